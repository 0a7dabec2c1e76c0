"""`contactlab bench`: errors, orders, gaps, the front."""

import itertools
import json

import attrs
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab import Simulation
from contactlab.cli import bench as cli_bench
from contactlab.cli.bench import markdown
from contactlab.cli.main import main
from contactlab.figures.work_precision import work_precision as draw
from contactlab.registry import composition
from contactlab.study import work_precision
from contactlab.study.bench_methods import Method, methods, scenes
from contactlab.study.benchmark import Benchmark, Row
from contactlab.study.work_precision import bench
from tests.longer import longer


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
    with pytest.raises(ValueError, match=r"did you mean 'springs'"):
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
    told = cli_bench._report(benchmark).splitlines()
    assert [line.endswith("front") for line in told[2:5]] == [True, True, False]


def test_below_rounding_only_time_counts():
    rows = tuple(row(error=error, time=time) for error, time in ((3e-14, 1.0), (1e-16, 2.0)))
    assert Benchmark(rows=rows, orders={}, complete=True).front() == [rows[0]]
    equal = tuple(row(error=0.5, time=time) for time in (1.0, 2.0))
    assert Benchmark(rows=equal, orders={}, complete=True).front() == [equal[0]]


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
    assert lines[2].startswith("| `fine`, `a` | steps=10 | 7.0e-06 | 7.0e-06 | - |")
    assert lines[-1] == "not complete: interrupted"


def test_markdown_is_printed_where_it_is_asked_for(capsys, monkeypatch):
    benchmark = Benchmark(rows=(row("fine / a", error=1e-4, time=1.0),), orders={}, complete=True)
    monkeypatch.setattr(cli_bench, "bench", lambda *_, **__: benchmark)
    assert main(["bench", "--markdown"]) == 0
    assert capsys.readouterr().out.startswith("| law, integrator | resolution |")
    assert main(["bench"]) == 0
    plain = capsys.readouterr().out
    assert plain.startswith("method")
    assert "|" not in plain


def test_two_forms_of_one_table_are_refused(capsys):
    assert main(["bench", "--json", "--markdown"]) == 2
    assert "leave out one" in capsys.readouterr().err


def test_budget_ends_it_and_says_so(capsys):
    assert main(["bench", "--quick", "--tangential", "coulomb", "--time-limit", "1e-6"]) == 0
    assert "not complete" in capsys.readouterr().out


@pytest.mark.slow
def test_command_writes_table_csv_and_picture(tmp_path, capsys):
    files = [str(tmp_path / name) for name in ("b.png", "b.csv")]
    words = ["bench", "--quick", "--tangential", "coulomb", "--json", "--figure"]
    assert main([*words, files[0], "--out", files[1]]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["complete"] is True
    assert len((tmp_path / "b.csv").read_text().splitlines()) == len(content["rows"]) + 1
    assert (tmp_path / "b.png").stat().st_size > 10_000
    assert main(["bench", "--time-limit", "-1"]) == 2


@pytest.mark.parametrize("width", [6.0, *longer(9.0)])
def test_the_picture_names_every_law_beside_its_points(width):
    """Both panels have one error axis; a law of another model is grey and a single point."""
    rows = tuple(
        attrs.evolve(
            row(method=method, error=error, time=time, options=options), converges=law_converges
        )
        for method, error, time, options, law_converges in (
            ("springs / symplectic", 1e-2, 1e-4, "springs=2, steps=25", True),
            ("springs / symplectic", 1e-3, 2e-4, "springs=8, steps=32", True),
            ("springs / adaptive", 1e-3, 1e-3, "springs=10, tolerance=0.01", True),
            ("walton", 1e-1, 1e-5, "", False),
            ("mindlin_cap / symplectic", 0.3, 1e-4, "steps=25", False),
            ("mindlin_cap / symplectic", 0.3, 1e-3, "steps=400", False),
        )
    )
    figure = Figure(figsize=(width, 3.0))
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    draw(np.array([[left, right]]), Benchmark(rows=rows, orders={}, complete=True))
    for axes in (left, right):
        assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
        words = [text.get_text() for text in axes.texts]
        assert {"springs", "walton", "mindlin cap", "2", "8"} <= set(words)
        assert "10" not in words  # under its usual integrator alone
        points = {tuple(line.get_xdata()) for line in axes.lines}
        assert (100.0, 200.0) in {tuple(np.round(each, 6)) for each in points}
        assert not any(1000.0 in each for each in points)
    assert left.get_ylim() == right.get_ylim()
    names = {text.get_text(): text.get_color() for text in left.texts}
    assert names["springs"] != names["walton"] == names["mindlin cap"]


@pytest.mark.slow
def test_names_do_not_lie_on_each_other():
    rows = tuple(
        row(method=f"law{number}", error=1e-6 * (1.0 + 0.01 * number), time=1e-4)
        for number in range(6)
    )
    figure = Figure(figsize=(9.0, 4.0))
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, 2)
    draw(panels, Benchmark(rows=rows, orders={}, complete=True))
    names = [text for text in panels[0].texts if text.get_text().startswith("law")]
    boxes = [text.get_window_extent() for text in names]
    assert len(names) == 6
    assert not any(a.overlaps(b) for a, b in itertools.combinations(boxes, 2))


def test_the_function_of_the_table_is_measured_too():
    found = bench([], quick=True, with_rebound=True)
    (only,) = found.rows
    assert only.method == work_precision.REBOUND
    assert found.complete
    assert 0.0 < only.error_rms < 1e-9
    assert min(only.sweep_time_s, only.time_s) > 0.0
    assert only.elsewhere_rms < 1e-9


def test_errors_are_of_the_runs_that_are_timed():
    """The exact law follows a history, and answers from its table where none is asked for."""
    row = next(row for row in bench(methods(["tangential.fronts"]), quick=True).rows)
    answers = composition.exact(1e-12)
    errors = [
        float(Simulation().run(scene).psi2 - Simulation(**answers).run(scene).psi2)
        for scene in scenes(quick=True)
    ]
    assert row.error_rms == pytest.approx(np.sqrt(np.mean(np.square(errors))), rel=1e-3)
    assert 1e-13 < row.error_rms < 1e-10
    assert row.force_error_rms < 1e-6
    assert np.isnan(row.books_worst)  # closed by construction, not checked


def test_scenes_lie_where_solid_spheres_do_and_others_are_named_apart():
    for scene in scenes():
        assert 1.16 < scene.chi < 1.76
    for scene in scenes(elsewhere=True):
        assert not 1.17 <= scene.chi <= 1.75
        assert abs(scene.psi1) < max(1.0, 4.0 * scene.chi - 1.0)


def test_scenes_for_laws_with_options_in_si_have_the_same_psi1_and_chi():
    for sized, plain in zip(scenes(sized=True), scenes(), strict=True):
        assert sized.pair.normal_mass < 0.1  # kg, not the unit of the paper's scenes
        assert sized.psi1 == pytest.approx(plain.psi1, rel=1e-12)
        assert sized.chi == pytest.approx(plain.chi, rel=1e-12)
    assert all(scene.pair.normal_mass == 1.0 for scene in scenes()[:-1])
