"""Error control around even steps, doubled until psi2 keeps a tolerance."""

from __future__ import annotations

from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import (
    CausalTangentialLaw,
    CoupledIntegrator,
    Ends,
    NormalMotion,
    Observer,
    SteppedTangentialLaw,
    TangentialLaw,
    TangentialMotion,
    faults,
    shares_loss,
)
from contactlab.contracts.status import Status
from contactlab.impact.error_model import range_of
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import Rule, quantity
from contactlab.numeric.types import Array, Real
from contactlab_laws.march import coupled, coupled_steps
from contactlab_laws.march.division import midpoints
from contactlab_laws.march.fixed import (
    MOST_STEPS,
    find_least_steps,
    in_groups,
    refine_count,
    refusals,
)
from contactlab_laws.march.march import march

TOLERANCE = Rule(
    lambda value: np.ndim(value) == 0 and 1e-12 <= value <= 1.0,
    "must be one number in [1e-12, 1]",
)
#: Steps of the first try; they are doubled until the error is small enough.
FIRST = 32
#: Steps after which an impact ends without an answer if its approach without friction has no end.
USUAL = 200
#: Doubled steps divide the change of psi2 by 4 under a smooth law: from this ratio on the law
#: counts as smooth, and the error left is the last change over the ratio less 1.
SMOOTH = 3.0
#: Under a law that jumps the error is of first order and wanders: it is estimated by the larger of
#: the last change and half the change before it, times this.
WANDERS = 2.0
#: Least error estimate over the change before, as two answers may agree by chance.
BELIEVED = 1.0 / 6.0
#: psi2 is rounded to this part of max(1, |psi1|) by sums of many steps.
ROUNDING = 1e-13


