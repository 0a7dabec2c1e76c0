"""`contactlab bench`: errors, orders, gaps, the front."""

import itertools
import json
import shutil
from importlib.util import find_spec
from types import SimpleNamespace

import attrs
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab import Simulation, rebound
from contactlab.cli import bench as cli_bench
from contactlab.cli.bench import markdown
from contactlab.cli.main import main
from contactlab.figures.work_precision import work_precision as draw
from contactlab.registry import composition
from contactlab.study import work_precision
from contactlab.study.bench_methods import methods, scenes
from contactlab.study.benchmark import Benchmark, Row
from contactlab.study.doors import limits
from contactlab.study.questions import questions
from contactlab.study.work_precision import bench
from tests.longer import longer
from tests.present import extra


def row(method="a", error=1.0, time=1.0, failed=0, options="steps=10", **entries):
    return Row(
        method=method, options=options, error_rms=error, error_worst=error, books_worst=0.0,
        time_s=time, failed=failed, status="SUCCESS" if not failed else "NON_FINITE",
        **({"sweep_time_s": time} | entries),
    )  # fmt: skip


def asked(*laws, only="sphere"):
    return questions(list(laws), only)


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
    laws = ("tangential.springs", "integrator.symplectic")
    found = bench(asked(*laws), quick=True, progress=lambda *count: seen.append(count))
    assert seen == [(1, 1)]
    errors = [entry.error_rms for entry in found.rows]
    assert errors[0] > 10 * errors[-1] > 0
    assert found.orders["springs / symplectic"] == pytest.approx(2.0, abs=0.4)
    assert all(entry.time_s > 0 for entry in found.rows)
    assert all(entry.sweep_time_s < entry.time_s for entry in found.rows)


def test_a_limit_takes_no_longer_than_a_tick_of_the_clock(monkeypatch):
    """The clock ticks once a reading; a limit may answer nothing."""
    clock = SimpleNamespace(process_time=itertools.count(0.0, 1e-3).__next__)
    monkeypatch.setattr(work_precision, "time", clock)
    (question,) = asked("tangential.coulomb")
    posed = attrs.evolve(question.pose(True), doors=limits(formula=True))
    found = bench([attrs.evolve(question, pose=lambda _: posed)], quick=True)
    assert [entry.limit for entry in found.rows] == [True, True]
    assert all(0.0 < entry.time_s <= 1.1e-3 for entry in found.rows)


@pytest.mark.slow
def test_annuli_grow_as_the_tolerance_falls():
    found = bench(asked("tangential.annulus", "integrator.adaptive"), quick=True)
    errors = {entry.options.partition("tolerance=")[2]: entry.error_rms for entry in found.rows}
    assert errors["0.001"] < errors["0.01"] / 2.0 < errors["0.1"] / 4.0


def test_front_holds_what_nothing_beats():
    rows = (row(error=1.0, time=1.0), row(error=0.5, time=2.0), row(error=0.7, time=3.0))
    failed = row(error=np.nan, time=np.nan, failed=1)
    benchmark = Benchmark(rows=(*rows, failed), orders={}, complete=True)
    assert benchmark.front("sphere") == [rows[0], rows[1]]
    told = cli_bench._report(benchmark).splitlines()
    assert told[0] == "sphere"
    assert ["front alone" in line for line in told[3:6]] == [True, True, False]


def test_fronts_are_of_one_question_and_of_one_time_without_limits():
    rows = (
        row(error=0.1, time=1.0, sweep_time_s=0.9), row(error=0.2, time=2.0, sweep_time_s=0.5),
        row(error=0.01, time=0.1, question="other"), row(error=1e-3, time=1e-3, limit=True),
    )  # fmt: skip
    benchmark = Benchmark(rows=rows, orders={}, complete=True)
    assert benchmark.front("sphere", "alone") == [rows[0]]
    assert benchmark.front("sphere", "of many") == [rows[1], rows[0]]
    assert benchmark.front("other") == [rows[2]]


def test_below_rounding_only_time_counts():
    rows = tuple(row(error=error, time=time) for error, time in ((3e-14, 1.0), (1e-16, 2.0)))
    assert Benchmark(rows=rows, orders={}, complete=True).front("sphere") == [rows[0]]
    equal = tuple(row(error=0.5, time=time) for time in (1.0, 2.0))
    assert Benchmark(rows=equal, orders={}, complete=True).front("sphere") == [equal[0]]


