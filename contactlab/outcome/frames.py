"""Results as tables of pandas and labelled arrays of xarray; both packages are optional."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np

from contactlab.outcome.columns import WithScene, unit_in
from contactlab.outcome.columns import columns as all_columns


class WithLaws(WithScene, Protocol):
    """A result that has statuses and names of laws, beside columns."""

    @property
    def status(self) -> Any:
        """Status of each impact."""

    @property
    def laws(self) -> Mapping[str, str]:
        """Names of the laws."""


def to_dataframe(result: WithLaws) -> Any:
    """Return a ``pandas.DataFrame``, one row for each impact: ``ImpactResult.to_dataframe``."""
    pandas = import_optional("pandas", "to_dataframe")
    columns, axes, units = _label_columns(result)
    if axes:
        index = pandas.MultiIndex.from_product(list(axes.values()), names=list(axes))
    else:
        index = pandas.RangeIndex(np.size(result.status), name="impact")
    frame = pandas.DataFrame({name: values.ravel() for name, values in columns.items()}, index)
    frame.attrs |= {"units": units, **result.laws}
    return frame


def to_xarray(result: WithLaws) -> Any:
    """Return an ``xarray.Dataset``, one dimension for each axis: ``ImpactResult.to_xarray``.

    A batch that is not a grid has the dimension ``impact``, or ``impact_0``, ``impact_1``, ...
    """
    xarray = import_optional("xarray", "to_xarray")
    columns, axes, units = _label_columns(result)
    dimensions, shape = tuple(axes), tuple(map(np.size, axes.values()))
    if not axes:
        shape = result.scene.shape
        numbered = tuple(f"impact_{number}" for number in range(len(shape)))
        dimensions = numbered if len(shape) > 1 else ("impact",) * len(shape)
    attributes = {name: {"units": unit} if unit else {} for name, unit in units.items()}
    return xarray.Dataset(
        {
            name: (dimensions, values.reshape(shape), attributes[name])
            for name, values in columns.items()
        },
        {name: (name, values, attributes[name]) for name, values in axes.items()},
        dict(result.laws),
    )


def _label_columns(result: WithLaws) -> tuple[dict[str, Any], dict[str, Any], dict[str, str]]:
    """Return the columns that a scene defines, of its shape, the axes of a grid, and all units."""
    scene = result.scene
    axes = dict(scene.axes)
    columns, units = {}, {}
    for name, unit, values in all_columns(result):
        if values is None:  # a scene without bodies
            continue
        units[name] = unit_in(unit, scene) if unit else ""
        if name in axes:
            continue
        if name == "status":
            values = np.reshape([status.name for status in np.ravel(np.array(values))], scene.shape)
        columns[name] = np.broadcast_to(values, scene.shape)
    return columns, axes, units


def import_optional(module: str, method: str) -> Any:
    """Return an optional module, or raise ``ImportError`` with the command that installs it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(
            f"{method} needs {module}, which is not installed: in the clone pip install "
            f'".[{module}]"'
        ) from error
