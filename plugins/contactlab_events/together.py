"""Many impacts in one call, of a law that offers it; what it leaves is followed one by one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import ClosedFormMotion, ManyPhasedTangentialLaw, TangentialMotion
from contactlab.status import Status
from contactlab_events.follow import books_miss
from contactlab_events.scaled import scaled

Flags = NDArray[np.bool_]

#: Fewer impacts take longer together than one by one: a call of some hundred panels costs what it
#: costs, however many impacts are in it.
FEWEST = 64
#: Books that miss by more, over the tangential energy, are not taken: an event was misplaced, or
#: the law is not as exact here as it is one by one.
BOOKS = 3e-7


def together(
    law: ManyPhasedTangentialLaw, normal: ClosedFormMotion, tolerance: float
) -> tuple[Flags, TangentialMotion]:
    """Return which impacts of a batch were solved together, and the motion of those."""
    shape = normal.scene.shape
    with np.errstate(all="ignore"):
        impact = scaled(normal)
        speed, factor = (np.broadcast_to(part, shape) for part in impact.posed(law))
        inertia = np.broadcast_to(impact.inertia, shape)
        known = (speed > 0.0) & np.isfinite(speed) & (inertia > 0.0) & np.isfinite(inertia)
        known &= np.greater(impact.force_unit, 0.0)
        change, work = np.zeros(shape), np.zeros(shape)
        found = law.impacts_together(speed[known], inertia[known], normal, tolerance)
        change[known], work[known] = found.change, found.work
        known[known] = found.solved
        known &= books_miss(speed, inertia, change, work) < BOOKS
        gained, lost = np.broadcast_arrays(*impact.answer(factor, change, work))
    return known, TangentialMotion(
        slip_velocity_change=gained[known],
        friction_work=lost[known],
        status=np.full(np.count_nonzero(known), Status.SUCCESS, dtype=object),
        counters={"panels": found.panels, "solves": found.panels},
    )
