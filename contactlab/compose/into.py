"""Sweeps into a folder: one part after another, each written as soon as it is solved."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contactlab.compose.composition import Laws
from contactlab.compose.fingerprints import fingerprint
from contactlab.compose.kept import TRIED_AGAIN, checked_folder, opened, written_piece
from contactlab.compose.pieces import Part, Piece
from contactlab.compose.solve import accept_scene
from contactlab.compose.sweep import WHOLE_IMPACTS, block_for, cut, one_axis, solve_parts
from contactlab.contracts.status import Status, succeeded
from contactlab.impact.grid import GridParts
from contactlab.impact.scene import IMPACTS_AT_A_TIME, Scene
from contactlab.numeric.checks import of_kind, refuse, whole
from contactlab.outcome.chunk_files import (
    chunks_in,
    name_of,
    read_about,
    refuse_file,
    refuse_place,
)
from contactlab.outcome.chunk_forms import COLUMN_OF_STATUS, Chunk, form_of
from contactlab.outcome.columns import columns, unit_in
from contactlab.outcome.files import written
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.sweep_folder import KIND, STATUSES, SweepFolder, about_of

if TYPE_CHECKING:
    from concurrent.futures import Executor

#: Least impacts of a file where impacts are marched, which takes longer.
MARCHED_AT_A_TIME = 1000
#: Chunks that an executor has before they are answered: memory is that of so many.
AHEAD = 32
#: Codes of statuses; that of success is 0.
CODES = {status: code for code, status in enumerate(Status)}
NAMES = [status.name for status in Status]


class _Into:
    """A folder that a sweep is written into."""

    def __init__(self, folder: str | Path, laws: Laws) -> None:
        self.form = form_of(checked_folder("into", folder))
        more = {"form": KIND, STATUSES: " ".join(NAMES)}
        self.folder, self.sweep = opened("into", folder, laws, more, self.form)
        self.units: dict[str, str] | None = None
        self.found = dict(chunks_in("into", self.folder, self.form))

    def holds(self, chunk: Chunk, scene: str) -> bool:
        """Return whether a chunk is written; refuse a chunk of another scene or size."""
        for other in self.found:
            if other != chunk and other.first < chunk.stop and chunk.first < other.stop:
                rule = f"is of chunks of another size than impacts {chunk.first} to {chunk.stop}"
                remedy = "give scenes and chunk as before, or name another folder"
                raise refuse_file("into", self.found[other], rule, remedy)
        if chunk not in self.found:
            return False
        path = self.found[chunk]
        about = read_about(path, self.form)
        if about.chunk != chunk:
            raise refuse_place("into", path, about.chunk, self.form)
        if about.sweep != self.sweep:
            raise refuse_file("into", path, "holds impacts of another sweep", "delete this file")
        if about.scene != scene:
            remedy = "give the scenes as before, or name another folder"
            raise refuse_file("into", path, "holds impacts of another scene", remedy)
        self._same_columns(dict(about.units), chunk)
        return True

    def write(self, chunk: Chunk, scene: str, result: ImpactResult) -> None:
        """Write the columns of a chunk, unless it has impacts that were not computed."""
        codes = _codes(result.status)
        if np.isin(codes, [CODES[status] for status in TRIED_AGAIN]).any():
            return
        arrays: dict[str, Any] = {}
        units: dict[str, str] = {}
        for name, unit, values in columns(result):
            if name == COLUMN_OF_STATUS:
                arrays[name] = codes
            elif values is not None:  # else the scene has no such column
                arrays[name] = np.asarray(values, dtype=np.float64)
            if name in arrays:
                units[name] = unit_in(unit, result.scene) if unit else ""
        self._same_columns(units, chunk)
        counts = np.bincount(codes, minlength=len(CODES)).tolist()
        named = {status.name: count for status, count in zip(CODES, counts, strict=True) if count}
        about = about_of(
            result,
            units,
            named,
            first=chunk.first,
            stop=chunk.stop,
            sweep=self.sweep,
            scene=scene,
        )
        with written_piece("into", self.folder, chunk, "impacts", self.form) as stream:
            # A sweep that grew and was stopped is not the one that was finished.
            (self.folder / self.form.finished).unlink(missing_ok=True)
            self.form.write(stream, arrays, about, NAMES)

    def _same_columns(self, units: dict[str, str], chunk: Chunk) -> None:
        """Refuse a scene with other columns than those before."""
        if self.units is None:
            self.units = units
        if units != self.units:
            first = next(iter({*units.items()} ^ {*self.units.items()}))[0]
            rule = f"impacts {chunk.first} to {chunk.stop} have other columns: {first}"
            raise refuse(
                "scenes", name_of(chunk, self.form), rule, "sweep them into another folder"
            )

    def finish(self, impacts: int) -> None:
        """Write the number of impacts; refuse chunks beyond it."""
        for chunk, path in self.found.items():
            if chunk.stop > impacts:
                rule = f"lies beyond the last of {impacts} impacts"
                remedy = "give the scenes as before, or name another folder"
                raise refuse_file("into", path, rule, remedy)
        path, words = self.folder / self.form.finished, json.dumps({"impacts": impacts}) + "\n"
        if path.is_file() and path.read_text("utf-8") == words:
            return  # nothing is to be written, and maybe nothing can be
        with written(path) as stream:
            stream.write(words)


def swept_into(
    laws: Laws,
    scenes: Scene | GridParts | Iterable[Scene],
    folder: str | Path,
    *,
    result_of: Callable[[Scene, Piece], ImpactResult],
    progress: Callable[[int, int], object] | None,
    chunk: int | None,
    executor: Executor | None,
) -> SweepFolder:
    """Return the folder with the columns of a sweep; see ``Simulation.sweep``.

    ``result_of`` makes the result of a piece.
    """
    size = None if chunk is None else whole("chunk", chunk)
    of_kind("scenes", scenes, Scene, Iterable, rule="must be a Scene, or an iterable of them")
    batches = _batches(scenes, size or MARCHED_AT_A_TIME)
    if (begin := next(batches, None)) is None:
        remedy = "make the generator anew: it gives its scenes once"
        raise refuse("scenes", scenes, "must hold at least one Scene", remedy)
    accept_scene(laws, begin)
    target = _Into(folder, laws)  # of scenes that are refused there is no folder
    waiting: dict[Chunk, tuple[Scene, str]] = {}
    done = stop = 0
    total, failed = _total(scenes), None

    def unsolved() -> Iterator[Part]:
        nonlocal failed
        try:
            yield from parts()
        except Exception as error:  # of who makes the scenes: chunks that are sent come first
            failed = error

    def parts() -> Iterator[Part]:
        nonlocal done, stop
        for scene in itertools.chain([begin], batches):
            accept_scene(laws, scene)
            before, block = stop, block_for(laws, scene)
            usual = IMPACTS_AT_A_TIME if block == WHOLE_IMPACTS else MARCHED_AT_A_TIME
            step = math.ceil((size or usual) / block) * block
            stop += scene.shape[0]
            for place in cut([Chunk(0, scene.shape[0])], step):
                where = Chunk(before + place.first, before + place.stop)
                part = scene.take(slice(*place))
                if not isinstance(scenes, Scene):  # the index in the whole sweep
                    part = part.numbered(np.arange(*where))
                mark = fingerprint(part)
                if target.holds(where, mark):
                    done += where.size
                    continue
                waiting[where] = part, mark
                yield Part(where, part, block)

    pieces = solve_parts(laws, unsolved(), executor, ahead=AHEAD)
    try:
        for piece in pieces:
            part, mark = waiting.pop(piece.chunk)
            target.write(piece.chunk, mark, result_of(part, piece))
            done += piece.chunk.size
            if progress is not None:
                progress(done, total or done)
        if failed is not None:
            raise failed
        target.finish(stop)
    except KeyboardInterrupt:
        pass  # finished chunks are in the folder, which tells that it is not complete
    finally:
        pieces.close()
    return SweepFolder(target.folder)


def _batches(scenes: Scene | Iterable[Scene], size: int) -> Iterator[Scene]:
    """Yield batches of one axis; single impacts are joined, ``size`` in a batch."""
    if isinstance(scenes, Scene):
        one_axis(scenes.shape)
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
            one_axis(scene.shape)
            yield scene
    if singles:
        yield Scene.stack(singles)


def _total(scenes: Scene | GridParts | Iterable[Scene]) -> int | None:
    """Return the number of impacts, if scenes tell it."""
    if isinstance(scenes, GridParts):
        return scenes.impacts
    return math.prod(scenes.shape) if isinstance(scenes, Scene) else None


def _codes(statuses: NDArray[np.object_]) -> Any:
    """Return the codes of an array of statuses, one byte each."""
    if succeeded(statuses):  # a look at each takes longer than the impacts
        return np.zeros(statuses.shape, dtype=np.uint8)
    return np.array([CODES[status] for status in statuses.tolist()], dtype=np.uint8)
