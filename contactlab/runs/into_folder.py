"""The folder that a sweep is written into: a file of columns for each chunk."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.status import Status, succeeded
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import AnyArray
from contactlab.outcome.chunk_files import (
    chunks_in,
    columns_of,
    name_of,
    read_about,
    refuse_file,
    refuse_place,
)
from contactlab.outcome.chunk_forms import COLUMN_OF_STATUS, About, Chunk, Form, checksum
from contactlab.outcome.columns import columns, unit_in
from contactlab.outcome.files import replace_file
from contactlab.outcome.result import ImpactResult
from contactlab.runs.pieces import Part, Piece
from contactlab.runs.recomputed import Finished, Sample, refuse_other_bits
from contactlab.runs.target import write_piece

#: Codes of statuses; that of success is 0.
CODES = {status: code for code, status in enumerate(Status)}
NAMES = [status.name for status in Status]


#: Remedy where a plug-in that brought a column is gone, new, or gives another unit.
OTHER_COLUMNS = "sweep them into another folder, or with the plug-ins that the folder was made with"


class ChunkFolder:
    """The chunks of a sweep in a folder: which are written, and writing of further ones."""

    def __init__(self, folder: Path, sweep: str, form: Form) -> None:
        self.folder, self.sweep, self.form = folder, sweep, form
        self.units: dict[str, str] | None = None
        self.found = dict(chunks_in("into", self.folder, self.form))
        self.sample = Sample()

    def holds(self, part: Part, scene: str) -> bool:
        """Return whether a chunk is written; refuse a chunk of another scene or size."""
        chunk = part.chunk
        for other in self.found:
            if other != chunk and other.first < chunk.stop and chunk.first < other.stop:
                rule = f"is of chunks of another size than impacts {chunk.first} to {chunk.stop}"
                remedy = "give scenes and chunk as before, or name another folder"
                raise refuse_file("into", self.found[other], rule, remedy)
        if chunk not in self.found:
            return False
        path = self.found[chunk]
        about = read_about(path, self.form, argument="into")
        if about.chunk != chunk:
            raise refuse_place("into", path, about.chunk, self.form)
        if about.sweep != self.sweep:
            raise refuse_file("into", path, "holds impacts of another sweep", "delete this file")
        if about.scene != scene:
            remedy = "give the scenes as before, or name another folder"
            raise refuse_file("into", path, "holds impacts of another scene", remedy)
        self._same_columns(dict(about.units), chunk)
        ended = np.zeros(chunk.size, dtype=bool)
        with columns_of(path, self.form, NAMES, about.sums, "into") as content:
            for name in about.units:  # each is compared with its checksum
                if name == COLUMN_OF_STATUS:
                    ended = ended | (content[name] == CODES[Status.WORKER_DIED])
                else:
                    content[name]
        self.sample.add(chunk, part.scene, part.block, ended)
        return True

    def compare(
        self,
        solve: Callable[[Iterable[Part]], Iterator[Piece]],
        result_of: Callable[[Scene, Piece], ImpactResult],
    ) -> None:
        """Solve a few written blocks again, and refuse the folder if their bits are others."""
        parts = {part.chunk: part for part in self.sample.parts()}
        for fresh in solve(parts.values()):
            first, stop = fresh.chunk
            chunk = next(each for each in self.found if each.first <= first < each.stop)
            arrays, units = _arrays(result_of(parts[fresh.chunk].scene, fresh))
            about = read_about(self.found[chunk], self.form, argument="into")
            self._same_columns({**about.units, **units}, chunk)
            with columns_of(self.found[chunk], self.form, NAMES, about.sums, "into") as content:
                written = {name: content[name] for name in arrays}
            place = slice(first - chunk.first, stop - chunk.first)
            kept = Finished(_name_columns(written), about.computer).take(place)
            refuse_other_bits("into", self.folder, fresh, _name_columns(arrays), kept)

    def write(self, piece: Piece, scene: str, result: ImpactResult, whole: Scene) -> None:
        """Write the columns of a chunk, those of the ``whole`` batch that it belongs to."""
        arrays, units = _arrays(result, whole)
        self._same_columns(units, piece.chunk)
        if self.form.whole:
            arrays = {name: np.broadcast_to(v, piece.chunk.size) for name, v in arrays.items()}
        each = np.bincount(arrays[COLUMN_OF_STATUS], minlength=len(CODES)).tolist()
        counts = {name: count for name, count in zip(NAMES, each, strict=True) if count}
        failures = result.failures if [*counts] != [Status.SUCCESS.name] else {}
        first, error = piece.chunk.first, float(np.max(result.plan.psi2_error))
        about = About(
            first=first,
            stop=piece.chunk.stop,
            sweep=self.sweep,
            scene=scene,
            units=units,
            counts=counts,
            failures={str(first + index): words for index, words in failures.items()},
            cautions=[str(caution) for caution in result.plan.cautions],
            psi2_error=None if math.isnan(error) else error,
            sums={name: checksum(values) for name, values in arrays.items()},
            computer=piece.computer,
        )
        with write_piece("into", self.folder, piece.chunk, "impacts", self.form) as stream:
            # a further chunk makes the sweep unfinished again
            (self.folder / self.form.finished).unlink(missing_ok=True)
            self.form.write(stream, arrays, about, NAMES)

    def _same_columns(self, units: dict[str, str], chunk: Chunk) -> None:
        """Refuse a scene with other columns than the scenes before."""
        if self.units is None:
            self.units = units
        if units != self.units:
            first = next(iter({*units.items()} ^ {*self.units.items()}))[0]
            rule = f"impacts {chunk.first} to {chunk.stop} have other columns: {first}"
            raise refuse("scenes", name_of(chunk, self.form), rule, OTHER_COLUMNS)

    def finish(self, impacts: int) -> None:
        """Write the number of impacts; refuse chunks beyond it."""
        for chunk, path in self.found.items():
            if chunk.stop > impacts:
                rule = f"lies beyond the last of {impacts} impacts"
                remedy = "give the scenes as before, or name another folder"
                raise refuse_file("into", path, rule, remedy)
        path, words = self.folder / self.form.finished, json.dumps({"impacts": impacts}) + "\n"
        if path.is_file() and path.read_text("utf-8") == words:
            return  # already finished; the folder may be read-only
        with replace_file(path) as stream:
            stream.write(words)


def _arrays(
    result: ImpactResult, whole: Scene | None = None
) -> tuple[dict[str, AnyArray], dict[str, str]]:
    """Return the columns that a scene has, statuses as codes, and their units."""
    arrays: dict[str, AnyArray] = {}
    units = {}
    for name, unit, values in columns(result, whole):
        if name == COLUMN_OF_STATUS:
            arrays[name] = _codes(result.status)
        elif values is not None:
            arrays[name] = np.asarray(values, dtype=np.float64)
        if name in arrays:
            units[name] = unit_in(unit, result.scene) if unit else ""
    return arrays, units


def _name_columns(arrays: Mapping[str, AnyArray]) -> dict[str, AnyArray]:
    """Return columns with statuses by name."""
    return {**arrays, COLUMN_OF_STATUS: np.array(NAMES)[arrays[COLUMN_OF_STATUS]]}


def _codes(statuses: NDArray[np.object_]) -> NDArray[np.uint8]:
    """Return the codes of an array of statuses, one byte each."""
    if succeeded(statuses):  # a look at each takes longer than the impacts
        return np.zeros(statuses.shape, dtype=np.uint8)
    return np.array([CODES[status] for status in statuses.tolist()], dtype=np.uint8)
