"""The report of ``contactlab bench`` as it is printed, of rows that are made by hand."""

from __future__ import annotations

import math

import attrs
import pytest

from contactlab.cli import bench
from contactlab.cli.arguments import write_items
from contactlab.study.benchmark import Benchmark, Row

NAN = math.nan


def row(method, options, **more):
    plain = {"error_rms": 1.234e-3, "error_worst": 5.6e-3, "force_error_rms": 7.8e-3,
             "books_worst": 9.1e-10, "time_s": 1.2e-3, "sweep_time_s": 3.4e-5, "failed": 0,
             "status": "SUCCESS", "elsewhere_rms": 2.5e-3}  # fmt: skip
    return Row(method=method, options=options, **(plain | more))


ROWS = (
    row("rebound()", "", time_s=NAN, force_error_rms=NAN, sweep_time_s=1e-8, error_rms=1e-9),
    row("springs / paper", "steps=100", error_rms=2e-3, time_s=5.0, sweep_time_s=6.0),
    row("springs / paper", "steps=50", failed=3, status="TOO_FEW_STEPS", error_rms=NAN),
)


def benched(rows, *, complete=True, orders=None, interrupted=False):
    return Benchmark(rows=rows, complete=complete, orders=orders or {}, interrupted=interrupted)


@pytest.mark.parametrize("interrupted", [True, False])
def test_the_table_of_the_benchmark(interrupted, monkeypatch):
    orders = {"springs / paper": 1.9876, "rebound()": NAN}
    monkeypatch.setattr(Benchmark, "front", lambda _: [ROWS[0]])
    whole = benched(ROWS, orders=orders)
    text = bench._report(whole)
    lines = [line.split() for line in text.splitlines()]
    rule = next(place for place, line in enumerate(lines) if set("".join(line)) == {"-"})
    headings = sorted(word for line in lines[:rule] for word in line)
    assert headings == sorted(
        ["method", "resolution", "psi2", "rms", "worst", "elsewhere", "force", "books", "one",
         "of", "many", "note"]
    )  # fmt: skip
    first, second, third = lines[rule + 1 : rule + 4]
    errors = ["0.0056", "0.0025"]
    assert first == ["rebound()", "1e-09", *errors, "-", "9.1e-10", "-", "10", "ns", "front"]
    assert second == ["springs", "/", "paper", "steps=100", "0.002", *errors, "0.0078", "9.1e-10",
                        "5", "s", "6", "s"]  # fmt: skip
    assert third == ["springs", "/", "paper", "steps=50", "-", *errors, "0.0078", "9.1e-10",
                        "1.2", "ms", "34", "µs", "3", "x", "TOO_FEW_STEPS"]  # fmt: skip
    assert text.endswith(
        "\n\nmethod           order observed\n---------------  --------------\n"
        "springs / paper            1.99"
    )
    part = attrs.evolve(whole, complete=False, interrupted=interrupted)
    why = "interrupted" if interrupted else "the budget ran out"
    assert bench._report(part) == f"{text}\n\nnot complete: {why}"
    assert "order observed" not in bench._report(benched(ROWS))


def test_the_short_table_of_the_benchmark(monkeypatch):
    monkeypatch.setattr(Benchmark, "short", lambda me: list(me.rows[:2]))
    text = bench.markdown(benched(ROWS, complete=True))
    assert text.splitlines() == [
        "| law, integrator | resolution | psi2 rms | worst | beyond spheres | energy books | one "
        "impact | each of many |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
        "| `rebound()` |  | 1.0e-09 | 5.6e-03 | 2.5e-03 | 9.1e-10 | - | 10 ns |",
        "| `springs`, `paper` | steps=100 | 2.0e-03 | 5.6e-03 | 2.5e-03 | 9.1e-10 | 5 s | 6 s |",
    ]
    part = benched((row("a", "b", error_rms=NAN),), complete=False)
    assert bench.markdown(part).endswith(
        "| `a` | b | - | 5.6e-03 | 2.5e-03 | 9.1e-10 | 1.2 ms | 34 µs |\n\nnot complete: the "
        "budget ran out"
    )


def test_a_benchmark_as_plain_numbers_and_as_a_file(tmp_path):
    whole = benched(ROWS, orders={"a": NAN, "b": 2.0})
    content = bench._content(whole)
    assert content["orders"] == {"a": None, "b": 2.0}
    assert content["complete"] is True
    assert [entry["time_s"] for entry in content["rows"]] == [None, 5.0, 1.2e-3]
    write_items(tmp_path / "b.csv", Row, whole.rows)
    lines = (tmp_path / "b.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0].split(",") == [field.name for field in attrs.fields(Row)]
    assert lines[2].startswith("springs / paper,steps=100,0.002,0.0056,0.0078,9.1e-10,5.0,6.0,0,")
    assert len(lines) == 4
