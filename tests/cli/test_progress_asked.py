"""Each command asks for its progress line by the option and with the name of its work."""

from __future__ import annotations

import contextlib

import pytest

from contactlab.cli import arguments, bench, report, stability, validate
from contactlab.cli import compare as compare_command
from contactlab.study.benchmark import Benchmark
from contactlab.study.comparison import compare
from contactlab.study.stability import Stability


@pytest.fixture
def asked(monkeypatch):
    found = []

    def progress(wanted, what):
        found.append((wanted, what))
        return contextlib.nullcontext()

    monkeypatch.setattr(arguments, "progress", progress)
    monkeypatch.setattr(stability, "methods", lambda _: [])
    monkeypatch.setattr(
        stability, "stability", lambda *_, **__: Stability(outcomes=(), regions=(), complete=True)
    )
    monkeypatch.setattr(bench, "methods", lambda _: [])
    monkeypatch.setattr(
        bench, "bench", lambda *_, **__: Benchmark(rows=(), orders={}, complete=True)
    )
    monkeypatch.setattr(validate, "validate", lambda _: [])
    monkeypatch.setattr(validate, "gather", lambda **_: [])
    monkeypatch.setattr(report, "compare", compare)
    monkeypatch.setattr(compare_command, "compare", compare)
    monkeypatch.setattr("contactlab.pages.report.report_page", lambda *_: "")
    monkeypatch.setattr("contactlab.figures.animation.animate", lambda *_, **__: None)
    return found


RIGID = ("--tangential", "coulomb")


@pytest.mark.parametrize(
    ("words", "works"),
    [
        (["run", "--psi1", 6, "--chi", 1, *RIGID], ["impact", "files"]),
        (["run", "SWEEP"], ["impacts", "files"]),
        (["sweep", "SWEEP"], ["impacts", "files"]),
        (["compare", "SWEEP", *RIGID], ["runs", "files"]),
        (["stability"], ["stability", "files"]),
        (["bench"], ["bench", "files"]),
        (["validate"], ["checks", "sources"]),
        (["animate", "--psi1", 6, "--chi", 1, *RIGID, "--out", "a.gif"], ["frames"]),
        (["report", "SWEEP", *RIGID, "--out", "a.html"], ["laws", "files"]),
    ],
)
def test_the_work_has_a_name(run, asked, short_sweep, tmp_path, monkeypatch, words, works):
    monkeypatch.chdir(tmp_path)
    words = [short_sweep if word == "SWEEP" else word for word in words]
    for option, wanted in ((["--progress"], True), (["--no-progress"], False), ([], None)):
        assert run(*words, *option).status == 0
        assert asked == [(wanted, what) for what in works]
        asked.clear()
