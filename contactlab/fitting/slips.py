"""Slips of a person in a column: whether the fit is far better with a column read another way."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.model import Model
from contactlab.fitting.parameters import Parameter, Setup, parameter_named
from contactlab.fitting.patterns import chance_of
from contactlab.fitting.problem import Problem, grid, solved
from contactlab.fitting.readings import Reading, readings, turned
from contactlab.numeric.checks import Real

Array = NDArray[np.float64]

#: A slip is told if residuals are this many times smaller without it, and the likelihood greater
#: by exp(CERTAIN/2), which chance alone gives a false reading once in 20,000 times.
SMALLER, CERTAIN = 2.0, 20.0
#: A reading is fitted if on the grid of starts its residuals are no more than this many times
#: those of the fit: between two starts lies a good part of a coefficient of friction.
WORTH_FITTING = 3.0
#: Readings about as good as the best are told beside it: this many in all at most.
TOLD, ALIKE = 3, 6.0
#: Numbers beyond parameters that it takes: fewer are met by chance.
SPARE = 3
#: A tilt is fitted if normal scatter follows its derivative as well with less than this chance.
WORTH_TILTING = 1e-2
#: Angles of incidence are off by no more than this, in degrees.
TILT = 15.0
#: Residuals below this share of the largest number are numerical error.
LEAST = 1e-6


class Read(NamedTuple):
    """A reading that is met better, its score, and the parameters that meet it best."""

    reading: Reading
    score: float
    values: Array


def slips(
    problem: Problem, given: Collection[str], values: Array, kept: Mapping[str, Array]
) -> tuple[list[str], list[str]]:
    """Return a sentence if a column, read another way, is met far better; and one if it may be.

    Readings are tried with the exact elastic law, by its table. Under other laws a reading has to
    be better there too. It only may be if the measurement is met nearly as well without outliers.

    Parameters
    ----------
    problem : Problem
    given : collection of str
        Columns of the measurement before the impact.
    values : array, shape (parameters,)
        The best values.
    kept : mapping of str to array, shape (n,)
        The numbers that are no outliers.
    """
    number = sum(problem.counts.values())
    if problem.model.setup.scene.sphere is None or number < len(values) + SPARE:
        return [], []
    quick = _elastic(problem)
    start = values if quick is problem else solved(quick, _first(quick))
    found = _better(quick, start, readings(quick, given))
    if quick is not problem and found:
        again = [_under(problem, one.reading) for one in found]
        found = _better(problem, values, again)
    if not found:
        return [], []
    told = _told(problem, values, found)
    others = [kept] if found[0].reading.rest is None else [kept, found[0].reading.rest]
    own = min(_without(problem, values, numbers) for numbers in others)
    if own - found[0].score > CERTAIN:
        return [told], []
    return [], [f"or, with every number kept, {told}"] if own > found[0].score else []


def _under(problem: Problem, reading: Reading) -> Reading:
    """Return a reading under the laws of the problem."""
    model = problem.model.at(reading.problem.model.setup.scene)
    return reading._replace(problem=attrs.evolve(reading.problem, model=model))


def _without(problem: Problem, values: Array, numbers: Mapping[str, Array]) -> float:
    """Return the score of the measurement with fewer numbers."""
    fewer = attrs.evolve(problem, measured=numbers)
    counts, sizes = list(problem.counts.values()), _sizes(problem)
    points = np.array([solved(fewer, start) for start in (values, _first(fewer))])
    return float(np.min(_scores(Reading("", fewer, {}), points, counts, sizes)))


def _elastic(problem: Problem) -> Problem:
    """Return the problem with the exact elastic law, which is quick; as it is if it has that."""
    model = problem.model
    if model.setup.simulation is None:
        return problem
    setup = Setup(model.setup.scene, None)
    names = {"friction_coefficient": None} | {
        one.name: None for one in model.parameters if one.name == "stiffness_ratio"
    }
    parameters = tuple(parameter_named(name, setup) for name in names)
    return attrs.evolve(problem, model=Model(setup=setup, parameters=parameters))


def _better(problem: Problem, values: Array, others: Iterable[Reading]) -> list[Read]:
    """Return the readings that are met far better than the measurement as it is, best first."""
    counts, sizes = list(problem.counts.values()), _sizes(problem)
    number = sum(counts)
    own = float(_scores(Reading("", problem, {}), values[None], counts, sizes)[0])
    enough = own - max(CERTAIN, 2.0 * number * math.log(SMALLER))
    found = []
    for reading in others:
        points = grid(reading.problem.model.parameters)
        rough = _scores(reading, points, counts, sizes)
        least = int(np.argmin(rough))
        if rough[least] - own > 2.0 * number * math.log(WORTH_FITTING):
            continue
        best = solved(reading.problem, points[least])
        score = float(_scores(reading, best[None], counts, sizes)[0])
        if score < enough:
            found.append(Read(reading, score, best))
    found.sort(key=lambda one: one.score)
    return [one for one in found if one.score - found[0].score < ALIKE][:TOLD]


def _first(problem: Problem) -> Array:
    """Return the point of the grid of starts that meets the measurement best."""
    points = grid(problem.model.parameters)
    counts = list(problem.counts.values())
    scores = _scores(Reading("", problem, {}), points, counts, _sizes(problem))
    return np.asarray(points[int(np.argmin(scores))])


def _sizes(problem: Problem) -> list[float]:
    """Return the size of the numbers of each quantity, as they were measured."""
    return list(problem.sizes().values())


def _scores(reading: Reading, points: Array, counts: list[int], sizes: list[float]) -> Array:
    """Return -2 log likelihood of the numbers as they were measured, shape (points,).

    The scatter of each quantity is that of its residuals; errors that are given weigh the numbers.

    Parameters
    ----------
    reading : Reading
    points : array, shape (points, parameters)
    counts : list of int
        Numbers that were measured, by quantity.
    sizes : list of float
        Size of the numbers of each quantity.
    """
    problem = reading.problem
    scores = np.zeros(len(points))
    residuals = problem.residuals(points)
    for (name, rows), count, size in zip(residuals.items(), counts, sizes, strict=True):
        weights = 1.0
        if name in problem.errors:
            error = problem.errors[name]
            weights = error / np.sqrt(np.nanmean(error**2))
        off = rows / (reading.factors.get(name, 1.0) * weights)
        scores += count * np.log(np.nanmean(off**2, axis=1) + (LEAST * size) ** 2)
    return scores


def _told(problem: Problem, values: Array, found: list[Read]) -> str:
    """Return what the best readings suppose, and what comes of the first."""
    best = found[0]
    counts, sizes = list(problem.counts.values()), _sizes(problem)
    own = _scores(Reading("", problem, {}), values[None], counts, sizes)[0]
    times = math.exp((own - best.score) / (2.0 * sum(counts)))
    listed = "; or ".join(one.reading.words for one in found)
    parameters = best.reading.problem.model.parameters
    then = ", ".join(
        f"{one.name} {value:.4g}" for one, value in zip(parameters, best.values, strict=True)
    )
    return f"{listed}: read so, residuals are {times:.2g} times smaller, and {then}"


class AngleOffset(Parameter):
    """An angle, in degrees, that all angles of incidence are too large by."""

    def applied(self, setup: Setup, value: Real) -> Setup:
        """Return the scene with the angles corrected."""
        scene = setup.scene
        angle: Any = np.arctan2(scene.tangential_velocity, scene.normal_speed)
        return setup._replace(scene=turned(scene, angle - np.radians(value), ()))


def tilted(problem: Problem, given: Collection[str], values: Array) -> tuple[float, str]:
    """Return a sentence if the fit is far better with all angles of incidence off by a number.

    Before it stands the chance with which normal scatter makes that: 1 if there is none.

    Parameters
    ----------
    problem : Problem
    given : collection of str
        Columns of the measurement before the impact.
    values : array, shape (parameters,)
        The best values.
    """
    from scipy.special import fdtrc  # only those who fit pay for it

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
    found = solved(wider, at)
    own, other = (
        float(_scores(Reading("", one, {}), point[None], counts, sizes)[0])
        for one, point in ((problem, values), (wider, found))
    )
    if own - other < max(CERTAIN, 2.0 * sum(counts) * math.log(SMALLER)):
        return 1.0, ""
    times = math.exp((own - other) / (2.0 * sum(counts)))
    then = ", ".join(
        f"{one.name} {value:.4g}"
        for one, value in zip(problem.model.parameters, found[:-1], strict=True)
    )
    look = (
        f"{name} looks as if all numbers were {abs(found[-1]):.2g} degrees too "
        f"{'large' if found[-1] > 0.0 else 'small'}, as by the zero of a protractor: read so, "
        f"residuals are {times:.2g} times smaller, and {then}"
    )
    return float(fdtrc(1, freedom, (times**2 - 1.0) * freedom)), look
