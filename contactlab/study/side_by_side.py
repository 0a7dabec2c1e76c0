"""A comparison, ``contactlab.study.comparison.Comparison``, as tables and plain numbers."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from contactlab.impact.scene import Scene, entry_unit
from contactlab.numeric.types import Array, Json, Real
from contactlab.outcome.columns import (
    COMPARISON_TABLE,
    columns_of,
    components,
    find_quantity,
    foreign,
    json_value,
)
from contactlab.outcome.tables import IN_SPACE, heading, number, time
from contactlab.outcome.text_table import table
from contactlab.scene_file import Measured, SceneFile
from contactlab.study.agreement import Agreement, LawRun

#: Laws beside each other, one impact's, above which each has a row.
MOST_COLUMNS = 4


class Compared(Protocol):
    """A comparison: the laws of ``contactlab.study.comparison.Comparison``, side by side."""

    @property
    def scene(self) -> Scene:
        """The scene or sweep."""

    @property
    def varied(self) -> Mapping[str, Real]:
        """Entries that vary."""

    @property
    def runs(self) -> Sequence[LawRun]:
        """The answer of each law, the reference first."""

    @property
    def agreements(self) -> Sequence[Agreement]:
        """Distances from each measured series."""

    @property
    def names(self) -> list[str]:
        """Names of the laws."""

    def values(self, quantity: str, law: str) -> Array:
        """Return a quantity of one law."""

    def difference(self, quantity: str, law: str) -> Array:
        """Return a quantity of one law less that of the first law."""

    def numerical_error(self, law: str) -> Array:
        """Return the numerical error of psi2 of one law."""


def default_quantities(comparison: Compared) -> list[str]:
    """Return the measured quantities, or psi2 of a sweep, or all defined ones of one impact."""
    measured = [agreement.measured.quantity for agreement in comparison.agreements]
    if measured:
        return list(dict.fromkeys(measured))
    scene = comparison.scene
    psi2 = [name for name, _ in components("psi2", comparison.runs[0].result.psi2, scene.shape)]
    known = {column.name for column in columns_of(scene)}
    if scene.shape:
        return [*psi2, "normal_restitution"] if "compressions" in known else psi2
    laws, others = comparison.names, [*COMPARISON_TABLE[1:], "compressions", *foreign()]
    return psi2 + [
        name
        for name in others
        if name.removesuffix("_deg") in known
        and not (scene.sphere is None and name in IN_SPACE)
        and not all(np.isnan(comparison.values(name, law)) for law in laws)
    ]


def describe(comparison: Compared, quantities: Sequence[str], file: SceneFile | None = None) -> str:
    """Return a file's title, tables, agreement with measured values, cautions and cost."""
    parts = [file.title, wrap(file.citation)] if file else []
    by_quantity: dict[str, list[Agreement]] = {name: [] for name in quantities}
    for agreement in comparison.agreements:
        by_quantity.setdefault(agreement.measured.quantity, []).append(agreement)
    if comparison.scene.shape:
        for name, agreements in by_quantity.items():
            parts += [_points(agreement) for agreement in agreements]
            if not agreements:
                parts.append(_over_sweep(comparison, name))
    else:
        parts += [_one_impact(comparison, quantities), *map(_points, comparison.agreements)]
    if comparison.agreements:
        parts.append(_agreement(comparison))
        opposite = dict.fromkeys(agreement.opposite for agreement in comparison.agreements)
        parts += [f"note: {sentence}" for sentence in opposite if sentence]
    parts += [_cautions(comparison), _cost(comparison)]
    return "\n\n".join(part for part in parts if part)


def _one_impact(comparison: Compared, quantities: Sequence[str]) -> str:
    """Return the quantities of one impact under all laws, a row each; of many laws a column."""
    first, *others = comparison.names
    if len(comparison.names) > MOST_COLUMNS:
        units = {name: find_quantity(name).unit_in(comparison.scene) for name in quantities}
        headings = ["law", *(heading(name, unit) for name, unit in units.items())]
        rows = [
            [law, *(float(comparison.values(name, law)) for name in quantities)]
            for law in comparison.names
        ]
        return table(headings, rows)
    headings = ["", *comparison.names, *(f"{name} - {first}" for name in others), "unit"]
    rows = []
    for name in quantities:
        values = [float(comparison.values(name, law)) for law in comparison.names]
        differences = [float(comparison.difference(name, law)) for law in others]
        rows.append([name, *values, *differences, find_quantity(name).unit_in(comparison.scene)])
    return table(headings, rows)


def _over_sweep(comparison: Compared, quantity: str) -> str:
    """Return one quantity under all laws, one row for each impact."""
    first, *others = comparison.names
    headings = [*map(_with_unit, comparison.varied)]
    headings += [*comparison.names, *(f"{name} - {first}" for name in others)]
    columns = [np.asarray(values) for values in comparison.varied.values()]
    columns += [comparison.values(quantity, law) for law in comparison.names]
    columns += [comparison.difference(quantity, law) for law in others]
    unit = find_quantity(quantity).unit_in(comparison.scene)
    return f"{heading(quantity, unit)}:\n{table(headings, np.transpose(columns).tolist())}"


