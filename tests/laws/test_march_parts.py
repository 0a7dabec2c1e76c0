"""Parts of the marches: numbers of steps, errors by hand, and faults in one call."""

from types import SimpleNamespace

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, Status, create
from contactlab.contracts import AllStepsResponse, AllStepsTangentialLaw, TangentialResponse
from contactlab_laws.march import adaptive, division, fixed
from contactlab_laws.march.fixed import needed_steps, refined

SCENE = Scene.nondimensional(psi1=2.0, chi=1.2)
PAIR = Scene.nondimensional(psi1=np.array([2.0, 0.5]), chi=1.2)


#: Of two tangential masses.
APART = Scene.nondimensional(psi1=np.array([2.0, 0.5]), chi=np.array([1.2, 1.5]))


def motion(scene=SCENE):
    return Simulation(tangential="coulomb").normal_motion(scene)


@pytest.mark.parametrize(
    ("needed", "taken"),
    [(7.0, 32), (32.0, 32), (32.5, 40), (40.0, 40), (41.0, 50), (63.0, 63), (64.0, 79)],
)
def test_steps_are_raised_by_a_quarter_at_a_time(needed, taken):
    """32, 40, 50, 63 and 79: each the last times 1.25, rounded up."""
    assert refined(32, needed) == taken
    assert refined(32, np.array([1.0, needed, np.nan])).tolist() == [32, taken, np.inf]


@pytest.mark.parametrize(
    ("needed", "taken"), [(99.0, 100), (100.0, 100), (101.0, np.inf), (np.inf, np.inf)]
)
def test_steps_end_at_the_most_that_are_taken(needed, taken, monkeypatch):
    monkeypatch.setattr(fixed, "MOST_STEPS", 100)
    assert refined(90, needed) == taken
    assert refined(90, np.array([needed]))[0] == taken


@attrs.frozen(kw_only=True)
class Stiff(AllStepsTangentialLaw):
    """A stiffness with which the contact oscillates by so many radians; forces and works given."""

    api_version = 2
    radians: float = 1.0
    offers: frozenset = frozenset()
    force: float = 0.0
    at: int = 0
    work: float = 0.0
    settled: bool = True
    stepwise: bool = False

    def stiffness(self, scene, normal):
        return scene.pair.tangential_mass * (self.radians / normal.duration) ** 2

    def start(self, scene, normal):
        return 0

    def advance(self, state, increment, before, after):
        force = (self.force if state == self.at else 0.0) + 0.0 * increment.displacement
        work = self.work + 0.0 * increment.displacement
        return TangentialResponse(force, work, self.settled), state + 1

    def advance_all(self, scene, normal, steps):
        if self.stepwise:
            return None
        forces = np.zeros(len(steps.kick))
        forces[self.at] = self.force
        return AllStepsResponse(forces, self.work, self.settled)


@pytest.mark.parametrize(
    ("radians", "steps", "microslip"),
    [
        (1.0, 7, 7),  # half an oscillation of the load by steps of half a radian
        (4.0, 8, 8),
        (10.0, 29, 20),  # 10 sqrt(10/1.2) = 28.9
        (30.0, 150, 60),
        (np.inf, np.inf, np.inf),
    ],
)
def test_steps_resolve_the_fastest_oscillation(radians, steps, microslip):
    for offers, expected in ((frozenset(), steps), (frozenset({"partial_slip"}), microslip)):
        law = Stiff(radians=radians, offers=offers)
        assert needed_steps(motion(), law) == expected
        assert needed_steps(motion(APART), law).tolist() == [expected] * 2


def test_a_stiffness_that_is_no_number_is_refused_alone():
    """It ended in an IndexError, of which the integrator was accused."""

    @attrs.frozen(kw_only=True)
    class Lost(Stiff):
        def stiffness(self, scene, normal):
            stiffness = super().stiffness(scene, normal) + 0.0 * scene.slip_velocity
            return np.where(scene.slip_velocity > 1.0, np.nan, stiffness)

    for name in ("symplectic", "paper", "adaptive"):
        march = create(f"integrator.{name}")
        found = march.integrate(motion(PAIR), Lost(stepwise=True), PAIR)
        assert found.status.tolist() == [Status.TOO_FEW_STEPS, Status.SUCCESS]
        assert found.detail[0].endswith("this scene needs at least nan.")
        alone = march.integrate(motion(), Lost(stepwise=True), SCENE)
        assert alone.status is Status.TOO_FEW_STEPS


def of_steps(scene=SCENE, *, radians=1.0, **options):
    simulation = Simulation(
        tangential=Stiff(radians=radians), integrator=create("integrator.symplectic", **options)
    )
    return simulation, simulation.plan(scene)


