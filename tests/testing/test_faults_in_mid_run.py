"""A law that fails in the middle of a run is named, with step and time; others are not harmed."""

import itertools
import math
import re
import warnings
from typing import Any, ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import ImpactError, Scene, Simulation, Status
from contactlab.contracts import (
    NormalContact,
    NormalLaw,
    PathTangentialLaw,
    SteppedTangentialLaw,
    Stretch,
    TangentialResponse,
)
from contactlab.testing.faulty_laws import SpoiledHertz

AT = 7
#: The normal motion is solved in a few long steps.
NORMAL_AT = 4
SCENE = Scene.nondimensional(psi1=1.2, chi=1.44)
BATCH = Scene.nondimensional(psi1=np.array([0.5, 1.2, 3.0]), chi=1.44)
STEPPING = ("paper", "symplectic", "adaptive")


@attrs.frozen(kw_only=True)
class Friction(SteppedTangentialLaw):
    """Slip, and at one step something else; the state counts the steps."""

    api_version: ClassVar[int] = 2
    answer: Any = None

    def start(self, scene, normal):
        return 0

    def advance(self, state, increment, before, after):
        force = after.friction_load * (1.0 + 0.0 * increment.velocity)
        sound = TangentialResponse(force, 0.0 * force), state + 1
        return self.answer(*sound) if state + 1 == AT else sound


@attrs.frozen(kw_only=True)
class Press(NormalLaw):
    """A linear spring, and from one step on something else; the state counts the steps."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius"})
    answer: Any = None

    def start(self, scene):
        return 0

    def respond(self, state, approach, rate):
        deep = approach * (approach > 0.0)
        sound = NormalContact(2.0 * deep, deep, approach), state + 1
        return self.answer(*sound) if state + 1 >= NORMAL_AT else sound


def raises(response, state):
    raise KeyError("stiffness")


def divides(response, state):
    return 1 / 0


TANGENTIAL = {
    "raises": (raises, Status.LAW_RAISED, "KeyError: 'stiffness'"),
    "divides": (divides, Status.LAW_RAISED, "ZeroDivisionError"),
    "None": (lambda *_: None, Status.LAW_RAISED, "TypeError"),
    "a number": (lambda *_: 0.0, Status.LAW_RAISED, "TypeError"),
    "three": (lambda response, state: (response, state, 1), Status.LAW_RAISED, "ValueError"),
    "no force": (lambda r, s: (r._replace(force=None), s), Status.MALFORMED, "None"),
    "text": (lambda r, s: (r._replace(force="0"), s), Status.MALFORMED, "'0'"),
    "complex": (lambda r, s: (r._replace(force=r.force + 0j), s), Status.MALFORMED, "j"),
    "wide": (
        lambda r, s: (r._replace(force=np.stack([r.force] * 2)), s),
        Status.MALFORMED,
        "array",
    ),
    "column": (
        lambda r, s: (r._replace(force=np.atleast_1d(r.force)[:, None]), s),
        Status.MALFORMED,
        "array",
    ),
    "work": (
        lambda r, s: (r._replace(friction_work=r.friction_work + 1j), s),
        Status.MALFORMED,
        "j",
    ),
    "no work": (lambda r, s: (r._replace(friction_work=None), s), Status.MALFORMED, "None"),
    "nan": (lambda r, s: (r._replace(force=r.force * np.nan), s), Status.NON_FINITE, "nan"),
    "infinite": (lambda r, s: (r._replace(force=r.force + np.inf), s), Status.NON_FINITE, "inf"),
    "unsettled": (lambda r, s: (r._replace(settled=False), s), Status.UNSETTLED, "no division"),
}
NORMAL = {
    "raises": (raises, Status.LAW_RAISED, "KeyError: 'stiffness'"),
    "None": (lambda *_: None, Status.LAW_RAISED, "TypeError"),
    "half": (lambda _, state: (None, state), Status.LAW_RAISED, "TypeError"),
    "nan": (lambda c, s: (NormalContact(*[c.force * np.nan] * 3), s), Status.NON_FINITE, "nan"),
    "nan force": (lambda c, s: (c._replace(force=c.force * np.nan), s), Status.NON_FINITE, "nan"),
    "nan load": (
        lambda c, s: (c._replace(friction_load=c.force * np.nan), s),
        Status.NON_FINITE,
        "nan",
    ),
    "negative load": (
        lambda c, s: (c._replace(friction_load=-c.force), s),
        Status.MALFORMED,
        "load below zero",
    ),
    "infinite": (lambda c, s: (c._replace(force=c.force + np.inf), s), Status.NON_FINITE, "inf"),
    "wide": (
        lambda c, s: (c._replace(force=np.stack([c.force] * 2)), s),
        Status.MALFORMED,
        "array",
    ),
}


def often(fault, tangential, integrator):
    """Return whether a normal law's fault is met by default: each fault, law and integrator is."""
    if tangential == "coulomb":
        return integrator == "symplectic" or fault == "raises"
    return tangential == "springs" and fault == "nan"


