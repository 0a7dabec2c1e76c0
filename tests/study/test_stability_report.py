"""The stability report as a whole: order of cases, work, budget, and what it counts."""

import itertools

import numpy as np

from contactlab import Scene
from contactlab.study import stability as report
from contactlab.study.bench_methods import Method
from contactlab.study.stability import Stability, stability
from contactlab.study.stability_cases import Case, Extreme, cases
from contactlab.study.stability_judge import ANSWERED, RAISED, REFUSED, WRONG, Outcome
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


def refuse_all(seen):
    def judged(one):
        seen.append(one)
        return told(REFUSED, family=one.family, case=one.label)

    return judged


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
