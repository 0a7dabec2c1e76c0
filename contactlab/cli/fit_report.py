"""A fit as tables, for reading, and its residuals as a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from contactlab.cli.table import table
from contactlab.fitting import Fit, Ranked
from contactlab.impact.scene import entry_unit
from contactlab.outcome.columns import QUANTITIES
from contactlab.outcome.files import write_table
from contactlab.outcome.tables import heading


def describe(found: Fit) -> str:
    """Return parameters with their intervals, and residuals, as tables."""
    headings = ["parameter", "value", "standard error", "95 % from", "to"]
    rows: list[list[Any]] = []
    for one in found.parameters.values():
        name = heading(one.name, one.unit)
        robust = () if one.robust is None else (one.robust,)
        more = (*(one.bootstrap or ()), *robust)
        rows.append([name, one.value, one.standard_error, *one.interval, *more])
    if any(one.bootstrap for one in found.parameters.values()):
        headings += ["bootstrap from", "to"]
    if any(one.robust is not None for one in found.parameters.values()):
        headings.append("robust")
    measured = found.measurements.measured
    residuals = [
        [name, QUANTITIES[name].unit, found.counts[name], found.rms[name],
         found.largest[name]]
        for name in measured
    ]  # fmt: skip
    parts = [
        f"{len(found.measurements)} impacts of {found.measurements.source or 'the data'}; "
        f"laws: {found.laws}",
        table(headings, rows, digits=5),
        table(["measured", "unit", "numbers", "rms residual", "largest"], residuals, digits=3),
    ]
    if found.measurements.unused:
        parts.append(f"columns not used: {', '.join(found.measurements.unused)}")
    if found.reduced_chi_square is not None:
        parts.append(f"reduced chi square: {found.reduced_chi_square:.3g}")
    parts += [f"note: {note}" for note in found.notes]
    return "\n\n".join(parts)


def ranking(ranked: list[Ranked]) -> str:
    """Return the laws in order, each with its own parameters."""
    fits = [one.fit for one in ranked if one.fit]
    names, quantities = list(fits[0].parameters), list(fits[0].rms)
    headings = ["law", "AIC - best", *names, *(f"rms {name}" for name in quantities)]
    best = min(one.aic for one in fits)
    rows = [
        [one.name, one.fit.aic - best, *(one.fit[name] for name in names), *one.fit.rms.values()]
        if one.fit
        else [one.name, *[None] * (1 + len(names) + len(quantities))]
        for one in ranked
    ]
    return f"laws by fit (a difference of 10 is beyond doubt)\n{table(headings, rows, digits=4)}"


def write_residuals(path: Path, shown: list[Ranked]) -> None:
    """Write a row for each measured number and law."""
    rows: list[list[Any]] = []
    given: list[str] = []
    for one in shown:
        assert one.fit is not None
        content = one.fit.measurements
        given = list(content.given)
        for name, residuals in one.fit.residuals.items():
            columns = [*content.given.values(), content.measured[name]]
            columns += [one.fit.predicted[name], residuals]
            rows += [
                [one.name, name, QUANTITIES[name].unit, impact + 1]
                + [float(column[impact]) for column in columns]
                for impact in np.flatnonzero(np.isfinite(residuals)).tolist()
            ]
    headings = [f"{name} ({entry_unit(name)})" for name in given]
    head = ["law", "quantity", "unit", "impact", *headings, "measured", "predicted", "residual"]
    write_table(path, head, rows)
