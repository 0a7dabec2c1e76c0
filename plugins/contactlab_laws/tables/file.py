"""The files of tables: arrays with version and day, under a checksum."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Number of the format; files of another are refused.
FORMAT = 3


class Stored(NamedTuple):
    """The content of a file.

    Attributes
    ----------
    arrays : mapping of str to array
    version, built : str
        Version of contactlab, and the day of building.
    """

    arrays: Mapping[str, NDArray[Any]]
    version: str
    built: str

    @classmethod
    def today(cls, **arrays: ArrayLike) -> Stored:
        """Return the content of a table built by the installed version."""
        from importlib import metadata  # takes 20 ms to import; only builders need it

        version, day = metadata.version("contactlab"), datetime.now(UTC).date().isoformat()
        return cls({k: np.asarray(v) for k, v in arrays.items()}, version, day)

    def checksum(self) -> str:
        """Return the SHA-256 of format, version, day, names and values, in order of name."""
        digest = hashlib.sha256(f"{FORMAT} {self.version} {self.built}".encode())
        for name in sorted(self.arrays):
            values = np.ascontiguousarray(self.arrays[name])
            digest.update(f"{name} {values.dtype.str} {values.shape}".encode())
            digest.update(values.tobytes())
        return digest.hexdigest()


def write(path: Path, stored: Stored) -> None:
    """Write a table with its checksum."""
    told = {"format": FORMAT, "version": stored.version, "built": stored.built}
    content: dict[str, Any] = {**told, "checksum": stored.checksum(), **stored.arrays}
    with path.open("wb") as file:
        np.savez_compressed(file, **content)


def read(path: Path) -> Stored:
    """Return the content of the file at ``path``.

    Raises
    ------
    ValueError
        If the file is of another format, incomplete, or not what its checksum says.
    """
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        told = [str(arrays.pop(name)) for name in ("format", "checksum", "version", "built")]
        stored = Stored(arrays, told[2], told[3])
        if told[:2] != [str(FORMAT), stored.checksum()]:
            raise ValueError("the checksum does not fit")
    except Exception as error:  # a damaged archive may raise almost anything
        remedy = "install contactlab anew, or build the table: python -m table_builders"
        raise ValueError(f"{path}: no table that can be trusted ({error}); {remedy}") from error
    return stored
