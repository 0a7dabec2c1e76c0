"""The normal motion of viscoelastic impacts, in steps of a smooth coordinate (theory §15)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab.numeric.types import Array

#: Newton's method finds the x at the end of each phase, in so many turns, each a march of so many
#: steps. It begins at FIRST times a power of 1 + a, which is right to 3 %.
TURNS, STEPS = 4, 192
FIRST, LOADING, UNLOADING = 1.2537, -0.085, 0.78
#: Least steps of Runge and Kutta in a phase: each of ``course`` is divided for as many.
LEAST = 192


class Course(NamedTuple):
    """Normal motions in scaled units, a column each.

    Attributes
    ----------
    duration : array, shape (steps, motions)
        Duration of each step.
    rate, radius, top : array, shape (steps + 1, motions)
        V, b and b² + a V; in unloading b².
    turn : int
        The sample at which V = 0.
    """

    duration: Array
    rate: Array
    radius: Array
    top: Array
    turn: int


def course(number: Array, steps: int) -> Course:
    """Return the motions at relaxation times a, shape (motions,), in an even number of steps."""
    # dT = 2b dx: loading b' = V, V' = -2.5 b (b³ + 1.5 a V b); unloading b' = V - 1.25 a b³,
    # V' = -2.5 b⁴, until b = 0. Both are polynomials, and V = 0 and b = 0 are samples.
    half, start = steps // 2, np.zeros((2, number.size))
    start[1] = 1.0
    loading = _ends(number, start, loads=True)
    first = _samples(number, start, loading, half, loads=True)
    first[-1, 1] = 0.0
    unloading = _ends(number, first[-1, :2], loads=False)
    second = _samples(number, first[-1, :2], unloading, half, loads=False)
    second[-1, 0] = 0.0
    radius, rate, duration = np.concatenate((first, second[1:])).swapaxes(0, 1)
    top = radius**2 + number * np.maximum(rate, 0.0)
    duration = np.concatenate((np.diff(first[:, 2], axis=0), np.diff(second[:, 2], axis=0)))
    return Course(duration, rate, radius, top, half)


def _ends(number: Array, start: Array, *, loads: bool) -> Array:
    """Return x at the end of a phase, where V or b vanishes."""
    end = FIRST * (1.0 + number) ** (LOADING if loads else UNLOADING)
    for _ in range(TURNS):
        last = _samples(number, start, end, STEPS, loads=loads)[-1, :2]
        slope = _slope(last, number, loads)
        end = end - (last[1] / slope[1] if loads else last[0] / slope[0])
    return np.asarray(end)


def _samples(number: Array, start: Array, end: Array, steps: int, *, loads: bool) -> Array:
    """Return (b, V, T) in equal steps of x, shape (steps + 1, 3, motions)."""
    samples, parts = np.zeros((steps + 1, 3, number.size)), -(-LEAST // steps)
    samples[0, :2] = state = start
    time, width = np.zeros(number.size), end / (steps * parts)
    for step in range(1, steps + 1):
        for _ in range(parts):
            k1 = _slope(state, number, loads)
            s2 = state + 0.5 * width * k1
            k2 = _slope(s2, number, loads)
            s3 = state + 0.5 * width * k2
            k3 = _slope(s3, number, loads)
            s4 = state + width * k3
            k4 = _slope(s4, number, loads)
            time = time + width / 3.0 * (state[0] + 2.0 * (s2[0] + s3[0]) + s4[0])
            state = state + width / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        samples[step, :2], samples[step, 2] = state, time
    return samples


def _slope(state: Array, number: Array, loads: bool) -> Array:
    """Return d(b, V)/dx."""
    b, rate = state
    cube = b * b * b
    if loads:
        return np.stack((rate, -2.5 * b * (cube + 1.5 * number * rate * b)))
    return np.stack((rate - 1.25 * number * cube, -2.5 * b * cube))
