"""A sound tangential law, and laws that break one clause of the contract each."""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.checks import POSITIVE, count, quantity
from contactlab.contracts import (
    Increment,
    NormalContact,
    Phase,
    PhasedTangentialLaw,
    PhaseResponse,
    RunningTangentialLaw,
    RunResponse,
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


class StiffensUnderLoad(Sound):
    """Remembers its stretch; its stiffness grows with the radius, and gives back more."""

    def start(self, problem):
        state = super().start(problem)
        return state._replace(stiffness=state.stiffness / problem.maximum_radius)

    def advance(self, state, increment, before, after):
        stiffness = state.stiffness * after.radius
        trial = state.force + increment.displacement  # the state keeps the stretch, in m
        limit = state.friction_coefficient * after.force
        force = np.minimum(np.maximum(stiffness * trial, -limit), limit)
        held = force / (stiffness + (stiffness == 0.0))
        response = TangentialResponse(force, np.maximum(force * (trial - held), 0.0))
        return response, state._replace(force=held)


class NeverQuiteSlips(Sound):
    """A slider of nine tenths of the friction."""

    def start(self, problem):
        state = super().start(problem)
        return state._replace(friction_coefficient=0.9 * state.friction_coefficient)


class FieldsOfText(Sound):
    def fields(self, state):
        return {"stuck": "all of it"}


class ChangesWhenAsked(Sound):
    """Keeps its force in an array, and lets go where it is asked for fields."""

    def start(self, problem):
        state = super().start(problem)
        return state._replace(force=np.array(state.force))

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        return response, new._replace(force=np.array(new.force))

    def fields(self, state):
        state.force[...] = 0.0
        return {}


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


class Running(Sound, RunningTangentialLaw):
    """Takes all steps at once, which for a law of one spring is the same loop."""

    runs_batches: ClassVar[bool] = True

    def run(self, problem, run):
        state, velocity, forces, work = self.start(problem), run.velocity, [], 0.0
        contact = NormalContact(0.0, 0.0, 0.0)
        for force, radius, drift, kick in zip(*run[:4], strict=True):
            before, contact = contact, NormalContact(force, radius, radius)
            arresting = velocity * run.mass / kick
            given = Increment(velocity * drift, velocity, arresting, force, kick)
            response, state = self.advance(state, given, before, contact)
            velocity = velocity - response.force * kick / run.mass
            forces.append(response.force)
            work = work + response.friction_work
        return self.ran(problem, RunResponse(np.array(forces), work, True))

    def ran(self, problem, response):
        return response


class RunsOtherwise(Running):
    """A little weaker where all steps are taken at once."""

    def ran(self, problem, response):
        return response._replace(force=0.99 * response.force)


class RunsTheMeanOfABatch(Running):
    """Right one by one; at once, one force for all impacts of a batch."""

    def ran(self, problem, response):
        if not problem.shape:
            return response
        mean = np.mean(response.force, axis=1, keepdims=True)
        return response._replace(force=0.0 * response.force + mean)


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


@attrs.frozen(kw_only=True)
class TakesAnyFlag(Sound):
    flag: bool = False


@attrs.frozen(kw_only=True)
class TwoRequired(Sound):
    """Sound, with parameters that have no defaults."""

    stretch: float = quantity("m", rule=POSITIVE)
    count: int = count()


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


class PushesAlong(Phases):
    """Speeds slip up."""

    force: ClassVar[float] = -0.5


class SlipsWhateverItClaims(Phases):
    offers: ClassVar[frozenset] = frozenset({"phases", "partial_slip"})


class PhaseInMetres(Phases):
    """Weaker in a wide contact, by a constant with a unit."""

    def begin(self, velocity, inertia, motion):
        return Slide(1.0 / (1.0 + 100.0 * motion.maximum_radius), self.power)


IMPACTS = {"count": 0}


class Wears(Phases):
    """Weaker with every impact that any such law has seen."""

    def begin(self, velocity, inertia, motion):
        IMPACTS["count"] += 1
        return Slide(1.0 / (1.0 + 0.01 * IMPACTS["count"]), self.power)


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (SoftUnloading, "closed_cycles", "give 0.045 of energy"),
    (KeepsForceAsItSoftens, "partial_unloading", "given back"),
    (StiffensUnderLoad, "random_paths", "A random path at varying normal load gives"),
    (ChangesItsState, "pure", "tried and thrown away changed the next one"),
    (NanAtOneStep, "answers", "force = np.float64(nan) at step 8"),
    (WrongShape, "answers", "force = array([[0.]])"),
    (ReturnsNone, "answers", "advance returned None"),
    (ReturnsComplex, "answers", "force = np.complex128(0j)"),
    (ReturnsText, "answers", "friction_work = 'much'"),
    (Raises, "answers", "Raised KeyError: 'stiffness'"),
    (WrongSign, "opposes_slip", "A first, positive slip meets a force of -0.59"),
    (HalfTheWork, "books", "50.0% of it is not in the books"),
    (HalfTheWork, "impact_books", "of the energy is in no book (by Symplectic)"),
    (NegativeWork, "friction_work", "Friction work of -0.12 in one step"),
    (HidesNan, "non_finite", "NaN as slip gives F = np.float64(0.0)"),
    (Relaxes, "turning_points", "off twice the loading curve"),
    (FeelsNormalLoad, "normal_load_alone", "Pressing alone makes F = 0.00037"),
    (FeelsNormalLoad, "impact_central", "psi1 = 0 gives psi2 ="),
    (HiddenMemory, "repeatable", "Interleaved with another"),
    (NotOdd, "odd_in_slip", "Reversed slip gives a force that differs"),
    (NotOdd, "impact_odd", "chi = 0.4: differs by"),
    (NoLimit, "coulomb_limit", "abs(F) exceeds mu P by 1.4"),
    (NeverQuiteSlips, "gross_slip", "F = 0.5271 mu P_max where mu P is 0.5857"),
    (HoldsOn, "separation", "out of contact"),
    (FieldsOfText, "fields", "fields['stuck'] = 'all of it'"),
    (ChangesWhenAsked, "fields", "Asking for the fields changed the state"),
    (InNewtonsPerMetre, "units", "In other units the answer differs"),
    (UnderstatesStiffness, "stiffness", "2 times the stiffness it states"),
    (MeanOfTheBatch, "batch", "Contact 0 of a batch is off"),
    (ClaimsPartialSlip, "cattaneo_mindlin", "off Cattaneo and Mindlin's"),
    (SaysItSlips, "slips_throughout", "off the law's own run"),
    (RunsOtherwise, "run_equals_steps", "differs by"),
    (RunsTheMeanOfABatch, "impact_batch", "An impact of a batch is off"),
    (WrongVersion, "api_version", "api_version = 2"),
    (ExpectsWithoutReason, "expected_failures", "'units' needs a reason"),
    (ExpectsTheUnknown, "expected_failures", "'unit', which is not a check"),
    (OffersNothing, "contract", "nobody can run it"),
    (Mutable, "immutable", "ratio can be set"),
    (CannotBePickled, "copies", "Can't pickle local object"),
    (TakesAnything, "parameters", "extra = nan: taken without a word"),
    (TakesAnyFlag, "parameters", "flag = nan: taken without a word"),
    (TooStrong, "impact_coulomb_limit", "abs(F) exceeds mu P by 0.2"),
    (TooWeakInTheBooks, "impact_books", "UNRESOLVED The energy books miss"),
    (PhaseOfNan, "impact_odd", "UNRESOLVED Newton's method fails"),
    (PushesAlong, "impact_bounds", "energy from nothing (by Events)"),
    (SlipsWhateverItClaims, "impact_reference", "off (by Events)"),
    (PhaseInMetres, "impact_units", "differs by"),
    (Wears, "impact_repeatable", "run twice, ends differently"),
]
