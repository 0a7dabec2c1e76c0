"""Pieces of a sweep: consecutive impacts with their plan and their motion."""

from __future__ import annotations

from typing import NamedTuple

from contactlab.compose import solve
from contactlab.compose.composition import Laws
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import Plan


class Chunk(NamedTuple):
    """The impacts from ``first`` up to, but not including, ``stop``: whole blocks of a sweep."""

    first: int
    stop: int

    @property
    def size(self) -> int:
        """Number of impacts."""
        return self.stop - self.first


class Piece(NamedTuple):
    """The plan and the motion of a chunk."""

    chunk: Chunk
    plan: Plan
    motion: Motion


def solved(laws: Laws, scene: Scene, chunk: Chunk, block: int) -> Piece:
    """Return the piece of a chunk, ``block`` impacts at a time; ``scene`` is the chunk alone."""
    plans, motions = zip(
        *(
            solve.outcome(
                laws, scene.take(slice(first, min(first + block, chunk.size))), False, None
            )
            for first in range(0, chunk.size, block)
        ),
        strict=True,
    )
    return Piece(chunk, Plan.joined(plans), Motion.joined(motions, (chunk.size,)))


def unsolved(chunk: Chunk, status: Status, detail: str = "") -> Piece:
    """Return the piece of a chunk without answers: every impact has ``status``."""
    shape = (chunk.size,)
    return Piece(chunk, Plan.nothing(shape), Motion.nothing(shape, status, detail))
