"""Normal laws and integrators that break one clause of the contract each."""

from __future__ import annotations

import time
from typing import ClassVar

import attrs
import numpy as np

import contactlab
from contactlab import Scene, Status
from contactlab.contracts import ClosedFormNormalLaw, Motion, NormalContact, NormalLaw

HERTZ = contactlab.registry.REGISTRY.law_class("normal.hertz")
MOTION = type(HERTZ().motion(Scene.nondimensional(psi1=0.0, chi=1.0).pair, 1.0))
STEPS = contactlab.registry.REGISTRY.law_class("integrator.symplectic")


class Altered(HERTZ):
    """Hertz's law with something done to the contact."""

    def alter(self, contact, approach, rate):
        raise NotImplementedError

    def respond(self, state, approach, rate):
        contact, state = super().respond(state, approach, rate)
        return self.alter(contact, approach, rate), state


class Pulls(Altered):
    def alter(self, contact, approach, rate):
        return contact._replace(force=contact.force - 1.0)


class GivesMore(Altered):
    """Harder on the way out than on the way in."""

    def alter(self, contact, approach, rate):
        return contact._replace(force=contact.force * np.where(rate < 0.0, 1.1, 1.0)[()])


class Narrows(Altered):
    def alter(self, contact, approach, rate):
        return contact._replace(radius=contact.radius * (1.0 - 0.8 * (approach > 1e-5)))


class ReadsNanAsNoContact(Altered):
    def alter(self, contact, approach, rate):
        return NormalContact(*[np.nan_to_num(part)[()] for part in contact])


class InNewtons(Altered):
    def alter(self, contact, approach, rate):
        return contact._replace(force=contact.force * (1.0 + 1e-6 * contact.force))


class ComplexForce(Altered):
    def alter(self, contact, approach, rate):
        return contact._replace(force=contact.force + 0j)


class MeanApproach(Altered):
    def alter(self, contact, approach, rate):
        return contact._replace(force=np.mean(contact.force) + 0.0 * contact.force)


class NotItsMotion(Altered):
    """Stiffer than its closed form says."""

    def alter(self, contact, approach, rate):
        return contact._replace(force=1.01 * contact.force)


@attrs.frozen(kw_only=True)
class Remembers(NormalLaw):
    """Writes into its state."""

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset] = frozenset({"radius"})

    def start(self, pair):
        return [0.0]

    def respond(self, state, approach, rate):
        state[0] = np.maximum(state[0], approach)
        deep = approach * (approach > 0.0)
        return NormalContact(1e6 * state[0] * (deep > 0.0), deep, approach), state


class Moving(HERTZ):
    """Hertz's law with something done to its motion in closed form."""

    moving: ClassVar[type] = MOTION

    def motion(self, pair, speed):
        return self.moving.of(pair, speed)


class MovesAsIfHeavier(Moving):
    """A Hertz impact, of a mass that is not the pair's."""

    def motion(self, pair, speed):
        return super().motion(attrs.evolve(pair, normal_mass=1.1 * pair.normal_mass), speed)


class Hurried(MOTION):
    """A pace in plain floats that is not that of the arrays."""

    def instant(self, phase):
        here = super().instant(phase)
        return here._replace(pace=1.01 * here.pace)


class InstantOffCourse(Moving):
    moving: ClassVar[type] = Hurried


class Steps(STEPS):
    """The symplectic scheme with something done to its motion."""

    def alter(self, motion, problem, observer):
        raise NotImplementedError

    def integrate(self, problem, observer=None):
        return self.alter(super().integrate(problem, observer), problem, observer)


class AlwaysSucceeds(Steps):
    def alter(self, motion, problem, observer):
        success = np.full(problem.shape, Status.SUCCESS, dtype=object)
        return attrs.evolve(motion, status=success if problem.shape else Status.SUCCESS)


class HeedsItsObserver(Steps):
    def alter(self, motion, problem, observer):
        return motion if observer is None else attrs.evolve(motion, duration=0.5)


class KeepsItsObserverWaiting(STEPS):
    def integrate(self, problem, observer=None):
        return super().integrate(problem, None)


class OneStatusForAll(Steps):
    def alter(self, motion, problem, observer):
        return attrs.evolve(motion, status=Status.SUCCESS) if problem.shape else motion


