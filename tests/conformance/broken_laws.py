"""A sound tangential law, and laws that break one clause of the contract each."""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.checks import POSITIVE, quantity
from contactlab.contracts import (
    Phase,
    PhasedTangentialLaw,
    PhaseResponse,
    SteppedTangentialLaw,
    TangentialResponse,
)


class Spring(NamedTuple):
    stiffness: Any
    friction_coefficient: Any
    force: Any


@attrs.frozen(kw_only=True)
class Sound(SteppedTangentialLaw):
    """A spring of one stiffness and a slider: keeps every clause, claims no partial slip."""

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset] = frozenset({"advance"})
    needs: ClassVar[frozenset] = frozenset({"steps"})

    ratio: float = quantity("1", rule=POSITIVE, default=0.7)

    def stiffness(self, problem):
        return self.ratio * 2.0 * problem.pair.effective_shear_modulus * problem.maximum_radius

    def start(self, problem):
        nothing = np.zeros(problem.shape) if problem.shape else 0.0
        return Spring(self.stiffness(problem), problem.friction_coefficient, nothing)

    def advance(self, state, increment, before, after):
        trial = state.force + state.stiffness * increment.displacement
        limit = state.friction_coefficient * after.force
        force = np.minimum(np.maximum(trial, -limit), limit)
        slip = (trial - force) / state.stiffness
        return TangentialResponse(force, force * slip), state._replace(force=force)


class SoftUnloading(Sound):
    """Gives back at half the stiffness, and so over twice the way."""

    def advance(self, state, increment, before, after):
        given = increment
        if not np.shape(state.force) and state.force * increment.displacement < 0.0:
            given = increment._replace(displacement=0.5 * increment.displacement)
        return super().advance(state, given, before, after)


class KeepsForceAsItSoftens(Sound):
    """Stiffness in proportion to the radius, force kept as the radius falls."""

    def advance(self, state, increment, before, after):
        full = state.stiffness
        soft = state._replace(stiffness=1e4 * after.radius * full + (after.radius == 0.0))
        response, new = super().advance(soft, increment, before, after)
        return response, new._replace(stiffness=full)


class ChangesItsState(Sound):
    """Keeps its force in an array and writes into it."""

    def start(self, problem):
        state = super().start(problem)
        return state._replace(force=np.array(state.force))

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        state.force[...] = new.force
        return response, state


class NanAtOneStep(Sound):
    """NaN once, in a certain range of normal load."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        if np.all(state.force != 0.0) and np.any(np.abs(increment.displacement) > 1e-7):
            response = response._replace(force=response.force * np.nan)
        return response, new


class WrongShape(Sound):
    """An array of one where a number is due."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        return response._replace(force=np.atleast_1d(response.force)[None]), new


class Answering(Sound):
    """Answers something else altogether."""

    def answer(self, response, state):
        raise NotImplementedError

    def advance(self, state, increment, before, after):
        return self.answer(*super().advance(state, increment, before, after))


class ReturnsNone(Answering):
    def answer(self, response, state):
        return None


class ReturnsComplex(Answering):
    def answer(self, response, state):
        return response._replace(force=response.force + 0j), state


class ReturnsText(Answering):
    def answer(self, response, state):
        return response._replace(friction_work="much"), state


class Raises(Answering):
    def answer(self, response, state):
        raise KeyError("stiffness")


class WrongSign(Answering):
    """Pushes the way the body goes."""

    def answer(self, response, state):
        return response._replace(force=-response.force), state


class HalfTheWork(Answering):
    def answer(self, response, state):
        return response._replace(friction_work=0.5 * response.friction_work), state


class NegativeWork(Answering):
    def answer(self, response, state):
        return response._replace(friction_work=-response.friction_work), state


class HidesNan(Answering):
    def answer(self, response, state):
        return response._replace(force=np.nan_to_num(response.force)), state


class Relaxes(Answering):
    """Forgets a part of its force in every step."""

    def answer(self, response, state):
        return response, state._replace(force=0.9 * state.force)


class FeelsNormalLoad(Sound):
    """A force from normal load alone."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        push = 0.01 * state.friction_coefficient * (after.force - before.force)
        return response._replace(force=response.force + push), new


MEMORY = {"force": 0.0}


class HiddenMemory(Sound):
    """Keeps its force where every run finds it."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(
            state._replace(force=MEMORY["force"]), increment, before, after
        )
        MEMORY["force"] = new.force
        return response, new


