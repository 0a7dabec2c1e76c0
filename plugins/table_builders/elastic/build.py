"""Building the table: cells are split until each holds g to the tolerance."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import attrs
import numpy as np
from numpy.typing import ArrayLike

from contactlab.numeric.types import Array
from contactlab_laws.tables.elastic import DEEPEST, NODES
from contactlab_laws.tables.file import Stored, write
from contactlab_laws.tables.regions import REGIONS, SLIP_BACK, SLIP_ON, Cuts
from table_builders.elastic import cuts as curves
from table_builders.elastic.exact import exact
from table_builders.elastic.fit import Cell, begins_at_one, fit, slope_at_one

Solve = Callable[[Array, Array], Array]

#: Error of psi2/psi1 that a cell may show; what it hides is a few times more.
TOLERANCE = 1e-10
#: Least level along a of SLIP_BACK's cells at psi1 = 1, and of those far above the cut: in longer
#: ones the high powers of t in the cut would be seen in d psi2/d psi1 there.
SHORT = 3
#: Cells between two saves.
BATCH = 16
#: An error this much smaller than the other is no reason to split along its coordinate.
MINOR = 0.01


@attrs.define
class Progress:
    """Cells done and cells left, with their terms; may be kept in a file."""

    cuts: Cuts
    todo: list[Cell]
    done: list[Cell]
    terms: list[Array]

    @classmethod
    def begin(cls, path: Path) -> Progress:
        """Return the progress kept at ``path``, or a new one."""
        if path.exists():
            with np.load(path) as kept:
                return cls(
                    Cuts(*(kept[name] for name in Cuts._fields)),
                    [Cell(*row) for row in kept["todo"].tolist()],
                    [Cell(*row) for row in kept["done"].tolist()],
                    list(kept["terms"]),
                )
        print("finding the cuts", file=sys.stderr, flush=True)
        cells = [Cell(region, 0, 0, 0, 0) for region in range(REGIONS) if region != SLIP_ON]
        cells += Cell(SLIP_ON, 0, 0, 0, 0).split(True, True)  # none crosses the seam
        for level in range(SHORT):
            for first in (Cell(SLIP_BACK, level, 0, 0, 0), Cell(SLIP_ON, level, 1, 0, 1)):
                if first in cells:
                    cells.remove(first)
                    cells += first.split(True, False)
        return cls(curves.find(), cells, [], [])

    def keep(self, path: Path) -> None:
        """Write this progress to ``path``."""
        with path.open("wb") as file:
            np.savez(
                file,
                **self.cuts._asdict(),
                todo=np.array(self.todo, dtype=np.int64).reshape(-1, 5),
                done=np.array(self.done, dtype=np.int64).reshape(-1, 5),
                terms=np.array(self.terms).reshape(-1, NODES, NODES),
            )

    @property
    def part(self) -> float:
        """The part of all regions that is done."""
        return sum(cell.area for cell in self.done) / REGIONS


def build(path: Path, *, tolerance: float = TOLERANCE, workers: int = 1) -> None:
    """Write the table to ``path``; what an earlier, interrupted call did is used.

    Parameters
    ----------
    path : Path
        Beside it lies, until the end, a file of what is done.
    tolerance : float
        Error of psi2/psi1 that a cell may show at its last Chebyshev coefficients.
    workers : int
        Processes.
    """
    kept = path.with_suffix(".part.npz")
    progress = Progress.begin(kept)
    began, first = time.monotonic(), progress.part
    with ExitStack() as stack:
        solve: Solve = exact
        if workers > 1:
            pool = stack.enter_context(ProcessPoolExecutor(workers))
            solve = partial(_compute, pool.map, workers)
        while progress.todo:
            _batch(progress, tolerance, solve)
            progress.keep(kept)
            spent, part = time.monotonic() - began, progress.part
            left = spent * (1.0 - part) / (part - first) if part > first else np.inf
            print(
                f"{len(progress.done)} patches, {100 * part:.1f} %, {left:.0f} s left",
                file=sys.stderr,
                flush=True,
            )
    order = sorted(range(len(progress.done)), key=progress.done.__getitem__)
    cells = np.array([progress.done[k] for k in order], dtype=np.int16)
    terms = np.array([progress.terms[k] for k in order])
    arrays: dict[str, ArrayLike] = {**progress.cuts._asdict(), "cells": cells, "terms": terms}
    write(path, Stored.today(tolerance=tolerance, **arrays))
    kept.unlink()


def _batch(progress: Progress, tolerance: float, solve: Solve) -> None:
    """Fit some cells, and split those that do not fit."""
    cells = progress.todo[-BATCH:]
    del progress.todo[-BATCH:]
    places = [cell.nodes(progress.cuts) for cell in cells]
    psi1 = np.stack([place[0] for place in places])
    chi = np.stack([place[1] for place in places])
    psi2 = solve(psi1.ravel(), chi.ravel()).reshape(psi1.shape)
    for cell, p, x, answers in zip(cells, psi1, chi, psi2, strict=True):
        slope = slope_at_one(cell, progress.cuts, solve) if begins_at_one(cell) else None
        patch = fit(cell, progress.cuts, p, x, answers, slope)
        most = max(patch.error_a, patch.error_b)
        along_a = patch.error_a > max(tolerance, MINOR * most) and cell.level_a < DEEPEST
        along_b = patch.error_b > max(tolerance, MINOR * most) and cell.level_b < DEEPEST
        if along_a or along_b:
            parts = cell.split(bool(along_a), bool(along_b))
            progress.todo.extend(part for part in parts if part.needs(progress.cuts))
        else:
            if most > tolerance:
                print(f"{cell} is left at {most:.1e}", file=sys.stderr)
            progress.done.append(cell)
            progress.terms.append(patch.terms)


def _compute(share: Callable[..., Iterable[Array]], workers: int, psi1: Array, chi: Array) -> Array:
    """Return answers of ``exact``, computed by as many processes behind the mapping ``share``."""
    parts = 8 * workers
    return np.concatenate(
        list(share(exact, np.array_split(psi1, parts), np.array_split(chi, parts)))
    )
