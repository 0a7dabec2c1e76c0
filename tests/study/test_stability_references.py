"""The references of the stability report: who judges whom, and when an answer has settled."""

from types import SimpleNamespace

import attrs
import pytest

from contactlab import Scene, create
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.contracts.status import Status
from contactlab.study import stability_references as references
from contactlab.study.stability_references import (
    continuum,
    fine_under,
    finer,
    itself,
    judging_laws,
    reference_for,
    rigid,
)

UNIT = Scene.nondimensional(psi1=9.0, chi=1.0)  # the range is 4, the tangential mass 1/2


class Scripted:
    """Simulations that answer with the numbers given, in turn; None is a failure."""

    def __init__(self, *answers, steps=None):
        self.answers, self.laws, self.steps = list(answers), [], steps

    def __call__(self, **laws):
        self.laws.append(laws)
        return SimpleNamespace(run=self.run, normal_motion=lambda _: SimpleNamespace(duration=2.0))

    def run(self, _):
        value = self.answers.pop(0)
        status = Status.SUCCESS if value is not None else Status.UNSETTLED
        counters = {} if self.steps is None else {"steps": self.steps.pop(0)}
        motion = SimpleNamespace(slip_velocity_change=value)
        return SimpleNamespace(status=status, motion=motion, counters=counters)


@pytest.fixture
def scripted(monkeypatch):
    for cached in (fine_under, finer, references._fine, references._exact):
        cached.cache_clear()

    def use(*answers, **words):
        simulation = Scripted(*answers, **words)
        monkeypatch.setattr(references, "Simulation", simulation)
        return simulation

    yield use
    for cached in (fine_under, finer, references._fine, references._exact):
        cached.cache_clear()


def names(classes):
    return [each.__name__ for each in dict.fromkeys(classes)]


def test_a_law_is_judged_by_others_with_its_limit_first():
    """Rings of annuli have Coulomb's law at a point; springs and sharp annuli another limit."""
    damped = create("normal.tsuji")
    for law, judges in {
        "springs": ["SharpAnnulus", "Annulus"],
        "sharp_annulus": ["Springs", "Annulus"],
        "annulus": ["Annulus", "Springs", "SharpAnnulus"],  # by itself: no other has its limit
        "fronts": ["Annulus", "Springs", "SharpAnnulus"],
    }.items():
        assert names(judging_laws(damped, create(f"tangential.{law}"))) == judges


def test_a_broken_law_judges_nobody(monkeypatch):
    create_any = type(REGISTRY).create

    def broken(self, name, **options):
        if name.endswith("sharp_annulus"):
            raise PluginError("broken")
        return create_any(self, name, **options)

    springs, damped = create("tangential.springs"), create("normal.tsuji")
    monkeypatch.setattr(type(REGISTRY), "create", broken)
    assert names(judging_laws(damped, springs)) == ["Springs", "Annulus"]


def test_each_law_has_its_kind_of_reference():
    elastic, damped = create("normal.hertz"), create("normal.jkr")

    def of(law, normal, **options):
        return reference_for(create(f"tangential.{law}", **options), normal)

    assert of("frictionless", elastic)(UNIT, None) == 0.0
    assert of("coulomb", elastic) is rigid
    assert of("coulomb", damped).func is references._rigid_under
    assert of("halfspace", elastic).func is finer
    assert of("springs", elastic) is of("fronts", elastic) is continuum
    assert of("springs", damped).func is references._other_law
    assert of("walton", elastic) is of("mindlin_cap", elastic) is itself
    assert of("mindlin_cap", damped)(UNIT, None) is None


@pytest.mark.parametrize(
    ("psi1", "change"),
    [(9.0, -0.6), (-9.0, 0.6), (0.59, -0.59), (-0.61, 0.6), (0.0, 0.0)],
)
def test_a_rigid_body_is_slowed_by_the_impulse_of_the_load(psi1, change, monkeypatch):
    """An impulse of 0.3 over a mass of 1/2, but no more than the slip."""
    monkeypatch.setattr(references, "load_impulse", lambda *_: 0.3)
    scene = Scene.nondimensional(psi1=psi1, chi=1.0)
    assert references._rigid_under(None, scene, None) == pytest.approx(change)


def test_the_impulse_of_the_load_is_that_of_the_normal_law():
    """Elastic: twice the momentum of 1. A linear dashpot without damping has the same."""
    hertz, linear = create("normal.hertz"), create("normal.linear", restitution=1.0)
    for law in (hertz, linear):
        assert references.load_impulse(UNIT, law) == pytest.approx(2.0, rel=1e-9)


def test_a_rigid_body_far_beyond_slip_keeps_its_digits():
    """At psi1 = 1e7 the change is 4 chi to all digits, though psi2 holds nine of them."""
    for sign in (1.0, -1.0):
        scene = Scene.nondimensional(psi1=sign * 1e7, chi=1 / 3)
        assert rigid(scene, None) == -sign * 4 / 3
    still = attrs.evolve(UNIT, tangential_velocity=0.0)
    assert rigid(still, None) == 0.0


