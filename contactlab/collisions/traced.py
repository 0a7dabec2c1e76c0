"""``rebound`` of arrays of JAX and PyTorch, which may be traced: under jit, vmap, grad, hessian."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from contactlab.collisions.namespaces import find_library, read_numbers
from contactlab.contracts.whole_impact import Tabulated
from contactlab.numeric.array_api import Traced
from contactlab.numeric.checks import Rule, refuse

#: Remedy for a number outside a table.
ENDS = "the table ends there: give such impacts to rebound as NumPy arrays"
#: Tables as arrays of a library, by law, library, type and place.
_TABLES: dict[tuple[object, ...], Mapping[str, Traced]] = {}


def by_standard(
    library: str,
    law: Tabulated,
    arguments: Mapping[str, object],
    rules: Mapping[str, Rule],
    *,
    joined: bool,
) -> object:
    """Return psi2 as an array of a library, of the broadcast shape.

    Parameters
    ----------
    library : str
        The package of the arrays, ``"jax"`` or ``"torch"``.
    law : Tabulated
    arguments : mapping of str to float or array
        psi1, chi and maybe restitution, at least one of them an array of that library.
    rules : mapping of str to Rule
        What numbers must obey; of traced ones, whose values are not known, psi2 is NaN instead.
    joined : bool
        Whether a restitution may be near 1.

    Raises
    ------
    ValueError
        If a number that is known is out of range, or shapes do not fit.
    """
    for name, value in arguments.items():
        read_numbers(library, name, value, rules[name], ENDS)
    arrays = find_library(library).arrays(arguments.values())
    xp = find_library(library).xp
    try:
        shape = xp.broadcast_shapes(*(array.shape for array in arrays))
    except (ValueError, RuntimeError):  # of JAX, of PyTorch
        shapes = {name: (*each.shape,) for name, each in zip(arguments, arrays, strict=True)}
        raise refuse("shapes", shapes, "must fit", "give one value of each for each") from None
    impact = [xp.broadcast_to(array, shape) for array in arrays]
    return _function(library, law, joined)(_tables(library, law, impact[0]), *impact)


def _tables(library: str, law: Tabulated, like: Any) -> Mapping[str, Traced]:
    """Return the numbers of a law's table as arrays of the type and place of ``like``."""
    place = like.device if library == "torch" else None
    key = law, library, like.dtype, place
    if key not in _TABLES:
        _TABLES[key] = find_library(library).constants(law.table_of_arrays(), like)
    return _TABLES[key]


@cache
def _function(library: str, law: Tabulated, joined: bool) -> Callable[..., Any]:
    """Return psi2 of tables and impacts, compiled when it is called if the library compiles."""
    of = find_library(library)
    xp = of.xp

    def psi2(tables: Mapping[str, Traced], *impact: Traced) -> Traced:
        return law.rebound_of_arrays(xp, tables, *impact, joined=joined, with_slopes=of.with_slopes)

    return of.compile_late(psi2)
