"""Forty faults that authors could really write: one method of a sound law, changed.

Each fault stands in ``FAULTS`` with the words that name it: a fault is caught where a failing
check's sentence has all the words of one entry.
"""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

import contactlab
from contactlab import Status
from contactlab.contracts import TangentialResponse
from tests.conformance.fresh_sound import (
    Brush,
    HardSphere,
    Mindlin,
    Press,
    Slider,
    Slip,
    SlipThenRoll,
    Tabled,
)

HERTZ = contactlab.compose.registry.REGISTRY.law_class("normal.hertz")
MOTION = type(HERTZ().motion(contactlab.Scene.nondimensional(psi1=0.0, chi=1.0)))
STEPS = contactlab.compose.registry.REGISTRY.law_class("integrator.symplectic")


# Bodies: what counts is the pair of them, and the slip velocity of the contact.


class IgnoresSpin(HardSphere):
    """Takes the velocity of the centre for that of the contact."""

    def slip(self, scene):
        return scene.tangential_velocity


class NormalRadiusOfOneBody(Press):
    """R of the sphere, whatever it meets."""

    def radius(self, scene):
        return scene.pair.radius if scene.sphere is None else scene.sphere.radius


class LimitRadiusOfOneBody(Brush):
    """Limits mu (b² - r²)/(kappa R) with R of the sphere."""

    def start(self, scene, normal):
        radius = scene.pair.radius if scene.sphere is None else scene.sphere.radius
        return (
            super()
            .start(scene, normal)
            ._replace(friction=scene.friction_coefficient * scene.pair.radius / radius)
        )


class NormalModulusOfOneBody(Press):
    """E* = G/(1 - nu): right of two bodies of one material."""

    def modulus(self, scene):
        if scene.sphere is None:
            return scene.pair.effective_modulus
        material = scene.sphere.material
        return material.shear_modulus / (1.0 - material.poisson_ratio)


class ShearModulusOfOneBody(Brush):
    """G* = 2 G/(2 - nu): right of two bodies of one material."""

    def modulus(self, scene):
        if scene.sphere is None:
            return scene.pair.effective_shear_modulus
        material = scene.sphere.material
        return 2.0 * material.shear_modulus / (2.0 - material.poisson_ratio)


class MassOfOneBody(HardSphere):
    """2 m/7 of the sphere, as if it met a wall."""

    def mass(self, scene):
        if scene.sphere is None:
            return scene.pair.tangential_mass
        return scene.sphere.mass / (1.0 + 1.0 / scene.sphere.gyration_ratio**2)


class RadiusOverRootTwoInStiffness(Mindlin):
    """R z/2 for b², in the stiffness only."""

    def modulus(self, scene):
        return super().modulus(scene) / 2.0**0.5


class NormalRadiusOverRootTwo(Press):
    """b² = R z/2; it claims no hemisphere of pressure."""

    offers: ClassVar[frozenset[str]] = frozenset({"radius"})

    def width(self, square):
        return (0.5 * square) ** 0.5


class FourfoldModulus(Mindlin):
    """8 G* b, which is for the G* of discrete-element codes."""

    def modulus(self, scene):
        return 8.0 * scene.pair.effective_shear_modulus


class HalfModulus(Mindlin):
    """G* b: a factor 2 was lost."""

    def modulus(self, scene):
        return scene.pair.effective_shear_modulus


# Friction work.


