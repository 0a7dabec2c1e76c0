"""The map of a method: cells, states, errors, and what ends it."""

import time

import numpy as np
import pytest

from contactlab.study.bench_methods import Method
from contactlab.study.stability_judge import ANSWERED, RAISED, REFUSED, SKIPPED, WRONG, Outcome
from contactlab.study.stability_map import (
    ALL_ANSWERED,
    NOT_TRIED,
    ONE_RAISED,
    ONE_REFUSED,
    ONE_WRONG,
    map_chis,
    region,
    region_cells,
)

STEPPED = Method(tangential="springs", integrator="symplectic")
RULED = Method(tangential="springs", integrator="adaptive")
ALL_STEPS = (
    1, 2, 3, 4, 6, 9, 14, 21, 32, 48, 72, 108, 162, 243, 365, 547, 820, 1230, 1845, 2768, 4152,
)  # fmt: skip


def outcome(kind, error=np.nan):
    return Outcome(method="m", family="map", case="", outcome=kind, error=error)


def judging(answers):
    """A judge that answers by the label of a case, and keeps the cases."""
    seen = []

    def judged(case):
        seen.append(case)
        return answers.get(case.label, outcome(ANSWERED, 1e-3))

    return judged, seen


def test_quick_cells_are_resolutions_by_chi():
    chis = (0.05, 0.5, 3.0, 30.0)
    assert map_chis(quick=True) == chis
    assert region_cells(STEPPED, quick=True) == [(n, chi) for n in (1, 5, 9, 30) for chi in chis]
    assert region_cells(RULED, quick=True) == [(t, chi) for t in (0.1, 1e-3) for chi in chis]


def test_all_cells_are_finer_and_wider():
    """Steps grow by about a half each; tolerances by decades; 17 chi from 0.05 to 1e4."""
    chis = map_chis()
    assert len(chis) == 17
    assert (chis[0], chis[-1]) == pytest.approx((0.05, 1e4))
    np.testing.assert_allclose(np.diff(np.log(chis)), np.log(2e5) / 16.0, rtol=1e-9)
    assert region_cells(STEPPED) == [(n, chi) for n in ALL_STEPS for chi in chis]
    tolerances = list(dict.fromkeys(fine for fine, _ in region_cells(RULED)))
    assert tolerances == pytest.approx([10.0**-power for power in range(7)], rel=1e-12)


@pytest.mark.parametrize(
    "method",
    [
        Method(tangential="walton", integrator="symplectic"),
        Method(tangential="springs", integrator="symplectic", normal="jkr"),
    ],
)
def test_methods_without_steps_or_exact_answers_have_no_map(method):
    assert region_cells(method, quick=True) == []


def test_a_cell_has_the_state_of_its_worst_impact_and_its_largest_error():
    """Three impacts a cell: psi1 = 0.3, 0.95 and 1.2."""
    refused, raised = outcome(REFUSED), outcome(RAISED)
    wrong, skipped = outcome(WRONG, 0.7), outcome(SKIPPED)
    answers = {
        "psi1=0.95 chi=0.5 steps=5": refused,
        "psi1=0.3 chi=3 steps=5": raised,
        "psi1=0.95 chi=3 steps=5": refused,
        "psi1=0.3 chi=0.5 steps=9": wrong,
        "psi1=0.95 chi=0.5 steps=9": raised,
        "psi1=1.2 chi=3 steps=9": outcome(ANSWERED, 0.2),
        **{f"psi1={psi1} chi=0.5 steps=30": skipped for psi1 in (0.3, 0.95, 1.2)},
    }
    judged, seen = judging(answers)
    found = region(STEPPED, [(n, chi) for n in (5, 9, 30) for chi in (0.5, 3.0)], judged=judged)
    assert (found.method, found.word) == ("springs / symplectic", "steps")
    assert (found.resolutions, found.chis) == ((5, 9, 30), (0.5, 3.0))
    assert found.state.tolist() == [
        [ONE_REFUSED, ONE_RAISED], [ONE_WRONG, ALL_ANSWERED], [ONE_REFUSED, ALL_ANSWERED]
    ]  # fmt: skip
    np.testing.assert_array_equal(found.error, [[1e-3, 1e-3], [0.7, 0.2], [np.nan, 1e-3]])
    assert found.failures == (raised, wrong, raised)
    assert (found.count(WRONG), found.count(RAISED)) == (1, 2)
    assert found.tried == len(seen) == 18
    assert found.complete
    assert found.converges
    assert ALL_ANSWERED < ONE_REFUSED < ONE_RAISED < ONE_WRONG


def test_a_cell_is_marched_at_the_steps_asked_for():
    judged, seen = judging({})
    region(STEPPED, [(5, 0.5)], judged=judged)
    assert [case.label for case in seen] == [
        f"psi1={psi1} chi=0.5 steps=5" for psi1 in ("0.3", "0.95", "1.2")
    ]
    for case, psi1 in zip(seen, (0.3, 0.95, 1.2), strict=True):
        assert case.options == {"tangential": {}, "integrator": {"steps": 5, "refine": False}}
        assert (case.family, case.planned, case.method) == ("map", False, STEPPED)
        scene = case.scene.make()
        assert (scene.psi1, scene.chi) == pytest.approx((psi1, 0.5))
        assert case.scene.family == "map"
    judged, seen = judging({})
    region(RULED, [(1e-3, 0.5)], judged=judged)
    assert seen[0].options == {"tangential": {}, "integrator": {"tolerance": 1e-3}}


def test_a_tolerance_that_takes_too_many_steps_is_not_tried():
    """sqrt((1 + chi)/tolerance) of at most 3e4: 9e8 times 1e-6 less 1 is 899. Not so of steps."""
    judged, seen = judging({})
    found = region(RULED, [(1e-6, 898.9), (1e-6, 899.1)], judged=judged)
    assert found.state.tolist() == [[ALL_ANSWERED, NOT_TRIED]]
    assert np.isnan(found.error[0, 1])
    assert (found.tried, found.complete) == (len(seen), True)
    assert len(seen) == 3
    stepped = region(STEPPED, [(1, 1e12)], judged=judged)
    assert stepped.state.tolist() == [[ALL_ANSWERED]]


def test_no_cell_is_begun_after_the_time_limit():
    judged, seen = judging({})
    over = region(STEPPED, [(5, 0.5)], until=time.perf_counter() - 1.0, judged=judged)
    assert (over.complete, over.tried, seen) == (False, 0, [])
    assert over.state.tolist() == [[NOT_TRIED]]
    ample = region(STEPPED, [(5, 0.5)], until=time.perf_counter() + 1e3, judged=judged)
    assert (ample.complete, ample.tried) == (True, 3)
