"""The table file: coefficients with version and day, under a checksum."""

from __future__ import annotations

import hashlib
from datetime import UTC, datetime
from pathlib import Path

import attrs
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SHIPPED = Path(__file__).with_name("damped.npz")
FORMAT = 2


@attrs.frozen(eq=False)
class Table:
    """Chebyshev coefficients by pieces of t.

    Attributes
    ----------
    cuts : array, shape (pieces of t, 3, chi, t)
        Coefficients of the values of psi1 at which the table is cut.
    terms : array, shape (pieces of t, 4, psi1, chi, t)
        Coefficients of the tabulated quantity.
    version, built : str
        Version of contactlab, and the day of building.
    """

    cuts: Array
    terms: Array
    version: str
    built: str

    @classmethod
    def today(cls, cuts: Array, terms: Array) -> Table:
        """Return a table built by the installed version."""
        import contactlab

        return cls(cuts, terms, contactlab.__version__, datetime.now(UTC).date().isoformat())

    def checksum(self) -> str:
        """Return the SHA-256 of coefficients, format, version and day."""
        digest = hashlib.sha256(f"{FORMAT} {self.version} {self.built}".encode())
        for values in (self.cuts, self.terms):
            digest.update(np.ascontiguousarray(values).tobytes())
        return digest.hexdigest()


def write(path: Path, table: Table) -> None:
    """Write a table with its checksum."""
    with path.open("wb") as file:
        np.savez_compressed(
            file, format=FORMAT, checksum=table.checksum(), **attrs.asdict(table, recurse=False)
        )


def read(path: Path) -> Table:
    """Return the table at ``path``; ValueError if the file is damaged or of another format."""
    remedy = (
        "install contactlab anew, or build the table: python -m contactlab_laws.damped_table build"
    )
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            table = Table(file["cuts"], file["terms"], str(file["version"]), str(file["built"]))
            if int(file["format"]) != FORMAT or str(file["checksum"]) != table.checksum():
                raise ValueError("the checksum does not fit")
    except Exception as error:  # a damaged archive may raise almost anything
        raise ValueError(f"{path}: no table that can be trusted ({error}); {remedy}") from error
    return table
