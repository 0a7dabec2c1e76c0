"""Pieces of a sweep in a folder, from which an interrupted sweep resumes."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.types import AnyArray
from contactlab.outcome.chunk_files import (
    DAMAGED,
    chunks_in,
    name_of,
    refuse_damage,
    refuse_file,
    refuse_place,
)
from contactlab.outcome.chunk_forms import NPZ, Chunk
from contactlab.outcome.files import PARTS
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import PlanColumns
from contactlab.registry.composition import Laws
from contactlab.runs.fingerprints import fingerprint
from contactlab.runs.pieces import Part, Piece
from contactlab.runs.recomputed import Finished, Sample, numbers_of, refuse_other_bits
from contactlab.runs.target import hold_folder, write_piece


class Kept:
    """The finished pieces of one sweep in a folder, each written to a temporary file first."""

    def __init__(self, folder: Path, sweep: str, scene: Scene) -> None:
        self.folder, self.sweep, self.scene = folder, sweep, scene

    def keep(self, piece: Piece) -> None:
        """Write a piece, unless it is there or was lost."""
        path = self.folder / name_of(piece.chunk)
        if path.exists() or not piece.solved:
            return
        arrays = _arrays(piece) | {"sweep": np.array(self.sweep)}
        arrays["checksum"] = np.array(_checksum(arrays))
        of = f"of {self.scene.shape[0]} impacts"
        with write_piece("keep", self.folder, piece.chunk, of) as stream:
            np.savez(stream, **arrays)

    def compare(
        self, pieces: Sequence[Piece], block: int, solve: Callable[[list[Part]], Iterator[Piece]]
    ) -> None:
        """Solve a few finished blocks again, and refuse the folder if their bits are others."""
        sample = Sample()
        for piece in pieces:
            ended = [status is Status.WORKER_DIED for status in piece.motion.status]
            scene = self.scene.take(slice(*piece.chunk))
            sample.add(piece.chunk, scene, block, np.array(ended))
        for fresh in solve(sample.parts()):
            first, stop = fresh.chunk
            (piece,) = (each for each in pieces if each.chunk.first <= first < each.chunk.stop)
            place = slice(first - piece.chunk.first, stop - piece.chunk.first)
            finished = Finished(numbers_of(piece), piece.computer).take(place)
            refuse_other_bits("keep", self.folder, fresh, numbers_of(fresh), finished)

    def pieces(self) -> list[Piece]:
        """Return the pieces in the folder, no impact in two of them; refuse other files."""
        pieces: list[Piece] = []
        for chunk, path in chunks_in("keep", self.folder):
            # Two runs with different chunks wrote impacts twice, on a disk without locks.
            if pieces and chunk.first < pieces[-1].chunk.stop:
                continue
            try:
                with open(path, "rb") as stream, np.load(stream, allow_pickle=False) as content:
                    arrays = {name: content[name] for name in content.files}
                    if str(arrays.pop("checksum")) != _checksum(arrays):
                        raise ValueError("its numbers are not those that were written")
                    piece, sweep = _piece(arrays), str(arrays["sweep"])
            except DAMAGED as error:
                raise refuse_damage("keep", path, error) from error
            if piece.chunk != chunk:
                raise refuse_place("keep", path, piece.chunk)
            if sweep != self.sweep:
                first, stop = chunk
                rule = f"holds impacts {first} to {stop} of another sweep"
                raise refuse_file("keep", path, rule, "delete this file")
            pieces.append(piece)
        return pieces


@contextlib.contextmanager
def keep_in(folder: str | Path, laws: Laws, scene: Scene, block: int) -> Iterator[Kept]:
    """Hold the folder of a sweep, and yield its pieces."""
    more = {"impacts": scene.shape[0], "scene": fingerprint(scene), "block": block}
    with hold_folder("keep", folder, laws, more) as (path, sweep):
        yield Kept(path, sweep, scene)


def remove(folder: Path) -> None:
    """Delete the pieces of a sweep, and their folder if it is empty then."""
    own = [path for _, path in chunks_in("keep", folder)]
    for path in (*own, *folder.glob(PARTS), folder / NPZ.about):
        path.unlink(missing_ok=True)
    with contextlib.suppress(OSError):
        folder.rmdir()


def _checksum(arrays: Mapping[str, AnyArray]) -> str:
    """Return a hash of the arrays of a piece, in the order of their names."""
    return fingerprint([(name, np.asarray(arrays[name])) for name in sorted(arrays)])


def _arrays(piece: Piece) -> dict[str, Any]:
    """Return the entries of a piece as arrays of numbers and text."""
    chunk, columns, motion, computer, _ = piece
    arrays: dict[str, Any] = {name: getattr(motion, name) for name in motion.numbers()}
    arrays["place"] = np.array(chunk)
    arrays["computer"] = np.array(computer)
    arrays["status"] = np.array([status.name for status in motion.status])
    arrays["detail"] = np.array(list(motion.detail), dtype=np.str_)
    arrays["counters"] = np.array(json.dumps(dict(motion.counters)))
    arrays |= columns.to_arrays()
    return arrays


def _piece(content: Mapping[str, Any]) -> Piece:
    """Return the piece of the arrays that ``_arrays`` made."""
    first, stop = content["place"].tolist()
    motion = Motion(
        **{name: content[name] for name in Motion.numbers()},
        status=np.array([Status[name] for name in content["status"]], dtype=object),
        detail=np.array(content["detail"].tolist(), dtype=object),
        counters=json.loads(str(content["counters"])),
    )
    columns, computer = PlanColumns.from_arrays(content), str(content["computer"])
    return Piece(Chunk(first, stop), columns, motion, computer)
