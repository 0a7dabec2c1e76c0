"""A NaN or an infinity at any step, of any law under any integrator, is reported: never an answer.

The laws here wrap a real one and spoil one of its answers. Whatever is done with it, the run
must not end in success.
"""

from __future__ import annotations

import math

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, ImpactError, Material, Scene, Simulation, Sphere
from contactlab.analysis.bench_methods import methods
from contactlab.contracts import (
    ClosedFormMotion,
    ClosedFormNormalLaw,
    NormalLaw,
    PhasedTangentialLaw,
    SteppedTangentialLaw,
)
from contactlab.registry import REGISTRY

STEPS = 9
#: Bad values that were met by a run, and those of them that it reported.
TRIED = {"bad values met": 0, "of them reported": 0}
NAN, INFINITY = math.nan, math.inf
STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
#: Two impacts: one that sticks at first, in the paper's units, and one that slips, in SI.
SCENES = [
    Scene.nondimensional(psi1=0.6, chi=0.4),
    Scene(Sphere(6.35e-3, STEEL), HalfSpace(STEEL), 0.15, 1.93, 0.9, -40.0),
]
COARSE = {"annulus": 4, "sharp_annulus": 4, "springs": 6}


class Spoiler:
    """Counts the calls of a run and spoils one, or all from then on; 0 spoils none."""

    def __init__(self, at: int, value: float, *, lasting: bool = False) -> None:
        self.at, self.value, self.lasting, self.calls = at, value, lasting, 0

    def __call__(self, entry):
        """Return ``entry``, or the bad value if its turn has come."""
        self.calls += 1
        if self.calls != self.at and not (self.lasting and self.calls > self.at > 0):
            return entry
        return entry * 0.0 + self.value if isinstance(entry, np.ndarray) else self.value

    @property
    def struck(self) -> bool:
        return self.calls >= self.at > 0


def inert_copy(law, base):
    """Return class attributes of a law for its wrapper."""
    names = ("needs", "offers", "resolution", "inert", "exact", "linear_below")
    found = {name: getattr(law, name) for name in names if hasattr(law, name)}
    return found | {"api_version": 1}


def spoiled_tangential(law, spoil, entry):
    """Wrap a stepped law; ``entry`` names what of its response is spoiled."""

    def advance(self, state, increment, before, after):
        response, state = law.advance(state, increment, before, after)
        return response._replace(**{entry: spoil(getattr(response, entry))}), state

    body = inert_copy(law, SteppedTangentialLaw) | {
        "start": lambda _, problem: law.start(problem),
        "advance": advance,
        "stiffness": lambda _, problem: law.stiffness(problem),
    }
    return attrs.frozen(type("Spoiled", (SteppedTangentialLaw,), body))()


def spoiled_phases(law, spoil, entry):
    """Wrap a phased law: one response of one phase is spoiled."""

    def wrap(phase):
        if type(phase).__name__.startswith("Spoiled"):
            return phase
        kind = type(phase)

        def respond(self, contact, slip, memo):
            response = kind.respond(self, contact, slip, memo)
            return response._replace(**{entry: spoil(getattr(response, entry))})

        def follow(self, *arguments):
            return wrap(kind.follow(self, *arguments))

        def carry_on(self, *arguments):
            return wrap(kind.carry_on(self, *arguments))

        def closed_form(self, *arguments):
            closed = kind.closed_form(self, *arguments)
            if closed is not None:
                closed.end = closed.end._replace(change=spoil(closed.end.change))
            return closed

        body = {
            "respond": respond,
            "follow": follow,
            "carry_on": carry_on,
            "closed_form": closed_form,
            "__slots__": (),
        }
        made = object.__new__(type(f"Spoiled{kind.__name__}", (kind,), body))
        for name in {field.name for field in attrs.fields(kind)}:
            object.__setattr__(made, name, getattr(phase, name))
        return made

    body = inert_copy(law, PhasedTangentialLaw) | {
        "begin": lambda _, *arguments: wrap(law.begin(*arguments)),
    }
    return attrs.frozen(type("Spoiled", (PhasedTangentialLaw,), body))()


