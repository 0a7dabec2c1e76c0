"""Error against run time: each of many impacts, and one alone, with one error axis."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from contactlab.figures.files import Panels
from contactlab.numeric.types import Array
from contactlab.outcome.style import LAW_COLOURS, QUIET
from contactlab.study.benchmark import Benchmark, Row

#: Integrator that a law is drawn under: the first that ran it.
USUAL = ("symplectic", "events", "adaptive", "paper")
#: Least error drawn; smaller ones stand at it, with their size beside the name.
FLOOR = 1e-6
#: Lower edge of the band of laws whose limit is another, and its words.
BAND, BAND_WORDS = 0.05, "another model: no finer step helps"
#: Upper end of the error axis: the band has room for the names of its points.
HIGHEST = 10.0
BAND_COLOUR, GREY_WORDS = "#EDEDED", "#555555"
#: Least distance of two names, width of a letter, and gap between a point and its name, in points.
APART, LETTER, GAP = 12.0, 4.6, 5.0
#: Distance from its point, over the height, from which on a line leads to a name.
LED = 0.045
#: Shifts of a name to the side and upwards that are tried, over width and height of the axes.
ASIDES, STEPS = (0.0, 0.06, 0.12, 0.2), tuple(np.arange(-0.4, 0.401, 0.01).tolist())
#: Price of a name that covers a curve or a name, and of a line that crosses a name or a point.
COVERS, CROSSES = 10.0, 1.0
#: Least and greatest height of a name, over that of the axes.
LOWEST_NAME, HIGHEST_NAME = 0.03, 0.97
#: Laws whose curve has the number of parts beside each point, and colours kept for some laws.
NUMBERED = "springs"
COLOURS = {
    "springs": LAW_COLOURS[1],
    "annulus": LAW_COLOURS[0],
    "halfspace": LAW_COLOURS[3],
}
EXACT_COLOUR = LAW_COLOURS[2]


#: Begin and end, low and high, over width and height of the axes.
Box = tuple[float, float, float, float]


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


def work_precision(panels: Panels, benchmark: Benchmark) -> Panels:
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
        axes.set_ylim(0.1 * FLOOR, HIGHEST)
        axes.set_xlim(*_limits(axes))
        axes.text(
            0.98, 0.03, source, transform=axes.transAxes, ha="right", fontsize="x-small",
            color=GREY_WORDS,
        )  # fmt: skip
        axes.set_yticks([10.0**power for power in range(-6, 1)])
        _write_beside(axes, [name for name in names if name is not None])
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
        words += f", exact to {drawn[last].error_rms:.0e}"
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
    colour = QUIET if other.error_rms > BAND else GREY_WORDS
    look: Any = {"marker": "s", "markersize": 5.0, "markerfacecolor": "white", "linestyle": ""}
    axes.plot([1e6 * seconds], [other.error_rms], color=colour, **look)
    return Name(other.name, 1e6 * seconds, other.error_rms, colour)


def _band(axes: Axes) -> None:
    """Shade the errors of other models."""
    axes.axhspan(BAND, HIGHEST, color=BAND_COLOUR, linewidth=0.0, zorder=0)
    axes.text(
        0.01, 0.965, BAND_WORDS, transform=axes.transAxes, ha="left", va="center",
        fontsize="x-small", style="italic", color=GREY_WORDS,
    )  # fmt: skip


def _limits(axes: Axes) -> tuple[float, float]:
    """Return limits of the time axis with room for the names on its right."""
    low, high = axes.get_xlim()
    return low, high * (high / low) ** 0.35


def _write_beside(axes: Axes, names: Sequence[Name]) -> None:
    """Write the names beside their points, where they cover no curve and no other name."""
    figure = axes.figure.figure  # of a subfigure too, in matplotlib of any age
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
    band = to_share.transform((1.0, BAND))[1]
    taken: list[Box] = []
    for text in axes.texts:
        (begin, low), (end, high) = axes.transAxes.inverted().transform(text.get_window_extent())
        taken.append((begin, end, low, high))
    for name in sorted(names, key=lambda each: (-each.y, each.x)):
        point_at = np.array(to_share.transform((name.x, name.y)))
        others = drawn[np.abs(drawn - point_at).max(axis=1) > 0.1 * gap]
        width = letter * len(name.words)
        lowest = band + 0.4 * apart if name.colour == QUIET else LOWEST_NAME
        best, chosen = math.inf, None
        for side, aside, step in itertools.product((1, -1), ASIDES, STEPS):
            begin = point_at[0] + (gap + aside if side > 0 else -gap - aside - width)
            height = point_at[1] + step
            box = begin, begin + width, height - 0.5 * apart, height + 0.5 * apart
            near = (begin - 0.2 * gap if side > 0 else begin + width + 0.2 * gap), height
            led = abs(step) > LED or aside > 0.0
            leader = np.linspace(point_at, near, 20 if led else 1)
            if not (begin > 0.0 and begin + width < 1.0 and lowest < height < HIGHEST_NAME):
                continue
            covered = _inside(drawn, (begin - 0.5 * gap, *box[1:])) + sum(
                max(min(box[1], other[1]) - max(box[0], other[0]), 0.0) > 0.0
                and max(min(box[3], other[3]) - max(box[2], other[2]), 0.0) > 0.0
                for other in taken
            )
            crossed = sum(_inside(leader, other) for other in taken)
            crossed += led and _meets(leader, others, 0.6 * gap)
            cost = COVERS * covered + CROSSES * crossed + abs(step) + aside + 0.02 * (side < 0)
            if cost < best:
                best, chosen = cost, (box, leader if led else None)
        assert chosen is not None
        box, line = chosen
        taken.append(box)
        if line is not None:
            axes.plot(*line.T, color=name.colour, linewidth=0.5, transform=axes.transAxes, zorder=1)
        axes.text(
            box[0], 0.5 * (box[2] + box[3]), name.words, transform=axes.transAxes,
            fontsize="small", va="center",
            color=GREY_WORDS if name.colour == QUIET else name.colour,
        )  # fmt: skip


def _meets(points: Array, others: Array, near: float) -> bool:
    """Return whether one of the points, shape (n, 2), is near one of the others."""
    return bool((np.abs(points[:, None] - others).max(axis=2) < near).any())


def _inside(points: Array, box: Box) -> bool:
    """Return whether one of the points, shape (n, 2), lies in a box."""
    across, up = points.T
    inside = (across > box[0]) & (across < box[1]) & (up > box[2]) & (up < box[3])
    return bool(inside.any())


def _along(corners: Array) -> Array:
    """Return points along a line, close enough that a name on it is seen to be."""
    if len(corners) < 2:
        return corners
    shares = np.linspace(0.0, 1.0, 20)[:, None, None]
    return (corners[:-1] + shares * np.diff(corners, axis=0)).reshape(-1, 2)
