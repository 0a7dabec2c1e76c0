"""Whether measurements determine the parameters, and which further measurement would."""

from __future__ import annotations

import math

import attrs
import numpy as np

from contactlab.impact.body_contact import resolve_velocity
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real
from contactlab.outcome.columns import foreign
from contactlab_fit.intervals import Spread, spread
from contactlab_fit.model import Model
from contactlab_fit.parameters import Parameter, in_words
from contactlab_fit.problem import Problem

#: Singular value of the effects, each of unit length, below which parameters are
#: indistinguishable.
ALIKE = 1e-3
#: Largest half-width of a 95 % interval, as a share of the range, or else of the value; and a
#: half-width of a friction coefficient that is informative for any value.
VAGUE_IN_RANGE, VAGUE, SHARP = 0.5, 1.0, 0.05
#: Difference of Akaike's criterion below which a second minimum is as good as the first where no
#: number is left to tell the scatter by: at 4 the second is the right one one time in eight.
CLOSE = 4.0
#: A parameter has no effect if its full change moves no quantity by this share of the quantity's
#: size; derivatives are good to about 1e-6.
NO_EFFECT = 1e-4
#: Factors on a value at which numbers that turn there have changed.
TURNING = (0.9, 1.1)
#: Candidate angles of incidence, and candidate psi1 without bodies, for a further measurement.
ANGLES_DEG = np.array(
    [1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0]
)
INCIDENCES = np.array([0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0])
ANGLES_IN_WORDS = "angles of incidence (degrees)"
#: Candidate quantities for a further measurement, all dimensionless.
CANDIDATES = ("normal_restitution", "tangential_restitution")
#: Share of the greatest effect from which on a measurement is worth while.
WORTH = 0.5


def check_enough(problem: Problem) -> None:
    """Refuse fewer numbers than parameters by a ValueError."""
    numbers, parameters = sum(problem.counts.values()), problem.model.parameters
    if numbers < len(parameters):
        raise ValueError(
            f"{numbers} measured numbers cannot determine {len(parameters)} parameters; "
            "measure more impacts, or fit fewer"
        )


def check_defined(problem: Problem) -> None:
    """Refuse a number for an undefined quantity, such as e_t without tangential velocity.

    Raises
    ------
    ValueError
        With the quantity and the impact.
    """
    ends = np.array([[parameter.starts[0] for parameter in problem.model.parameters]])
    for name, residuals in problem.residuals(ends).items():
        lost = np.flatnonzero(np.isfinite(problem.measured[name]) & ~np.isfinite(residuals[0]))
        if lost.size and name in foreign():
            remedy = "write needs=('motion',) into its Column, or give simulation=Simulation()"
            table = f" by the table of rebounds; {remedy}" if problem.model.tabled else ""
            raise ValueError(f"{name}: its column has no number for impact {lost[0] + 1}{table}")
        if lost.size:
            raise ValueError(
                f"{name}: is not defined for impact {lost[0] + 1}, which divides by zero (no "
                "tangential velocity?); leave this cell empty"
            )


def check_scatter(problem: Problem) -> None:
    """Refuse a quantity with too few numbers to estimate its scatter.

    The parameters can meet as many numbers exactly. The residuals would then be zero, and with
    them the estimated error that weights the quantity beside the others. If the parameters meet
    all numbers, no weight matters.
    """
    exact = sum(problem.counts.values()) == len(problem.model.parameters)
    if len(problem.measured) == 1 or exact:
        return
    for name, count in problem.counts.items():
        if name not in problem.errors and count <= len(problem.model.parameters):
            raise ValueError(
                f"{name}: {count} numbers are too few to estimate their scatter; give a column "
                f"{name}_error, measure more, or do not fit {name} (--quantity)"
            )


def idle(problem: Problem, values: Array) -> list[str]:
    """Return the quantities that depend on no parameter; empty if no quantity depends on any.

    No parameter can meet such a quantity, for example a measured restitution under an elastic
    law. Its residuals would only hide how well the other quantities are met.
    """
    effects = problem.linearise(values, problem.sizes())[1]
    effects = np.abs(effects * _sizes(problem.model.parameters, values)).max(axis=1)
    parts = problem.by_quantity(effects)
    without_effect = [name for name, part in parts.items() if part.max() < NO_EFFECT]
    return without_effect if len(without_effect) < len(problem.measured) else []


