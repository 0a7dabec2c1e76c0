"""Impacts whose normal motion no step can follow: answered as a whole, or refused.

Clay, of restitution 0, is an example: its damping is infinite, and its contact never ends.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.contracts import faults
from contactlab.contracts.restitution import LEAST_RESTITUTION
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import every, some
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Mask, Real
from contactlab.registration.names import short_name
from contactlab.registry.composition import RESTITUTION, Laws
from contactlab.registry.registry import REGISTRY
from contactlab.solve.way import Way


def follow_apart(laws: Laws, where: Any, part: Scene) -> list[tuple[Any, Scene]]:
    """Return places and scenes of the impacts that no step follows, and of the others.

    So NaN of the former never stands beside numbers of the latter. ``where`` is
    the place of ``part`` in the whole scene.
    """
    if (law := laws.capability.unfollowed) is None:
        return [(where, part)]
    rate = law.unfollowed_rate(part)
    if rate is None or not part.shape or every(known := np.isfinite(rate)) or not some(known):
        return [(where, part)]
    places = []
    for mask in (~known, known):
        place = mask
        if where is not ...:
            place = np.zeros(where.shape, dtype=bool)
            place[where] = mask
        places.append((place, part.take(mask)))
    return places


def refuse_march(way: Way, *, history: bool) -> None:
    """Refuse impacts to march, or with a history, whose normal motion no step can follow."""
    _, scene, laws = way
    law = laws.capability.unfollowed
    if law is None or (rate := law.unfollowed_rate(scene)) is None:
        return
    remedy = f"take at least {LEAST_RESTITUTION}"
    if way.both:
        why = "for this body, whose impact must be followed in steps"
    elif history:
        why = "with a history"
        remedy += ", or no history"
    elif some(np.isfinite(rate) & _find_gaps(way)):
        why = f"under {REGISTRY.short_name(laws.tangential)}, which follows the impact in steps"
        springs = RESTITUTION["tangential"]
        if short_name(REGISTRY.short_name(laws.tangential)) != springs:
            remedy += f", or {springs}"
    else:
        return
    raise refusal(rate, scene, why, remedy)


def refusal(rate: Real, scene: Scene, why: str, remedy: str) -> ValueError:
    """Return the ValueError of the first impact that no step can follow."""
    e = np.broadcast_to(-np.asarray(rate) / scene.normal_speed, scene.shape)
    first = float(e[np.isfinite(e)].flat[0])
    return refuse("restitution", first, f"must be from {LEAST_RESTITUTION} {why}", remedy)


def _find_gaps(way: Way) -> Mask:
    """Return the impacts without a whole-impact answer; no impact if the law fails."""
    try:
        prepared = way.prepare(False)
    except faults.LawFaultError:
        return False
    missing = prepared.columns.marched
    for where, answer in prepared.answered:
        missing = missing | (where & ~np.isfinite(answer.slip_velocity_change))
    return np.asarray(missing)
