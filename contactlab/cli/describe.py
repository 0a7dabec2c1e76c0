"""A result in words and tables, as the terminal shows it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from contactlab.cli.table import table
from contactlab.compose.collision import VECTORS, Collision
from contactlab.impact.scene import entry_unit
from contactlab.outcome.numerical_error import error_cautions
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.tables import answer, closing, largest_imbalance, sections, sweep_section


def describe(
    result: ImpactResult,
    *,
    title: str = "",
    varied: Mapping[str, Any],
    collision: Collision | None = None,
) -> str:
    """Return the whole report of one impact, or of a sweep.

    Parameters
    ----------
    result : ImpactResult
    title : str
    varied : mapping of str to array
        What a sweep varies.
    collision : Collision, optional
        Both bodies in space, where the scene was given by vectors.
    """
    plan = result.plan
    warned = "\n".join(f"caution:  {text}" for text in error_cautions(result))
    if result.scene.shape:
        shown = {name: (entry_unit(name), values) for name, values in varied.items()}
        body = [table(*sweep_section(result, shown)), largest_imbalance(result)]
    else:
        lines = "\n".join(f"{name:24} {words}" for name, words in answer(result))
        body = [lines, *(table(*section) for section in sections(result))]
        if collision is not None:
            body.insert(1, table(["in space", "before", "after", "unit"], _space(collision)))
            plan = collision.plan
    end = "\n".join(f"{name + ':':9} {words}" for name, words in closing(result))
    return "\n\n".join([title] * bool(title) + [*body, *[warned] * bool(warned), str(plan), end])


def _space(collision: Collision) -> list[list[str]]:
    """Return the vectors of both bodies, and the impulse."""
    rows = []
    for name, unit in VECTORS:
        before = getattr(collision.encounter, name, None)
        shown = "" if before is None else _vector(before)
        rows.append([name.replace("_", " "), shown, _vector(getattr(collision, name)), unit])
    return rows


def _vector(numbers: Any) -> str:
    return f"({', '.join(f'{each:.6g}' for each in numbers.tolist())})"
