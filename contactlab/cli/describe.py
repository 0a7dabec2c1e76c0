"""A result as text and tables for the terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from contactlab.numeric.types import Real
from contactlab.outcome.numerical_error import error_cautions
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.sheet import tell_vector
from contactlab.outcome.tables import (
    answer,
    closing,
    has_bodies,
    largest_imbalance,
    sections,
    sweep_section,
)
from contactlab.outcome.text_table import table

if TYPE_CHECKING:
    from contactlab.collisions.collision import Collision


def describe(
    result: ImpactResult,
    *,
    title: str,
    varied: Mapping[str, Real],
    collision: Collision | None,
) -> str:
    """Return the report of one impact or a sweep, with vectors if ``collision`` is given."""
    cautions = "\n".join(f"caution: {text}" for text in error_cautions(result))
    if result.scene.shape:
        body = [table(*sweep_section(result, varied)), largest_imbalance(result)]
    else:
        lines = "\n".join(f"{name:24} {words}" for name, words in answer(result))
        body = [table(*section) for section in sections(result)]
        if collision is not None:
            body.insert(0, in_space(collision))
        # Who has bodies asks for velocities and spins: psi2 comes last.
        body.insert(len(body) if has_bodies(result.scene) else 0, lines)
    ending = "\n".join(f"{name + ':':9} {words}" for name, words in closing(result))
    parts = [title, *body, cautions, str(result.plan), ending]
    return "\n\n".join(part for part in parts if part)


def in_space(collision: Collision) -> str:
    """Return a table with the vectors of both bodies and the impulse."""
    from contactlab.collisions.collision import VECTORS_AFTER  # only for vectors

    rows = []
    for name, unit in VECTORS_AFTER:
        before = getattr(collision.encounter, name, None)
        shown = "" if before is None else tell_vector(before)
        rows.append([name.replace("_", " "), shown, tell_vector(getattr(collision, name)), unit])
    return table(["in space", "before", "after", "unit"], rows)
