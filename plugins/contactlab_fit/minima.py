"""Minima of a fit: searches from several starts, and a scan over friction."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contactlab.numeric.types import Array
from contactlab_fit.model import FRICTION
from contactlab_fit.problem import Problem, fewer, solved, starting

#: Relative and absolute distance below which two searches have reached the same minimum.
SAME = 1e-3
#: Frictions that are scanned about a minimum: e_t has the same value on either side of its least
#: one, and the grid of starts is coarser than their distance. Farther off the grid sees both.
SCANNED, NEAR = 1.05 ** np.arange(-18.0, 19.0), 0.04


def minima(problem: Problem, progress: Callable[[int, int], object] | None = None) -> list[Array]:
    """Return the minima of a sum of squares, shape (parameters,) each, the best first."""
    found: list[Array] = []
    few, _ = fewer(problem)
    starts = starting(few)
    for done, start in enumerate(starts, start=1):
        _reach(problem, few, start, found)
        if progress is not None:
            progress(done, len(starts) + 1)  # the diagnosis is the last
    for start in [start for about in found for start in _further(few, about, found)]:
        _reach(problem, few, start, found)
    return sorted(found, key=problem.criterion) if len(found) > 1 else found


def _reach(problem: Problem, few: Problem, start: Array, found: list[Array]) -> None:
    """Search from a start, and add the minimum to those found if it is another one."""
    values = solved(few, start)
    if few is not problem:
        values = solved(problem, values)
    if not any(np.allclose(values, minimum, rtol=SAME, atol=SAME) for minimum in found):
        found.append(values)


def _further(problem: Problem, about: Array, found: list[Array]) -> list[Array]:
    """Return the minima over friction of a scan about a minimum, but for those found already."""
    names = [parameter.name for parameter in problem.model.parameters]
    if FRICTION not in names or not problem.model.at_once(list(problem.measured)):
        return []
    place = names.index(FRICTION)
    low, high = (end[place] for end in problem.bounds())
    points = np.tile(about, (len(SCANNED), 1))
    points[:, place] *= SCANNED
    points = points[(points[:, place] >= low) & (points[:, place] <= high)]
    scales = problem.scales(problem.residuals(about[None]))
    squares = np.sum(problem.weighted(points, scales) ** 2, axis=1)
    inner = (squares[1:-1] < squares[:-2]) & (squares[1:-1] <= squares[2:])
    known = np.array([minimum[place] for minimum in found])
    return [
        start
        for start in points[1:-1][inner]
        if np.all(np.abs(start[place] - known) > NEAR * known)
    ]
