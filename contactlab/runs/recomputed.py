"""Finished blocks that a resumed sweep computes again; it refuses other bits than those kept.

Other bits show a change of any code or data that a law uses: functions, files, notebooks.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from contactlab.contracts.status import Status
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import AnyArray, Array, Mask, Real
from contactlab.outcome.chunk_forms import Chunk
from contactlab.runs.pieces import Part, Piece
from contactlab.runs.target import ANOTHER


class Finished(NamedTuple):
    """A finished block of a folder: numbers and statuses by name, and their computer."""

    numbers: Mapping[str, AnyArray]
    computer: str

    def take(self, place: slice) -> Finished:
        """Return a part; a number that all impacts share stays one."""
        each = self.numbers.items()
        parts = {name: values[place] if np.ndim(values) else values for name, values in each}
        return Finished(parts, self.computer)


class Sample:
    """Finished blocks to compute again: a random one, and those at both ends of psi1 and chi.

    A change may show at one end only.
    """

    def __init__(self) -> None:
        self._draw = np.random.default_rng()  # anew each time, whatever the user has seeded
        self._blocks = 0
        self._drawn: tuple[Part, ...] = ()
        self._ends: dict[tuple[str, int], tuple[float, Part]] = {}

    def add(self, chunk: Chunk, scene: Scene, block: int, ended: Mask) -> None:
        """Consider the blocks of a finished chunk, but those with impacts that ``ended`` a process.

        Such impacts would end this process too.
        """
        starts = np.arange(0, chunk.size, block)
        places = np.flatnonzero(~np.logical_or.reduceat(ended, starts))
        if not places.size:
            return

        def part(place: int) -> Part:
            first = int(starts[place])
            where = slice(first, min(first + block, chunk.size))
            shifted = Chunk(chunk.first + where.start, chunk.first + where.stop)
            return Part(shifted, scene.take(where), block)

        self._blocks += places.size
        if self._draw.integers(self._blocks) < places.size:  # each block is as likely as another
            self._drawn = (part(self._draw.choice(places)),)
        for name, values in _ranges(scene).items():
            for sign in (-1, 1):
                most = np.maximum.reduceat(sign * values, starts)[places]
                place = int(np.argmax(most))
                end = self._ends.get((name, sign))
                if end is None or most[place] > end[0]:
                    self._ends[name, sign] = float(most[place]), part(places[place])

    def parts(self) -> list[Part]:
        """Return the blocks in order, each once."""
        parts = [*self._drawn, *(part for _, part in self._ends.values())]
        return [*{part.chunk: part for part in sorted(parts, key=lambda each: each.chunk)}.values()]


def _ranges(scene: Scene) -> dict[str, Array]:
    """Return psi1 and chi of each impact; of vectors and tensors the size."""
    psi1: Real = scene.psi1 if scene.planar else kinetics.size_of(scene, scene.psi1)
    ranges = {"psi1": psi1, "chi": kinetics.largest_chi(scene)}
    return {
        name: np.nan_to_num(np.broadcast_to(values, scene.shape)) for name, values in ranges.items()
    }


def numbers_of(piece: Piece) -> dict[str, AnyArray]:
    """Return the numbers of a piece by name, and its statuses."""
    motion = piece.motion
    numbers = {name: getattr(motion, name) for name in motion.numbers()}
    numbers |= {name: getattr(piece.columns, name) for name in ("psi2_error", "restitution_error")}
    names = np.array([status.name for status in motion.status])
    return {"status": names, **{name: np.asarray(values) for name, values in numbers.items()}}


def refuse_other_bits(
    argument: str, folder: Path, fresh: Piece, found: Mapping[str, AnyArray], kept: Finished
) -> None:
    """Refuse a folder whose numbers of a block are not those ``found`` of the ``fresh`` piece."""
    if not fresh.solved or not (name := _differing(kept.numbers, found, fresh.chunk.size)):
        return
    where = f"impacts {fresh.chunk.first} to {fresh.chunk.stop}"
    if kept.computer != fresh.computer:
        rule = f"{where} are of {kept.computer}; {name} has other bits on {fresh.computer}"
        remedy = "go on where it was begun, or name another folder"
        raise refuse(argument, str(folder), rule, remedy)
    changed = "a function or a file of the laws, or of a column, has changed"
    rule = f"{name} of {where} is another now: {changed}"
    raise refuse(argument, str(folder), rule, ANOTHER)


def _differing(kept: Mapping[str, AnyArray], found: Mapping[str, AnyArray], size: int) -> str:
    """Return the name of a column with other bits, where impacts succeeded; empty if none has."""
    if (kept["status"] != found["status"]).any():
        return "status"
    good = found["status"] == Status.SUCCESS.name
    for name in (each for each in found if each != "status"):
        one, other = (_rows(numbers[name], size)[good] for numbers in (kept, found))
        if one.shape != other.shape:
            return name
        if np.any(
            (one.view(np.uint64) != other.view(np.uint64)) & ~(np.isnan(one) & np.isnan(other))
        ):
            return name
    return ""


def _rows(values: AnyArray, size: int) -> Array:
    """Return a column with a row for each impact; all have the same if it is one number."""
    array = np.asarray(values, dtype=np.float64)
    return np.ascontiguousarray(np.broadcast_to(array, (size, *array.shape[1:])))