@pytest.mark.parametrize(
    ("options", "radians", "most", "sentence", "status"),
    [
        ({"steps": 29}, 10.0, 1000, None, Status.SUCCESS),
        (
            {"steps": 28},
            10.0,
            1000,
            "steps raised from 28 to 35: fewer do not resolve the stiffness",
            Status.SUCCESS,
        ),
        (
            {"steps": 28, "refine": False},
            10.0,
            1000,
            "28 steps are too few: this scene needs 29",
            Status.TOO_FEW_STEPS,
        ),
        ({"steps": 20}, 10.0, 29, "steps raised from 20 to 29: ", Status.SUCCESS),
        (
            {"steps": 20},
            10.0,
            28,
            "20 steps are too few: this scene needs 29",
            Status.TOO_FEW_STEPS,
        ),
    ],
)
def test_too_few_steps_are_raised_or_refused(options, radians, most, sentence, status, monkeypatch):
    monkeypatch.setattr(fixed, "MOST_STEPS", most)
    simulation, plan = of_steps(radians=radians, **options)
    told = [text for text in map(str, plan.cautions) if "steps" in text]
    assert [text[: len(sentence or "")] for text in told] == ([sentence] if sentence else [])
    result = simulation.run(SCENE)
    assert result.status is status
    together = simulation.run(PAIR)
    assert together.status.tolist() == [status, status]
    if status is Status.TOO_FEW_STEPS:
        assert result.motion.detail == f"steps = {options['steps']}; this scene needs at least 29."


class Instants:
    """An observer that may be shown all instants at the end."""

    stepwise = False

    def __init__(self):
        self.seen = []

    def __call__(self, sample):
        self.seen.append(
            (float(np.ravel(sample.time)[0]), float(np.ravel(sample.tangential_force)[0]))
        )


FAULTS = [
    ({"settled": False}, Status.UNSETTLED, "no division found"),
    ({"force": np.inf, "at": 3}, Status.NON_FINITE, "force inf"),
    ({"force": np.float64(np.inf), "at": 3}, Status.NON_FINITE, "force inf"),
    ({"work": np.nan}, Status.NON_FINITE, "friction work nan"),
    ({"work": np.float64(np.nan)}, Status.NON_FINITE, "friction work nan"),
]


@pytest.mark.parametrize(("options", "status", "what"), FAULTS)
def test_a_fault_in_one_call_is_that_of_step_by_step(options, status, what):
    """The step of an infinite force is told, whichever way it was found."""
    march = create("integrator.symplectic", steps=8)
    for stepwise in (False, True):
        law = Stiff(**options, stepwise=stepwise)
        observed = Instants()
        found = march.integrate(motion(), law, SCENE)
        shown = march.integrate(motion(), law, SCENE, observed)
        for each in (found, shown):
            assert each.status is status
            assert what in each.detail
            if "force" in options:
                assert "step 4" in each.detail
        assert len(observed.seen) == (1 if "settled" in options else 4 if "at" in options else 8)


def test_an_observer_of_all_steps_sees_the_velocity_between_the_kicks():
    """The force acts at the fourth of eight steps, and is seen with half of what it takes."""
    march = create("integrator.symplectic", steps=8)
    rows = {}
    for stepwise in (False, True):
        law = Stiff(force=0.25, at=3, work=0.5, stepwise=stepwise)
        samples = []

        def observe(sample, samples=samples):
            samples.append((sample.time, sample.slip_velocity, sample.tangential_force))

        class Shown:
            stepwise = False
            __call__ = staticmethod(observe)

        found = march.integrate(motion(), law, SCENE, Shown())
        rows[stepwise] = np.array(samples, dtype=float)
    lost = -float(found.slip_velocity_change)
    assert rows[False] == pytest.approx(rows[True], abs=1e-14)
    assert rows[True][:, 1] == pytest.approx(
        SCENE.slip_velocity - lost * np.array([0, 0, 0, 0.5, 1, 1, 1, 1]), abs=1e-14
    )
    assert rows[True][:, 2].tolist() == [0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.0]
    assert lost > 0.0


