"""Every law that fits a scene, each under the integrator that suits it, and how it does."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.compose import composition
from contactlab.compose.names import full_name, short_name
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.compose.simulation import Simulation
from contactlab.contracts import SteppedTangentialLaw, TangentialLaw, WholeImpactTangentialLaw
from contactlab.scene_file import LawChoice
from contactlab.study.compare import Comparison

#: The scene where none is given: psi2 over psi1 of a solid sphere, with what codes give.
DEFAULT_SCENE = Path(__file__).with_name("compiled_codes.toml")


class Candidates(NamedTuple):
    """Simulations by name, the reference first, and why other laws are left out."""

    simulations: dict[str, Simulation]
    left_out: dict[str, str]


@attrs.frozen(kw_only=True)
class Score:
    """How one law does over a sweep, against the first law of the comparison.

    Attributes
    ----------
    law, integrator : str
        The integrator is empty for a law that needs none.
    rms, worst : float
        Of psi2, less that of the first law.
    where : float
        psi1 of the worst.
    numerical_error : float
        Largest that is estimated, or declared, of psi2; NaN if unknown.
    energy_made : float
        Largest share of the energy at the start that the books find made from nothing.
    pressed_force : float
        What pressing alone adds to the force of a sheared Hertz contact, over mu P_max; NaN of
        a law that answers to no step.
    run_time_per_impact : float
        In s, in the sweep.
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
    """Return every installed tangential law that fits the normal law, in each of its forms.

    The first is the best that fits: the exact solution over elastic Hertz contact. The
    integrator is the one chosen where that runs the law, else the best that does.
    """
    normal = laws.resolved().made("normal")
    first = composition.preferred("tangential", normal)
    names = [short_name(name) for name in REGISTRY.names("tangential")]
    simulations: dict[str, Simulation] = {}
    left_out: dict[str, str] = {}
    for name in [first, *(other for other in names if other != first)]:
        try:
            law = REGISTRY.create(full_name("tangential", name))
        except (PluginError, ValueError) as error:
            left_out[name] = str(error)
            continue
        if complaint := composition.misfit(normal, law):
            left_out[name] = complaint
            continue
        for words in _forms(law):
            chosen = laws.choose(tangential=name)
            chosen = chosen.set({f"tangential.{key}": word for key, word in words.items()})
            label = " ".join([name, *words.values()])
            simulations[label] = chosen.suited().simulation()
    return Candidates(simulations, left_out)


def _forms(law: TangentialLaw) -> list[dict[str, str]]:
    """Return the choices of words that a law has: none, for its defaults, and each other one."""
    found: list[dict[str, str]] = [{}]
    for field in getattr(type(law), "__attrs_attrs__", ()):  # a law of a stranger may be no attrs
        others = field.metadata.get("words", ())
        found += [{field.name: word} for word in others if word != getattr(law, field.name)]
    return found


def scores(comparison: Comparison, simulations: dict[str, Simulation]) -> list[Score]:
    """Return the score of each law of a comparison, the reference first."""
    psi1 = np.ravel(comparison.scene.psi1 * np.ones(comparison.scene.shape))
    found = []
    for run in comparison.runs:
        law = simulations[run.name].tangential
        off = np.ravel(np.abs(comparison.difference("psi2", run.name)))
        made = -np.ravel(run.result.energy.relative_imbalance)
        known = np.isfinite(off)
        place = int(np.argmax(np.where(known, off, -1.0)))
        whole = isinstance(law, WholeImpactTangentialLaw)
        integrator = run.result.laws["integrator"].partition(" ")[0]
        found.append(
            Score(
                law=run.name,
                integrator="" if whole else integrator,
                rms=float(np.sqrt(np.mean(off[known] ** 2))) if known.any() else np.nan,
                worst=float(off[place]) if known.any() else np.nan,
                where=float(psi1[place]),
                numerical_error=_largest(comparison.numerical_error(run.name)),
                energy_made=max(_largest(made), 0.0) + 0.0,
                pressed_force=pressed_force(law),
                run_time_per_impact=run.run_time_per_impact,
            )
        )
    return found


def pressed_force(law: TangentialLaw) -> float:
    """Return what a growing load alone adds to the force of a sheared contact, over mu P_max."""
    if not isinstance(law, SteppedTangentialLaw):
        return np.nan
    from contactlab.testing.bench import Bench, drive, straight

    path = straight((0.0, 0.4), (0.3, 0.4), (0.3, 1.0))
    force = drive(law, Bench.of(), path).force
    sheared = 2 * len(force) // 3  # the last of the three legs only presses
    return float(np.max(np.abs(force[sheared:])) - abs(force[sheared - 1]))


def _largest(values: Any) -> float:
    values = np.ravel(values)
    return float(np.max(values[np.isfinite(values)])) if np.isfinite(values).any() else np.nan
