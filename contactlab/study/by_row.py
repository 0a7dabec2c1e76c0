"""Every law against every row of a measured set: rms, rows within the error, chi²."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import attrs
import numpy as np

from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array
from contactlab.outcome.tables import heading, number
from contactlab.registry.composition import DEFAULT_NORMAL
from contactlab.runs.simulation import Simulation
from contactlab.study.agreement import by_rms
from contactlab.study.evidence import (
    NORMALS,
    Slopes,
    Source,
    evidence_of,
    measured_sets,
    simulations_over,
)
from contactlab.study.slopes import Row


@attrs.frozen(kw_only=True, eq=False)
class ByRow:
    """One measured quantity of a set, and the prediction of each law, row by row.

    Attributes
    ----------
    name, kind, title : str
    words : tuple of str
        Citation, how it was measured, licence and notes, as far as they are told.
    quantity : str
        Heading of the measured quantity, with its unit.
    rows : tuple of str
        Names of the rows.
    values, errors : array, shape (n,)
        Measured values and half-widths; 0 or NaN where none is told.
    laws : mapping of str to array, shape (n,)
        Values by law; NaN where the law fails.
    """

    name: str
    kind: str
    title: str
    words: tuple[str, ...]
    quantity: str
    rows: tuple[str, ...]
    values: Array
    errors: Array
    laws: Mapping[str, Array]

    @property
    def ordered(self) -> list[str]:
        """Names of the laws by rms; laws that fail come last."""
        return by_rms({law: self.rms(law) for law in self.laws})

    def off(self, law: str) -> Array:
        """Return predicted less measured values, shape (n,)."""
        return self.laws[law] - self.values

    def rms(self, law: str) -> float:
        """Return the rms of ``off``; NaN if the law fails in a row."""
        return float(np.sqrt(np.mean(self.off(law) ** 2)))

    def within(self, law: str) -> int:
        """Return the number of rows whose error covers the law."""
        return int(np.sum(np.abs(self.off(law)) <= self.errors, where=self.errors > 0.0))

    def chi2(self, law: str) -> float:
        """Return the mean of (off/error)² over rows with an error; NaN if none has one."""
        told = self.errors > 0.0
        return (
            float(np.mean((self.off(law)[told] / self.errors[told]) ** 2)) if told.any() else np.nan
        )

    def worst(self, law: str) -> str:
        """Return the row that is furthest off, over its error where all have one."""
        off = np.abs(self.off(law))
        off = off / self.errors if (self.errors > 0.0).all() else off
        place = int(np.argmax(np.nan_to_num(off, nan=np.inf)))
        found, told = (
            number(float(each), digits=3) for each in (self.laws[law][place], self.values[place])
        )
        return f"{self.rows[place]}: {found} for {told}"


def by_row(progress: Callable[[int, int], object] | None = None) -> Iterator[ByRow]:
    """Iterate over the measured quantities of all sets, slopes first.

    ``progress(done, total)`` follows each set.
    """
    sets = sorted(measured_sets(), key=lambda item: not isinstance(item, Slopes))
    for done, item in enumerate(sets, start=1):
        if isinstance(item, Slopes):
            yield _slopes(item)
        elif isinstance(item, Source):
            yield from _series(item)
        if progress is not None:
            progress(done, len(sets))


def slopes_of_laws(rows: Sequence[Row]) -> dict[str, Array]:
    """Return beta0 of every law in each row by name, shape (n,), as experimenters take it.

    The line of slip throughout is that of the law's own restitution.
    """
    found: dict[str, Array] = {}
    for normal in NORMALS:
        elastic = [normal == DEFAULT_NORMAL or row.restitution >= 1.0 for row in rows]
        losses = [
            None if each else row.restitution for each, row in zip(elastic, rows, strict=True)
        ]
        made = {loss: _laws(normal, loss) for loss in dict.fromkeys(losses)}
        for law in next(iter(made.values())):
            if any(law not in simulations for simulations in made.values()):
                continue  # does not fit every row
            found[law] = np.empty(len(rows))
            for loss, simulations in made.items():
                mine = [place for place, each in enumerate(losses) if each == loss]
                found[law][mine] = _slopes_of(simulations[law], [rows[place] for place in mine])
    return found


def _slopes_of(simulation: Simulation, rows: Sequence[Row]) -> list[float]:
    """Return the slope of one law in each row; rows of one psi1 and chi are run once."""
    apart = {(row.chi, row.psi1.tobytes()): row for row in rows}
    psi1 = np.concatenate([row.psi1 for row in apart.values()])
    sizes = [row.psi1.size for row in apart.values()]
    chi = np.repeat([row.chi for row in apart.values()], sizes)
    result = simulation.sweep(Scene.nondimensional(psi1=psi1, chi=chi))
    psi2 = np.split(np.broadcast_to(result.psi2, psi1.shape), np.cumsum(sizes)[:-1])
    e = float(np.ravel(result.normal_restitution)[0])
    slopes = {
        key: row.slope_of(after, e) for (key, row), after in zip(apart.items(), psi2, strict=True)
    }
    return [slopes[row.chi, row.psi1.tobytes()] for row in rows]


def _laws(normal: str, loss: float | None) -> dict[str, Simulation]:
    """Return tangential laws under a normal law with a restitution; elastic without one."""
    options = {DEFAULT_NORMAL: {}} if loss is None else {normal: {"restitution": loss}}
    beside = "" if normal == DEFAULT_NORMAL else f", {normal}"
    simulations = simulations_over(options)[0]
    return {name.partition(",")[0] + beside: item for name, item in simulations.items()}


def _slopes(item: Slopes) -> ByRow:
    file = item.read()
    return ByRow(
        name=item.name,
        kind=item.kind,
        title=file.title,
        words=(file.citation, file.how, f"Licence: {file.licence}.", file.notes),
        quantity="beta0",
        rows=tuple(row.name for row in file.rows),
        values=np.array([row.beta0 for row in file.rows]),
        errors=np.array([row.error for row in file.rows]),
        laws=slopes_of_laws(file.rows),
    )


def _series(item: Source) -> Iterator[ByRow]:
    one = evidence_of(item)
    for agreement in one.comparison.agreements:
        measured, known = agreement.measured, agreement.defined
        yield ByRow(
            name=item.name,
            kind=item.kind,
            title=one.file.title,
            words=(one.file.citation.strip(),),
            quantity=heading(measured.quantity, agreement.unit),
            rows=tuple(f"{measured.against} {x:.4g}" for x in measured.x[known]),
            values=measured.values[known],
            errors=measured.error[known],
            laws={law: values[known] for law, values in agreement.predicted.items()},
        )
