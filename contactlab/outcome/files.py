"""Files are written under a temporary name, then renamed: a file is complete or absent.

Every file that contactlab writes goes through ``replace_file``. A full disk, an error or a killed
process leaves the old file unchanged; only a killed process leaves a file
``.contactlab-*.part`` behind. In the folder of a sweep the next sweep deletes it.
"""

from __future__ import annotations

import contextlib
import csv
import os
import shutil
import stat
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import BinaryIO, Literal, TextIO, TypedDict, overload


class OfText(TypedDict):
    """Options of ``open`` for text."""

    mode: Literal["x"]
    encoding: str
    errors: str
    newline: str


#: Surrogates let file names that are not UTF-8 pass unchanged.
TEXT: OfText = {
    "mode": "x", "encoding": "utf-8", "errors": "surrogateescape", "newline": "",
}  # fmt: skip
#: Largest scene or table that is read, in bytes: enough for a sweep of a million numbers.
LARGEST = 32_000_000
#: Names of temporary files, with ``*`` for random letters.
PARTS = ".contactlab-*.part"


def stamp(path: str | Path) -> tuple[int, ...]:
    """Return a value that changes when a file is written; empty for a missing file."""
    try:
        status = os.stat(path)
    except OSError:
        return ()
    return status.st_ino, status.st_size, status.st_mtime_ns


def content(path: Path, *, kind: str, remedy: str) -> bytes:
    """Return the bytes of a regular file; messages name its ``kind``, such as ``"a scene"``."""
    try:
        status = os.stat(path)
        if not stat.S_ISREG(status.st_mode):  # a pipe may never end, or never begin
            raise ValueError(f"{path}: cannot be read: is not a regular file")
        if status.st_size > LARGEST:
            size, most = status.st_size / 1e6, LARGEST / 1e6
            raise ValueError(f"{path}: is too large: {size:.0f} MB, {kind} has at most {most:.0f}")
        return path.read_bytes()
    except FileNotFoundError:
        raise ValueError(f"{path}: no such file; {remedy}") from None
    except OSError as error:
        raise ValueError(f"{path}: cannot be read: {error.strerror}") from None


@overload
def replace_file(
    path: str | Path, *, binary: Literal[False] = ...
) -> AbstractContextManager[TextIO]: ...
@overload
def replace_file(
    path: str | Path, *, binary: Literal[True]
) -> AbstractContextManager[BinaryIO]: ...
def replace_file(
    path: str | Path, *, binary: bool = False
) -> AbstractContextManager[TextIO | BinaryIO]:
    """Return a stream whose content replaces ``path`` when the block ends without an error.

    Text is UTF-8 without translation of line ends, as ``csv`` requires. The new file has the
    permissions of the old one; if ``path`` is a symbolic link, the file behind the link is
    replaced. An ``OSError`` names ``path``, and leaves the old file unchanged.
    """
    return _replace(path, binary)


@contextlib.contextmanager
def _replace(path: str | Path, binary: bool) -> Iterator[TextIO | BinaryIO]:
    """Return the stream of ``replace_file``."""
    if why_not := unwritable(path):
        raise OSError(f"{path}: {why_not}")
    target = os.path.realpath(path)
    part = os.path.join(os.path.dirname(target), PARTS.replace("*", os.urandom(6).hex()))
    try:
        with open(part, "xb") if binary else open(part, **TEXT) as stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        with contextlib.suppress(OSError):  # no old file, or a file system without permissions
            shutil.copymode(target, part)
        os.replace(part, target)
    except OSError as error:
        if error.errno is not None and error.filename in (None, part):
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise
    finally:
        with contextlib.suppress(OSError):
            os.unlink(part)


def write_table(
    path: str | Path, headings: Sequence[str], rows: Iterable[Sequence[object]]
) -> None:
    """Write a CSV file: a line of headings, then the rows."""
    with replace_file(path) as stream:
        writer = csv.writer(stream)
        writer.writerow(headings)
        writer.writerows(rows)


def unwritable(path: str | Path) -> str:
    """Return why ``path`` cannot be written, empty if no reason shows beforehand."""
    target = os.path.realpath(path)
    folder = os.path.dirname(target)
    try:
        if not stat.S_ISREG(os.stat(target).st_mode):
            return "is not a regular file; give the name of a file"
        if not os.access(target, os.W_OK):
            return "is protected against writing"
    except FileNotFoundError:
        pass  # a new file
    except OSError as error:
        return str(error.strerror)
    if not os.path.isdir(folder):
        return f"there is no folder {folder}"
    if not os.access(folder, os.W_OK):
        return f"nothing can be written in the folder {folder}"
    return ""


def distinct(outputs: Mapping[str, str | Path | None]) -> None:
    """Refuse two outputs that are the same file; the message names both by their keys."""
    names: dict[str, str] = {}
    for name, path in outputs.items():
        real_path = path and os.path.normcase(os.path.realpath(path))
        if real_path in names:
            raise ValueError(f"{names[real_path]}, {name}: {path} is the same file; give two")
        if real_path:
            names[str(real_path)] = name
