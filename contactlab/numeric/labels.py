"""Arrays of other libraries, none imported: xarray, pandas, dask, JAX and PyTorch."""

from __future__ import annotations

import sys
from functools import cache
from typing import Any

import numpy as np

from contactlab.numeric.types import AnyArray

#: Packages of arrays, by the package of their classes. NumPy would pair such arrays by position,
#: compute them at once or lose their trace.
LIBRARIES = {
    "xarray": "xarray", "pandas": "pandas", "dask": "dask", "jax": "jax", "jaxlib": "jax",
    "torch": "torch",
}  # fmt: skip
#: Packages of tables, whose columns have names as in pandas.
TABLES = ("polars", "pyarrow")
#: The attribute that gives plain numbers, by the one that holds the unit: of astropy, of pint.
QUANTITIES = {"unit": "to_value", "units": "magnitude"}
#: Words that quantities without a unit have as their unit.
NO_UNIT = ("", "dimensionless", "None")
#: Attributes that tell arrays from other objects of their package.
ONLY_OF = {"pandas": "iloc", "torch": "detach"}
#: The refusal of a table.
OF_COLUMNS = (
    "has columns with names, but arrays are paired by position here",
    "give numbers in the order that is meant: .to_numpy()",
)
#: The refusal of traced arrays elsewhere.
ONLY_ARRAYS = "of scenes and laws only rebound and Collision.of_arrays take traced arrays"


def library_of(value: object) -> str:
    """Return the package of an array of another library; empty for all other values."""
    kind: type = type(value)
    return _library(kind)


@cache
def _library(kind: type) -> str:
    """Return the package of a class of such arrays; empty for all other classes."""
    for base in kind.__mro__:
        package = base.__module__.partition(".")[0]
        if package in LIBRARIES and hasattr(kind, ONLY_OF.get(package, "__class__")):
            return LIBRARIES[package]
    return ""


def numbers_of(value: Any) -> AnyArray | None:
    """Return the numbers of an array of JAX or PyTorch; None if it is traced, by jit or vmap."""
    if library_of(value) == "jax":
        return None if isinstance(value, sys.modules["jax"].core.Tracer) else np.asarray(value)
    plain = value.detach()
    plain = plain.double() if plain.is_floating_point() else plain  # NumPy has no bfloat16
    try:
        numbers: AnyArray = plain.cpu().numpy()
    except RuntimeError:  # a tensor of torch.func
        return None
    return numbers


def forbid_position(value: Any) -> tuple[str, str] | None:
    """Return why ``value`` must not be read by position, and the remedy; None for other values.

    A ``DataArray`` without dimensions is a number, and so is an entry of one. A ``Series`` whose
    index counts 0, 1, 2, ... has the same pairs by position and by label.
    """
    library = library_of(value)
    if not library:
        return _unread(value)
    if library == "xarray" and getattr(value, "dims", None) != ():
        dimensions = ", ".join(map(str, getattr(value, "dims", ())))
        rule = f"has dimensions with names ({dimensions}), but arrays are paired by position here"
        return rule, "give numbers in the order that is meant: .values"
    if library == "pandas":
        if value.ndim > 1:
            return OF_COLUMNS
        if not np.array_equal(np.asarray(value.index), np.arange(len(value.index))):
            rule = "has an index other than 0, 1, 2, ..., but arrays are paired by position here"
            return rule, "give numbers in the order that is meant: .to_numpy()"
    if library in ("jax", "torch") and numbers_of(value) is None:
        return f"is traced by {library}", ONLY_ARRAYS
    if library == "torch" and value.requires_grad:
        return "has a gradient, which would be lost here", f"give .detach(); {ONLY_ARRAYS}"
    if library == "torch" and value.device.type != "cpu":
        return "is on another device", "give .cpu()"
    if library == "dask":
        remedy = "give its numbers: .compute(); of dask arrays only rebound returns dask arrays"
        return "is not computed yet", remedy
    return None


def _unread(value: Any) -> tuple[str, str] | None:
    """Return why NumPy must not read an object: a unit, a mask or names would be lost."""
    for name, of_quantity in QUANTITIES.items():
        unit = str(getattr(value, name, ""))
        if unit not in NO_UNIT and (hasattr(value, of_quantity) or isinstance(value, np.ndarray)):
            remedy = (
                "give plain numbers in SI units: .to_value(unit) of astropy, .m_as(unit) of pint"
            )
            return f"has the unit {unit}, which would be lost here", remedy
    # importing numpy.ma takes 8 ms
    if hasattr(value, "_mask") and np.ma.is_masked(value):
        return "must have no masked entries", "fill or drop them"
    if type(value).__module__.partition(".")[0] in TABLES and hasattr(value, "columns"):
        return OF_COLUMNS
    return None
