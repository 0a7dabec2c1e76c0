"""A sound stepped law, and stepped laws that break one clause of the contract each."""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import SteppedTangentialLaw, TangentialResponse
from contactlab.impact.hertz import hertz_scales
from contactlab.numeric.checks import POSITIVE, quantity
from tests.testing.made import altered, broken


class Spring(NamedTuple):
    stiffness: Any
    friction_coefficient: Any
    force: Any


class Two(NamedTuple):
    stiffness: Any
    radius: Any


@attrs.frozen(kw_only=True)
class Sound(SteppedTangentialLaw):
    """A spring of one stiffness and a slider: keeps every clause, claims no partial slip."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset] = frozenset({"radius"})

    ratio: float = quantity("1", rule=POSITIVE, default=0.7)

    def stiffness(self, scene, normal):
        return self.ratio * 2.0 * scene.pair.effective_shear_modulus * normal.maximum_radius

    def start(self, scene, normal):
        nothing = np.zeros(scene.shape) if scene.shape else 0.0
        return Spring(self.stiffness(scene, normal), scene.friction_coefficient, nothing)

    def advance(self, state, increment, before, after):
        trial = state.force + state.stiffness * increment.displacement
        limit = state.friction_coefficient * after.friction_load
        force = np.minimum(np.maximum(trial, -limit), limit)
        slip = (trial - force) / state.stiffness
        work = np.maximum(0.5 * (force + state.force) * slip, 0.0)
        return TangentialResponse(force, work), state._replace(force=force)


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

    def start(self, scene, normal):
        state = super().start(scene, normal)
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


class Answering(Sound):
    """Answers something else altogether."""

    def answer(self, response, state):
        raise NotImplementedError

    def advance(self, state, increment, before, after):
        return self.answer(*super().advance(state, increment, before, after))


class ReturnsNone(Answering):
    def answer(self, response, state):
        return None


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


class RatioOfLoads(Sound):
    """Work of the mean load, by way of a ratio to the load that is left."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        left = after.friction_load + (after.friction_load == 0.0)
        ratio = np.where(after.friction_load > 0.0, increment.friction_load / left, 1.0)[()]
        return response._replace(friction_work=ratio * response.friction_work), new


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
        limit = 0.8 * state.friction_coefficient * after.friction_load
        force = np.maximum(response.force, -limit)
        return response._replace(force=force), new._replace(force=force)


class NoLimit(Sound):
    """Sticks whatever the load, as long as there is one."""

    def advance(self, state, increment, before, after):
        force = (state.force + state.stiffness * increment.displacement) * (
            after.friction_load > 0.0
        )
        return TangentialResponse(force, 0.0 * force), state._replace(force=force)


class StiffensUnderLoad(Sound):
    """Remembers its stretch; its stiffness grows with the radius, and gives back more."""

    def start(self, scene, normal):
        state = super().start(scene, normal)
        return state._replace(stiffness=state.stiffness / normal.maximum_radius)

    def advance(self, state, increment, before, after):
        stiffness = state.stiffness * after.radius
        trial = state.force + increment.displacement  # the state keeps the stretch, in m
        limit = state.friction_coefficient * after.friction_load
        force = np.minimum(np.maximum(stiffness * trial, -limit), limit)
        held = force / (stiffness + (stiffness == 0.0))
        response = TangentialResponse(force, np.maximum(force * (trial - held), 0.0))
        return response, state._replace(force=held)


class ChangesWhenAsked(Sound):
    """Keeps its force in an array, and lets go where it is asked for fields."""

    def start(self, scene, normal):
        state = super().start(scene, normal)
        return state._replace(force=np.array(state.force))

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        return response, new._replace(force=np.array(new.force))

    def fields(self, state):
        state.force[...] = 0.0
        return {}


class InNewtonsPerMetre(Sound):
    """A constant with a unit, in the middle of the code."""

    def start(self, scene, normal):
        state = super().start(scene, normal)
        return state._replace(stiffness=0.0 * state.stiffness + 2e7)

    def stiffness(self, scene, normal):
        return 2e7


class MeanOfTheBatch(Sound):
    """One displacement for all."""

    def advance(self, state, increment, before, after):
        mean = increment._replace(
            displacement=0.0 * increment.displacement + np.mean(increment.displacement)
        )
        return super().advance(state, mean, before, after)


class Misstating(Sound):
    """States another stiffness than its spring has."""

    def stated(self, true, scene):
        raise NotImplementedError

    def start(self, scene, normal):
        return super().start(scene, normal)._replace(stiffness=super().stiffness(scene, normal))

    def stiffness(self, scene, normal):
        return self.stated(super().stiffness(scene, normal), scene)


class StiffWhereLarge(Sound):
    """As stiff as it states up to half of the largest radius, and twice as stiff beyond."""

    def start(self, scene, normal):
        return super().start(scene, normal)._replace(stiffness=self._largest(scene, normal))

    def _largest(self, scene, normal):
        return Two(super().stiffness(scene, normal), 0.9 * normal.maximum_radius)

    def advance(self, state, increment, before, after):
        large = after.radius > state.stiffness.radius
        used = state._replace(stiffness=state.stiffness.stiffness * np.where(large, 2.0, 1.0)[()])
        response, new = super().advance(used, increment, before, after)
        return response, new._replace(stiffness=state.stiffness)


class WritesIntoIt(Sound):
    """Damps what it was given, in place."""

    def advance(self, state, increment, before, after):
        velocity = increment.velocity
        velocity *= 0.999
        return super().advance(state, increment, before, after)


