"""The quantities of a result by name, for tables, figures and measured values."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.impact.scene import Scene
from contactlab.numeric.checks import nearest, refuse
from contactlab.outcome.export import COLUMNS, unit_in
from contactlab.outcome.result import ImpactResult


class Quantity(NamedTuple):
    """A named quantity of a result, its unit, and how it is read."""

    name: str
    unit: str
    read: Callable[[ImpactResult], Any]

    def unit_in(self, scene: Scene) -> str:
        """Return the unit that its numbers have in ``scene``."""
        return unit_in(self.unit, scene)

    def of(self, result: ImpactResult) -> NDArray[np.float64]:
        """Return it as an array of the scene's shape; NaN where it is not defined."""
        value = self.read(result)
        number = np.nan if value is None else value
        return np.array(np.broadcast_to(np.asarray(number, dtype=np.float64), result.scene.shape))


def _in_degrees(read: Callable[[ImpactResult], Any]) -> Callable[[ImpactResult], Any]:
    def converted(result: ImpactResult) -> Any:
        value = read(result)
        return None if value is None else np.degrees(value)

    return converted


def numeric_columns() -> dict[str, Quantity]:
    """Return the columns of the exports that are numbers, by name.

    Angles are there in degrees too, and so is the rebound speed.
    """
    found = {}
    for name, unit, read in COLUMNS:
        if name == "status":
            continue
        found[name] = Quantity(name, unit, read)
        if unit == "rad":
            found[f"{name}_deg"] = Quantity(f"{name}_deg", "deg", _in_degrees(read))
    found["rebound_speed"] = Quantity("rebound_speed", "m/s", _rebound_speed)
    return found


def _rebound_speed(result: ImpactResult) -> Any:
    """Return the speed of the centre after the impact, which is what many rigs measure."""
    tangential = result.rebound_tangential_velocity
    return None if tangential is None else np.hypot(result.rebound_normal_velocity, tangential)


QUANTITIES = numeric_columns()


def quantity_named(name: str, *, where: str = "quantity") -> Quantity:
    """Return a quantity by name: any column of the exports, angles also with ``_deg``.

    Raises
    ------
    ValueError
        If there is none, with the nearest match.
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    remedy = f"{nearest(name, QUANTITIES)}known: {', '.join(QUANTITIES)}"
    raise refuse(where, name, "is not a quantity of a result", remedy)
