"""A sweep in a folder: finished chunks, read by columns and chunks."""

from __future__ import annotations

import json
import math
import os
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.status import Status
from contactlab.numeric.checks import of_kind, refuse
from contactlab.numeric.names import nearest, tell_attributes
from contactlab.numeric.types import Json
from contactlab.outcome.answer import Checked
from contactlab.outcome.chunk_files import (
    DAMAGED,
    abouts_in,
    columns_of,
    read_about,
    refuse_damage,
    refuse_file,
)
from contactlab.outcome.chunk_forms import COLUMN_OF_STATUS, FORMS, NPZ, About, Form, find_gaps
from contactlab.outcome.columns import json_value
from contactlab.outcome.files import stamp
from contactlab.outcome.frames import import_optional
from contactlab.outcome.sheet import Sheet, batch_axes

if TYPE_CHECKING:
    from dask.dataframe import DataFrame as DaskFrame
    from matplotlib.axes import Axes
    from pandas import DataFrame
    from xarray import Dataset

    from contactlab.outcome.style import Width

#: Words of ``sweep.json`` for a folder of this kind, and for the codes of its statuses.
KIND, STATUSES = "columns of results", "statuses"
#: A number in a sentence.
NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def _tell(same: list[tuple[list[float], str, About]], total: int) -> str:
    """Return one sentence for several chunks whose sentences differ in numbers only."""
    _, sentence, about = max(same, key=lambda each: each[0])
    if len(same) == total and all(other == sentence for _, other, _ in same):
        return sentence
    others = "" if len(same) == 1 else f" (so say {len(same)} of {total} chunks, here the largest)"
    return f"impacts {about.first} to {about.stop}: {sentence}{others}"


class _Unchanged(NamedTuple):
    """A chunk's file, its notes, and its stamp when the folder was opened."""

    path: Path
    about: About
    stamp: tuple[int, ...]

    def check(self) -> None:
        """Refuse a file that is not the one that was opened."""
        if stamp(self.path) != self.stamp:  # by another sweep, maybe
            rule = "was written or removed after this folder was opened"
            raise refuse_file("path", self.path, rule, f"open {self.path.parent} again")


def _read(
    path: Path, form: Form, statuses: Sequence[str], about: About, names: Sequence[str]
) -> dict[str, NDArray[Any]]:
    """Return columns of a chunk by name, statuses by their words."""
    with columns_of(path, form, statuses, about.sums) as content:
        columns = {name: np.broadcast_to(content[name], about.chunk.size) for name in names}
    if COLUMN_OF_STATUS in columns:
        columns[COLUMN_OF_STATUS] = np.array(statuses)[columns[COLUMN_OF_STATUS]]
    return columns


def _frame(
    form: Form, statuses: Sequence[str], names: Sequence[str], chunk: _Unchanged
) -> DataFrame:
    """Return a ``pandas.DataFrame`` of columns of a chunk."""
    chunk.check()
    pandas = import_optional("pandas", "to_dask")
    index = pandas.RangeIndex(*chunk.about.chunk, name="impact")
    columns = _read(chunk.path, form, statuses, chunk.about, names)
    frame: DataFrame = pandas.DataFrame(columns, index)
    return frame


