"""Pieces of a sweep in a folder, from which an interrupted sweep resumes."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator, Mapping
from importlib import metadata
from pathlib import Path
from typing import IO, Any

import attrs
import numpy as np

from contactlab.compose import sources
from contactlab.compose.composition import Laws
from contactlab.compose.fingerprints import fingerprint
from contactlab.compose.pieces import Piece
from contactlab.compose.registry import REGISTRY
from contactlab.contracts.law import Law
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import of_kind, refuse
from contactlab.numeric.types import AnyArray
from contactlab.outcome.chunk_files import (
    DAMAGED,
    chunks_in,
    name_of,
    refuse_damaged,
    refuse_file,
    refuse_place,
)
from contactlab.outcome.chunk_forms import NPZ, Chunk, Form
from contactlab.outcome.files import written
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import PlanColumns
from contactlab.registration.names import KINDS, PROJECT

#: Distributions that every number comes from.
NUMBERS_FROM = (PROJECT, "numpy", "scipy")
#: Statuses of impacts that were not computed: a resumed sweep computes them.
TRIED_AGAIN = (Status.INTERRUPTED, Status.WORKER_DIED)


class Kept:
    """A folder with the finished pieces of one sweep, each written to a temporary file first."""

    def __init__(self, folder: str | Path, laws: Laws, scene: Scene, block: int) -> None:
        self.impacts = scene.shape[0]
        more = {"impacts": self.impacts, "scene": fingerprint(scene), "block": block}
        self.folder, self.sweep = opened("keep", folder, laws, more)

    def keep(self, piece: Piece) -> None:
        """Write a piece, unless it is there or has impacts that were not computed."""
        path = self.folder / name_of(piece.chunk)
        if path.exists() or any(status in TRIED_AGAIN for status in piece.motion.status):
            return
        arrays = _arrays(piece) | {"sweep": np.array(self.sweep)}
        arrays["checksum"] = np.array(_checksum(arrays))
        with written_piece(
            "keep", self.folder, piece.chunk, f"of {self.impacts} impacts"
        ) as stream:
            np.savez(stream, **arrays)

    def pieces(self) -> list[Piece]:
        """Return the pieces in the folder, no impact in two of them; refuse other files."""
        pieces: list[Piece] = []
        for chunk, path in chunks_in("keep", self.folder):
            # Two runs at the same time, with different chunks, may have written impacts twice.
            if pieces and chunk.first < pieces[-1].chunk.stop:
                continue
            try:
                with open(path, "rb") as stream, np.load(stream, allow_pickle=False) as content:
                    arrays = {name: content[name] for name in content.files}
                    if str(arrays.pop("checksum")) != _checksum(arrays):
                        raise ValueError("its numbers are not those that were written")
                    piece, sweep = _piece(arrays), str(arrays["sweep"])
            except DAMAGED as error:
                raise refuse_damaged("keep", path, error) from error
            if piece.chunk != chunk:
                raise refuse_place("keep", path, piece.chunk)
            if sweep != self.sweep:
                first, stop = chunk
                rule = f"holds impacts {first} to {stop} of another sweep"
                raise refuse_file("keep", path, rule, "delete this file")
            pieces.append(piece)
        return pieces


def checked_folder(argument: str, folder: object) -> Path:
    """Return the path of a folder, or refuse what is none."""
    return Path(of_kind(argument, folder, str, os.PathLike, rule="must be the path of a folder"))


def opened(
    argument: str, folder: str | Path, laws: Laws, more: Mapping[str, object], form: Form = NPZ
) -> tuple[Path, str]:
    """Return the folder of a sweep, made if there is none, and the sweep's fingerprint.

    The fingerprint is of the laws, their code and ``more``. It is written into every piece, so
    that a piece of another sweep is refused. A folder of another sweep is refused here.
    """
    checked_folder(argument, folder)
    if os.path.lexists(folder) and not os.path.isdir(folder):
        what = "is a link to nothing" if os.path.islink(folder) else "is a file"
        raise refuse(argument, str(folder), what, "name a folder")
    by_kind = laws.by_kind()
    modules = _modules(by_kind)
    if nameless := sources.without_file(modules):
        rule = f"cannot tell the code of {nameless[0]} from an earlier one: it is in no file"
        raise refuse(argument, str(folder), rule, "write the classes of the laws into a file")
    code = sources.code_of(modules)
    if own := sources.own_code():
        code[PROJECT] = own
    about = {
        **{f"code of {name}": checksum for name, checksum in code.items()},
        **{kind: f"{REGISTRY.describe(law)}: {law!r}" for kind, law in by_kind.items()},
        **more,
        "options": fingerprint(by_kind),
        **{name: metadata.version(name) for name in NUMBERS_FROM},
    }
    _check(argument, Path(folder), about, form)
    origins = {kind: REGISTRY.describe(law) for kind, law in by_kind.items()}
    return Path(folder), fingerprint(about | origins)  # "options" has what the words of a law have


def _check(argument: str, folder: Path, about: Mapping[str, object], form: Form) -> None:
    """Make the folder if there is none, or refuse a folder of another sweep."""
    remedy = "delete the folder, or name another for this sweep"
    path = folder / form.about
    if not os.path.exists(path):
        if os.path.exists(folder) and any(folder.glob("[!.]*")):
            rule = "is not empty, and holds no sweep"
            raise refuse(argument, str(folder), rule, "name a new folder")
        try:
            folder.mkdir(exist_ok=True)
        except (OSError, ValueError) as error:  # a name with a null character
            rule = f"cannot be made: {getattr(error, 'strerror', error)}"
            raise refuse(
                argument, str(folder), rule, "name a folder in one that is there"
            ) from None
        with written(path) as stream:
            stream.write(json.dumps(about, indent=2) + "\n")
        return
    try:
        before = dict(json.loads(path.read_text(encoding="utf-8")))
    except OSError as error:
        rule = f"cannot be read: {error.strerror}"
        raise refuse_file(argument, path, rule, "try again") from error
    except (ValueError, TypeError) as error:
        rule = f"{form.about} in it cannot be read: {error}"
        raise refuse(argument, str(folder), rule, remedy) from error
    # What both have comes first: another law has other code.
    # Words of a law with a set differ between processes; its options do not.
    same = KINDS if before.get("options") == about.get("options") else ()
    for name in (*(name for name in about if name in before), *about, *before):
        if name in same:
            continue
        was, now = before.get(name, "none"), about.get(name, "none")
        if was != now:
            rule = f"holds another sweep: {name} was {was}, is {now}"
            raise refuse(argument, str(folder), rule, remedy)


@contextlib.contextmanager
def written_piece(
    argument: str, folder: Path, chunk: Chunk, of: str, form: Form = NPZ
) -> Iterator[IO[bytes]]:
    """Return a stream of a chunk's file; ``of`` ends "holds 80 of 150 impacts" in an error."""
    try:
        with written(folder / name_of(chunk, form), binary=True) as stream:
            yield stream
    except OSError as error:
        first, stop = chunk
        done = count(argument, folder, form)
        words = (
            f"{argument} = {str(folder)!r}: impacts {first} to {stop} are not written: "
            f"{error.strerror or error}; {folder} holds {done} {of}; "
            "the same sweep goes on from them"
        )
        raise OSError(*filter(None, (error.errno, words))) from error


