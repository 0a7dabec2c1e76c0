"""Columns of a chunk of a sweep as a file of NumPy, or of Parquet by pyarrow."""

from __future__ import annotations

import contextlib
import importlib
import itertools
import json
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import IO, Any, NamedTuple, Protocol

import numpy as np

from contactlab.numeric.types import AnyArray, Places
from contactlab.outcome.frames import import_optional

COLUMN_OF_STATUS = "status"
#: Compression of columns of Parquet; no checksum covers the word of a file about it.
CODEC = "SNAPPY"
#: Key of the notes of a chunk in the metadata of a Parquet file.
TOLD = b"contactlab"
#: A hash of all bytes takes 6 % of a sweep, so numbers this many places apart are first added up.
LANES = 1021


class Chunk(NamedTuple):
    """The impacts from ``first`` up to, but not including, ``stop``: whole blocks of a sweep."""

    first: int
    stop: int

    @property
    def size(self) -> int:
        """Number of impacts."""
        return self.stop - self.first


def find_gaps(chunks: Iterable[Chunk], stop: int) -> list[Chunk]:
    """Return the impacts up to ``stop`` that no chunk has."""
    pairs = itertools.pairwise([Chunk(0, 0), *sorted(chunks), Chunk(stop, stop)])
    return [Chunk(one.stop, other.first) for one, other in pairs if one.stop < other.first]


class About(NamedTuple):
    """The notes of a chunk, beside its columns.

    Attributes
    ----------
    first, stop : int
        Its impacts.
    sweep, scene : str
        Fingerprints of the laws and of the scene.
    units : mapping of str to str
        The unit of each column, empty for the status.
    counts : mapping of str to int
        Number of impacts of each status.
    failures : mapping of str to str
        A sentence for each impact that failed, by its index in the sweep.
    cautions : sequence of str
    psi2_error : float or None
        Largest declared bound of the numerical error of psi2; None where it is not declared.
    sums : mapping of str to int
        The checksum of each column.
    computer : str
        What computed the impacts.
    """

    first: int
    stop: int
    sweep: str
    scene: str
    units: Mapping[str, str]
    counts: Mapping[str, int]
    failures: Mapping[str, str]
    cautions: Sequence[str]
    psi2_error: float | None
    sums: Mapping[str, int]
    computer: str

    @property
    def chunk(self) -> Chunk:
        """Its impacts."""
        return Chunk(self.first, self.stop)

    def to_json(self) -> str:
        """Return a text with its own checksum, from which ``read_notes`` reads the entries."""
        words = json.dumps(self._asdict())
        return json.dumps([words, zlib.crc32(words.encode())])


def read_notes(text: str) -> dict[str, Any]:
    """Return the notes of a chunk by name; ``ValueError`` if they are not as written."""
    words, checksum = json.loads(text)
    if zlib.crc32(words.encode()) != checksum:
        raise ValueError("its words are not those that were written")
    return dict(json.loads(words))


def checksum(values: AnyArray) -> int:
    """Return a number that changes if a number of a column does, or most two change places."""
    column = np.ascontiguousarray(values)
    if column.dtype != np.float64:
        return zlib.crc32(column.data)
    numbers = column.reshape(-1).view(np.uint64)
    even = numbers.size // LANES * LANES
    sums = numbers[:even].reshape(-1, LANES).sum(axis=0)
    return zlib.crc32(numbers[even:].data, zlib.crc32(sums.data))


class ByName(Protocol):
    """Columns of a file, each read when it is asked for; ``about`` is a text."""

    def __getitem__(self, name: str, /) -> AnyArray: ...


class Form(NamedTuple):
    """How the chunks of a folder are named, written and read.

    Attributes
    ----------
    suffix : str
        Suffix of the files, without a dot.
    digits : int
        Least digits of a number in a name.
    about, finished : str
        Names of the files that tell the sweep, and the number of its impacts.
    whole : bool
        Whether a column is stored as a whole that is one number for all impacts.
    write : callable
        Writes columns into a stream, with ``About`` and the names of statuses. The column of
        statuses has places among the names.
    read : callable
        Returns a context with the columns of a path by name, each read when it is asked for, and
        ``"about"``; takes the names of statuses too.
    """

    suffix: str
    digits: int
    about: str
    finished: str
    whole: bool
    write: Callable[[IO[bytes], Mapping[str, AnyArray], About, Sequence[str]], None]
    read: Callable[[Path, Sequence[str]], contextlib.AbstractContextManager[ByName]]


