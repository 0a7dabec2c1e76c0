"""Sweeps into a folder: one part after another, each written as soon as it is solved."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contactlab.impact import batches
from contactlab.impact.grid import GridParts
from contactlab.impact.scene import IMPACTS_AT_A_TIME, Scene
from contactlab.numeric.checks import of_kind, refuse, whole
from contactlab.outcome.chunk_forms import Chunk, form_of
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.sweep_folder import KIND, STATUSES, SweepFolder
from contactlab.registry.bound import bind
from contactlab.registry.composition import Laws
from contactlab.runs.fingerprints import fingerprint
from contactlab.runs.into_folder import NAMES, ChunkFolder
from contactlab.runs.pieces import Part, Piece
from contactlab.runs.sweep import WHOLE_IMPACTS, block_for, cut, one_axis, solve_parts
from contactlab.runs.target import check_folder, hold_folder
from contactlab.solve.solve import accept_scene

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from contactlab.numeric.progress import Count

#: Least impacts of a file where impacts are marched, which takes longer.
MARCHED_AT_A_TIME = 1000
#: Chunks that an executor has before they are answered: memory is that of so many.
AHEAD = 32


def sweep_into(
    laws: Laws,
    scenes: Scene | GridParts | Iterable[Scene],
    folder: str | Path,
    *,
    result_of: Callable[[Scene, Piece], ImpactResult],
    progress: Count | None,
    chunk: int | None,
    executor: Executor | None,
    return_partial: bool,
) -> SweepFolder:
    """Return the folder with the columns of a sweep; see ``Simulation.sweep``.

    ``result_of`` makes the result of a piece.
    """
    size = None if chunk is None else whole("chunk", chunk)
    of_kind("scenes", scenes, Scene, Iterable, rule="must be a Scene, or an iterable of them")
    later = _batches(scenes, size or MARCHED_AT_A_TIME)
    if (begin := next(later, None)) is None:
        remedy = "make the generator anew: it gives its scenes once"
        raise refuse("scenes", scenes, "must hold at least one Scene", remedy)
    given, (laws, _) = laws, bind(laws, begin)
    accept_scene(laws, begin)  # refused scenes make no folder
    form = form_of(check_folder("into", folder))
    more = {"form": KIND, STATUSES: " ".join(NAMES)}
    waiting: dict[Chunk, tuple[Scene, str, Scene]] = {}
    solve = partial(solve_parts, laws, executor=executor)
    done = stop = 0
    total, failed = _total(scenes), None

    def unsolved(target: ChunkFolder) -> Iterator[Part]:
        nonlocal failed
        try:
            yield from parts(target)
        except Exception as error:  # scenes failed: sent chunks come first
            failed = error

    def parts(target: ChunkFolder) -> Iterator[Part]:
        nonlocal done, stop
        for scene in itertools.chain([begin], later):
            _refuse_unlike(given, laws, scene)
            accept_scene(laws, scene)
            before, block = stop, block_for(laws, scene)
            usual = IMPACTS_AT_A_TIME if block == WHOLE_IMPACTS else MARCHED_AT_A_TIME
            step = math.ceil((size or usual) / block) * block
            stop += scene.shape[0]
            for place in cut([Chunk(0, scene.shape[0])], step):
                where = Chunk(before + place.first, before + place.stop)
                taken = scene.take(slice(*place))
                if not isinstance(scenes, Scene):  # the index in the whole sweep
                    taken = taken.with_index(np.arange(*where))
                part, mark = Part(where, batches.drop_varying(taken), block), fingerprint(taken)
                if target.holds(part._replace(scene=taken), mark):
                    done += where.size
                    continue
                target.compare(solve, result_of)
                waiting[where] = taken, mark, scene
                yield part
        target.compare(solve, result_of)

    with hold_folder("into", folder, laws, more, form) as (path, sweep):
        target = ChunkFolder(path, sweep, form)
        pieces = solve(unsolved(target), ahead=AHEAD)
        try:
            for piece in pieces:
                part, mark, whole_scene = waiting.pop(piece.chunk)
                if piece.solved:
                    target.write(piece, mark, result_of(part, piece), whole_scene)
                done += piece.chunk.size
                if progress is not None:
                    progress(done, total or done)
            if failed is not None:
                raise failed
            target.finish(stop)
        except KeyboardInterrupt as error:  # the folder tells that it is not complete
            if not return_partial:
                words = f"{done} impacts are in {folder}: the same sweep goes on"
                raise type(error)(words) from None
        finally:
            pieces.close()
    return SweepFolder(path)


def _refuse_unlike(given: Laws, laws: Laws, scene: Scene) -> None:
    """Refuse a batch for which materials give other options than for the first."""
    if bind(given, scene)[0] != laws:
        rule = "has materials whose properties give its laws other options than the first batch's"
        raise refuse("scenes", scene, rule, "sweep each into a folder of its own")


def _batches(scenes: Scene | Iterable[Scene], size: int) -> Iterator[Scene]:
    """Yield batches of one axis; single impacts are joined, ``size`` in a batch."""
    if isinstance(scenes, Scene):
        one_axis(scenes)
        yield scenes
        return
    singles: list[Scene] = []
    for position, scene in enumerate(scenes):
        of_kind(f"scenes[{position}]", scene, Scene)
        if not scene.shape:
            singles.append(scene)
        if singles and (scene.shape or len(singles) == size):
            yield Scene.stack(singles)
            singles = []
        if scene.shape:
            one_axis(scene)
            yield scene
    if singles:
        yield Scene.stack(singles)


def _total(scenes: Scene | GridParts | Iterable[Scene]) -> int | None:
    """Return the number of impacts, if scenes tell it."""
    if isinstance(scenes, GridParts):
        return scenes.impacts
    return math.prod(scenes.shape) if isinstance(scenes, Scene) else None
