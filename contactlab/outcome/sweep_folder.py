"""A sweep in a folder: finished chunks, read by columns and chunks."""

from __future__ import annotations

import itertools
import json
import math
import os
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from contactlab.contracts.status import Status
from contactlab.numeric.checks import of_kind, refuse
from contactlab.numeric.names import attributes_told, nearest
from contactlab.outcome.answer import Checked
from contactlab.outcome.chunk_files import (
    DAMAGED,
    abouts_in,
    columns_of,
    read_about,
    refuse_damaged,
    refuse_file,
)
from contactlab.outcome.chunk_forms import COLUMN_OF_STATUS, FORMS, NPZ, About
from contactlab.outcome.files import stamp
from contactlab.outcome.result import ImpactResult

#: What ``sweep.json`` says of a folder of this kind, and of the codes of its statuses.
KIND, STATUSES = "columns of results", "statuses"
#: A number in a sentence.
NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def about_of(
    result: ImpactResult,
    units: Mapping[str, str],
    counts: Mapping[str, int],
    *,
    first: int,
    stop: int,
    sweep: str,
    scene: str,
    sums: Mapping[str, int],
    computer: str,
) -> About:
    """Return what the chunk of a result tells.

    Parameters
    ----------
    result : ImpactResult
    units, counts, first, stop, sweep, scene, sums, computer
        As of ``About``.
    """
    error = float(np.max(result.plan.psi2_error))
    failures = result.failures if [*counts] != [Status.SUCCESS.name] else {}
    return About(
        first=first,
        stop=stop,
        sweep=sweep,
        scene=scene,
        units=units,
        counts=counts,
        failures={str(first + index): words for index, words in failures.items()},
        cautions=[str(caution) for caution in result.plan.cautions],
        psi2_error=None if math.isnan(error) else error,
        sums=sums,
        computer=computer,
    )


def _told(same: list[tuple[list[float], str, About]], total: int) -> str:
    """Return one sentence for those of several chunks, which differ in numbers only."""
    _, sentence, about = max(same, key=lambda each: each[0])
    if len(same) == total and all(other == sentence for _, other, _ in same):
        return sentence
    others = "" if len(same) == 1 else f" (so say {len(same)} of {total} chunks, here the largest)"
    return f"impacts {about.first} to {about.stop}: {sentence}{others}"


@attributes_told
class SweepFolder(Checked):
    """The finished chunks of ``sweep(..., into=folder)``, read by columns and chunks.

    ``folder["psi2"]`` is a column of all impacts. ``folder.chunks("psi1", "psi2")`` reads a chunk
    after another, in the memory of one.

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
            raise refuse_damaged("path", path, error) from error

    @property
    def missing(self) -> list[tuple[int, int]]:
        """First and stop of impacts that are not computed; of an unfinished sweep up to the last.

        The same sweep into the same folder computes them.
        """
        spans = [(about.first, about.stop) for _, about in self._abouts]
        last = self.impacts if self.impacts is not None else max((b for _, b in spans), default=0)
        pairs = itertools.pairwise([(0, 0), *spans, (last, last)])
        return [(before, after) for (_, before), (after, _) in pairs if before < after]

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

    def chunks(self, *names: str) -> Iterator[tuple[slice, dict[str, Any]]]:
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
        wanted = names or tuple(self.units)
        for name in wanted:
            rule, remedy = "must be the name of a column", "'psi2', or chunks('psi1', 'psi2')"
            of_kind("column", name, str, rule=rule, remedy=remedy)
            if name not in self.units:
                known = ", ".join(self.units) or "none, as no chunk is finished"
                remedy = f"{nearest(name, self.units)}known: {known}"
                raise refuse("column", name, "is not a column of the sweep", remedy)
        for path, about in self._unchanged():
            with columns_of(path, self._form, self._names, about.sums) as content:
                columns = {
                    name: np.broadcast_to(content[name], about.chunk.size) for name in wanted
                }
            if COLUMN_OF_STATUS in columns:
                columns[COLUMN_OF_STATUS] = np.array(self._names)[columns[COLUMN_OF_STATUS]]
            yield slice(*about.chunk), columns

    def __getitem__(self, name: str) -> Any:
        """Return a column of the sweep up to its last chunk, shape (n,); no chunk may be missing.

        An unfinished sweep has fewer impacts: ``check`` tells.
        """
        if self.missing:
            first, stop = self.missing[0]
            rule = f"impacts {first} to {stop} are missing"
            remedy = "run the same sweep into the folder again, or read chunks()"
            raise refuse("path", str(self.path), rule, remedy)
        column = np.empty(0)
        for place, columns in self.chunks(name):
            if not column.size:
                column = np.empty(len(self), dtype=columns[name].dtype)
            column[place] = columns[name]
        return column

    @property
    def statuses(self) -> Mapping[str, int]:
        """The number of computed impacts of each status, by its name."""
        return dict(sum((Counter(about.counts) for _, about in self._abouts), Counter()))

    def _unchanged(self) -> Iterator[tuple[Path, About]]:
        """Yield the finished chunks; refuse a file that is not the one that was opened."""
        for path, about in self._abouts:
            if stamp(path) != self._stamps[path]:  # by another sweep, maybe
                rule = "was written or removed after this folder was opened"
                raise refuse_file("path", path, rule, f"open {self.path} again")
            yield path, about

    def _failed(self) -> Iterator[tuple[int, str]]:
        for path, about in self._unchanged():
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
        return [_told(same, total) for same in said.values()]

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

    def _unfinished(self) -> str:
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
