"""Sweeps: a batch cut into blocks that depend on the laws alone, solved here or by an executor."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Generator, Iterable, Iterator
from contextlib import AbstractContextManager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from contactlab.contracts.status import Status
from contactlab.impact import batches, kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse, whole
from contactlab.outcome.chunk_forms import Chunk, find_gaps
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import PlanColumns
from contactlab.registry.composition import Laws
from contactlab.runs.pieces import Part, Piece, leave_open, solve_chunk
from contactlab.solve.solve import refuse_gathering

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from contactlab.numeric.progress import Count
    from contactlab.runs.kept import Kept

#: Impacts of a block if nothing is marched: as many as fit into the cache.
WHOLE_IMPACTS = 1 << 14
#: Impacts of a block that are marched: a call costs little, an interruption loses little.
MARCHED = 1000


def block_for(laws: Laws, scene: Scene) -> int:
    """Return how many impacts of a scene are solved in one call."""
    # The last bits of an answer may depend on the impacts beside it: on the iterations of an array
    # solver, and on whether the processor uses scalar or vector arithmetic. So the size of a block
    # depends on the laws alone.
    able = laws.capability
    if able.path is not None:
        return able.path.cost(scene, laws.capability.accuracy).block
    known = able.closed is not None and able.whole is not None
    return WHOLE_IMPACTS if known else MARCHED


def solve_parts(
    laws: Laws, parts: Iterable[Part], executor: Executor | None, *, ahead: int | None = None
) -> Generator[Piece, None, None]:
    """Yield the pieces of parts, solved here or by an executor; ``ahead`` as in ``pieces_of``."""
    if executor is None:
        return (solve_chunk(laws, scene, chunk, block) for chunk, scene, block in parts)
    from contactlab.runs.workers import pieces_of  # needed with an executor only

    return pieces_of(laws, parts, executor, ahead=ahead)


def sweep_columns(
    laws: Laws,
    scene: Scene,
    *,
    progress: Count | None,
    chunk: int | None,
    executor: Executor | None,
    keep: str | Path | None,
    return_partial: bool,
) -> tuple[PlanColumns, Motion]:
    """Return columns of the plan and motion of a batch of one axis; see ``Simulation.sweep``."""
    size, block = scene.shape[0], block_for(laws, scene)
    step = math.ceil(whole("chunk", block if chunk is None else chunk) / block) * block
    solve = partial(solve_parts, laws, executor=executor)
    plain = batches.drop_varying(scene)
    with _keep_pieces(keep, laws, scene, block) as kept:
        finished = [] if kept is None else kept.pieces()
        done = sum(piece.chunk.size for piece in finished)
        missing = cut(find_gaps([piece.chunk for piece in finished], size), step)
        parts = (Part(each, plain.take(slice(*each)), block) for each in missing)
        pieces = solve(parts)
        try:
            if kept is not None:
                kept.compare([*finished], block, solve)
            for piece in pieces:
                finished.append(piece)
                if kept is not None:
                    kept.keep(piece)
                done += piece.chunk.size
                if progress is not None:
                    progress(done, size)
        except KeyboardInterrupt as error:
            if kept is not None and finished:
                kept.keep(finished[-1])  # the interruption may have stopped its writing
            if not return_partial:
                where = f" are in {keep}: the same sweep goes on" if keep else ""
                raise type(error)(f"{done} of {size} impacts{where}") from None
            gaps = find_gaps([piece.chunk for piece in finished], size)
            finished += [
                leave_open(gap, kinetics.slip_axes(scene), Status.INTERRUPTED) for gap in gaps
            ]
        finally:
            pieces.close()
    finished.sort(key=lambda piece: piece.chunk)
    columns = PlanColumns.join([piece.columns for piece in finished], (size,))
    return columns, Motion.join([piece.motion for piece in finished], (size,))


def _keep_pieces(
    keep: str | Path | None, laws: Laws, scene: Scene, block: int
) -> AbstractContextManager[Kept | None]:
    """Return a context with the folder of finished pieces, or with None."""
    if keep is None:
        return contextlib.nullcontext()
    from contactlab.runs.kept import keep_in  # needed with ``keep`` only

    return keep_in(keep, laws, scene, block)


def one_axis(scene: Scene) -> None:
    """Refuse a scene that is not a batch of one axis."""
    refuse_gathering(scene)
    if len(scene.shape) != 1:
        rule = "must be a sequence, or a one-dimensional batch"
        raise refuse("scenes", scene.shape, rule, "for one impact use run")


def cut(gaps: Iterable[Chunk], step: int) -> Iterator[Chunk]:
    """Yield the gaps in chunks of at most ``step`` impacts."""
    for gap in gaps:
        for first in range(gap.first, gap.stop, step):
            yield Chunk(first, min(first + step, gap.stop))
