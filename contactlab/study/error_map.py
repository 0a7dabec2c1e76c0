"""Error of psi2 over steps and chi, of a law under its usual integrator: a batch for each step."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np

from contactlab.contracts import TangentialLaw
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import yes_or_no
from contactlab.numeric.types import Array
from contactlab.registry import composition
from contactlab.registry.composition import DEFAULT_NORMAL, STEPPED, exact, fixed_steps
from contactlab.runs.simulation import Simulation
from contactlab.study.bench_methods import Method
from contactlab.study.posed import pose
from contactlab.study.stability_cases import INCIDENCES
from contactlab.study.stability_references import REFERENCE_TOLERANCES, converges

#: Columns, chi from light shells to heavy cores, and rows, steps of one contact.
CHIS = tuple(np.geomspace(0.05, 30.0, 36).tolist())
STEPS = (2, 3, 4, 5, 6, 7, 9, 11, 14, 18, 23, 30, 39, 50, 64, 83, 107, 138, 178, 230, 296, 400)
#: The same of a quick map.
QUICK_CHIS, QUICK_STEPS = tuple(np.geomspace(0.05, 30.0, 9).tolist()), (3, 9, 30, 100)
#: Steps that stand for the limit of a law without the continuum's limit: ten times the most mapped.
LIMIT_STEPS = 4000


@attrs.frozen(kw_only=True, eq=False)
class ErrorMap:
    """Largest error of psi2 over ``INCIDENCES`` at each number of steps and each chi.

    Attributes
    ----------
    law : str
    steps : tuple of int
    chis : tuple of float
    error : array, shape (steps, chis)
        Distance from the law's own limit, without the model error of one that is no continuum; NaN
        where an impact was refused or failed.
    """

    law: str
    steps: tuple[int, ...]
    chis: tuple[float, ...]
    error: Array


def error_maps(methods: Sequence[Method], *, quick: bool = False) -> list[ErrorMap]:
    """Return the map of each law that is marched in steps, under its usual integrator.

    Parameters
    ----------
    methods : sequence of Method
        Laws and integrators to choose from; those under other normal laws are left out.
    quick : bool
        Fewer cells.
    """
    chosen: dict[str, Method] = {}
    for usual in reversed(STEPPED):
        for method in methods:
            named = method.integrator == usual and method.normal == DEFAULT_NORMAL
            if named and not method.whole:
                chosen[method.tangential] = method
    laws = dict.fromkeys(method.tangential for method in methods)
    return [error_map(chosen[law], quick=quick) for law in laws if law in chosen]


def error_map(method: Method, *, quick: bool = False) -> ErrorMap:
    """Return the map of a law under an integrator of fixed steps that refuses too few.

    Parameters
    ----------
    method : Method
    quick : bool
        Fewer cells.
    """
    steps, chis = (QUICK_STEPS, QUICK_CHIS) if yes_or_no("quick", quick) else (STEPS, CHIS)
    psi1, chi = (each.ravel() for each in np.meshgrid(INCIDENCES, chis, indexing="ij"))
    law = composition.law("tangential", method.tangential)
    scene = pose(Scene.nondimensional(psi1=psi1, chi=chi), (law,))
    limit = _psi2(_limit(law), scene)
    rows = []
    for count in steps:
        march = composition.law("integrator", method.integrator, steps=count, refine=False)
        errors = np.abs(_psi2(Simulation(tangential=law, integrator=march), scene) - limit)
        rows.append(errors.reshape(len(INCIDENCES), -1).max(axis=0))  # NaN if one is NaN
    return ErrorMap(
        law=method.tangential,
        steps=steps,
        chis=chis,
        error=np.array(rows),
    )


def _limit(law: TangentialLaw) -> Simulation:
    """Return the reference of a law: the exact solution, or the law itself in very many steps."""
    if converges(law):
        return Simulation(**exact(REFERENCE_TOLERANCES[-1]))
    return Simulation(tangential=law, integrator=fixed_steps(LIMIT_STEPS))


def _psi2(simulation: Simulation, scene: Scene) -> Array:
    """Return psi2 of each impact, NaN where it was refused or failed."""
    result = simulation.sweep(scene)
    return np.where(np.asarray(result.status) == Status.SUCCESS, result.psi2, np.nan)
