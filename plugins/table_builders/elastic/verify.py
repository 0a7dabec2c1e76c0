"""Judging the table by fresh exact impacts, a third of them on or beside singular curves."""

from __future__ import annotations

import sys
import time
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array
from contactlab_laws.tables.elastic import Table, values
from contactlab_laws.tables.patches import polynomial
from contactlab_laws.tables.regions import CUT_END, LARGEST_CHI, Cuts, places, slip_cut
from table_builders.elastic.coordinates import NAMES
from table_builders.elastic.exact import exact

#: Impacts between two reports of progress.
BATCH = 2000
#: Distances from singular curves: 10 to the power of anything between.
NEAREST, FARTHEST = -16.0, -2.0
LEAST_CHI = 1e-3
BESIDE_NAMES = (
    "beside psi1 = 1",
    "beside psi1 = 4 chi - 1",
    "beside chi = 1/2",
    "beside psi1 = 1, chi = 1/2",
    "beside the cut, stuck first",
    "beside the cut, slip first",
    "beside psi1 = 2 chi",
    "beside psi1 = 0",
    "beside chi = 5/2",
)


class Draws(NamedTuple):
    """Random impacts; ``kind`` is -1, or the number of the curve beside which they lie."""

    psi1: Array
    chi: Array
    kind: NDArray[np.intp]


class Errors(NamedTuple):
    """Errors of psi2, of max(1, psi1)."""

    name: str
    draws: int
    largest: float
    rms: float
    psi1: float
    chi: float


def draw(count: int, seed: int, cuts: Cuts) -> Draws:
    """Return random impacts with psi1 >= 0 and chi <= LARGEST_CHI.

    A third lies on or beside singular curves, a third where most impacts stick, a third
    anywhere up to a little beyond the beginning of full slip.
    """
    rng = np.random.default_rng(seed)
    chi = rng.uniform(LEAST_CHI, LARGEST_CHI, count)
    third = np.arange(count) % 3
    most = np.where(third == 1, 1.5, 1.05 * np.maximum(1.0, 4.0 * chi - 1.0))
    psi1 = most * rng.uniform(0.0, 1.0, count)
    distance = 10.0 ** rng.uniform(NEAREST, FARTHEST, (2, count))
    distance *= rng.choice((-1.0, 0.0, 1.0), (2, count), p=(0.48, 0.04, 0.48))
    here, beside = distance
    kind = np.where(third == 2, rng.integers(0, len(BESIDE_NAMES), count), -1)
    unit = rng.uniform(0.0, 1.0, count)
    t = CUT_END * rng.uniform(0.0, 1.0, count)
    for number, (psi1_there, chi_there) in enumerate(
        (
            (1.0 + here, chi),
            (4.0 * chi - 1.0 + here, chi),
            (unit, 0.5 + here),
            (1.0 + beside, 0.5 + here),
            (unit, polynomial(cuts.stuck, unit) + here),
            (None, slip_cut(cuts.slip, t) + here),
            (2.0 * chi + here, chi),
            (np.abs(here), chi),
            (psi1, LARGEST_CHI - np.abs(here)),
        )
    ):
        chosen = kind == number
        chi[chosen] = chi_there[chosen]
        chi[chosen] = np.minimum(chi[chosen], LARGEST_CHI)
        if psi1_there is None:
            psi1_there = 1.0 + t**5 * (2.0 * chi - 1.0)
        psi1[chosen] = np.abs(psi1_there[chosen])
    return Draws(psi1, chi, kind)


def verify(table: Table, *, count: int, seed: int, workers: int = 1) -> list[Errors]:
    """Return the errors over ``count`` fresh impacts: by region, by curve, and of all.

    Parameters
    ----------
    table : Table
    count, seed : int
        Impacts, and the seed that they are drawn with.
    workers : int
        Processes.
    """
    draws = draw(count, seed, table.cuts)
    truth = np.empty(count)
    began = time.monotonic()
    parts = [slice(first, first + BATCH) for first in range(0, count, BATCH)]
    given = ([draws.psi1[part] for part in parts], [draws.chi[part] for part in parts])
    with ExitStack() as stack:
        share = map
        if workers > 1:
            share = stack.enter_context(ProcessPoolExecutor(workers)).map  # type: ignore[assignment]
        for done, (part, answers) in enumerate(zip(parts, share(exact, *given), strict=True), 1):
            truth[part] = answers
            left = (time.monotonic() - began) * (len(parts) - done) / done
            print(f"{min(done * BATCH, count)} impacts, {left:.0f} s left", file=sys.stderr)
    return judge(table, draws, truth)


def judge(table: Table, draws: Draws, truth: Array) -> list[Errors]:
    """Return the errors of the table against ``truth``."""
    error = np.abs(values(table, draws.psi1, draws.chi) - truth) / np.maximum(1.0, draws.psi1)
    region = np.full(error.size, len(NAMES))
    here = places(draws.psi1, draws.chi, table.cuts)
    region[here.who] = here.region
    groups = [(name, (region == k) & (draws.kind < 0)) for k, name in enumerate(NAMES)]
    groups.append(("slips throughout", (region == len(NAMES)) & (draws.kind < 0)))
    groups += [(name, draws.kind == k) for k, name in enumerate(BESIDE_NAMES)]
    groups.append(("all", np.ones(error.size, dtype=bool)))
    return [_errors(name, error, draws, chosen) for name, chosen in groups if chosen.any()]


def _errors(name: str, error: Array, draws: Draws, chosen: NDArray[np.bool_]) -> Errors:
    """Return the largest and the rms error of the draws chosen, and where the largest is."""
    worst = int(np.flatnonzero(chosen)[error[chosen].argmax()])
    return Errors(
        name,
        int(chosen.sum()),
        float(error[worst]),
        float(np.sqrt(np.mean(error[chosen] ** 2))),
        float(draws.psi1[worst]),
        float(draws.chi[worst]),
    )
