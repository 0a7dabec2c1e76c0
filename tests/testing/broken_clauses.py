"""Small faults, one for each sentence of the kit that no other broken law brings about."""

from __future__ import annotations

from typing import Any, ClassVar

import attrs
import numpy as np

import contactlab
from contactlab import Status
from contactlab.contracts import TangentialMotion, faults, quantity
from contactlab.solve.normal_motion import normal_motion
from tests.testing.broken_impacts import AllAtOnce, Knowing, OtherwiseAtOnce, Whole, by_course
from tests.testing.broken_integrators import AsksTillItGives
from tests.testing.broken_laws import Answering, Misstating, Sound
from tests.testing.broken_normal import Altered, Moving, Stepwise
from tests.testing.fresh_faults import HERTZ, MOTION, STEPS, Steps
from tests.testing.fresh_sound import Brush, HardSphere, Press
from tests.testing.made import altered, broken
from tests.testing.slip_laws import OfLoad

NUMBERS: dict[str, Any] = {"force": 0.0, "calls": 0}


# What a law declares.


class ClaimsAndExpects(Sound):
    offers: ClassVar[frozenset] = frozenset({"partial_slip"})
    expected_failures: ClassVar[dict] = {"cattaneo_mindlin": "one spring for the whole contact"}


class ClaimsAccuracy(STEPS):
    offers: ClassVar[frozenset] = STEPS.offers | {"controls_error"}
    resolution: ClassVar[str] = "tolerance"
    tolerance = 1e-9
    _steps = 200


class ControlsBySteps(STEPS):
    offers: ClassVar[frozenset] = STEPS.offers | {"controls_error"}


@attrs.frozen(kw_only=True)
class RefusesNamelessly(Sound):
    """A parameter that is refused without its name."""

    extra: float = 1.0

    def __attrs_post_init__(self):
        if not np.isreal(self.extra) or isinstance(self.extra, str) or self.extra != 1.0:
            raise ValueError("must be 1")


@attrs.frozen(kw_only=True)
class CopiesOtherwise(Sound):
    """A copy has forgotten where it is from."""

    origin: Any = attrs.field(default="made", eq=False)

    def __copy__(self):
        return attrs.evolve(self, origin="copied")


# Stepped laws.


class WritesIntoItsState(Sound):
    """Notes the step in a list that came in; the answer does not depend on it."""

    def start(self, scene, normal):
        return super().start(scene, normal), []

    def advance(self, state, increment, before, after):
        response, new = super().advance(state[0], increment, before, after)
        state[1].append(1)
        return response, (new, state[1])


class WearsByTheRun(Sound):
    """A little stiffer with every start."""

    def start(self, scene, normal):
        NUMBERS["calls"] += 1
        state = super().start(scene, normal)
        return state._replace(stiffness=state.stiffness * (1.0 + 1e-9 * NUMBERS["calls"]))


class RemembersAClosedLoop(Sound):
    """Weaker by a little from the second turn of the slip on: loading and unloading are alike."""

    def start(self, scene, normal):
        return super().start(scene, normal), (0.0, 0)

    def advance(self, state, increment, before, after):
        spring, (last, turns) = state
        turns = turns + (last * increment.displacement < 0.0)
        response, new = super().advance(spring, increment, before, after)
        told = response._replace(force=np.where(turns > 1, 0.999, 1.0)[()] * response.force)
        moved = np.where(increment.displacement == 0.0, last, increment.displacement)[()]
        return told, (new, (moved, turns))


class WeakerInABatch(AllAtOnce):
    """Of a batch a little weaker where all steps are taken at once."""

    def told(self, response):
        share = 0.99 if response.force.ndim > 1 else 1.0
        return response._replace(force=share * response.force)


# Normal laws.


class HeedsTheCallBefore(Press):
    """A force from the approach of the call before, whichever state it was for."""

    def respond(self, state, approach, rate):
        contact, state = super().respond(state, approach, rate)
        force = contact.force * (1.0 + 1e-3 * (NUMBERS["force"] > 1.2 * np.max(approach)))
        NUMBERS["force"] = float(np.max(approach))
        return contact._replace(force=force), state