class TellsTheTime(Steps):
    def alter(self, motion, problem, observer):
        return attrs.evolve(motion, friction_work=motion.friction_work + time.perf_counter())


class Sloppy(Steps):
    """Of no order at all."""

    def alter(self, motion, problem, observer):
        change = motion.slip_velocity_change * (1.0 + 1e-3)
        return attrs.evolve(motion, slip_velocity_change=change)


class Inelastic(Steps):
    def alter(self, motion, problem, observer):
        return attrs.evolve(motion, normal_velocity=0.5 * motion.normal_velocity)


class GivesUpOnNothing(Steps):
    """Takes contact without end for an answer."""

    def alter(self, motion, problem, observer):
        if motion.status is not Status.NOT_SEPARATED:
            return motion
        return Motion(
            duration=1.0, normal_velocity=-1.0, slip_velocity_change=0.0, friction_work=0.0
        )


class NamesNobody(Steps):
    """Says that something was raised, and not by whom."""

    def alter(self, motion, problem, observer):
        raised = motion.status is Status.LAW_RAISED
        return attrs.evolve(motion, detail="Something was raised.") if raised else motion


class IgnoresItsSteps(STEPS):
    """As many steps as it likes, whatever is asked; it claims no order."""

    order: ClassVar[int | None] = None

    def integrate(self, problem, observer=None):
        return STEPS(steps=50).integrate(problem, observer)


@attrs.frozen(kw_only=True)
class Mended(NormalLaw):
    """Another normal law, its NaN read as no contact."""

    api_version: ClassVar[int] = 1
    law: NormalLaw

    def start(self, pair):
        return self.law.start(pair)

    def respond(self, state, approach, rate):
        contact, state = self.law.respond(state, approach, rate)
        return NormalContact(*[float(np.nan_to_num(part)) for part in contact]), state


class ReadsNanAsTheEnd(STEPS):
    """Ends an impact where the normal law has no answer, however few steps it has lasted."""

    def integrate(self, problem, observer=None):
        if isinstance(problem.normal, ClosedFormNormalLaw) or problem.shape:
            return super().integrate(problem, observer)
        problem = attrs.evolve(problem, normal=Mended(law=problem.normal))
        motion = super().integrate(problem, observer)
        short = motion.status is Status.TOO_FEW_STEPS
        return attrs.evolve(motion, status=Status.SUCCESS, detail="") if short else motion


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (Pulls, "presses", "A force of -1 N pulls"),
    (GivesMore, "normal_passive", "gives back 0.025"),
    (Narrows, "grows", "The radius falls by 0.8"),
    (ReadsNanAsNoContact, "contacts_non_finite", "An approach of NaN gives a force of 0.0"),
    (InNewtons, "contacts_units", "In other units the force differs"),
    (ComplexForce, "contacts", "force = 0j"),
    (MeanApproach, "contacts_batch", "Contact 0 of a batch is off"),
    (NotItsMotion, "motion_agrees", "The force of the motion is 1.0e-02 off"),
    (MovesAsIfHeavier, "motion_obeys_newton", "The rate is"),
    (InstantOffCourse, "motion_scaled", "off course"),
    (Remembers, "contacts_pure", "The state that went in was changed"),
    (AlwaysSucceeds, "faults_reported", "A fault in Hertz and FailingSpring reads as success"),
    (ReadsNanAsTheEnd, "normal_faults_reported", "A fault in LinearPress and"),
    (NamesNobody, "faults_named", "FailingSpring raised, and is not named"),
    (HeedsItsObserver, "observer_changes_nothing", "Watched, the duration is 0.5"),
    (KeepsItsObserverWaiting, "observer_changes_nothing", "The observer was not called"),
    (OneStatusForAll, "impacts_batch", "status has not the batch's shape"),
    (TellsTheTime, "integrator_pure", "run twice, ends differently"),
    (Sloppy, "order", "Order 2 is declared, and 0.10 is found"),
    (IgnoresItsSteps, "finer_is_better", "Made finer, the error goes from"),
    (Inelastic, "ends_well", "An elastic impact ends at 0.415 m/s"),
    (GivesUpOnNothing, "bounded", "is said to have ended"),
]