class LimitOfTheForce(Sound):
    """Coulomb's limit of the normal force, which may be a pull."""

    def advance(self, state, increment, before, after):
        pressed = after._replace(friction_load=abs(after.force))
        return super().advance(state, increment, before, pressed)


def held(state, after):
    """A little of the force, where the bodies have parted."""
    return 1e-3 * state.force * (after.friction_load == 0.0)


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (SoftUnloading, "closed_cycles", "give 0.045 of energy"),
    (KeepsForceAsItSoftens, "partial_unloading", "given back"),
    (StiffensUnderLoad, "random_paths", "A random path at varying normal load gives"),
    (ChangesItsState, "pure", "tried and thrown away changed the next one"),
    (NanAtOneStep, "answers", "at step 8"),
    (ReturnsNone, "answers", "advance returned None"),
    (Raises, "answers", "Raised KeyError: 'stiffness'"),
    (WrongSign, "opposes_slip", "A first, positive slip meets a force of -0.59"),
    (HalfTheWork, "books", "50.0% of it is not in the books"),
    (HalfTheWork, "impact_books", "of the energy is unaccounted (HalfTheWork by Symplectic)"),
    (RatioOfLoads, "last_step", "as the load falls to zeta = 1e-06"),
    (HiddenMemory, "repeatable", "Interleaved with another"),
    (NotOdd, "odd_in_slip", "Reversed slip gives a force that differs"),
    (NotOdd, "impact_odd", "chi = 0.4: differs by"),
    (NoLimit, "coulomb_limit", "abs(F) exceeds mu P by 1.4"),
    (ChangesWhenAsked, "fields", "Asking for the fields changed the state"),
    (InNewtonsPerMetre, "units", "In other units the answer differs"),
    (StiffWhereLarge, "stiffness", "2 times the stiffness it states, at zeta = 1.0 under Hertz"),
    (LimitOfTheForce, "tension",
     "Under tension abs(F) exceeds mu times a friction load of 0 P_max"),
    (WritesIntoIt, "read_only", "The law writes into what it was given"),
    (MeanOfTheBatch, "batch", "Contact 0 of a batch that differs in friction_coefficient only"),
    *broken(Answering, "answer",
        ("ReturnsComplex",
         lambda response, state: (response._replace(force=response.force + 0j), state),
         "answers", "0j"),
        ("ReturnsText", lambda response, state: (response._replace(friction_work="much"), state),
         "answers", "friction_work = 'much'"),
        ("NegativeWork",
         lambda response, state: (response._replace(friction_work=-response.friction_work), state),
         "friction_work", "Friction work of -0.1"),
        ("HidesNan",
         lambda response, state: (response._replace(force=np.nan_to_num(response.force)), state),
         "non_finite", "NaN as slip gives F = "),
        ("Relaxes", lambda response, state: (response, state._replace(force=0.9 * state.force)),
         "turning_points", "off twice the loading curve"),
    ),
    *broken(Sound, "fields",
        ("FieldsOfText", lambda *_: {"stuck": "all of it"},
         "fields", "fields['stuck'] = 'all of it'"),
    ),
    *broken(Sound, "offers",
        ("ClaimsPartialSlip", frozenset({"partial_slip"}),
         "cattaneo_mindlin", "off Cattaneo and Mindlin's"),
    ),
    *altered(Sound, "advance",
        ("WrongShape", lambda response, new, *_: (
            response._replace(force=np.atleast_1d(response.force)[None]), new),
         "answers", "force = array([[0.]])"),
        ("FeelsNormalLoad", lambda response, new, state, _, before, after: (response._replace(
            force=response.force + 0.01 * state.friction_coefficient * (
                after.friction_load - before.friction_load)), new),
         "normal_load_alone", "Pressing alone makes F = 0.00037",
         "impact_central", "psi1 = 0 gives psi2 ="),
        ("HoldsOn", lambda response, new, state, _, _before, after: (
            response._replace(force=response.force + held(state, after)),
            new._replace(force=new.force + held(state, after))),
         "separation", "out of contact"),
        ("LeansUnderTension", lambda response, new, _, _increment, _before, after: (
            response._replace(force=response.force * np.where(
                (after.force < 0.0) & (response.force > 0), 1.0 - 1e-12, 1.0)[()]), new),
         "tension", "not the same reversed"),
    ),
    *altered(Sound, "start",
        ("NeverQuiteSlips", lambda state, *_: state._replace(
            friction_coefficient=0.9 * state.friction_coefficient),
         "gross_slip", "F = 0.5271 mu P_max where mu P is 0.5857",
         "sliding_impulse", "A grazing impact under Hertz, chi = 0.4, is 0.1 off"),
        ("UnderstatesStiffness", lambda state, *_: state._replace(stiffness=2.0 * state.stiffness),
         "stiffness", "2 times the stiffness it states"),
    ),
    *altered(Sound, "stiffness",
        ("FirstBody",
         lambda stiffness, scene, _: np.ravel(stiffness)[0] + np.zeros(scene.shape)[()],
         "batch", "Contact 1 of a batch that differs in normal_speed only is off",
         "impact_batch", "Impact (0, 2) of a batch is off"),
    ),
    *broken(Misstating, "stated",
        ("StatesNoStiffness", lambda *_: 0.0,
         "stiffness", "states stiffness 0, and its force depends on displacement"),
        ("StatesThatOfHertz", lambda _, scene: (
            0.7 * 2.0 * scene.pair.effective_shear_modulus * hertz_scales(scene).radius),
         "stiffness", "1.58 times the stiffness it states, at zeta = 0.05 under SoftHertz"),
    ),
]  # fmt: skip
