"""Error against run time: each of many impacts, and one alone, with one error axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from contactlab.figures.style import LAW_COLOURS, QUIET
from contactlab.study.benchmark import Benchmark, Row

#: Integrator that a law is drawn under: the first that ran it.
USUAL = ("symplectic", "events", "adaptive", "paper")
#: Least error drawn; smaller ones stand at it, with their size beside the name.
FLOOR = 1e-8
#: Lower edge of the band of laws whose limit is another, and its words.
BAND, BAND_WORDS = 0.05, "another model: no finer step helps"
#: Upper end of the error axis: the band has room for slanted names, from an error of
#: ``SLANTED_FROM`` on and ``SLANTED_APART`` of the width apart.
HIGHEST, SLANTED_FROM, SLANTED_APART = 1e5, 3.0, 0.055
BAND_COLOUR = "#EDEDED"
#: Least distance of two names, width of a letter, and gap between a point and its name, in points.
APART, LETTER, GAP = 12.0, 4.4, 5.0
#: Laws whose curve has the number of parts beside each point, and colours kept for some laws.
NUMBERED = "springs"
COLOURS = {
    "springs": LAW_COLOURS[1],
    "annulus": LAW_COLOURS[0],
    "halfspace": LAW_COLOURS[3],
}
EXACT_COLOUR = LAW_COLOURS[2]


class Other(NamedTuple):
    """A code that is not run here: error and times measured elsewhere, NaN if not measured.

    Attributes
    ----------
    name : str
    error_rms : float
    many_s, one_s : float
        Run time of each of many impacts, and of one alone, in s.
    """

    name: str
    error_rms: float
    many_s: float
    one_s: float


#: Guide, theory §13: 50 steps of a contact in LAMMPS (4 Feb 2025), ``mindlin/force``, at 57 ns, and
#: of 8 springs there at 84 ns. The plain code is the paper's annuli written without any table.
OTHERS = (
    Other("LAMMPS mindlin", 0.269, 50 * 57e-9, math.nan),
    Other("8 in LAMMPS", 0.006, 50 * 84e-9, math.nan),
    Other("plain NumPy", 1.8e-3, math.nan, 11.9e-3),
)
#: Sources of the hollow marks, left and right.
SOURCES = (
    "hollow squares: LAMMPS, compiled, 50 steps,\nits own spring and 8 springs (guide, theory §13)",
    "hollow square: the paper's 50 annuli,\nwritten without tables",
)


def work_precision(panels: Any, benchmark: Benchmark) -> Any:
    """Draw error over run time: each of many impacts on the left, one alone on the right.

    Parameters
    ----------
    panels : array of Axes, shape (1, 2)
    benchmark : Benchmark
    """
    left, right = np.ravel(panels)
    curves = _curves(benchmark)
    ways: tuple[tuple[Axes, str, str, str], ...] = (
        (left, "sweep_time_s", "many_s", "each of many (arrays, one core)"),
        (right, "time_s", "one_s", "one alone, with its call"),
    )
    for (axes, column, of_other, title), source in zip(ways, SOURCES, strict=True):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_title(title, loc="left", fontsize="medium")
        axes.set_xlabel("run time per impact (µs)")
        names = [_curve(axes, law, rows, column) for law, rows in curves.items()]
        names += [_other(axes, other, getattr(other, of_other)) for other in OTHERS]
        _band(axes)
        axes.set_ylim(0.2 * FLOOR, HIGHEST)
        axes.set_xlim(*_limits(axes))
        known = [name for name in names if name is not None]
        _write_above(axes, [name for name in known if name.colour == QUIET])
        _write_beside(axes, [name for name in known if name.colour != QUIET])
        axes.text(
            0.98, 0.07, source, transform=axes.transAxes, ha="right", fontsize="x-small",
            color="#555555",
        )  # fmt: skip
        axes.set_yticks([10.0**power for power in range(-8, 1, 2)])
    left.set_ylabel(r"error of $\psi_2$, rms over the scenes")
    right.sharey(left)
    right.tick_params(labelleft=False)
    return panels


def _curves(benchmark: Benchmark) -> dict[str, list[Row]]:
    """Return the rows of each law under its usual integrator."""
    methods: dict[str, list[str]] = {}
    for row in benchmark.rows:
        law, _, integrator = row.method.partition(" / ")
        methods.setdefault(law, []).append(integrator)
    curves = {}
    for law, integrators in methods.items():
        usual = next((name for name in USUAL if name in integrators), integrators[0])
        method = f"{law} / {usual}" if usual else law
        rows = [row for row in benchmark.rows if row.method == method and row.ok]
        if rows:  # of another model the quickest alone: finer steps cost and do not help
            curves[law] = rows if rows[0].converges else rows[:1]
    return curves


class Name(NamedTuple):
    """A name beside the end of a curve: words, place in the units of the axes, and colour."""

    words: str
    x: float
    y: float
    colour: str


def _curve(axes: Axes, law: str, rows: Sequence[Row], column: str) -> Name | None:
    """Draw the curve of a law; return its name, or None if no time was measured."""
    points = [
        (1e6 * getattr(row, column), max(row.error_rms, FLOOR), row)
        for row in rows
        if math.isfinite(getattr(row, column))
    ]
    if not points:
        return None
    times, errors, drawn = zip(*points, strict=True)
    colour = _colour(law, drawn[0])
    below = errors[0] <= FLOOR
    axes.plot(
        times, errors, color=colour, marker="v" if below else "o", markersize=4.0, linewidth=1.3
    )
    if law == NUMBERED:
        for time, error, row in points:
            axes.annotate(
                row.options.partition(",")[0].partition("=")[2], (time, error),
                xytext=(-5.0, 0.0), textcoords="offset points", ha="right", va="center",
                fontsize="x-small", color=colour,
            )  # fmt: skip
    last = int(np.argmax(times))
    words = law.replace("_", " ")
    if below:
        words += f", below: {drawn[last].error_rms:.0e}"
    return Name(words, times[last], errors[last], colour)


def _colour(law: str, row: Row) -> str:
    """Return the colour of a law: grey if its limit is another."""
    if not row.converges:
        return QUIET
    return COLOURS.get(law, EXACT_COLOUR)


def _other(axes: Axes, other: Other, seconds: float) -> Name | None:
    """Draw a hollow mark for a code that is not run here; return its name."""
    if not math.isfinite(seconds):
        return None
    colour = QUIET if other.error_rms > BAND else "#555555"
    look: Any = {"marker": "s", "markersize": 5.0, "markerfacecolor": "white", "linestyle": ""}
    axes.plot([1e6 * seconds], [other.error_rms], color=colour, **look)
    return Name(other.name, 1e6 * seconds, other.error_rms, colour)


def _band(axes: Axes) -> None:
    """Shade the errors of other models."""
    axes.axhspan(BAND, HIGHEST, color=BAND_COLOUR, linewidth=0.0, zorder=0)
    axes.text(
        0.01, 0.965, BAND_WORDS, transform=axes.transAxes, ha="left", va="center",
        fontsize="x-small", style="italic", color="#555555",
    )  # fmt: skip


def _limits(axes: Axes) -> tuple[float, float]:
    """Return limits of the time axis with room for the names on its right."""
    low, high = axes.get_xlim()
    return low, high * (high / low) ** 0.35


def _write_above(axes: Axes, names: Sequence[Name]) -> None:
    """Write slanted names in the upper part of the band, each with a line to its point."""
    left, right = (math.log10(limit) for limit in axes.get_xlim())
    beside = -1.0
    for name in sorted(names, key=lambda each: each.x):
        share = (math.log10(name.x) - left) / (right - left)
        beside = max(share, beside + SLANTED_APART)
        at = 10.0 ** (left + beside * (right - left))
        axes.plot([name.x, at], [name.y, SLANTED_FROM], color=QUIET, linewidth=0.5, zorder=1)
        axes.text(
            at, SLANTED_FROM, name.words, rotation=35.0, rotation_mode="anchor", ha="left",
            va="bottom", fontsize="small", color="#555555",
        )  # fmt: skip


def _write_beside(axes: Axes, names: Sequence[Name]) -> None:
    """Write the names beside their points, where they cover no curve and no other name."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    figure.canvas.draw()
    to_share = axes.transData + axes.transAxes.inverted()
    drawn = np.concatenate([_along(to_share.transform(line.get_xydata())) for line in axes.lines])
    drawn = drawn[np.isfinite(drawn).all(axis=1)]
    point = figure.dpi / 72.0
    apart, letter, gap = (
        size * point / length
        for size, length in (
            (APART, axes.bbox.height), (LETTER, axes.bbox.width), (GAP, axes.bbox.width)
        )
    )  # fmt: skip
    taken: list[tuple[float, float, float]] = []  # begin, end and height of a name
    for name in sorted(names, key=lambda each: (-each.y, each.x)):
        x, y = to_share.transform((name.x, name.y))
        width = letter * len(name.words)
        places = sorted(
            (abs(step) + (0.0 if side > 0 else 0.02), side, step)
            for side in (1, -1)
            for step in np.arange(-0.3, 0.301, 0.01)
        )
        for _, side, step in places:
            begin = x + gap if side > 0 else x - gap - width
            height = y + step
            free = begin > 0.0 and begin + width < 1.0 and 0.02 < height < 0.75
            inside = (drawn[:, 0] > begin - 0.5 * gap) & (drawn[:, 0] < begin + width)
            free = free and not (inside & (np.abs(drawn[:, 1] - height) < 0.6 * apart)).any()
            if free and all(
                begin + width < other[0] or begin > other[1] or abs(height - other[2]) >= apart
                for other in taken
            ):
                break
        taken.append((begin, begin + width, height))
        axes.text(
            begin, height, name.words, transform=axes.transAxes, color=name.colour,
            fontsize="small", va="center",
        )  # fmt: skip


def _along(corners: Any) -> Any:
    """Return points along a line, close enough that a name on it is seen to be."""
    if len(corners) < 2:
        return corners
    shares = np.linspace(0.0, 1.0, 20)[:, None, None]
    return (corners[:-1] + shares * np.diff(corners, axis=0)).reshape(-1, 2)