class SpoiledMotion(ClosedFormMotion):
    """Wraps a motion in closed form; ``name`` says which of its answers is spoiled."""

    def __init__(self, motion, spoil, name):
        self.motion, self.spoil, self.name = motion, spoil, name

    def _told(self, name, value):
        return self.spoil(value) if name == self.name else value

    def _course(self, name, course):
        if not self.name.startswith(name):
            return course
        entry = self.name.partition(".")[2]
        return course._replace(**{entry: self.spoil(getattr(course, entry))})

    duration = property(lambda self: self._told("duration", self.motion.duration))
    maximum_radius = property(lambda self: self.motion.maximum_radius)
    maximum_approach = property(lambda self: self.motion.maximum_approach)
    maximum_force = property(lambda self: self._told("maximum_force", self.motion.maximum_force))
    scaled_mass = property(lambda self: self.motion.scaled_mass)

    def course(self, phase):
        return self._course("course", self.motion.course(phase))

    def instant(self, phase):
        return self._course("instant", self.motion.instant(phase))

    def phase_at_rate(self, rate):
        return self.motion.phase_at_rate(rate)

    def at(self, phase):
        time, approach, rate, contact = self.motion.at(phase)
        if self.name == "at.rate":
            rate = self._one(rate)
        if self.name == "at.force":
            contact = contact._replace(force=self._one(contact.force))
        if self.name == "at.radius":
            contact = contact._replace(radius=self._one(contact.radius))
        if self.name == "at.time":
            time = self._one(time)
        return time, approach, rate, contact

    def _one(self, rows):
        """Spoil one instant, whether they come one by one or all at once."""
        rows = np.array(rows, dtype=float)
        flat = rows.reshape(-1)
        for place in range(flat.size):
            flat[place] = self.spoil(float(flat[place]))
        return rows

    def phase(self, fraction):
        return self.motion.phase(fraction)

    def pace(self, phase):
        return self.motion.pace(phase)


def spoiled_closed_form(law, spoil, name):
    """Wrap a normal law with a motion in closed form."""
    body = inert_copy(law, ClosedFormNormalLaw) | {
        # No short cut of the plan: the march is what is tested.
        "offers": law.offers,
        "start": lambda _, pair: law.start(pair),
        "respond": lambda _, *arguments: law.respond(*arguments),
        "motion": lambda _, pair, speed: SpoiledMotion(law.motion(pair, speed), spoil, name),
    }
    return attrs.frozen(type("SpoiledHertz", (ClosedFormNormalLaw,), body))()


def spoiled_normal(law, spoil, entry):
    """Wrap a normal law; without closed form, so that every integrator asks it step by step."""

    def respond(self, state, approach, rate):
        contact, state = law.respond(state, approach, rate)
        return contact._replace(**{entry: spoil(getattr(contact, entry))}), state

    body = inert_copy(law, NormalLaw) | {
        "offers": law.offers - {"closed_form_motion", "elastic_hertz"},
        "start": lambda _, pair: law.start(pair),
        "respond": respond,
    }
    return attrs.frozen(type("SpoiledHertz", (NormalLaw,), body))()


def options_of(method):
    law = REGISTRY.law_class(f"tangential.{method.tangential}").resolution
    tangential = {law: COARSE.get(method.tangential, 4)} if law else {}
    name = f"integrator.{method.integrator}"
    step = REGISTRY.law_class(name).resolution
    integrator = {"steps": STEPS} if step == "steps" else {}
    if step == "tolerance":
        integrator = {"tolerance": 1e-3 if method.integrator == "events" else 0.1}
    return (
        contactlab.create(f"tangential.{method.tangential}", **tangential),
        contactlab.create(name, **integrator),
    )


def every_step(make, scene, value, most=400):
    """Spoil call 1, 2, 3, ... until a run ends before its turn; return how many were told of.

    A bad value that nobody used (a trial step that was rejected, an instant of no interest)
    may end in an answer, if that is the clean one.
    """
    first = make(Spoiler(0, value))
    clean = answer(first, scene)
    assert clean is not None
    # Where steps are tried and thrown away, another step is as good, to the tolerance.
    close = 1e-9 if first.integrator.resolution == "steps" else 0.05
    reported = 0
    for lasting in (False, True):
        for at in [*range(1, 41), *np.geomspace(41, most, 12).astype(int).tolist()]:
            spoil = Spoiler(at, value, lasting=lasting)
            found = answer(make(spoil), scene)
            if not spoil.struck:
                break
            TRIED["bad values met"] += 1
            if found is None:
                TRIED["of them reported"] += 1
                reported += 1
                continue
            assert found == pytest.approx(clean, rel=close), (
                f"{value} at call {at}{' and on' if lasting else ''}: {found}, not {clean}"
            )
    return reported


