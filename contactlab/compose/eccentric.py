"""Eccentric impacts under three laws: who answers, the plan and the motion (theory §14)."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from contactlab.compose import composition, sweep
from contactlab.compose.composition import Laws
from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.pieces import Chunk, Piece
from contactlab.compose.solve import WORK_ACCURACY, normal_or_failed
from contactlab.contracts import faults
from contactlab.contracts.eccentric import (
    EccentricIntegrator,
    EccentricMotion,
    EccentricObserver,
    EccentricTangentialLaw,
    IncrementalTangentialLaw,
    VectorTangentialLaw,
)
from contactlab.contracts.normal import NormalLaw
from contactlab.impact.cautions import rigid_bodies, unit_slips, unlikely
from contactlab.impact.eccentric import EccentricScene
from contactlab.numeric.checks import refuse
from contactlab.outcome.eccentric import (
    EccentricResult,
    balanced,
)
from contactlab.outcome.history import NO_HISTORY, EccentricHistory, NoHistory, Recorder
from contactlab.outcome.plan import MARCHED, Clause, Plan, PlanColumns

#: Least bound of the imbalance of the energy books: where W is nearly singular the energy is the
#: small difference of large products.
CANCELS = 1e-4
#: Shares of W_nn that friction leaves, 1 - W_nt²/(W_nn W_tt), and the largest errors from each down
#: to a tenth of it, where abs(lam) > 1: of V2 over max(1, V2) and psi2 over max(1, psi1), in 1,200
#: random planar impacts by 50 springs and 200 steps.
NEAR_SINGULAR = ((0.1, 0.07), (0.01, 0.4), (0.001, 1.2))


def run(laws: Laws, scene: EccentricScene, recorder: Recorder | None) -> EccentricMotion:
    """Return the motion of one impact, or of a batch by blocks.

    Raises
    ------
    ValueError
        If a law has no answer to the scene, or a history is asked of a batch.
    """
    accept(laws, scene)
    if not scene.shape:
        return _motion(laws, scene, recorder)
    if recorder is not None:
        raise refuse("history", True, "is kept of a single impact", "run them one by one")
    flat = scene.take(np.ones(scene.shape, dtype=bool)) if len(scene.shape) > 1 else scene
    piece = solved(laws, flat, Chunk(0, flat.shape[0]), sweep.ECCENTRIC_IMPACTS)
    return EccentricMotion.joined([piece.motion], scene.shape)


def result_of(
    laws: Laws,
    scene: EccentricScene,
    motion: EccentricMotion,
    started: float,
    history: EccentricHistory | NoHistory = NO_HISTORY,
) -> EccentricResult:
    """Return the result of a motion whose books are checked."""
    declared: Any = laws.tangential.books_bound(scene.central)
    bound = np.maximum(declared, CANCELS) + WORK_ACCURACY * (laws.integrator.accuracy or 0.0)
    return EccentricResult(
        scene=scene,
        plan=plan(laws, scene),
        motion=balanced(motion, scene, bound),
        run_time=time.perf_counter() - started,
        laws=composition.versions(*laws),
        history=history,
    )


def solved(laws: Laws, scene: EccentricScene, chunk: Chunk, block: int) -> Piece:
    """Return the piece of a sweep's chunk, a block at a time; ``scene`` is the chunk alone."""
    places = [slice(first, first + block) for first in range(0, chunk.size, block)]
    motions = [_motion(laws, scene.take(place), None) for place in places]
    shape = (chunk.size,)
    return Piece(chunk, PlanColumns.nothing(shape), EccentricMotion.joined(motions, shape))


def are_eccentric(scenes: Any) -> bool:
    """Return whether scenes are a batch, or a sequence, of eccentric ones."""
    if isinstance(scenes, list | tuple) and scenes:
        return isinstance(scenes[0], EccentricScene)
    return isinstance(scenes, EccentricScene)


def preferred(scene: EccentricScene) -> dict[str, str]:
    """Return the names of the laws that answer ``scene`` best: exact in the plane."""
    return composition.EXACT if scene.planar else composition.IN_SPACE


