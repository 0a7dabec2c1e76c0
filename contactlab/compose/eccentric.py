"""Eccentric impacts under three laws: who answers, the plan and the motion (theory §14)."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contactlab.compose import composition, sweep
from contactlab.compose.composition import Laws
from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.pieces import Chunk, Piece
from contactlab.compose.solve import WORK_ACCURACY
from contactlab.contracts import faults
from contactlab.contracts.eccentric import (
    EccentricIntegrator,
    EccentricMotion,
    EccentricObserver,
    EccentricTangentialLaw,
    IncrementalTangentialLaw,
    VectorTangentialLaw,
)
from contactlab.impact.eccentric import EccentricScene
from contactlab.impact.hertz import hertz_scales
from contactlab.numeric.checks import refuse
from contactlab.outcome.eccentric import (
    EccentricHistory,
    EccentricRecorder,
    EccentricResult,
    balanced,
)
from contactlab.outcome.history import NO_HISTORY, NoHistory
from contactlab.outcome.plan import Clause, Plan, PlanColumns

if TYPE_CHECKING:
    from concurrent.futures import Executor

#: Least bound of the imbalance of the energy books: where W is nearly singular the energy is the
#: small difference of large products.
CANCELS = 1e-4
#: Above this ratio of contact radius to R the theory of half-spaces is doubtful (theory §8).
DOUBTFUL_SIZE_RATIO = 0.1
#: Shares of W_nn that friction leaves, 1 - W_nt²/(W_nn W_tt), and the largest errors from each down
#: to a tenth of it, where abs(lam) > 1: of V2 over max(1, V2) and psi2 over max(1, psi1), in 1,200
#: random planar impacts by 50 springs and 200 steps.
NEAR_SINGULAR = ((0.1, 0.07), (0.01, 0.4), (0.001, 1.2))


def run(laws: Laws, scene: EccentricScene, *, history: bool | str = False) -> EccentricResult:
    """Return the result of one impact, or of a batch.

    Raises
    ------
    ValueError
        If a law has no answer to the scene, or a history is asked of a batch.
    """
    started = time.perf_counter()
    _accept(laws, scene)
    if history and scene.shape:
        raise refuse("history", history, "is kept of a single impact", "run them one by one")
    recorder = EccentricRecorder() if history else None
    if scene.shape:
        flat = scene.take(np.ones(scene.shape, dtype=bool)) if len(scene.shape) > 1 else scene
        piece = solved(laws, flat, Chunk(0, flat.shape[0]), sweep.ECCENTRIC_IMPACTS)
        motion = EccentricMotion.joined([piece.motion], scene.shape)
    else:
        motion = _motion(laws, scene, recorder)
    kept = NO_HISTORY if recorder is None else recorder.history()
    return _result(laws, scene, motion, started, kept)


def _result(
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


def swept(
    laws: Laws,
    scenes: Any,
    *,
    progress: Callable[[int, int], object] | None,
    chunk: int | None,
    executor: Executor | None,
    keep: str | Path | None,
) -> EccentricResult:
    """Return the result of many impacts: a batch, or a sequence of single ones."""
    started = time.perf_counter()
    scene = scenes if isinstance(scenes, EccentricScene) else EccentricScene.stack(scenes)
    sweep.one_axis(scene.shape)
    _accept(laws, scene)
    options: dict[str, Any] = {"progress": progress, "chunk": chunk}
    _, motion = sweep.swept(laws, scene, solved, executor=executor, keep=keep, **options)
    return _result(laws, scene, motion, started)


def preferred(scene: EccentricScene) -> dict[str, str]:
    """Return the names of the laws that answer ``scene`` best: exact in the plane."""
    return composition.EXACT if scene.planar else composition.IN_SPACE


def _accept(laws: Laws, scene: EccentricScene) -> None:
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
    return Plan(
        computed=computed,
        left_out=left_out,
        cautions=tuple(Clause(text, everywhere) for text in _cautions(laws, scene)),
        marched=np.full(scene.shape, not whole),
        psi2_error=np.full(scene.shape, np.nan) if scene.shape else np.nan,
    )


def _cautions(laws: Laws, scene: EccentricScene) -> list[str]:
    """Return a sentence for each doubt about the model."""
    cautions = []
    scales = hertz_scales(scene.central)
    largest = float(np.max(np.asarray(scales.radius) / scene.pair.radius))
    if scene.bodies and largest > DOUBTFUL_SIZE_RATIO:
        cautions.append(
            f"C = {largest:.3g}, contact radius over R: the contact is not small against the "
            f"radius, the theory of half-spaces is doubtful above {DOUBTFUL_SIZE_RATIO}"
        )
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
    for body in scene.bodies:
        cautions += getattr(body, "cautions", lambda _: ())(float(np.min(scales.duration)))
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
