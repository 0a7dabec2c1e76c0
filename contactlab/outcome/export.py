"""Write results as JSON, CSV or npz, with the columns of ``contactlab.outcome.columns``.

To add a file format, add a writer and a line in ``WRITERS``.
"""

from __future__ import annotations

import csv
import importlib
import itertools
import json
import math
import zipfile
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import IO, TextIO, TypeAlias

import numpy as np

from contactlab.contracts.status import Status, succeeded
from contactlab.numeric.types import AnyArray
from contactlab.outcome.columns import columns, csv_heading
from contactlab.outcome.files import replace_file, write_table
from contactlab.outcome.result import ImpactResult

#: A column of texts or numbers, or one text that all rows have.
Cells: TypeAlias = "str | AnyArray"
#: Rows of a CSV file from which on pyarrow is worth its import; also the rows of one batch.
MANY = 50_000
#: Rows that one format writes.
AT_ONCE = 500
#: A column of an npz is compressed if so many numbers of it shrink to this share.
SAMPLE, WORTH_WHILE = 8192, 0.5


def write_json(result: ImpactResult, path: str | Path) -> None:
    """Write ``result.to_dict``, and the history if the result has one."""
    content = result.to_dict()
    if result.history:
        content["history"] = result.history.to_dict()
    text = json.dumps(content, indent=2, allow_nan=False) + "\n"
    with replace_file(path) as stream:
        stream.write(text)


def write_csv(result: ImpactResult, path: str | Path) -> None:
    """Write one row for each impact, with the unit in each heading."""
    with replace_file(path) as stream:
        print_csv(result, stream)


def print_csv(result: ImpactResult, stream: TextIO) -> None:
    """Write what ``write_csv`` writes into a stream."""
    table, shape = columns(result), result.scene.shape
    headings = [csv_heading(name, unit, result.scene) for name, unit, _ in table]
    csv.writer(stream, lineterminator="\n").writerow(headings)
    cells = [_cells(values, shape) for _, _, values in table]
    rows = math.prod(shape)
    lines = _lines_of_many if rows >= MANY and find_spec("pyarrow") else _lines
    for first in range(0, rows, MANY):
        part = [each if isinstance(each, str) else each[first : first + MANY] for each in cells]
        stream.writelines(lines(part, min(MANY, rows - first)))


def _cells(value: object, shape: tuple[int, ...]) -> Cells:
    """Return a column as an array, words quoted; one text where all impacts have the same."""
    array = np.asarray(math.nan if value is None else value)
    array = np.broadcast_to(array, shape).ravel() if array.dtype != object else _flat(value, shape)
    words = array.dtype.kind == "U"
    bits = array.view(np.int64) if array.dtype == np.float64 else array  # -0.0 is not 0.0
    if not array.size or (bits[1:] == bits[0]).all():
        return _quote(array[0]) if words else repr(array[0].item())
    if not words:
        return array
    different, places = np.unique(array, return_inverse=True)
    return np.array([*map(_quote, different)])[places]


def _quote(word: str) -> str:
    """Return a word as a cell of a CSV file."""
    return '"' + word.replace('"', '""') + '"' if set(word) & set(',"\r\n') else str(word)


def _lines(cells: Sequence[Cells], rows: int) -> Iterator[str]:
    """Yield the lines of a CSV file, each number with the shortest digits that give it back."""
    # One format for many rows: joining texts of cells takes a fifth of the time of their digits.
    columns = [each for each in cells if not isinstance(each, str)]
    form = ",".join(_form(each) for each in cells) + "\n"
    for first in range(0, rows, AT_ONCE):
        last = min(first + AT_ONCE, rows)
        parts = zip(*(column[first:last].tolist() for column in columns), strict=True)
        yield form * (last - first) % tuple(itertools.chain.from_iterable(parts))


def _form(cell: Cells) -> str:
    """Return the format of a cell within the format of a row."""
    if isinstance(cell, str):
        return cell.replace("%", "%%")
    return "%s" if cell.dtype.kind == "U" else "%r"


def _lines_of_many(cells: Sequence[Cells], rows: int) -> Iterable[str]:
    """Return the same numbers by pyarrow, twice as fast; it writes 1 for 1.0."""
    if all(isinstance(each, str) for each in cells):  # no column tells how many rows there are
        return _lines(cells, rows)
    pyarrow, compute = map(importlib.import_module, ("pyarrow", "pyarrow.compute"))
    texts = [
        pyarrow.scalar(each) if isinstance(each, str)
        else pyarrow.array(each).cast(pyarrow.string())
        for each in cells
    ]  # fmt: skip
    lines: list[str] = compute.binary_join_element_wise(*texts, ",").to_pylist()
    return (f"{line}\n" for line in lines)


def write_history_csv(result: ImpactResult, path: str | Path) -> None:
    """Write the history of a single impact, one row for each instant."""
    history = result.history
    if not history or result.scene.shape:
        raise ValueError("result: has no history of a single impact; run(scene, history=True)")
    course = history.columns()
    headings = [csv_heading(name, history.unit(name), result.scene) for name in course]
    write_table(path, headings, list(zip(*course.values(), strict=True)))


def write_npz(result: ImpactResult, path: str | Path) -> None:
    """Write every column, and the history's arrays with the prefix ``history_``."""
    arrays = {name: _flat(values, result.scene.shape) for name, _, values in columns(result)}
    if result.history:
        course = result.history.columns() | result.history.fields
        arrays |= {f"history_{name}": column for name, column in course.items()}
    with replace_file(path, binary=True) as stream:  # numpy adds .npz to any other path
        _write_arrays(stream, arrays)


def _write_arrays(stream: IO[bytes], arrays: Mapping[str, AnyArray]) -> None:
    """Write arrays as npz, compressed only where numbers repeat and so shrink."""
    with zipfile.ZipFile(stream, "w", compresslevel=1) as archive:
        for name, values in arrays.items():
            archive.compression = _kind_of(np.ascontiguousarray(values))  # of the next file
            with archive.open(f"{name}.npy", "w", force_zip64=True) as file:
                np.lib.format.write_array(file, np.asanyarray(values), allow_pickle=False)


def _kind_of(values: AnyArray) -> int:
    """Return whether to store or to deflate an array, by numbers of its middle."""
    flat = values.reshape(-1)
    first = max(0, (flat.size - SAMPLE) // 2)
    sample = flat[first : first + SAMPLE].tobytes()
    shrinks = len(zlib.compress(sample, 1)) < WORTH_WHILE * len(sample)
    return zipfile.ZIP_DEFLATED if shrinks else zipfile.ZIP_STORED


#: Writer of each file format, by suffix.
WRITERS = {".json": write_json, ".csv": write_csv, ".npz": write_npz}


def _flat(value: object, shape: tuple[int, ...]) -> AnyArray:
    """Return a column as a flat array of numbers, or of names of statuses."""
    array = np.asarray(math.nan if value is None else value)
    if array.dtype != object:
        return np.broadcast_to(array.astype(np.float64), shape).ravel()
    if array.shape == shape and succeeded(array):  # looking up a million names takes long
        return np.full(array.size, Status.SUCCESS.name)
    items = np.broadcast_to(array, shape).ravel().tolist()
    return np.array([math.nan if each is None else getattr(each, "name", each) for each in items])
