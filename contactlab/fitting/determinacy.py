"""What the measurements cannot determine is refused, with a measurement that would."""

from __future__ import annotations

import math
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.model import Model
from contactlab.fitting.parameters import Parameter
from contactlab.fitting.problem import Problem
from contactlab.scene import Scene

Array = NDArray[np.float64]

#: A change of a parameter by its whole size that moves no measured quantity by this share of
#: that quantity's size has no effect; derivatives are good to about 1e-6.
NO_EFFECT = 1e-4
#: Parameters whose effects, each of unit length, differ by less than this are told apart by none.
ALIKE = 1e-3
#: Half-width of the 95 % interval, of the range or else of the value, from which on nothing is
#: determined; and a half-width of friction that says something however small the value.
VAGUE_IN_RANGE, VAGUE, SHARP = 0.5, 1.0, 0.05
#: Difference of Akaike's criterion below which a second minimum is as good as the first: at 4 the
#: second is the right one about one time in eight.
CLOSE = 4.0
#: Angles of incidence and, without bodies, psi1 at which a further measurement is thought of.
ANGLES_DEG = np.array(
    [1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0]
)
INCIDENCES = np.array([0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0])
#: Quantities that are thought of, all without unit.
THOUGHT_OF = ("normal_restitution", "tangential_restitution")
#: Share of the greatest effect that a measurement is worth while with.
WORTH = 0.5


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


def idle(problem: Problem, values: Array) -> list[str]:
    """Return the quantities that depend on no parameter, where others do.

    They can be met by none, and would only hide how sharply the others are: a restitution that
    was measured, under an elastic law.
    """
    effects = problem.linearised(values, problem.sizes())[1]
    effects = np.abs(effects * _sizes(problem.model.parameters, values)).max(axis=1)
    ends = np.cumsum(list(problem.counts.values()))[:-1]
    parts = zip(problem.measured, np.split(effects, ends), strict=True)
    found = [name for name, part in parts if part.max() < NO_EFFECT]
    return found if len(found) < len(problem.measured) else []


def check_determined(problem: Problem, values: Array) -> None:
    """Refuse parameters that no measured number depends on, or that are not told apart.

    Raises
    ------
    ValueError
        With the parameters, and a measurement that would determine them.
    """
    parameters = problem.model.parameters
    effects = problem.linearised(values, problem.sizes())[1] * _sizes(parameters, values)
    lengths = np.sqrt(np.sum(effects**2, axis=0) / len(effects))
    for place, parameter in enumerate(parameters):
        if lengths[place] < NO_EFFECT:
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
            advice = _telling_apart(problem.model, np.array([minima[0], other]))
            raise ValueError(
                f"the data do not determine {names}: they are met as well by {told}; {advice}"
            )


def _telling_apart(model: Model, both: Array) -> str:
    """Return a sentence on which measurement differs most between two sets of values."""
    scene, x, words = _thought_of(model.setup.scene)
    name = THOUGHT_OF[1] if scene.sphere is not None else "psi2"
    one, other = model.at(scene).predicted(both, [name])[name]
    best = int(np.argmax(np.abs(one - other)))
    return (
        f"measure {name} at {words} of about {x[best]:g}: {one[best]:.3g} of the first, "
        f"{other[best]:.3g} of the second."
    )


def _undetermined(model: Model, values: Array, places: list[int], told: str) -> ValueError:
    names = " and ".join(model.parameters[place].name for place in places)
    advice = " ".join(dict.fromkeys(_advice(model, values, place) for place in places))
    return ValueError(f"the data do not determine {names}: {told}; {advice}")


def _advice(model: Model, values: Array, place: int) -> str:
    """Return a sentence on which measurement depends most on a parameter."""
    parameter = model.parameters[place]
    scene, x, words = _thought_of(model.setup.scene)
    names = THOUGHT_OF if scene.sphere is not None else ("normal_restitution", "psi2")
    effects = {name: _effect(model.at(scene), values, place, name) for name in names}
    greatest = {name: float(np.max(effect)) for name, effect in effects.items()}
    name = max(greatest, key=lambda key: greatest[key])
    if greatest[name] < NO_EFFECT:
        return f"no rebound of these laws depends on {parameter.name}: fix it, or choose others."
    worth = x[effects[name] >= WORTH * greatest[name]]
    where = f" from {worth.min():g} to {worth.max():g}" if len(worth) > 1 else f" of {worth[0]:g}"
    if len(worth) == len(x):
        return f"measure {name} to determine {parameter.name}, at any {words}."
    best = x[int(np.argmax(effects[name]))]
    return f"measure {name} at {words}{where}, best about {best:g}, to determine {parameter.name}."


def _thought_of(scene: Scene) -> tuple[Scene, Array, str]:
    """Return impacts over a range of incidence at the speed of those that were measured."""
    if scene.sphere is None:
        chi = float(np.median(scene.chi))
        return Scene.nondimensional(psi1=INCIDENCES, chi=chi), INCIDENCES, "psi1"
    speed: Any = np.hypot(scene.normal_speed, scene.tangential_velocity)
    angle = np.radians(ANGLES_DEG)
    first = scene.take(0)
    impacts = attrs.evolve(
        first,
        normal_speed=float(np.median(speed)) * np.cos(angle),
        tangential_velocity=float(np.median(speed)) * np.sin(angle),
        spin=0.0,
    )
    return impacts, ANGLES_DEG, "angles of incidence (degrees)"


def _effect(model: Model, values: Array, place: int, quantity: str) -> Array:
    """Return how far a quantity moves if the parameter changes by its size."""
    parameter = model.parameters[place]
    size = _sizes((parameter,), values[place : place + 1])[0]
    ends = np.array([values, values])
    ends[0, place] = max(values[place] - 0.05 * size, parameter.least)
    ends[1, place] = min(values[place] + 0.05 * size, parameter.most)
    below, above = model.predicted(ends, [quantity])[quantity]
    return np.asarray(np.abs(above - below) / (ends[1, place] - ends[0, place]) * size)


def _sizes(parameters: tuple[Parameter, ...], values: Array) -> Array:
    """Return what counts as a change of each parameter by its whole size."""
    return np.array(
        [
            min(parameter.width, max(abs(value), 1e-12))
            for parameter, value in zip(parameters, values.tolist(), strict=True)
        ]
    )
