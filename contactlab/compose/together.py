"""Impacts in which friction changes the approach: normal and tangential motion together (§14)."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from contactlab.compose.answers import separated
from contactlab.compose.composition import Laws
from contactlab.compose.normal_motion import normal_or_failed
from contactlab.contracts import faults
from contactlab.contracts.integrator import Integrator
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import TangentialLaw
from contactlab.contracts.tangential_motion import Observer, TangentialMotion
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import chosen, spread
from contactlab.numeric.checks import shown
from contactlab.numeric.types import Mask, Real
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import ENDLESS, MARCHED, PlanColumns, Reason

#: Impacts solved at a time: their springs stay in the cache.
AT_A_TIME = 1000
#: Least bound of the imbalance of the energy books: where W is nearly singular the energy is the
#: small difference of large products.
CANCELS = 1e-4
#: Shares of W_nn that friction leaves, 1 - W_nt²/(W_nn W_tt), and the largest errors from each down
#: to a tenth of it, where abs(lam) > 1: of V2 over max(1, V2) and psi2 over max(1, psi1), in 1,200
#: random planar impacts by 50 springs and 200 steps.
NEAR_SINGULAR = ((0.1, 0.07), (0.01, 0.4), (0.001, 1.2))
#: Least slip at which cautions are asked, over the larger of two.
LITTLE = 1e-3
#: Statuses by which a law ends a whole batch: its impacts are then solved one by one.
GIVEN_UP = (Status.LAW_RAISED, Status.MALFORMED, Status.NON_FINITE)
#: Why impacts are not marched.
WHOLE = Reason("the law answers normal and tangential motion together")


def moved(laws: Laws, scene: Scene, normal: NormalMotion, observer: Observer | None) -> Motion:
    """Return the motion of impacts, or raise LawFaultError if a law fails."""
    law, integrator = laws.tangential, laws.integrator
    blamed: TangentialLaw | Integrator = law if law.together else integrator
    with faults.blaming(blamed):
        if law.together:
            answer = law.impacts_together(scene, normal, integrator.accuracy, observer)
        else:
            answer = integrator.integrate_together(normal, law, scene, observer)
        if not isinstance(answer, TangentialMotion) or (
            answer.normal is None and np.any(np.asarray(answer.status) == Status.SUCCESS)
        ):
            told = f"the answer {shown(answer)}, no TangentialMotion with the ends of its normal"
            sentence = faults.sentence(blamed, f"{told} motion", 1)
            raise faults.LawFaultError(Status.MALFORMED, sentence)
        return Motion.along(normal, answer, scene.slip_axes)


def given_up(motion: Motion) -> Any:
    """Return the impacts of a batch that may have failed because of one beside them."""
    statuses = np.asarray(motion.status, dtype=object)
    return np.isin(statuses, np.array(GIVEN_UP, dtype=object))


def columns_of(laws: Laws, scene: Scene, normal: NormalMotion) -> PlanColumns:
    """Return the columns of the plan: who answers, and the declared errors."""
    shape, together = scene.shape, laws.tangential.together
    code = chosen(separated(normal), 0 if together else MARCHED, ENDLESS)
    errors: tuple[Any, Any]
    if together:
        errors = laws.tangential.errors_together(scene, laws.integrator.accuracy)
    else:
        errors = laws.integrator.errors_together(normal, laws.tangential, scene)
    psi2, restitution = (spread(error, shape) for error in errors)
    return PlanColumns(code, psi2, (WHOLE,) if together else (), restitution)


def lasting(laws: Laws, scene: Scene, marched: Mask) -> str:
    """Return words on how long the march of some impacts takes, empty if nobody declares it."""
    part = scene if np.all(marched) else scene.take(marched)
    normal = normal_or_failed(laws.normal, part.central)
    seconds = laws.integrator.seconds_together(normal, laws.tangential, part)
    return f": about {seconds:.1g} s" if seconds > 0.0 else ""


def books_bound(laws: Laws, central: Scene) -> Any:
    """Return the bound of the imbalance of the energy books over the energy at the start."""
    bound: Any = laws.tangential.books_bound(central)
    return max(bound, CANCELS) if isinstance(bound, float) else np.maximum(bound, CANCELS)


def at_larger_slip(scene: Scene) -> Scene:
    """Return the central scene at the larger slip: at first touch, or as pressure alone leaves it.

    Sizes of cautions grow with the slip, and pressure makes slip where there is none at first.
    """
    return _at_slip(scene, np.maximum(*_slips(scene)))


def at_smaller_slip(scene: Scene) -> Scene:
    """Return the central scene at the smaller slip, but no less than a little of the larger.

    Some cautions hold of contacts that grip alone.
    """
    slips = _slips(scene)
    return _at_slip(scene, np.maximum(np.minimum(*slips), LITTLE * np.maximum(*slips)))


def _slips(scene: Scene) -> tuple[Any, Any]:
    """Return the slip speed at first touch, and that which pressure alone leaves."""
    drag = scene.coupling(2.0 * np.asarray(scene.normal_speed))
    return scene.slip_speed, scene.size_of(np.asarray(scene.slip_velocity) - drag)


def _at_slip(scene: Scene, slip: Real) -> Scene:
    """Return the central scene at a slip speed."""
    slip = spread(slip, scene.shape)
    return attrs.evolve(scene.central, tangential_velocity=slip).numbered(scene.index)


def cautions(laws: Laws, scene: Scene) -> list[str]:
    """Return a sentence for each doubt that only impacts with coupling raise."""
    said = []
    if not scene.planar and "partial_slip" in laws.tangential.offers:
        said.append(
            "springs in space: abs(q) <= mu p holds for each spring, not at every point; psi2 "
            "moves by less than 0.01 in four of five random impacts, by up to 0.1 where the slip "
            "turns most (model)"
        )
    if not laws.tangential.together:
        said += _near_singular(scene)
    return said


def _near_singular(scene: Scene) -> list[str]:
    """Return a caution where steps lose accuracy: friction can jam, and W is nearly singular."""
    jams = scene.size_of(np.asarray(scene.lam)) > 1.0
    least = float(np.min(scene.free_share, where=jams, initial=1.0))
    if least > NEAR_SINGULAR[0][0]:
        return []
    sizes = [f"by up to {error:g}" for share, error in NEAR_SINGULAR if least > share / 10.0]
    known = sizes[0] if sizes else "by more than the whole answer"
    return [
        "friction can jam and W is nearly singular, "
        f"1 - W_nt²/(W_nn W_tt) = {least:.2g}: 50 springs in 200 steps were off {known} there "
        "(numerical error; in the plane fronts is exact)"
    ]
