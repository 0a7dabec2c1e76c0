"""Numerical error and model error are two things, in the numbers and in the picture."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure

import contactlab
from contactlab import Scene, Simulation
from contactlab.contracts.error_model import range_of
from contactlab.figures.stability import (
    CONTOURS,
    REFUSED_COLOUR,
    draw_stability,
    error_colours,
    error_over_steps,
    model_errors,
)
from contactlab.impact.hertz import rigid_body_rebound
from contactlab.study.bench_methods import Method, methods
from contactlab.study.error_map import ErrorMap, error_map, error_maps
from contactlab.study.model_error import ModelError, model_error
from contactlab.study.stability_cases import Case, Extreme
from contactlab.study.stability_judge import ANSWERED, UNDECLARED, WRONG, judge_run
from contactlab.study.stability_map import region
from contactlab.study.stability_references import continuum

CHI = 49 / 34
#: Decades of errors that have colours of their own.
DECADES = (1e-3, 1e-2, 1e-1, 1.0)


def no_change(*_):
    return 0.0


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


def test_what_more_rings_change_is_no_error_of_the_model():
    """The half-space without coupling has the continuum's limit, to the error of its rings."""
    assert model_error("halfspace", (CHI, 100.0), (1.2,)) is None


@pytest.mark.parametrize("law", ["mindlin_cap", "linear_spring"])
def test_that_of_a_spring_is_what_finer_steps_leave(law):
    steps = contactlab.create("integrator.symplectic", steps=3000)
    result = Simulation(tangential=law, integrator=steps).run(
        Scene.nondimensional(psi1=1.2, chi=CHI)
    )
    found = model_error(law, (CHI,), (1.2,))
    assert found.error[0] == pytest.approx(over_range(result.psi2, 1.2, CHI), abs=1e-4)
    assert found.error[0] > 0.02


@pytest.mark.parametrize("law", ["annulus", "fronts", "springs", "sharp_annulus"])
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
    """A map of two rows, an error of each decade in each; the last column is refused."""
    error = np.tile([*(0.3 * decade for decade in DECADES), np.nan], (2, 1))
    return ErrorMap(
        law="law",
        integrator="symplectic",
        steps=(10, 100),
        chis=tuple(np.geomspace(0.1, 10.0, error.shape[1])),
        error=error,
        converges=converges,
    )


def painted(converges):
    """The colours seen in more than a few dots of a map's picture."""
    figure = Figure(figsize=(6.0, 3.0))
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    error_over_steps(axes, area(converges))
    canvas.draw()
    dots = np.asarray(canvas.buffer_rgba())[:, :, :3].reshape(-1, 3)
    colours, counts = np.unique(dots, axis=0, return_counts=True)
    # Words and lines have fewer dots of one colour.
    return set(map(tuple, colours[counts > 2000].tolist())) - {(0, 0, 0), (255, 255, 255)}


def test_no_cell_of_a_model_has_a_colour_of_accuracy():
    accurate, model = painted(True), painted(False)
    refused = tuple(round(255 * part) for part in to_rgb(REFUSED_COLOUR))
    assert accurate & model == {refused}
    assert len(accurate) == len(model) == len(DECADES) + 1
    for colours, norm in (error_colours(True), error_colours(False)):
        lightness = np.mean([colours(norm(0.3 * decade))[:3] for decade in DECADES], axis=1)
        assert np.all(np.diff(lightness) < 0.0)  # darker is worse, in both


def test_contours_stand_where_the_error_is_a_hundredth_and_a_thousandth():
    axes = Figure().subplots()
    assert error_over_steps(axes, area(True)) is axes
    (contours,) = [each for each in axes.collections if isinstance(each, QuadContourSet)]
    assert list(contours.levels) == list(CONTOURS)
    error = area(True).error[0]
    for path, level in zip(contours.get_paths(), CONTOURS, strict=True):
        place = np.searchsorted(error[:-1], level)
        low, high = np.array(area(True).chis)[[place - 1, place]]
        assert np.all((path.vertices[:, 0] >= low) & (path.vertices[:, 0] <= high))


def test_the_map_says_which_error_is_which(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: drawn.append(figure))
    models = (ModelError(law="coulomb", chis=(0.5, 3.0), error=np.array([0.5, np.nan])),)
    maps = (area(True), area(False))
    for shown, words in (
        (maps[:1], {"from the exact": True, "own": False, "model error": True}),
        (maps[1:], {"from the exact": False, "own": True, "model error": True}),
        ((), {"from the exact": False, "own": False, "model error": True}),
    ):
        draw_stability(tmp_path / "m.png", shown, models)
        labels = " ".join(axes.get_ylabel().replace("\n", " ") for axes in drawn[-1].axes)
        assert {word: word in labels for word in words} == words


def test_the_map_of_springs_refuses_few_steps_and_falls_with_more():
    """Theory §4: fewer steps than 2.85 sqrt(chi) are unstable, and the error is of second order."""
    found = error_map(Method(tangential="springs", integrator="symplectic"), quick=True)
    refused = np.isnan(found.error)
    assert refused[0].all()
    for steps, row in zip(found.steps, refused, strict=True):
        assert all(row[np.sqrt(found.chis) * 2.85 > steps])
    assert not refused[-1, 0]
    fine = found.error[:, 4]  # chi = 1.2
    assert 0.0 < fine[-1] < 0.2 * fine[-2] < 0.02
    assert [each.law for each in error_maps(methods(["springs", "coulomb"]), quick=True)] == [
        "springs"
    ]


def test_a_law_with_another_limit_is_mapped_against_its_own():
    found = error_map(Method(tangential="mindlin_cap", integrator="symplectic"), quick=True)
    assert not found.converges
    assert np.nanmin(found.error[-1]) < 1e-3  # its model error is up to 0.6


def test_model_errors_are_drawn_over_chi():
    axes = Figure().subplots()
    item = ModelError(law="coulomb", chis=(0.5, 3.0), error=np.array([0.5, 0.2]))
    assert model_errors(axes, [item]) is axes
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), item.error)
