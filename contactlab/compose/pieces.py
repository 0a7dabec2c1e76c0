"""Pieces of a sweep: consecutive impacts with columns of their plan and their motion."""

from __future__ import annotations

from typing import NamedTuple

from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.outcome.chunk_forms import Chunk
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import PlanColumns


class Part(NamedTuple):
    """A chunk before it is solved: its scene, and the impacts of one call."""

    chunk: Chunk
    scene: Scene
    block: int


class Piece(NamedTuple):
    """The columns of the plan and the motion of a chunk."""

    chunk: Chunk
    columns: PlanColumns
    motion: Motion


def unsolved(chunk: Chunk, axes: tuple[int, ...], status: Status, detail: str = "") -> Piece:
    """Return the piece of a chunk without answers: every impact has ``status``.

    ``axes`` are the scene's ``slip_axes``.
    """
    shape = (chunk.size,)
    nothing = Motion.nothing(shape, status, detail, axes=axes)
    return Piece(chunk, PlanColumns.nothing(shape), nothing)