def test_failed_and_slow_resolutions_are_gaps_never_dropped(monkeypatch):
    monkeypatch.setattr(work_precision, "SLOW_QUICK", 0.0)
    found = bench(asked("tangential.springs", "integrator.symplectic"), quick=True)
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
    assert lines[2].startswith("| sphere | `fine`, `a` | steps=10 | 7.0e-06 | 7.0e-06 | 0.0e+00 |")
    assert lines[-1] == "not complete: interrupted"


def test_markdown_is_printed_where_it_is_asked_for(capsys, monkeypatch):
    benchmark = Benchmark(rows=(row("fine / a", error=1e-4, time=1.0),), orders={}, complete=True)
    monkeypatch.setattr(cli_bench, "bench", lambda *_, **__: benchmark)
    assert main(["bench", "--markdown"]) == 0
    assert capsys.readouterr().out.startswith("| question | law, integrator |")
    assert main(["bench"]) == 0
    plain = capsys.readouterr().out
    assert plain.startswith("sphere\nmethod")
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


def test_the_picture_has_a_panel_for_each_question_and_a_legend():
    """Full marks of one impact alone, hollow ones of each of many, by error and time in µs."""
    rows = (
        row(method="springs / symplectic", error=1e-2, time=1e-4, sweep_time_s=1e-6),
        row(method="springs / symplectic", error=1e-3, time=2e-4, sweep_time_s=2e-6),
        row(method="limit: a copy", error=np.nan, time=1e-7, limit=True),
        row(method="coulomb", error=1e-12, time=1e-3, question="plane with e"),
    )
    figure = Figure(figsize=(9.0, 3.0))
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, 3)
    draw(panels, Benchmark(rows=rows, orders={}, complete=True))
    first, second, spare = panels
    assert [axes.get_title(loc="left") for axes in panels] == ["sphere", "plane with e", ""]
    for axes in (first, second):
        assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")

    def marks(axes, *, full):
        return {
            (round(float(line.get_xdata()[0]), 6), float(line.get_ydata()[0]))
            for line in axes.lines
            if line.get_marker() == "o" and (line.get_markerfacecolor() != "white") is full
        }

    assert marks(first, full=True) == {(100.0, 1e-2), (200.0, 1e-3)}
    assert marks(first, full=False) == {(1.0, 1e-2), (2.0, 1e-3)}
    assert marks(second, full=True) == {(1000.0, 1e-8)}  # smaller errors stand at the floor
    words = [text.get_text() for text in spare.get_legend().get_texts()]
    assert {"springs", "other laws", "one alone", "each of many"} <= set(words)
    assert "annuli" not in words


def numbers(name, *, quick=True):
    """Doors of a question, the numbers that each answers."""
    (question,) = questions(only=name)
    posed = question.pose(quick)
    return posed, {
        f"{door.name} {door.options}".strip(): np.concatenate(
            [door.read(door.bind(each)()).numbers for each in posed.impacts]
        )
        for door in posed.doors
        if door.read
    }


@pytest.mark.parametrize(
    ("name", "door", "error"),
    [
        ("plane with e", "collide()", 2e-3),
        ("turning slip", "run()", 2e-3),
        ("ellipse", "collide()", 2e-3),
        *longer(
            ("plane", "collide()", 1e-9),
            ("sphere with e", "rebound()", 5e-5),
            ("spin about the normal", "halfspace rings=16", 1e-2),
            ("two contacts", "collide()", 1e-3),
        ),
    ],
)
def test_doors_of_a_question_agree_with_its_truth(name, door, error):
    posed, answers = numbers(name)
    truth = np.concatenate(posed.truths)
    assert np.abs(answers[door] - truth).max() < error
    assert np.ptp(truth) > 1e-3 or len(truth) == 1
    for other, answer in answers.items():
        if "springs=100" in other:
            assert np.abs(answer - truth).max() < 1e-3


@pytest.mark.slow
@extra("contactlab_halfspace")
def test_spin_about_the_normal_is_no_question_of_a_door_without_it():
    posed, answers = numbers("spin about the normal")
    assert abs(answers["collide(), without"] - posed.truths[0])[0] > 0.1