def watchable(scene, integrator):
    """Return whether there is a history: impacts of a batch may have instants of their own."""
    return True


def one_status(result):
    statuses = {*np.ravel(np.asarray(result.status, dtype=object))}
    assert len(statuses) == 1
    return statuses.pop()


def told(result):
    """The sentence of the first impact."""
    return np.ravel(np.asarray(result.motion.detail, dtype=object))[0]


@pytest.mark.parametrize("scene", [SCENE, BATCH], ids=["one", "batch"])
@pytest.mark.parametrize("integrator", STEPPING)
@pytest.mark.parametrize("fault", TANGENTIAL)
def test_a_tangential_law_is_named_with_step_and_time(fault, integrator, scene):
    answer, status, words = TANGENTIAL[fault]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = Simulation(tangential=Friction(answer=answer), integrator=integrator).run(
            scene, history=watchable(scene, integrator)
        )
    assert one_status(result) is status
    assert re.match(rf"At step {AT}, time \S+ s: .*Friction", told(result))
    assert words in told(result)
    if result.history:
        assert AT - 1 <= len(result.history.time) <= AT
        assert (np.asarray(result.history.time) > 0.0).all()
    with pytest.raises(ImpactError, match=f"At step {AT}"):
        result.check()


@pytest.mark.parametrize("scene", [SCENE, BATCH], ids=["one", "batch"])
@pytest.mark.parametrize(
    ("fault", "tangential", "integrator"),
    [
        pytest.param(*case, marks=[pytest.mark.slow] * (not often(*case)))
        for case in itertools.product(NORMAL, ("coulomb", "springs", "frictionless"), STEPPING)
    ],
)
def test_a_normal_law_is_named(fault, tangential, integrator, scene):
    answer, status, words = NORMAL[fault]
    simulation = Simulation(
        normal=Press(answer=answer), tangential=tangential, integrator=integrator
    )
    result = simulation.run(scene, history=watchable(scene, integrator))
    assert one_status(result) is status
    assert re.match(rf"At step {NORMAL_AT}, time \S+ s: ", told(result))
    assert re.search(f"{words}|not finite|not a NormalContact", told(result))
    assert "Press" in told(result)
    assert one_status(simulation.run(scene)) is status  # unwatched, steps may be taken at once


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
@pytest.mark.parametrize("fault", ["raises", "None", "text", "nan"])
def test_the_motion_so_far_is_kept(fault, integrator):
    """Six of all the steps acted before the fault."""
    answer, _, _ = TANGENTIAL[fault]
    simulation = Simulation(tangential=Friction(answer=answer), integrator=integrator)
    result = simulation.run(SCENE, history=True)
    assert result.motion.counters["steps"] == AT
    assert np.isnan(result.psi2)
    so_far = result.history.slip_velocity[AT - 2] - SCENE.slip_velocity
    assert -0.1 < so_far < 0.0


@attrs.frozen(kw_only=True)
class WritesInPlace(Friction):
    """Damps the velocity that it is given, in place."""

    def advance(self, state, increment, before, after):
        velocity = increment.velocity
        velocity *= 0.999
        return super().advance(state, increment, before, after)


@pytest.mark.parametrize("integrator", STEPPING)
def test_a_law_that_writes_into_what_it_is_given_is_reported_and_changes_nothing(integrator):
    kept = np.array(BATCH.slip_velocity)
    simulation = Simulation(tangential=WritesInPlace(answer=raises), integrator=integrator)
    result = simulation.run(BATCH, history=watchable(BATCH, integrator))
    assert one_status(result) is Status.LAW_RAISED
    assert "read-only" in told(result)
    assert "WritesInPlace" in told(result)
    assert np.array_equal(BATCH.slip_velocity, kept)


@attrs.frozen(kw_only=True)
class Unready(Friction):
    """Friction that cannot even start."""

    def start(self, scene, normal):
        raise KeyError("stiffness")


