"""Figure of a history: both forces over time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from matplotlib.axes import Axes

from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array
from contactlab.outcome.style import Width, curve_colour, figure_size, styled, zero_line


class Forces(Protocol):
    """What is drawn of a history."""

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
        forces = (
            ("normal force", history.normal_force),
            ("tangential force", history.tangential_force),
        )
        for number, (name, column) in enumerate(forces):
            curves = drawn.plot(history.time, column, color=curve_colour(number))
            curves[0].set_label(name)
        drawn.set_xlabel(f"time ({time})")
        drawn.set_ylabel(f"force ({force})")
        drawn.legend()
    return drawn


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
