"""`integrator.adaptive`: as many steps as keep psi2 within a tolerance, over any laws."""

import math
from functools import cache
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, Status
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse
from contactlab.impact.hertz import rigid_body_rebound
from tests.laws.law_files import EXAMPLES, of_file
from tests.laws.normal_laws import LinearSpring, in_si
from tests.laws.outside_laws import RescaledSpring

pytestmark = pytest.mark.slow

CHI = 49.0 / 34.0
PSI1, CHIS = (0.5, 0.9, 2.0, 3.0), (CHI, 3.0)


@cache
def smoothed():
    """Return the class of the example of a law in five minutes, without what the example draws."""
    code = (EXAMPLES / "law_in_five_minutes.py").read_text("utf-8").partition("\n\nSHARES")[0]
    namespace = {"__name__": "law_in_five_minutes"}
    exec(compile(code, "law_in_five_minutes.py", "exec"), namespace)
    return namespace["Smoothed"]


def mindlin(form):
    return lambda: contactlab.create("tangential.mindlin_cap", form=form)


LAWS = {
    "springs": lambda: contactlab.create("tangential.springs", springs=12),
    "annulus": lambda: contactlab.create("tangential.annulus", annuli=10),
    "displacement": mindlin("displacement"),
    "increment": mindlin("increment"),
    "increment_rescaled": mindlin("increment_rescaled"),
    "custom": lambda: of_file(EXAMPLES / "custom_law.py", "MindlinCap")(),
    "cundall": lambda: of_file(
        EXAMPLES / "third_party_plugin/contactlab_cundall/law.py", "CundallStrack"
    )(),
    "rescaled": RescaledSpring,
    "smoothed": lambda: smoothed()(),
}
#: Of second order in the step; the others jump as they come to slip, and are of first.
SECOND = ("springs", "displacement", "increment", "increment_rescaled", "smoothed")


def adaptive(tolerance):
    return contactlab.create("integrator.adaptive", tolerance=tolerance)


def scene(psi1=1.2, chi=CHI):
    return Scene.nondimensional(psi1=psi1, chi=chi)


@cache
def law_of(name):
    return LAWS[name]()


@cache
def fine(name, chi):
    """Return psi2 at PSI1 by many steps, chosen by nobody, and how far they may be off."""
    answers = []
    for steps in (10_000, 20_000):
        march = contactlab.create("integrator.symplectic", steps=steps)
        sim = Simulation(tangential=law_of(name), integrator=march)
        answers.append(np.array([sim.run(scene(psi1, chi)).check().psi2 for psi1 in PSI1]))
    change = answers[1] - answers[0]
    # What the finest steps are off by is a third of the change, or all of it.
    return answers[1] + change / 3.0, np.abs(change) * (1e-2 if name in SECOND else 1.0)


def errors(name, chi, tolerance):
    """Return errors over max(1, psi1), less what the reference may be off by."""
    exact, unsure = fine(name, chi)
    sim = Simulation(tangential=law_of(name), integrator=adaptive(tolerance))
    found = np.array([sim.run(scene(psi1, chi)).check().psi2 for psi1 in PSI1])
    return np.maximum(np.abs(found - exact) - unsure, 0.0) / np.maximum(1.0, PSI1)


def kept(name, tolerances):
    worst = []
    for tolerance in tolerances:
        found = np.concatenate([errors(name, chi, tolerance) for chi in CHIS])
        assert found.max() <= 2.0 * tolerance, f"{found / tolerance} at {tolerance}"
        worst.append(np.sqrt(np.mean(found**2)))
    if worst[0] <= tolerances[-1]:
        return 1.0  # the fewest steps are enough
    return np.polyfit(np.log(tolerances), np.log(worst), 1)[0]


@pytest.mark.parametrize("name", SECOND)
def test_error_is_within_twice_the_tolerance(name):
    """And in proportion to it. Tolerances of steps added up to ten times, for some laws more."""
    assert kept(name, tuple(np.logspace(-3, -5, 9))) >= 0.8


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(LAWS) - set(SECOND) - {"annulus"}))
def test_error_of_laws_that_jump_is_too(name):
    """They are of first order, and need many steps: 1e5 of them for 1e-5."""
    assert kept(name, np.logspace(-3, -4, 5)) >= 0.8


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_error_of_annuli_wanders(tolerance):
    """What an annulus remembers depends on the step it came into contact in: up to five tolerances.

    The plan declares nothing: the tolerance is no bound.
    """
    for chi in CHIS:
        found = errors("annulus", chi, tolerance)
        assert found.max() <= 6.0 * tolerance
        sim = Simulation(tangential=law_of("annulus"), integrator=adaptive(tolerance))
        plan = sim.plan(scene(np.array(PSI1), chi))
        assert np.isnan(plan.psi2_error[plan.marched]).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in SECOND if "increment" not in name])
def test_error_is_down_to_1e_6(name):
    assert kept(name, (1e-5, 1e-6)) >= 0.6