@pytest.mark.parametrize("scene", [SCENE, BATCH], ids=["one", "batch"])
@pytest.mark.parametrize("integrator", STEPPING)
def test_a_law_that_raises_at_the_start_is_named(integrator, scene):
    result = Simulation(tangential=Unready(), integrator=integrator).run(scene)
    assert one_status(result) is Status.LAW_RAISED
    assert re.match(
        r"At step [01](, time 0 s)?: KeyError: 'stiffness' \(start, .*Unready", told(result)
    )


@pytest.mark.parametrize("integrator", STEPPING)
def test_a_normal_law_that_raises_at_the_start_is_named(integrator):
    @attrs.frozen(kw_only=True)
    class Limp(Press):
        def start(self, scene):
            raise KeyError("stiffness")

    result = Simulation(normal=Limp(), tangential="coulomb", integrator=integrator).run(SCENE)
    assert one_status(result) is Status.LAW_RAISED
    assert re.match(r"At step 1.*: KeyError: 'stiffness' \(start, .*Limp", told(result))


@attrs.frozen
class Gliding(Stretch):
    """A stretch without force; its states may raise."""

    stop: float
    raises: bool
    start = change = work = 0.0

    def states(self, contact):
        if self.raises:
            raise KeyError("stiffness")
        return 0.0 * contact.force, 0.0 * contact.force


@attrs.frozen(kw_only=True)
class Stumbling(PathTangentialLaw):
    """A law of one stretch, which raises before it, after it, or in its history."""

    api_version: ClassVar[int] = 2
    at: str = "once"

    def path(self, velocity, inertia, motion, tolerance):
        if self.at == "once":
            raise KeyError("stiffness")
        yield Gliding(2.9 if self.at == "later" else math.pi, self.at == "history")
        raise KeyError("stiffness")


@pytest.mark.parametrize("scene", [SCENE, BATCH], ids=["one", "batch"])
@pytest.mark.parametrize("at", ["once", "later"])
def test_a_law_of_paths_that_raises_is_named(at, scene):
    law = Stumbling(at=at)
    result = Simulation(tangential=law, integrator="events").run(scene, history=True)
    assert one_status(result) is Status.LAW_RAISED
    assert re.match(
        r"At step [12]: KeyError: 'stiffness' \(path, .* at x = \S+ from Stumbling",
        told(result),
    )
    assert np.all(np.asarray(result.history.time) >= 0.0)
    assert at == "once" or len(result.history.time) > 1


def test_a_law_of_paths_that_raises_in_its_history_is_named():
    law = Stumbling(at="history")
    result = Simulation(tangential=law, integrator="events").run(SCENE, history=True)
    assert one_status(result) is Status.LAW_RAISED
    assert "KeyError: 'stiffness' (states" in told(result)


def test_a_law_is_named_with_its_module_and_its_version(monkeypatch):
    soft = contactlab.create("tangential.coulomb")
    press = Press(answer=NORMAL["raises"][0])
    result = Simulation(normal=press, tangential=soft, integrator="symplectic").run(SCENE)
    assert f"from Press in {Press.__module__}." in told(result)

    def raising(self, scene, normal):
        raise ZeroDivisionError("of a law")

    monkeypatch.setattr(type(soft), "whole_impacts", raising)
    result = Simulation(tangential=soft).run(SCENE)
    assert "from Coulomb in contactlab_laws.coulomb." in told(result)
    assert f"coulomb (contactlab {contactlab.__version__})" in result.laws.values()


def test_contact_that_never_ends_is_bounded_and_said():
    def floats(contact, state):
        return contact, state

    @attrs.frozen(kw_only=True)
    class Sticky(Press):
        def respond(self, state, approach, rate):
            return NormalContact(0.0 * approach, 0.0 * approach, 1.0 + 0.0 * approach), state

    for integrator in STEPPING:
        result = Simulation(
            normal=Sticky(answer=floats), tangential="coulomb", integrator=integrator
        ).run(SCENE)
        assert result.status is Status.NOT_SEPARATED


def test_a_fault_harms_no_other_run():
    sound = Simulation(tangential="annulus", integrator="symplectic")
    before = sound.run(SCENE).psi2
    for answer, _, _ in TANGENTIAL.values():
        Simulation(tangential=Friction(answer=answer), integrator="symplectic").run(SCENE)
    assert sound.run(SCENE).psi2 == before


def test_a_part_of_a_spoiled_motion_is_as_spoiled():
    """The kit takes single impacts of batches along it."""
    law = SpoiledHertz()
    part = law.motion(BATCH).take(1)
    sound = contactlab.create("normal.hertz").motion(BATCH).take(1)
    assert part.law is law
    assert part.at(0.5).approach == sound.at(0.5).approach
    assert np.isnan(part.at(2.0).approach)