def _write_npz(
    stream: IO[bytes], columns: Mapping[str, Any], about: About, _: Sequence[str]
) -> None:
    np.savez(stream, **columns, about=np.array(about.to_json()))


@contextlib.contextmanager
def _read_npz(path: Path, _: Sequence[str]) -> Iterator[ByName]:
    with open(path, "rb") as stream, np.load(stream, allow_pickle=False) as content:
        yield content


def _write_parquet(
    stream: IO[bytes], columns: Mapping[str, AnyArray], about: About, names: Sequence[str]
) -> None:
    """Write statuses by name, and units as metadata of the columns."""
    pyarrow, parquet = _arrow()
    fields, arrays = [], []
    for name, values in columns.items():
        array = pyarrow.array(values)
        if name == COLUMN_OF_STATUS:
            array = pyarrow.DictionaryArray.from_arrays(array, [*names]).dictionary_decode()
        arrays.append(array)
        unit = {"unit": about.units[name]}
        fields.append(pyarrow.field(name, array.type, nullable=False, metadata=unit))
    schema = pyarrow.schema(fields, {TOLD: about.to_json().encode()})
    few = [name for name, values in columns.items() if not any(values.strides)]
    parquet.write_table(
        pyarrow.Table.from_arrays(arrays, schema=schema),
        stream,
        row_group_size=about.chunk.size,
        use_dictionary=[*few, COLUMN_OF_STATUS],  # other columns hardly repeat a number
        write_page_checksum=True,
        compression=CODEC,
    )


@contextlib.contextmanager
def _read_parquet(path: Path, names: Sequence[str]) -> Iterator[ByName]:
    pyarrow, parquet = _arrow()
    try:
        columns = _ParquetColumns(parquet, path, names)
        with columns.file:
            yield columns
    except pyarrow.ArrowException as error:
        raise ValueError(str(error)) from error


class _ParquetColumns:
    """The columns of a file of Parquet by name, and the notes of the chunk."""

    def __init__(self, parquet: ModuleType, path: Path, names: Sequence[str]) -> None:
        self.file = parquet.ParquetFile(path, page_checksum_verification=True)
        self.names = names

    def __getitem__(self, name: str) -> AnyArray:
        if name == "about":
            return np.array(self.file.schema_arrow.metadata[TOLD].decode())
        column = self.file.read([name], use_threads=False).column(name).combine_chunks()
        place = self.file.schema_arrow.get_field_index(name)
        # Read a column first: asked for a codec that it lacks, pyarrow ends the process.
        codec = self.file.metadata.row_group(0).column(place).compression
        if codec != CODEC:
            raise ValueError(f"{name} is compressed by {codec}, not {CODEC}")
        if name != COLUMN_OF_STATUS:
            values: AnyArray = column.to_numpy()
            if values.dtype != np.float64:
                raise ValueError(f"{name} is of {values.dtype}, not float64")
            return values
        coded = column.dictionary_encode()
        codes = [self.names.index(each) for each in coded.dictionary.to_pylist()]
        places: Places = coded.indices.to_numpy()
        return np.array(codes, dtype=np.uint8)[places]


def _arrow() -> tuple[ModuleType, ModuleType]:
    """Return the modules ``pyarrow`` and ``pyarrow.parquet``."""
    return import_optional("pyarrow", "Parquet"), importlib.import_module("pyarrow.parquet")


NPZ = Form("npz", 1, "sweep.json", "finished.json", False, _write_npz, _read_npz)
#: Programs that read a folder of Parquet take its files in the order of their names, and pass over
#: names that begin with an underscore.
PARQUET = Form("parquet", 12, "_sweep.json", "_finished.json", True, _write_parquet, _read_parquet)
FORMS = (NPZ, PARQUET)


def form_of(folder: Path) -> Form:
    """Return the form of a folder to write: Parquet by a name that ends with it, else NPZ."""
    if folder.suffix.lower() != f".{PARQUET.suffix}":
        return NPZ
    _arrow()
    return PARQUET
