"""The motion of an impact, normal and tangential."""

from __future__ import annotations

import math
from collections.abc import Mapping
from operator import attrgetter
from typing import Any

import attrs
import numpy as np

from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.sampled_motion import Ends
from contactlab.contracts.status import Status
from contactlab.contracts.tangential_motion import TangentialMotion
from contactlab.contracts.whole_impact import WholeImpact
from contactlab.numeric.arrays import (
    are_zeros,
    choose,
    fill,
    finite,
    lock_arrays,
    shared,
    some,
    spread,
    zeros,
)
from contactlab.numeric.types import Array, Each, Real

#: Entries of ``Motion`` by the name of their source in a normal motion.
ENDS = {
    "duration": "duration",
    "normal_velocity": "final_rate",
    "maximum_radius": "maximum_radius",
    "maximum_approach": "maximum_approach",
    "maximum_force": "maximum_force",
}
#: Types of the entries of most motions of one impact, whose numbers are all floats.
USUAL = {float, Status, str, dict, type(None)}


@attrs.frozen(kw_only=True, eq=False, slots=False)  # frozen slots are slow to fill
class Motion(TangentialMotion[Each]):
    """A tangential motion with the duration, the maxima and the end of its normal motion.

    Attributes
    ----------
    duration : float or array
        Time of contact, in s.
    normal_velocity : float or array
        Rate of approach at the end, in m/s; negative: the bodies separate.
    maximum_radius, maximum_approach : float or array
        Greatest contact radius and approach, in m.
    maximum_force : float or array
        Greatest normal force, in N.
    exchange : float or array
        Energy in J that friction moved from the normal to the tangential motion, 0 unless the
        tangential law returned a normal motion of its own; NaN if the normal law does not declare
        its dissipation.
    compressions : float or array
        How often the approach grew: 1, or more where friction pressed the bodies together again.
    """

    duration: Each
    normal_velocity: Each
    maximum_radius: Each
    maximum_approach: Each
    maximum_force: Each
    exchange: Each | float = 0.0
    compressions: Each | float = 1.0

    def turn(self, along: Array) -> Motion:
        """Return the motion with its slip along unit vectors of the tangent plane, (..., 2)."""
        change = np.asarray(self.slip_velocity_change)[..., None] * along
        motion: Motion = self
        return attrs.evolve(motion, slip_velocity_change=lock_arrays(change))

    @staticmethod
    def combine(
        normal: NormalMotion,
        tangential: TangentialMotion | WholeImpact,
        axes: tuple[int, ...] = (),
    ) -> Motion:
        """Return the motion of one batch from its two parts; its arrays are read-only.

        ``tangential`` is the answer of one whole impact, or a motion; ``axes`` are those of a slip
        velocity beside the batch's.
        """
        shape = normal.scene.shape
        if not (shape or axes):
            ends: NormalMotion | Ends = normal
            exchange: Real = 0.0
            compressions: Real = 1.0
            if tangential.normal is not None:
                own = Ends.of(tangential.normal)
                if not math.isnan(own.final_rate):
                    ends, exchange, compressions = own, _exchange(normal, own), own.compressions
            alone: dict[str, Any] = {  # entry by entry: a loop would take most of the time
                "status": tangential.status,
                "detail": tangential.detail,
                "counters": tangential.counters,
                "slip_velocity_change": tangential.slip_velocity_change,
                "friction_work": tangential.friction_work,
                "shear_loss": tangential.shear_loss,
                "normal_spin_change": tangential.normal_spin_change,
                "normal": None,
                "contacts": None,
                "duration": ends.duration,
                "normal_velocity": ends.final_rate,
                "maximum_radius": ends.maximum_radius,
                "maximum_approach": ends.maximum_approach,
                "maximum_force": ends.maximum_force,
                "exchange": exchange,
                "compressions": compressions,
            }
            if {*map(type, alone.values())} != USUAL:
                for name in Motion.numbers():
                    alone[name] = float(alone[name])
            return fill(Motion, alone)
        entries: dict[str, Any] = {name: getattr(normal, source) for name, source in ENDS.items()}
        usual = {"exchange": zeros(shape), "compressions": shared(1.0, shape)}
        if tangential.normal is not None:
            entries |= _gather_ends(normal, tangential, entries)
            usual = {}
        entries["friction_work"] = tangential.friction_work
        for name in ("shear_loss", "normal_spin_change"):
            if are_zeros(value := getattr(tangential, name)):
                usual[name] = zeros(shape)
            else:
                entries[name] = value
        change = tangential.slip_velocity_change
        given: dict[str, Any] = usual | {
            name: lock_arrays(spread(value, shape)) for name, value in entries.items()
        }
        return Motion(
            **given,
            slip_velocity_change=lock_arrays(spread(change, (*shape, *axes))),
            status=lock_arrays(tangential.status),
            detail=lock_arrays(tangential.detail),
            counters=tangential.counters,
            contacts=getattr(tangential, "contacts", None),
        )


