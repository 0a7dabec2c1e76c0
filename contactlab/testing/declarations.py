"""Checks of the declarations of a law: drift, bounds, dissipation, partners."""

from __future__ import annotations

import attrs
import numpy as np

from contactlab.contracts import (
    Increment,
    Integrator,
    Law,
    NormalContact,
    NormalLaw,
    SteppedTangentialLaw,
    TangentialLaw,
    TangentialResponse,
)
from contactlab.impact.scene import Scene
from contactlab.registry.registry import REGISTRY
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.check import apply_if, check, hold, within
from contactlab.testing.integrators import CHI
from contactlab.testing.laws import Yield, Yielding
from contactlab.testing.load_paths import scene

#: Bound of displacement less velocity times drift, over the greatest displacement.
AT = 1e-9
#: Bound of the declared dissipation's error, over the energy of the normal motion.
LOST = 1e-6
#: Impacts of the batches of these checks.
ANGLES = (0.4, 1.2, 2.5)


@attrs.frozen(kw_only=True)
class Noting(Yielding):
    """``Yielding`` that keeps the increments of its steps."""

    seen: list[Increment] = attrs.field(factory=list, eq=False, repr=False)

    def advance(
        self, state: Yield, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, Yield]:
        """Return the force of the spring, and keep the step."""
        self.seen.append(increment)
        return super().advance(state, increment, before, after)


@check(Integrator)
def drift(integrator: Integrator) -> None:
    """The displacement of a step is velocity times drift, if the drift is told (Increment)."""
    apply_if(SteppedTangentialLaw in integrator.needs, "The integrator has no steps.")
    law, impact = Noting(), scene(ANGLES[1], CHI)
    normal = normal_motion(REGISTRY.create("normal.hertz"), impact)
    integrator.integrate(impact, normal, law, None)
    apply_if(law.seen, "The integrator did not ask the law.")
    told = np.array([(*step[:2], step.drift) for step in law.seen], dtype=np.float64)
    moved, velocity, drifts = told.T
    apply_if(not np.isnan(drifts).all(), "The integrator does not tell the drift.")
    gap = float(np.max(np.abs(moved - velocity * drifts)) / np.max(np.abs(moved)))
    within(gap, AT, f"Displacements are {gap:.2g} off velocity times drift.")


@check(TangentialLaw)
def books_bound_told(law: TangentialLaw) -> None:
    """The bound of the energy books is a number >= 0 for each impact."""
    for impact in (scene(ANGLES[1], CHI), scene(np.array(ANGLES), CHI)):
        bound = np.asarray(law.books_bound(impact), dtype=np.float64)
        good = bound.shape in ((), impact.shape) and (bound >= 0.0).all()
        hold(good, f"books_bound = {bound!r}: must be at least 0, of shape {impact.shape} or ().")


@check(NormalLaw)
def dissipation(law: NormalLaw) -> None:
    """The declared dissipation is the loss of an impact without friction."""
    for impact in (scene(ANGLES[1], CHI), scene(np.array(ANGLES), CHI)):
        motion = normal_motion(law, impact)
        declared = np.asarray(law.dissipation(motion), dtype=np.float64)
        apply_if(not np.isnan(declared).all(), "The law declares none.")
        energy = 0.5 * impact.pair.normal_mass * np.square(impact.normal_speed)
        lost = energy - 0.5 * impact.pair.normal_mass * np.square(motion.final_rate)
        gap = float(np.max(np.abs(lost - declared) / energy))
        within(
            gap,
            LOST,
            f"An impact without friction loses another energy than is declared: off by {gap:.2g} "
            f"of the energy of the normal motion.",
        )


@check(Law)
def partners(law: Law) -> None:
    """Scenes are refused by a sentence, or not at all."""
    for impact in (scene(ANGLES[1], CHI), Scene.nondimensional(psi1=1.0, chi=CHI)):
        try:
            law.accept(impact)
        except ValueError as error:
            hold(str(error), "The law refuses a scene without a word.")
