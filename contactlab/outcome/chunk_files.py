"""Files of the chunks of a sweep in a folder, in order; other files are refused."""

from __future__ import annotations

import contextlib
import errno
import itertools
import re
import tokenize
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import attrs

from contactlab.numeric.types import AnyArray
from contactlab.outcome.chunk_forms import NPZ, About, ByName, Chunk, Form, checksum, read_notes

#: Errors that reading a damaged file raises.
DAMAGED = (
    OSError, EOFError, KeyError, TypeError, ValueError, RuntimeError,
    zipfile.BadZipFile, tokenize.TokenError,
)  # fmt: skip


def name_of(chunk: Chunk, form: Form = NPZ) -> str:
    """Return the name of a chunk's file."""
    first, stop = (str(impact).zfill(form.digits) for impact in chunk)
    return f"impacts-{first}-{stop}.{form.suffix}"


def chunks_in(argument: str, folder: Path, form: Form = NPZ) -> list[tuple[Chunk, Path]]:
    """Return the chunks of a folder by their names, with their files, in order.

    Raises
    ------
    ValueError
        If the name of a file is not that of a chunk.
    """
    found = []
    for path in folder.glob(f"impacts-*.{form.suffix}"):
        numbers = re.fullmatch("impacts-([0-9]+)-([0-9]+)", path.stem)
        chunk = Chunk(*map(int, numbers.groups())) if numbers else Chunk(0, 0)
        if chunk.size <= 0 or path.name != name_of(chunk, form):
            rule = f"is not the name of a chunk, impacts-FIRST-STOP.{form.suffix}"
            raise refuse_file(argument, path, rule, "move this file")
        found.append((chunk, path))
    return sorted(found)


def refuse_file(argument: str, path: Path, rule: str, remedy: str) -> ValueError:
    """Return the refusal of a file, with its whole path."""
    return ValueError(f"{argument} = {str(path)!r}: {rule}; {remedy}")


def refuse_damage(argument: str, path: Path, error: Exception) -> ValueError:
    """Return the refusal of an unreadable file; a file that may be whole is not to be deleted."""
    # Damage of an archive makes an OSError without a number, or of a seek that is out of range.
    if isinstance(error, OSError) and error.errno not in (None, errno.EINVAL):
        return refuse_file(argument, path, f"cannot be read: {error.strerror}", "try again")
    return refuse_file(argument, path, f"is damaged: {error}", "delete this file")


def refuse_place(argument: str, path: Path, chunk: Chunk, form: Form = NPZ) -> ValueError:
    """Return the refusal of a file whose name tells other impacts than its ``chunk``."""
    rule = f"contains impacts {chunk.first} to {chunk.stop}, which are not those of its name"
    remedy = f"rename it to {name_of(chunk, form)}, or delete this file"
    return refuse_file(argument, path, rule, remedy)


@contextlib.contextmanager
def columns_of(
    path: Path,
    form: Form,
    names: Sequence[str] = (),
    sums: Mapping[str, int] = MappingProxyType({}),
    argument: str = "path",
) -> Iterator[ByName]:
    """Yield the columns of a chunk by name; a damaged file is refused.

    ``sums`` are the checksums of the columns, which the chunk tells.
    """
    try:
        with form.read(path, names) as content:
            yield _Compared(content, sums)
    except DAMAGED as error:
        raise refuse_damage(argument, path, error) from error


@attrs.frozen
class _Compared:
    """Columns of a chunk by name, compared with their checksums."""

    content: ByName
    sums: Mapping[str, int]

    def __getitem__(self, name: str) -> AnyArray:
        values = self.content[name]
        if name in self.sums and checksum(values) != self.sums[name]:
            raise ValueError("its numbers are not those that were written")
        return values


def read_about(path: Path, form: Form, argument: str = "path") -> About:
    """Return the notes of a chunk, or refuse a damaged file and a file of another version."""
    with columns_of(path, form, argument=argument) as content:
        told = read_notes(str(content["about"]))
    if told.keys() != {*About._fields}:
        rule = (
            f"tells {', '.join(told)}; this version of contactlab reads {', '.join(About._fields)}"
        )
        remedy = f"read it by the version that {form.about} names"
        raise refuse_file(argument, path, rule, remedy)
    return About(**told)


def abouts_in(folder: Path, form: Form) -> list[tuple[Path, About]]:
    """Return the files of a folder, in order, each with its notes.

    Sentences on failures stay in the files: a million of them would not fit into memory.

    Raises
    ------
    ValueError
        If a file is damaged, or files are not of one sweep.
    """
    found = []
    for chunk, path in chunks_in("path", folder, form):
        about = read_about(path, form)
        if about.chunk != chunk:
            raise refuse_place("path", path, about.chunk, form)
        found.append((path, about._replace(failures={})))
    for (_, before), (path, after) in itertools.pairwise(found):
        if before.sweep != after.sweep or before.stop > after.first:
            rule = "holds impacts of another sweep, or of chunks of another size"
            raise refuse_file("path", path, rule, "move this file")
    return found
