"""Measured impacts of a table as the series of a scene file, to be drawn beside the laws."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.measurements import Measurements
from contactlab.scene_file import SceneFile
from contactlab.scene_file.measured import Measured

Array = NDArray[np.float64]

#: What was to be kept the same in a measurement varies by less than this share of itself.
SAME = 0.1


def with_measurements(file: SceneFile, table: Measurements) -> SceneFile:
    """Return a scene file with the impacts of a table in the place of its measured values.

    They are compared at the angles (or whatever else varies) of the table, and at what the scene
    says of the rest, such as its speed.

    Raises
    ------
    ValueError
        If the file has no sweep, if more than one column varies, or the speeds differ.
    """
    if not file.varied:
        raise ValueError(f"{file.path}: needs a [sweep] to draw measured values beside")
    moving = [name for name, values in table.given.items() if not _constant(values)]
    if len(moving) != 1:
        told = f"these vary by more than {SAME:.0%}: {', '.join(moving) or 'none'}"
        raise ValueError(f"{table.source}: one column must vary, such as angle_deg; {told}")
    _check_speed(file, table)
    x = table.given[moving[0]]
    return attrs.evolve(
        file, measured=tuple(_series(table, name, moving[0], x) for name in table.measured)
    )


def _constant(values: Array) -> bool:
    return bool(np.ptp(values) <= SAME * abs(float(np.mean(values))))


def _check_speed(file: SceneFile, table: Measurements) -> None:
    """Refuse a scene whose speed is not that of the measurement."""
    scene = file.scene
    own = {
        "speed": np.hypot(scene.normal_speed, scene.tangential_velocity),
        "normal_speed": np.asarray(scene.normal_speed),
    }
    for name in own.keys() & table.given.keys() - file.varied.keys():
        there, here = float(np.mean(table.given[name])), float(np.mean(own[name]))
        if abs(there - here) > SAME * there:
            raise ValueError(
                f"{table.source}: {name} is {there:.4g} m/s, and {here:.4g} m/s in {file.path}; "
                "write that of the measurement there"
            )


def _series(table: Measurements, quantity: str, against: str, x: Array) -> Measured:
    """Return the numbers of one quantity that were measured.

    Parameters
    ----------
    table : Measurements
    quantity, against : str
        What was measured, and the entry of the scene that varied.
    x : array, shape (n,)
        Of that entry.
    """
    values = table.measured[quantity]
    there = np.isfinite(values)
    errors = table.errors.get(quantity, np.zeros(len(values)))
    return Measured(
        quantity=quantity,
        against=against,
        x=x[there],
        values=values[there],
        x_error=np.zeros(int(there.sum())),
        error=errors[there],
        label="measured",
        source=table.source or "the data",
    )
