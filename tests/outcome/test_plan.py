"""What a plan contains: each sentence, the impacts that it is said of, and the declared error."""

import pickle
import re
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status
from contactlab.contracts import (
    NormalContact,
    NormalLaw,
    SteppedTangentialLaw,
    TangentialResponse,
    WholeImpactTangentialLaw,
)
from contactlab.contracts.whole_impact import no_force
from contactlab.outcome.plan import PSI2_ERROR, TANGENTIAL_MOTION
from contactlab_laws.compiled import library, tell
from tests.laws.normal_laws import Damped, ForceFree, LinearSpring, in_si

CHI = 1.4411764706
MIXED = [0.0, 1.2, 9.0, 50.0]
UNDECLARED = "the laws state no bound; run(scene, estimate_error=True) estimates the error"
SPRINGS = {"tangential": "springs", "integrator": "symplectic"}

MARCHED = "friction: springs, followed by symplectic"
RESOLUTION = "resolution: up to 30 springs and 226 steps: by chi + abs(eta), in a compiled march"
if library() is None:
    RESOLUTION = (
        "resolution: up to 50 springs and 200 steps: the usual, as the march is not compiled, "
        + tell()
    )
STATED = "(bound stated by the laws)"
#: What exists and was not needed.
ABSENT = "loss (none given), spin about the normal (none), elliptic contact (round)"


def scene(psi1=1.2):
    return Scene.nondimensional(psi1=psi1, chi=CHI)


def said(sentences):
    """Return each sentence of a batch with the impacts that it is said of."""
    return {sentence.words: sentence.where.tolist() for sentence in sentences}


def test_the_plan_of_one_impact_that_is_marched():
    plan = Simulation(**SPRINGS).plan(scene())
    assert list(map(str, plan.computed)) == [
        "normal motion: hertz, in closed form",
        MARCHED,
        RESOLUTION,
        f"numerical error of psi2: below {plan.psi2_error:.2g} {STATED}",
    ]
    assert list(map(str, plan.left_out)) == [f"{ABSENT}, history (not requested)"]
    assert plan.cautions == ()
    assert plan.marched
    assert str(plan).splitlines()[1] == f"computed: {plan.computed[1]}"
    assert str(plan).splitlines()[-1] == f"left out: {ABSENT}, history (not requested)"


def test_the_plan_of_a_batch_says_which_impacts():
    plan = Simulation(**SPRINGS).plan(scene(MIXED))
    most = np.nanmax(plan.psi2_error)
    assert said(plan.computed) == {
        "normal motion: hertz, in closed form": [True] * 4,
        MARCHED: [
            False, True, False, False,
        ],
        RESOLUTION: [False, True, False, False],
        f"numerical error of psi2: below {most:.2g} {STATED}": [True] * 4,
    }  # fmt: skip
    march = "stepping through the contact: "
    assert said(plan.left_out) == {
        f"{march}central impact, no slip velocity": [True, False, False, False],
        f"{march}the impact slips from start to end, eq. (45)": [False, False, True, True],
        f"{ABSENT}, history (not requested)": [True] * 4,
    }
    assert plan.to_dict()["left_out"] == list(map(str, plan.left_out))
    assert plan.to_dict()["psi2_error"] == plan.psi2_error.tolist()


@pytest.mark.parametrize(
    ("history", "left_out"),
    [
        (False, [f"{ABSENT}, history (not requested)"]),
        (True, [f"{ABSENT}, traction and stick/slip fields (not requested, history='fields')"]),
        ("fields", [ABSENT]),
    ],
)
def test_what_of_the_history_is_left_out(history, left_out):
    plan = Simulation(**SPRINGS).plan(scene(), history=history)
    assert list(map(str, plan.left_out)) == left_out


def test_a_closed_form_is_declared_to_rounding_and_an_integrator_to_its_tolerance():
    """The error of psi2 is 1e-12 max(1, |psi1|) of closed forms, and the tolerance times that."""
    largest = np.maximum(1.0, MIXED)
    solved = Simulation(
        tangential=contactlab.create("tangential.fronts", table=False),
        integrator=contactlab.create("integrator.events", tolerance=1e-5),
    )
    plan = solved.plan(scene(MIXED))
    assert plan.psi2_error[1] == pytest.approx(1.2e-5)
    closed = plan.psi2_error[[0, 2, 3]] / largest[[0, 2, 3]]
    assert ((closed >= 1e-12) & (closed < 1.1e-12)).all()
    assert f"below {1.2e-5:.2g} {STATED}" in str(plan)
    for index, psi1 in enumerate(MIXED):
        alone = solved.plan(scene(psi1)).psi2_error
        assert alone == pytest.approx(plan.psi2_error[index], rel=1e-12)


