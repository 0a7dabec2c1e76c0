"""Residuals that climb with a column or follow it, and numbers that decide alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Real
from contactlab.outcome.columns import QUANTITIES
from contactlab_fit.f_test import (
    NUMERICAL,
    SPARE,
    chance_of,
    chances_of_each,
    orthonormal,
    remaining,
)
from contactlab_fit.problem import Problem

#: Degree of the polynomial in the rank of a column.
DEGREE = 3
#: A column varies if its range exceeds this share of its greatest magnitude.
VARIES = 0.1
#: Leverage above which a single number determines the fit.
ALONE = 0.95
ORDER = "the order of the rows"
LOOK = "check that column, what else changed with it, and other laws"


class Pattern(NamedTuple):
    """Residuals that follow a column: the chance that scatter makes them, and a sentence."""

    chance: float
    words: str


#: No pattern: the chance is that of any scatter.
NO_PATTERN = Pattern(1.0, "")


def pattern(
    problem: Problem, values: Array, scales: Mapping[str, Real], columns: Mapping[str, Array]
) -> Pattern:
    """Return the least likely dependence of residuals on a varying column, or on the order.

    Notes
    -----
    F tests, beside the parameters, for each quantity: of a line and of a polynomial of third degree
    in the rank of the column, and of a line through 0 that ends at a value of it, as where slip
    begins; and of a parameter that changes between two rows. A test of runs of signs would
    be too weak: no run in ten impacts is improbable enough. The chance is multiplied by the number
    of tests (Bonferroni).
    """
    weighted, jacobian = problem.linearise(values, scales)
    residuals, slopes = problem.by_quantity(weighted), problem.by_quantity(jacobian)
    own = problem.residuals(values[None])
    ranks = _rank(columns, len(next(iter(problem.measured.values()))))
    sizes = problem.sizes()
    least = {n: (NUMERICAL * size / np.min(scales[n])) ** 2 for n, size in sizes.items()}
    tests: list[Pattern] = []
    ended: list[Pattern] = []
    count = 0
    for name, numbers in problem.measured.items():
        present = np.isfinite(numbers)
        for column, rank in ranks.items():
            x = rank[present]
            terms = legendre.legvander(2.0 * (x - x.min()) / max(np.ptp(x), 1.0) - 1.0, DEGREE)

            def test(words: str, added: Array, name: str = name) -> Pattern:
                chance = chance_of(residuals[name], slopes[name], added, least[name])
                return Pattern(chance, f"{name}: {words}: {LOOK}")

            number = np.asarray(columns.get(column, rank + 1.0), dtype=float)[present]
            row = own[name][0][present]
            order = np.argsort(x, kind="stable")
            ends = np.searchsorted(x[order], np.arange(SPARE, max(int(x.max()), SPARE) + 2))
            weights = _to(ends, number[order] ** 2)
            along = _to(ends, (row * number)[order])
            gains = along**2 / np.where(weights > 0.0, weights, 1.0)
            low = order[: ends[int(np.argmax(gains))]]  # the line nearest to the residuals
            words = _climb(name, number[low], row[low], column)
            chance = np.min(
                _chances(
                    residuals[name][order], slopes[name][order], number[order], ends, least[name]
                )
            )
            ended.append(Pattern(float(chance), f"{name}: {words}: {LOOK}"))
            tests.append(test(_climb(name, number, row, column), terms[:, 1:2]))
            tests.append(test(f"residuals follow {column}", terms[:, 1:]))
            count += len(ends)
    same = [name for name in ranks if ORDER not in ranks and _in_order(ranks[name])]
    changes, changed = _changes(problem, weighted, jacobian, max(least.values()), same)
    tests += changes
    if not tests:
        return NO_PATTERN
    clearest, line = min(tests), min(ended, default=NO_PATTERN)
    number_of_tests = len(tests) - len(changes) + changed + count
    if 2.0 * line.chance < clearest.chance:  # not where a changed parameter makes the same line
        clearest = line
    return clearest._replace(chance=clearest.chance * number_of_tests)


def _to(ends: NDArray[np.intp], products: Array) -> Array:
    """Return the sums of products, shape (numbers, ...), before each end."""
    zero = np.zeros((1, *products.shape[1:]))
    return np.asarray(np.concatenate([zero, np.cumsum(products, axis=0)])[ends])


def _chances(
    residuals: Array, slopes: Array, term: Array, ends: NDArray[np.intp], least: float
) -> Array:
    """Return the chance that scatter follows a term that is 0 from an end on, for each end.

    Running sums: a projection of each of n terms would take n² numbers.
    """
    basis = orthonormal(slopes)
    products = _to(ends, remaining(residuals, basis) * term)
    along = _to(ends, basis * term[:, None])
    return chances_of_each(residuals, slopes, products, _to(ends, term**2), along, least)


def _climb(name: str, x: Array, residuals: Array, column: str) -> str:
    """Return how residuals grow with a column: the ends of the line through them."""
    ends = float(x.min()), float(x.max())
    if ends[0] == ends[1]:
        return f"residuals are off at {column} {ends[0]:.3g}"
    low, high = np.polyval(np.polyfit(x, residuals, 1), ends)
    unit = QUANTITIES[name].unit if name in QUANTITIES else "1"
    size = f"from {low:+.2g} to {high:+.2g}{'' if unit == '1' else ' ' + unit}"
    way = "climb" if high > low else "fall"
    return f"residuals {way} with {column}, {size} between {ends[0]:.3g} and {ends[1]:.3g}"


def _changes(
    problem: Problem, weighted: Array, jacobian: Array, least: float, same: list[str]
) -> tuple[list[Pattern], int]:
    """Return a pattern for each parameter, at the likeliest row of a change, and the tests made."""
    why = f"{ORDER}: has the set-up changed?"
    if same:
        why = (
            f"{ORDER} (also that of {same[0]}): has the set-up changed, or do the laws fail in "
            "part of the range?"
        )
    rows = np.concatenate([np.flatnonzero(np.isfinite(v)) for v in problem.measured.values()])
    lasts = np.arange(SPARE, int(rows.max()) + 2 - SPARE)
    if not len(lasts):
        return [], 0
    order = np.argsort(-rows, kind="stable")  # a change is a term that begins at a row
    ends = np.searchsorted(-rows[order], -lasts, side="right")
    changes = []
    for parameter, slope in zip(problem.model.parameters, jacobian.T, strict=True):
        chances = _chances(weighted[order], jacobian[order], slope[order], ends, least)
        best = int(np.argmin(chances))
        first = lasts[best]
        words = f"{parameter.name} changes between impacts {first} and {first + 1}, in {why}"
        changes.append(Pattern(float(chances[best]), words))
    return changes, len(lasts) * len(changes)


def leverage(problem: Problem, values: Array, scales: Mapping[str, Real]) -> list[str]:
    """Return a sentence for each number that the fit meets at any value."""
    _, jacobian = problem.linearise(values, scales)
    shares = problem.by_quantity(np.sum(orthonormal(jacobian) ** 2, axis=1))
    if len(jacobian) <= jacobian.shape[1]:
        return []
    return [
        f"{name}: impact {row + 1} alone decides the fit (leverage {share:.2f}), so an error in "
        "this impact would not show. Measure more such impacts"
        for name, numbers in problem.measured.items()
        for row, share in zip(np.flatnonzero(np.isfinite(numbers)), shares[name], strict=True)
        if share > ALONE
    ]


def _rank(columns: Mapping[str, Array], count: int) -> dict[str, Array]:
    """Return the ranks of varying columns, and the order of the rows if no rank equals it."""
    ranks: dict[str, Array] = {}
    for name, values in columns.items():
        _, rank = np.unique(values, return_inverse=True)
        if np.ptp(values) > VARIES * np.max(np.abs(values)) and rank.max() >= DEGREE:
            ranks[name] = rank.reshape(-1).astype(float)
    order = np.arange(count, dtype=float)
    if count > DEGREE and not any(_in_order(rank) for rank in ranks.values()):
        ranks[ORDER] = order
    return ranks


def _in_order(rank: Array) -> bool:
    """Return whether a column grows or falls along the rows."""
    return abs(float(np.corrcoef(np.arange(len(rank)), rank)[0, 1])) > 0.99
