"""The curves on which the sign of the last slip changes, found by bisection."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from contactlab.numeric.types import Array
from contactlab_laws.tables.regions import CUT_END, Cuts
from table_builders.elastic.coordinates import SLIP_POWERS, STUCK_POWERS
from table_builders.elastic.exact import last_slip

POINTS = 20
#: chi is found to 2^-HALVINGS; g is wrong by some (error of the cut)^(5/2) only.
HALVINGS = 24
#: chi between which the sign changes.
STUCK_RANGE, SLIP_RANGE = (1.4, 1.9), (1.7, 2.69)


def find() -> Cuts:
    """Return both cuts."""
    stuck = _fit(lambda psi1, _: psi1, 1.0, STUCK_RANGE, STUCK_POWERS)
    slip = _fit(lambda t, chi: 1.0 + t**5 * (2.0 * chi - 1.0), CUT_END, SLIP_RANGE, SLIP_POWERS)
    return Cuts(stuck, slip)


def _fit(
    psi1: Callable[[float, float], float],
    end: float,
    within: tuple[float, float],
    powers: Sequence[int],
) -> Array:
    """Return the terms of a cut: psi1 of argument (up to ``end``) and chi (``within``), powers."""
    nodes = 0.5 - 0.5 * np.cos(np.pi * (np.arange(POINTS) + 0.5) / POINTS)
    arguments = (end * nodes).tolist()
    chi = np.array([_bisect(psi1, argument, within) for argument in arguments])
    solved = np.linalg.lstsq(nodes[:, None] ** np.array(powers), chi, rcond=None)[0]
    terms = np.zeros(powers[-1] + 1)
    terms[list(powers)] = solved / end ** np.array(powers)
    return terms


def _bisect(
    psi1: Callable[[float, float], float], argument: float, within: tuple[float, float]
) -> float:
    low, high = within
    for _ in range(HALVINGS):
        chi = 0.5 * (low + high)
        if last_slip(psi1(argument, chi), chi) < 0:
            low = chi
        else:
            high = chi
    return 0.5 * (low + high)
