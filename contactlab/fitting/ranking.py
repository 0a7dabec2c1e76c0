"""Ranking of laws by their fits to the same measurements."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import attrs

from contactlab.compose.simulation import Simulation
from contactlab.fitting.estimation import fit
from contactlab.fitting.measurements import read_measurements
from contactlab.fitting.outcome import Fit
from contactlab.outcome.result import ImpactError


@attrs.frozen(kw_only=True)
class Ranked:
    """A law and its fit; without a fit, ``refusal`` gives the reason."""

    name: str
    fit: Fit | None
    refusal: str = ""


def rank(
    measurements: object,
    scene: Any,
    simulations: Mapping[str, Simulation | None],
    *,
    progress: Callable[[int, int], object] | None = None,
    parameters: Sequence[str] = ("friction_coefficient",),
    **options: Any,
) -> list[Ranked]:
    """Return laws in the order of Akaike's criterion, the best first, laws without a fit last.

    Parameters
    ----------
    measurements, scene, parameters
        As for ``fit``.
    simulations : mapping of str to Simulation
        Laws by the names to report; None stands for the exact elastic laws.
    progress : callable, optional
        Called as ``progress(done, total)`` after each law.
    **options
        As for ``fit``.

    Raises
    ------
    ValueError
        If the measurements cannot be read. The failure of a single law is in its ``refusal``.
    """
    table = read_measurements(measurements)
    ranked = []
    for done, (name, simulation) in enumerate(simulations.items(), start=1):
        keywords = options | {"parameters": parameters, "simulation": simulation}
        try:
            ranked.append(Ranked(name=name, fit=fit(table, scene, **keywords)))
        except (ValueError, ImpactError) as error:
            ranked.append(Ranked(name=name, fit=None, refusal=str(error)))
        if progress is not None:
            progress(done, len(simulations))
    return in_order(ranked)


def in_order(ranked: Iterable[Ranked]) -> list[Ranked]:
    """Return laws with the lowest Akaike criterion first, laws without a fit last."""
    return sorted(ranked, key=lambda law: (law.fit is None, law.fit.aic if law.fit else 0.0))
