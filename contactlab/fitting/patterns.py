"""Residuals that follow a column, and single numbers that decide a parameter."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from contactlab.fitting.outliers import NUMERICAL
from contactlab.fitting.problem import Problem

Array = NDArray[np.float64]

#: Degree of the polynomial in the rank of a column that residuals are compared with, and numbers
#: beyond parameters and degree that it takes.
DEGREE, SPARE = 3, 3
#: A column varies if its numbers spread over more than this share of the greatest.
VARIES = 0.1
#: Share of its scatter that a number takes away with itself, from which on it decides alone.
ALONE = 0.95
ORDER = "the order of the rows"


class Pattern(NamedTuple):
    """Residuals that follow a column: how likely chance alone makes that, and a sentence."""

    chance: float
    words: str


def pattern(
    problem: Problem, values: Array, scales: Mapping[str, Any], columns: Mapping[str, Array]
) -> Pattern:
    """Return the clearest dependence of residuals on a column that varies, or on the order.

    Parameters
    ----------
    problem : Problem
    values : array, shape (parameters,)
        The best values.
    scales : mapping of str to float or array
        Scatter, by quantity.
    columns : mapping of str to array, shape (n,)
        What was set before the impact.

    Notes
    -----
    F tests, beside the parameters, of a polynomial of third degree in the rank of the column, for
    each quantity, and of a parameter that changes between two rows. They see what runs of signs do
    not: no run of ten impacts is so long as to be sure. The chance is multiplied by the number of
    tests (Bonferroni).
    """
    weighted, jacobian = problem.linearised(values, scales)
    ends = np.cumsum(list(problem.counts.values()))[:-1]
    parts = zip(np.split(weighted, ends), np.split(jacobian, ends), strict=True)
    ranks = _ranked(columns, len(next(iter(problem.measured.values()))))
    sizes = problem.sizes()
    least = {n: (NUMERICAL * size / np.min(scales[n])) ** 2 for n, size in sizes.items()}
    tests = []
    for (name, numbers), (residuals, slopes) in zip(problem.measured.items(), parts, strict=True):
        for column, rank in ranks.items():
            x = rank[np.isfinite(numbers)]
            terms = legendre.legvander(2.0 * (x - x.min()) / max(np.ptp(x), 1.0) - 1.0, DEGREE)
            words = (
                f"{name}: residuals follow {column}: look at that column, at what else has changed "
                "with it, and at other laws"
            )
            chance = chance_of(residuals, slopes, terms[:, 1:], least[name])
            tests.append(Pattern(chance, words))
    same = [name for name in ranks if ORDER not in ranks and _in_order(ranks[name])]
    tests += _changes(problem, weighted, jacobian, max(least.values()), same)
    if not tests:
        return Pattern(1.0, "")
    found = min(tests)
    return found._replace(chance=found.chance * len(tests))


def _changes(
    problem: Problem, weighted: Array, jacobian: Array, least: float, same: list[str]
) -> list[Pattern]:
    """Return how likely it is by chance that a parameter has changed between two rows.

    Parameters
    ----------
    problem : Problem
    weighted, jacobian : array, shape (numbers,) and (numbers, parameters)
        Residuals over the scatter, and their derivatives.
    least : float
        Square of the numerical error, in units of the scatter.
    same : list of str
        Columns that grow or fall along the rows.
    """
    why = f"{ORDER}: what has changed meanwhile?"
    if same:
        why = (
            f"{ORDER}, which is that of {same[0]}: has something changed meanwhile, or do the laws "
            "not hold throughout?"
        )
    rows = np.concatenate([np.flatnonzero(np.isfinite(v)) for v in problem.measured.values()])
    found = []
    for parameter, slope in zip(problem.model.parameters, jacobian.T, strict=True):
        for last in range(SPARE, int(rows.max()) + 2 - SPARE):
            terms = (slope * (rows >= last))[:, None]
            words = (
                f"{parameter.name} is another up to impact {last} than from impact {last + 1} on, "
                f"in {why}"
            )
            found.append(Pattern(chance_of(weighted, jacobian, terms, least), words))
    return found


def leverage(problem: Problem, values: Array, scales: Mapping[str, Any]) -> list[str]:
    """Return a sentence for each number that a fit runs through whatever it is."""
    _, jacobian = problem.linearised(values, scales)
    basis = _basis(jacobian)
    shares = np.sum(basis**2, axis=1)
    found, first = [], 0
    for name, numbers in problem.measured.items():
        rows = np.flatnonzero(np.isfinite(numbers))
        part, first = shares[first : first + len(rows)], first + len(rows)
        found += [
            f"{name}: the fit runs through impact {row + 1} whatever was measured there (leverage "
            f"{share:.2f}), so that an error in it would not show; measure more like it"
            for row, share in zip(rows, part, strict=True)
            if share > ALONE and len(shares) > jacobian.shape[1]
        ]
    return found


def _ranked(columns: Mapping[str, Array], count: int) -> dict[str, Array]:
    """Return the ranks of the columns that vary, and the order of the rows if it is another."""
    found: dict[str, Array] = {}
    for name, values in columns.items():
        _, rank = np.unique(values, return_inverse=True)
        if np.ptp(values) > VARIES * np.max(np.abs(values)) and rank.max() >= DEGREE:
            found[name] = rank.reshape(-1).astype(float)
    order = np.arange(count, dtype=float)
    if count > DEGREE and not any(_in_order(rank) for rank in found.values()):
        found[ORDER] = order
    return found


def _in_order(rank: Array) -> bool:
    """Return whether a column grows or falls along the rows."""
    return abs(float(np.corrcoef(np.arange(len(rank)), rank)[0, 1])) > 0.99


def chance_of(residuals: Array, slopes: Array, terms: Array, least: float) -> float:
    """Return the chance with which normal scatter follows terms as well as residuals do.

    Parameters
    ----------
    residuals : array, shape (numbers,)
    slopes : array, shape (numbers, parameters)
        Derivatives by the parameters.
    terms : array, shape (numbers, m)
    least : float
        Square of the numerical error, in units of the scatter.
    """
    from scipy.special import fdtrc  # only those who fit pay for it

    added = terms.shape[1]
    freedom = len(residuals) - slopes.shape[1] - added
    if freedom < SPARE:
        return 1.0
    plain, curved = _left(residuals, slopes), _left(residuals, np.hstack([slopes, terms]))
    ratio = (plain - curved) / added / (curved / freedom + least + np.finfo(float).tiny)
    return float(fdtrc(added, freedom, max(ratio, 0.0)))


def _left(residuals: Array, columns: Array) -> float:
    """Return the square of what is left of residuals beside columns."""
    basis = _basis(columns)
    left = residuals - basis @ (basis.T @ residuals)
    return float(left @ left)


def _basis(columns: Array) -> Array:
    """Return orthonormal columns that span those that are not zero."""
    lengths = np.linalg.norm(columns, axis=0)
    return np.asarray(np.linalg.qr(columns[:, lengths > 0.0] / lengths[lengths > 0.0])[0])