@attrs.frozen(kw_only=True)
class Clutches(NormalLaw):
    """A linear spring, that holds what comes faster than 1 m/s for ever at an overlap of 1 m."""

    api_version: ClassVar[int] = 2

    def start(self, scene):
        return np.where(np.asarray(scene.normal_speed) > 1.0, 1.0, 0.0)

    def respond(self, state, approach, rate):
        overlap = np.maximum(approach, state)
        if np.ndim(approach) == 0:
            overlap = float(overlap)
        return NormalContact(1e7 * approach, 0.0 * approach, overlap), state


def test_a_solved_normal_motion_is_not_declared_exact():
    """Its load impulse is good to 1e-7, and friction can change psi by 4 chi."""
    plan = Simulation(normal=LinearSpring(), tangential="coulomb").plan(in_si(scene(MIXED)))
    assert plan.psi2_error == pytest.approx(np.full(4, 4e-7 * CHI), rel=1e-3)
    assert "integrated from first touch to separation" in str(plan)


def test_impacts_that_do_not_part_are_left_out_and_nothing_is_said_of_their_numbers():
    steel = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
    speeds = np.array([0.5, 2.0, 0.7])
    batch = Scene(Sphere(0.01, steel), HalfSpace(steel), 0.1, speeds, 0.05)
    result = Simulation(normal=Clutches(), tangential="coulomb").run(batch)
    parted = [True, False, True]
    assert [status is Status.SUCCESS for status in result.status] == parted
    came = "stepping through the contact: the bodies did not separate"
    assert said(result.plan.left_out)[came] == [False, True, False]
    errors = [where for text, where in said(result.plan.computed).items() if "error" in text]
    assert errors == [parted]
    assert result.plan.cautions
    none = Simulation(normal=ForceFree(), tangential="coulomb").plan(scene())
    assert none.cautions == ()
    assert "error" not in str(none)


def test_undeclared_errors_are_said_of_the_impacts_that_are_marched():
    """Of a damped contact the springs declare nothing; a central impact is known without them."""
    plan = Simulation(normal=Damped(), **SPRINGS).plan(in_si(scene([0.0, 1.2])))
    told = said(plan.computed)
    assert told[f"numerical error of psi2: {UNDECLARED}"] == [False, True]
    declared = [text for text, where in told.items() if where == [True, False]]
    assert re.fullmatch(r"numerical error of psi2: below 5.8e-07 .*", declared[0])


def test_a_sweep_in_parts_has_the_plan_of_the_whole():
    """Sentences that differ in their numbers only are one."""
    psi1 = [0.0, 0.5, 1.2, 9.0, 0.0, 50.0]
    simulation = Simulation(**SPRINGS)
    whole = simulation.plan(scene(psi1))
    parts = simulation.sweep(scene(psi1), chunk=2).plan
    assert parts.marched.tolist() == whole.marched.tolist()
    np.testing.assert_array_equal(parts.psi2_error, whole.psi2_error)
    for kind in ("computed", "left_out", "cautions"):
        joined = {str(text).partition(" below")[0]: where
                  for text, where in said(getattr(parts, kind)).items()}  # fmt: skip
        once = {str(text).partition(" below")[0]: where
                for text, where in said(getattr(whole, kind)).items()}  # fmt: skip
        assert joined == once


@attrs.frozen(kw_only=True)
class Partly(WholeImpactTangentialLaw):
    """Knows impacts below psi = 2 only, in a contract that promises all."""

    api_version: ClassVar[int] = 2
    change: object = 0.0

    def whole_impacts(self, scene, normal):
        slow = np.abs(scene.slip_velocity) < 2.0
        known = no_force(scene, where=slow, reason="slow")
        return (attrs.evolve(known, slip_velocity_change=self.change),)


@pytest.mark.parametrize("psi1", [3.0, [1.0, 3.0, 1.5]])
def test_a_law_of_whole_impacts_that_leaves_some_out_is_named(psi1):
    result = Simulation(tangential=Partly()).run(scene(psi1))
    left_out = np.array(result.status, dtype=object) == Status.MALFORMED
    assert left_out.tolist() == (np.array(psi1) > 2.0).tolist()
    assert list(result.failures) == np.flatnonzero(left_out).tolist()
    for sentence in result.failures.values():
        assert "no answer to some impacts" in sentence
        assert "Partly" in sentence


@pytest.mark.parametrize("psi1", [1.0, [0.5, 1.0]])
@pytest.mark.parametrize("change", [None, "0", 1j, np.zeros(3)])
def test_an_answer_that_is_no_number_is_named(psi1, change):
    result = Simulation(tangential=Partly(change=change)).run(scene(psi1))
    assert {*np.ravel(np.array(result.status, dtype=object))} == {Status.MALFORMED}
    assert "to a whole impact" in result.failures[0]


