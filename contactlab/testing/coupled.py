"""Checks of what a law asks beyond forces: marks, a normal motion, partners, bounds."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.registry import REGISTRY
from contactlab.contracts import Integrator, Law, NormalLaw, SteppedTangentialLaw, TangentialLaw
from contactlab.contracts.sampled_motion import gathered
from contactlab.impact.scene import Scene
from contactlab.testing.check import apply_if, check, hold, hold_success
from contactlab.testing.coupled_laws import Exchanging, Marked
from contactlab.testing.integrators import CHI
from contactlab.testing.load_paths import scene

#: Bound of the distance of a step's end from a mark, over the greatest approach.
AT = 1e-9
#: Bound of what steps leave in the energy of a conservative coupling, over the energy.
CONSERVED = 0.02
#: Bound of the declared dissipation's error, over the energy of the normal motion.
LOST = 1e-6
#: Impacts of the batches of these checks.
ANGLES = (0.4, 1.2, 2.5)


@check(Integrator, claim="marks")
def marks(integrator: Any) -> None:
    """A step ends at every mark of a stepped law, also in batches (Integrator, 9)."""
    normal_law = REGISTRY.create("normal.hertz")
    batch = scene(np.array(ANGLES), CHI)
    together, alone = Marked(), []
    for index in range(len(ANGLES)):
        impact, law = batch.take(index), Marked()
        normal = normal_motion(normal_law, impact)
        motion = integrator.integrate(normal, law, impact, None)
        hold_success(motion)
        alone.append(float(np.asarray(motion.slip_velocity_change)))
        ends = np.array([float(np.asarray(after.overlap)) for _, after in law.seen])
        for phase in law.marks(impact, normal):
            wanted = float(np.asarray(normal.at(phase).approach))
            miss = float(np.min(np.abs(ends - wanted)) / np.asarray(normal.maximum_approach))
            hold(
                miss <= AT,
                f"A law asks for the end of a step at phase {phase:.4g}; the nearest is {miss:.2g} "
                f"of the greatest approach away. Bound: {AT:.2g}.",
            )
    normal = normal_motion(normal_law, batch)
    change = integrator.integrate(normal, together, batch, None).slip_velocity_change
    gap = float(np.max(np.abs(np.asarray(change) / np.array(alone) - 1.0)))
    hold(
        gap <= AT,
        f"A batch whose impacts have other marks is {gap:.2g} off its impacts one by one."
        f" Bound: {AT:.2g}.",
    )


@check(Integrator, claim="normal_motion")
def normal_motion_told(integrator: Any) -> None:
    """The normal motion that came of the friction is handed on (Integrator, 9)."""
    law, normal_law = Exchanging(), REGISTRY.create("normal.hertz")
    for impact in (scene(ANGLES[1], CHI), scene(np.array(ANGLES), CHI)):
        normal = normal_motion(normal_law, impact)
        motion = integrator.integrate(normal, law, impact, None)
        hold_success(motion)
        hold(motion.normal is not None, "law.normal_motion is not asked: normal is None.")
        after: Any = gathered(motion.normal, lambda part: part.final_rate, impact.shape)
        pair, slip, change = impact.pair, impact.slip_velocity, motion.slip_velocity_change
        speed = np.square(impact.normal_speed)
        start = pair.normal_mass * speed + pair.tangential_mass * np.square(slip)
        end = pair.normal_mass * after**2 + pair.tangential_mass * np.square(slip + change)
        gain = float(np.max(np.abs(end / start - 1.0)))
        hold(
            gain <= CONSERVED,
            f"A conservative coupling changes the energy by {gain:.2g} of itself: the drift of an "
            f"increment, or the last state, is wrong. Bound: {CONSERVED:.2g}.",
        )


@check(Integrator)
def drift(integrator: Any) -> None:
    """The displacement of a step is velocity times drift, if the drift is told (Increment)."""
    apply_if(issubclass(SteppedTangentialLaw, integrator.tangential_contract), "It has no steps.")
    law, impact = Marked(), scene(ANGLES[1], CHI)
    normal = normal_motion(REGISTRY.create("normal.hertz"), impact)
    integrator.integrate(normal, law, impact, None)
    apply_if(law.seen, "It did not ask the law.")
    told = np.array([step[:2] + step[4:] for step, _ in law.seen], dtype=np.float64)
    moved, velocity, drifts = told.T
    apply_if(not np.isnan(drifts).all(), "It does not tell the drift.")
    gap = float(np.max(np.abs(moved - velocity * drifts)) / np.max(np.abs(moved)))
    hold(gap <= AT, f"Displacements are {gap:.2g} off velocity times drift. Bound: {AT:.2g}.")


@check(SteppedTangentialLaw)
def marks_grow(law: Any) -> None:
    """Marks are phases that grow from 0 to pi, of one impact and of a batch (stepped, 7)."""
    for impact in (scene(ANGLES[1], CHI), scene(np.array(ANGLES), CHI)):
        marked = law.marks(impact, normal_motion(REGISTRY.create("normal.hertz"), impact))
        apply_if(marked is not None, "It has no marks.")
        phases = np.asarray(marked, dtype=np.float64)
        good = phases.ndim == 1 or phases.shape[1:] == impact.shape
        hold(good, f"Marks of shape {phases.shape} for a scene of shape {impact.shape}.")
        edge = np.zeros((1, *phases.shape[1:]))
        grow = np.diff(np.concatenate((edge, phases, edge + np.pi)), axis=0)
        hold((grow > 0.0).all(), "Marks must grow along the first axis, between 0 and pi.")


@check(TangentialLaw)
def books_bound_told(law: Any) -> None:
    """The bound of the energy books is a number >= 0 for each impact (TangentialLaw, 7)."""
    for impact in (scene(ANGLES[1], CHI), scene(np.array(ANGLES), CHI)):
        bound = np.asarray(law.books_bound(impact), dtype=np.float64)
        good = bound.shape in ((), impact.shape) and (bound >= 0.0).all()
        hold(good, f"books_bound = {bound!r}: must be at least 0, of shape {impact.shape} or ().")


@check(NormalLaw)
def dissipation(law: Any) -> None:
    """The declared dissipation is the loss of an impact without friction (NormalLaw, 7)."""
    for impact in (scene(ANGLES[1], CHI), scene(np.array(ANGLES), CHI)):
        motion = normal_motion(law, impact)
        declared = np.asarray(law.dissipation(motion), dtype=np.float64)
        apply_if(not np.isnan(declared).all(), "It declares none.")
        energy = 0.5 * impact.pair.normal_mass * np.square(impact.normal_speed)
        lost = energy - 0.5 * impact.pair.normal_mass * np.square(motion.final_rate)
        gap = float(np.max(np.abs(lost - declared) / energy))
        hold(
            gap <= LOST,
            f"An impact without friction loses another energy than is declared: off by {gap:.2g} "
            f"of the energy of the normal motion. Bound: {LOST:.2g}.",
        )


@check(Law)
def partners(law: Law) -> None:
    """Partners and scenes are refused by a sentence, or not at all (Law, 8)."""
    for name in ("normal.hertz", "tangential.springs", "integrator.symplectic"):
        other = REGISTRY.create(name)
        if other.kind != law.kind:
            reason = law.refuses(other)
            told = reason is None or (isinstance(reason, str) and bool(reason.strip()))
            hold(told, f"refuses({name}) returned {reason!r}: must be None, or a reason.")
    for impact in (scene(ANGLES[1], CHI), Scene.nondimensional(psi1=1.0, chi=CHI)):
        try:
            law.accept(impact)
        except ValueError as error:
            hold(str(error), "It refuses a scene without a word.")
