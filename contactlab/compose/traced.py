"""``rebound`` of arrays of JAX, which may be traced: jit, vmap, grad and hessian."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np

from contactlab.contracts.whole_impact import Tabulated
from contactlab.numeric.checks import Rule, real, refuse
from contactlab.numeric.labels import is_traced, library_of

#: Types that psi2 is computed in; shorter ones are widened.
SHORTEST = "float32"


def by_jax(
    law: Tabulated,
    arguments: Mapping[str, object],
    rules: Mapping[str, Rule],
    *,
    joined: bool,
) -> Any:
    """Return psi2 as an array of JAX, of the broadcast shape.

    Parameters
    ----------
    law : Tabulated
    arguments : mapping of str to float or array
        psi1, chi and maybe restitution, at least one of them an array of JAX.
    rules : mapping of str to Rule
        What numbers must obey; of traced ones, whose values are not known, psi2 is NaN instead.
    joined : bool
        Whether a restitution may be near 1.

    Raises
    ------
    ValueError
        If a number that is known is out of range, or shapes do not fit.
    """
    jax: Any = importlib.import_module("jax")
    numpy: Any = importlib.import_module("jax.numpy")
    for name, value in arguments.items():
        if library_of(value) not in ("", "jax"):
            rule = "must be numbers or an array of jax, as the others"
            raise refuse(name, value, rule, "give arrays of one package")
        if not is_traced(value):
            remedy = "the table ends there: give such impacts to rebound as NumPy arrays"
            known = np.asarray(value) if library_of(value) else value
            real(name, known, rule=rules[name], remedy=remedy, empty=True)
    # the type of arrays, not of numbers beside them, as everywhere in JAX
    kind = numpy.result_type(*arguments.values())
    if not numpy.issubdtype(kind, numpy.floating):
        kind = numpy.result_type(float)
    kind = numpy.promote_types(kind, SHORTEST)
    try:
        shape = numpy.broadcast_shapes(*map(numpy.shape, arguments.values()))
    except ValueError:
        shapes = {name: numpy.shape(value) for name, value in arguments.items()}
        raise refuse("shapes", shapes, "must fit", "give one value of each for each") from None
    impact = [numpy.broadcast_to(numpy.asarray(value, kind), shape) for value in arguments.values()]
    with jax.ensure_compile_time_eval():  # else a constant made in a trace would outlive it
        tables = _tables(law, str(kind))
    return _compiled(law, joined)(tables, *impact)


@cache
def _tables(law: Tabulated, kind: str) -> Any:
    """Return the numbers of a law's table as arrays of JAX."""
    numpy: Any = importlib.import_module("jax.numpy")
    return {
        name: numpy.asarray(each, kind if each.dtype.kind == "f" else "int32")
        for name, each in law.table_of_arrays().items()
    }


@cache
def _compiled(law: Tabulated, joined: bool) -> Callable[..., Any]:
    """Return psi2 of tables and impacts, compiled by JAX when it is called."""
    jax: Any = importlib.import_module("jax")
    numpy: Any = importlib.import_module("jax.numpy")

    def psi2(tables: Any, *impact: Any) -> Any:
        return law.rebound_of_arrays(numpy, tables, *impact, joined=joined)

    compiled: Callable[..., Any] = jax.jit(psi2)
    return compiled
