"""Integrators that break one clause of the contract each."""

from __future__ import annotations

import time

import attrs
import numpy as np

from contactlab import Status
from contactlab.contracts import (
    Increment,
    NormalContact,
    NormalMotion,
    NormalSample,
)
from contactlab.testing.faulty_laws import Unyielding
from tests.testing.fresh_faults import STEPS, Steps
from tests.testing.made import broken


class AlwaysSucceeds(Steps):
    def alter(self, motion, scene):
        success = np.full(scene.shape, Status.SUCCESS, dtype=object)
        numbers = {name: np.nan_to_num(getattr(motion, name))[()] for name in motion.numbers()}
        status = success if scene.shape else Status.SUCCESS
        return attrs.evolve(motion, status=status, **numbers)


class HeedsItsObserver(STEPS):
    def integrate(self, scene, normal, tangential, observer=None):
        motion = super().integrate(scene, normal, tangential, observer)
        return motion if observer is None else attrs.evolve(motion, friction_work=0.5)


class KeepsItsObserverWaiting(STEPS):
    def integrate(self, scene, normal, tangential, observer=None):
        return super().integrate(scene, normal, tangential, None)


class MeanOfTheBatch(Steps):
    """One change of velocity for all impacts of a batch."""

    def alter(self, motion, scene):
        change = np.mean(motion.slip_velocity_change) + 0.0 * motion.slip_velocity_change
        return attrs.evolve(motion, slip_velocity_change=change)


class Sloppy(Steps):
    """Of no order at all."""

    def alter(self, motion, scene):
        change = motion.slip_velocity_change * (1.0 + 1e-3)
        return attrs.evolve(motion, slip_velocity_change=change)


class ShortImpulse(Steps):
    """One per cent short of the impulse, of an order that it does not declare."""

    def alter(self, motion, scene):
        return attrs.evolve(motion, slip_velocity_change=0.99 * motion.slip_velocity_change)


class FirstLoad(STEPS):
    """The load of a step from its sample, as for a march of points: not the mean over it."""

    def integrate(self, scene, normal, tangential, observer=None):
        return super().integrate(scene, Pointwise(normal), tangential, observer)


class Pointwise(NormalMotion):
    """A normal motion whose load impulse is a rough sum."""

    def __init__(self, normal):
        self.normal, self.law, self.scene = normal, normal.law, normal.scene
        self.duration, self.maximum_radius = normal.duration, normal.maximum_radius
        self.maximum_approach, self.maximum_force = normal.maximum_approach, normal.maximum_force
        self.final_rate, self.status = normal.final_rate, normal.status
        self.total_load_impulse = normal.total_load_impulse

    def at(self, phase):
        time, approach, rate, contact, impulse = self.normal.at(phase)
        swing = 2.0 * np.pi * np.asarray(time) / self.duration
        rough = impulse + 1e-4 * self.total_load_impulse * (1.0 - np.cos(0.5 * swing))
        return NormalSample(time, approach, rate, contact, rough)

    def phase(self, fraction):
        return self.normal.phase(fraction)

    def take(self, part):
        return Pointwise(self.normal.take(part))


class ArrayOfOne(Steps):
    """An array where one number is due."""

    def alter(self, motion, scene):
        if scene.shape:
            return motion
        return attrs.evolve(motion, slip_velocity_change=np.array([motion.slip_velocity_change]))


class NamesNobody(Steps):
    """Says that something was raised, and not by whom."""

    def alter(self, motion, scene):
        raised = motion.status is Status.LAW_RAISED
        return attrs.evolve(motion, detail="Something was raised.") if raised else motion


class NamesNobodyAtTheStart(Steps):
    """Says who raised in a step, and not who raised before the first one."""

    def alter(self, motion, scene):
        first = motion.status is Status.LAW_RAISED and motion.detail.startswith("At step 0")
        return attrs.evolve(motion, detail="Something was raised.") if first else motion


class IgnoresItsSteps(STEPS):
    """As many steps as it likes, whatever is asked; it claims no order."""

    def integrate(self, scene, normal, tangential, observer=None):
        return STEPS(steps=50).integrate(scene, normal, tangential, observer)


class AsksTillItGives(STEPS):
    """Repeats a step of a stiff law until there is a force."""

    def integrate(self, scene, normal, tangential, observer=None):
        if isinstance(tangential, Unyielding):
            contact = NormalContact(1.0, 1.0, 1.0, 1.0)
            given, state = Increment(1.0, 1.0, 1.0, 1.0), tangential.start(scene, normal)
            while tangential.advance(state, given, contact, contact)[0].force == 0.0:
                pass
        return super().integrate(scene, normal, tangential, observer)


class ReadsNanAsTheEnd(STEPS):
    """Takes a normal contact that is not a number for none."""

    def integrate(self, scene, normal, tangential, observer=None):
        return super().integrate(scene, Mended(normal), tangential, observer)


class Mended(Pointwise):
    """Another normal motion, its NaN read as no contact."""

    def at(self, phase):
        time, approach, rate, contact, impulse = self.normal.at(phase)
        contact = NormalContact(*(np.nan_to_num(part) for part in contact))
        return NormalSample(
            time, np.nan_to_num(approach), np.nan_to_num(rate), contact, np.nan_to_num(impulse)
        )


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (AlwaysSucceeds, "faults_reported", "A fault in Hertz and FailingSpring reads as success"),
    (ReadsNanAsTheEnd, "normal_faults_reported", "A fault in SpoiledHertz and"),
    (NamesNobody, "faults_named", "FailingSpring raised, and is not named"),
    (NamesNobodyAtTheStart, "faults_named", "FailingSpring raised, and is not named"),
    (HeedsItsObserver, "observer_changes_nothing", "Watched, the friction_work is 0.5"),
    (KeepsItsObserverWaiting, "observer_changes_nothing", "The observer was not called"),
    (MeanOfTheBatch, "impact_batch", "Impact (0, 0) of a batch is off"),
    (Sloppy, "order", "Order 2 is promised by a count of steps, and 0.09 is found"),
    (IgnoresItsSteps, "finer_is_better", "Made finer, the error goes from"),
    (ShortImpulse, "sliding_impulse_by", "The impulse of sliding is 0.01 off"),
    (FirstLoad, "sliding_impulse_by", "The impulse of sliding is 0.0002 off"),
    (ArrayOfOne, "ends_well", "slip_velocity_change = array(["),
    (AsksTillItGives, "bounded", "Unyielding is called without end"),
    *broken(Steps, "alter",
        ("OneStatusForAll",
         lambda motion, scene: motion if not scene.shape else attrs.evolve(
             motion, status=Status.SUCCESS, detail=""),
         "impact_batch", "status has not the batch's shape"),
        ("TellsTheTime",
         lambda motion, *_: attrs.evolve(
             motion, friction_work=motion.friction_work + time.perf_counter()),
         "impact_repeatable", "run twice, ends differently"),
        ("ReturnsATuple", lambda motion, *_: (motion.slip_velocity_change, motion.friction_work),
         "ends_well", "The integrator returns a tuple"),
        ("WorkOfTheLastStage",
         lambda motion, *_: attrs.evolve(motion, friction_work=2.0 * motion.friction_work),
         "books_by", "of the energy is unaccounted"),
    ),
    *broken(STEPS, "needs",
        ("NoContract", frozenset({"stepped"}), "contract", "is a word that no check knows"),
        ("RunsNumbers", frozenset({int}), "contract", "must be words, or classes of laws"),
    ),
]  # fmt: skip
