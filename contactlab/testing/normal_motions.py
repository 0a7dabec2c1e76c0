"""Checks of the normal motion under a law, from first touch to separation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from contactlab.contracts import NormalContact, NormalLaw, NormalMotion
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing import limits
from contactlab.testing.check import apply_if, check, hold, within
from contactlab.testing.load_paths import bodies, scene
from contactlab.testing.normal import respond, strokes

#: Normal speeds of the impacts, over the speed of the kit's other impacts.
SPEEDS = (0.1, 1.0, 3.0)
#: Bound of the force at the end of contact, over the maximum: the overshoot of a polynomial.
END = 1e-3
#: Steps of a leg of a closed cycle, and the error of the trapezium rule, over the work moved.
LEG, QUADRATURE = 400, 3e-3
#: Rates over v1 of the legs of a cycle: press, release, press again, release.
RATES = (
    (0.05, 1.0),
    (1.0, 0.05),
    (0.5, 0.5),
    (0.0, 0.0),
    (0.05, 0.05, 1.0, 1.0),
    (0.3, 1.0, 0.05, 0.6),
)
#: Relative bound for solved motions, and for the difference between a motion alone and in a batch.
SOLVED = 1e-6


class _Stepwise(NormalLaw):
    """A law without its closed form: its motion is solved from ``respond``."""

    api_version = 2

    def __init__(self, law: NormalLaw) -> None:
        self.law = law

    def start(self, scene: Scene) -> object:
        return self.law.start(scene)

    def respond(self, state: object, approach: Real, rate: Real) -> tuple[NormalContact, object]:
        return self.law.respond(state, approach, rate)


def _pulls(motion: NormalMotion) -> bool:
    """Return whether the force is negative somewhere along a motion."""
    return bool(np.min(motion.at(np.linspace(0.0, np.pi, 101)).contact.force) < 0.0)


def impacts(law: NormalLaw) -> Iterator[NormalMotion]:
    """Iterate over motions of the law at several speeds, solved and in closed form.

    Raises
    ------
    NotApplicableError
        If adhesion holds the bodies together at every speed.
    """
    parted = 0
    for factor in SPEEDS:
        ball = scene(0.0, 1.0)
        impact = type(ball)(
            None, None, ball.friction_coefficient, factor * ball.normal_speed, 0.0, pair=ball.pair
        )
        for each in (_Stepwise(law), law):
            limits.begin(f"a normal motion at {factor} times the speed")
            motion = normal_motion(each, impact)
            if motion.status is Status.NOT_SEPARATED and _pulls(motion):
                continue  # adhesion holds slow bodies together
            hold(motion.status is Status.SUCCESS, f"An impact does not end: {motion.detail}")
            parted += 1
            yield motion
    apply_if(parted, "At no speed do the bodies part: adhesion holds them.")


@check(NormalLaw)
def normal_passive(law: NormalLaw) -> None:
    """A closed cycle that begins and ends out of contact gives no energy, at any rates.

    Cycles press slowly and release fast, or the reverse; some release in part and press again.
    """
    impact, stroke, _ = strokes()
    depth, speed = float(stroke.max()), float(impact.normal_speed)
    closed = 0
    for rates in RATES:
        knots = [0.0, depth, -0.2 * depth]
        if len(rates) > 2:
            knots = [0.0, depth, 0.6 * depth, 0.9 * depth, -0.2 * depth]
        legs = list(zip(knots, knots[1:], rates, strict=False))
        # At a turning point the rate is that of the leg before, then that of the leg after.
        approach = np.concatenate([np.linspace(start, stop, LEG + 1) for start, stop, _ in legs])
        rate = np.concatenate(
            [np.full(LEG + 1, share * speed * np.sign(stop - start)) for start, stop, share in legs]
        )
        force, _, overlap, _ = respond(law, impact, approach, rate)
        if overlap[-1] > 0.0:
            continue  # adhesion keeps contact: the cycle is not closed
        closed += 1
        mean = 0.5 * (force[1:] + force[:-1])
        work = mean * np.diff(approach)
        put_in = float(np.sum(np.abs(work)))
        gained = -float(work.sum())
        within(
            gained,
            QUADRATURE * put_in,
            f"A closed cycle at rates {rates} of v1 gives {gained:.3g} J from nothing, with "
            f"{put_in:.3g} J moved to and fro.",
        )
    apply_if(closed, "Adhesion holds the surfaces far behind first touch: no cycle is closed.")


@check(NormalLaw)
def rebounds(law: NormalLaw) -> None:
    """The bodies part no faster than v1, and the impulse of the force is the change of momentum."""
    from scipy.integrate import trapezoid  # help and lists import this file and need no scipy

    for motion in impacts(law):
        impact = motion.scene
        rebound = -float(motion.final_rate) / float(impact.normal_speed)
        hold(0.0 <= rebound <= 1.0 + SOLVED, f"The bodies part {rebound:.6g} times as fast.")
        momentum = impact.pair.normal_mass * (impact.normal_speed - float(motion.final_rate))
        sample = motion.at(np.linspace(0.0, np.pi, 2001))
        load = np.asarray(sample.contact.friction_load)
        impulse = trapezoid(np.asarray(sample.contact.force), np.asarray(sample.time))
        gap = abs(float(impulse) / float(momentum) - 1.0)
        within(gap, QUADRATURE, f"The force adds up to an impulse that is {gap:.2g} off.")
        gathered = float(trapezoid(load, np.asarray(sample.time)))
        gap = abs(gathered - float(motion.total_load_impulse)) / max(gathered, float(momentum))
        within(gap, QUADRATURE, f"The friction load's impulse is {gap:.2g} off its integral.")


@check(NormalLaw)
def ends_unloaded(law: NormalLaw) -> None:
    """The force is zero or negative when contact ends."""
    for motion in impacts(law):
        last = motion.at(np.asarray(np.pi)).contact
        left = float(last.force) / float(motion.maximum_force)
        within(
            left, END, f"Contact ends under load: the force is still {left:.2g} of the greatest."
        )


@check(NormalLaw)
def motion_batch(law: NormalLaw) -> None:
    """A batch of unlike bodies moves as each pair does alone (Integrator, 3)."""
    impact = scene(0.0, 1.0, bodies=bodies(4))
    limits.begin("the normal motion of a batch")
    together = normal_motion(law, impact)
    for place in range(4):
        limits.begin(f"the normal motion of impact {place} of a batch, alone")
        alone = normal_motion(law, impact.take(place))
        for name in (
            "duration", "maximum_radius", "maximum_approach", "maximum_force", "final_rate",
            "total_load_impulse",
        ):  # fmt: skip
            expected = float(getattr(alone, name))
            value = float(np.broadcast_to(getattr(together, name), impact.shape)[place])
            gap = abs(value - expected) / max(abs(expected), 1e-300)
            within(gap, SOLVED, f"The {name} of impact {place} of a batch is off by {gap:.1e}.")
