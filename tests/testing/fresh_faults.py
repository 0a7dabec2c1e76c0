"""Forty faults that authors could really write: one method of a sound law, changed.

Each fault stands in ``FAULTS`` with the check that catches it and the words that name it.
"""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

import contactlab
from contactlab import Status
from contactlab.contracts import Errors, TangentialResponse
from contactlab.solve.normal_motion import normal_motion
from tests.testing.fresh_sound import (
    Brush,
    HardSphere,
    Mindlin,
    Press,
    Slider,
    Slip,
    SlipThenRoll,
    Tabled,
)
from tests.testing.made import altered, broken

HERTZ = contactlab.registry.registry.REGISTRY.law_class("normal.hertz")
MOTION = type(HERTZ().motion(contactlab.Scene.nondimensional(psi1=0.0, chi=1.0)))
STEPS = contactlab.registry.registry.REGISTRY.law_class("integrator.symplectic")


# Bodies: what counts is the pair of them, and the slip velocity of the contact.


class LimitRadiusOfOneBody(Brush):
    """Limits mu (b² - r²)/(kappa R) with R of the sphere."""

    def start(self, scene, normal):
        radius = scene.pair.radius if scene.sphere is None else scene.sphere.radius
        return (
            super()
            .start(scene, normal)
            ._replace(friction=scene.friction_coefficient * scene.pair.radius / radius)
        )


class NormalRadiusOverRootTwo(Press):
    """b² = R z/2; it claims no hemisphere of pressure."""

    offers: ClassVar[frozenset[str]] = frozenset({"radius"})

    def width(self, square):
        return (0.5 * square) ** 0.5


# Friction work.


class WorkOfThePreviousStep(Slider):
    """The work of a step comes with the answer to the next one."""

    def start(self, scene, normal):
        return super().start(scene, normal), np.zeros(scene.shape)[()]

    def advance(self, state, increment, before, after):
        response, new = super().advance(state[0], increment, before, after)
        return response._replace(friction_work=state[1]), (new, response.friction_work)


class MorePower(Slip):
    power: ClassVar[float] = 1.01


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

    def integrate(self, scene, normal, tangential, observer=None):
        return self.alter(super().integrate(scene, normal, tangential, observer), scene)


class IntegratorNotOdd(Steps):
    """One per cent short where slip is negative."""

    def alter(self, motion, scene):
        share = np.where(np.asarray(scene.slip_velocity) < 0.0, 0.99, 1.0)
        change = share * motion.slip_velocity_change
        return attrs.evolve(motion, slip_velocity_change=change if scene.shape else float(change))


# Declared errors.


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


# Memory.


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


# Friction.


class UniformLimits(Brush):
    """Springs that slip all at once; it claims no partial slip."""

    offers: ClassVar[frozenset[str]] = frozenset()

    def profile(self, places, radius):
        return 1.0 * (places < radius) * radius**2


# Batches, NaN, units, chance.


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

    def integrate(self, scene, normal, tangential, observer=None):
        if scene.sphere is not None:
            scene = attrs.evolve(scene, spin=0.0)
            normal = normal_motion(normal.law, scene)
        return super().integrate(scene, normal, tangential, observer)


def alone(pair, body):
    """Return a function of a scene: of the first body, or of the pair where no body is known."""
    return lambda scene: pair(scene.pair) if scene.sphere is None else body(scene.sphere)


def transposed(numbers):
    """Return the numbers of a batch of two axes in the order of the other axis."""
    shape = np.shape(numbers)
    return numbers if len(shape) < 2 else np.ravel(numbers, order="F").reshape(shape)