def _points(agreement: Agreement) -> str:
    """Return measured values beside the laws, one row for each value."""
    measured = agreement.measured
    names = list(agreement.predicted)
    headings = [*map(_with_unit, measured.varied), "measured", "reading error"]
    headings += [*names, *(f"{name} - measured" for name in names)]
    columns = [
        *measured.varied.values(),
        measured.values,
        measured.error,
        *agreement.predicted.values(),
    ]
    columns += [agreement.difference(name) for name in names]
    rows = np.transpose(columns).tolist()
    title = heading(measured.quantity, agreement.unit)
    return f"{title}, measured: {measured.source}\n{table(headings, rows, digits=4)}"


def _agreement(comparison: Compared) -> str:
    """Return the rms and largest distance of each law from measured values."""
    rows = []
    for agreement in comparison.agreements:
        measured = agreement.measured
        for law in agreement.predicted:
            place = number(agreement.where_largest(law), digits=3)
            worst = f"at {measured.against} {place}"
            off = [agreement.rms(law), agreement.largest(law), agreement.unit]
            rows.append([measured.quantity, law, *off, worst])
    headings = ["law - measured", "law", "rms", "largest", "unit", "where largest"]
    return table(headings, rows, digits=3)


def _cautions(comparison: Compared) -> str:
    """Return the cautions of all plans, each once with the names of its laws."""
    about: dict[str, list[str]] = {}
    for run in comparison.runs:
        for sentence in run.result.plan.cautions:
            about.setdefault(str(sentence), []).append(run.name)
    lines = []
    for text, laws in about.items():
        all_laws = len(laws) == len(comparison.runs) > 1
        lines.append(f"caution, {'all laws' if all_laws else ', '.join(laws)}: {text}")
    return "\n".join(textwrap.fill(line, width=96, subsequent_indent="  ") for line in lines)


def _cost(comparison: Compared) -> str:
    """Return run time and number of successful impacts of each law."""
    first = comparison.runs[0].run_time_per_impact
    rows = []
    for run in comparison.runs:
        statuses = np.ravel(np.array(run.result.status, dtype=object))
        followed = f"{sum(bool(status) for status in statuses)} of {statuses.size}"
        ratio = number(run.run_time_per_impact / first, digits=2)
        rows.append([run.name, time(run.run_time_per_impact), ratio, followed])
    return table(["cost", "run time an impact", "relative", "impacts followed"], rows)


def _with_unit(entry: str) -> str:
    unit = entry_unit(entry)
    return entry if unit in ("1", "deg") else f"{entry} ({unit})"


def wrap(text: str) -> str:
    """Return a text in lines of 96 characters."""
    return textwrap.fill(" ".join(text.split()), width=96)


def to_dict(comparison: Compared, quantities: Sequence[str]) -> dict[str, Json]:
    """Return the comparison as numbers, lists and text, ready for JSON."""
    return {
        "laws": {
            run.name: {
                "versions": dict(run.result.laws),
                "run_time_per_impact_s": run.run_time_per_impact,
                "status": json_value(np.array(run.result.status, dtype=object))
                if comparison.scene.shape
                else json_value(run.result.status),
                "cautions": [str(sentence) for sentence in run.result.plan.cautions],
                "psi2_numerical_error": _list(comparison.numerical_error(run.name)),
                "values": {name: _list(comparison.values(name, run.name)) for name in quantities},
                "differences": {
                    name: _list(comparison.difference(name, run.name)) for name in quantities
                },
            }
            for run in comparison.runs
        },
        "varied": {name: _list(values) for name, values in comparison.varied.items()},
        "measured": [
            {
                "quantity": agreement.measured.quantity,
                "unit": agreement.unit,
                "against": agreement.measured.against,
                "source": agreement.measured.source,
                "x": _list(agreement.measured.x),
                **_other_entries(agreement.measured),
                "values": _list(agreement.measured.values),
                "error": _list(agreement.measured.error),
                "laws": {
                    law: {
                        "values": _list(values),
                        "rms": json_value(agreement.rms(law)),
                        "largest": json_value(agreement.largest(law)),
                    }
                    for law, values in agreement.predicted.items()
                },
            }
            for agreement in comparison.agreements
        ],
    }


def _other_entries(measured: Measured) -> dict[str, Json]:
    """Return the other entries of measured impacts, if they have some."""
    entries = {name: _list(values) for name, values in measured.beside.items()}
    return {"beside": entries} if entries else {}


def _list(values: Real) -> Json:
    return json_value(np.asarray(values)) if np.ndim(values) else json_value(float(values))
