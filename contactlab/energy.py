"""The energy books of an impact."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from contactlab.checks import Real
from contactlab.contracts.integrator import Motion
from contactlab.plain import plain
from contactlab.scene import Scene
from contactlab.status import Status


@attrs.frozen(kw_only=True, eq=False)
class EnergyLedger:
    """Kinetic energy of the relative motion at the contact, in J.

    Attributes
    ----------
    start, end : float or array
        ½ M_n v_z² + ½ M_t v_x² before and after.
    friction_work : float or array
        Added up by the law from traction and slip, step by step.
    imbalance : float or array
        start - end - friction_work: zero in an exact solution.
    """

    start: Real
    end: Real
    friction_work: Real
    imbalance: Real

    @property
    def relative_imbalance(self) -> Real:
        """Imbalance over the energy at the start."""
        return self.imbalance / self.start

    def to_dict(self) -> dict[str, Any]:
        """Return the four entries and the relative imbalance as plain numbers or lists."""
        entries = attrs.asdict(self) | {"relative_imbalance": self.relative_imbalance}
        return {name: plain(value) for name, value in entries.items()}


def ledger(scene: Scene, motion: Motion) -> EnergyLedger:
    """Return the books of ``motion``, from the velocities alone but for the friction work."""
    pair, before, change = scene.pair, scene.slip_velocity, motion.slip_velocity_change
    speed, after = scene.normal_speed, motion.normal_velocity
    with np.errstate(over="ignore", invalid="ignore"):
        # Products, not powers: a float raised to a power raises OverflowError.
        start = 0.5 * pair.normal_mass * speed * speed
        start = start + 0.5 * pair.tangential_mass * before * before
        # The loss is formed from the changes: with a huge v_x, start - end would cancel.
        loss = 0.5 * pair.normal_mass * (speed - after) * (speed + after)
        loss = loss - pair.tangential_mass * change * (before + 0.5 * change)
        return EnergyLedger(
            start=start,
            end=start - loss,
            friction_work=motion.friction_work,
            imbalance=loss - motion.friction_work,
        )


def balanced(motion: Motion, scene: Scene, bound: float) -> Motion:
    """Return ``motion``, its status changed where the books miss by more than ``bound``.

    ``bound`` is what the tangential law declares, over the energy at the start.
    """
    if bound == np.inf:
        return motion
    books = ledger(scene, motion)
    missing = np.abs(books.imbalance) > bound * np.asarray(books.start)
    if not missing.any():
        return motion
    worst = np.nanmax(np.abs(np.asarray(books.relative_imbalance))[missing])
    detail = f"Off by {worst:.2g} of the energy at the start; declared: {bound:.2g}."
    if not scene.shape:
        return (
            attrs.evolve(motion, status=Status.UNBALANCED, detail=detail)
            if motion.status
            else motion
        )
    statuses = motion.status.copy()
    statuses[missing & (statuses == Status.SUCCESS)] = Status.UNBALANCED
    return attrs.evolve(motion, status=statuses, detail=motion.detail or detail)