def test_the_error_of_a_sweep_in_parts_is_the_largest_of_its_parts():
    """Of prose that was merged the number of the first part stayed: 9e-12."""
    psi1 = [9.0, 10.0, 5e3, 6e3]
    plan = Simulation(tangential="coulomb").sweep(scene(psi1), chunk=2).plan
    (words,) = (clause.words for clause in plan.computed if "error" in clause.text)
    assert words == f"numerical error of psi2: below {plan.psi2_error.max():.2g} {STATED}"
    assert plan.psi2_error.max() > 100.0 * plan.psi2_error[0]
    (first,) = (clause.words for clause in plan[0].computed if "error" in clause.text)
    assert first == f"numerical error of psi2: below {plan.psi2_error[0]:.2g} {STATED}"


def test_one_impact_of_a_batch_has_the_clauses_that_are_said_of_it():
    plan = Simulation(**SPRINGS).plan(scene(MIXED))
    alone = [Simulation(**SPRINGS).plan(scene(psi1)) for psi1 in MIXED]
    assert [str(plan[index]) for index in range(len(MIXED))] == list(map(str, alone))


@attrs.frozen(kw_only=True)
class Doubtful(SteppedTangentialLaw):
    """Says how many impacts it was asked about, and counts how often."""

    api_version: ClassVar[int] = 2
    asked: ClassVar[list] = []

    def cautions(self, scene, normal):
        self.asked.append(scene.shape)
        return (f"doubt: {np.max(normal.maximum_force):.3g} N over {scene.shape}, law's {{odd}} 3",)

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        return TangentialResponse(0.0 * increment.velocity, 0.0 * increment.velocity), state


def test_a_plan_is_worded_once_from_the_whole_batch_when_it_is_read_and_may_travel_before(tmp_path):
    """The words of one impact cost more than its closed form; nobody may read them."""
    Doubtful.asked.clear()
    simulation = Simulation(tangential=Doubtful(), integrator="symplectic")
    batch = scene([0.5, 1.2, 9.0, 50.0])
    for keep in (None, tmp_path / "kept", tmp_path / "kept"):
        result = simulation.sweep(batch, chunk=1, keep=keep)
        assert not Doubtful.asked
        travelled = pickle.loads(pickle.dumps(result.plan))
        force = result.motion.maximum_force.max()
        expected = f"doubt: {force:.3g} N over (4,), law's {{odd}} 3"
        for plan in (result.plan, travelled, result.plan[1]):
            assert list(map(str, plan.cautions)) == [expected]
        assert Doubtful.asked == [(4,)]
        Doubtful.asked.clear()
        assert [clause.code for clause in travelled.computed] == ["", TANGENTIAL_MOTION, PSI2_ERROR]
        assert str(travelled) == str(result.plan) == str(simulation.plan(batch))
        Doubtful.asked.clear()
    other = result.plan.change(left_out=(), psi2_error=0.5)
    assert (other.left_out, other.psi2_error) == ((), 0.5)
    assert other.computed == result.plan.computed


class Bare(NormalLaw):
    """A linear spring that is no attrs class."""

    api_version: ClassVar[int] = 2

    def start(self, scene):
        return None

    def respond(self, state, approach, rate):
        pressed = approach * (approach > 0.0)
        return NormalContact(pressed, 0.0 * pressed, approach), state


@attrs.frozen(kw_only=True)
class Wrapping(Bare):
    """A law with options that are a law and a function."""

    inner: object = None
    scale: object = None


NAMED = [
    ({"tangential": "springs"}, "springs, followed by symplectic"),
    (
        {
            "tangential": contactlab.create("tangential.springs", springs=100, grid="doubling"),
            "integrator": contactlab.create("integrator.symplectic", steps=400),
        },
        "springs (springs=100, grid='doubling'), followed by symplectic (steps=400)",
    ),
    ({"normal": contactlab.create("normal.tsuji", restitution=0.9), **SPRINGS}, ": tsuji, in"),
    (
        {"normal": contactlab.create("normal.tsuji", restitution=0.8), **SPRINGS},
        "(restitution=0.8)",
    ),
    ({"normal": Bare(), "tangential": "linear_spring"}, "normal motion: Bare,"),
    (
        {"normal": Wrapping(inner=contactlab.create("normal.hertz"), scale=scene)},
        "normal motion: Wrapping (inner=hertz, scale=<function scene>)",
    ),
]


@pytest.mark.parametrize(("laws", "words"), NAMED)
def test_a_plan_names_laws_by_their_names_and_the_options_that_are_no_defaults(laws, words):
    told = str(Simulation(**{"tangential": "linear_spring"} | laws).plan(scene()))
    assert words in told
    assert "0x" not in told  # the address of an object
