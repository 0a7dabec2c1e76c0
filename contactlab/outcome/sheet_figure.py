"""Figure of a sheet: one column over another."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from contactlab.numeric.checks import refuse
from contactlab.numeric.names import nearest
from contactlab.numeric.types import AnyArray, Array
from contactlab.outcome.history_figure import on_axes
from contactlab.outcome.sheet import Sheet
from contactlab.outcome.style import Width, curve_colour, label

#: Curves above which they share one colour and no legend tells them apart.
MOST_CURVES = 6


def draw_sheet(
    axes: Axes | None,
    sheet: Sheet,
    x: str | None = None,
    y: str | None = None,
    *,
    width: Width | None = None,
    course: bool = False,
) -> Axes:
    """Draw column ``y`` over column ``x``, with a curve for each place of the axes but the first.

    Parameters
    ----------
    axes : Axes or None
        None makes a new figure of ``matplotlib.pyplot``.
    sheet : Sheet
    x, y : str or None
        Columns or axes; the first axis, and the first column that is not ``x``, by default.
    width : {"one", "two"}, optional
        Columns of a page that a new figure fills.
    course : bool
        Whether curves go along the first axis; else along ``x``.

    Raises
    ------
    ValueError
        If there is no such column, or it holds no numbers.
    """
    numbers = _numbers(sheet)
    x = _find_column("x", x or next(iter(sheet.axes), None) or next(iter(numbers)), numbers)
    y = _find_column("y", y or next(name for name in numbers if name != x), numbers)
    refuse_itself(x, y)
    rows = sheet.shape[0] if sheet.shape else 1
    across, up = (numbers[name].reshape(rows, -1) for name in (x, y))
    names = [*np.ndindex(*sheet.shape[1:])]
    with on_axes(axes, width) as drawn:
        for k, place in enumerate(names):
            order = np.arange(rows) if course else np.argsort(across[:, k], kind="stable")
            curve = course or np.unique(across[:, k]).size == rows > 1
            curves = drawn.plot(
                across[order, k],
                up[order, k],
                color=curve_colour(k if len(names) <= MOST_CURVES else 0),
                marker="" if curve else ".",
                linestyle="-" if curve else "none",
            )
            curves[0].set_label(_tell_place(sheet, place))
        for name, put in ((x, drawn.set_xlabel), (y, drawn.set_ylabel)):
            put(label(name, sheet.units.get(name, "") or "1"))
        if 1 < len(names) <= MOST_CURVES:
            drawn.legend()
    return drawn


def _numbers(sheet: Sheet) -> dict[str, Array]:
    """Return axes and columns that hold numbers, each of the sheet's shape."""
    found: dict[str, AnyArray] = {}
    for place, (name, values) in enumerate(sheet.axes.items()):
        words = values is None or np.asarray(values).dtype.kind == "U"
        counted = np.arange(sheet.shape[place]) if words else np.asarray(values)
        after = len(sheet.shape) - place - 1
        found[name] = counted.reshape(-1, *(1,) * after)
    found |= {name: np.asarray(values) for name, values in sheet.columns.items()}
    return {
        name: np.broadcast_to(values, sheet.shape).astype(float)
        for name, values in found.items()
        if values.dtype.kind in "fiub"
    }


def refuse_itself(x: str, y: str) -> None:
    """Refuse a column over itself; a single name that is given is that of ``x``."""
    if x == y:
        raise refuse("x, y", x, "is drawn over itself", f"write y={x!r} alone, or another x")


def _find_column(argument: str, name: str, numbers: dict[str, Array]) -> str:
    """Return the name of a column that holds numbers, or refuse it."""
    if name not in numbers:
        remedy = f"{nearest(name, numbers)}known: {', '.join(numbers)}"
        raise refuse(argument, name, "is not a column of numbers", remedy)
    return name


def _tell_place(sheet: Sheet, place: tuple[int, ...]) -> str:
    """Return the place of a curve on the axes but the first."""
    parts = []
    for (name, values), index in zip([*sheet.axes.items()][1:], place, strict=True):
        value = index if values is None else values[index]
        parts.append(str(value) if isinstance(value, str) else f"{name} {value:.4g}")
    return ", ".join(parts)
