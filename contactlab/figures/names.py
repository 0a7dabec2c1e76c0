"""Names beside curves, in place of a legend."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import BboxBase
from numpy.typing import NDArray

from contactlab.numeric.types import Array

#: Places along a curve beside which its name may stand, and most points that stand for a curve.
PLACES, POINTS = 48, 1500
#: Boxes that are compared with all points of a curve at once: what a processor's cache holds.
BOXES = 32
#: Distances in points: least between two names, least between a name and any curve, and those
#: that are tried between a name and its own curve.
BETWEEN, LEAST, GAPS = 2.5, 1.5, (2.5, 5.0, 9.0)
#: Distances at which a thin line leads from the name to its curve, where there is room only there.
LED = (12.0, 18.0, 26.0, 38.0, 54.0, 72.0)
#: Shifts to the side of such a name that are tried, in widths of the name.
SHIFTS = (-1.2, -0.8, -0.4, 0.0, 0.4, 0.8, 1.2)
#: Least distance in points from other curves where such a line begins, and the length that it may
#: be longer to cross one curve less.
APART, CROSSED = 2.5, 25.0
#: A name is nearer to its own curve than to any other by this factor.
NEARER = 1.35


def name_curves(
    axes: Axes,
    lines: Sequence[Line2D],
    names: Sequence[str],
    *,
    alike: Sequence[Sequence[Line2D]] = (),
) -> bool:
    """Write each name beside its curve in the colour of the curve; return False if one has no room.

    A name touches no curve and no other text, and is nearest to its own curve. Where one name
    finds no such place, none is written: a legend is left to the caller. Labels, limits and all
    other text should be there before.

    Parameters
    ----------
    axes : Axes
    lines : sequence of Line2D
        Curves of the axes to be named.
    names : sequence of str
        A name for each curve.
    alike : sequence of sequences of Line2D
        Groups of curves that share a name: a name may be as near to another of its group.
    """
    figure = axes.figure.figure  # of a subfigure too, in matplotlib of any age
    # limits and layout come first
    if (layout := figure.get_layout_engine()) is not None:
        layout.execute(figure)
    else:
        figure.draw_without_rendering()
    unit = figure.dpi / 72.0
    curved = [line for line in axes.lines if len(np.atleast_1d(line.get_xdata())) > 2]
    dots = {line: _dots(line, unit) for line in curved}
    rules = [_dots(line, unit) for line in axes.lines if line not in dots]
    taken = [_box(text.get_window_extent()) for text in axes.texts if text.get_text()]
    if (legend := axes.get_legend()) is not None:
        taken.append(_box(legend.get_window_extent()))
    frame = _box(axes.get_window_extent())
    texts: list[_Name] = []
    for line, name in zip(lines, names, strict=True):
        text = axes.text(0.0, 0.0, name, color=line.get_color(), fontsize="small", zorder=6)
        text.set_in_layout(False)
        box = text.get_window_extent()
        group = next((group for group in alike if line in group), (line,))
        texts.append(_Name(line, text, np.array([box.width, box.height]), group))
    # Curves that lie among others find fewer places, and choose first; so does, in the next try,
    # a name that found none.
    order = sorted(texts, key=lambda name: -_crowd(dots, name.line))
    for _ in texts:
        without = _write(axes, order, dots, rules, taken, frame, unit)
        if without is None:
            return True
        order.sort(key=lambda name: name is not without)
    for one in texts:
        one.text.remove()
    return False


class _Name(NamedTuple):
    """A name to be written: its curve, its text, its width and height, and curves that share it."""

    line: Line2D
    text: Text
    size: Array
    group: Sequence[Line2D]


def _write(
    axes: Axes,
    order: Sequence[_Name],
    dots: dict[Line2D, Array],
    rules: Sequence[Array],
    taken: Sequence[Array],
    frame: Array,
    unit: float,
) -> _Name | None:
    """Write names in an order; return the first that has no room, with nothing written, or None."""
    straight, boxes = list(rules), list(taken)
    leaders: list[Line2D] = []
    for name in order:
        others = [points for other, points in dots.items() if other not in name.group]
        curves = [*dots.values(), *straight]
        room = _Room(dots[name.line], others, curves, boxes, frame, name.size, unit)
        found = room.beside() or room.lead()
        if found is None:
            for leader in leaders:
                leader.remove()
            return name
        place, start = found
        if start is not None:
            end = place - [0.0, np.sign((place - start)[1]) * 0.5 * name.size[1]]
            points = axes.transData.inverted().transform([start, end])
            straight.append(np.linspace(start, place, 40))
            x, y = points.T
            colour = name.line.get_color()
            leaders += axes.plot(x, y, scalex=False, scaley=False, color=colour, linewidth=0.6)
        low = place - 0.5 * name.size
        boxes.append(np.array([low, low + name.size]))
        name.text.set_position(tuple(axes.transData.inverted().transform(place)))
        name.text.set(ha="center", va="center")
    return None


def _dots(line: Line2D, unit: float) -> Array:
    """Return points along a line, ``unit`` dots apart if that is not too many, shape (n, 2)."""
    xy = np.asarray(line.get_transform().transform(line.get_xydata()), dtype=np.float64)
    xy = xy[np.isfinite(xy).all(axis=1)]
    if len(xy) < 2:
        return xy
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(xy, axis=0).T))))
    count = int(min(max(along[-1] / unit, PLACES), POINTS))
    fine = np.linspace(0.0, along[-1], count)
    return np.column_stack([np.interp(fine, along, column) for column in xy.T])


def _places(points: Array) -> Array:
    """Return ``PLACES`` points of a curve or some more, evenly spaced."""
    return points[:: max(len(points) // PLACES, 1)]


def _box(extent: BboxBase) -> Array:
    """Return lower left and upper right corner of an extent, shape (2, 2)."""
    return np.array([extent.min, extent.max])


def _crowd(dots: dict[Line2D, Array], line: Line2D) -> float:
    """Return how near the other curves are: minus the greatest distance to the nearest."""
    places = _places(dots[line])
    others = [points for other, points in dots.items() if other is not line]
    if not others:
        return 0.0
    near = np.min([_distances(places, points) for points in others], axis=0)
    return -float(np.max(near))


def _distances(places: Array, points: Array) -> Array:
    """Return the distance of each place from the nearest point."""
    return np.asarray(np.sqrt(((places[:, None] - points[None]) ** 2).sum(axis=2)).min(axis=1))


def _off(boxes: Array, points: Array) -> Array:
    """Return the distances of boxes, shape (n, 2, 2), from their nearest points; 0 inside."""
    if not len(points):
        return np.full(len(boxes), np.inf)
    least = np.empty(len(boxes))
    columns = np.ascontiguousarray(points.T)
    for first in range(0, len(boxes), BOXES):
        squared = np.zeros(())
        for axis, column in enumerate(columns):
            low, high = boxes[first : first + BOXES, :, axis, None].swapaxes(0, 1)
            beyond = np.maximum(low - column, column - high)
            np.maximum(beyond, 0.0, out=beyond)
            squared = squared + np.square(beyond, out=beyond)
        least[first : first + BOXES] = squared.min(axis=1)
    return np.sqrt(least)


def _boxes(centres: Array, size: Array) -> Array:
    """Return the boxes of a size around centres, shape (n, 2, 2)."""
    return np.stack([centres - 0.5 * size, centres + 0.5 * size], axis=1)


class _Room(NamedTuple):
    """The name of one curve, and all that it may not touch; points and boxes in dots.

    Attributes
    ----------
    own : array, shape (n, 2)
        Points of the curve.
    others, curves : sequence of arrays
        Points of curves with other names, and of all curves and straight lines.
    taken : sequence of arrays, shape (2, 2)
        Boxes of other text.
    frame : array, shape (2, 2)
        Box of the axes.
    size : array, shape (2,)
        Width and height of the name.
    unit : float
        Dots of a point.
    """

    own: Array
    others: Sequence[Array]
    curves: Sequence[Array]
    taken: Sequence[Array]
    frame: Array
    size: Array
    unit: float

    def beside(self) -> tuple[Array, Array | None] | None:
        """Return the best centre of the name beside its curve, without a line; or None."""
        size, unit = self.size, self.unit
        offsets = [
            (shift * size[0], side * (0.5 * size[1] + gap * unit))
            for gap in GAPS
            for side in (-1.0, 1.0)
            for shift in (-0.5, 0.0, 0.5)
        ]
        centres = (_places(self.own)[:, None] + np.array(offsets)).reshape(-1, 2)
        centres = centres[self._free(_boxes(centres, size))]
        if not len(centres):
            return None
        boxes = _boxes(centres, size)
        near = _off(boxes, self.own)
        far = np.full(len(boxes), 60.0 * unit)
        if self.others:
            far = np.min([_off(boxes, points) for points in self.others], axis=0)
        score = np.where(far < NEARER * near, -np.inf, np.minimum(far, 30.0 * unit) - 1.5 * near)
        best = int(np.argmax(score))
        return (centres[best], None) if score[best] > -np.inf else None

    def lead(self) -> tuple[Array, Array | None] | None:
        """Return the best centre of the name away from its curve, and where its line begins."""
        best, place = np.inf, None
        size, unit, pad = self.size, self.unit, LEAST * self.unit
        for point in _places(self.own):
            distances = (_distances(point[None], points)[0] for points in self.others)
            if min(distances, default=9e9) < APART * unit:
                continue
            for gap, side, shift in itertools.product(LED, (-1.0, 1.0), SHIFTS):
                reach = side * gap * unit
                centre = point + np.array([shift * size[0], reach + side * 0.5 * size[1]])
                if not self._free(_boxes(centre[None], size))[0]:
                    continue
                end = centre - np.array([0.0, side * 0.5 * size[1]])
                path = point + np.linspace(0.1, 1.0, 16)[:, None] * (end - point)
                crossed = sum(_distances(path, points).min() < pad for points in self.others)
                crossed += sum(
                    bool(((path > other[0] - pad) & (path < other[1] + pad)).all(axis=1).any())
                    for other in self.taken
                )
                length = float(np.hypot(*(end - point))) + CROSSED * unit * crossed
                if length < best:
                    best, place = length, (centre, point)
        return place

    def _free(self, boxes: Array) -> NDArray[np.bool_]:
        """Return which boxes lie in the axes and touch neither a curve nor other text."""
        low, high = boxes[:, 0], boxes[:, 1]
        inside = (low >= self.frame[0] + self.unit) & (high <= self.frame[1] - self.unit)
        free: NDArray[np.bool_] = inside.all(axis=1)
        pad = BETWEEN * self.unit
        for other in self.taken:
            free &= ~((low < other[1] + pad) & (high > other[0] - pad)).all(axis=1)
        for points in self.curves:
            free[free] = _off(boxes[free], points) >= LEAST * self.unit
        return free
