"""Mistakes in a column, detected by a far better fit with the column read another way."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.f_test import SPARE, chance_of
from contactlab.fitting.model import Model
from contactlab.fitting.parameters import Parameter, Setup, parameter_named
from contactlab.fitting.problem import Problem, grid, solved
from contactlab.fitting.readings import Reading, readings, turned
from contactlab.numeric.checks import Real

Array = NDArray[np.float64]

#: A mistake is reported if its correction makes residuals this many times smaller and the
#: likelihood exp(CERTAIN/2) times greater, which chance does once in 20,000 times.
SMALLER, CERTAIN = 2.0, 20.0
#: A reading is fitted if its residuals on the grid of starts are at most this many times the
#: residuals of the fit: the friction coefficients of the grid are far apart.
WORTH_FITTING = 3.0
#: Most readings reported, and difference of scores up to which they are as good as the best.
LISTED, ALIKE = 3, 6.0
#: A tilt is fitted if normal scatter follows its derivative with less than this chance.
WORTH_TILTING = 1e-2
#: Largest tilt, in degrees.
TILT = 15.0
#: Residuals below this share of the largest number are numerical error.
LEAST = 1e-6


class Read(NamedTuple):
    """A reading, its score, and its best values of the parameters."""

    reading: Reading
    score: float
    values: Array


def slips(
    problem: Problem, given: Collection[str], values: Array, kept: Mapping[str, Array]
) -> tuple[list[str], list[str]]:
    """Return sentences on certain and on possible mistakes in columns, at most one of them.

    Readings are tried with the tabulated exact elastic law. Under other laws a reading has to fit
    far better too. A mistake is only possible if the fit to the numbers ``kept``, without
    outliers, is nearly as good as the best reading.
    """
    number = sum(problem.counts.values())
    if problem.model.setup.scene.sphere is None or number < len(values) + SPARE:
        return [], []
    quick = _elastic(problem)
    start = values if quick is problem else solved(quick, _first(quick))
    better = _better(quick, start, readings(quick, given))
    if quick is not problem and better:
        again = [_under(problem, read.reading) for read in better]
        better = _better(problem, values, again)
    if not better:
        return [], []
    best = better[0]
    sentence = _sentence(problem, values, better)
    subsets = [kept] if best.reading.rest is None else [kept, best.reading.rest]
    own = min(_without(problem, values, numbers) for numbers in subsets)
    if own - best.score > CERTAIN:
        return [sentence], []
    return [], [f"or, with every number kept, {sentence}"] if own > best.score else []


def _under(problem: Problem, reading: Reading) -> Reading:
    """Return a reading under the laws of the problem."""
    model = problem.model.at(reading.problem.model.setup.scene)
    return reading._replace(problem=attrs.evolve(reading.problem, model=model))


def _without(problem: Problem, values: Array, numbers: Mapping[str, Array]) -> float:
    """Return the score of the measurement with only some of its numbers."""
    fewer = attrs.evolve(problem, measured=numbers)
    counts, sizes = list(problem.counts.values()), _sizes(problem)
    points = np.array([solved(fewer, start) for start in (values, _first(fewer))])
    return float(np.min(_scores(Reading("", fewer, {}), points, counts, sizes)))


def _elastic(problem: Problem) -> Problem:
    """Return the problem under the exact elastic law, whose table is quick."""
    model = problem.model
    if model.setup.simulation is None:
        return problem
    setup = Setup(model.setup.scene, None)
    names = {"friction_coefficient": None} | {
        p.name: None for p in model.parameters if p.name == "stiffness_ratio"
    }
    parameters = tuple(parameter_named(name, setup) for name in names)
    return attrs.evolve(problem, model=Model(setup=setup, parameters=parameters))


def _better(problem: Problem, values: Array, candidates: Iterable[Reading]) -> list[Read]:
    """Return the readings that fit far better than the measurement as it is, best first."""
    counts, sizes = list(problem.counts.values()), _sizes(problem)
    number = sum(counts)
    own = float(_scores(Reading("", problem, {}), values[None], counts, sizes)[0])
    limit = own - max(CERTAIN, 2.0 * number * math.log(SMALLER))
    better = []
    for reading in candidates:
        points = grid(reading.problem.model.parameters)
        rough = _scores(reading, points, counts, sizes)
        least = int(np.argmin(rough))
        if rough[least] - own > 2.0 * number * math.log(WORTH_FITTING):
            continue
        best = solved(reading.problem, points[least])
        score = float(_scores(reading, best[None], counts, sizes)[0])
        if score < limit:
            better.append(Read(reading, score, best))
    better.sort(key=lambda read: read.score)
    return [read for read in better if read.score - better[0].score < ALIKE][:LISTED]


def _first(problem: Problem) -> Array:
    """Return the best point of the grid of starts, shape (parameters,)."""
    points = grid(problem.model.parameters)
    counts = list(problem.counts.values())
    scores = _scores(Reading("", problem, {}), points, counts, _sizes(problem))
    return np.asarray(points[int(np.argmin(scores))])


def _sizes(problem: Problem) -> list[float]:
    """Return the size of the numbers of each measured quantity."""
    return list(problem.sizes().values())


def _scores(reading: Reading, points: Array, counts: list[int], sizes: list[float]) -> Array:
    """Return -2 log likelihood of the numbers as measured, shape (points,).

    The scatter of each quantity is the rms of its residuals, weighted by stated errors.
    """
    problem = reading.problem
    scores = np.zeros(len(points))
    residuals = problem.residuals(points)
    for (name, rows), count, size in zip(residuals.items(), counts, sizes, strict=True):
        weights = 1.0
        if name in problem.errors:
            error = problem.errors[name]
            weights = error / np.sqrt(np.nanmean(error**2))
        residual = rows / (reading.factors.get(name, 1.0) * weights)
        scores += count * np.log(np.nanmean(residual**2, axis=1) + (LEAST * size) ** 2)
    return scores


def _sentence(problem: Problem, values: Array, better: list[Read]) -> str:
    """Return a sentence on the best readings, with the parameters of the first."""
    best = better[0]
    counts, sizes = list(problem.counts.values()), _sizes(problem)
    own = _scores(Reading("", problem, {}), values[None], counts, sizes)[0]
    times = math.exp((own - best.score) / (2.0 * sum(counts)))
    listed = "; or ".join(read.reading.words for read in better)
    parameters = best.reading.problem.model.parameters
    estimates = ", ".join(
        f"{p.name} {value:.4g}" for p, value in zip(parameters, best.values, strict=True)
    )
    return f"{listed}: read so, residuals are {times:.2g} times smaller, and {estimates}"


class AngleOffset(Parameter):
    """The common excess of all angles of incidence, in degrees."""

    def applied(self, setup: Setup, value: Real) -> Setup:
        """Return the scene with corrected angles."""
        scene = setup.scene
        angle: Any = np.arctan2(scene.tangential_velocity, scene.normal_speed)
        return setup._replace(scene=turned(scene, angle - np.radians(value), ()))


def tilted(problem: Problem, given: Collection[str], values: Array) -> tuple[float, str]:
    """Return the chance that scatter looks like a common error of angles, and a sentence on it.

    The chance is 1 and the sentence empty unless the fit is far better with that error corrected.
    """
    from scipy.special import fdtrc  # only a fit needs scipy

    counts, sizes = list(problem.counts.values()), _sizes(problem)
    freedom = sum(counts) - len(values) - 1
    if problem.model.setup.scene.sphere is None or freedom < SPARE:
        return 1.0, ""
    name = "angle_deg" if "angle_deg" in given else "the angle of incidence"
    offset = AngleOffset(name=name, unit="deg", least=-TILT, most=TILT, starts=(0.0,))
    model = attrs.evolve(problem.model, parameters=(*problem.model.parameters, offset))
    wider = attrs.evolve(problem, model=model)
    at = np.append(values, 0.0)
    weighted, slopes = wider.linearised(at, problem.scales(problem.residuals(values[None])))
    if chance_of(weighted, slopes[:, :-1], slopes[:, -1:], 0.0) > WORTH_TILTING:
        return 1.0, ""
    best = solved(wider, at)
    own, corrected = (
        float(_scores(Reading("", fitted, {}), point[None], counts, sizes)[0])
        for fitted, point in ((problem, values), (wider, best))
    )
    if own - corrected < max(CERTAIN, 2.0 * sum(counts) * math.log(SMALLER)):
        return 1.0, ""
    times = math.exp((own - corrected) / (2.0 * sum(counts)))
    estimates = ", ".join(
        f"{p.name} {value:.4g}"
        for p, value in zip(problem.model.parameters, best[:-1], strict=True)
    )
    sentence = (
        f"{name} looks as if all numbers were {abs(best[-1]):.2g} degrees too "
        f"{'large' if best[-1] > 0.0 else 'small'}, as by the zero of a protractor: read so, "
        f"residuals are {times:.2g} times smaller, and {estimates}"
    )
    return float(fdtrc(1, freedom, (times**2 - 1.0) * freedom)), sentence
