"""The values of a plug-in's column, NaN and told where its function fails."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Protocol

import numpy as np

from contactlab.impact.scene import Scene
from contactlab.numeric.names import quote
from contactlab.registration.hooks import short
from contactlab.registration.installed import PluginWarning

HISTORY = "history"


class WithScene(Protocol):
    """Argument of columns and functions of plug-ins: the result of an impact or of a batch."""

    @property
    def scene(self) -> Scene:
        """The scene, whose shape the columns have."""

    @property
    def history(self) -> object:
        """The history, false if there is none."""

    def __getitem__(self, index: int, /) -> WithScene: ...


def values_of(
    name: str,
    value: Callable[[Any], object],
    needs: Sequence[str],
    result: WithScene,
    *,
    words: bool = False,
) -> object:
    """Return the values of a function of a result, NaN and a warning for impacts where it fails.

    A function that needs a history has no value without a history.
    """
    if HISTORY in needs and not result.history:
        return None
    said: list[str] = []
    values = _evaluate(value if words else partial(_numbers, value), result, said)
    if said:
        many = f"{len(said)} of {math.prod(result.scene.shape)} impacts"
        text = f"column {name}: NaN for {many}, its function failed: {said[0]}"
        warnings.warn(text, PluginWarning, stacklevel=4)
    return values


def _numbers(value: Callable[[WithScene], object], result: WithScene) -> object:
    """Return the numbers of a function of a result; refuse other objects and other shapes."""
    given = value(result)
    shape = result.scene.shape
    if given is None or type(given) is float:
        return given
    try:
        numbers = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(f"it gave {quote(given)}, which is no number") from None
    if numbers.ndim and numbers.shape[: len(shape)] != shape:
        raise ValueError(f"it gave the shape {numbers.shape} for impacts of the shape {shape}")
    return given


def _evaluate(value: Callable[[WithScene], object], result: WithScene, said: list[str]) -> object:
    """Return the values of a function; where it fails for a batch it is asked for each impact."""
    shape = result.scene.shape
    try:
        return value(result)
    except Exception as error:
        if not shape:
            said.append(short(error))
            return np.nan
    numbers = np.full(shape, np.nan)
    for place in range(shape[0]):
        one = _evaluate(value, result[place], said)
        own = np.asarray(one).shape
        if own and own != shape[1:]:
            said.append(f"it gave the shape {own} for one impact of a batch")
            one = None
        numbers[place] = np.nan if one is None else one
    return numbers
