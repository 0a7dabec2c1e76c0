"""A robust second fit, and outliers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Real
from contactlab_fit.f_test import CHANCE, NUMERICAL, log_chance
from contactlab_fit.parameters import in_words
from contactlab_fit.problem import Problem, fewer, grid, minimum

#: Standard deviation of normal scatter over its median absolute deviation.
NORMAL = 1.4826
#: Candidate outliers have residuals beyond these, in units of the scatter of the robust fit; the
#: fit without them decides.
CUTS = (20.0, 10.0, 6.0, 4.5, 3.5)
#: Largest share of outliers, and least count of numbers that shows a scatter.
FEW, LEAST = 0.3, 6
#: Most impacts that a sentence lists.
LISTED = 8


class Outliers(NamedTuple):
    """Outliers, and the fit without them.

    Attributes
    ----------
    chance : float
        Chance that normal scatter makes such outliers; 1 without outliers.
    places : mapping of str to array of int
        Rows of the outliers, by quantity.
    rest : Problem
        The problem without the outliers.
    values : array, shape (parameters,)
        Best values of the rest.
    """

    chance: float
    places: Mapping[str, NDArray[np.intp]]
    rest: Problem
    values: Array


def robust(problem: Problem, values: Array) -> tuple[Array, dict[str, Array]]:
    """Return robust values, shape (parameters,), and the scatter by quantity.

    Notes
    -----
    ``scipy.optimize.least_squares`` with the loss "soft_l1": first at a small scale, which nearly
    gives the least absolute deviations, then at the scatter of the first fit.
    """
    few, _ = fewer(problem)
    points = np.vstack([values, grid(problem.model.parameters)])
    near = _nearly(few.scales(few.residuals(values[None])))
    start = points[int(np.argmin(np.sum(np.abs(few.weigh(points, near)), axis=1)))]
    scales = _nearly(problem.scales(problem.residuals(values[None])))
    first = minimum(problem, start, scales, loss="soft_l1")
    scales = scatter(problem, first)
    return minimum(problem, first, scales, loss="soft_l1"), scales


def _nearly(scales: Mapping[str, Real]) -> dict[str, Array]:
    """Return scales at which a loss is nearly that of absolute deviations."""
    return {name: 0.1 * np.asarray(scale) for name, scale in scales.items()}


def scatter(problem: Problem, values: Array) -> dict[str, Array]:
    """Return the scatter of each quantity, in its unit, from its median absolute residual.

    Stated errors set the ratios of the scatter within a quantity.
    """
    number = sum(problem.counts.values())
    wider = math.sqrt(number / max(number - len(values), 1))
    scales: dict[str, Array] = {}
    sizes = problem.sizes()
    for name, rows in problem.residuals(values[None]).items():
        errors = problem.errors.get(name, np.ones(rows.shape[1]))
        middle = float(np.nanmedian(np.abs(rows[0] / errors)))
        scales[name] = errors * max(NORMAL * wider * middle, NUMERICAL * sizes[name] / errors.max())
    return scales


def outliers(problem: Problem, values: Array, scales: Mapping[str, Real]) -> Outliers:
    """Return the numbers whose removal improves the fit beyond chance.

    Notes
    -----
    The F test of k numbers with a mean of their own, times the number of ways to choose k
    (Bonferroni). Candidates are the k numbers farthest from the robust fit, for growing k.
    """
    from scipy.special import gammaln  # only a fit needs scipy

    off = {
        name: np.abs(rows[0]) / scales[name]
        for name, rows in problem.residuals(values[None]).items()
    }
    flat = np.concatenate([rows[np.isfinite(rows)] for rows in off.values()])
    number, parameters = len(flat), len(values)
    if number < LEAST + parameters - 1:
        return none(problem, values)
    least = sum((NUMERICAL * size / np.min(scales[q])) ** 2 for q, size in problem.sizes().items())
    whole = math.nan
    best = none(problem, values)
    for count in sorted({int(np.sum(flat > cut)) for cut in CUTS} - {0}):
        freedom = number - count - parameters
        if count > max(1.0, FEW * number) or freedom < 3:
            break
        cut = np.sort(flat)[-count]
        places = {name: np.flatnonzero(rows >= cut) for name, rows in off.items()}
        rest = _leave_out(problem, places)
        if min(rest.counts.values()) <= parameters:
            break
        again = minimum(rest, values, scales)
        square = _square(rest, again, scales)
        if math.isnan(whole):
            whole = _square(problem, minimum(problem, values, scales), scales)
        ratio = (whole - square) / count / ((square + least) / freedom)
        ways = gammaln(number + 1) - gammaln(count + 1) - gammaln(number - count + 1)
        chance = math.exp(min(log_chance(count, freedom, max(ratio, 0.0)) + ways, 0.0))
        if chance < min(best.chance, CHANCE):
            best = Outliers(chance, {n: p for n, p in places.items() if len(p)}, rest, again)
    return best


def none(problem: Problem, values: Array) -> Outliers:
    """Return the problem without outliers."""
    return Outliers(1.0, {}, problem, values)


def describe_outliers(problem: Problem, far: Outliers) -> list[str]:
    """Return a sentence for each quantity that has outliers."""
    residuals = {
        name: problem.measured[name] - rows[0]
        for name, rows in problem.model.predict(far.values[None], list(far.places)).items()
    }
    without = in_words(problem.model.parameters, far.values)
    sentences = []
    for name, places in far.places.items():
        kept = np.delete(residuals[name], places)
        rms = float(np.sqrt(np.nanmean(kept**2)))
        largest = float(np.max(np.abs(residuals[name][places])))
        are = "are" if len(places) > 1 else "is"
        sentences.append(
            f"{name}: {impacts_in_words(places)} {are} off by up to {largest:.3g}, the others by "
            f"{rms:.2g} (rms). Without {'them' if len(places) > 1 else 'this one'}: {without}. "
            "Put # "
            "before a line to skip the line"
        )
    return sentences


def impacts_in_words(places: NDArray[np.intp]) -> str:
    """Return rows as impacts by their numbers, the first of many."""
    rows = [str(place + 1) for place in places[:LISTED]]
    if len(places) > LISTED:
        rows.append(f"{len(places) - LISTED} more")
    listed = " and ".join([", ".join(rows[:-1]), rows[-1]] if rows[1:] else rows)
    return f"{'impacts' if len(places) > 1 else 'impact'} {listed}"


def _square(problem: Problem, values: Array, scales: Mapping[str, Real]) -> float:
    """Return the sum of squares of residuals over the scatter."""
    weighted = problem.weigh(values[None], scales)[0]
    return float(weighted @ weighted)


def _leave_out(problem: Problem, places: Mapping[str, NDArray[np.intp]]) -> Problem:
    """Return the problem without some numbers."""
    measured = {}
    for name, values in problem.measured.items():
        measured[name] = values.copy()
        measured[name][places[name]] = np.nan
    return attrs.evolve(problem, measured=measured)
