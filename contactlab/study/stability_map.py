"""The usable region of a method: numerical error over resolution and chi."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose.composition import DEFAULT_NORMAL
from contactlab.compose.names import full_name
from contactlab.compose.registry import REGISTRY
from contactlab.impact.scene import Scene
from contactlab.study.bench_methods import Method
from contactlab.study.stability_cases import Case, Extreme
from contactlab.study.stability_judge import ANSWERED, RAISED, WRONG, Outcome, judge
from contactlab.study.stability_references import converges

Array = NDArray[np.float64]

#: States of a cell: the state of its worst impact.
ALL_ANSWERED, ONE_REFUSED, ONE_RAISED, ONE_WRONG, NOT_TRIED = range(5)
STATES = {ANSWERED: ALL_ANSWERED, RAISED: ONE_RAISED, WRONG: ONE_WRONG}
#: Estimated steps under a tolerance, sqrt((1 + chi)/tolerance), beyond which a cell is not tried.
MOST_STEPS = 3e4
#: psi1 of the impacts in each cell.
INCIDENCES = (0.3, 0.95, 1.2)
CHIS = tuple(np.geomspace(0.05, 1e4, 17).tolist())
STEPS = (1, 2, 3, 4, 6, 9, 14, 21, 32, 48, 72, 108, 162, 243, 365, 547, 820, 1230, 1845, 2768, 4152)
TOLERANCES = tuple((10.0 ** -np.arange(0.0, 6.1, 1.0)).tolist())
QUICK_CHIS = (0.05, 0.5, 3.0, 30.0)
QUICK_STEPS = (1, 5, 9, 30)
QUICK_TOLERANCES = (0.1, 1e-3)


@attrs.frozen(kw_only=True, eq=False)
class Region:
    """Largest numerical error over the range at each resolution (rows) and chi (columns).

    Attributes
    ----------
    converges : bool
        Whether the law converges to the elastic continuum. If not, errors are against the law's
        own exact answer, and do not contain its model error.
    word : str
        ``steps`` or ``tolerance``.
    error : array, shape (rows, columns)
        NaN where every impact was refused.
    state : array of int
        ``ALL_ANSWERED``; ``ONE_REFUSED``, ``ONE_RAISED`` or ``ONE_WRONG`` where at least one
        impact was refused, raised or is silently wrong; ``NOT_TRIED`` for more steps than
        ``MOST_STEPS``, or after the time limit.
    failures : tuple of Outcome
        The impacts that are silently wrong or raised.
    complete : bool
        False if the time limit left cells out.
    """

    method: str
    word: str
    resolutions: tuple[float, ...]
    chis: tuple[float, ...]
    error: Array
    state: NDArray[np.int8]
    tried: int
    converges: bool = True
    failures: tuple[Outcome, ...] = ()
    complete: bool = True

    def count(self, outcome: str) -> int:
        """Return the number of impacts with an outcome, ``WRONG`` or ``RAISED``."""
        return sum(item.outcome == outcome for item in self.failures)


def region_cells(method: Method, *, quick: bool = False) -> list[tuple[float, float]]:
    """Return (resolution, chi) of every cell; empty for a method without steps or tolerance."""
    word = _word(method)
    if word is None or method.normal != DEFAULT_NORMAL:  # the map is judged by exact answers
        return []
    if word == "steps":
        resolutions: tuple[float, ...] = QUICK_STEPS if quick else STEPS
    else:
        resolutions = QUICK_TOLERANCES if quick else TOLERANCES
    return [(fine, chi) for fine in resolutions for chi in map_chis(quick=quick)]


def map_chis(*, quick: bool = False) -> tuple[float, ...]:
    """Return the values of chi of the map."""
    return QUICK_CHIS if quick else CHIS


def region(
    method: Method,
    cells: list[tuple[float, float]],
    *,
    until: float = np.inf,
    judged: Callable[[Case], Outcome] = judge,
) -> Region:
    """Return errors and states of a method over its cells, run in the order of ``cells``.

    Parameters
    ----------
    method : Method
    cells : list of tuple (resolution, chi)
    until : float
        Time (``time.perf_counter``) after which no cell is begun.
    judged : callable
        Runs one case and returns its outcome.
    """
    word = _word(method)
    assert word is not None
    resolutions = tuple(dict.fromkeys(fine for fine, _ in cells))
    chis = tuple(dict.fromkeys(chi for _, chi in cells))
    error = np.full((len(resolutions), len(chis)), np.nan)
    state = np.full(error.shape, ALL_ANSWERED, dtype=np.int8)
    failures: list[Outcome] = []
    tried = 0
    complete = True
    for fine, chi in cells:
        place = resolutions.index(fine), chis.index(chi)
        began = time.perf_counter()
        complete = began < until
        if not complete or (word == "tolerance" and (1.0 + chi) ** 0.5 / fine**0.5 > MOST_STEPS):
            state[place] = NOT_TRIED
            continue
        for psi1 in INCIDENCES:
            outcome = judged(_case(method, word, fine, psi1, chi))
            tried += 1
            state[place] = max(state[place], STATES.get(outcome.outcome, ONE_REFUSED))
            if outcome.outcome in (WRONG, RAISED):
                failures.append(outcome)
            error[place] = np.fmax(error[place], outcome.error)
    return Region(
        method=method.name,
        word=word,
        resolutions=resolutions,
        chis=chis,
        error=error,
        state=state,
        tried=tried,
        converges=converges(REGISTRY.law_class(full_name("tangential", method.tangential))),
        failures=tuple(failures),
        complete=complete,
    )


def _word(method: Method) -> str | None:
    if method.whole:
        return None
    word: str | None = REGISTRY.law_class(full_name("integrator", method.integrator)).resolution
    return word


def _case(method: Method, word: str, fine: float, psi1: float, chi: float) -> Case:
    """Return the case of one impact in a cell."""
    options: dict[str, dict[str, Any]] = {"tangential": {}, "integrator": {word: fine}}
    if hasattr(REGISTRY.law_class(full_name("integrator", method.integrator)), "refine"):
        options["integrator"]["refine"] = False  # the map shows the steps asked for
    scene = Extreme("map", "", lambda: Scene.nondimensional(psi1=psi1, chi=chi))
    return Case(
        family="map",
        label=f"psi1={psi1:g} chi={chi:.4g} {word}={fine:g}",
        method=method,
        options=options,
        scene=scene,
        planned=False,
    )