class WorkOnePercent(Brush):
    """Friction work, one per cent too much."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        return response._replace(friction_work=1.01 * response.friction_work), new


class WorkOfThePreviousStep(Slider):
    """The work of a step comes with the answer to the next one."""

    def start(self, scene, normal):
        return super().start(scene, normal), 0.0 * scene.slip_velocity

    def advance(self, state, increment, before, after):
        response, new = super().advance(state[0], increment, before, after)
        return response._replace(friction_work=state[1]), (new, response.friction_work)


class MorePower(Slip):
    power: ClassVar[float] = 1.01


class PowerOnePercent(SlipThenRoll):
    """Power of friction, one per cent too much."""

    slip: ClassVar[type] = MorePower


# Oddness.


class Count(NamedTuple):
    memory: Any
    displacement: Any


class NotOddAtLargeD(Slider):
    """The total displacement is cut at 500 units of it, on one side only."""

    def start(self, scene, normal):
        unit = scene.friction_coefficient * normal.maximum_approach / scene.pair.stiffness_ratio
        return Count(super().start(scene, normal), (500.0 * unit, 0.0))

    def advance(self, state, increment, before, after):
        most, so_far = state.displacement
        now = np.minimum(so_far + increment.displacement, most)
        given = increment._replace(displacement=now - so_far)
        response, memory = super().advance(state.memory, given, before, after)
        return response, Count(memory, (most, now))


class CourseOfOneSign(HardSphere):
    """The course of an impact is that of a positive slip velocity."""

    def whole_impacts(self, scene, normal):
        *others, last = super().whole_impacts(scene, normal)
        friction, mass = scene.friction_coefficient, scene.pair.tangential_mass
        share = abs(last.slip_velocity_change) * mass / (friction * normal.total_load_impulse)

        def course(impulse, load):
            return -share * friction * impulse / mass, share * friction * load

        return (*others, attrs.evolve(last, course=course))


class Steps(STEPS):
    """The symplectic scheme with something done to its motion."""

    def alter(self, motion, scene):
        return motion

    def integrate(self, normal, tangential, scene, observer=None):
        return self.alter(super().integrate(normal, tangential, scene, observer), scene)


class IntegratorNotOdd(Steps):
    """One per cent short where slip is negative."""

    def alter(self, motion, scene):
        share = np.where(np.asarray(scene.slip_velocity) < 0.0, 0.99, 1.0)
        change = share * motion.slip_velocity_change
        return attrs.evolve(motion, slip_velocity_change=change if scene.shape else float(change))


# Declared errors.


class FalsePsi2Error(Brush):
    """Declares 1e-9; the answers are good to 1e-3."""

    def psi2_error(self, scene, normal, steps):
        return 1e-9 + 0.0 * scene.psi1


class FalseErrorOfAWhole(Tabled):
    """Declares 1e-9; the table is good to 1e-2."""

    def answer(self, scene, change, work):
        return attrs.evolve(super().answer(scene, change, work), psi2_error=1e-9)


class RoughMotion(MOTION):
    """A load impulse out of a rough table."""

    accuracy = 1e-12

    def at(self, phase):
        sample = super().at(phase)
        return sample._replace(load_impulse=(1.0 + 3e-6) * sample.load_impulse)


class FalseAccuracyOfAMotion(HERTZ):
    """Declares an accuracy of 1e-12; the load impulse is good to 3e-6."""

    def motion(self, scene):
        motion = RoughMotion.of(self, scene)
        return attrs.evolve(motion, total_load_impulse=(1.0 + 3e-6) * motion.total_load_impulse)


class FalseResolution(STEPS):
    """Says that it takes ten times the steps that it takes."""

    def resolution_for(self, normal, tangential, scene):
        return 10.0 * super().resolution_for(normal, tangential, scene)


# Memory.


class RemembersAfterSeparation(Slider):
    """Out of contact it answers zero, and keeps its state."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        return response, new._replace(
            force=np.where(after.friction_load > 0.0, new.force, state.force)[()]
        )


class ClearsOneStepLate(Slider):
    """Lets go where the contact was open before the step and is open after it."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        gone = (before.friction_load <= 0.0) & (after.friction_load <= 0.0)
        kept = np.where(gone | (after.friction_load > 0.0), new.force, state.force)[()]
        return response, new._replace(force=kept)


class StateInPlaceInABatch(Slider):
    """Of a batch the force is written into the state that came in."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        if np.ndim(state.force):
            state.force[...] = new.force
            return response, state
        return response, new


STARTED: dict[Any, Any] = {}


class CachedByShape(Slider):
    """What it made of a scene is kept for every other scene of the same shape."""

    def start(self, scene, normal):
        if scene.shape not in STARTED:
            STARTED[scene.shape] = super().start(scene, normal)
        return STARTED[scene.shape]


class RelaxesPerCall(Slider):
    """Creep in every call, whatever its duration."""

    def held(self, state, increment, before, after):
        return (1.0 - 1e-6) * state.force


class LimitOfTheStepBefore(Slider):
    """Coulomb's limit of the load that the step begins with."""

    def limit(self, state, before, after):
        return state.friction * before.friction_load


# Friction.


class LimitOfTheForce(Slider):
    """Coulomb's limit of the normal force, where it presses."""

    def limit(self, state, before, after):
        return state.friction * np.maximum(after.force, 0.0)


class LimitByMuSquared(Slider):
    def friction(self, scene):
        return scene.friction_coefficient**2


class HardCodedFriction(Slider):
    """Steel on steel, 0.3."""

    def friction(self, scene):
        return 0.3 + 0.0 * scene.friction_coefficient


class FrictionOfTheFirst(Slider):
    """Of a batch the first friction coefficient, for all."""

    def friction(self, scene):
        return np.ravel(scene.friction_coefficient)[0] + np.zeros(scene.shape)[()]


class RestitutionOfTheVelocities(HardSphere):
    """mu (1 + e) M_n v1 with e of the normal velocities: not the impulse of the friction load."""

    def impulse(self, scene, normal):
        return scene.pair.normal_mass * (scene.normal_speed - normal.final_rate)


class UniformLimits(Brush):
    """Springs that slip all at once; it claims no partial slip."""

    offers: ClassVar[frozenset[str]] = frozenset()

    def profile(self, places, radius):
        return 1.0 * (places < radius) * radius**2


# Batches, NaN, units, chance.


class TransposedBatch(Slider):
    """Of a batch of two axes the friction coefficients in the order of the other axis."""

    def friction(self, scene):
        friction = np.asarray(scene.friction_coefficient)
        if friction.ndim < 2:
            return scene.friction_coefficient
        return np.ravel(friction, order="F").reshape(friction.shape)


