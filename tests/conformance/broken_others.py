"""Normal laws and integrators that break one clause of the contract each."""

from __future__ import annotations

import time
from typing import ClassVar

import attrs
import numpy as np

import contactlab
from contactlab import Status
from contactlab.contracts import Motion, NormalContact, NormalLaw

HERTZ = contactlab.registry.REGISTRY.law_class("normal.hertz")
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


class KeepsItsObserverWaiting(Steps):
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


BROKEN = {
    Pulls: "presses",
    GivesMore: "normal_passive",
    Narrows: "grows",
    ReadsNanAsNoContact: "contacts_non_finite",
    InNewtons: "contacts_units",
    ComplexForce: "contacts",
    MeanApproach: "contacts_batch",
    NotItsMotion: "motion_agrees",
    Remembers: "contacts_pure",
    AlwaysSucceeds: "faults_reported",
    NamesNobody: "faults_named",
    HeedsItsObserver: "observer_changes_nothing",
    KeepsItsObserverWaiting: "observer_changes_nothing",
    OneStatusForAll: "impacts_batch",
    TellsTheTime: "integrator_pure",
    Sloppy: "order",
    Inelastic: "ends_well",
    GivesUpOnNothing: "bounded",
}