class StartsApart(MOTION):
    def at(self, phase):
        sample = super().at(phase)
        return sample._replace(approach=sample.approach - 1e-10 * self.maximum_approach)


class HeavierScaled(MOTION):
    @property
    def scaled_mass(self):
        return 0.81


def motion(member, change):
    """Return Hertz's motion, of which one member is a function of what the sound one answers."""
    return altered(MOTION, member, ("Changed", change, "", ""))[0][0]


# Integrators.


class MassOfTheSphere(STEPS):
    """2 m/7 of the sphere for M_t, as if it met a wall."""

    def integrate(self, scene, normal, tangential, observer=None):
        if scene.sphere is not None:
            mass = scene.sphere.mass / (1.0 + 1.0 / scene.sphere.gyration_ratio**2)
            pair = attrs.evolve(scene.pair, tangential_mass=mass)
            scene = attrs.evolve(scene, sphere=None, target=None, pair=pair)
            normal = normal_motion(normal.law, scene)
        return super().integrate(scene, normal, tangential, observer)


class ShowsInstantsTwice(STEPS):
    def integrate(self, scene, normal, tangential, observer=None):
        def twice(sample):
            observer(sample)
            observer(sample)

        watched = twice if observer is not None else None
        return super().integrate(scene, normal, tangential, watched)


class ShowsTheFirstHalf(STEPS):
    def integrate(self, scene, normal, tangential, observer=None):
        half = 0.5 * float(np.max(normal.duration))

        def early(sample):
            if np.max(sample.time) < half:
                observer(sample)

        watched = early if observer is not None else None
        return super().integrate(scene, normal, tangential, watched)


class FailsInABatch(Steps):
    """Of a batch the first impact is unresolved."""

    def alter(self, motion, scene):
        if not scene.shape:
            return motion
        status = np.array(motion.status, dtype=object)
        status[(0,) * status.ndim] = Status.UNRESOLVED
        return TangentialMotion(
            slip_velocity_change=motion.slip_velocity_change,
            friction_work=motion.friction_work,
            status=status,
        )


class ReportsItsEndlessness(AsksTillItGives):
    """Repeats a step of a stiff law until it raises, and reports that."""

    def integrate(self, scene, normal, tangential, observer=None):
        try:
            return super().integrate(scene, normal, tangential, observer)
        except Exception as error:
            detail = faults.tell_error(error)
            return TangentialMotion.nothing(scene.shape, Status.LAW_RAISED, detail)


EVENTS = contactlab.registry.registry.REGISTRY.law_class("integrator.events")


class EndsTheEndless(EVENTS):
    """Takes events without end for a success."""

    def integrate(self, scene, normal, tangential, observer=None):
        motion = super().integrate(scene, normal, tangential, observer)
        if scene.shape or motion.status is Status.SUCCESS:
            return motion
        return attrs.evolve(motion, status=Status.SUCCESS, detail="", slip_velocity_change=-1.0)


# Sentences of checks whose first sentence another law brings about.


class WorkOfOneSense(Answering):
    """One per cent more work where the force is negative."""

    def answer(self, response, state):
        share = np.where(response.force < 0.0, 1.01, 1.0)[()]
        return response._replace(friction_work=share * response.friction_work), state


