"""Parts of the marches: numbers of steps, errors by hand, and faults in one call."""

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, Status, create
from contactlab.contracts import AllStepsResponse, AllStepsTangentialLaw, TangentialResponse
from contactlab_laws.march import adaptive, fixed

SCENE = Scene.nondimensional(psi1=2.0, chi=1.2)
PAIR = Scene.nondimensional(psi1=np.array([2.0, 0.5]), chi=1.2)


def motion(scene=SCENE):
    return Simulation(tangential="coulomb").normal_motion(scene)


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


@pytest.mark.parametrize(
    ("options", "law", "most", "taken"),
    [
        ({"steps": 29}, {"radians": 10.0}, 1000, 29),  # 10 sqrt(10/1.2) = 28.9
        ({"steps": 28}, {"radians": 10.0}, 1000, 35),  # a quarter more, rounded up
        ({"steps": 28, "refine": False}, {"radians": 10.0}, 1000, None),
        ({"steps": 20}, {"radians": 10.0}, 29, 29),
        ({"steps": 20}, {"radians": 10.0}, 28, None),
        ({"steps": 20}, {"radians": 10.0, "offers": frozenset({"partial_slip"})}, 1000, 20),
        ({"steps": 8}, {"radians": 4.0}, 1000, 8),
        ({"steps": 7}, {}, 1000, 7),  # half an oscillation of the load, in steps of half a radian
    ],
)
def test_too_few_steps_are_raised_or_refused(options, law, most, taken, monkeypatch):
    monkeypatch.setattr(fixed, "MOST_STEPS", most)
    simulation = Simulation(
        tangential=Stiff(**law), integrator=create("integrator.symplectic", **options)
    )
    result, together = simulation.run(SCENE), simulation.run(PAIR)
    status = Status.TOO_FEW_STEPS if taken is None else Status.SUCCESS
    assert [result.status, *together.status] == [status] * 3
    if taken is None:
        assert "needs at least 29" in result.motion.detail
    else:
        assert result.counters["steps"] == taken
        told = any("steps raised" in text for text in map(str, result.plan.cautions))
        assert told is (taken > options["steps"])


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