def accept(laws: Laws, scene: EccentricScene) -> None:
    """Refuse laws that have no answer to the scene, and name laws that have one."""
    tangential, integrator = laws.tangential, laws.integrator
    name = type(tangential).__name__
    where = "in the plane" if scene.planar else "in space"
    reason: str | None = None
    if isinstance(tangential, EccentricTangentialLaw):
        reason = tangential.refuses_eccentric(scene)
    elif not isinstance(tangential, IncrementalTangentialLaw):
        reason = "it needs the normal motion before the march, and here friction changes it"
    elif not scene.planar and not isinstance(tangential, VectorTangentialLaw):
        reason = "its displacement is a number, and here it is a vector of the tangent plane"
    elif not isinstance(integrator, EccentricIntegrator):
        name, reason = type(integrator).__name__, "it follows a normal motion that is known before"
    if reason is not None:
        words = ", ".join(f"{kind}={law!r}" for kind, law in preferred(scene).items())
        rule = f"has no answer to an eccentric impact {where}: {reason}"
        raise ValueError(f"{name}: {rule}; take Simulation({words})")


def _motion(
    laws: Laws, scene: EccentricScene, observer: EccentricObserver | None
) -> EccentricMotion:
    """Return the motion of one block; a normal law that fails has a status."""
    tangential, integrator = laws.tangential, laws.integrator
    try:
        normal = normal_motion(laws.normal, scene.central)
        with faults.blaming(tangential):
            if isinstance(tangential, EccentricTangentialLaw):
                accuracy = integrator.accuracy
                return tangential.eccentric_impacts(scene, normal, accuracy, observer)
            assert isinstance(integrator, EccentricIntegrator)
            assert isinstance(tangential, IncrementalTangentialLaw)
            return integrator.integrate_eccentric(scene, normal, tangential, observer)
    except faults.LawFaultError as fault:
        return EccentricMotion.nothing(scene.shape, fault.status, fault.detail)


def plan(laws: Laws, scene: EccentricScene) -> Plan:
    """Return what ``run`` computes for the scene, and its cautions."""
    everywhere = np.ones(scene.shape, dtype=bool)
    whole = isinstance(laws.tangential, EccentricTangentialLaw)
    how = "answered as a whole" if whole else f"marched by {type(laws.integrator).__name__}"
    names = f"{type(laws.normal).__name__}, {type(laws.tangential).__name__}"
    computed = (
        Clause(f"normal and tangential motion together: {names}, {how}", everywhere),
        Clause("velocities, impulse and energy books of the relative motion", everywhere),
    )
    if scene.planar:
        what = "second tangent: the motion stays in a plane"
    else:
        what = "error of psi2: none is declared in space"
    left_out = (Clause(what, everywhere),)
    cautions = tuple(Clause(text, everywhere) for text in _cautions(laws, scene))
    columns = PlanColumns.nothing(scene.shape)
    if not whole:
        columns = columns._replace(code=np.full(scene.shape, MARCHED))
    return Plan(columns, (computed, left_out, cautions))


def _cautions(laws: Laws, scene: EccentricScene) -> list[str]:
    """Return a sentence for each doubt about the model."""
    central = scene.central
    cautions = [*unit_slips(central), *unlikely(central), *rigid_bodies(central)]
    if scene.bodies:  # those of a law itself may have sizes that were measured for spheres
        cautions += NormalLaw.cautions(laws.normal, central, normal_or_failed(laws, central))
    if np.any(np.asarray(scene.pair.dundurs_beta) != 0.0):
        cautions.append(
            "unlike materials: pressure also shears the surfaces, which is left out (model)"
        )
    if not scene.planar and "partial_slip" in laws.tangential.offers:
        cautions.append(
            "springs in space: abs(q) <= mu p holds for each spring, not at every point; psi2 "
            "moves by less than 0.01 in four of five random impacts, by up to 0.1 where the slip "
            "turns most (model)"
        )
    if isinstance(laws.tangential, IncrementalTangentialLaw):
        cautions += _near_singular(scene)
    return cautions


def _near_singular(scene: EccentricScene) -> list[str]:
    """Return a caution where steps lose accuracy: friction can jam, and W is nearly singular."""
    W, drag = scene.inverse_mass, np.asarray(scene.lam)
    size = 2 if scene.planar else 3
    minor = np.linalg.det(W[..., 1:size, 1:size])
    left = np.linalg.det(W[..., :size, :size]) / (W[..., 0, 0] * minor)
    jams = np.abs(drag) > 1.0 if scene.planar else np.hypot(drag[..., 0], drag[..., 1]) > 1.0
    least = float(np.min(left, where=jams, initial=1.0))
    if least > NEAR_SINGULAR[0][0]:
        return []
    sizes = [f"by up to {error:g}" for share, error in NEAR_SINGULAR if least > share / 10.0]
    known = sizes[0] if sizes else "by more than the whole answer"
    return [
        "friction can jam and W is nearly singular, "
        f"1 - W_nt²/(W_nn W_tt) = {least:.2g}: 50 springs in 200 steps were off {known} there "
        "(numerical error; in the plane fronts is exact)"
    ]
