"""Minima of a fit: searches from several starts, and a scan over friction."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from contactlab.numeric.types import Array, Real
from contactlab_fit.model import FRICTION
from contactlab_fit.problem import Problem, fewer, grid, solve_problem, starting

#: Relative and absolute distance below which two searches have reached the same minimum.
SAME = 1e-3
#: Frictions that are scanned about a minimum: e_t has the same value on either side of its least
#: one, and the grid of starts is coarser than their distance. Farther off the grid sees both.
SCANNED, NEAR = 1.05 ** np.arange(-18.0, 19.0), 0.04
#: Sum of squares over the least one up to which the data may allow a friction, and the share within
#: which a profile sees another minimum.
ALLOWED, BESIDE = 4.0, 0.12


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
    """Search from a start, and add the minimum if it is new."""
    values = solve_problem(few, start)
    if few is not problem:
        values = solve_problem(problem, values)
    if not any(np.allclose(values, minimum, rtol=SAME, atol=SAME) for minimum in found):
        found.append(values)


def _further(problem: Problem, about: Array, found: list[Array]) -> list[Array]:
    """Return the new minima over friction of a scan about a minimum."""
    names = [parameter.name for parameter in problem.model.parameters]
    if FRICTION not in names or not problem.model.at_once(list(problem.measured)):
        return []
    place = names.index(FRICTION)
    low, high = (end[place] for end in problem.bounds())
    points = np.tile(about, (len(SCANNED), 1))
    points[:, place] *= SCANNED
    points = points[(points[:, place] >= low) & (points[:, place] <= high)]
    scales = problem.scales(problem.residuals(about[None]))
    if not problem.model.tabled and len(names) == 1:
        points = _allow(problem, about, points, scales)
        if not len(points):
            return []
    squares = np.sum(problem.weigh(points, scales) ** 2, axis=1)
    inner = (squares[1:-1] < squares[:-2]) & (squares[1:-1] <= squares[2:])
    known = np.array([minimum[place] for minimum in found])
    return [
        start
        for start in points[1:-1][inner]
        if np.all(np.abs(start[place] - known) > NEAR * known)
    ]


def _allow(problem: Problem, about: Array, points: Array, scales: Mapping[str, Real]) -> Array:
    """Return the points up to the last that the data allow, by lines through the grid of starts.

    Marched laws take long. Residuals are computed on the grid only; between its points they may be
    less by as much as lines and curves through them differ.
    """
    from scipy.interpolate import PchipInterpolator  # only a fit needs scipy

    starts = grid(problem.model.parameters)
    at, x = np.log(starts[:, 0]), np.log(points[:, 0])
    known = problem.weigh(starts, scales)
    curve = PchipInterpolator(at, known)(np.clip(x, at[0], at[-1]))
    line = np.stack([np.interp(x, at, row) for row in known.T], axis=-1)
    least = np.maximum(np.abs(curve) - np.abs(curve - line), 0.0)
    best = float(np.sum(problem.weigh(about[None], scales) ** 2))
    near = np.abs(points[:, 0] / about[0] - 1.0) < BESIDE
    allowed = np.flatnonzero((np.sum(least**2, axis=1) < ALLOWED * best) & ~near)
    if not allowed.size:
        return points[:0]
    middle = len(points) // 2
    return points[max(min(allowed[0], middle) - 1, 0) : max(allowed[-1], middle) + 2]
