"""``python -m table_builders``: what each command calls, with which numbers, and what it prints."""

import os
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from contactlab.impact import coupling
from contactlab_laws.tables import damped, elastic
from contactlab_laws.tables.file import Stored, write
from table_builders import __main__ as command
from table_builders.coupling import build as unlike
from table_builders.damped import build as damped_build
from table_builders.damped import checks, differences
from table_builders.elastic import bench, build, thin, verify
from table_builders.elastic.verify import Errors

ROWS = [
    Errors("beside psi1 = 0", 3, 2.5e-12, 1e-12, 0.25, 1.5),
    Errors("all", 12, 1e-9, 2e-10, 1.0, 0.125),
]


class Call(NamedTuple):
    """What a function was called with."""

    given: tuple
    named: dict


@pytest.fixture
def told(monkeypatch):
    """Return the calls of the functions that the commands stand for."""
    calls = {}

    def stand_in(place, name, answer):
        def noted(*given, **named):
            calls[f"{place.__name__}.{name}"] = Call(given, named)
            return answer

        monkeypatch.setattr(place, name, noted)

    stand_in(unlike, "build", None)
    stand_in(damped_build, "build", None)
    stand_in(differences, "write", None)
    stand_in(checks, "verify", 3)
    stand_in(checks, "bench", 4)
    stand_in(bench, "bench", [("9 together", 12.4), ("one at a time", 98765.4)])
    stand_in(build, "build", None)
    stand_in(thin, "write", [])
    stand_in(verify, "verify", ROWS)
    return calls


def run(monkeypatch, *asked):
    monkeypatch.setattr(sys, "argv", ["table_builders", *asked])
    return command.main()


@pytest.mark.parametrize(
    ("asked", "called", "given", "answer"),
    [
        ("coupling build", "coupling.build.build", (coupling.FILE,), 0),
        ("elastic thin", "elastic.thin.write", (), 0),
        ("damped build", "damped.build.build", (damped.SHIPPED,), 0),
        ("damped differences", "damped.differences.write", (), 0),
        ("damped bench", "damped.checks.bench", (), 4),
        ("damped verify", "damped.checks.verify", (480, 1), 3),
        ("damped verify --count 7 --seed 2", "damped.checks.verify", (7, 2), 3),
    ],
)
def test_a_command_calls_one_function_and_returns_its_answer(
    asked, called, given, answer, told, monkeypatch, capsys
):
    assert run(monkeypatch, *asked.split()) == answer
    assert told == {f"table_builders.{called}": (given, {})}
    assert capsys.readouterr().out == ""


def test_the_time_of_elastic_impacts_is_printed_in_nanoseconds(told, monkeypatch, capsys):
    assert run(monkeypatch, "elastic", "bench") == 0
    assert list(told) == ["table_builders.elastic.bench.bench"]
    assert capsys.readouterr().out == (
        "9 together                           12 ns of processor time\n"
        "one at a time                     98765 ns of processor time\n"
    )


def small(tmp_path):
    file = tmp_path / "small.npz"
    write(file, Stored({"cells": np.zeros((5, 5))}, "1.2", "2026-11-01"))
    return file


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ((), {"tolerance": 1e-10, "workers": 1}),
        (("--tolerance", "1e-6", "--workers", "3"), {"tolerance": 1e-6, "workers": 3}),
        (("--workers", "0"), {"tolerance": 1e-10, "workers": os.cpu_count()}),
    ],
)
def test_building_tells_patches_and_bytes(options, named, told, monkeypatch, capsys, tmp_path):
    file = small(tmp_path)
    assert run(monkeypatch, "elastic", "build", "--file", str(file), *options) == 0
    assert told == {"table_builders.elastic.build.build": ((file,), named)}
    size = len(file.read_bytes())
    assert capsys.readouterr().out == f"{file}: 5 patches, {size} bytes\n"


def test_a_machine_that_hides_its_cores_has_one(told, monkeypatch, tmp_path):
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    run(monkeypatch, "elastic", "build", "--file", str(small(tmp_path)), "--workers", "0")
    assert told["table_builders.elastic.build.build"].named["workers"] == 1


@pytest.mark.parametrize(
    ("options", "named", "answer"),
    [
        ("", {"count": 10_000, "seed": 1, "workers": 1, "alone": False}, 0),
        ("--count 9 --seed 4 --workers 2 --alone --bound 0.9e-9", None, 1),
    ],
)
def test_verifying_prints_a_table_and_fails_above_the_bound(
    options, named, answer, told, monkeypatch, capsys
):
    assert run(monkeypatch, "elastic", "verify", *options.split()) == answer
    call = told["table_builders.elastic.verify.verify"]
    assert call.named == (named or {"count": 9, "seed": 4, "workers": 2, "alone": True})
    assert np.array_equal(call.given[0].grid, elastic.shipped().grid)
    stored = elastic.read(elastic.SHIPPED)
    assert capsys.readouterr().out == (
        f"{elastic.SHIPPED}: contactlab {stored.version}, {stored.built}\n"
        "errors of max(1, psi1)           count  largest      rms  at psi1, chi\n"
        "beside psi1 = 0                      3  2.5e-12  1.0e-12  0.25, 1.5\n"
        "all                                 12  1.0e-09  2.0e-10  1.0, 0.125\n"
    )


@pytest.mark.parametrize(
    ("asked", "lines"),
    [
        (
            "",
            [
                "usage: python -m table_builders [-h] {elastic,damped,coupling} ...",
                "``python -m table_builders``: build a table, verify it, or time it; run in "
                "``plugins``.",
                "elastic the elastic rebound",
                "damped the rebound with a restitution, by Tsuji's law",
                "coupling the size of elastic coupling of unlike bodies",
            ],
        ),
        (
            "elastic",
            [
                "build build the table: minutes",
                "verify compare with fresh impacts",
                "bench print the processor time an impact takes",
            ],
        ),
        ("damped", ["differences measure springs and normal laws: minutes"]),
        ("damped verify", ["--count COUNT impacts (480)"]),
        ("elastic build", ["--tolerance TOLERANCE of psi2/psi1 (1e-10)"]),
        (
            "elastic verify",
            [
                "--count COUNT impacts (10000) --seed SEED --alone solve each impact alone: slow "
                "--bound BOUND largest error (1e-9) "
                "--workers WORKERS processes; 0 for one a core (1) --file FILE the table"
            ],
        ),
        ("coupling", ["build build the table: four minutes of processor time"]),
    ],
)
def test_help_tells_commands_and_defaults(asked, lines, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "200")
    with pytest.raises(SystemExit) as ended:
        run(monkeypatch, *asked.split(), "--help")
    assert ended.value.code == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert [line for line in lines if line not in printed] == []


@pytest.mark.parametrize("asked", ["", "elastic", "damped", "coupling", "damped build --count 3"])
def test_an_unfinished_command_is_refused(asked, told, monkeypatch, capsys):
    with pytest.raises(SystemExit) as ended:
        run(monkeypatch, *asked.split())
    assert ended.value.code == 2
    assert not told
    assert "usage: python -m table_builders" in capsys.readouterr().err


def test_only_the_elastic_table_may_be_another_file(monkeypatch, capsys, told):
    with pytest.raises(SystemExit):
        run(monkeypatch, "damped", "build", "--file", str(Path("any.npz")))
    assert "unrecognized arguments: --file" in capsys.readouterr().err
    assert not told