@pytest.mark.parametrize(
    ("earlier", "last", "error"),
    [
        (0.4, 0.1, 0.4 / 6.0),  # as smooth: a third of the last, but a sixth of the one before
        (0.3, 0.1, 0.05),  # just smooth: half of the last
        (0.29, 0.1, 0.29),  # wanders: twice half of the one before
        (0.1, 0.4, 0.8),
        (1.0, 0.1, 1.0 / 6.0),
        (0.6, 0.0, 0.1),
        (0.0, 0.0, 0.0),
        (0.0, 0.2, 0.4),
    ],
)
def test_the_error_of_three_answers(earlier, last, error):
    answers = np.array([1.0, 1.0 - earlier, 1.0 - earlier + last])
    found = adaptive.Adaptive._error(
        *(SimpleNamespace(slip_velocity_change=each) for each in answers)
    )
    assert found == pytest.approx(error, abs=1e-15)


@pytest.mark.parametrize("tolerance", [1e-12, 1e-4, 1.0])
def test_the_tolerance_is_that_of_the_larger_of_one_and_psi1(tolerance):
    law = create("integrator.adaptive", tolerance=tolerance)
    assert law._allowed(PAIR) == pytest.approx(max(tolerance, 1e-13) * np.array([2.0, 1.0]))


@pytest.mark.parametrize("bad", [0.9e-12, 1.1, np.array([0.1])])
def test_a_tolerance_out_of_range_is_refused(bad):
    with pytest.raises(ValueError, match=r"tolerance .*must be one number in \[1e-12, 1\]"):
        create("integrator.adaptive", tolerance=bad)
    assert create("integrator.adaptive", tolerance=1e-12)


def test_what_is_not_resolved_tells_the_steps_taken(monkeypatch):
    """Of the impacts of a batch only those; gross slip needs no more than the first three tries."""
    monkeypatch.setattr(adaptive, "MOST_STEPS", 128)
    march = create("integrator.adaptive", tolerance=1e-9)
    scene = Scene.nondimensional(psi1=np.array([9.0, 0.6]), chi=1.2)
    law = create("tangential.springs")
    normal = motion(scene)
    found = march.integrate(normal, law, scene)
    assert found.status.tolist() == [Status.SUCCESS, Status.UNRESOLVED]
    assert found.detail[1] == "After 128 steps psi2 still changes by more than the tolerance."
    assert found.counters == {"steps": 128, "evaluations": 32 + 64 + 128}


def test_a_law_that_fails_with_finer_steps_fails():
    """At 32 and 64 steps all is well; at 128 the 100th force is infinite."""

    @attrs.frozen(kw_only=True)
    class Late(Stiff):
        def advance_all(self, scene, normal, steps):
            forces = np.sin(np.arange(len(steps.kick)))
            forces[99:] = np.inf
            return AllStepsResponse(forces, 0.0, True)

    found = create("integrator.adaptive").integrate(motion(), Late(), SCENE)
    assert found.status is Status.NON_FINITE
    assert "force inf" in found.detail
    assert found.counters == {"steps": 128, "evaluations": 224}


@pytest.mark.parametrize("make", [division.midpoints, division.endpoints])
def test_only_short_divisions_are_kept(make, monkeypatch):
    monkeypatch.setattr(division, "LONGEST_KEPT", 12)
    normal = motion()
    assert make(normal, 12) is make(normal, 12)
    long = make(normal, 13)
    assert long is not make(normal, 13)
    monkeypatch.setattr(division, "LONGEST_KEPT", 13)
    kept = make(normal, 13)
    for one, other in zip((*long.contact, *long[1:]), (*kept.contact, *kept[1:]), strict=True):
        assert np.array_equal(one, other)


def test_steps_are_given_one_by_one_whatever_the_block(monkeypatch):
    steps = division.midpoints(motion(PAIR), 10)
    rows = []
    for block in (4096, 4):
        monkeypatch.setattr(division, "BLOCK", block)
        rows.append([(*step.contact, *step[1:]) for step in division.one_by_one(steps)])
    assert len(rows[0]) == len(rows[1]) == 10
    for one, other, k in zip(*rows, range(10), strict=True):
        assert np.array_equal(one, other)
        assert all(type(value) is float for value in one)  # the impacts share their normal motion
        assert one[6] == steps.friction_load[k]


def test_loads_that_no_steps_can_carry_are_told_by_the_sum():
    """An infinite load at the third step: the normal law is blamed, and no march begins."""
    from contactlab_laws.march.march import _unsound

    normal = motion()
    steps = division.midpoints(normal, 6)
    assert _unsound(normal, steps) is None
    huge = [np.full(6, 1.7e308)] * 2
    assert _unsound(normal, steps._replace(drift=huge[0], kick=huge[1])) is None
    load = np.array(steps.friction_load)
    load[2] = np.inf
    sentence = _unsound(normal, steps._replace(friction_load=load))
    assert "Hertz" in sentence
    assert "inf" in sentence
    assert "step 3" in sentence
