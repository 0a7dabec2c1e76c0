"""The stability report as a whole: order of cases, work, budget, and what it counts."""

import itertools

import numpy as np
import pytest

from contactlab import Scene
from contactlab.study import stability as report
from contactlab.study.bench_methods import Method
from contactlab.study.stability import Stability, stability, work
from contactlab.study.stability_cases import Case, Extreme, cases
from contactlab.study.stability_judge import ANSWERED, RAISED, REFUSED, SKIPPED, WRONG, Outcome
from contactlab.study.stability_map import Region

SPRINGS = Method(tangential="springs", integrator="symplectic")


def told(outcome, **entries):
    names = {"method": "a / b", "family": "speed", "case": ""}
    return Outcome(**(names | {"outcome": outcome} | entries))


def case(chi=3.0, tangential=None, integrator=None, family="chi"):
    def make():
        return Scene.nondimensional(psi1=1.2, chi=chi)

    options = {"tangential": tangential or {}, "integrator": integrator or {}}
    scene = Extreme(family, "", make)
    return Case(family=family, label="", method=SPRINGS, options=options, scene=scene)


@pytest.mark.parametrize(
    ("entries", "steps"),
    [
        # 200 steps and a tolerance of 1e-4 if none is set; root of 1 + chi under a tolerance.
        ({}, 200.0 * 2.0),
        ({"chi": 8.0}, 200.0 * 3.0),
        ({"integrator": {"steps": 70}}, 70.0),
        ({"integrator": {"tolerance": 1e-6}}, 200.0 * 2.0 * 10.0),
        ({"integrator": {"tolerance": 1e-2}}, 200.0 * 2.0 / 10.0),
        # Parts cost by their square over 1e4; a tolerance of the law is none.
        ({"integrator": {"steps": 70}, "tangential": {"springs": 100}}, 140.0),
        ({"integrator": {"steps": 70}, "tangential": {"springs": 300}}, 700.0),
        ({"integrator": {"steps": 70}, "tangential": {"tolerance": 1e6}}, 70.0),
        ({"chi": 1e14}, 200.0 * 1e6),
        ({"chi": float("nan")}, 200.0),  # a refused scene
    ],
)
def test_work_is_that_of_steps_and_parts(entries, steps):
    assert work(case(**entries)) == pytest.approx(steps, rel=1e-6)


def refuse_all(seen):
    def judged(one):
        seen.append(one)
        return told(REFUSED, family=one.family, case=one.label)

    return judged


def test_cases_are_run_by_family_and_by_work_and_the_long_ones_are_skipped(monkeypatch):
    """Work of 12 000 is run and more is not, in a quick report."""
    limit = report.QUICK_LARGEST
    listed = [
        case(integrator={"steps": steps}, family=family)
        for family in ("steps", "chi")
        for steps in (int(limit) + 1, 5, int(limit), 7)
    ]
    monkeypatch.setattr(report, "cases", lambda _, *, quick: iter(listed if quick else []))
    monkeypatch.setattr(report, "region_cells", lambda *_, **__: [])
    seen = []
    found = stability([SPRINGS], quick=True, judged=refuse_all(seen))
    ran = [(one.family, one.options["integrator"]["steps"]) for one in seen]
    assert ran == [(family, n) for family in ("chi", "steps") for n in (5, 7, int(limit))]
    assert [one.outcome for one in found.outcomes] == [REFUSED, REFUSED, REFUSED, SKIPPED] * 2
    assert {one.note for one in found.outcomes if one.outcome == SKIPPED} == {"too much work"}
    assert (limit, report.LARGEST) == (12_000.0, 300_000.0)
    assert (found.skipped(), found.tried(), found.complete) == (2, 6, True)


def test_every_method_has_its_map_and_each_law_one_model_error(monkeypatch):
    """Model errors are of elastic contact: a law under another normal law has none of its own."""
    methods = [
        SPRINGS,
        Method(tangential="springs", integrator="adaptive"),
        Method(tangential="coulomb", integrator="symplectic", normal="jkr"),
    ]
    asked, mapped = [], []
    monkeypatch.setattr(report, "model_error", lambda *words: asked.append(words))
    monkeypatch.setattr(report, "cases", lambda *_, **__: iter(()))

    def region(method, cells, *, until, judged):
        mapped.append((method, cells, until))
        nothing = np.zeros((1, 1))
        return Region(
            method=method.name, word="steps", resolutions=(1.0,), chis=(1.0,), error=nothing,
            state=nothing.astype(np.int8), tried=len(cells), complete=method is SPRINGS,
        )  # fmt: skip

    monkeypatch.setattr(report, "region", region)
    seen = []
    found = stability(methods, quick=True, progress=lambda *count: seen.append(count))
    assert [(method, len(cells)) for method, cells, _ in mapped] == [
        (methods[0], 16),
        (methods[1], 8),
    ]
    assert asked == [("springs", (0.05, 0.5, 3.0, 30.0), (0.3, 0.95, 1.2))]
    # The second map was cut short: its cells do not count as done.
    assert seen == [(16, 25), (16, 25), (17, 25)]
    assert not found.complete
    assert found.tried() == 24


def test_a_budget_is_asked_before_each_case(monkeypatch):
    """The clock begins at 100 s and ticks 1 s a look: a budget of 2.5 s holds two cases."""
    clock = itertools.count(100.0)
    monkeypatch.setattr(report.time, "perf_counter", lambda: next(clock))
    found = stability([SPRINGS], quick=True, budget=2.5, judged=refuse_all([]))
    assert len(found.outcomes) == 2
    assert not found.complete
    assert found.regions == found.models == ()


def test_without_a_budget_every_case_is_run():
    method = Method(tangential="walton", integrator="symplectic")
    found = stability([method], quick=True, judged=refuse_all([]))
    assert found.complete
    assert len(found.outcomes) == len(list(cases(method, quick=True)))
    assert found.skipped() == 0


def test_failures_are_those_of_cases_and_of_the_map():
    wrong, raised, good = told(WRONG), told(RAISED), told(ANSWERED)
    nothing = np.zeros((1, 1))
    region = Region(
        method="a", word="steps", resolutions=(1.0,), chis=(1.0,), error=nothing,
        state=nothing.astype(np.int8), tried=5, failures=(wrong,),
    )  # fmt: skip
    found = Stability(outcomes=(good, wrong, raised), regions=(region,), complete=True)
    assert found.failures() == [wrong, raised, wrong]
    assert (found.silently_wrong(), found.tried(), found.skipped()) == (2, 8, 0)
    assert (region.complete, region.converges, found.models) == (True, True, ())


def test_coarse_is_an_answer_with_a_bound_above_a_quarter_of_the_range():
    outcomes = (
        told(ANSWERED, error=0.05, bound=0.25), told(ANSWERED, error=0.2, bound=0.2501),
        told(WRONG, error=0.9, bound=0.9), told(ANSWERED, error=0.3, bound=0.1, family="mass"),
        told(ANSWERED, error=0.4, bound=0.1, method="c"), told(ANSWERED, bound=0.1),
    )  # fmt: skip
    found = Stability(outcomes=outcomes, regions=(), complete=True)
    assert found.counts("a / b") == {ANSWERED: 4, WRONG: 1, "coarse": 1}
    assert found.worst("a / b", "speed") == 0.05
    assert np.isnan(found.worst("c", "mass"))
    assert (told(ANSWERED).note, told(ANSWERED).run_time_s) == ("", 0.0)
