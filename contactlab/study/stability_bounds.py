"""The invariants that bind every method, and what of them a coarse one may break."""

from __future__ import annotations

import numpy as np

from contactlab.contracts.error_model import range_of
from contactlab.outcome.result import ImpactResult

#: Energy books, over the energy at the start: an integrator that controls its error adds up
#: friction work less accurately than velocities.
BOOKS = 1e-5
#: However coarse a method is, energy from nothing beyond this is wrong.
LARGEST_GAIN = 0.1
#: |1 - e| of an elastic impact is never beyond this, however few the steps, nor beyond what the
#: normal motion declares.
LARGEST_NORMAL = 1e-9


def broken_invariants(
    result: ImpactResult,
    bound: float,
    *,
    passive: bool = True,
    books_bound: float = 0.0,
    load_impulse: float | None = None,
) -> list[str]:
    """Return the laws of physics (theory §7) that a result breaks by more than ``bound``.

    Parameters
    ----------
    result : ImpactResult
    bound : float
        Declared or estimated error of psi2, over its range.
    passive : bool
        False for a law that says of its books that they do not close: its model makes energy.
    books_bound : float
        Declared imbalance of the books, over the energy at the start.
    load_impulse : float, optional
        Of the friction load, in N s; by default that of an elastic impact.
    """
    scene, motion = result.scene, result.motion
    _, width, speed = range_of(scene)
    if load_impulse is not None:
        grip = scene.friction_coefficient * load_impulse / scene.pair.tangential_mass
        width = min(float(grip), 2.0 * speed)
    change, rate = float(motion.slip_velocity_change), float(motion.normal_velocity)
    numbers = (change, rate, float(motion.duration), float(motion.friction_work))
    if not np.all(np.isfinite(numbers)):
        return ["a number that is not finite"]
    if width == 0.0:
        return [] if change == 0.0 else ["a change of velocity where nothing can act"]
    broken = []
    allowed = min(bound, LARGEST_GAIN)
    along = -change * np.sign(float(scene.slip_velocity))
    if along < -allowed * width and passive:
        broken.append("friction speeds the slip up")
    gripped = width < 2.0 * speed  # the range is that of slip throughout, 4 chi
    if along > (1.0 + allowed) * width and (passive or gripped):
        broken.append(
            "|psi2 - psi1| beyond what mu times the load can do" if gripped else "|psi2| > |psi1|"
        )
    if not passive:
        return broken
    books = result.energy
    scale = 0.5 * float(scene.pair.normal_mass * scene.normal_speed**2)
    scale += float(scene.pair.tangential_mass) * width * speed
    allowed_books = max(bound, BOOKS, min(books_bound, LARGEST_GAIN))
    if not abs(float(books.imbalance)) <= allowed_books * scale:
        broken.append("energy books do not close")
    if float(books.friction_work) < -allowed * scale:
        broken.append("friction does work on the bodies")
    return broken
