"""The exact law, compiled: ``contactlab_impact.h`` as a library built with the package."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array
from contactlab_laws import compiled
from contactlab_laws.compiled import library

#: Least error of a step: of the compiled law, and of Python's if much accuracy is asked for.
LEAST_ERROR = 5e-13
#: Steps of an impact before it is given up; a hard one takes 30, one of kappa = 1e6 some 10,000.
MOST_STEPS = 20_000
#: Below this psi1, psi2 is proportional to psi1; rounding would spoil smaller numbers.
LINEAR_BELOW = 1e-8
#: Statuses of impacts without an answer. ``MEMORY`` is that of all without a library, and of one
#: whose memory finds no room: Python's solver follows them. Scenes hold no numbers of the last, 4.
UNSETTLED, OUTGROWN, MEMORY = 1, 2, 3
#: Impacts of one call, a second at most: Ctrl-C is heard between two calls.
AT_A_TIME = 8192
#: Steps for which there is room at first.
ROOM = 64
#: Begin of words on an installation without the library.
BY_PYTHON = "Python, about 2 ms an impact"
#: Sentences on impacts without an answer, by status.
LOST = (
    "",
    "The contact neither ends nor settles in {} steps",
    "The velocities of a jam outgrow the numbers",
    "There is no room for the memory of the contact",
    "No bodies have such numbers",
)


def tell() -> str:
    """Return in words whether the library is used, and why not."""
    words = compiled.tell()
    return words if words == compiled.COMPILED else f"{BY_PYTHON}: {words}"


def follow(
    numbers: Array, tolerance: float, most: int = MOST_STEPS
) -> tuple[Array, NDArray[np.intc]]:
    """Return the ends of impacts, shape (7, impacts), and their statuses.

    Parameters
    ----------
    numbers : array, shape (4, impacts)
        psi1, chi, lam and eta of theory §14.
    tolerance : float
        Error of a step.
    most : int
        Steps after which an impact is given up.

    Returns
    -------
    tuple
        V, psi2 - psi1, work over 2.5 mu² v1²/(2 kappa W_nn), T, the largest u, compressions and
        steps; and 0, a place of ``LOST``, or ``MEMORY``, which is that of all without a library.
    """
    count = numbers.shape[1]
    if count > AT_A_TIME:
        begins = range(0, count, AT_A_TIME)
        parts = (follow(numbers[:, k : k + AT_A_TIME], tolerance, most) for k in begins)
        outs, statuses = zip(*parts, strict=True)
        return np.concatenate(outs, axis=1), np.concatenate(statuses)
    rows = np.empty((12, count))  # numbers, ends and statuses: an address takes a microsecond
    rows[:4] = numbers
    out, status = rows[4:11], rows[11].view(np.intc)[:count]
    if (found := library()) is None:
        status.fill(MEMORY)
    else:
        place, row = rows.ctypes.data, rows.strides[0]
        found.contactlab_impact_follow_all(
            count, place, tolerance, most, place + 4 * row, place + 11 * row
        )
    return out, status


def follow_one(
    numbers: Sequence[float], tolerance: float, most: int = MOST_STEPS
) -> tuple[Array, int, Array]:
    """Return the end of one impact, its status, and its steps as rows of ``steps.Steps``."""
    law, given = library(), np.array(numbers, dtype=np.float64)
    assert law is not None
    out, status, count = np.empty(7), ctypes.c_int(), ROOM
    rows = np.empty((0, law.contactlab_impact_width()))
    while count > len(rows):
        rows = np.empty((count, rows.shape[1]))
        count = law.contactlab_impact_follow_kept(
            given.ctypes.data, tolerance, most, count, rows.ctypes.data,
            out.ctypes.data, ctypes.byref(status),
        )  # fmt: skip
    return out, status.value, rows[:count]


def central(psi1: Array, chi: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return psi2 - psi1 and the work of spheres, shape (impacts,), and a mask of answers.

    Parameters
    ----------
    psi1, chi : array, shape (impacts,)
        Impacts that do not slip throughout.
    """
    numbers = np.zeros((4, psi1.size))
    least = np.copysign(np.maximum(np.abs(psi1), LINEAR_BELOW), psi1)
    numbers[0], numbers[1] = least, chi
    found, status = follow(numbers, LEAST_ERROR)
    share = psi1 / least
    return found[1] * share, found[2] * share * share, status == 0
