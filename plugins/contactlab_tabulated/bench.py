"""The time that an impact takes from the table."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from contactlab_tabulated.coordinates import LARGEST_CHI
from contactlab_tabulated.function import rebound

Array = NDArray[np.float64]

REPEATS = 7
SIZES = (1_000, 10_000, 100_000, 1_000_000)
SINGLES = 1_000


def mixed(count: int) -> tuple[Array, Array]:
    """Return impacts over all of chi, psi1 up to a little beyond the beginning of full slip."""
    rng = np.random.default_rng(7)
    chi = rng.uniform(0.01, LARGEST_CHI, count)
    return rng.uniform(0.0, 1.05 * np.maximum(1.0, 4.0 * chi - 1.0)), chi


def bench() -> list[tuple[str, float]]:
    """Return names and nanoseconds an impact, the least of some repeats."""
    rows = []
    for count in SIZES:
        psi1, chi = mixed(count)
        least = _least(partial(rebound, psi1, chi))
        rows.append((f"{count} together", 1e9 * least / count))
    least = _least(partial(rebound, psi1, chi, derivatives=True))
    rows.append((f"{count} with derivatives", 1e9 * least / count))
    pairs = list(zip(psi1[:SINGLES].tolist(), chi[:SINGLES].tolist(), strict=True))

    def singly() -> None:
        for pair in pairs:
            rebound(*pair)

    rows.append(("one at a time", 1e9 * _least(singly) / SINGLES))
    return rows


def _least(call: Callable[[], object]) -> float:
    times = []
    for _ in range(REPEATS):
        began = perf_counter()
        call()
        times.append(perf_counter() - began)
    return min(times)
