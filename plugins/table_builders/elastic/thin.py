"""The table thinned to 1e-6, written into the kernels in JavaScript and C."""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array
from contactlab_laws.tables.elastic import NODES, SHIPPED
from contactlab_laws.tables.file import read
from contactlab_laws.tables.patches import chebyshev_of_values, nodes
from contactlab_laws.tables.regions import STUCK_BACK, Cuts
from table_builders.elastic.coordinates import impact, measure

#: The kernels, and how the table begins in each.
FILES = {"contactlab_bounce.mjs": "const TABLE = [", "contactlab_bounce.h": "_table[] = {"}
#: Terms left out of a patch change psi2 by less; of g the others are told in UNIT.
LEFT_OUT, UNIT = 5e-7, 1e-9
#: Characters of a line.
WIDTH = 1000


def thin_table() -> list[str]:
    """Return the numbers of the thinned table.

    First the terms of both cuts and of the seam. Then for each patch with chi > 1/2 how many
    numbers follow; its region from 0, levels and indices along a and b; how many powers of a it
    has; and for each of these how many of b, and the terms by Chebyshev polynomials of 2x - 1, in
    units of UNIT.
    """
    stored = read(SHIPPED)
    cuts = Cuts(*(stored.arrays[name] for name in Cuts._fields))
    numbers = [repr(each) for curve in cuts for each in curve.tolist()]
    forth = chebyshev_of_values(NODES) @ nodes(NODES)[:, None] ** np.arange(NODES)
    for cell, terms in zip(stored.arrays["cells"], stored.arrays["terms"], strict=True):
        if cell[0] < STUCK_BACK:
            continue
        rows = _rows(cell, forth @ terms @ forth.T, cuts)
        patch = [cell[0] - STUCK_BACK, *cell[1:], len(rows)]
        for row in rows:
            patch += [len(row), *row]
        numbers += [str(each) for each in (len(patch), *patch)]
    return numbers


def _rows(cell: NDArray[np.int16], terms: Array, cuts: Cuts) -> list[list[int]]:
    """Return the terms that are kept, in units, by powers of a and then of b."""
    region, level_a, level_b, i, j = cell.tolist()
    x, y = ((k + nodes(NODES)) * 0.5**level for k, level in ((i, level_a), (j, level_b)))
    a, b = np.meshgrid(x, y, indexing="ij")
    psi1, chi = impact(region, a, b, cuts)
    weight = float(np.abs(psi1 * measure(region, psi1, chi)).max())
    sizes = np.sort(np.abs(terms), axis=None)
    least = sizes[np.searchsorted(sizes.cumsum(), LEFT_OUT / weight)]
    units = np.where(np.abs(terms) < least, 0.0, np.rint(terms / UNIT)).astype(int)
    rows = [np.trim_zeros(row, "b").tolist() for row in units]
    while rows and not rows[-1]:
        rows.pop()
    return rows


def write(folder: Path | None = None) -> list[Path]:
    """Write the table into the kernels of a folder, by default contactlab's; return the files."""
    return put(thin_table(), FILES, folder)


def put(numbers: list[str], heads: dict[str, str], folder: Path | None = None) -> list[Path]:
    """Write numbers into the kernels of a folder, where a table has its head; return the files."""
    source = folder or Path(str(resources.files("contactlab").joinpath("kernels")))
    lines, line = [], ""
    for number in numbers:
        if len(line) + len(number) >= WIDTH:
            lines.append(line)
            line = ""
        line += f"{number},"
    text = "\n".join([*lines, line])
    for name, head in heads.items():
        file = source / name
        pattern = f"({re.escape(head)}\n).*?(\n[]}}];)"
        before = file.read_text("utf-8")
        file.write_text(re.sub(pattern, rf"\g<1>{text}\g<2>", before, flags=re.DOTALL), "utf-8")
    return [source / name for name in heads]