#: Each with the check that catches it, and words by which its sentence names the fault.
FAULTS = [
    (LimitRadiusOfOneBody, "unlike_bodies",
     "Balls unlike in radius, psi1 = 0.5: exchanged, psi2 differs by"),
    (NormalRadiusOverRootTwo, "radius", "b² is 0.5 R z at greatest compression"),
    (WorkOfThePreviousStep, "work_in_its_step", "that of the step before, of 0.1, 0.059"),
    (NotOddAtLargeD, "odd_in_slip", "Reversed slip, as far as 10000 units, gives a force that"),
    (CourseOfOneSign, "whole_impact_form",
     "psi1 = -0.3, chi = 0.4, 'hard spheres': its course ends"),
    (IntegratorNotOdd, "impact_odd", "psi1 = -0.01, chi = 0.4: differs by 1.9e-04 from the mirror"),
    (FalseAccuracyOfAMotion, "motion_accuracy",
     "accuracy = 1e-12 is declared for the load impulse"),
    (ClearsOneStepLate, "contact_again", "After 1 step(s) out of contact, contact is made again"),
    (StateInPlaceInABatch, "pure", "changed the next one, at step 1 of a batch of shape (3,)"),
    (CachedByShape, "impact_after_another", "An impact of other bodies, run after another scene"),
    (UniformLimits, "coulomb_at_a_point", "The traction exceeds mu p by 1"),
    (HidesNanInABatch, "non_finite",
     "NaN as the slip of one contact of a batch gives F = 0 N there"),
    (RegularisedInMillimetres, "impact_units", "in other units psi2 differs by"),
    (DrawsFromTheGlobalGenerator, "impact_repeatable", "An impact that slips, run twice, ends"),
    (IntegratorIgnoresSpin, "spin", "of which spin is 1: psi2 differs by"),
    *broken(HardSphere, "slip",
        ("IgnoresSpin", lambda scene: scene.tangential_velocity,
         "spin", "of which spin is 1: psi2 differs by"),
    ),
    *broken(Press, "radius",
        ("NormalRadiusOfOneBody",
         lambda scene: scene.pair.radius if scene.sphere is None else scene.sphere.radius,
         "contacts_unlike", "Balls unlike in radius: exchanged, the force differs by"),
    ),
    *broken(Mindlin, "modulus",
        ("FourfoldModulus", lambda scene: 8.0 * scene.pair.effective_shear_modulus,
         "at_rest_stiffness", "dF/dD of a contact at rest is 4 times 2 G* b"),
        ("HalfModulus", lambda scene: scene.pair.effective_shear_modulus,
         "at_rest_stiffness", "dF/dD of a contact at rest is 0.5 times 2 G* b"),
    ),
    *broken(SlipThenRoll, "slip",
        ("PowerOnePercent", MorePower, "impact_books", "the energy books miss 1.0e-02"),
    ),
    *broken(Brush, "errors",
        ("FalsePsi2Error", lambda scene, *_: Errors(1e-9 + 0.0 * scene.psi1),
         "declared_error", "psi2_error = 1e-09 is declared, and psi2 is 0.0007"),
    ),
    *broken(Slider, "held",
        ("RelaxesPerCall", lambda state, *_: (1.0 - 1e-6) * state.force,
         "held_still", "Held still for 400 steps, the force of 0.225 mu P_max changes by"),
    ),
    *broken(Slider, "limit",
        ("LimitOfTheStepBefore",
         lambda state, before, _after: state.friction * before.friction_load,
         "coulomb_limit", "it is mu times the load at the start of the step"),
        ("LimitOfTheForce",
         lambda state, _before, after: state.friction * np.maximum(after.force, 0.0),
         "friction_load", "mu times the friction load is 0.3514 and mu times the normal"),
    ),
    *broken(Slider, "friction",
        ("LimitByMuSquared", lambda scene: scene.friction_coefficient**2,
         "friction_coefficient", "goes with mu to the power 2, not 1"),
        ("HardCodedFriction", lambda scene: 0.3 + 0.0 * scene.friction_coefficient,
         "friction_coefficient", "goes with mu to the power"),
        ("FrictionOfTheFirst",
         lambda scene: np.ravel(scene.friction_coefficient)[0] + np.zeros(scene.shape)[()],
         "batch", "Contact 1 of a batch that differs in friction_coefficient only"),
    ),
    *broken(HardSphere, "impulse",
        ("RestitutionOfTheVelocities",
         lambda scene, normal: scene.pair.normal_mass * (scene.normal_speed - normal.final_rate),
         "load_impulse", "off mu times the impulse of the friction load"),
    ),
    *broken(Press, "dashpot",
        ("NanRateIsNoDamping", lambda damping, rate: 1.0 + damping * np.nan_to_num(rate),
         "contacts_non_finite", "A rate of NaN gives a force of"),
    ),
    *altered(Brush, "advance",
        ("WorkOnePercent", lambda response, new, *_: (
            response._replace(friction_work=1.01 * response.friction_work), new),
         "gross_slip", "work of gross slip by 4.0 is 1.01 times force times slip"),
    ),
    *altered(STEPS, "errors",
        ("FalseResolution", lambda errors, *_: errors._replace(resolution=10.0 * errors.resolution),
         "resolution_told", "errors tells steps = 2000, and with steps = 2000 an"),
    ),
    *altered(Mindlin, "modulus",
        ("RadiusOverRootTwoInStiffness", lambda modulus, _: modulus / 2.0**0.5,
         "at_rest_stiffness", "a contact at rest is 0.7071 times 2 G* b"),
    ),
    *altered(Tabled, "answer",
        ("FalseErrorOfAWhole", lambda answer, *_: attrs.evolve(answer, psi2_error=1e-9),
         "declared_error", "psi2_error = 1e-09 is declared, and psi2 is 0.004"),
    ),
    *altered(Slider, "advance",
        ("RemembersAfterSeparation",
         lambda response, new, state, _, _before, after: (response, new._replace(
             force=np.where(after.friction_load > 0.0, new.force, state.force)[()])),
         "contact_again", "contact is made again: pressing alone gives F = 0.01"),
    ),
    *broken(Press, "radius",
        ("TransposedNormalBatch", lambda scene: transposed(scene.pair.radius),
         "contacts_batch", "Contact (0, 1) of a batch of shape (2, 3) is off"),
    ),
    *broken(Press, "modulus",  # right of two bodies of one material, as the next
        ("NormalModulusOfOneBody", alone(
            lambda pair: pair.effective_modulus,
            lambda body: body.material.shear_modulus / (1.0 - body.material.poisson_ratio)),
         "contacts_unlike", "unlike in shear_modulus: exchanged, the force differs"),
    ),
    *broken(Brush, "modulus",
        ("ShearModulusOfOneBody", alone(
            lambda pair: pair.effective_shear_modulus,
            lambda body: 2.0 * body.material.shear_modulus / (2.0 - body.material.poisson_ratio)),
         "unlike_bodies", "unlike in shear_modulus, psi1 = 0.5: exchanged, psi2"),
    ),
    *broken(HardSphere, "mass",  # as if it met a wall
        ("MassOfOneBody", alone(
            lambda pair: pair.tangential_mass,
            lambda body: body.mass / (1.0 + 1.0 / body.gyration_ratio**2)),
         "unlike_bodies", "Balls unlike in mass, psi1 = 9.0: exchanged, psi2 differs by"),
    ),
    *broken(Slider, "friction",
        ("TransposedBatch", lambda scene: transposed(scene.friction_coefficient),
         "batch", "Contact (0, 1) of a batch of shape (2, 3) is off"),
    ),
    *broken(Steps, "alter",
        ("HidesUnsettled", lambda motion, scene: (
            motion if scene.shape or motion.status is not Status.UNSETTLED
            else attrs.evolve(motion, status=Status.SUCCESS, detail="")),
         "faults_reported", "A fault in Hertz and UnsettledSpring reads as success"),
    ),
]  # fmt: skip