def test_the_exact_solution_is_asked_again_at_a_coarser_tolerance(scripted):
    first = scripted(None, -1.5)
    assert continuum(UNIT, None) == -1.5
    tolerances = [laws["integrator"].tolerance for laws in first.laws]
    assert tolerances == [1e-11, 1e-9]
    references._exact.cache_clear()
    scripted(None, None)
    assert continuum(UNIT, None) is None
    references._exact.cache_clear()
    once = scripted(-1.4)
    assert continuum(UNIT, None) == -1.4
    assert len(once.laws) == 1


def test_the_first_law_that_settles_judges(monkeypatch):
    answers = {"a": None, "b": -2.0, "c": -3.0}
    monkeypatch.setattr(references, "fine_under", lambda *words: answers[words[2]])
    assert references._other_law(None, ["a", "b", "c"], UNIT, None) == -2.0
    assert references._other_law(None, ["a"], UNIT, None) is None


@pytest.mark.parametrize(
    ("answers", "change"),
    [
        # 3e-3 of the range of 4 is 0.012.
        ((-1.0, -1.0119), -1.0119),
        ((-1.0, -1.0121, -1.0), None),  # the list ends
        ((-1.0, -1.1, -1.2, -1.3, -1.4, -1.5), None),
        ((-1.0, -1.1, -1.2, -1.3, -1.4, -1.4), -1.4),
        ((-1.0, None), None),
        ((None,), None),
    ],
)
def test_a_fine_law_has_settled_where_a_doubling_changes_little(answers, change, scripted):
    run = scripted(*answers, *([None] if len(answers) == 3 else []))
    springs, jkr = REGISTRY.law_class("tangential.springs"), create("normal.jkr")
    assert fine_under(UNIT, jkr, springs) == change
    assert run.answers == []
    parts = [50 * 2**k for k in range(len(run.laws))]
    assert [laws["tangential"].springs for laws in run.laws] == parts
    assert [laws["integrator"].steps for laws in run.laws] == [8 * count for count in parts]
    assert {laws["normal"] for laws in run.laws} == {jkr}


def test_a_law_of_whole_impacts_is_run_at_twice_its_resolution(scripted):
    law, normal = create("tangential.halfspace", rings=8), create("normal.hertz")
    run = scripted(-1.25)
    assert finer(normal, UNIT, law) == -1.25
    assert run.laws[0]["tangential"].rings == 16
    finer.cache_clear()
    scripted(None)
    assert finer(normal, UNIT, law) is None
    finest = create("tangential.halfspace", rings=96)  # the most that the law accepts
    scripted()
    assert finer(normal, UNIT, finest) is None


class Stiff:
    """A stepped law of a constant stiffness."""

    def __init__(self, frequency):
        self.frequency = frequency

    def stiffness(self, scene, normal):
        return self.frequency**2 * scene.pair.tangential_mass


@pytest.mark.parametrize(
    ("frequency", "first"),
    # Four times half the frequency times the duration of 2, and one more; 1000 at least.
    [(700.5, 2804), (10.0, 1000), (249.5, 1000), (250.5, 1004)],
)
def test_steps_begin_above_the_stability_limit(frequency, first, scripted):
    run = scripted(None)
    assert references._fine(UNIT, Stiff(frequency)) is None
    assert [laws["integrator"].steps for laws in run.laws] == [1000, first]


def test_an_answer_by_itself_is_extrapolated_at_second_order(scripted):
    """Errors of 3, 3/4 and 3/16: each extrapolation is exact, the second confirms the first."""
    run = scripted(-1.0 + 0.3, -1.0 + 0.3 / 4.0, -1.0 + 0.3 / 16.0)
    assert references._fine(UNIT, Stiff(1.0)) == pytest.approx(-1.0, abs=1e-15)
    assert [laws["integrator"].steps for laws in run.laws] == [1000, 1000, 2000, 4000]


@pytest.mark.parametrize(("off", "settled"), [(2.9e-5, True), (3.1e-5, False)])
def test_it_has_settled_within_a_share_of_the_range(off, settled, scripted):
    """The extrapolations differ by 4/3 of what the third answer is off; the range is 4."""
    third = -1.0 + 4.0 * off * 0.75
    scripted(-1.0, -1.0, third, None)
    found = references._fine(UNIT, Stiff(1.0))
    assert found == (pytest.approx(-1.0 + 4.0 * off) if settled else None)


def test_steps_that_were_refined_are_doubled_and_end_at_the_most(scripted):
    run = scripted(-1.0, -2.0, -3.0, steps=[70_000, 100_000, 100_001])
    assert references._fine(UNIT, Stiff(1.0)) is None
    steps = [laws["integrator"].steps for laws in run.laws]
    assert steps == [1000, 1000, 140_000, 200_000]


def test_only_a_stepped_law_is_judged_by_itself():
    assert itself(UNIT, create("tangential.walton")) is None
