"""Scores of laws, and a comparison as JSON and CSV, with numbers found by hand."""

import io

import attrs
import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.outcome.columns import json_value
from contactlab.outcome.result import ImpactResult
from contactlab.scene_file import LawChoice, read_scene
from contactlab.study.comparison import compare
from contactlab.study.scores import (
    DEFAULT_SCENE,
    candidates,
    pressed_force,
    scores,
    to_dict,
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


def test_every_law_is_a_candidate_in_each_of_its_forms():
    found = candidates(LawChoice())
    names = list(found.simulations)
    assert names[0] == "fronts"  # the exact solution is the reference
    assert names[1:] == sorted(names[1:])
    assert [name for name in names if name.startswith("mindlin_cap")] == [
        "mindlin_cap", "mindlin_cap displacement_rescaled", "mindlin_cap increment",
        "mindlin_cap increment_rescaled",
    ]  # fmt: skip
    forms = {name: law.tangential.form for name, law in found.simulations.items()
             if name.startswith("mindlin_cap")}  # fmt: skip
    assert forms == {name: ([*name.split(), "displacement"])[1] for name in forms}
    assert found.left_out == {}
    marched = {type(law.integrator) for name, law in found.simulations.items() if name != "fronts"}
    assert REGISTRY.law_class("integrator.symplectic") in marched


def test_the_integrator_chosen_runs_the_laws_that_it_can():
    found = candidates(LawChoice(integrator="paper")).simulations
    paper = REGISTRY.law_class("integrator.paper")
    assert type(found["springs"].integrator) is paper
    assert type(found["fronts"].integrator) is not paper


def test_laws_that_cannot_be_compared_are_left_out_with_a_reason(monkeypatch):
    make = type(REGISTRY).create

    def broken(self, name, **options):
        if name == "tangential.walton":
            raise PluginError("tangential.walton: broken")
        return make(self, name, **options)

    monkeypatch.setattr(type(REGISTRY), "create", broken)
    found = candidates(LawChoice(normal="jkr"))
    assert found.left_out["walton"] == "tangential.walton: broken"
    assert "elastic_hertz" in found.left_out["fronts"]
    assert next(iter(found.simulations)) in ("annulus", "springs")
    assert "walton" not in found.simulations
    # One form of the half-space needs elastic surfaces, its others do not.
    assert {"halfspace", "halfspace one_way"} < set(found.simulations)
    assert "halfspace two_way" not in found.simulations
    assert "give normal.hertz" in found.left_out["halfspace two_way"]


def test_a_comparison_is_plain_numbers(compared):
    found = to_dict(compared, ["psi2"])
    assert list(found) == ["laws", "varied", "measured"]
    law = found["laws"]["smooth"]
    assert law["values"] == {"psi2": [0.5, 2.0, 6.0]}
    assert law["differences"]["psi2"] == pytest.approx([0.5, 2.0, 4.0])
    assert law["status"] == ["SUCCESS"] * 3
    assert law["versions"].keys() == {"normal", "tangential", "integrator"}
    assert law["run_time_per_impact_s"] == compared.runs[1].run_time_per_impact
    assert law["psi2_numerical_error"] == [float(value) for value in
                                           compared.numerical_error("smooth")]  # fmt: skip
    assert all(isinstance(words, str) for words in law["cautions"])
    assert found["varied"] == {"psi1": [0.5, 2.0, 6.0]}
    (series,) = found["measured"]
    assert {key: series[key] for key in ("quantity", "unit", "against", "source")} == {
        "quantity": "psi2", "unit": "1", "against": "psi1", "source": "made up",
    }  # fmt: skip
    assert (series["x"], series["values"], series["error"]) == ([1.0, 8.0], [0.1, 3.5], [0.0, 0.2])
    assert series["laws"]["rigid"]["values"] == pytest.approx([0.0, 4.0])
    assert series["laws"]["rigid"]["rms"] == pytest.approx(np.sqrt(0.13))
    assert series["laws"]["rigid"]["largest"] == pytest.approx(0.5)


def test_a_single_impact_is_single_numbers():
    found = to_dict(compare(Scene.nondimensional(psi1=2.0, chi=1.0), LAWS), ["psi2"])
    assert found["laws"]["smooth"]["status"] == "SUCCESS"
    assert found["laws"]["smooth"]["values"]["psi2"] == 2.0
    assert (found["varied"], found["measured"]) == ({}, [])


def written(comparison, quantities):
    stream = io.StringIO()
    write_csv(comparison, quantities, stream)
    return [line.split(",") for line in stream.getvalue().splitlines()]


HEAD = ["table", "quantity", "unit", "against", "x", "law", "value", "reference", "difference"]


def test_a_table_has_a_row_for_each_value(compared):
    head, *rows = written(compared, ["psi2", "slip_restitution"])
    assert head == HEAD
    assert len(rows) == 2 * 2 * 3 + 2 * 2
    smooth = [row[6:] for row in rows if row[:2] == ["scene", "psi2"] and row[5] == "smooth"]
    assert np.array(smooth, dtype=float) == pytest.approx(
        np.array([[0.5, 0.0, 0.5], [2.0, 0.0, 2.0], [6.0, 2.0, 4.0]])
    )
    assert [row[4] for row in rows[:3]] == ["0.5", "2.0", "6.0"]
    assert [row[:4] for row in rows[-4:]] == [["measured", "psi2", "1", "psi1"]] * 4
    measured = [[float(each) for each in (row[4], *row[6:])] for row in rows[-4:-2]]
    assert measured == [pytest.approx([1.0, 0.0, 0.1, -0.1]), pytest.approx([8.0, 4.0, 3.5, 0.5])]


def test_a_single_impact_has_no_abscissa():
    _, first, second = written(compare(Scene.nondimensional(psi1=2.0, chi=1.0), LAWS), ["psi2"])
    assert first[:6] == ["scene", "psi2", "1", "", "", "rigid"]
    assert second[4:] == ["", "smooth", "2.0", "0.0", "2.0"]


def test_other_entries_that_vary_have_columns_at_the_end(compared):
    steel = Material.named("steel")
    bodies = Sphere(0.01, steel), HalfSpace(steel)
    scene = Scene.grid(
        *bodies, speed=2.0, angle_deg=[30.0, 60.0], friction_coefficient=[0.0, 0.1, 0.2]
    )
    found = compare(scene, LAWS)
    agreements = compared.agreements
    head, *rows = written(attrs.evolve(found, agreements=agreements), ["rebound_spin"])
    assert head == [*HEAD, "friction_coefficient (1)"]
    assert [float(row[4]) for row in rows[:6]] == pytest.approx([30.0] * 3 + [60.0] * 3)
    assert [row[9] for row in rows[:6]] == ["0.0", "0.1", "0.2"] * 2
    assert {row[2] for row in rows[:12]} == {"rad/s"}
    assert {len(row) for row in rows} == {10}
    assert rows[-1][9] == ""


def test_the_default_scene_is_there():
    assert DEFAULT_SCENE.is_file()
    assert isinstance(compare(read_scene(DEFAULT_SCENE), LAWS).runs[0].result, ImpactResult)
