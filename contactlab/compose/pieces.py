"""Pieces of a sweep: consecutive impacts with columns of their plan and their motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from contactlab.contracts.eccentric import EccentricMotion
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import PlanColumns


class Chunk(NamedTuple):
    """The impacts from ``first`` up to, but not including, ``stop``: whole blocks of a sweep."""

    first: int
    stop: int

    @property
    def size(self) -> int:
        """Number of impacts."""
        return self.stop - self.first


class Piece(NamedTuple):
    """The columns of the plan and the motion of a chunk: a Motion, or an EccentricMotion.

    The plan of eccentric impacts has no columns.
    """

    chunk: Chunk
    columns: PlanColumns
    motion: Any


#: What returns a piece, from laws, the chunk's scene, the chunk, and the impacts of a block.
Solve: TypeAlias = Callable[[Any, Any, Chunk, int], Piece]


def unsolved(chunk: Chunk, scene: Any, status: Status, detail: str = "") -> Piece:
    """Return the piece of a chunk of ``scene`` without answers: every impact has ``status``."""
    kind: Any = Motion if isinstance(scene, Scene) else EccentricMotion
    shape = (chunk.size,)
    return Piece(chunk, PlanColumns.nothing(shape), kind.nothing(shape, status, detail))