@attrs.frozen(kw_only=True)
class Elastic(SteppedTangentialLaw):
    """F = k x: with the linear normal spring, psi = psi1 cos(sqrt(k/M_t) t) in closed form.

    ``seen`` keeps every state that ``advance`` was given, with a copy of what it held then.
    """

    api_version: ClassVar[int] = 2
    stiffness_in_newton_per_metre: float = 1.0
    seen: list = attrs.field(factory=list)

    def start(self, scene, normal):
        return np.zeros(1)

    def advance(self, state, increment, before, after):
        self.seen.append((state, float(state[0])))
        new = state + increment.displacement
        force = self.stiffness_in_newton_per_metre * float(new[0])
        return TangentialResponse(force, 0.0), new


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_duration_and_restitution_do_not_depend_on_the_tolerance(tolerance):
    sim = Simulation(normal=LinearSpring(), tangential="coulomb", integrator=adaptive(tolerance))
    result = sim.run(in_si(scene(7.0))).check()
    assert result.motion.duration == pytest.approx(math.pi, rel=1e-8)
    assert result.normal_restitution == pytest.approx(1.0, rel=1e-8)


def test_error_follows_the_tolerance():
    """A linear oscillator: the error stays below the tolerance and falls in proportion to it."""
    tolerances, errors = np.logspace(-2.0, -5.0, 13), []  # steps are doubled: many, to see a slope
    for tolerance in tolerances:
        law = Elastic(stiffness_in_newton_per_metre=1.7)
        sim = Simulation(normal=LinearSpring(), tangential=law, integrator=adaptive(tolerance))
        exact = 1.2 * math.cos(math.sqrt(1.7 * 2 * CHI) * math.pi)
        errors.append(abs(sim.run(in_si(scene())).check().psi2 - exact))
    assert all(error < 3 * tolerance for error, tolerance in zip(errors, tolerances, strict=True))
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.3)


def test_states_that_a_law_was_given_are_not_changed():
    law = Elastic(stiffness_in_newton_per_metre=2.0)
    Simulation(normal=LinearSpring(), tangential=law, integrator=adaptive(1e-3)).run(in_si(scene()))
    assert len(law.seen) > 100
    assert all(float(state[0]) == held for state, held in law.seen)


def test_cost_grows_as_the_inverse_root_of_the_tolerance():
    """Of laws of second order; the steps before the last cost as much again."""
    tolerances = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
    counters = [
        Simulation(tangential="springs", integrator=adaptive(tolerance)).run(scene()).counters
        for tolerance in tolerances
    ]
    for each in counters:
        assert set(each) == {"steps", "evaluations"}
        assert each["steps"] <= each["evaluations"] <= 2 * each["steps"]
    steps = [each["steps"] for each in counters]
    slope = np.polyfit(np.log(tolerances), np.log(steps), 1)[0]
    assert slope == pytest.approx(-0.5, abs=0.15)


def test_rigid_friction_is_exact_at_any_tolerance():
    for psi1 in (-3.0, 0.4, 5.7, 6.0):
        for tolerance in (1e-2, 1e-5):
            result = Simulation(tangential="coulomb", integrator=adaptive(tolerance)).run(
                scene(psi1)
            )
            assert result.psi2 == pytest.approx(rigid_body_rebound(psi1, CHI), abs=1e-13)


@pytest.mark.parametrize("law", ["annulus", "springs", RescaledSpring()])
def test_batch_equals_one_by_one_and_history_changes_nothing(law):
    sim = Simulation(tangential=law, integrator=adaptive(1e-2))
    psi1 = np.array([0.5, 1.2, 6.5, 0.01])
    batch = sim.sweep(Scene.nondimensional(psi1=psi1, chi=CHI)).check()
    ones = [sim.run(scene(float(value))) for value in psi1]
    assert batch.psi2 == pytest.approx([one.psi2 for one in ones], abs=1e-11)
    kept = sim.run(scene(1.2), history=True)
    assert kept.psi2 == ones[1].psi2
    assert (np.diff(kept.history.time) > 0).all()
    assert len(kept.history.time) == kept.counters["steps"]


def test_a_batch_has_one_time_axis():
    """Impacts that need fewer steps are shown with those of the one that needs most."""
    sim = Simulation(tangential="springs", integrator=adaptive(1e-3))
    batch = Scene.nondimensional(psi1=np.array([0.5, 1.2]), chi=CHI)
    kept = sim.run(batch, history=True).check()
    assert kept.history.time.shape == (kept.counters["steps"], 2)
    assert kept.psi2.tolist() == sim.run(batch).psi2.tolist()
    assert kept.history.slip_velocity[-1] == pytest.approx(kept.psi2, abs=3e-3)


def test_what_cannot_be_resolved_is_a_status(monkeypatch):
    monkeypatch.setattr("contactlab_laws.march.adaptive.MOST_STEPS", 500)
    result = Simulation(tangential="springs", integrator=adaptive(1e-8)).run(
        Scene.nondimensional(psi1=np.array([0.5, 1e-300]), chi=CHI)
    )
    assert result.status[0] is Status.UNRESOLVED
    assert "psi2 still changes" in result.failures[0]


@pytest.mark.parametrize("bad", [0.0, 1e-13, 2.0, math.nan, "fine", None])
def test_bad_tolerance(bad):
    with pytest.raises(ValueError, match="tolerance"):
        adaptive(bad)


def test_non_finite_force_is_reported():
    law = Elastic(stiffness_in_newton_per_metre=math.nan)
    result = Simulation(tangential=law, integrator=adaptive(1e-3)).run(scene(), history=True)
    assert result.status is Status.NON_FINITE