class NotOdd(Sound):
    """Slips sooner one way than the other."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        limit = 0.8 * state.friction_coefficient * after.force
        force = np.maximum(response.force, -limit)
        return response._replace(force=force), new._replace(force=force)


class NoLimit(Sound):
    """Sticks whatever the load, as long as there is one."""

    def advance(self, state, increment, before, after):
        force = (state.force + state.stiffness * increment.displacement) * (after.force > 0.0)
        return TangentialResponse(force, 0.0 * force), state._replace(force=force)


class HoldsOn(Sound):
    """Pulls a little when the bodies have parted."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        held = 1e-3 * state.force * (after.force == 0.0)
        return response._replace(force=response.force + held), new._replace(force=new.force + held)


class InNewtonsPerMetre(Sound):
    """A constant with a unit, in the middle of the code."""

    def start(self, problem):
        state = super().start(problem)
        return state._replace(stiffness=0.0 * state.stiffness + 2e7)

    def stiffness(self, problem):
        return 2e7


class UnderstatesStiffness(Sound):
    def start(self, problem):
        state = super().start(problem)
        return state._replace(stiffness=2.0 * state.stiffness)


class MeanOfTheBatch(Sound):
    """One displacement for all."""

    def advance(self, state, increment, before, after):
        mean = increment._replace(
            displacement=0.0 * increment.displacement + np.mean(increment.displacement)
        )
        return super().advance(state, mean, before, after)


class ClaimsPartialSlip(Sound):
    offers: ClassVar[frozenset] = frozenset({"advance", "partial_slip"})


class SaysItSlips(Sound):
    def slips_throughout(self, psi1, chi):
        return np.abs(psi1) > 0.0


class WrongVersion(Sound):
    api_version: ClassVar[int] = 2


class ExpectsTooMuch(Sound):
    expected_failures: ClassVar[dict] = {"units": "it says so, but it is not so"}


class ExpectsWithoutReason(Sound):
    expected_failures: ClassVar[dict] = {"units": ""}


class ExpectsTheUnknown(Sound):
    expected_failures: ClassVar[dict] = {"unit": "there is no such check at all"}


class OffersNothing(Sound):
    offers: ClassVar[frozenset] = frozenset()


@attrs.define(kw_only=True)
class Mutable(Sound):
    def __setattr__(self, name, value):
        object.__setattr__(self, name, value)


@attrs.frozen(kw_only=True)
class CannotBePickled(Sound):
    rule: Any = attrs.field(factory=lambda: lambda value: value)


@attrs.frozen(kw_only=True)
class TakesAnything(Sound):
    extra: float = 1.0


@attrs.frozen
class Slide(Phase):
    """Gross slip with a factor on the force and one on its power."""

    force: float
    power: float

    def respond(self, contact, slip, memo):
        return PhaseResponse(self.force * contact.force, None, None, ())

    def friction_power(self, contact, slip, velocity, response):
        return self.power * self.force * contact.force * velocity


@attrs.frozen(kw_only=True)
class Phases(PhasedTangentialLaw):
    """Slips in one direction for ever."""

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset] = frozenset({"phases"})
    needs: ClassVar[frozenset] = frozenset({"events"})
    force: ClassVar[float] = 1.0
    power: ClassVar[float] = 1.0

    def begin(self, velocity, inertia, motion):
        return Slide(self.force, self.power)


class TooStrong(Phases):
    force: ClassVar[float] = 1.2


class TooWeakInTheBooks(Phases):
    power: ClassVar[float] = 0.5


class PhaseOfNan(Phases):
    force: ClassVar[float] = float("nan")


BROKEN = {
    SoftUnloading: "closed_cycles",
    KeepsForceAsItSoftens: "partial_unloading",
    ChangesItsState: "pure",
    NanAtOneStep: "answers",
    WrongShape: "answers",
    ReturnsNone: "answers",
    ReturnsComplex: "answers",
    ReturnsText: "answers",
    Raises: "answers",
    WrongSign: "opposes_slip",
    HalfTheWork: "books",
    NegativeWork: "friction_work",
    HidesNan: "non_finite",
    Relaxes: "turning_points",
    FeelsNormalLoad: "normal_load_alone",
    HiddenMemory: "repeatable",
    NotOdd: "odd_in_slip",
    NoLimit: "coulomb_limit",
    HoldsOn: "separation",
    InNewtonsPerMetre: "units",
    UnderstatesStiffness: "stiffness",
    MeanOfTheBatch: "batch",
    ClaimsPartialSlip: "cattaneo_mindlin",
    SaysItSlips: "slips_throughout",
    WrongVersion: "api_version",
    ExpectsWithoutReason: "expected_failures",
    ExpectsTheUnknown: "expected_failures",
    OffersNothing: "contract",
    Mutable: "immutable",
    CannotBePickled: "copies",
    TakesAnything: "parameters",
    TooStrong: "impact_coulomb_limit",
    TooWeakInTheBooks: "impact_books",
    PhaseOfNan: "impact_odd",
}
