"""The report of ``contactlab stability`` as it is printed, of results that are made by hand."""

from __future__ import annotations

import argparse
import math
import re

import attrs
import numpy as np
import pytest

from contactlab.cli import stability
from contactlab.study.model_error import ModelError
from contactlab.study.stability import Stability
from contactlab.study.stability_judge import RAISED, WRONG, Outcome
from contactlab.study.stability_map import Region

NAN = math.nan


def outcome(family, kind, error=NAN, *, method="a / x", bound=NAN, case="here", note=""):
    return Outcome(
        method=method, family=family, case=case, outcome=kind, error=error, bound=bound, note=note
    )


OUTCOMES = (
    outcome("stiff", "answered", 1.26e-3, bound=0.01),
    outcome("stiff", "answered", 3.4e-3, bound=0.01),
    outcome("stiff", "answered", 0.2, bound=0.5),
    outcome("long", "refused", case="there"),
    outcome("long", "skipped", method="b"),
    outcome("long", "skipped", method="b"),
    outcome("long", RAISED, method="b", case="there", note="ValueError"),
    outcome("stiff", WRONG, 0.9, method="b", case="stiff one", note="error 0.9 of the range"),
)
TABLES = """\
worst error  stiff  long
-----------  -----  ----
a / x        0.003     -
b                -     -

runs   answered  coarse  refused  skipped  raised  silently wrong
-----  --------  ------  -------  -------  ------  --------------
a / x         3       1        1        0       0               0
b             0       0        0        2       1               1
"""
ENDING = """
Errors are numerical: distances from the law's own exact answer, over the range of psi2.
Answers whose declared or estimated error is a quarter of the range or more are counted as coarse
and have no error in the table.
A law whose exact answer differs from the elastic continuum is listed with its model error."""


def region(**counted):
    failures = tuple(
        outcome("map", kind, method="a / x", case=f"map {place}", note="odd")
        for kind, count in counted.items()
        for place in range(count)
    )
    return Region(method="a / x", word="steps", resolutions=(5, 9), chis=(0.5, 3.0, 7.0),
                  error=np.zeros((2, 3)), state=np.zeros((2, 3), dtype=np.int8), tried=24,
                  failures=failures)  # fmt: skip


def model(law, error):
    return ModelError(law=law, chis=(0.5, 1.5, 2.5), error=np.array(error))


def test_the_tables_of_stability():
    found = Stability(outcomes=OUTCOMES, regions=(), complete=True)
    text = stability.report(found)
    assert text.startswith(TABLES)
    assert re.search(r"^method +case$", text, re.MULTILINE)
    rows = [line.split() for line in text.splitlines() if line.startswith("b  ")]
    assert rows[2:] == [
        ["b", "there", "raised", "ValueError"],
        ["b", "stiff", "one", "silently", "wrong", "error", "0.9", "of", "the", "range"],
    ]
    assert text.endswith(
        f"\n\n6 runs tried, 1 silently wrong; 2 more were skipped as too much work.{ENDING}"
    )
    assert "map " not in text
    assert "model error  worst" not in text
    assert stability.report(attrs.evolve(found, complete=False)).endswith(
        f"{ENDING}\n\nnot complete: the budget ran out"
    )
    assert stability.report(attrs.evolve(found, complete=False), "interrupted").endswith(
        f"{ENDING}\n\nnot complete: interrupted"
    )
    sound = Stability(outcomes=OUTCOMES[:3], regions=(), complete=True)
    assert not re.search(r"^method +case$", stability.report(sound), re.MULTILINE)


def test_the_maps_and_the_model_errors_of_stability():
    models = (model("hertz", [NAN, -0.12, 0.34]), model("cap", [0.56, 0.1, NAN]),
              model("none", [NAN] * 3))  # fmt: skip
    regions = (region(**{RAISED: 2, WRONG: 1}), region())
    text = stability.report(Stability(outcomes=(), regions=regions, complete=True, models=models))
    assert (
        """
map    against chi  tried  raised  silently wrong
-----  -----------  -----  ------  --------------
a / x  steps           24       2               1
a / x  steps           24       0               0

model error  worst  at chi
-----------  -----  ------
hertz          0.3       2
cap            0.6     0.5
none             -       -

method  case"""
        in text
    )
    assert "48 runs tried, 1 silently wrong; 0 more" in text
    listed = [
        line.split() for line in text.splitlines() if line.startswith("a / x") and "odd" in line
    ]
    assert [row[3:5] for row in listed] == [["map", "0"], ["map", "1"], ["map", "0"]]


def arguments(**more):
    plain = {"budget": math.inf, "width": None, "law": None, "quick": True, "progress": False,
             "csv": None, "figure": None, "json": False, "style": "print"}  # fmt: skip
    return argparse.Namespace(**(plain | more))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--width", "one"), "--width one: the map is too wide for one column; use --width two"),
        (("--budget", "0"), "--budget 0: must be positive, in seconds"),
        (("--budget", "-1"), "--budget -1: must be positive, in seconds"),
    ],
)
def test_options_of_stability_that_cannot_be(run, options, words):
    assert run("stability", *options) == (2, "", f"contactlab stability: error: {words}\n")


def test_an_interrupted_report_has_the_outcomes_judged_so_far(monkeypatch, capsys):
    def study(chosen, *, judged, **_):
        assert [judged(case) for case in chosen] == list(chosen)
        raise KeyboardInterrupt

    monkeypatch.setattr(stability, "stability", study)
    monkeypatch.setattr(stability, "methods", lambda _: OUTCOMES[:2])
    monkeypatch.setattr(stability, "judge", lambda case: case)
    assert stability.execute(arguments()) == 130
    out = capsys.readouterr().out
    assert "2 runs tried" in out
    assert out.endswith("not complete: interrupted\n")