@tell_attributes
class SweepFolder(Checked):
    """The finished chunks of ``sweep(..., into=folder)``, read by columns and chunks.

    ``folder["psi2"]`` is a column of all impacts. ``folder.chunks("psi1", "psi2")`` reads a chunk
    after another, in the memory of one; ``folder.to_dask("psi1", "psi2")`` reads them when they are
    computed. ``to_dict``, ``to_dataframe`` and ``to_xarray`` take names of columns too.

    Parameters
    ----------
    path : str or Path
        The folder.

    Attributes
    ----------
    path : Path
    laws : mapping of str to str
        Names, versions and options of the three laws.

    Raises
    ------
    ValueError
        If the folder holds no such sweep, or a file in it is damaged.
    """

    def __init__(self, path: str | Path) -> None:
        rule = "must be the path of a folder"
        self.path = Path(of_kind("path", path, str, os.PathLike, rule=rule))
        there = (form for form in FORMS if os.path.exists(self.path / form.about))
        self._form = next(there, NPZ)
        try:
            about = dict(json.loads((self.path / self._form.about).read_text(encoding="utf-8")))
            if of_columns := about.get("form") == KIND:
                self.laws = {kind: about[kind] for kind in ("normal", "tangential", "integrator")}
                self._names = about[STATUSES].split()
        except (AttributeError, *DAMAGED) as error:
            rule = f"holds no sweep: {self._form.about} in it cannot be read: {error}"
            raise refuse("path", str(path), rule, "make one: sweep(scenes, into=folder)") from error
        if not of_columns:
            remedy = "the same sweep with keep=folder returns the result"
            raise refuse("path", str(path), "is a folder of keep=, without columns", remedy)

    @cached_property
    def _abouts(self) -> list[tuple[Path, About]]:
        """The finished chunks in order; sentences on failures stay in their files."""
        found = abouts_in(self.path, self._form)
        self._stamps = {path: stamp(path) for path, _ in found}
        return found

    @cached_property
    def impacts(self) -> int | None:
        """The number of impacts of the whole sweep; None until it is finished."""
        path = self.path / self._form.finished
        try:
            return int(json.loads(path.read_text("utf-8"))["impacts"])
        except FileNotFoundError:
            return None
        except (OverflowError, *DAMAGED) as error:
            raise refuse_damage("path", path, error) from error

    @property
    def missing(self) -> list[tuple[int, int]]:
        """First and stop of impacts that are not computed; of an unfinished sweep up to the last.

        The same sweep into the same folder computes them.
        """
        chunks = [about.chunk for _, about in self._abouts]
        last = (
            self.impacts if self.impacts is not None else max((c.stop for c in chunks), default=0)
        )
        return [(gap.first, gap.stop) for gap in find_gaps(chunks, last)]

    @property
    def complete(self) -> bool:
        """True if every impact of the sweep is computed."""
        return self.impacts is not None and not self.missing

    @property
    def units(self) -> Mapping[str, str]:
        """The unit of each column, by name; empty for the status."""
        return dict(self._abouts[0][1].units) if self._abouts else {}

    def __len__(self) -> int:
        """Return the number of impacts in finished chunks."""
        return sum(about.chunk.size for _, about in self._abouts)

    def chunks(self, *names: str) -> Iterator[tuple[slice, dict[str, NDArray[Any]]]]:
        """Yield the place of each finished chunk in the sweep, and its columns by name.

        Parameters
        ----------
        *names : str
            Columns, all of them by default; ``units`` lists them. The status is a name.

        Raises
        ------
        ValueError
            If there is no such column, or a file is damaged.
        """
        wanted = self._find_names(names)
        for path, about in self._check_chunks():
            yield slice(*about.chunk), _read(path, self._form, self._names, about, wanted)

    def _find_names(self, names: Sequence[str]) -> Sequence[str]:
        """Return names of columns, by default all, or refuse a name of no column."""
        wanted = names or tuple(self.units)
        for name in wanted:
            rule, remedy = "must be the name of a column", "'psi2', or chunks('psi1', 'psi2')"
            of_kind("column", name, str, rule=rule, remedy=remedy)
            if name not in self.units:
                known = ", ".join(self.units) or "none, as no chunk is finished"
                remedy = f"{nearest(name, self.units)}known: {known}"
                raise refuse("column", name, "is not a column of the sweep", remedy)
        return wanted

    def _columns(self, *names: str) -> dict[str, NDArray[Any]]:
        """Return columns of all impacts by name; no chunk may be missing."""
        if self.missing:
            first, stop = self.missing[0]
            rule = f"impacts {first} to {stop} are missing"
            remedy = "run the same sweep into the folder again, or read chunks()"
            raise refuse("path", str(self.path), rule, remedy)
        columns: dict[str, NDArray[Any]] = {}
        for place, part in self.chunks(*names):
            for name, values in part.items():
                if name not in columns:
                    columns[name] = np.empty(len(self), dtype=values.dtype)
                columns[name][place] = values
        return columns or {name: np.empty(0) for name in names}

    def _sheet(self, *names: str) -> Sheet:
        shape = (len(self),)
        return Sheet(self._columns(*names), self.units, batch_axes(shape), shape, self.laws)

    def to_dict(self, *names: str) -> dict[str, Json]:
        """Return laws, statuses, cautions and what is missing, and the columns that are named.

        Parameters
        ----------
        *names : str
            Columns; none by default, as a folder may have more impacts than memory holds.
        """
        columns = self._columns(*names) if names else {}
        return {
            "impacts": len(self),
            "missing": [list(span) for span in self.missing],
            "statuses": dict(self.statuses),
            "laws": dict(self.laws),
            "cautions": self.cautions,
            "units": dict(self.units),
            **{name: json_value(values) for name, values in columns.items()},
        }

    def to_dataframe(self, *names: str) -> DataFrame:
        """Return a ``pandas.DataFrame`` of columns of all impacts, units in ``.attrs["units"]``.

        Parameters
        ----------
        *names : str
            Columns, all of them by default.
        """
        from contactlab.outcome.frames import to_dataframe

        return to_dataframe(self._sheet(*names))

    def to_xarray(self, *names: str) -> Dataset:
        """Return an ``xarray.Dataset`` of columns of all impacts, with units.

        Parameters
        ----------
        *names : str
            Columns, all of them by default.
        """
        from contactlab.outcome.frames import to_xarray

        return to_xarray(self._sheet(*names))

    def to_dask(self, *names: str) -> DaskFrame:
        """Return a ``dask.dataframe.DataFrame`` of the finished chunks, read when it is computed.

        Its index is the place of each impact in the sweep. Each chunk is a partition, from files of
        NumPy and of Parquet alike, and is compared with its checksums.

        Parameters
        ----------
        *names : str
            Columns, all of them by default.
        """
        dask = import_optional("dask.dataframe", "to_dask", extra="dask,pandas,pyarrow")
        wanted = self._find_names(names)
        told = [_Unchanged(path, about, self._stamps[path]) for path, about in self._abouts]
        if not told:
            remedy = "run the sweep into it first"
            raise refuse("path", str(self.path), "holds no finished chunk", remedy)
        read = partial(_frame, self._form, self._names, wanted)
        edges = [*(chunk.about.first for chunk in told), told[-1].about.stop - 1]
        meta = read(told[0]).iloc[:0]
        frame: DaskFrame = dask.from_map(read, told, meta=meta, divisions=edges)
        return frame

    def _draw(self, axes: Axes | None, x: str | None, y: str | None, width: Width | None) -> Axes:
        """Draw one column over another, by default psi2 over psi1; only these two are read."""
        from contactlab.outcome.sheet_figure import draw_sheet  # matplotlib only when drawing

        x, y = x or "psi1", y or "psi2"
        return draw_sheet(axes, self._sheet(*dict.fromkeys((x, y))), x, y, width=width)

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return a column of the sweep up to its last chunk, shape (n,); no chunk may be missing.

        An unfinished sweep has fewer impacts, which ``check`` tells.
        """
        return self._columns(name)[name]

    @property
    def statuses(self) -> Mapping[str, int]:
        """The number of computed impacts of each status, by its name."""
        return dict(sum((Counter(about.counts) for _, about in self._abouts), Counter()))

    def _check_chunks(self) -> Iterator[tuple[Path, About]]:
        """Yield the finished chunks; refuse a file that is not the one that was opened."""
        for path, about in self._abouts:
            _Unchanged(path, about, self._stamps[path]).check()
            yield path, about

    def _iterate_failures(self) -> Iterator[tuple[int, str]]:
        for path, about in self._check_chunks():
            if [*about.counts] != [Status.SUCCESS.name]:
                for index, sentence in read_about(path, self._form).failures.items():
                    yield int(index), sentence

    @property
    def psi2_error(self) -> float:
        """Largest declared bound of the numerical error of psi2; NaN if one is not declared."""
        errors = [about.psi2_error for _, about in self._abouts]
        return max((math.nan if each is None else each for each in errors), default=math.nan)

    @property
    def cautions(self) -> list[str]:
        """Doubts about the numbers, in sentences.

        Chunks whose sentences differ in numbers only are told once, by the chunk with the largest
        numbers, with its impacts.
        """
        said: dict[str, list[tuple[list[float], str, About]]] = {}
        for _, about in self._abouts:
            for sentence in about.cautions:
                numbers = [float(each) for each in NUMBER.findall(sentence)]
                same = said.setdefault(NUMBER.sub("#", sentence), [])
                same.append((numbers, sentence, about))
        total = len(self._abouts)
        return [_tell(same, total) for same in said.values()]

    @property
    def _of_many(self) -> bool:
        return True

    def _status_at(self, index: int) -> Status:
        names = (
            columns[COLUMN_OF_STATUS][index - place.start]
            for place, columns in self.chunks(COLUMN_OF_STATUS)
            if place.start <= index < place.stop
        )
        return Status[next(names)]

    def _tell_missing(self) -> str:
        if self.complete:
            return ""
        gaps = ", ".join(f"{first} to {stop}" for first, stop in self.missing)
        what = f"it stopped after impact {len(self) - 1}" if len(self) else "no chunk is finished"
        what = f"impacts {gaps} are missing" if gaps else what
        return f"{self.path}: is not complete: {what}; the same sweep into this folder goes on"

    def __repr__(self) -> str:
        """Return path, number of impacts and statuses on one line."""
        counts = ", ".join(f"{count} {name}" for name, count in self.statuses.items())
        state = "" if self.complete else "; not complete"
        return f"SweepFolder({str(self.path)!r}; {len(self)} impacts; {counts or 'none'}{state})"
