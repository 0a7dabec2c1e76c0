"""Options of laws that follow from the materials, or that have one number for each impact."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts.law import Law, law_kind
from contactlab.impact.bodies import normal_compliance
from contactlab.impact.material import Material
from contactlab.impact.of_speed import spread_over
from contactlab.impact.scene import Scene
from contactlab.numeric.named import split_heading
from contactlab.numeric.types import Array, Real


class Combined(NamedTuple):
    """How the option of a law follows from a property of two materials.

    Attributes
    ----------
    sentence : str
        The rule in words, for ``contactlab plugins show``.
    of : callable
        ``of(first, second, materials)`` returns the option from the property of the first body and
        of the second, each a float or an array over the impacts, and the two materials.
    """

    sentence: str
    of: Callable[[Any, Any, tuple[Material, Material]], Any]


def _by_compliance(first: Real, second: Real, materials: tuple[Material, Material]) -> Real:
    parts = map(normal_compliance, materials)
    one, other = parts
    return (first * one + second * other) / (one + other)


#: Each body's number weighted by its share of the approach, (1-nu²)/E: exact to first order for the
#: relaxation times of Kelvin-Voigt bodies in series, which move in that share.
BY_COMPLIANCE = Combined("the mean weighted by (1-nu²)/E", _by_compliance)
MEAN = Combined("the mean of both", lambda first, second, _: 0.5 * (first + second))
#: The square root of the product, as of surface energies.
GEOMETRIC_MEAN = Combined(
    "the square root of the product", lambda first, second, _: np.sqrt(first * second)
)


def number_in(law: Law, option: str, scene: Scene) -> Real:
    """Return an option of a law for the impacts of a scene, or of a part of it.

    A law reads an option so that is marked ``quantity(..., per_impact=True)``.

    Parameters
    ----------
    law : Law
    option : str
        Name of the option.
    scene : Scene
        One impact or a batch, as the law is given it.

    Returns
    -------
    float or array
        One number for all impacts, or an array of the scene's shape.

    Raises
    ------
    ValueError
        If the option has another shape than the scene.
    """
    value: Real = getattr(law, option)
    if not isinstance(value, np.ndarray):
        return value
    name = f"{law_kind(law)}.{option}"
    for heading, each in scene._options.items():
        if split_heading(heading)[0] == name:
            numbers: Array = each.numbers
            return numbers
    return spread_over(name, value, scene.shape)
