"""Results as labelled tables of pandas and labelled arrays of xarray, both of them optional."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from contactlab.export import COLUMNS, unit_in
from contactlab.grid import Grid
from contactlab.result import ImpactResult

#: Units of the entries of a scene that are no columns of a result.
OTHER_UNITS = {
    "friction_coefficient": "1", "speed": "m/s", "angle_deg": "deg", "angle": "rad",
    "radius": "m", "mass": "kg", "gyration_ratio": "1", "density": "kg/m³",
    "shear_modulus": "Pa", "young_modulus": "Pa", "poisson_ratio": "1",
}  # fmt: skip


def to_dataframe(result: ImpactResult) -> Any:
    """Return a ``pandas.DataFrame`` of one row an impact; see ``ImpactResult.to_dataframe``."""
    pandas = _needed("pandas", "to_dataframe")
    columns = _columns(result)
    axes = _axes(result)
    if axes:
        index = pandas.MultiIndex.from_product(list(axes.values()), names=list(axes))
    else:
        index = pandas.RangeIndex(np.size(result.status), name="impact")
    content = {
        name: np.broadcast_to(values, result.scene.shape).ravel()
        for name, values in columns.items()
        if name not in axes
    }
    frame = pandas.DataFrame(content, index=index)
    frame.attrs["units"] = {name: _unit(name, result) for name in (*axes, *content)}
    frame.attrs["laws"] = dict(result.laws)
    return frame


def to_xarray(result: ImpactResult) -> Any:
    """Return an ``xarray.Dataset`` with a dimension for each axis; see ``ImpactResult.to_xarray``.

    A batch that is no grid has the dimension ``impact``, or ``impact_0``, ``impact_1``, ...
    """
    xarray = _needed("xarray", "to_xarray")
    axes, shape = _axes(result), result.scene.shape
    if axes:
        dimensions, shape = tuple(axes), tuple(map(np.size, axes.values()))
    else:
        names = [f"impact_{number}" for number in range(len(shape))]
        dimensions = tuple(names) if len(shape) > 1 else ("impact",) * len(shape)
    variables = {
        name: (
            dimensions,
            np.broadcast_to(values, result.scene.shape).reshape(shape),
            _attributes(name, result),
        )
        for name, values in _columns(result).items()
        if name not in axes
    }
    coordinates = {name: (name, values, _attributes(name, result)) for name, values in axes.items()}
    return xarray.Dataset(variables, coordinates, {"laws": str(dict(result.laws))})


def _columns(result: ImpactResult) -> dict[str, Any]:
    """Return the columns that are defined for the scene, by name; statuses by theirs."""
    found = {}
    for name, _, read in COLUMNS:
        value = read(result)
        if value is None:
            continue
        if name == "status":
            statuses = np.array(value, dtype=object)
            value = np.array([status.name for status in statuses.flat]).reshape(statuses.shape)
        found[name] = np.asarray(value)
    return found


def _axes(result: ImpactResult) -> dict[str, Any]:
    """Return the axes of a grid; none of any other batch."""
    return dict(result.scene.axes) if isinstance(result.scene, Grid) else {}


def _unit(name: str, result: ImpactResult) -> str:
    """Return the unit of a column or of an axis, ``"sphere.radius"`` too; empty for words."""
    units = {column: unit for column, unit, _ in COLUMNS} | OTHER_UNITS
    unit = units.get(name.rpartition(".")[2], "")
    return unit_in(unit, result.scene) if unit else ""


def _attributes(name: str, result: ImpactResult) -> dict[str, str]:
    unit = _unit(name, result)
    return {"units": unit} if unit else {}


def _needed(module: str, method: str) -> Any:
    """Return an optional module, or say how to get it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(
            f'{method} needs {module}, which is not installed: pip install "contactlab[{module}]"'
        ) from error