class TransposedNormalBatch(Press):
    """Of a batch of two axes the radii in the order of the other axis."""

    def radius(self, scene):
        radius = np.asarray(scene.pair.radius)
        if radius.ndim < 2:
            return scene.pair.radius
        return np.ravel(radius, order="F").reshape(radius.shape)


class HidesNanInABatch(Slider):
    """Of a batch NaN is cleaned away."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        if np.ndim(state.force):
            force = np.nan_to_num(response.force)
            return TangentialResponse(force, np.nan_to_num(response.friction_work)), new._replace(
                force=force
            )
        return response, new


class NanRateIsNoDamping(Press):
    """A rate of NaN is taken for rest."""

    def dashpot(self, damping, rate):
        return 1.0 + damping * np.nan_to_num(rate)


class RegularisedInMillimetres(Slider):
    """Below a millimetre a second friction is viscous."""

    def limit(self, state, before, after):
        return state.friction * after.friction_load

    def advance(self, state, increment, before, after):
        slow = np.tanh(np.abs(increment.velocity) / 1e-3)
        softer = state._replace(friction=state.friction * slow)
        response, new = super().advance(softer, increment, before, after)
        return response, new._replace(friction=state.friction)


class DrawsFromTheGlobalGenerator(HardSphere):
    """A rough surface: mu varies by a per cent, from NumPy's global generator."""

    def friction(self, scene):
        draw = np.random.standard_normal(scene.shape or None)  # noqa: NPY002
        return scene.friction_coefficient * (1.0 + 0.01 * draw)


# Integrators.


class IntegratorIgnoresSpin(STEPS):
    """Takes the velocity of the centre for that of the contact."""

    def integrate(self, normal, tangential, scene, observer=None):
        if scene.sphere is not None:
            scene = attrs.evolve(scene, spin=0.0)
        return super().integrate(normal, tangential, scene, observer)


class HidesUnsettled(Steps):
    """A law that found no answer reads as success."""

    def alter(self, motion, scene):
        if scene.shape or motion.status is not Status.UNSETTLED:
            return motion
        return attrs.evolve(motion, status=Status.SUCCESS, detail="")


#: Each fault and the words that name it: all words of one tuple, in one sentence.
FAULTS: list[tuple[type, tuple[tuple[str, ...], ...]]] = [
    (IgnoresSpin, (("spin",),)),
    (NormalRadiusOfOneBody, (("unlike", "radius"), ("exchanged",))),
    (LimitRadiusOfOneBody, (("unlike", "radi"), ("exchanged",))),
    (NormalModulusOfOneBody, (("unlike", "modul"), ("exchanged",))),
    (ShearModulusOfOneBody, (("unlike", "modul"), ("exchanged",))),
    (MassOfOneBody, (("unlike", "mass"), ("exchanged",))),
    (RadiusOverRootTwoInStiffness, (("dF/dD", "2 G* b"),)),
    (NormalRadiusOverRootTwo, (("b²", "R z"),)),
    (FourfoldModulus, (("dF/dD", "2 G* b"),)),
    (HalfModulus, (("dF/dD", "2 G* b"),)),
    (
        WorkOnePercent,
        (("riction work", "1.01"), ("riction work", "1 %")),
    ),
    (WorkOfThePreviousStep, (("riction work", "step before"),)),
    (PowerOnePercent, (("in no book",), ("energy books",))),
    (NotOddAtLargeD, (("eversed slip",), ("psi1 = -",))),
    (CourseOfOneSign, (("psi1 = -", "course"),)),
    (IntegratorNotOdd, (("psi1 = -",),)),
    (FalsePsi2Error, (("psi2_error", "declare"),)),
    (FalseErrorOfAWhole, (("psi2_error", "declare"),)),
    (FalseAccuracyOfAMotion, (("accuracy", "declare"),)),
    (FalseResolution, (("resolution_for",),)),
    (RemembersAfterSeparation, (("again", "contact"),)),
    (ClearsOneStepLate, (("again", "contact"),)),
    (StateInPlaceInABatch, (("state that went in",), ("thrown away",))),
    (CachedByShape, (("other bodies",), ("another scene",))),
    (RelaxesPerCall, (("eld still",),)),
    (LimitOfTheStepBefore, (("load", "start of the step"),)),
    (LimitOfTheForce, (("friction load", "normal force"), ("friction load", "not"))),
    (LimitByMuSquared, (("mu to the power",),)),
    (HardCodedFriction, (("mu to the power",),)),
    (FrictionOfTheFirst, (("friction_coefficient", "batch"),)),
    (RestitutionOfTheVelocities, (("friction load", "mu"),)),
    (UniformLimits, (("traction", "mu p"),)),
    (TransposedBatch, (("shape (2, 3)",),)),
    (TransposedNormalBatch, (("shape (2, 3)",),)),
    (HidesNanInABatch, (("NaN", "batch"),)),
    (NanRateIsNoDamping, (("rate of NaN",),)),
    (RegularisedInMillimetres, (("other units",), ("any units",))),
    (DrawsFromTheGlobalGenerator, (("run twice",),)),
    (IntegratorIgnoresSpin, (("spin",),)),
    (HidesUnsettled, (("settled",),)),
]
