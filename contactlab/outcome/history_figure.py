"""Figure of a history: both forces over time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes

from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array
from contactlab.outcome.style import Width, curve_colour, figure_size, styled, zero_line


class Forces(Protocol):
    """The part of a history that is drawn."""

    @property
    def time(self) -> Array:
        """The instants."""

    @property
    def normal_force(self) -> Array:
        """The normal force at each."""

    @property
    def tangential_force(self) -> Array:
        """The tangential force at each."""

    def unit(self, name: str) -> str:
        """Return the unit of a column."""


def draw_history(axes: Axes | None, history: Forces, *, width: Width | None = None) -> Axes:
    """Draw normal and tangential force over time, in the units of the history."""
    force, time = history.unit("normal_force"), history.unit("time")
    with on_axes(axes, width) as drawn:
        zero_line(drawn)
        for number, (name, times, column) in enumerate(_curves(history)):
            curves = drawn.plot(times, column, color=curve_colour(number))
            curves[0].set_label(name)
        drawn.set_xlabel(f"time ({time})")
        drawn.set_ylabel(f"force ({force})")
        drawn.legend()
    return drawn


def _curves(history: Forces) -> Iterator[tuple[str, Array, Array]]:
    """Yield name, times and force of each curve; of several contacts those of each.

    The tangential force of a contact among several is the length of its vector.
    """
    time, normal, tangential = history.time, history.normal_force, history.tangential_force
    if tangential.ndim < 3:
        yield "normal force", time, normal
        yield "tangential force", time, tangential
        return
    for k in range(normal.shape[1]):
        when = time if time.ndim == 1 else time[:, k]
        yield f"contact {k}, normal force", when, normal[:, k]
        yield f"contact {k}, tangential force", when, np.hypot(*tangential[:, k].T)


@contextmanager
def on_axes(axes: Axes | None, width: Width | None) -> Iterator[Axes]:
    """Yield the Axes, or Axes of a new figure inside the style of the package."""
    if axes is not None and width is not None:
        raise refuse("width", width, "is that of a new figure", "leave it out where axes are given")
    if axes is not None:
        yield axes
        return
    from matplotlib import pyplot  # chooses a backend for the process

    size = None if width is None else figure_size(width)
    with styled(width=width):
        yield pyplot.subplots(figsize=size)[1]
