"""What the stability judge says of one run: answers, refusals, errors within their bounds."""

from types import SimpleNamespace

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, create
from contactlab.contracts.status import Status
from contactlab.study.bench_methods import Method
from contactlab.study.stability_cases import Case, Extreme
from contactlab.study.stability_judge import (
    ANSWERED,
    RAISED,
    REFUSED,
    WRONG,
    judge,
    judge_run,
    marched,
)

COULOMB = Simulation(tangential="coulomb")
METHOD = Method(tangential="springs", integrator="symplectic")


def case(planned=True, psi1=1.0, **entries):
    scene = Extreme("chi", "", lambda: Scene.nondimensional(psi1=psi1, chi=1.0))
    names = {"family": "chi", "label": "a label", "method": METHOD, "options": {}, "scene": scene}
    return Case(**(names | {"planned": planned} | entries))


def answer(declared, psi1=1.0, **motion):
    """A rigid impact, of which at chi = 1 the change is -1 and the range 2; with a declared error.

    Its friction does the work of its change.
    """
    result = COULOMB.run(Scene.nondimensional(psi1=psi1, chi=1.0)).check()
    plan = result.plan.changed(psi2_error=declared)
    return attrs.evolve(result, plan=plan, motion=attrs.evolve(result.motion, **motion))


def judged(result, expected, normal="hertz", tangential="springs", **entries):
    """The outcome of a run that gives ``result`` where ``expected`` is right."""
    run = SimpleNamespace(
        run=lambda _: result,
        normal=create(f"normal.{normal}"),
        tangential=create(f"tangential.{tangential}"),
        laws=None,
    )
    reference = entries.pop("reference", lambda *_: expected)
    return judge_run(case(**entries), run, result.scene, reference)


@pytest.mark.parametrize(
    ("declared", "bound"),
    # Over the range of 2, and rounding of 1e-9; at most 1.1.
    [(0.02, 0.01), (0.0, 1e-9), (0.5, 0.25), (9.0, 1.1)],
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_error_is_held_to_what_is_declared(declared, bound, sign):
    for share, outcome in ((0.9, ANSWERED), (1.01, WRONG)):
        found = judged(answer(declared), -1.0 + sign * 2.0 * share * bound)
        assert found.outcome == outcome
        assert found.error == pytest.approx(share * bound, rel=1e-6)
        assert found.bound == pytest.approx(bound, rel=1e-6, abs=2e-9)
        words = f"error {share * bound:.2g} of the range, at most {bound:.2g} is declared"
        assert found.note == ("" if outcome == ANSWERED else f"{words} or estimated")
    names = (found.method, found.family, found.case)
    assert names == ("springs / symplectic", "chi", "a label")


def test_where_nothing_can_act_any_error_is_infinite():
    still = answer(0.0, psi1=0.0, slip_velocity_change=0.0, friction_work=0.0)
    found = judged(still, 0.0, psi1=0.0)
    assert (found.outcome, found.error, found.bound) == (ANSWERED, 0.0, 1e-9)
    found = judged(still, 1e-300, psi1=0.0)
    assert (found.outcome, found.error) == (WRONG, np.inf)


def test_an_answer_without_reference_is_held_to_the_invariants():
    found = judged(answer(0.02), None)
    assert (found.outcome, found.note) == (ANSWERED, "no reference")
    assert np.isnan(found.error)
    found = judged(answer(0.02, slip_velocity_change=0.5, friction_work=-0.3), None)
    assert found.outcome == WRONG
    assert found.note.split("; ") == [
        "friction speeds the slip up", "friction does work on the bodies"
    ]  # fmt: skip


def failing(error):
    def run(*_):
        raise error

    simulation = SimpleNamespace(run=run, normal_motion=run, tangential=None, integrator=None)
    return simulation, Scene.nondimensional(psi1=1.0, chi=1.0)


def test_an_exception_is_an_outcome():
    """Of a planned run a fault of the program, of a march a refusal by the law."""
    simulation, scene = failing(ZeroDivisionError("by zero"))
    found = judge_run(case(), simulation, scene, lambda *_: None)
    assert (found.outcome, found.note) == (RAISED, "ZeroDivisionError: by zero")
    found = judge_run(case(planned=False), simulation, scene, lambda *_: None)
    assert (found.outcome, found.note) == (REFUSED, "LAW_RAISED ZeroDivisionError: by zero")

    def broken(*_):
        raise KeyError("reference")

    found = judged(answer(0.0), None, reference=broken)
    assert (found.outcome, found.note) == (RAISED, "its reference: KeyError: 'reference'")
    assert found.run_time_s > 0.0


def test_a_failed_run_is_a_refusal_with_its_status():
    result = answer(0.0, status=Status.TOO_FEW_STEPS, detail="Give 9 steps.")
    found = judged(result, -1.0)
    assert (found.outcome, found.note) == (REFUSED, "TOO_FEW_STEPS Give 9 steps.")
    assert found.run_time_s > 0.0
    assert np.isnan(found.error)
    assert np.isnan(found.bound)


def test_a_bad_scene_or_option_is_bad_input():
    found = judge(case(options={"tangential": {"springs": 0}, "integrator": {}}))
    assert found.outcome == REFUSED
    assert found.note.startswith("bad input: tangential.springs: springs = 0")
    found = judge(case(options={"tangential": {}, "integrator": {"steps": 400}}))
    assert found.outcome == ANSWERED
    assert 0.0 < found.error < 1e-4 < found.bound == 0.01


def test_a_marched_impact_has_no_answer_of_the_whole():
    """At psi1 = 4 the contact slips throughout: a closed form answers, or the integrator."""
    scene = Scene.nondimensional(psi1=4.0, chi=1.0)
    simulation = Simulation(tangential="annulus", integrator="symplectic")
    planned, found = simulation.run(scene), marched(simulation, scene)
    assert (planned.plan.marched, found.plan.marched) == (False, True)
    assert np.isnan(found.plan.psi2_error)
    assert planned.plan.psi2_error < 1e-11
    assert found.psi2 == pytest.approx(0.0, abs=1e-2)
    assert planned.psi2 == pytest.approx(0.0, abs=1e-12)
    assert found.status is Status.SUCCESS
    exact = Simulation(integrator=create("integrator.events", tolerance=1e-5))
    found = marched(exact, scene)
    assert found.plan.psi2_error == pytest.approx(4e-5, rel=1e-6)  # the tolerance times psi1
