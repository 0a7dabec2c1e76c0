"""The energy books of an impact."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from contactlab.contracts.status import Status
from contactlab.impact.bodies import Pair
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import some
from contactlab.numeric.checks import Real
from contactlab.outcome.columns import json_value
from contactlab.outcome.motion import Motion

#: e beyond this is energy from nothing, and not the error of a scheme: the fewest steps
#: that an explicit one takes leave e - 1 = 3e-3.
LARGEST_RESTITUTION = 1.02
#: Slip faster at the end than this many times the slip at the start is energy from nothing too:
#: the capped spring of discrete-element codes, which makes some by its nature, stays below it
#: between elastic spheres, and passes it under strongly damped normal laws.
LARGEST_SLIP = 1.1


def _energy() -> Any:
    return attrs.field(metadata={"unit": "J"})


@attrs.frozen(kw_only=True, eq=False)
class EnergyLedger:
    """Kinetic energy of the relative motion at the contact, in J.

    Attributes
    ----------
    start, end : float or array
        ½ M_n v_z² + ½ M_t v_x² before and after.
    normal_loss : float or array
        ½ M_n v_z² before less after: what a dissipative normal law takes up; zero if elastic.
    friction_work : float or array
        Added up by the law from traction and slip, step by step.
    imbalance : float or array
        start - end - normal_loss - friction_work: zero in an exact solution. Normal force
        does no work in slip, nor friction in approach, so the two losses are apart.
    """

    start: Real = _energy()
    end: Real = _energy()
    normal_loss: Real = _energy()
    friction_work: Real = _energy()
    imbalance: Real = _energy()

    @property
    def relative_imbalance(self) -> Real:
        """Imbalance over the energy at the start."""
        with np.errstate(under="ignore"):
            return self.imbalance / self.start

    def to_dict(self) -> dict[str, Any]:
        """Return the five entries and the relative imbalance as plain numbers or lists."""
        entries = attrs.asdict(self) | {"relative_imbalance": self.relative_imbalance}
        return {name: json_value(value) for name, value in entries.items()}


def ledger(scene: Scene, motion: Motion) -> EnergyLedger:
    """Return the books of ``motion``, from the velocities alone but for the friction work."""
    before = (scene.normal_speed, scene.slip_velocity)
    after = (motion.normal_velocity, motion.slip_velocity_change)
    return books(scene.pair, before, after, motion.friction_work)


def books(
    pair: Pair, before: tuple[Real, Real], after: tuple[Real, Real], friction_work: Real
) -> EnergyLedger:
    """Return the books of two bodies.

    Parameters
    ----------
    pair : Pair
    before : tuple
        Rate of approach and slip velocity, in m/s.
    after : tuple
        Rate of approach, and the change of the slip velocity, in m/s.
    friction_work : float or array
        In J.
    """
    (speed, slip), (rate, change) = before, after
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        # Products, not powers: a float raised to a power raises OverflowError.
        start = 0.5 * pair.normal_mass * speed * speed
        start = start + 0.5 * pair.tangential_mass * slip * slip
        # The loss is formed from the changes: with a huge v_x, start - end would cancel.
        normal_loss = 0.5 * pair.normal_mass * (speed - rate) * (speed + rate)
        slip_loss = -pair.tangential_mass * change * (slip + 0.5 * change)
        return EnergyLedger(
            start=start,
            end=start - normal_loss - slip_loss,
            normal_loss=normal_loss,
            friction_work=friction_work,
            imbalance=slip_loss - friction_work,
        )


@np.errstate(all="ignore")
def balanced(motion: Motion, scene: Scene, bound: float) -> Motion:
    """Return ``motion``, its status ``UNBALANCED`` where energy came from nothing, or went.

    That is where the books miss by more than ``bound``, over the energy at the start; and
    where the bodies part, or slip, faster than they met.
    """
    speed: Any = abs(motion.normal_velocity)
    fast = speed > LARGEST_RESTITUTION * scene.normal_speed
    if some(fast):
        detail = _sentences(
            "The bodies part {:.4g} times as fast as they met.", speed / scene.normal_speed
        )
        motion = motion.failing(fast, Status.UNBALANCED, detail)
    books = ledger(scene, motion)
    miss: Any = abs(books.imbalance)
    missing = miss > bound * books.start
    if some(missing):
        share = abs(books.relative_imbalance)
        detail = _sentences(
            f"Off by {{:.2g}} of the energy at the start; declared: {bound:.2g}.", share
        )
        motion = motion.failing(missing, Status.UNBALANCED, detail)
    before: Any = abs(scene.slip_velocity)
    after: Any = abs(scene.slip_velocity + motion.slip_velocity_change)
    slips = after > LARGEST_SLIP * before
    if some(slips):
        detail = _sentences(
            "The contact slips {:.4g} times as fast as it met.", np.divide(after, before)
        )
        motion = motion.failing(slips, Status.UNBALANCED, detail)
    return motion


def _sentences(sentence: str, numbers: Any) -> Any:
    """Return the sentence with its number in it, for each impact."""
    if not np.ndim(numbers):
        return sentence.format(float(numbers))
    sentences = [sentence.format(number) for number in np.ravel(numbers).tolist()]
    return np.array(sentences, dtype=object).reshape(np.shape(numbers))
