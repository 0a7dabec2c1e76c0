"""What the measurements cannot determine is refused, with a measurement that would."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contactlab.fitting import advice
from contactlab.fitting.model import Model
from contactlab.fitting.problem import Problem

Array = NDArray[np.float64]

#: Parameters whose effects, each of unit length, differ by less than this are told apart by none.
ALIKE = 1e-3
#: Half-width of the 95 % interval, of the range or else of the value, from which on nothing is
#: determined; and a half-width of friction that says something however small the value.
VAGUE_IN_RANGE, VAGUE, SHARP = 0.5, 1.0, 0.05
#: Difference of Akaike's criterion below which a second minimum is as good as the first: at 4 the
#: second is the right one about one time in eight.
CLOSE = 4.0


def check_enough(problem: Problem) -> None:
    """Refuse fewer numbers than parameters.

    Raises
    ------
    ValueError
    """
    numbers, parameters = sum(problem.counts.values()), problem.model.parameters
    if numbers < len(parameters):
        raise ValueError(
            f"{numbers} measured numbers cannot determine {len(parameters)} parameters; "
            "measure more impacts, or fit fewer"
        )


def check_scatter(problem: Problem) -> None:
    """Refuse, among several quantities, one that the parameters can meet to the last digit.

    Its residuals would be zero, and with them the error that its weight is found by.

    Raises
    ------
    ValueError
    """
    if len(problem.measured) == 1:
        return
    for name, count in problem.counts.items():
        if name not in problem.errors and count <= len(problem.model.parameters):
            raise ValueError(
                f"{name}: {count} measured, too few to find their scatter beside that of the other "
                f"quantities; give a column {name}_error, measure more, or leave it out of those "
                "that are fitted"
            )


def idle(problem: Problem, values: Array) -> list[str]:
    """Return the quantities that depend on no parameter, where others do.

    They can be met by none, and would only hide how sharply the others are: a restitution that
    was measured, under an elastic law.
    """
    effects = problem.linearised(values, problem.sizes())[1]
    effects = np.abs(effects * advice.sizes(problem.model.parameters, values)).max(axis=1)
    ends = np.cumsum(list(problem.counts.values()))[:-1]
    parts = zip(problem.measured, np.split(effects, ends), strict=True)
    found = [name for name, part in parts if part.max() < advice.NO_EFFECT]
    return found if len(found) < len(problem.measured) else []


def check_determined(problem: Problem, values: Array) -> None:
    """Refuse parameters that no measured number depends on, or that are not told apart.

    Raises
    ------
    ValueError
        With the parameters, and a measurement that would determine them.
    """
    parameters = problem.model.parameters
    effects = problem.linearised(values, problem.sizes())[1] * advice.sizes(parameters, values)
    lengths = np.sqrt(np.sum(effects**2, axis=0) / len(effects))
    for place, parameter in enumerate(parameters):
        if lengths[place] < advice.NO_EFFECT:
            raise _undetermined(
                problem.model, values, [place], f"no measured number depends on {parameter.name}"
            )
    unit = effects / np.sqrt(np.sum(effects**2, axis=0))
    _, singular, turned = np.linalg.svd(unit, full_matrices=False)
    if singular[-1] < ALIKE:
        places = np.flatnonzero(np.abs(turned[-1]) > 0.1).tolist()
        names = " and ".join(parameters[place].name for place in places)
        told = f"a change of {names} together leaves every measured number as it is"
        raise _undetermined(problem.model, values, places, told)


def check_precise(problem: Problem, values: Array, reaches: Array) -> None:
    """Refuse parameters whose interval is as wide as their range, or as themselves.

    Parameters
    ----------
    problem : Problem
    values, reaches : array, shape (parameters,)
        Best values, and half-widths of their 95 % intervals; NaN where there is none.

    Raises
    ------
    ValueError
        With the parameter, and a measurement that would determine it.
    """
    for place, parameter in enumerate(problem.model.parameters):
        value, reach = float(values[place]), float(reaches[place])
        allowed = VAGUE_IN_RANGE * parameter.width
        if not math.isfinite(allowed):
            allowed = max(VAGUE * abs(value), SHARP)
        if reach > allowed:
            told = (
                f"the measured numbers hardly depend on {parameter.name}: {value:.3g} ± {reach:.2g}"
            )
            raise _undetermined(problem.model, values, [place], told)


def check_single(problem: Problem, minima: list[Array]) -> None:
    """Refuse data that two sets of values meet about as well.

    Parameters
    ----------
    problem : Problem
    minima : list of array
        Values of the parameters at the minima that were found, the best first.

    Raises
    ------
    ValueError
        With both, and a measurement that would tell them apart.
    """
    for other in minima[1:]:
        if problem.criterion(other) - problem.criterion(minima[0]) < CLOSE:
            told = " and ".join(
                ", ".join(
                    f"{parameter.name} = {value:.4g}"
                    for parameter, value in zip(problem.model.parameters, values, strict=True)
                )
                for values in (minima[0], other)
            )
            names = " and ".join(parameter.name for parameter in problem.model.parameters)
            remedy = advice.telling_apart(problem.model, np.array([minima[0], other]))
            raise ValueError(
                f"the data do not determine {names}: they are met as well by {told}; {remedy}"
            )


def _undetermined(model: Model, values: Array, places: list[int], told: str) -> ValueError:
    """Return the refusal of parameters that the data do not determine.

    Parameters
    ----------
    model : Model
    values : array, shape (parameters,)
        Each in its parameter's unit.
    places : list of int
        Which parameters are not determined.
    told : str
        Why not.
    """
    names = " and ".join(model.parameters[place].name for place in places)
    remedy = " ".join(dict.fromkeys(advice.advised(model, values, place) for place in places))
    return ValueError(f"the data do not determine {names}: {told}; {remedy}")
