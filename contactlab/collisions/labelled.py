"""``rebound`` of labelled arrays, paired by their labels, and of dask arrays, not computed yet."""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

from contactlab.numeric.checks import of_kind, quote, real, refuse
from contactlab.numeric.labels import library_of

#: Names of the answers: psi2 and its derivatives.
ANSWERS = ("psi2", "dpsi2_dpsi1", "dpsi2_dchi", "dpsi2_de")
#: The class of each package whose labels, or laziness, the answer keeps.
KINDS = {"xarray": "DataArray", "pandas": "Series", "dask": "Array"}
MODULES = {"xarray": "xarray", "pandas": "pandas", "dask": "dask.array"}


def by_labels(
    function: Callable[..., object], answers: int, arguments: Mapping[str, object]
) -> object:
    """Return the answers of a function to labelled or lazy arrays, labelled or lazy too.

    Parameters
    ----------
    function : callable
        Takes as many arrays as there are ``arguments``, and returns ``answers`` arrays.
    answers : int
        1, or the length of the tuple that ``function`` returns.
    arguments : mapping of str to float or array
        At least one of them is an array of xarray, pandas or dask.

    Raises
    ------
    ValueError
        If labels differ, arrays with labels stand beside arrays without, or two packages meet.
    """
    library, owner = _library(arguments)
    module = importlib.import_module(MODULES[library])
    ways = {"xarray": _by_dimensions, "pandas": _by_index, "dask": _lazily}
    apply: Callable[..., Any] = ways[library]
    checked = {
        name: value if library_of(value) else real(name, value, empty=True)
        for name, value in arguments.items()
    }
    for name, value in checked.items():
        # a dask array has no labels, nor has an array of NumPy
        if library != "dask" and isinstance(value, np.ndarray):
            rule = f"has no labels, but {owner} has"
            raise refuse(name, value, rule, f"make it a {KINDS[library]} too")
    return apply(module, function, answers, checked)


def _library(arguments: Mapping[str, object]) -> tuple[str, str]:
    """Return the package of the arguments, and the name of the first argument of it."""
    owners: dict[str, str] = {}
    for name, value in arguments.items():
        library = library_of(value)
        if not library:
            continue
        kind = getattr(importlib.import_module(MODULES[library]), KINDS[library])
        rule = f"must be a {library} {KINDS[library]}, or numbers"
        of_kind(name, value, kind, rule=rule, remedy="give one column or variable of it")
        owners.setdefault(library, name)
    if len(owners) > 1:
        given = ", ".join(f"{name} of {library}" for library, name in owners.items())
        raise ValueError(f"{given}: must be of one package; give arrays of one of them")
    return next(iter(owners.items()))


def _by_dimensions(
    xarray: Any, function: Callable[..., object], answers: int, arguments: Mapping[str, object]
) -> object:
    """Return ``DataArray``s over every dimension of the arguments; lazy ones of lazy ones."""
    labelled = [value for value in arguments.values() if library_of(value)]
    try:
        xarray.align(*labelled, join="exact", copy=False)
    except ValueError as error:
        remedy = "align them first: xarray.align(psi1, chi, join='inner')"
        raise _unequal(arguments, "labels along each dimension", remedy) from error
    found = xarray.apply_ufunc(
        function,
        *arguments.values(),
        join="exact",
        dask="parallelized",
        output_core_dims=[()] * answers,
        output_dtypes=[np.float64] * answers,
    )
    each = found if answers > 1 else (found,)
    return _one_or_all(array.rename(name) for array, name in zip(each, ANSWERS, strict=False))


def _by_index(
    pandas: Any, function: Callable[..., Any], answers: int, arguments: Mapping[str, Any]
) -> object:
    """Return ``Series`` with the index of the first one; the others follow in its order."""
    index = None
    columns = []
    for value in arguments.values():
        if not library_of(value):
            columns.append(value)
            continue
        index = value.index if index is None else index
        labels = _like_levels(value.index, index)
        if labels is None or not labels.equals(index):
            places = _places(labels, index)
            if places is None:
                remedy = "align them first: psi1, chi = psi1.align(chi, join='inner')"
                raise _unequal(arguments, "labels", remedy)
            value = value.iloc[places]
        columns.append(value.to_numpy())
    found = function(*columns)
    each = found if answers > 1 else (found,)
    return _one_or_all(
        pandas.Series(array, index=index, name=name)
        for array, name in zip(each, ANSWERS, strict=False)
    )


def _like_levels(labels: Any, index: Any) -> Any:
    """Return labels with their levels in the order of an index; None if levels have other names."""
    names, wanted = [*labels.names], [*index.names]
    if len(wanted) == 1 or names == wanted or None in names + wanted:
        return labels
    same = len(set(wanted)) == len(wanted) and sorted(map(str, names)) == sorted(map(str, wanted))
    return labels.reorder_levels(wanted) if same else None


def _places(labels: Any, index: Any) -> object:
    """Return the place of each label of an index; None where labels differ or repeat."""
    if labels is None or len(labels) != len(index) or not (labels.is_unique and index.is_unique):
        return None
    places = labels.get_indexer(index)
    # a number is found in an index of intervals, and True in one of numbers
    same = (places >= 0).all() and labels.take(places).equals(index)
    return places if same else None


def _lazily(
    dask_array: Any, function: Callable[..., object], answers: int, arguments: Mapping[str, Any]
) -> object:
    """Return dask arrays of the broadcast shape; bad numbers are refused when they are computed."""
    for name, value in arguments.items():
        if any(map(math.isnan, np.shape(value))):
            rule = "has chunks of unknown size, which cannot be paired"
            raise refuse(name, value, rule, "call its compute_chunk_sizes() first")
    shapes = {name: np.shape(value) for name, value in arguments.items()}
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        raise refuse("shapes", shapes, "must fit", "give one value of each for each") from None
    signature = f"{','.join(['()'] * len(arguments))}->{','.join(['()'] * answers)}"
    return dask_array.apply_gufunc(
        function,
        signature,
        *arguments.values(),
        output_dtypes=np.float64 if answers == 1 else [np.float64] * answers,
        allow_rechunk=True,  # chunks of the arguments may differ
    )


def _one_or_all(answers: Iterable[object]) -> object:
    """Return a single answer, or all as a tuple."""
    one, *others = answers
    return (one, *others) if others else one


def _unequal(arguments: Mapping[str, object], what: str, remedy: str) -> ValueError:
    """Return the refusal of arguments whose labels differ."""
    names = [name for name, value in arguments.items() if library_of(value)]
    values = ", ".join(quote(arguments[name], most=40) for name in names)
    return ValueError(f"{', '.join(names)} = {values}: must have equal {what}; {remedy}")