def count(argument: str, folder: Path, form: Form = NPZ) -> int:
    """Return the number of impacts in the pieces of a folder; 0 if there is no folder."""
    return sum(chunk.size for chunk, _ in chunks_in(argument, folder, form))


def remove(folder: Path) -> None:
    """Delete the pieces of a sweep, and their folder if it is empty then."""
    own = [path for _, path in chunks_in("keep", folder)]
    for path in (*own, *folder.glob(".contactlab-*.part"), folder / NPZ.about):
        path.unlink(missing_ok=True)
    with contextlib.suppress(OSError):
        folder.rmdir()


def _modules(tree: Any) -> set[str]:
    """Return the names of the modules with the classes in a tree of laws."""
    if isinstance(tree, Mapping | list | tuple):
        values = tree.values() if isinstance(tree, Mapping) else tree
        return set[str]().union(*map(_modules, values))
    names = {each.__module__ for each in type(tree).__mro__}
    if isinstance(tree, type):
        names.add(tree.__module__)
    if attrs.has(type(tree)):
        names |= _modules([getattr(tree, field.name) for field in attrs.fields(type(tree))])
    elif isinstance(tree, Law):
        names |= _modules(getattr(tree, "__dict__", {}))
    return names


def _checksum(arrays: Mapping[str, AnyArray]) -> str:
    """Return a hash of the arrays of a piece, in the order of their names."""
    return fingerprint([(name, np.asarray(arrays[name])) for name in sorted(arrays)])


def _arrays(piece: Piece) -> dict[str, Any]:
    """Return the entries of a piece as arrays of numbers and text."""
    chunk, columns, motion = piece
    arrays: dict[str, Any] = {name: getattr(motion, name) for name in motion.numbers()}
    arrays["place"] = np.array(chunk)
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
    return Piece(Chunk(first, stop), PlanColumns.from_arrays(content), motion)
