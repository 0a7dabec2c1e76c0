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

#: A normal restitution above this is energy from nothing, and no integration error: an explicit
#: scheme with the fewest steps leaves e - 1 = 3e-3.
LARGEST_RESTITUTION = 1.02
#: A slip velocity at the end above this multiple of the slip velocity at the start is energy from
#: nothing too. The capped spring of discrete-element codes makes some energy; its slip velocity
#: stays below this bound between elastic spheres, and exceeds it under strongly damped normal laws.
LARGEST_SLIP = 1.1


def _energy() -> Any:
    """Return an attribute in J."""
    return attrs.field(metadata={"unit": "J"})


@attrs.frozen(kw_only=True, eq=False)
class EnergyLedger:
    """Kinetic energy of the relative motion at the contact, in J.

    Attributes
    ----------
    start, end : float or array
        ½ M_n v_z² + ½ M_t v_x² before and after.
    normal_loss : float or array
        ½ M_n v_z² before less after: loss of a dissipative normal law; zero if elastic.
    friction_work : float or array
        Sum over the steps, computed by the law from traction and slip.
    imbalance : float or array
        start - end - normal_loss - friction_work: zero in an exact solution. The losses are
        independent: the normal force does no work in slip, friction none in approach.
    """

    start: Real = _energy()
    end: Real = _energy()
    normal_loss: Real = _energy()
    friction_work: Real = _energy()
    imbalance: Real = _energy()

    @property
    def relative_imbalance(self) -> Real:
        """Imbalance over the energy at the start, unit 1."""
        with np.errstate(under="ignore"):
            return self.imbalance / self.start

    def to_dict(self) -> dict[str, Any]:
        """Return the five entries and the relative imbalance as plain numbers or lists."""
        entries = attrs.asdict(self) | {"relative_imbalance": self.relative_imbalance}
        return {name: json_value(value) for name, value in entries.items()}


def ledger(scene: Scene, motion: Motion) -> EnergyLedger:
    """Return the energy books of ``motion``, in J, from its velocities and its friction work."""
    before = (scene.normal_speed, scene.slip_velocity)
    after = (motion.normal_velocity, motion.slip_velocity_change)
    return books(scene.pair, before, after, motion.friction_work)


def books(
    pair: Pair, before: tuple[Real, Real], after: tuple[Real, Real], friction_work: Real
) -> EnergyLedger:
    """Return the energy books from (rate, slip velocity) and (rate, change of slip velocity)."""
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
    """Return ``motion`` with status ``UNBALANCED`` where the energy books do not balance.

    The imbalance over the energy at the start exceeds ``bound``, or the bodies separate or slip
    faster than at first touch.
    """
    speed: Any = abs(motion.normal_velocity)
    fast = speed > LARGEST_RESTITUTION * scene.normal_speed
    if some(fast):
        detail = _sentences(
            "The bodies part {:.4g} times as fast as they met.", speed / scene.normal_speed
        )
        motion = motion.failing(fast, Status.UNBALANCED, detail)
    books = ledger(scene, motion)
    imbalance: Any = abs(books.imbalance)
    unbalanced = imbalance > bound * books.start
    if some(unbalanced):
        share = abs(books.relative_imbalance)
        detail = _sentences(
            f"Off by {{:.2g}} of the energy at the start; declared: {bound:.2g}.", share
        )
        motion = motion.failing(unbalanced, Status.UNBALANCED, detail)
    before: Any = abs(scene.slip_velocity)
    after: Any = abs(scene.slip_velocity + motion.slip_velocity_change)
    slips_fast = after > LARGEST_SLIP * before
    if some(slips_fast):
        detail = _sentences(
            "The contact slips {:.4g} times as fast as it met.", np.divide(after, before)
        )
        motion = motion.failing(slips_fast, Status.UNBALANCED, detail)
    return motion


def _sentences(sentence: str, numbers: Any) -> Any:
    """Return the sentence of each impact with its number filled in, in the shape of ``numbers``."""
    if not np.ndim(numbers):
        return sentence.format(float(numbers))
    sentences = [sentence.format(number) for number in np.ravel(numbers).tolist()]
    return np.array(sentences, dtype=object).reshape(np.shape(numbers))