def test_every_question_has_its_name_once_and_one_is_found_by_it():
    names = [each.name for each in questions()]
    spins = find_spec("contactlab_halfspace") is not None
    assert len(set(names)) == len(names) == 9 + spins
    assert ("spin about the normal" in names) is spins
    with pytest.raises(
        ValueError, match=r"question = 'plain': must be one of 'sphere', .*'course'"
    ):
        questions(only="plain")


def test_a_restitution_stands_in_place_of_a_normal_law(capsys):
    """Without laws the questions of impacts with loss, each at that restitution."""
    asked = questions(restitution=0.5)
    assert [each.name.partition(" with e")[1] for each in asked] == [" with e"] * 4
    posed = asked[0].pose(True)
    truth = np.concatenate(posed.truths)
    assert truth == pytest.approx(
        [rebound(float(each.psi1), float(each.chi), restitution=0.5) for each in posed.impacts],
        abs=5e-5,
    )
    words = ["bench", "--quick", "--tangential", "coulomb", "--restitution"]
    assert main([*words, "0.6"]) == 0
    assert "coulomb, viscoelastic e=0.6" in capsys.readouterr().out
    for value, rule in (("1.6", "from 0 to 1"), ("0.001", "at least 0.01")):
        assert main(["bench", "--restitution", value]) == 2
        assert rule in capsys.readouterr().err
    assert main([*words, "0.6", "--normal", "hertz"]) == 2
    assert "stands in place of a normal law, and hertz is named" in capsys.readouterr().err


def test_kernels_in_c_answer_where_a_compiler_is():
    known = any(map(shutil.which, ("cc", "gcc", "clang")))
    posed, answers = numbers("sphere with e")
    assert ("C, contactlab_bounce.h" in answers) is known
    if known:
        off = answers["C, contactlab_bounce.h"] - np.concatenate(posed.truths)
        assert np.abs(off).max() < 1e-4


def test_times_are_of_the_processor(monkeypatch):
    """Short calls are made often enough for the clock, and long ones once."""
    calls = []
    clock = SimpleNamespace(process_time=lambda: 1e-5 * len(calls))
    monkeypatch.setattr(work_precision, "time", clock)
    assert work_precision.least_time(lambda: calls.append(0), 1.0) == pytest.approx(1e-5)
    assert len(calls) > 100
    calls.clear()
    assert work_precision.least_time(lambda: calls.append(0), 1e-9) == pytest.approx(1e-5)
    assert len(calls) == 1


def test_a_resolution_that_changes_no_answer_is_no_row():
    found = bench(asked("tangential.fronts"), quick=True)
    assert len(found.rows) == 1


def test_the_force_of_a_course_is_measured_at_every_instant():
    found = bench(asked("tangential.fronts", only="course"), quick=True)
    assert max(entry.error_rms for entry in found.rows) < 1e-6
    (rigid,) = bench(asked("tangential.coulomb", only="course"), quick=True).rows
    assert rigid.error_worst > 0.5


def test_errors_are_of_the_runs_that_are_timed():
    """The exact law follows a history, and answers from its table where none is asked for."""
    row = next(row for row in bench(asked("tangential.fronts"), quick=True).rows)
    answers = composition.exact(1e-12)
    errors = [
        float(Simulation().run(scene).psi2 - Simulation(**answers).run(scene).psi2)
        for scene in scenes(quick=True)
    ]
    assert row.error_rms == pytest.approx(np.sqrt(np.mean(np.square(errors))), rel=1e-3)
    assert 1e-13 < row.error_rms < 1e-10
    assert np.isnan(row.books_worst)  # closed by construction, not checked


def test_scenes_lie_where_solid_spheres_do():
    for scene in scenes():
        assert 1.16 < scene.chi < 1.76


def test_scenes_for_laws_with_options_in_si_have_the_same_psi1_and_chi():
    for sized, plain in zip(scenes(sized=True), scenes(), strict=True):
        assert sized.pair.normal_mass < 0.1  # kg, not the unit of the paper's scenes
        assert sized.psi1 == pytest.approx(plain.psi1, rel=1e-12)
        assert sized.chi == pytest.approx(plain.chi, rel=1e-12)
    assert all(scene.pair.normal_mass == 1.0 for scene in scenes()[:-1])