def check_determined(problem: Problem, values: Array) -> None:
    """Refuse parameters without effect, or with indistinguishable effects, on the data."""
    parameters = problem.model.parameters
    effects = problem.linearise(values, problem.sizes())[1] * _sizes(parameters, values)
    lengths = np.sqrt(np.sum(effects**2, axis=0) / len(effects))
    for place, parameter in enumerate(parameters):
        if lengths[place] < NO_EFFECT and not _turns(problem, values, place):
            raise _refuse_free(
                problem.model, values, [place], f"no measured number depends on {parameter.name}"
            )
    unit = effects / np.sqrt(np.sum(effects**2, axis=0))
    _, singular, turned = np.linalg.svd(unit, full_matrices=False)
    if singular[-1] < ALIKE:
        places = np.flatnonzero(np.abs(turned[-1]) > 0.1).tolist()
        names = " and ".join(parameters[place].name for place in places)
        reason = f"a change of {names} together changes no measured number"
        raise _refuse_free(problem.model, values, places, reason)


def _turns(problem: Problem, values: Array, place: int) -> bool:
    """Return whether numbers depend on a parameter at a turning point, of derivative 0."""
    low, high = problem.bounds()
    points = np.tile(values, (3, 1))
    points[1:, place] = np.clip(values[place] * np.array(TURNING), low[place], high[place])
    moved = problem.weigh(points, problem.sizes())
    return bool(np.min(np.max(np.abs(moved[1:] - moved[0]), axis=1)) > NO_EFFECT)


def check_precise(problem: Problem, values: Array, ends: Spread) -> None:
    """Refuse parameters whose interval is too wide beside their range or value."""
    for place, parameter in enumerate(problem.model.parameters):
        value, reach = float(values[place]), float(ends.reaches[place])
        allowed = VAGUE_IN_RANGE * parameter.width
        if not math.isfinite(allowed):
            allowed = max(VAGUE * abs(value), SHARP)
        if reach > allowed:
            reason = (
                f"the measured numbers hardly depend on {parameter.name}: {value:.3g} ± {reach:.2g}"
            )
            raise _refuse_free(problem.model, values, [place], reason)


def check_single(problem: Problem, minima: list[Array], ends: Spread) -> None:
    """Refuse data that values outside the intervals meet about as well.

    Raises
    ------
    ValueError
        With each minimum that the F test does not part from the first, and its intervals.
    """
    best, *others = minima
    alike = [
        other for other in others if not ends.holds(other) and _meets(problem, other, best, ends)
    ]
    if not alike:
        return
    parameters = problem.model.parameters
    told = [_with_ends(parameters, best, ends)]
    told += [_with_ends(parameters, other, spread(problem, other, best)) for other in alike]
    names = " and ".join(parameter.name for parameter in parameters)
    remedy = _telling_apart(problem.model, np.array([best, alike[0]]))
    raise ValueError(
        f"the data do not determine {names}: the data fit as well with {' and '.join(told)}; "
        f"{remedy}"
    )


def _meets(problem: Problem, other: Array, best: Array, ends: Spread) -> bool:
    """Return whether the F test cannot tell other values from the best ones."""
    if math.isnan(ends.rise):
        return problem.criterion(other) - problem.criterion(best) < CLOSE
    scales = problem.scales(problem.residuals(best[None]))
    squares = np.sum(problem.weigh(np.array([best, other]), scales) ** 2, axis=1)
    return bool(squares[1] - squares[0] < ends.rise)


def _with_ends(parameters: tuple[Parameter, ...], values: Array, ends: Spread) -> str:
    """Return parameters with their values and intervals, in words."""
    if np.isnan(ends.low).any():
        return in_words(parameters, values)
    return ", ".join(
        f"{parameter.name} {value:.4g} (95 % {low:.4g} to {high:.4g})"
        for parameter, value, low, high in zip(parameters, values, ends.low, ends.high, strict=True)
    )


def _refuse_free(model: Model, values: Array, places: list[int], reason: str) -> ValueError:
    """Return the refusal of the parameters at ``places``, with the reason and a remedy."""
    names = " and ".join(model.parameters[place].name for place in places)
    remedy = " ".join(dict.fromkeys(_advise(model, values, place) for place in places))
    return ValueError(f"the data do not determine {names}: {reason}; {remedy}")