@attrs.frozen(kw_only=True)
class Adaptive(CoupledIntegrator):
    """The steps of ``symplectic``, doubled until psi2 no longer changes by the tolerance.

    The error is measured on the answer of the whole impact, not summed over single steps. It is the
    error in time; the law's own discretisation adds another. The tolerance is an aim and no bound,
    so no error is declared: of 6,000 impacts of a linear spring at 1e-5, 141 were off by more than
    twice that, the worst by 22 times.

    Parameters
    ----------
    tolerance : float
        Tolerance of psi2 over max(1, |psi1|), from 1e-12 to 1. Cost grows as its inverse square
        root.

    References
    ----------
    Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993), §II.4:
    Richardson extrapolation as an estimate of the error.
    """

    api_version: ClassVar[int] = 2
    resolution: ClassVar[str | None] = "tolerance"
    needs: ClassVar[frozenset[type]] = frozenset({SteppedTangentialLaw})

    tolerance: float = quantity("1", rule=TOLERANCE, default=1e-4)

    def integrate(
        self,
        scene: Scene,
        normal: NormalMotion,
        tangential: TangentialLaw,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion; impacts of a batch choose their own steps."""
        law = tangential
        assert isinstance(law, SteppedTangentialLaw)

        def even(normal: NormalMotion, count: int) -> TangentialMotion:
            first = _march(normal, law, count)
            second = _march(normal, law, 2 * count) if _succeeds(first) else first
            if not _succeeds(second):
                return second
            return self._double(normal, law, 4 * count, (first, second), 3 * count)

        try:
            with faults.blaming(law):
                needed = find_least_steps(normal, law)
            motion = in_groups(normal, FIRST, needed, refine_count(FIRST, needed), even)
            if observer is not None:
                _march(normal, law, motion.counters.get("steps", FIRST), observer)
        except faults.LawFaultError as fault:
            return TangentialMotion.nothing(scene.shape, fault.status, fault.detail)
        return motion

    def integrate_coupled(
        self,
        scene: Scene,
        normal: NormalMotion,
        tangential: TangentialLaw,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion in steps that are doubled until no velocity changes by the tolerance.

        The tolerance is that of the velocities over the greatest of them at first touch.
        """
        assert isinstance(tangential, CausalTangentialLaw)
        needed = coupled_steps.find_least_steps(scene, normal, tangential)
        count = np.where(needed <= MOST_STEPS, np.maximum(needed, FIRST), np.inf)
        refused = Status.TOO_FEW_STEPS, refusals(FIRST, needed)
        before = coupled.march_coupled(scene, normal, tangential, count, None, refused, usual=USUAL)
        succeeded = np.asarray(before.status == Status.SUCCESS)
        if not succeeded.any():
            return before
        count = np.where(succeeded, count, np.inf)  # failed impacts are not followed again
        motion, count = self._double_coupled(scene, normal, tangential, count, before)
        if scene.shape:
            failed = before.status != Status.SUCCESS
            everywhere = np.ones(scene.shape, dtype=bool)
            parts = [(everywhere, motion), (failed, batch.take(before, scene.shape, failed))]
            steps = motion.counters
            motion = attrs.evolve(TangentialMotion.merge(parts, scene.shape), counters=steps)
        if observer is not None:
            coupled.march_coupled(scene, normal, tangential, count, observer)
        return motion

    def _double_coupled(
        self,
        scene: Scene,
        normal: NormalMotion,
        law: CausalTangentialLaw,
        count: Array,
        before: TangentialMotion,
    ) -> tuple[TangentialMotion, Array]:
        """Return motion and steps of each impact, doubled from ``before``, in ``count`` steps."""
        finer = np.where(2.0 * count <= MOST_STEPS, 2.0 * count, np.inf)
        sentence = "A velocity still changes by more than the tolerance at the most steps."
        refused = Status.UNRESOLVED, sentence
        last = coupled.march_coupled(scene, normal, law, finer, None, refused)
        moved = np.maximum(
            *(np.abs(a - b) for a, b in zip(*map(_rates, (last, before)), strict=True))
        )
        largest = np.maximum(np.abs(scene.velocity).max(axis=-1), 0.0)
        left = (moved > 3.0 * self.tolerance * largest) & (last.status == Status.SUCCESS)
        if not np.any(left):
            return last, finer
        if not scene.shape:
            return self._double_coupled(scene, normal, law, finer, last)
        middle = batch.take(last, scene.shape, left)
        more, most = self._double_coupled(
            scene.take(left), normal.take(left), law, finer[left], middle
        )
        finer[left] = most
        parts = [(np.ones(scene.shape, dtype=bool), last), (left, more)]
        steps = max(last.counters.get("steps", 0), more.counters.get("steps", 0))
        merged = TangentialMotion.merge(parts, scene.shape)
        return attrs.evolve(merged, counters={"steps": steps}), finer

    def _double(
        self,
        normal: NormalMotion,
        law: SteppedTangentialLaw,
        count: int,
        before: tuple[TangentialMotion, TangentialMotion],
        tried: int,
    ) -> TangentialMotion:
        """Return the motion in ``count`` steps, doubled where the error exceeds the tolerance."""
        # ``before``: in a quarter and half of the steps; ``tried``: steps taken before.
        shape = normal.scene.shape
        counters = {"steps": count, "evaluations": tried + count}
        last = attrs.evolve(_march(normal, law, count), counters=counters)
        if not _succeeds(last):
            return last
        error, allowed = self._error(*before, last), self._allow_change(normal.scene)
        unresolved = np.asarray(~(error <= allowed))
        if not unresolved.any():
            return last
        if 2 * count > MOST_STEPS:
            sentence = f"After {count} steps psi2 still changes by more than the tolerance."
            return last.failing(unresolved, Status.UNRESOLVED, sentence)
        if not shape or unresolved.all():
            return self._double(normal, law, 2 * count, (before[1], last), tried + count)
        middle, fine = (batch.take(motion, shape, unresolved) for motion in (before[1], last))
        finer = self._double(normal.take(unresolved), law, 2 * count, (middle, fine), 0)
        parts = ((np.ones_like(unresolved), last), (unresolved, finer))
        merged = TangentialMotion.merge(parts, shape)
        # The most steps that any impact took, and all evaluations.
        evaluations = counters["evaluations"] + finer.counters["evaluations"]
        return attrs.evolve(
            merged, counters={"steps": finer.counters["steps"], "evaluations": evaluations}
        )

    def _allow_change(self, scene: Scene) -> Real:
        """Return the tolerance as a change of slip velocity, in m/s."""
        unit, _, speed = range_of(scene)
        allowed: Real = max(self.tolerance, ROUNDING) * np.maximum(unit, speed)
        return allowed

    @staticmethod
    def _error(*motions: TangentialMotion) -> Array:
        """Return the estimated error of the last of three answers with doubled steps, in m/s."""
        coarse, middle, fine = (np.asarray(m.slip_velocity_change) for m in motions)
        earlier, last = np.abs(middle - coarse), np.abs(fine - middle)
        with np.errstate(all="ignore"):
            ratio = np.where(last > 0.0, earlier / last, np.inf)
            smooth = np.maximum(last / (np.minimum(ratio, 4.0) - 1.0), BELIEVED * earlier)
        error: Array = np.where(ratio >= SMOOTH, smooth, WANDERS * np.maximum(last, 0.5 * earlier))
        return error


def _rates(motion: TangentialMotion) -> tuple[Real, Array]:
    """Return the rate of approach at the end, and the largest change of a slip velocity."""
    slip = np.asarray(motion.slip_velocity_change)
    if slip.ndim > np.ndim(motion.status):
        slip = slip[..., 0] + 1j * slip[..., 1]
    return Ends.of(motion.normal).final_rate, slip


def _succeeds(motion: TangentialMotion) -> bool:
    """Return whether every impact was followed to its end."""
    return bool(np.all(motion.status == Status.SUCCESS))


def _march(
    normal: NormalMotion, law: SteppedTangentialLaw, count: int, observer: Observer | None = None
) -> TangentialMotion:
    """Return the motion in ``count`` steps that are even."""
    with faults.blaming(normal.law):
        steps = midpoints(normal, count, graded=shares_loss(law, normal.law))
    return march(normal, law, steps, observer)
