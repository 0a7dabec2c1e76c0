"""Numerical error and model error are two things, in the numbers and in the picture."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import contactlab
from contactlab import Scene, Simulation
from contactlab.contracts.error_model import range_of
from contactlab.figures.stability import (
    DECADES,
    draw_stability,
    error_colours,
    model_errors,
    usable_region,
)
from contactlab.impact.hertz import rigid_body_rebound
from contactlab.study.bench_methods import Method
from contactlab.study.model_error import ModelError, model_error
from contactlab.study.stability import Stability
from contactlab.study.stability_cases import Case, Extreme
from contactlab.study.stability_map import ALL_ANSWERED, Region, region
from contactlab.study.stability_outcome import ANSWERED, UNDECLARED, WRONG, judge_run
from contactlab.study.stability_references import continuum
from contactlab.study.stability_references import none as no_change

CHI = 49 / 34


def over_range(psi2, psi1, chi):
    """The difference of an answer from the table of exact ones, over the range of psi2."""
    width = range_of(Scene.nondimensional(psi1=psi1, chi=chi)).width
    return abs(psi2 - contactlab.rebound(psi1, chi)) / width


def test_that_of_the_rigid_body_is_its_distance_from_the_exact_table():
    found = model_error("coulomb", (0.3, CHI), (0.5, 1.2))
    for chi, error in zip(found.chis, found.error, strict=True):
        off = [over_range(rigid_body_rebound(psi1, chi), psi1, chi) for psi1 in (0.5, 1.2)]
        assert error == pytest.approx(max(off), rel=1e-7)
        assert error > 0.05


@pytest.mark.parametrize("law", ["mindlin_cap", "linear_spring"])
def test_that_of_a_spring_is_what_finer_steps_leave(law):
    steps = contactlab.create("integrator.symplectic", steps=3000)
    result = Simulation(tangential=law, integrator=steps).run(
        Scene.nondimensional(psi1=1.2, chi=CHI)
    )
    found = model_error(law, (CHI,), (1.2,))
    assert found.error[0] == pytest.approx(over_range(result.psi2, 1.2, CHI), abs=1e-4)
    assert found.error[0] > 0.02


@pytest.mark.parametrize("law", ["annulus", "fronts", "springs", "sharp_annulus", "tabulated"])
def test_laws_that_converge_to_the_continuum_have_none(law):
    assert model_error(law, (CHI,), (1.2,)) is None


@pytest.mark.parametrize(("law", "converges"), [("springs", True), ("mindlin_cap", False)])
def test_a_region_knows_whether_its_law_converges_to_the_exact_solution(law, converges):
    found = region(Method(tangential=law, integrator="symplectic"), [(50, CHI)])
    assert found.converges is converges
    assert 0.0 < found.error[0, 0] < 0.05


@pytest.mark.parametrize(("reference", "expected"), [(continuum, ANSWERED), (no_change, WRONG)])
def test_the_error_of_a_law_that_declares_none_is_judged_by_the_estimate(reference, expected):
    """One spring is off by more than a hundredth of the range, as the estimate says."""
    scene = Extreme("map", "", lambda: Scene.nondimensional(psi1=1.2, chi=CHI))
    method = Method(tangential="springs", integrator="symplectic")
    case = Case(family="map", label="", method=method, options={}, scene=scene, planned=False)
    law = contactlab.create("tangential.springs", springs=1)
    simulation = Simulation(tangential=law, integrator="symplectic")
    outcome = judge_run(case, simulation, scene.make(), reference)
    assert outcome.outcome == expected
    assert outcome.error > UNDECLARED
    assert (outcome.error < outcome.bound) == (expected == ANSWERED)


def area(converges):
    """A map of one cell for every decade of error."""
    error = np.array([[0.3 * decade for decade in DECADES]] * 2)
    return Region(
        method="law / symplectic",
        word="steps",
        resolutions=(10, 100),
        chis=tuple(np.geomspace(0.1, 10.0, error.shape[1])),
        error=error,
        state=np.full(error.shape, ALL_ANSWERED, dtype=np.int8),
        tried=error.size,
        converges=converges,
    )


def painted(converges):
    """The colours seen in more than a few dots of a region's picture."""
    figure = Figure(figsize=(6.0, 3.0))
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    usable_region(axes, area(converges))
    canvas.draw()
    dots = np.asarray(canvas.buffer_rgba())[:, :, :3].reshape(-1, 3)
    colours, counts = np.unique(dots, axis=0, return_counts=True)
    return set(map(tuple, colours[counts > 500].tolist())) - {(0, 0, 0)}


def test_no_cell_of_a_model_has_a_colour_of_accuracy():
    accurate, model = painted(True), painted(False)
    assert len(accurate) == len(model) == len(DECADES)
    assert not accurate & model
    for colours, norm in (error_colours(True), error_colours(False)):
        lightness = np.mean([colours(norm(0.3 * decade))[:3] for decade in DECADES], axis=1)
        assert np.all(np.diff(lightness) < 0.0)  # darker is worse, in both


def test_the_map_says_which_error_is_which(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: drawn.append(figure))
    models = (ModelError(law="coulomb", chis=(0.5, 3.0), error=np.array([0.5, np.nan])),)
    regions = (area(True), area(False))
    for shown, words in (
        (regions[:1], {"from the exact": True, "own": False, "model error": True}),
        (regions[1:], {"from the exact": False, "own": True, "model error": True}),
        ((), {"from the exact": False, "own": False, "model error": True}),
    ):
        found = Stability(outcomes=(), regions=shown, complete=True, models=models)
        draw_stability(tmp_path / "m.png", found)
        labels = " ".join(word for axes in drawn[-1].axes for word in axes.get_ylabel().split())
        assert {word: word in labels for word in words} == words


def test_model_errors_are_drawn_over_chi():
    axes = Figure().subplots()
    item = ModelError(law="coulomb", chis=(0.5, 3.0), error=np.array([0.5, 0.2]))
    assert model_errors(axes, [item]) is axes
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), item.error)
