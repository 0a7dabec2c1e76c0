"""Ctrl-C in the middle of a report keeps what is done, says so, and ends with 130."""

from __future__ import annotations

import csv
import json
import time
from types import SimpleNamespace

import pytest

from contactlab.cli import stability
from contactlab.study import paper_figures, work_precision
from contactlab.study.bench_methods import Method
from tests.cli.conftest import interrupting, partial

STEPPED = [Method(tangential="springs", integrator="symplectic")]


def rows(path):
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def test_bench(run, monkeypatch, tmp_path):
    """A clock that interrupts: in the second question, and before the first answer."""
    clock = SimpleNamespace(process_time=interrupting(time.process_time, 0))
    words = ("bench", "--quick", "--tangential", "coulomb")
    table, picture = tmp_path / "b.csv", tmp_path / "b.png"
    monkeypatch.setattr(work_precision, "_ask", interrupting(work_precision._ask, 1))
    ran = run(*words, "--out", table, "--figure", picture)
    assert ran.status == 130
    assert ran.out.endswith("not complete: interrupted\n")
    assert {row["question"] for row in rows(partial(table))} == {"sphere"}
    assert partial(picture).read_bytes().startswith(b"\x89PNG")
    monkeypatch.undo()
    monkeypatch.setattr(work_precision, "time", clock)
    ran = run(*words, "--json", "--figure", tmp_path / "none.png")
    assert ran.status == 130
    content = json.loads(ran.out)
    assert (content["rows"], content["complete"]) == ([], False)
    assert not (tmp_path / "none.png").exists()
    assert "what is done" not in ran.err


@pytest.mark.parametrize("after", [0, 7])
def test_stability(run, monkeypatch, tmp_path, after):
    """A clock that interrupts: it is read before each case."""
    monkeypatch.setattr(stability, "methods", lambda _, **__: STEPPED)
    clock = SimpleNamespace(perf_counter=interrupting(time.perf_counter, after))
    monkeypatch.setattr("contactlab.study.time_limit.time", clock)
    table, picture = tmp_path / "s.csv", tmp_path / "s.png"
    partial(picture).write_text("earlier")
    ran = run("stability", "--quick", "--out", table, "--figure", picture)
    assert ran.status == 130
    assert ran.out.endswith("not complete: interrupted\n")
    assert len(rows(partial(table))) == after
    assert not picture.exists()
    assert partial(picture).read_text() == "earlier"
    assert "no map drawn: interrupted" in ran.err
    assert f"what is done is in {partial(table)}" in ran.err
    assert f"what is done is in {partial(picture)}" not in ran.err


def test_figures(run, monkeypatch, tmp_path):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(paper_figures, "figure_4", interrupted)
    ran = run("figures", "--out", tmp_path, "--only", "2,4", "--tangential", "coulomb")
    assert ran.status == 130
    assert sorted(path.name for path in tmp_path.iterdir()) == ["figure-2.csv", "figure-2.png"]
    assert "interrupted" in ran.err
