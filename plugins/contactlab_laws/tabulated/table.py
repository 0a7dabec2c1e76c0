"""The table file: patches, cuts, and where they came from, under a checksum."""

from __future__ import annotations

import hashlib
from datetime import date
from functools import cached_property
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab_laws.tabulated.coordinates import REGIONS, Cuts

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

SHIPPED = Path(__file__).with_name("elastic.npz")
FORMAT = 1
#: Chebyshev nodes of a cell in each coordinate, and powers in its patch.
NODES = 12
#: Cells are found in a grid of 2^DEEPEST by 2^DEEPEST for each region.
DEEPEST = 6


@attrs.frozen
class Provenance:
    """How a table was made."""

    version: str
    tolerance: float
    built: str

    @classmethod
    def today(cls, tolerance: float, day: date) -> Provenance:
        """Return the provenance of a table built by the installed version."""
        import contactlab

        return cls(contactlab.__version__, tolerance, day.isoformat())


@attrs.frozen(eq=False, slots=False)
class Table:
    """g by patches.

    Parameters
    ----------
    cuts : Cuts
        The curves that divide regions.
    cells : ndarray of int16, shape (patches, 5)
        Region, levels and indices of each cell along a and b.
    terms : ndarray, shape (patches, 12, 12)
        Terms of g by powers of the local coordinates x, y in [0, 1] of a and b.
    provenance : Provenance
    """

    cuts: Cuts
    cells: NDArray[np.int16]
    terms: Array
    provenance: Provenance

    @cached_property
    def grid(self) -> NDArray[np.int16]:
        """The patch at each place of the fine grid, shape (regions, 64, 64)."""
        size = 1 << DEEPEST
        grid = np.full((REGIONS, size, size), -1, dtype=np.int16)
        for patch, (region, level_a, level_b, i, j) in enumerate(self.cells.tolist()):
            wide, high = size >> level_a, size >> level_b
            grid[region, i * wide : (i + 1) * wide, j * high : (j + 1) * high] = patch
        return grid

    @cached_property
    def scales(self) -> tuple[Array, Array]:
        """Local x = scale a - index, shape (patches,); and for b."""
        levels = self.cells[:, 1:3].astype(np.float64)  # int16 would give float32
        return np.exp2(levels[:, 0]), np.exp2(levels[:, 1])

    @cached_property
    def corners(self) -> tuple[Array, Array]:
        """Indices of the cells, as numbers, shape (patches,)."""
        return self.cells[:, 3].astype(np.float64), self.cells[:, 4].astype(np.float64)


def write(path: Path, table: Table) -> None:
    """Write a table with its checksum."""
    content: dict[str, Any] = _content(table)
    with path.open("wb") as file:
        checksum = np.array(_checksum(content))
        np.savez_compressed(file, checksum=checksum, **content)


def read(path: Path) -> Table:
    """Return the table at ``path``.

    Raises
    ------
    ValueError
        If the file is of another format, incomplete, or not what its checksum says.
    """
    remedy = (
        "install contactlab anew, or build the table: python -m contactlab_laws.tabulated build"
    )
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            content = {name: file[name] for name in file.files}
        checksum = str(content.pop("checksum"))
        if int(content["format"]) != FORMAT or checksum != _checksum(content):
            raise ValueError("the checksum does not fit")
        provenance = Provenance(
            str(content["version"]), float(content["tolerance"]), str(content["built"])
        )
        cuts = Cuts(content["stuck"], content["slip"])
        return Table(cuts, content["cells"], content["terms"], provenance)
    except Exception as error:  # a damaged archive may raise almost anything
        raise ValueError(f"{path}: no table that can be trusted ({error}); {remedy}") from error


def _content(table: Table) -> dict[str, NDArray[Any]]:
    made = table.provenance
    return {
        "format": np.array(FORMAT),
        "version": np.array(made.version),
        "tolerance": np.array(made.tolerance),
        "built": np.array(made.built),
        "stuck": table.cuts.stuck,
        "slip": table.cuts.slip,
        "cells": table.cells,
        "terms": table.terms,
    }


def _checksum(content: dict[str, NDArray[Any]]) -> str:
    """Return the SHA-256 of names and values, in order of name."""
    digest = hashlib.sha256()
    for name in sorted(content):
        values = np.ascontiguousarray(content[name])
        digest.update(f"{name} {values.dtype.str} {values.shape}".encode())
        digest.update(values.tobytes())
    return digest.hexdigest()
