"""A fit as tables, and its residuals as a file."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from contactlab.impact.scene import entry_unit
from contactlab.outcome.answer import ImpactError
from contactlab.outcome.columns import QUANTITIES
from contactlab.outcome.files import write_table
from contactlab.outcome.tables import heading
from contactlab.outcome.text_table import table
from contactlab_fit import Fit, Ranked
from contactlab_fit.conventions import Reading, Result

#: Most letters of a refusal beside a reading: options that it names stand in whole.
LETTERS = 400


def tell_readings(
    readings: Sequence[Reading], fit_of: Callable[[Mapping[str, str]], Fit]
) -> list[Result]:
    """Return the fit by each reading of headings, in words; empty if there is one reading.

    The words are parameters and rms residuals, or the reason of a refusal.
    """
    if len(readings) == 1:
        return []
    told: list[Result] = []
    for reading in readings:
        try:
            found = fit_of(reading.columns)
        except (ValueError, ImpactError) as error:
            why = re.split(r"(?<=[a-z)])[.;] |: read so", str(error))[0][:LETTERS]
            told.append(Result(f"no fit: {why}", runs=False))
            continue
        values = [
            f"{name} {each.value:.3g} ± {each.standard_error:.1g}"
            for name, each in found.parameters.items()
        ]
        values += [f"rms of {name} {rms:.3g}" for name, rms in found.rms.items()]
        told.append(Result(", ".join(values), runs=True))
    return told


def describe(fit: Fit) -> str:
    """Return parameters with their intervals and residuals as tables."""
    headings = ["parameter", "value", "standard error", "95 % from", "to"]
    rows: list[list[Any]] = []
    for parameter in fit.parameters.values():
        name = heading(parameter.name, parameter.unit)
        robust = () if parameter.robust is None else (parameter.robust,)
        more = (*(parameter.bootstrap or ()), *robust)
        rows.append([name, parameter.value, parameter.standard_error, *parameter.interval, *more])
    if any(parameter.bootstrap for parameter in fit.parameters.values()):
        headings += ["bootstrap from", "to"]
    if any(parameter.robust is not None for parameter in fit.parameters.values()):
        headings.append("robust")
    measured = fit.measurements.measured
    residuals = [
        [name, QUANTITIES[name].unit, fit.counts[name], fit.rms[name],
         fit.largest[name]]
        for name in measured
    ]  # fmt: skip
    parts = [
        f"{len(fit.measurements)} impacts of {fit.measurements.source or 'the data'}; "
        f"laws: {fit.laws}",
        table(headings, rows, digits=5),
        table(["measured", "unit", "numbers", "rms residual", "largest"], residuals, digits=3),
    ]
    if fit.measurements.unused:
        parts.append(f"columns not used: {', '.join(fit.measurements.unused)}")
    if fit.reduced_chi_square is not None:
        parts.append(f"reduced chi square: {fit.reduced_chi_square:.3g}")
    if fit.taken:
        parts.append("taken, for no table or scene has them:\n  " + "\n  ".join(fit.taken))
    parts += [f"note: {note}" for note in fit.notes]
    parts += [f"caution: {caution}" for caution in fit.cautions]
    return "\n\n".join(parts)


def ranking(ranked: list[Ranked]) -> str:
    """Return a table of the laws in order, each with its fitted parameters."""
    fits = [law.fit for law in ranked if law.fit]
    names = list(dict.fromkeys(name for one in fits for name in one.parameters))
    quantities = list(dict.fromkeys(name for one in fits for name in one.rms))
    headings = ["law", "AIC - best", *names, *(f"rms {name}" for name in quantities)]
    best = min(one.aic for one in fits)
    rows = [
        [law.name, law.fit.aic - best, *_numbers(law.fit, names, quantities)]
        if law.fit
        else [law.name, *[None] * (1 + len(names) + len(quantities))]
        for law in ranked
    ]
    return f"laws by fit (a difference of 10 is beyond doubt)\n{table(headings, rows, digits=4)}"


def _numbers(fit: Fit, names: list[str], quantities: list[str]) -> list[float | None]:
    """Return parameters and rms residuals of a law; None for those that it lacks."""
    values = [fit[name] if name in fit.parameters else None for name in names]
    return [*values, *(fit.rms.get(name) for name in quantities)]


def further_cautions(first: Fit, ranked: list[Ranked]) -> list[str]:
    """Return cautions that the first law lacks, each once with the laws that have it."""
    laws: dict[str, list[str]] = {}
    for law in ranked:
        for text in law.fit.cautions if law.fit else ():
            laws.setdefault(text, []).append(law.name)
    return [
        f"caution of {' and '.join(names)}: {text}"
        for text, names in laws.items()
        if text not in first.cautions
    ]


def write_residuals(path: Path, shown: list[Ranked]) -> None:
    """Write the residuals as CSV, a row for each measured number under each law."""
    rows: list[list[Any]] = []
    entries: list[str] = []
    for law in shown:
        assert law.fit is not None
        content = law.fit.measurements
        entries = list(content.given)
        for name, residuals in law.fit.residuals.items():
            columns = [*content.given.values(), content.measured[name]]
            columns += [law.fit.predicted[name], residuals]
            rows += [
                [law.name, name, QUANTITIES[name].unit, impact + 1]
                + [float(column[impact]) for column in columns]
                for impact in np.flatnonzero(np.isfinite(residuals)).tolist()
            ]
    headings = [f"{name} ({entry_unit(name)})" for name in entries]
    head = ["law", "quantity", "unit", "impact", *headings, "measured", "predicted", "residual"]
    write_table(path, head, rows)
