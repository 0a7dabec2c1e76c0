"""Results as tables of pandas and labelled arrays of xarray; both packages are optional."""

from __future__ import annotations

import importlib
import math
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from contactlab.outcome.sheet import Sheet

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset


def to_dataframe(sheet: Sheet) -> DataFrame:
    """Return a ``pandas.DataFrame``, one row for each number of a column.

    Its index is the axes; where none has values, the rows are counted.
    """
    pandas = import_optional("pandas", "to_dataframe")
    if all(values is None for values in sheet.axes.values()):
        index = pandas.RangeIndex(math.prod(sheet.shape), name=sheet.row)
    else:
        places = zip(sheet.axes.items(), sheet.shape, strict=True)
        axes = {
            name: np.arange(size) if values is None else values for (name, values), size in places
        }
        index = pandas.MultiIndex.from_product(list(axes.values()), names=list(axes))
        if len(axes) == 1:
            index = index.get_level_values(0)
    columns = {
        name: np.broadcast_to(values, sheet.shape).ravel() for name, values in sheet.columns.items()
    }
    frame: DataFrame = pandas.DataFrame(columns, index)
    frame.attrs |= {"units": dict(sheet.units), **sheet.about}
    return frame


def to_xarray(sheet: Sheet) -> Dataset:
    """Return an ``xarray.Dataset``, one dimension for each axis."""
    xarray = import_optional("xarray", "to_xarray")
    dimensions, units = tuple(sheet.axes), sheet.units
    attributes = {name: {"units": unit} if unit else {} for name, unit in units.items()}
    data: Dataset = xarray.Dataset(
        {
            name: (dimensions, np.broadcast_to(values, sheet.shape), attributes.get(name, {}))
            for name, values in sheet.columns.items()
        },
        {
            name: (name, values, attributes.get(name, {}))
            for name, values in sheet.axes.items()
            if values is not None
        },
        dict(sheet.about),
    )
    return data


def import_optional(module: str, method: str, *, extra: str = "") -> ModuleType:
    """Return an optional module, or raise ``ImportError`` with the command that installs it.

    ``extra`` are the extras to install, by default the one named as the module.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(
            f"{method} needs {module}, which is not installed: in the clone pip install "
            f'".[{extra or module}]"'
        ) from error