def _telling_apart(model: Model, both: Array) -> str:
    """Return a sentence on the measurement that differs most between two sets of values."""
    scene, x, words = _candidates(model.setup.scene)
    name = CANDIDATES[1] if words != "psi1" else "psi2"
    first, second = model.at(scene).predict(both, [name])[name]
    best = int(np.argmax(np.abs(first - second)))
    return (
        f"measure {name} at {words} of about {x[best]:g}: {first[best]:.3g} of the first, "
        f"{second[best]:.3g} of the second."
    )


def _advise(model: Model, values: Array, place: int) -> str:
    """Return a sentence on the measurement that depends most on a parameter."""
    parameter = model.parameters[place]
    scene, x, words = _candidates(model.setup.scene)
    names = CANDIDATES if words != "psi1" else ("normal_restitution", "psi2")
    effects = {name: _effect(model.at(scene), values, place, name) for name in names}
    greatest = {name: float(np.max(effect)) for name, effect in effects.items()}
    name = max(greatest, key=lambda key: greatest[key])
    if greatest[name] < NO_EFFECT:
        return f"no rebound of these laws depends on {parameter.name}: fix it, or choose others."
    worth = x[effects[name] >= WORTH * greatest[name]]
    if len(worth) == len(x):
        return f"measure {name} to determine {parameter.name}, at any {words}."
    best = x[int(np.argmax(effects[name]))]
    where = f"of about {best:g}"
    if len(worth) > 1:
        where = f"from {worth.min():g} to {worth.max():g}, best about {best:g},"
    return f"measure {name} at {words} {where} to determine {parameter.name}."


def _candidates(scene: Scene) -> tuple[Scene, Array, str]:
    """Return candidate impacts at the measured speed, their incidence, and its name."""
    if scene.along is not None:
        return _candidates_of_bodies(scene), ANGLES_DEG, ANGLES_IN_WORDS
    if scene.sphere is None and scene.has_units:
        one = scene.take(0).central
        slip, mu = INCIDENCES / one.psi_scale, one.friction_coefficient
        return Scene(None, None, mu, one.normal_speed, slip, pair=one.pair), INCIDENCES, "psi1"
    if scene.sphere is None:
        chi = float(np.median(scene.chi))
        return Scene.nondimensional(psi1=INCIDENCES, chi=chi), INCIDENCES, "psi1"
    speed: Real = np.hypot(scene.normal_speed, scene.tangential_velocity)
    angle = np.radians(ANGLES_DEG)
    first = scene.take(0)
    impacts = attrs.evolve(
        first,
        normal_speed=float(np.median(speed)) * np.cos(angle),
        tangential_velocity=float(np.median(speed)) * np.sin(angle),
        spin=0.0,
    )
    return impacts, ANGLES_DEG, ANGLES_IN_WORDS


def _candidates_of_bodies(scene: Scene) -> Scene:
    """Return candidate impacts of a body, on a surface at rest."""
    before = np.hypot(*resolve_velocity(scene, scene.encounter.velocity))
    speed, angle = float(np.median(before)), np.radians(ANGLES_DEG)[:, None]
    met = scene.encounter.take(0)
    n = met.normal / np.linalg.norm(met.normal)
    velocity = speed * (np.cos(angle) * n + np.sin(angle) * np.asarray(scene.along))
    rest = dict.fromkeys(("spin", "target_velocity", "target_spin"), np.zeros(3))
    met = attrs.evolve(met, velocity=velocity, **rest)
    impacts: Scene = attrs.evolve(met.scene, along=scene.along)
    return impacts


def _effect(model: Model, values: Array, place: int, quantity: str) -> Array:
    """Return how far a quantity moves if a parameter changes by its size, shape (impacts,)."""
    parameter = model.parameters[place]
    size = _sizes((parameter,), values[place : place + 1])[0]
    ends = np.array([values, values])
    ends[0, place] = max(values[place] - 0.05 * size, parameter.least)
    ends[1, place] = min(values[place] + 0.05 * size, parameter.most)
    below, above = model.predict(ends, [quantity])[quantity]
    return np.asarray(np.abs(above - below) / (ends[1, place] - ends[0, place]) * size)


def _sizes(parameters: tuple[Parameter, ...], values: Array) -> Array:
    """Return the full change of each parameter, shape (parameters,)."""
    return np.array(
        [
            min(parameter.width, max(abs(value), 1e-12))
            for parameter, value in zip(parameters, values.tolist(), strict=True)
        ]
    )
