"""`contactlab bench`: errors, orders, gaps, the front."""

import json

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.legend import Legend

from contactlab.cli.bench import markdown
from contactlab.cli.main import main
from contactlab.figures.work_precision import work_precision as draw
from contactlab.study import work_precision
from contactlab.study.bench_methods import Method, methods, scenes
from contactlab.study.work_precision import Benchmark, Row, bench


def row(method="a", error=1.0, time=1.0, failed=0, options="steps=10"):
    return Row(
        method=method, options=options, error_rms=error, error_worst=error, force_error_rms=error,
        books_worst=0.0, time_s=time, sweep_time_s=time, failed=failed,
        status="SUCCESS" if not failed else "NON_FINITE",
    )  # fmt: skip


def test_every_fitting_composition_is_there_and_no_other():
    names = {method.name for method in methods()}
    assert {"annulus / paper", "springs / symplectic", "fronts / events"} <= names
    assert "fronts / paper" not in names
    assert not any(name.startswith("frictionless") for name in names)


def test_law_by_name_and_unknown_law():
    assert {method.tangential for method in methods(["tangential.coulomb"])} == {"coulomb"}
    with pytest.raises(ValueError, match=r"did you mean 'tangential.springs'"):
        methods(["springz"])


def test_no_scene_is_answered_in_closed_form():
    """Slip throughout would make every law look exact."""
    for scene in scenes():
        assert abs(scene.psi1) < max(1.0, 4.0 * scene.chi - 1.0)


def test_errors_fall_with_the_steps_and_the_order_is_seen():
    seen = []
    method = Method(tangential="springs", integrator="symplectic")
    found = bench([method], quick=True, progress=lambda *count: seen.append(count))
    assert seen == [(done, len(found.rows)) for done in range(1, len(found.rows) + 1)]
    errors = [entry.error_rms for entry in found.rows]
    assert errors[0] > 10 * errors[-1] > 0
    assert found.orders["springs / symplectic"] == pytest.approx(2.0, abs=0.4)
    assert all(entry.time_s > 0 for entry in found.rows)


def test_front_holds_what_nothing_beats():
    rows = (row(error=1.0, time=1.0), row(error=0.5, time=2.0), row(error=0.7, time=3.0))
    failed = row(error=np.nan, time=np.nan, failed=1)
    benchmark = Benchmark(rows=(*rows, failed), orders={}, complete=True)
    assert benchmark.front() == [rows[0], rows[1]]


def test_below_rounding_only_time_counts():
    rows = tuple(row(error=error, time=time) for error, time in ((3e-14, 1.0), (1e-16, 2.0)))
    assert Benchmark(rows=rows, orders={}, complete=True).front() == [rows[0]]
    equal = tuple(row(error=0.5, time=time) for time in (1.0, 2.0))
    assert Benchmark(rows=equal, orders={}, complete=True).front() == [equal[0]]


def test_an_order_is_a_slope_and_a_flat_ladder_has_none():
    falling = [row(error=h**-2.0, options=f"steps={h}") for h in (10, 20, 40)]
    assert work_precision._order(falling) == pytest.approx(2.0)
    flat = [row(error=0.3, options=f"steps={h}") for h in (10, 20, 40)]
    assert np.isnan(work_precision._order(flat))


def test_failed_and_slow_resolutions_are_gaps_never_dropped(monkeypatch):
    monkeypatch.setattr(work_precision, "SLOW_QUICK", 0.0)
    found = bench([Method(tangential="springs", integrator="symplectic")], quick=True)
    assert [entry.status for entry in found.rows] == ["SUCCESS", "NOT_RUN", "NOT_RUN"]
    assert not found.rows[-1].ok


def test_a_short_table_has_what_is_good_enough_and_what_is_best():
    rows = (
        row("fine / a", error=1e-2, time=1.0),
        row("fine / a", error=9e-4, time=2.0),
        row("fine / b", error=8e-4, time=3.0),
        row("fine / b", error=8e-5, time=9.0),
        row("fine / a", error=7e-6, time=8.0),
        row("rigid", error=0.7, time=0.5),
        row("capped / a", error=0.39, time=0.1),
        row("capped / a", error=0.26, time=0.4),
        row("capped / a", error=0.2, time=0.8),
        row("failed / a", error=np.nan, time=np.nan, failed=1),
    )
    benchmark = Benchmark(rows=rows, orders={}, complete=False, interrupted=True)
    assert benchmark.short() == [rows[4], rows[1], rows[6], rows[5]]
    lines = markdown(benchmark).splitlines()
    assert len({line.count("|") for line in lines[:6]}) == 1
    assert lines[2].startswith("| `fine`, `a` | steps=10 | 7.0e-06 |")
    assert lines[-1] == "not complete: interrupted"


def test_two_forms_of_one_table_are_refused(capsys):
    assert main(["bench", "--json", "--markdown"]) == 2
    assert "leave out one" in capsys.readouterr().err


def test_budget_ends_it_and_says_so(capsys):
    assert main(["bench", "--quick", "--law", "coulomb", "--budget", "1e-6"]) == 0
    assert "not complete" in capsys.readouterr().out


def test_command_writes_table_csv_and_picture(tmp_path, capsys):
    files = [str(tmp_path / name) for name in ("b.png", "b.csv")]
    arguments = [
        "bench",
        "--quick",
        "--law",
        "coulomb",
        "--json",
        "--figure",
        files[0],
        "--csv",
        files[1],
    ]
    assert main(arguments) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["complete"] is True
    assert len((tmp_path / "b.csv").read_text().splitlines()) == len(content["rows"]) + 1
    assert (tmp_path / "b.png").stat().st_size > 10_000
    assert main(["bench", "--budget", "-1"]) == 2


@pytest.mark.parametrize("width", [3.4, 9.0])
def test_the_picture_names_laws_and_integrators(width):
    rows = tuple(
        row(method=method, error=error, time=time)
        for method, error, time in (
            ("springs / symplectic", 1e-2, 1e-4), ("springs / adaptive", 1e-3, 1e-3),
            ("walton", 1e-1, 1e-5),
        )
    )  # fmt: skip
    figure = Figure(figsize=(width, 3.0))
    axes = draw(figure.add_subplot(), Benchmark(rows=rows, orders={}, complete=True))
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    legends = [each for each in axes.get_children() if isinstance(each, Legend)]
    named = {each.get_title().get_text(): [t.get_text() for t in each.texts] for each in legends}
    assert named["law"] == ["springs", "walton"]
    assert named["integrator"][:2] == ["symplectic", "adaptive"]
    (laws,) = [each for each in legends if each.get_title().get_text() == "law"]
    springs, walton = (line.get_marker() for line in laws.get_lines())
    assert springs in ("None", "", None)  # its markers are those of the integrators
    assert walton not in ("None", "", None)
