"""The exact law, compiled: ``contactlab_impact.h`` as a library that is built with the package."""

from __future__ import annotations

import ctypes
import hashlib
import os
from collections.abc import Sequence
from functools import cache
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array

#: 0 in this variable leaves the library out, at the build and at run time.
VARIABLE = "CONTACTLAB_COMPILED"
#: Name of the library beside this module, and the sources that it is built of, by package.
LIBRARY = "_impacts.so"
SOURCES = (("contactlab", "kernels/contactlab_impact.h"), ("contactlab_laws", "fronts/impacts.c"))
#: Least error of a step: of the compiled law, and of Python's if much accuracy is asked for.
LEAST_ERROR = 5e-13
#: Steps of an impact before it is given up; a hard one takes 30, one of kappa = 1e6 some 10,000.
MOST_STEPS = 20_000
#: psi2 is proportional to psi1 below it; smaller ones would be lost in rounding.
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
#: Words on an installation with the library.
COMPILED = "compiled"


def digest() -> str:
    """Return the digest of the installed sources."""
    content = hashlib.sha256()
    for package, path in SOURCES:
        content.update(resources.files(package).joinpath(path).read_bytes())
    return content.hexdigest()


def library() -> Any:
    """Return the library, or None where there is none or it is left out."""
    return _library(_wants_library())[0]


def told() -> str:
    """Return in words whether the library is used, and why not."""
    return _library(_wants_library())[1]


def _wants_library() -> bool:
    """Return whether the environment lets the library be used."""
    return os.environ.get(VARIABLE, "").strip().lower() not in ("0", "false", "no", "off")


@cache
def _library(wanted: bool) -> tuple[Any, str]:
    """Return the library, or None, and words about it."""
    if not wanted:
        return None, f"{BY_PYTHON}: {VARIABLE}=0 leaves the compiled solver out"
    again = "install contactlab again where there is a C compiler"
    with resources.as_file(resources.files(__package__).joinpath(LIBRARY)) as path:
        if not path.exists():
            return None, f"{BY_PYTHON}: the compiled solver was not built; {again}"
        try:
            found = ctypes.CDLL(str(path))
            built_of = found.contactlab_impact_sources
        except (OSError, AttributeError) as error:
            return None, f"{BY_PYTHON}: the compiled solver does not load ({error}); {again}"
    built_of.restype = ctypes.c_char_p
    try:
        sources = digest()
    except OSError:
        return None, f"{BY_PYTHON}: the sources of the compiled solver are not there; {again}"
    if built_of().decode() != sources:
        return None, f"{BY_PYTHON}: the compiled solver is older than its sources; {again}"
    pointer = ctypes.c_void_p  # ``ndpointer`` takes longer than an impact
    found.contactlab_impact_follow_all.argtypes = (
        ctypes.c_long, pointer, ctypes.c_double, ctypes.c_int, pointer, pointer,
    )  # fmt: skip
    found.contactlab_impact_follow_all.restype = None
    found.contactlab_impact_follow_kept.argtypes = (
        pointer, ctypes.c_double, ctypes.c_int, ctypes.c_long, pointer, pointer, pointer,
    )  # fmt: skip
    found.contactlab_impact_follow_kept.restype = ctypes.c_long
    return found, COMPILED


def follow(
    numbers: Array, tolerance: float, most: int = MOST_STEPS
) -> tuple[Array, NDArray[np.intc]]:
    """Return what impacts leave, shape (7, impacts), and their statuses.

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


def kept(
    numbers: Sequence[float], tolerance: float, most: int = MOST_STEPS
) -> tuple[Array, int, Array]:
    """Return what one impact leaves, its status, and its steps as rows of ``steps.Steps``."""
    law, given = library(), np.array(numbers, dtype=np.float64)
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
    """Return psi2 - psi1 and the work of spheres, shape (impacts,), and where they were found.

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
