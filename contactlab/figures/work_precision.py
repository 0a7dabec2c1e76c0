"""Error against processor time: a panel for each question, the fronts of its doors."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactlab.figures.files import Panels
from contactlab.outcome.style import LAW_COLOURS, QUIET
from contactlab.study.benchmark import TIMES, Benchmark, Row

#: Panels in a row, and their height over that of a figure with one panel.
COLUMNS, HEIGHT = 4, 0.65
#: Least error drawn; smaller ones stand at it.
FLOOR = 1e-8
#: Limits of both axes: the error, and the time in µs.
ERRORS, MICROSECONDS = (3e-9, 3.0), (1e-2, 3e5)
#: Doors of one colour, by what their name has, the first that fits.
FAMILIES = {
    "limit": "#000000",
    "C,": LAW_COLOURS[4],
    "rebound": LAW_COLOURS[2],
    "collide()": LAW_COLOURS[3],
    "run()": LAW_COLOURS[5],
    "fronts": LAW_COLOURS[5],
    "springs": LAW_COLOURS[1],
    "annulus": LAW_COLOURS[0],
}
#: Their names in the legend.
WORDS = {
    "limit": "a copy, a formula: limits", "C,": "C kernel", "rebound": "rebound()",
    "collide()": "collide()", "run()": "run(), default", "springs": "springs",
    "annulus": "annuli",
}  # fmt: skip
OTHER = "other laws"
GREY_WORDS = "#555555"


def work_precision(panels: Axes | Panels, benchmark: Benchmark) -> Axes | Panels:
    """Draw error over processor time, each question in its panel.

    Full marks are of one impact alone, hollow ones of each of many; lines join a front.

    Parameters
    ----------
    panels : Axes, or array of Axes
        At least as many as questions; those left over hold the legend, or nothing.
    benchmark : Benchmark
    """
    every: list[Axes] = list(np.ravel(np.asarray(panels, dtype=object)))
    by_question = {
        question: [row for row in rows if not row.peer]  # another model's difference is no error
        for question, rows in benchmark.by_question().items()
    }
    wide = every[0].get_subplotspec()
    columns = wide.get_gridspec().ncols if wide is not None else 1
    for place, (axes, (question, rows)) in enumerate(zip(every, by_question.items(), strict=False)):
        _draw(axes, benchmark, question, rows)
        if place % columns:
            axes.tick_params(labelleft=False)
        else:
            axes.set_ylabel("error, rms")
        if place + columns >= len(by_question):
            axes.set_xlabel("time per impact (µs)")
            axes.tick_params(labelbottom=True)
        else:
            axes.tick_params(labelbottom=False)
    spare = every[len(by_question) :]
    for axes in spare:
        axes.set_axis_off()
    _legend(
        spare[0] if spare else every[0],
        [each for rows in by_question.values() for each in rows],
        outside=bool(spare),
    )
    return panels


def _draw(axes: Axes, benchmark: Benchmark, question: str, rows: Sequence[Row]) -> None:
    """Draw the doors of one question."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(*MICROSECONDS)
    axes.set_ylim(*ERRORS)
    axes.set_xticks([1e-2, 1.0, 1e2, 1e4])
    axes.set_yticks([1e-8, 1e-6, 1e-4, 1e-2, 1.0])
    axes.minorticks_off()
    axes.set_title(question, loc="left", fontsize="medium")
    axes.tick_params(labelsize="small")
    for word, column in TIMES.items():
        front = benchmark.front(question, word)
        alone = word == "alone"
        dashes = "-" if alone else "--"
        axes.plot(*_points(front, column), zorder=1, color=QUIET, linewidth=1.0, linestyle=dashes)
        for row in rows:
            _mark(axes, row, column, full=alone, fronts=row in front)


def _mark(axes: Axes, row: Row, column: str, *, full: bool, fronts: bool) -> None:
    """Draw one door, small and pale where it is on no front; a limit without error as a line."""
    time, colour = 1e6 * getattr(row, column), FAMILIES.get(_family(row), QUIET)
    if not (row.ok and math.isfinite(time)):
        return
    if not math.isfinite(row.error_rms):
        axes.axvline(time, color=colour, linewidth=0.7, linestyle="-" if full else "--", zorder=0)
        return
    size, alpha = (4.5, 1.0) if fronts or row.limit else (2.5, 0.5)
    axes.plot(
        [time], [max(row.error_rms, FLOOR)], markersize=size, alpha=alpha,
        markerfacecolor=colour if full else "white", marker="x" if row.limit else "o",
        linestyle="", color=colour,
    )  # fmt: skip


def _points(rows: Sequence[Row], column: str) -> tuple[list[float], list[float]]:
    """Return times in µs and errors of rows."""
    return (
        [1e6 * getattr(row, column) for row in rows],
        [max(row.error_rms, FLOOR) for row in rows],
    )


def _family(row: Row) -> str:
    """Return the key of ``FAMILIES`` that a row belongs to; empty for other laws."""
    return next((key for key in FAMILIES if key in row.method), "")


def _legend(axes: Axes, rows: Sequence[Row], *, outside: bool) -> None:
    """Name the colours that were drawn, and the two kinds of mark."""
    drawn = {FAMILIES.get(_family(row), QUIET) for row in rows if row.ok}
    dots = [(FAMILIES[key], words) for key, words in WORDS.items() if FAMILIES[key] in drawn]
    if QUIET in drawn:
        dots.append((QUIET, OTHER))
    marks = [
        Line2D([], [], color=colour, label=words, marker="o", linestyle="", markersize=4.5)
        for colour, words in dots
    ]
    kinds = (("one alone", "-", GREY_WORDS), ("each of many", "--", "white"))
    for words, dashes, inside in kinds:
        line = Line2D([], [], color=GREY_WORDS, label=words, marker="o", markersize=4.5)
        line.set(linestyle=dashes, linewidth=1.0, markerfacecolor=inside)
        marks.append(line)
    place = {"loc": "upper left", "bbox_to_anchor": (0.0, 1.0)} if outside else {"loc": "best"}
    axes.legend(handles=marks, fontsize="small", handlelength=1.6, labelspacing=0.35, **place)
