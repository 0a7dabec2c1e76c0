"""`contactlab stability`: its table, its files, and that a law that is wrong makes it fail."""

import csv
import json
import math
import re

import attrs
import pytest
from matplotlib.figure import Figure

from contactlab.cli import stability
from contactlab.registry.registry import REGISTRY
from contactlab.study.bench_methods import Method
from contactlab.study.stability import Stability
from contactlab.study.stability_judge import RAISED, WRONG, Outcome

pytestmark = pytest.mark.slow

COMMAND = ("stability", "--quick", "--tangential", "springs")


def failed(outcome):
    return Outcome(method="a / paper", family="map", case="here", outcome=outcome, note="off by 9")


def test_a_law_without_steps_has_a_model_error_and_no_picture(run, tmp_path):
    ran = run("stability", "--quick", "--tangential", "coulomb", "--figure", tmp_path / "s.png")
    assert ran.status == 0
    assert float(re.search(r"^coulomb +(0\.\d+) +\S+$", ran.out, re.MULTILINE)[1]) > 0.3
    assert not (tmp_path / "s.png").exists()
    assert "nothing to map" in ran.err


def test_table_csv_and_figure_of_a_law(run, tmp_path):
    files = tmp_path / "s.csv", tmp_path / "s.png"
    ran = run(*COMMAND, "--out", files[0], "--figure", files[1])
    assert ran.status == 0
    for integrator in ("paper", "symplectic", "adaptive"):
        assert len(re.findall(rf"^springs / {integrator} ", ran.out, re.MULTILINE)) == 2
    with files[0].open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    total = re.search(
        r"(\d+) compared, 0 wrong; (\d+) had no reference.*; (\d+) refused.*; (\d+) not run",
        ran.out,
    )
    assert len(rows) == sum(map(int, total.groups()))
    compared = [row for row in rows if row["outcome"] == "answered" and row["error"] != "nan"]
    assert len(compared) == int(total[1])
    assert sum(row["family"] == "map" for row in rows) == 3 * 4 * (4 + 4 + 2)
    answered = [row for row in rows if row["outcome"] == "answered"]
    assert len(answered) > 100
    # eccentric impacts that no other method answers have no error
    assert not any(float(row["error"]) > float(row["bound"]) for row in answered)
    assert files[1].stat().st_size > 10_000


def test_a_law_that_is_silently_wrong_fails_it_and_is_named(run, monkeypatch, tmp_path):
    """Half the friction: steady, odd, its books in order, and wrong."""
    law = REGISTRY.law_class("tangential.springs")
    start, answer = law.start, law.whole_impacts

    def halved(scene):
        return attrs.evolve(scene, friction_coefficient=0.5 * scene.friction_coefficient)

    monkeypatch.setattr(law, "advance_all", lambda *_: None)
    monkeypatch.setattr(law, "start", lambda me, scene, normal: start(me, halved(scene), normal))
    monkeypatch.setattr(
        law, "whole_impacts", lambda me, scene, normal: answer(me, halved(scene), normal)
    )
    monkeypatch.setattr(
        stability,
        "methods",
        lambda *_, **__: [Method(tangential="springs", integrator="symplectic")],
    )
    ran = run(*COMMAND, "--out", tmp_path / "s.csv")
    assert ran.status == 1
    assert re.search(r"springs / symplectic +\S.* silently wrong +error \S+ of the range", ran.out)
    wrong = int(re.search(r"compared, (\d+) wrong;", ran.out)[1])
    row = re.search(r"^springs / symplectic +\d+ [\d ]+ (\d+)$", ran.out, re.MULTILINE)
    assert int(row[1]) == wrong > 10
    with (tmp_path / "s.csv").open(newline="", encoding="utf-8") as stream:
        listed = [row for row in csv.DictReader(stream) if row["outcome"] == "silently wrong"]
    assert len(listed) == wrong
    assert {"map", "chi"} <= {row["family"] for row in listed}
    content = json.loads(run(*COMMAND, "--json").out)
    assert content["silently_wrong"] == wrong
    assert sum(item["outcome"] == "silently wrong" for item in content["outcomes"]) == wrong


@pytest.mark.parametrize("outcome", [WRONG, RAISED])
def test_a_failure_on_the_map_alone_fails_it(run, monkeypatch, outcome):
    found = Stability(outcomes=(failed(outcome),), complete=True)
    monkeypatch.setattr(stability, "stability", lambda *_, **__: found)
    ran = run(*COMMAND)
    assert ran.status == 1
    assert re.search(rf"a / paper +here +{outcome} +off by 9", ran.out)
    assert f"0 compared, {int(outcome == WRONG)} wrong; " in ran.out
    assert ("1 raised an error" in ran.out) is (outcome == RAISED)


def test_answers_without_a_reference_are_not_counted_as_compared(run, monkeypatch):
    """Each of the outcomes is one number of the totals, in words and in JSON."""
    told = [
        *(("answered", 0.001), ("answered", math.nan), ("answered", math.nan), (WRONG, 0.5)),
        *((WRONG, math.nan), ("refused", math.nan), ("skipped", math.nan)),
    ]
    outcomes = tuple(attrs.evolve(failed(word), error=error) for word, error in told)
    found = Stability(outcomes=outcomes, complete=True)
    monkeypatch.setattr(stability, "stability", lambda *_, **__: found)
    words = run(*COMMAND).out
    assert "2 compared, 2 wrong; 3 had no reference" in words
    assert "1 refused with a reason; 1 not run" in words
    content = json.loads(run(*COMMAND, "--json").out)
    counted = ("compared", "no_reference", "refused", "raised", "not_run")
    assert [content[name] for name in counted] == [2, 3, 1, 0, 1]
    assert (content["silently_wrong"], content["tried"]) == (2, 6)


def test_the_picture_has_a_curve_a_law_under_its_usual_integrator(run, tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: drawn.append(figure))
    laws = ("--tangential", "springs,linear_spring")
    ran = run(*COMMAND[:2], *laws, "--figure", tmp_path / "m.png")
    assert ran.status == 0
    (axes,) = drawn[0].axes
    assert {"springs", "linear spring"} <= {text.get_text() for text in axes.texts}


def test_a_restitution_stands_in_place_of_a_normal_law(run):
    """Of Coulomb at a point: each case at that restitution, elastic ones beside it differ."""
    words = "stability", "--quick", "--tangential", "coulomb", "--csv"
    ran = run(*words, "--restitution", "0.6")
    assert ran.status == 0
    methods = {row["method"] for row in csv.DictReader(ran.out.splitlines())}
    assert methods == {"coulomb, viscoelastic e=0.6"}
    refused = run(*words, "--restitution", "0.6", "--normal", "hertz")
    assert refused.status == 2
    assert "stands in place of a normal law, and hertz is named" in refused.err
    assert "from 0 to 1" in run(*words, "--restitution", "1.6").err
