"""Which further measurement would determine a parameter, found by the model itself."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.model import Model
from contactlab.fitting.parameters import Parameter
from contactlab.impact.scene import Scene

Array = NDArray[np.float64]

#: A change of a parameter by its whole size that moves no measured quantity by this share of
#: that quantity's size has no effect; derivatives are good to about 1e-6.
NO_EFFECT = 1e-4
#: Angles of incidence and, without bodies, psi1 at which a further measurement is thought of.
ANGLES_DEG = np.array(
    [1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0]
)
INCIDENCES = np.array([0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0])
#: Quantities that are thought of, all without unit.
THOUGHT_OF = ("normal_restitution", "tangential_restitution")
#: Share of the greatest effect that a measurement is worth while with.
WORTH = 0.5


def telling_apart(model: Model, both: Array) -> str:
    """Return a sentence on which measurement differs most between two sets of values."""
    scene, x, words = _thought_of(model.setup.scene)
    name = THOUGHT_OF[1] if scene.sphere is not None else "psi2"
    one, other = model.at(scene).predicted(both, [name])[name]
    best = int(np.argmax(np.abs(one - other)))
    return (
        f"measure {name} at {words} of about {x[best]:g}: {one[best]:.3g} of the first, "
        f"{other[best]:.3g} of the second."
    )


def advised(model: Model, values: Array, place: int) -> str:
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
    """Return how far a quantity moves if the parameter changes by its size, shape (impacts,).

    Parameters
    ----------
    model : Model
    values : array, shape (parameters,)
        Each in its parameter's unit.
    place : int
        Which parameter changes.
    quantity : str
        A measured quantity, by name.
    """
    parameter = model.parameters[place]
    size = sizes((parameter,), values[place : place + 1])[0]
    ends = np.array([values, values])
    ends[0, place] = max(values[place] - 0.05 * size, parameter.least)
    ends[1, place] = min(values[place] + 0.05 * size, parameter.most)
    below, above = model.predicted(ends, [quantity])[quantity]
    return np.asarray(np.abs(above - below) / (ends[1, place] - ends[0, place]) * size)


def sizes(parameters: tuple[Parameter, ...], values: Array) -> Array:
    """Return what counts as a change of each parameter by its whole size."""
    return np.array(
        [
            min(parameter.width, max(abs(value), 1e-12))
            for parameter, value in zip(parameters, values.tolist(), strict=True)
        ]
    )