class PushesAtFirst(Sound):
    """A force below a fifth of Coulomb's limit drives the slip; a larger one opposes it."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        limit = state.friction_coefficient * after.friction_load
        sense = np.where(abs(response.force) < 0.2 * limit, -1.0, 1.0)[()]
        return response._replace(force=sense * response.force), new


class StiffensUnderLoad(Sound):
    """A sheared force that grows with the load, as far as friction goes."""

    def advance(self, state, increment, before, after):
        grown = after.friction_load / np.where(
            before.friction_load > 0.0, before.friction_load, 1.0
        )
        force = np.where(before.friction_load > 0.0, grown, 1.0)[()] * state.force
        return super().advance(state._replace(force=force), increment, before, after)


class SpoilsTheOthers(Answering):
    """NaN of one contact of a batch makes the others stronger."""

    def answer(self, response, state):
        share = 1.0 + 0.01 * bool(np.isnan(response.force).any())
        return response._replace(force=share * response.force), state


class ThrowsAtTheEnd(Sound):
    """Twice the force that the load could hold, in a step that ends almost without load."""

    def advance(self, state, increment, before, after):
        response, new = super().advance(state, increment, before, after)
        gone = after.friction_load < 1e-3 * before.friction_load
        thrown = 2.0 * state.friction_coefficient * before.friction_load * gone
        return response._replace(force=response.force + thrown), new


class EqualToItselfOnly(Sound):
    """No copy is equal to it."""

    __hash__ = Sound.__hash__

    def __eq__(self, other):
        return self is other


@attrs.frozen(kw_only=True)
class InFurlongs(Sound):
    """A parameter in a unit of no system."""

    length: float = quantity("furlong", default=1.0)


class ShowsSuccessesOnly(STEPS):
    """Keeps what an observer should see until the end, and shows nothing of a failed run."""

    def integrate(self, scene, normal, tangential, observer=None):
        seen = []
        motion = super().integrate(scene, normal, tangential, seen.append)
        if observer is not None and np.all(motion.status == Status.SUCCESS):
            for sample in seen:
                observer(sample)
        return motion


class RunsItsOwnLawsOnly(STEPS):
    """Runs laws of one class, which no other law is derived from."""

    needs: ClassVar[frozenset[type]] = frozenset({InFurlongs})


def counting(base, member, name):
    """Return a law that counts the calls of a method in a dictionary of its own."""

    def method(law, *given, **named):
        law.calls["made"] = law.calls.get("made", 0) + 1
        return getattr(base, member)(law, *given, **named)

    calls = attrs.field(factory=dict, eq=False)
    content = {"__annotations__": {"calls": Any}, "calls": calls, member: method}
    return attrs.frozen(kw_only=True)(type(name, (base,), content))


def rounded(state, scene, *_):
    """Round the speed of the scene that a law was given, and return the state."""
    object.__setattr__(scene, "normal_speed", np.round(scene.normal_speed, 1))
    return state


class ChangesTheSceneToo(Press):
    def start(self, scene):
        return rounded(super().start(scene), scene)


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (OfLoad, "slip_speed", "At a slip speed of 0.0001 m/s F/(mu P) is"),
    (ClaimsAndExpects, "expected_failures", "The law offers 'partial_slip' and expects to fail"),
    (RefusesNamelessly, "parameters", "extra = nan: refused without its name: must be 1"),
    (CopiesOtherwise, "copies", "A copy differs: "),
    (WritesIntoItsState, "pure", "The state that went in was changed at step 1."),
    (WearsByTheRun, "repeatable", "gives other forces"),
    (RemembersAClosedLoop, "turning_points", "A closed loop at slip 0.3 is not forgotten"),
    (MassOfTheSphere, "unlike_bodies", "Balls unlike in mass, psi1 = 0.5: exchanged, psi2"),
    (WeakerInABatch, "all_steps", "A batch of shape (8,): differs by"),
    (HeedsTheCallBefore, "contacts_pure", "A step tried and thrown away changed the next one"),
    (ShowsInstantsTwice, "observer_changes_nothing", "called at times that do not increase"),
    (ShowsTheFirstHalf, "observer_changes_nothing", "The last instant seen is at 0.4"),
    (FailsInABatch, "impact_batch", "A batch of shape (2, 3): UNRESOLVED"),
    (ReportsItsEndlessness, "bounded", "Unyielding is called without end"),
    (EndsTheEndless, "bounded", "A run with endless events is reported as a success"),
    (WorkOfOneSense, "odd_in_slip", "Reversed slip gives a friction work that differs by"),
    (PushesAtFirst, "opposes_slip", "A first, positive slip meets a force of -"),
    (StiffensUnderLoad, "normal_load_alone", "Pressing on a contact that is sheared adds"),
    (SpoilsTheOthers, "non_finite", "of one contact of a batch changes the force of the others"),
    (ThrowsAtTheEnd, "last_step", "mu P_max as the load falls to zeta = 1e-06"),
    (EqualToItselfOnly, "copies", "A copy is not equal to the law"),
    (InFurlongs, "units", "The unit 'furlong' is not understood"),
    (ShowsSuccessesOnly, "faults_reported", "0 instants of the history are left"),
    (RunsItsOwnLawsOnly, "impact_odd", "The law fits none of the laws of the kit"),
    (OtherwiseAtOnce, "impact_repeatable", "Watched, an impact ends differently, by 1"),
    *broken(Sound, "waives",
        ("WaivesTheUnknown", lambda: frozenset({"elliptic"}),
         "contract", "waives() names 'elliptic', which is neither in offers nor in needs"),
        ("WaivesAWord", lambda: "elliptic", "contract", "waives() gave 'elliptic': must be"),
    ),
    *broken(Press, "needs",
        ("NeedsAsANormalLaw", frozenset({"radius"}),
         "contract", "A normal law needs nothing"),
    ),
    *broken(Sound, "resolution",
        ("NamesNoParameter", "fineness",
         "contract", "resolution = 'fineness': must name a parameter"),
    ),
    *broken(Sound, "needs",
        ("NeedsInAList", ["radius"],
         "contract", "needs must be a frozenset, a constant of the class"),
    ),
    *broken(Press, "offers",
        ("OffersHertzWithoutAMotion", frozenset({"radius", "elastic_hertz"}),
         "contract", "offers 'elastic_hertz', and is no ClosedForm"),
    ),
    *broken(Sound, "expected_failures",
        ("ExpectsOfAnother", {"grows": "it is no normal law at all"},
         "expected_failures", "'grows' is not a check of such a law"),
    ),
    *broken(Sound, "fields",
        ("FieldsWithoutNames", lambda *_: {1: np.zeros(3)}, "fields", "fields: 1 is not a name"),
    ),
    *broken(Brush, "expected_failures",
        ("BundleUnderDamping", {}, "coulomb_at_a_point_damped", "under StronglyDampedHertz"),
    ),
    *broken(Brush, "modulus",
        ("SofterBundle", lambda scene: 0.9 * scene.pair.effective_shear_modulus,
         "cattaneo_mindlin", "off Cattaneo and Mindlin's"),
    ),
    *broken(HardSphere, "restitution",
        ("NeedsBodies", lambda scene: 0.2 if scene.sphere is None else 0.4,
         "unlike_bodies", "off that of a scene with the same pair and no bodies"),
    ),
    *broken(Press, "respond",
        ("AnswersANumber", lambda state, approach, _rate: (0.0 * approach, state),
         "grows", "respond returned "),
    ),
    *broken(Altered, "alter",
        ("NanOverlap",
         lambda contact, approach, _rate: contact._replace(
             overlap=np.where(np.isnan(approach), -1.0, contact.overlap)[()]),
         "contacts_non_finite", "An approach of NaN is taken for no contact"),
        ("NanLoad",
         lambda contact, *_: contact._replace(
             friction_load=np.nan_to_num(contact.friction_load)[()]),
         "contacts_non_finite", "An approach of NaN gives a friction load of 0.0"),
        ("NegativeRadius", lambda contact, *_: contact._replace(radius=-contact.radius),
         "presses", "A contact radius of -"),
        ("WideWithoutContact",
         lambda contact, *_: contact._replace(radius=contact.radius + 1e-9),
         "presses", "There is a contact radius out of contact"),
        ("LoadedWithoutContact",
         lambda contact, *_: contact._replace(friction_load=contact.friction_load + 1e-3),
         "presses", "There is a friction load out of contact"),
        ("NoForceAtAll",
         lambda contact, *_: contact._replace(
             force=0.0 * contact.force, friction_load=0.0 * contact.force),
         "presses", "There is no force at any approach"),
        ("NeverEnds", lambda contact, *_: contact._replace(overlap=1.0 + abs(contact.overlap)),
         "presses", "Far behind first touch the overlap says that there is still"),
    ),
    *broken(Stepwise, "alter",
        ("NeverParts",
         lambda contact, dashpot, rate: contact._replace(
             force=3.0 * dashpot * np.maximum(rate, 0.0)),
         "rebounds", "An impact does not end: "),
    ),
    (ClaimsAccuracy, "controls_error", "off the exact solution"),
    (ControlsBySteps, "contract", "its resolution must be 'tolerance'"),
    *broken(Steps, "alter",
        ("GivesUp",
         lambda motion, scene: motion if scene.shape else attrs.evolve(
             motion, status=Status.UNRESOLVED),
         "ends_well", "UNRESOLVED"),
        ("SaysMore",
         lambda motion, scene: motion if scene.shape else attrs.evolve(
             motion, detail="all is well"),
         "ends_well", "A success says 'all is well'"),
        ("WrongWay",
         lambda motion, _scene: attrs.evolve(
             motion, slip_velocity_change=-motion.slip_velocity_change),
         "ends_well", "m/s changes by 1.1"),
        ("CountsInHalves",
         lambda motion, _scene: attrs.evolve(motion, counters={"steps": 199.5}),
         "ends_well", "counters = {'steps': 199.5}: must be whole numbers"),
        ("SilentFault",
         lambda motion, scene: attrs.evolve(motion, detail="") if not scene.shape else motion,
         "faults_reported", "says nothing of what and where"),
        ("MissesOnePerThousand",
         lambda motion, _scene: attrs.evolve(motion, friction_work=1.001 * motion.friction_work),
         "books_by", "With 8 times the steps "),
    ),
    *altered(Sound, "advance",
        ("NeverSettles", lambda response, new, *_: (response._replace(settled=False), new),
         "coulomb_limit", "The law found no answer on a straight load path"),
        ("PaysUnderTension", lambda response, new, _, increment, _before, after: (response._replace(
            friction_work=response.friction_work - (
                1e-3 * abs(after.force * increment.displacement) * (after.force < 0.0))), new),
         "tension", "Under tension friction work is -"),
    ),
    *altered(HERTZ, "motion",
        ("EndsFaster",
         lambda motion, _: attrs.evolve(motion, final_rate=(1.0 + 1e-8) * motion.final_rate),
         "motion_obeys_newton", "The motion does not end at its final rate"),
    ),
    *broken(Moving, "moving",
        ("WithStartsSlower",
         motion("at", lambda sample, _: sample._replace(rate=sample.rate * (1.0 - 1e-9))),
         "motion_agrees", "The motion starts at 0.8299"),
        ("WithStartsApart", StartsApart, "motion_agrees", "The motion does not start at touch"),
        ("WithHeavierScaled", HeavierScaled,
         "motion_obeys_newton", "The scaled mass is 1.3e-02 off"),
        ("WithWiderScaled",
         motion("scaled", lambda scaled, _: scaled._replace(radius=1.01 * scaled.radius)),
         "motion_scaled", "The scaled radius is 1.0e-02 off"),
        ("WithLaterAtARate", motion("phase_at_rate", lambda phase, _: phase + 1e-6),
         "motion_scaled", "phase_at_rate is 1.0e-06 off"),
        ("WithLaterAtAFraction", motion("phase", lambda phase, _: phase * (1.0 + 1e-5)),
         "motion_scaled", "off the inverse of time"),
    ),
    (counting(Sound, "advance", "ChangesItself"), "pure", "The law itself was changed by a run"),
    (counting(Whole, "told", "CountsItsImpacts"),
     "impact_repeatable", "A run changed the law (as whole impacts)"),
    (counting(Press, "respond", "CountsItsCalls"),
     "contacts_pure", "The law itself was changed by a run"),
    (counting(Steps, "alter", "CountsItsRuns"), "impact_repeatable", "A run changed the law"),
    *altered(Sound, "start",
        ("ChangesTheScene", rounded, "read_only", "The law changed the scene"),
    ),
    (ChangesTheSceneToo, "contacts_read_only", "The law changed the scene"),
    *broken(Misstating, "stated",
        ("InfinitelyStiff", lambda true, _: np.inf * true, "stiffness", "stiffness = inf"),
        ("StatesTooStiff", lambda true, _: 1e8 * true,
         "impact_central", "the stiffness that it states, "),
    ),
    *broken(Knowing, "told",
        ("HurriedForce", by_course(lambda _, change, force: (change, 2.0 * force)),
         "whole_impacts", "along the course the force is"),
    ),
    *broken(Whole, "told",
        ("CourseOfTheEnd", by_course(
            lambda _, change, force: (np.ravel(change)[-1:], np.ravel(force)[-1:])),
         "whole_impact_form", "its course answers shapes (1,), (1,) to (20001,)"),
    ),
]  # fmt: skip
