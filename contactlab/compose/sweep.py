"""Sweeps: a batch cut into blocks that are always the same, solved here or by an executor."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from contactlab.contracts.normal import ClosedFormNormalLaw
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import WholeImpactTangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import whole
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import Plan

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from contactlab.compose.simulation import Simulation

#: Impacts of a block where nothing is marched: as many as fit into the cache.
WHOLE_IMPACTS = 1 << 14


class Chunk(NamedTuple):
    """Impacts ``first`` to ``stop``, without the last, of a sweep: some whole blocks of it."""

    first: int
    stop: int


class Piece(NamedTuple):
    """The plan and the motion of a chunk."""

    chunk: Chunk
    plan: Plan
    motion: Motion


def block_of(simulation: Simulation) -> int:
    """Return how many impacts are solved in one call.

    The last bits of an answer may depend on what is solved beside it: on the iterations of an
    array solver, and on which arithmetic, of scalars or of vectors, the processor has for a
    number. So a block depends on the laws alone.
    """
    whole_impacts = isinstance(simulation.tangential, WholeImpactTangentialLaw)
    if whole_impacts and isinstance(simulation.normal, ClosedFormNormalLaw):
        return WHOLE_IMPACTS
    return simulation.integrator.chunk(simulation.tangential)


def solved(simulation: Simulation, scene: Scene, chunk: Chunk, block: int) -> Piece:
    """Return the piece of a chunk, ``scene`` being that chunk alone, solved block by block.

    Parameters
    ----------
    simulation : Simulation
    scene : Scene
        A batch of one axis, of the chunk's length.
    chunk : Chunk
        Where it lies in the whole sweep.
    block : int
        Most impacts that are advanced together.
    """
    size = chunk.stop - chunk.first
    plans, motions = zip(
        *(
            simulation._outcome(scene.take(slice(first, min(first + block, size))), False, None)
            for first in range(0, size, block)
        ),
        strict=True,
    )
    return Piece(chunk, Plan.joined(plans), Motion.joined(motions, (size,)))


def unsolved(chunk: Chunk, status: Status, detail: str = "") -> Piece:
    """Return the piece of a chunk that there is no answer to."""
    shape = (chunk.stop - chunk.first,)
    return Piece(chunk, Plan.nothing(shape), Motion.nothing(shape, status, detail))


def swept(
    simulation: Simulation,
    scene: Scene,
    *,
    progress: Callable[[int, int], object] | None,
    chunk: int | None,
    executor: Executor | None,
    keep: str | Path | None,
) -> tuple[Plan, Motion]:
    """Return plan and motion of a one-dimensional batch; see ``Simulation.sweep``.

    Parameters
    ----------
    simulation : Simulation
    scene : Scene
        Of shape (n,).
    progress, chunk, executor, keep
        As ``Simulation.sweep`` has them.
    """
    size, block = scene.shape[0], block_of(simulation)
    step = math.ceil(whole("chunk", block if chunk is None else chunk) / block) * block
    kept = None
    if keep is not None:
        from contactlab.compose.kept import Kept  # only for those who keep

        kept = Kept(keep, simulation, scene, block)
    found = [] if kept is None else kept.pieces()
    done = sum(piece.chunk.stop - piece.chunk.first for piece in found)
    missing = _cut(_gaps(found, size), step)
    if executor is None:
        pieces = (solved(simulation, scene.take(slice(*each)), each, block) for each in missing)
    else:
        from contactlab.compose.executors import (
            pieces_of,  # only for those who share their work out
        )

        pieces = pieces_of(simulation, scene, list(missing), block, executor)
    try:
        for piece in pieces:
            if kept is not None:
                kept.keep(piece)
            found.append(piece)
            done += piece.chunk.stop - piece.chunk.first
            if progress is not None:
                progress(done, size)
    except KeyboardInterrupt:
        found += [unsolved(gap, Status.INTERRUPTED) for gap in _gaps(found, size)]
    finally:
        pieces.close()
    found.sort(key=lambda piece: piece.chunk)
    plan = Plan.joined([piece.plan for piece in found])
    return plan, Motion.joined([piece.motion for piece in found], (size,))


def _gaps(pieces: Iterable[Piece], size: int) -> list[Chunk]:
    """Return what no piece covers."""
    ends = [(0, 0), *sorted(piece.chunk for piece in pieces), (size, size)]
    return [
        Chunk(before, after)
        for (_, before), (after, _) in itertools.pairwise(ends)
        if before < after
    ]


def _cut(gaps: Iterable[Chunk], step: int) -> Iterator[Chunk]:
    for gap in gaps:
        for first in range(gap.first, gap.stop, step):
            yield Chunk(first, min(first + step, gap.stop))
