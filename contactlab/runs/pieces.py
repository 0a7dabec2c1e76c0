"""Pieces of a sweep: consecutive impacts with columns of their plan and their motion."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.outcome.chunk_forms import Chunk
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import PlanColumns
from contactlab.registry.composition import Laws
from contactlab.solve.solve import outcome, ways
from contactlab.solve.way import blocks

#: Variables that set the number of threads of BLAS, the strongest first.
THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")


class Part(NamedTuple):
    """A chunk before it is solved: its scene, and the impacts of one call."""

    chunk: Chunk
    scene: Scene
    block: int


class Piece(NamedTuple):
    """The columns of the plan and the motion of a chunk.

    ``computer`` is the processor, NumPy and threads. A piece that the executor lost is not
    ``solved``, so that the same sweep tries it again.
    """

    chunk: Chunk
    columns: PlanColumns
    motion: Motion
    computer: str = ""
    solved: bool = True

    @classmethod
    def join(cls, pieces: Sequence[Piece]) -> Piece:
        """Return the piece of consecutive chunks, in order."""
        chunk = Chunk(pieces[0].chunk.first, pieces[-1].chunk.stop)
        return cls(
            chunk,
            PlanColumns.join([piece.columns for piece in pieces], (chunk.size,)),
            Motion.join([piece.motion for piece in pieces], (chunk.size,)),
            next((piece.computer for piece in pieces if piece.computer), ""),
        )


def solve_chunk(laws: Laws, scene: Scene, chunk: Chunk, block: int) -> Piece:
    """Return the piece of a sweep's chunk, a block at a time; ``scene`` is the chunk alone."""
    scenes = (scene.take(place) for place in blocks(chunk.size, block))
    pieces = (outcome(ways(laws, each), each, False, None) for each in scenes)
    columns, motions = zip(*pieces, strict=True)
    shape = (chunk.size,)
    joined = PlanColumns.join(columns, shape), Motion.join(motions, shape)
    return Piece(chunk, *joined, computer())


def leave_open(chunk: Chunk, axes: tuple[int, ...], status: Status, detail: str = "") -> Piece:
    """Return the piece of a chunk without answers: every impact has ``status``.

    ``axes`` are the scene's ``slip_axes``.
    """
    shape = (chunk.size,)
    nothing = Motion.nothing(shape, status, detail, axes=axes)
    return Piece(chunk, PlanColumns.nothing(shape), nothing, solved=False)


@cache
def computer() -> str:
    """Return what the last bits of a number depend on: processor, NumPy, threads of BLAS."""
    found = np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
    processor = ", ".join([platform.machine(), *found[-1:]])
    threads = next(filter(None, map(os.environ.get, THREADS)), os.cpu_count())
    return f"{platform.node()} ({processor}, NumPy {np.__version__}, {threads} BLAS threads)"
