"""Every law that fits a scene, its scores, and a comparison as CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TextIO

import attrs
import numpy as np
from numpy.typing import ArrayLike

from contactlab.contracts import SteppedTangentialLaw, TangentialLaw, WholeImpactTangentialLaw
from contactlab.impact.scene import entry_unit
from contactlab.numeric.types import Real
from contactlab.outcome.columns import QUANTITIES, csv_heading
from contactlab.outcome.tables import number, time
from contactlab.outcome.text_table import table
from contactlab.registration.names import short_name
from contactlab.registry import composition
from contactlab.registry.registry import REGISTRY, PluginError
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import LawChoice, SceneFile
from contactlab.study.comparison import Comparison
from contactlab.study.side_by_side import wrap

#: Scores below this are rounding errors and shown as 0.
ZERO = 1e-12
#: Default scene: psi2 over psi1 of a solid sphere, with the values of other codes.
DEFAULT_SCENE = Path(__file__).with_name("compiled_codes.toml")
CSV_HEADINGS = (
    "table", "quantity", "unit", "against", "x", "law", "value", "reference", "difference",
)  # fmt: skip


class Candidates(NamedTuple):
    """Simulations by name, the reference first; reasons by name for laws left out."""

    simulations: dict[str, Simulation]
    left_out: dict[str, str]


@attrs.frozen(kw_only=True)
class Score:
    """Scores of one law over a sweep, against the first law of the comparison.

    Attributes
    ----------
    law, integrator : str
        Names; the integrator is empty for a law that needs none.
    rms, worst : float
        Rms and largest absolute difference of psi2 from the first law.
    where : float
        psi1 at the largest difference.
    numerical_error : float
        Largest estimated or declared numerical error of psi2; NaN if neither is known.
    energy_made : float
        Largest energy from nothing, over the energy at the start.
    pressed_force : float
        Force that a growing load adds to a sheared Hertz contact, over mu P_max; NaN for a law
        that is not stepped.
    run_time_per_impact : float
        Run time per impact in the sweep, in s.
    """

    law: str
    integrator: str
    rms: float
    worst: float
    where: float
    numerical_error: float
    energy_made: float
    pressed_force: float
    run_time_per_impact: float = attrs.field(metadata={"unit": "s"})


def candidates(laws: LawChoice) -> Candidates:
    """Return simulations of every tangential law that fits the normal law, in each of its forms.

    The first is the preferred law: the exact solution under elastic Hertz contact. A simulation
    has the integrator chosen if that runs the law, else the preferred one.
    """
    normal = attrs.evolve(laws, normal=laws.normal or composition.DEFAULT_NORMAL).make("normal")
    first = composition.prefer_law("tangential", normal)
    names = [short_name(name) for name in REGISTRY.names("tangential")]
    simulations: dict[str, Simulation] = {}
    left_out: dict[str, str] = {}
    for name in [first, *(name for name in names if name != first)]:
        try:
            law = composition.law("tangential", name)
        except (PluginError, ValueError) as error:
            left_out[name] = str(error)
            continue
        for words in _forms(law):
            chosen = laws.choose(tangential=name)
            chosen = chosen.set({f"tangential.{key}": word for key, word in words.items()})
            label = " ".join([name, *words.values()])
            if complaint := composition.misfit(normal, chosen.make("tangential")):
                left_out[label] = complaint
            else:
                simulations[label] = chosen.suit().simulation()
    return Candidates(simulations, left_out)


def _forms(law: TangentialLaw) -> list[dict[str, str]]:
    """Return options that select each form of a law, by words: first none, for the default."""
    forms: list[dict[str, str]] = [{}]
    for field in getattr(type(law), "__attrs_attrs__", ()):  # a plug-in need not use attrs
        words = field.metadata.get("words", ())
        forms += [{field.name: word} for word in words if word != getattr(law, field.name)]
    return forms


def scores(comparison: Comparison, simulations: dict[str, Simulation]) -> list[Score]:
    """Return the score of each law of a comparison, the reference first."""
    psi1 = np.ravel(comparison.scene.psi1 * np.ones(comparison.scene.shape))
    listed = []
    for run in comparison.runs:
        law = simulations[run.name].tangential
        difference = np.ravel(np.abs(comparison.difference("psi2", run.name)))
        made = -np.ravel(run.result.energy.relative_imbalance)
        finite = np.isfinite(difference)
        place = int(np.argmax(np.where(finite, difference, -1.0)))
        whole = isinstance(law, WholeImpactTangentialLaw)
        integrator = run.result.laws["integrator"].partition(" ")[0]
        listed.append(
            Score(
                law=run.name,
                integrator="" if whole else integrator,
                rms=float(np.sqrt(np.mean(difference[finite] ** 2))) if finite.any() else np.nan,
                worst=float(difference[place]) if finite.any() else np.nan,
                where=float(psi1[place]),
                numerical_error=_largest(comparison.numerical_error(run.name)),
                energy_made=max(_largest(made), 0.0) + 0.0,  # no -0
                pressed_force=pressed_force(law),
                run_time_per_impact=run.run_time_per_impact,
            )
        )
    return listed


def pressed_force(law: TangentialLaw) -> float:
    """Return the force that a growing load adds to a sheared contact, over mu P_max."""
    if not isinstance(law, SteppedTangentialLaw):
        return np.nan
    from contactlab.testing.load_paths import Bench, drive, straight

    path = straight((0.0, 0.4), (0.3, 0.4), (0.3, 1.0))
    force = drive(law, Bench.of(), path).force
    sheared = 2 * len(force) // 3  # the third leg only presses
    return float(np.max(np.abs(force[sheared:])) - abs(force[sheared - 1]))


def _largest(values: ArrayLike) -> float:
    values = np.ravel(values)
    return float(np.max(values[np.isfinite(values)])) if np.isfinite(values).any() else np.nan


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
        measured, unit = agreement.measured, agreement.unit
        for law, values in agreement.predicted.items():
            columns = (measured.x, values, measured.values, agreement.difference(law))
            beside = (measured.beside.get(name, np.nan) for name in others)
            for row in _rows(*columns, *beside):
                start = ["measured", measured.quantity, unit, measured.against]
                writer.writerow([*start, row[0], law, *row[1:]])


def _rows(*columns: Real) -> Iterator[list[Any]]:
    for row in np.broadcast(*columns):
        yield ["" if np.isnan(item) else float(item) for item in row]


def describe_scores(scores: Sequence[Score], comparison: Comparison, file: SceneFile) -> str:
    """Return title and one row for each law: the reference first, the others by rms."""
    reference = scores[0].law
    headings = [
        "law", "integrator", "psi2: rms", "worst", "at psi1", "numerical error",
        "energy from nothing", "force from load alone", "time an impact",
    ]  # fmt: skip
    rows = []
    for score in [scores[0], *sorted(scores[1:], key=lambda score: score.rms)]:
        distance: list[str | float] = [score.rms, score.worst, score.where]
        if score.law == reference:
            distance = ["reference", "", ""]
        rows.append([
            score.law, score.integrator, *(_short(each) for each in distance),
            *map(_short, (score.numerical_error, score.energy_made, score.pressed_force)),
            time(score.run_time_per_impact),
        ])  # fmt: skip
    count = comparison.scene.shape[0]
    notes = (
        f"psi2: distance from {reference} over {count} impacts, model error and numerical error "
        "together. Numerical error of psi2: the largest estimated or declared one. Energy from "
        "nothing: over the energy at the start. Force from load alone: what pressing adds to a "
        "sheared contact, over mu P_max; a dash for laws that are not stepped. Time: in the sweep."
    )
    parts = [part for part in (file.title, wrap(file.citation)) if part]
    return "\n\n".join([*parts, table(headings, rows), wrap(notes)])


def _short(value: str | float) -> str:
    """Return text, or a number with two digits, 0 if it is a rounding error."""
    if isinstance(value, str):
        return value
    return "0" if abs(value) < ZERO else number(value, digits=2)
