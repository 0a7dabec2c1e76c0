"""The processor time that an impact takes from the table, its arguments checked."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from time import process_time

import numpy as np
from numpy.typing import NDArray

from contactlab_tabulated.coordinates import LARGEST_CHI
from contactlab_tabulated.function import rebound

Array = NDArray[np.float64]

#: The least time of these is taken: other work on the machine disturbs the rest.
REPEATS = 15
SIZES = (1_000, 10_000, 100_000, 1_000_000)
SINGLES = 1_000


def mixed(count: int) -> tuple[Array, Array]:
    """Return impacts over all of chi, psi1 up to a little beyond the beginning of full slip."""
    rng = np.random.default_rng(7)
    chi = rng.uniform(0.01, LARGEST_CHI, count)
    return rng.uniform(0.0, 1.05 * np.maximum(1.0, 4.0 * chi - 1.0)), chi


def bench() -> list[tuple[str, float]]:
    """Return names and nanoseconds of processor time an impact."""
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
        began = process_time()
        call()
        times.append(process_time() - began)
    return min(times)
