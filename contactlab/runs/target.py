"""The folder that a sweep is written into: of one sweep, and written by one process at a time."""

from __future__ import annotations

import contextlib
import errno
import json
import os
from collections.abc import Iterator, Mapping
from importlib import metadata
from pathlib import Path
from typing import IO

from contactlab.numeric.checks import of_kind, refuse
from contactlab.outcome.chunk_files import chunks_in, name_of
from contactlab.outcome.chunk_forms import NPZ, Chunk, Form
from contactlab.outcome.files import PARTS, replace_file
from contactlab.outcome.locks import InUseError, alone_with
from contactlab.registration.names import KINDS, PROJECT
from contactlab.registry.composition import Laws
from contactlab.registry.law_files import code_of
from contactlab.registry.law_words import own_options
from contactlab.registry.registry import REGISTRY
from contactlab.runs.fingerprints import fingerprint

#: Distributions that every number comes from.
NUMBERS_FROM = (PROJECT, "numpy", "scipy")
ANOTHER = "delete the folder, or name another for this sweep"


def check_folder(argument: str, folder: object) -> Path:
    """Return the path of a folder, or refuse a value that is no such path."""
    path = Path(of_kind(argument, folder, str, os.PathLike, rule="must be the path of a folder"))
    if os.path.lexists(path) and not os.path.isdir(path):
        what = "is a link to nothing" if os.path.islink(path) else "is a file"
        raise refuse(argument, str(path), what, "name a folder")
    return path


@contextlib.contextmanager
def hold_folder(
    argument: str, folder: str | Path, laws: Laws, more: Mapping[str, object], form: Form = NPZ
) -> Iterator[tuple[Path, str]]:
    """Hold the folder of a sweep, made if there is none; yield it with the sweep's fingerprint.

    The fingerprint is of the laws, the files of their classes and ``more``. It is written into
    every piece, so that a piece of another sweep is refused. A folder of another sweep is refused
    here, and one that is in use.
    """
    path, by_kind = check_folder(argument, folder), laws.by_kind()
    origins = {kind: REGISTRY.describe(law) for kind, law in by_kind.items()}
    about = {
        **{f"code of {name}": checksum for name, checksum in code_of(by_kind).items()},
        **{kind: f"{origins[kind]} {own_options(law)}".rstrip() for kind, law in by_kind.items()},
        **more,
        "options": fingerprint(by_kind),
        **{name: metadata.version(name) for name in NUMBERS_FROM},
    }
    _make(argument, path, form)
    try:
        with alone_with(path / form.about) as (stream, locked):
            _begin_or_compare(argument, path, stream, about, form)
            for part in path.glob(PARTS) if locked else ():  # left by a killed sweep
                part.unlink(missing_ok=True)
            # "options" has what the words of a law have
            yield path, fingerprint(about | origins)
    except InUseError:
        rule, remedy = "is in use by another sweep", "wait until it ends, or name another folder"
        raise refuse(argument, str(folder), rule, remedy) from None


def _make(argument: str, folder: Path, form: Form) -> None:
    """Make the folder if there is none; refuse one with other files and without a sweep."""
    if os.path.exists(folder / form.about):
        return
    if os.path.exists(folder) and any(folder.glob("[!.]*")):
        rule = "is not empty, and holds no sweep"
        raise refuse(argument, str(folder), rule, "name a new folder")
    try:
        folder.mkdir(exist_ok=True)
    except (OSError, ValueError) as error:  # a name with a null character
        rule = f"cannot be made: {getattr(error, 'strerror', error)}"
        raise refuse(argument, str(folder), rule, "name a folder in one that is there") from None


def _begin_or_compare(
    argument: str, folder: Path, stream: IO[str], about: Mapping[str, object], form: Form
) -> None:
    """Write what the sweep is into an empty file, or refuse a folder of another sweep."""
    try:
        words = stream.read()
        if not words:
            _write(stream.fileno(), (json.dumps(about, indent=2) + "\n").encode())
            return
        before = dict(json.loads(words))
    except (ValueError, TypeError) as error:
        rule = f"{form.about} in it cannot be read: {error}"
        raise refuse(argument, str(folder), rule, ANOTHER) from error
    # What both have comes first: another law has other code.
    # Words of a law with a set or a function differ between processes; its options do not.
    same = KINDS if before.get("options") == about.get("options") else ()
    for name in (*(name for name in about if name in before), *about, *before):
        if name in same:
            continue
        was, now = before.get(name, "none"), about.get(name, "none")
        if was != now:
            rule = f"holds another sweep: {name} was {was}, is {now}"
            raise refuse(argument, str(folder), rule, ANOTHER)


def _write(descriptor: int, words: bytes) -> None:
    """Write a text into an empty file, which stays empty where there is no room."""
    try:
        if os.write(descriptor, words) < len(words):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        os.fsync(descriptor)
    except OSError:
        os.ftruncate(descriptor, 0)
        raise


@contextlib.contextmanager
def write_piece(
    argument: str, folder: Path, chunk: Chunk, of: str, form: Form = NPZ
) -> Iterator[IO[bytes]]:
    """Return a stream of a chunk's file; ``of`` ends "holds 80 of 150 impacts" in an error."""
    try:
        with replace_file(folder / name_of(chunk, form), binary=True) as stream:
            yield stream
    except OSError as error:
        first, stop = chunk
        done = count(argument, folder, form)
        left = "goes on from them" if done else "begins again"
        words = (
            f"{argument} = {str(folder)!r}: impacts {first} to {stop} are not written: "
            f"{error.strerror or error}; "
            f"{folder} holds {done} {of}; the same sweep {left}"
        )
        raise OSError(*filter(None, (error.errno, words))) from error


def count(argument: str, folder: Path, form: Form = NPZ) -> int:
    """Return the number of impacts in the pieces of a folder; 0 if there is no folder."""
    return sum(chunk.size for chunk, _ in chunks_in(argument, folder, form))
