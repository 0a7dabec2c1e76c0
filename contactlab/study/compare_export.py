"""A comparison as JSON and CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from typing import Any, TextIO

import attrs
import numpy as np

from contactlab.impact.scene import entry_unit
from contactlab.outcome.columns import QUANTITIES, csv_heading, json_value
from contactlab.study.compare import Comparison
from contactlab.study.scores import Score

CSV_HEADINGS = (
    "table", "quantity", "unit", "against", "x", "law", "value", "reference", "difference",
)  # fmt: skip


def to_dict(comparison: Comparison, quantities: Sequence[str]) -> dict[str, Any]:
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
                "unit": QUANTITIES[agreement.measured.quantity].unit_in(comparison.scene),
                "against": agreement.measured.against,
                "source": agreement.measured.source,
                "x": _list(agreement.measured.x),
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


def plain_score(score: Score) -> dict[str, Any]:
    """Return a score as numbers and text, ready for JSON; None for NaN."""
    return {name: json_value(value) for name, value in attrs.asdict(score).items()}


def write_csv(comparison: Comparison, quantities: Sequence[str], stream: TextIO) -> None:
    """Write one row per value to ``stream``; the reference is the first law, or the measured value.

    The second and further varied entries have columns of their own at the end.
    """
    writer = csv.writer(stream, lineterminator="\n")
    others = dict(list(comparison.varied.items())[1:])
    headings = [csv_heading(name, entry_unit(name), comparison.scene) for name in others]
    writer.writerow([*CSV_HEADINGS, *headings])
    for name in quantities:
        unit = QUANTITIES[name].unit_in(comparison.scene)
        against, x = next(iter(comparison.varied.items()), ("", np.nan))
        for law in comparison.names:
            values, difference = comparison.values(name, law), comparison.difference(name, law)
            for row in _rows(x, values, values - difference, difference, *others.values()):
                writer.writerow(["scene", name, unit, against, row[0], law, *row[1:]])
    for agreement in comparison.agreements:
        measured = agreement.measured
        unit = QUANTITIES[measured.quantity].unit_in(comparison.scene)
        for law, values in agreement.predicted.items():
            columns = (measured.x, values, measured.values, agreement.difference(law))
            for row in _rows(*columns):
                start = ["measured", measured.quantity, unit, measured.against]
                writer.writerow([*start, row[0], law, *row[1:], *("" for _ in others)])


def _rows(*columns: Any) -> Iterator[list[Any]]:
    for row in np.broadcast(*columns):
        yield ["" if np.isnan(item) else float(item) for item in row]


def _list(values: Any) -> Any:
    return json_value(np.asarray(values)) if np.ndim(values) else json_value(float(values))
