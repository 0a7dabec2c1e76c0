"""Numerical error and model error are two things."""

from __future__ import annotations

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.impact.error_model import range_of
from contactlab.impact.hertz import rigid_body_rebound
from contactlab.study.bench_methods import Method, methods
from contactlab.study.error_map import error_map, error_maps
from contactlab.study.model_error import model_error
from contactlab.study.stability_cases import Case, Cell
from contactlab.study.stability_judge import ANSWERED, UNDECLARED, WRONG, judge_run
from contactlab.study.stability_references import continuum

CHI = 49 / 34


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


@pytest.mark.parametrize("law", ["mindlin_cap", "linear_spring"])
def test_that_of_a_spring_is_what_finer_steps_leave(law):
    steps = contactlab.create("integrator.symplectic", steps=3000)
    result = Simulation(tangential=law, integrator=steps).run(
        Scene.nondimensional(psi1=1.2, chi=CHI)
    )
    found = model_error(law, (CHI,), (1.2,))
    assert found.error[0] == pytest.approx(over_range(result.psi2, 1.2, CHI), abs=1e-4)
    assert found.error[0] > 0.02


@pytest.mark.parametrize("law", ["annulus", "fronts", "springs"])
def test_laws_that_converge_to_the_continuum_have_none(law):
    assert model_error(law, (CHI,), (1.2,)) is None


@pytest.mark.parametrize(("reference", "expected"), [(continuum, ANSWERED), (no_change, WRONG)])
def test_the_error_of_a_law_that_declares_none_is_judged_by_the_estimate(reference, expected):
    """One spring is off by more than a hundredth of the range, as the estimate says."""
    scene = Case("map", "", lambda: Scene.nondimensional(psi1=1.2, chi=CHI))
    method = Method(tangential="springs", integrator="symplectic")
    case = Cell(family="map", label="", method=method, options={}, scene=scene, planned=False)
    law = contactlab.create("tangential.springs", springs=1)
    simulation = Simulation(tangential=law, integrator="symplectic")
    outcome = judge_run(case, simulation, scene.make(), reference)
    assert outcome.outcome == expected
    assert outcome.error > UNDECLARED
    assert (outcome.error < outcome.bound) == (expected == ANSWERED)


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