def answer(simulation, scene):
    """Return the numbers of a successful run, None of one that reports a failure."""
    with np.errstate(all="ignore"):
        result = simulation.run(scene)
    try:
        motion = result.check().motion
    except ImpactError:
        return None
    numbers = (motion.slip_velocity_change, motion.normal_velocity, motion.duration)
    work = motion.friction_work / result.energy.start
    return [*map(float, numbers), 1.0 + float(work)]


METHODS = [method for method in methods() if method.tangential != "frictionless"]
STEPPED = [method for method in METHODS if method.integrator != "events"]
PHASED = [method for method in METHODS if method.integrator == "events"]


@pytest.mark.parametrize("value", [NAN, INFINITY])
@pytest.mark.parametrize("method", STEPPED, ids=lambda method: method.name)
def test_tangential_laws_by_steps(method, value):
    law, integrator = options_of(method)
    for entry in ("force", "friction_work"):
        for scene in SCENES:
            assert every_step(
                lambda spoil, entry=entry: Simulation(
                    tangential=spoiled_tangential(law, spoil, entry), integrator=integrator
                ),
                scene,
                value,
            )


@pytest.mark.parametrize("value", [NAN, INFINITY])
@pytest.mark.parametrize("entry", ["force", "radius"])
@pytest.mark.parametrize("method", STEPPED, ids=lambda method: method.name)
def test_normal_laws_by_steps(method, entry, value):
    law, integrator = options_of(method)
    if entry == "radius" and "radius" not in law.needs | law.offers:
        needs = law.needs & {"radius", "hertzian_pressure"}
        if not needs:
            pytest.skip("the law does not look at the radius")
    normal = contactlab.create("normal.hertz")
    for scene in SCENES:
        assert every_step(
            lambda spoil: Simulation(
                normal=spoiled_normal(normal, spoil, entry), tangential=law, integrator=integrator
            ),
            scene,
            value,
        )


@pytest.mark.parametrize("value", [NAN, INFINITY])
@pytest.mark.parametrize("entry", ["at.force", "at.rate", "at.time"])
@pytest.mark.parametrize("method", STEPPED, ids=lambda method: method.name)
def test_motions_in_closed_form_by_steps(method, entry, value):
    law, integrator = options_of(method)
    if "closed_form_motion" not in integrator.uses:
        pytest.skip("does not ask for the motion in closed form")
    normal = contactlab.create("normal.hertz")
    reported = every_step(
        lambda spoil: Simulation(
            normal=spoiled_closed_form(normal, spoil, entry), tangential=law, integrator=integrator
        ),
        SCENES[0],
        value,
    )
    # A rigid body asks for the mean of the force, which comes from the rate.
    assert reported or (method.tangential, entry) == ("coulomb", "at.force")


@pytest.mark.parametrize("value", [NAN, INFINITY])
@pytest.mark.parametrize("method", PHASED, ids=lambda method: method.name)
def test_tangential_laws_by_phases(method, value):
    law, integrator = options_of(method)
    for scene in SCENES:
        every_step(
            lambda spoil: Simulation(
                tangential=spoiled_phases(law, spoil, "force"), integrator=integrator
            ),
            scene,
            value,
        )


@pytest.mark.parametrize("value", [NAN, INFINITY])
@pytest.mark.parametrize("entry", ["course.force", "course.radius", "course.rate", "course.pace"])
@pytest.mark.parametrize("method", PHASED, ids=lambda method: method.name)
def test_motions_in_closed_form_by_events(method, entry, value):
    law, integrator = options_of(method)
    normal = contactlab.create("normal.hertz")
    for scene in SCENES:
        every_step(
            lambda spoil: Simulation(
                normal=spoiled_closed_form(normal, spoil, entry),
                tangential=law,
                integrator=integrator,
            ),
            scene,
            value,
        )
