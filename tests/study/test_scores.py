"""Scores of laws, and a comparison as JSON and CSV, with numbers found by hand."""

import io

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, create
from contactlab.outcome.columns import json_value
from contactlab.outcome.result import ImpactResult
from contactlab.registry.registry import REGISTRY
from contactlab.scene_file import LawChoice, read_scene
from contactlab.study.comparison import compare
from contactlab.study.scores import (
    DEFAULT_SCENE,
    candidates,
    pressed_force,
    scores,
    write_csv,
)
from tests.study.made_up import ERRORS, LAWS, SERIES, SWEEP


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    path = tmp_path_factory.mktemp("scores") / "measured.toml"
    path.write_text(SWEEP + SERIES + ERRORS, encoding="utf-8")
    return compare(read_scene(path), LAWS)


def with_runs(compared, **motion):
    """The comparison with other motions of the second law."""
    first, second = compared.runs
    result = attrs.evolve(second.result, motion=attrs.evolve(second.result.motion, **motion))
    return attrs.evolve(compared, runs=(first, attrs.evolve(second, result=result)))


def test_a_score_is_the_distance_from_the_first_law(compared):
    """Without friction psi2 is 0.5, 2 and 6; rigid 0, 0 and 2."""
    first, second = scores(compared, LAWS)
    assert (first.law, first.rms, first.worst) == ("rigid", 0.0, 0.0)
    assert (second.law, second.worst, second.where) == ("smooth", pytest.approx(4.0), 6.0)
    assert second.rms == pytest.approx(np.sqrt((0.25 + 4.0 + 16.0) / 3.0))
    assert first.integrator == second.integrator == ""
    assert second.energy_made == 0.0
    assert np.isnan(second.pressed_force)
    assert second.run_time_per_impact == compared.runs[1].run_time_per_impact > 0.0
    assert json_value(second)["pressed_force"] is None
    assert json_value(second)["worst"] == second.worst


def test_failed_impacts_do_not_count_in_a_score(compared):
    change = np.array([0.0, 0.0, np.nan])
    _, found = scores(with_runs(compared, slip_velocity_change=change), LAWS)
    assert (found.worst, found.where) == (pytest.approx(2.0), 2.0)
    assert found.rms == pytest.approx(np.sqrt(4.25 / 2.0))
    _, found = scores(with_runs(compared, slip_velocity_change=np.full(3, np.nan)), LAWS)
    assert np.isnan([found.rms, found.worst]).all()
    assert found.where == 0.5


def test_energy_made_is_the_largest_share_of_the_energy_at_the_start(compared):
    """Heat without a change of slip comes from nothing; at psi1 = 2 the energy is 1/2 + 4/4."""
    lost = with_runs(compared, friction_work=np.array([0.1, -0.3, 0.2]))
    _, found = scores(lost, LAWS)
    assert found.energy_made == pytest.approx(0.1 / (0.5 + 0.25 * 0.25))
    made = with_runs(compared, friction_work=np.array([-0.1, 0.3, -0.2]))
    _, found = scores(made, LAWS)
    assert found.energy_made == pytest.approx(0.3 / 1.5)
    taken = with_runs(compared, friction_work=np.array([-0.1, -0.3, -0.2]))
    _, found = scores(taken, LAWS)
    assert found.energy_made == 0.0


def test_a_stepped_law_has_an_integrator_and_a_numerical_error():
    laws = {"rough": Simulation(tangential="linear_spring")}
    found = compare(Scene.nondimensional(psi1=1.2, chi=1.0), laws)
    (run,) = found.runs
    result = attrs.evolve(run.result, psi2_error_estimate=0.25)
    (score,) = scores(attrs.evolve(found, runs=(attrs.evolve(run, result=result),)), laws)
    assert (score.integrator, score.numerical_error) == ("symplectic", 0.25)
    assert score.pressed_force == pytest.approx(0.0, abs=1e-12)
    (unknown,) = scores(found, laws)
    assert np.isnan(unknown.numerical_error)


def test_force_that_pressing_adds():
    """The capped spring has 2/3 of the stiffness 2, and the radius grows as the root of z."""
    assert pressed_force(create("tangential.mindlin_cap")) == pytest.approx(
        (2 / 3) * 2.0 * 0.3 * (1.0 - 0.4**0.5), rel=1e-9
    )
    assert pressed_force(create("tangential.linear_spring")) == pytest.approx(0.0, abs=1e-12)
    assert np.isnan(pressed_force(create("tangential.walton")))


def test_the_integrator_chosen_runs_the_laws_that_it_can():
    found = candidates(LawChoice(integrator="paper")).simulations
    paper = REGISTRY.law_class("integrator.paper")
    assert type(found["springs"].integrator) is paper
    assert type(found["fronts"].integrator) is not paper


def test_a_single_impact_is_single_numbers():
    found = compare(Scene.nondimensional(psi1=2.0, chi=1.0), LAWS).to_dict(["psi2"])
    assert found["laws"]["smooth"]["status"] == "SUCCESS"
    assert found["laws"]["smooth"]["values"]["psi2"] == 2.0
    assert (found["varied"], found["measured"]) == ({}, [])


def written(comparison, quantities):
    stream = io.StringIO()
    write_csv(comparison, quantities, stream)
    return [line.split(",") for line in stream.getvalue().splitlines()]


def test_a_single_impact_has_no_abscissa():
    _, first, second = written(compare(Scene.nondimensional(psi1=2.0, chi=1.0), LAWS), ["psi2"])
    assert first[:6] == ["scene", "psi2", "1", "", "", "rigid"]
    assert second[4:] == ["", "smooth", "2.0", "0.0", "2.0"]


def test_the_default_scene_is_there():
    assert DEFAULT_SCENE.is_file()
    assert isinstance(compare(read_scene(DEFAULT_SCENE), LAWS).runs[0].result, ImpactResult)
