"""Even steps: how many an impact needs, and refinement or refusal of fewer."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from typing import ClassVar

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    CausalTangentialLaw,
    CoupledIntegrator,
    Errors,
    NormalMotion,
    Observer,
    SteppedTangentialLaw,
    Steps,
    TangentialLaw,
    TangentialMotion,
    claims,
    faults,
    judges,
    resolution_of,
    shares_loss,
)
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import choose, every, finite, for_share, greater
from contactlab.numeric.checks import count, flag
from contactlab.numeric.types import Real
from contactlab_laws.march import coupled, coupled_steps
from contactlab_laws.march.division import LARGEST_LEAD, LARGEST_PHASE_STEP, resolving
from contactlab_laws.march.march import march

#: Least steps under any tangential law: they resolve the normal load, half an oscillation.
LEAST_STEPS = math.ceil(math.pi / LARGEST_PHASE_STEP)
#: More steps than this are refused.
MOST_STEPS = 2_000_000
#: Ratio of one number of steps to the next where they are raised.
RAISE = 1.25

#: The march of impacts that all take the same number of steps.
EvenMarch = Callable[[NormalMotion, int], TangentialMotion]


def find_least_steps(normal: NormalMotion, law: TangentialLaw, scene: Scene | None = None) -> Real:
    """Return the least steps an impact that resolve omega = sqrt(stiffness/mass), batch shape.

    ``scene`` is that of ``normal`` unless friction changes the approach.
    """
    assert isinstance(law, SteppedTangentialLaw)
    if scene is not None and scene.inverse_mass is not None:
        assert isinstance(law, CausalTangentialLaw)
        steps: Real = greater(
            coupled_steps.find_least_steps(scene, normal, law), float(LEAST_STEPS)
        )
        return steps
    scene = normal.scene
    stiffness = judges.stiffness_of(law, scene, normal)
    if not scene.shape and isinstance(stiffness, float):
        single = math.sqrt(stiffness / scene.pair.tangential_mass) * float(normal.duration)
        least = single / LARGEST_PHASE_STEP
        if "partial_slip" not in claims(law):
            least = max(least, single * math.sqrt(single / (24.0 * LARGEST_LEAD)))
        return float(max(math.ceil(least), LEAST_STEPS)) if math.isfinite(least) else least
    omega = np.sqrt(stiffness / scene.pair.tangential_mass)
    return np.maximum(resolving(omega * normal.duration, law), float(LEAST_STEPS))


def refine_count(steps: int, needed: Real) -> Real:
    """Return ``steps``, or the first number >= ``needed`` of a sequence from it."""
    # With a sequence the impacts of a batch fall into a few groups of equal steps.
    if isinstance(needed, float) and needed <= steps:
        return float(steps)
    sequence = [float(steps)]
    while sequence[-1] < min(_most(needed), MOST_STEPS):
        sequence.append(min(math.ceil(sequence[-1] * RAISE), MOST_STEPS))
    sequence.append(np.inf)
    # No number is enough for NaN, which sorts behind infinity.
    return np.array(sequence)[np.minimum(np.searchsorted(sequence, needed), len(sequence) - 1)]


def _most(needed: Real) -> float:
    """Return the largest of the numbers that are not NaN."""
    return needed if isinstance(needed, float) else float(np.fmax.reduce(needed, axis=None))


def refusals(steps: int, needed: Real) -> str | NDArray[np.object_]:
    """Return the detail of ``TOO_FEW_STEPS`` for each impact."""
    told = f"steps = {steps}; this scene needs at least {{:.6g}}.".format
    if isinstance(needed, float):
        return told(needed)
    return np.array(list(map(told, np.ravel(needed))), dtype=object).reshape(np.shape(needed))


def in_groups(
    normal: NormalMotion, steps: int, needed: Real, taken: Real, even: EvenMarch
) -> TangentialMotion:
    """Return the motion of impacts, each marched by ``even`` in the steps ``taken`` alone."""
    shape = normal.scene.shape
    if isinstance(needed, float) and isinstance(taken, float) and needed <= taken <= MOST_STEPS:
        return even(normal, int(taken))
    possible = (needed <= taken) & (taken <= MOST_STEPS)
    if np.all(possible) and np.min(taken) == np.max(taken):
        return even(normal, int(np.max(taken)))
    if not shape:
        return TangentialMotion.nothing(shape, Status.TOO_FEW_STEPS, refusals(steps, needed))
    taken = np.broadcast_to(np.where(possible, taken, 0), shape)
    needed = np.broadcast_to(needed, shape)
    parts = []
    for number in np.unique(taken).tolist():
        where = taken == number
        if number:
            motion = even(normal.take(where), int(number))
        else:
            detail = refusals(steps, needed[where])
            motion = TangentialMotion.nothing(np.shape(needed[where]), Status.TOO_FEW_STEPS, detail)
        parts.append((where, motion))
    return TangentialMotion.merge(parts, shape)


@attrs.frozen(kw_only=True)
class FixedSteps(CoupledIntegrator):
    """Even steps over the contact's duration, under any normal law; a subclass samples them."""

    resolution: ClassVar[str | None] = "steps"
    offers: ClassVar[frozenset[str]] = frozenset({"several_contacts"})
    needs: ClassVar[frozenset[type]] = frozenset({SteppedTangentialLaw})

    steps: int | None = count(default=None, usual=200, most=MOST_STEPS)
    refine: bool = flag(default=True)

    @abstractmethod
    def divide(self, normal: NormalMotion, count: int, *, graded: bool) -> Steps:
        """Return ``count`` steps of a normal motion, ``graded`` towards its ends or even."""

    @property
    def _steps(self) -> int:
        """The steps of an impact whose stiffness they resolve."""
        return int(resolution_of(self))

    def _count_steps(self, needed: Real) -> Real:
        """Return how many steps each impact takes: ``steps``, or more if these are too few."""
        return refine_count(self._steps, needed) if self.refine else float(self._steps)

    def errors(self, scene: Scene, normal: NormalMotion, tangential: TangentialLaw) -> Errors:
        """Return the tangential law's declared errors at the steps taken, and these steps."""
        if scene.inverse_mass is None:
            needed = find_least_steps(normal, tangential, scene)
            taken = steps = self._count_steps(needed)
        else:
            assert isinstance(tangential, CausalTangentialLaw)
            needed = coupled_steps.find_least_steps(scene, normal, tangential)
            taken = self._take_coupled(needed)
            steps = self._count_steps(np.maximum(needed, LEAST_STEPS))
        declared = tangential.errors(scene, normal, taken)
        if type(declared) is not Errors:
            return declared  # the judge refuses it
        psi2, restitution, _ = declared
        if not every(followed := (needed <= taken) & (taken < math.inf)):
            psi2, restitution = (choose(followed, each, math.nan) for each in (psi2, restitution))
        return Errors(psi2, restitution, steps)

    def _take_coupled(self, needed: Real) -> Real:
        """Return the steps of each impact in the approach without friction; infinite if refused."""
        most = MOST_STEPS if self.refine else self._steps
        taken: Real = choose(needed <= most, greater(needed, float(self._steps)), math.inf)
        return taken

    def cautions(
        self, scene: Scene, normal: NormalMotion, tangential: TangentialLaw
    ) -> tuple[str, ...]:
        """Return a sentence if the steps are too few: the steps taken instead, or needed."""
        needed = find_least_steps(normal, tangential, scene)
        most = _most(needed)
        if most <= self._steps:
            return ()
        share = for_share(np.broadcast_to(needed > self._steps, scene.shape))
        if self.refine and most <= MOST_STEPS:
            to = int(np.max(refine_count(self._steps, needed)))
            raised = f"steps raised from {self._steps} to {to}{share}"
            return (f"{raised}: fewer do not resolve the stiffness",)
        return (f"{self._steps} steps are too few{share}: this scene needs {most:.6g}",)

    def integrate(
        self,
        scene: Scene,
        normal: NormalMotion,
        tangential: TangentialLaw,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion, in more steps than ``steps`` where these are too few.

        Impacts that are observed share one time axis: the most steps that any of them needs.
        """
        law = tangential
        assert isinstance(law, SteppedTangentialLaw)

        def even(normal: NormalMotion, number: int) -> TangentialMotion:
            with faults.blaming(normal.law):
                steps = self.divide(normal, number, graded=shares_loss(law, normal.law))
            return march(normal, law, steps, observer)

        try:
            with faults.blaming(law):
                needed = find_least_steps(normal, law)
            if observer is not None:
                needed = float(np.max(needed))
            return in_groups(normal, self._steps, needed, self._count_steps(needed), even)
        except faults.LawFaultError as fault:
            return TangentialMotion.nothing(scene.shape, fault.status, fault.detail)

    def integrate_coupled(
        self,
        scene: Scene,
        normal: NormalMotion,
        tangential: TangentialLaw,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion, ``steps`` counted on the approach without friction."""
        assert isinstance(tangential, CausalTangentialLaw)
        needed = coupled_steps.find_least_steps(scene, normal, tangential)
        taken = self._take_coupled(needed)
        words = "" if finite(taken) else refusals(self._steps, needed)
        refused = Status.TOO_FEW_STEPS, words
        return coupled.march_coupled(
            scene, normal, tangential, taken, observer, refused, usual=self._steps
        )