def _gather_ends(
    normal: NormalMotion, tangential: TangentialMotion | WholeImpact, entries: Mapping[str, Real]
) -> Mapping[str, Real]:
    """Return the entries of the normal motion that friction changed, and the exchange."""
    own = Ends.of(tangential.normal)
    # NaN, unequal to itself, where friction left the normal motion as it was.
    alone = own.final_rate != own.final_rate
    exchange, compressions = _exchange(normal, own), own.compressions
    if not some(alone):
        ends = {name: getattr(own, source) for name, source in ENDS.items()}
        return ends | {"exchange": exchange, "compressions": compressions}
    coupled = {
        name: choose(alone, entries[name], getattr(own, source)) for name, source in ENDS.items()
    }
    return coupled | {
        "exchange": choose(alone, 0.0, exchange),
        "compressions": choose(alone, 1.0, compressions),
    }


def _exchange(normal: NormalMotion, own: Ends) -> Real:
    """Return the energy in J that the normal motion lost, and the normal law did not take."""
    speed: Real = normal.scene.normal_speed
    rate = own.final_rate
    lost = 0.5 * normal.scene.pair.normal_mass * (speed * speed - rate * rate)
    moved: Real = lost - own.dissipation
    return moved


#: Numbers that a law must give if it answers both motions together.
MOVED = (
    "normal_velocity", "slip_velocity_change", "friction_work", "shear_loss", "normal_spin_change",
)  # fmt: skip
#: The numbers of a motion but the exchange, which may be undeclared, and the compressions.
CHECKED = (*MOVED, *(name for name in ENDS if name != "normal_velocity"))
#: Both lists of numbers of a motion: one call is faster than a loop over names.
_numbers, _moved = attrgetter(*CHECKED), attrgetter(*MOVED)


def all_finite(motion: Motion, coupled: bool) -> bool:
    """Return whether all numbers are finite, by their sum.

    ``coupled`` is that of ``sound``.
    """
    return finite(sum((_moved if coupled else _numbers)(motion)))


def sound(motion: Motion, *, coupled: bool = False) -> Motion:
    """Return ``motion`` with status ``NON_FINITE`` where a success holds a number not finite.

    Laws that answer both motions ``coupled``, and motions that no step can follow, need not know a
    duration or the maxima. Integrators
    check the quantities that they use; this check adds overflows in the conversion to SI, and
    quantities that an integrator does not check.
    """
    # If finite numbers overflow, each is looked at.
    if motion.status is Status.SUCCESS:
        if all_finite(motion, coupled):
            return motion
    elif not np.ndim(motion.status):
        return motion
    elif not coupled:
        with np.errstate(all="ignore"):
            if all_finite(motion, coupled):
                return motion
    names = MOVED if coupled else CHECKED
    values = {name: np.asarray(getattr(motion, name)) for name in names}
    change = values["slip_velocity_change"]
    if change.ndim > np.ndim(motion.status):
        values["slip_velocity_change"] = change.sum(axis=-1)
    good = np.all([np.isfinite(value) for value in values.values()], axis=0)
    if np.all(good):
        return motion
    bad = [name.replace("_", " ") for name, value in values.items() if not np.isfinite(value).all()]
    sentence = f"Not finite at the end of contact: {', '.join(bad)}."
    return motion.failing(~good, Status.NON_FINITE, sentence)


def without_failures(motion: Motion) -> Motion:
    """Return ``motion`` with NaN for every number of the impacts that failed."""
    good, shape = np.asarray(motion.status == Status.SUCCESS), np.shape(motion.status)
    numbers: dict[str, Any] = {}
    for name in Motion.numbers():
        value = np.asarray(getattr(motion, name))
        trailing = value.shape[len(shape) :]
        kept = np.where(good.reshape((*shape, *(1 for _ in trailing))), value, math.nan)
        numbers[name] = lock_arrays(spread(kept, (*shape, *trailing)))
    return attrs.evolve(motion, **numbers)
