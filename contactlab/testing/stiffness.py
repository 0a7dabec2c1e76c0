"""Checks of a stepped law's stiffness, and of its friction under a negative normal force."""

from __future__ import annotations

import math

import numpy as np

from contactlab.contracts import NormalContact, SteppedTangentialLaw
from contactlab.numeric.types import Array
from contactlab.registry.composition import misfit
from contactlab.registry.registry import REGISTRY
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.check import check, hold, within, worst
from contactlab.testing.laws import SoftHertz
from contactlab.testing.load_paths import (
    HEAVY,
    Bench,
    Path,
    continue_from,
    drive,
    scene,
    slack,
    straight,
)

#: Normal loads zeta at which dF/dD is measured, up to the largest contact.
LEVELS = (0.05, 0.3, 0.7, 1.0)
#: Amplitudes of slip over zeta at which dF/dD is measured: small, and beyond gross slip.
SLIPS = (1e-3, 2.0)


@check(SteppedTangentialLaw)
def stiffness(law: SteppedTangentialLaw) -> None:
    """``stiffness`` is an upper bound of dF/dD, from which stable steps follow (stepped, 6).

    The contacts are as large as Hertz's, and larger under a softer normal law.
    """
    for normal_law in (REGISTRY.create("normal.hertz"), SoftHertz()):
        if misfit(normal_law, law) is not None:
            continue
        bench = Bench.along(normal_motion(normal_law, scene(0.0, HEAVY)))
        bound = float(law.stiffness(bench.scene, bench.normal)) * bench.slip / bench.friction_force
        hold(bound >= 0.0 and math.isfinite(bound), f"stiffness = {bound!r}.")
        if bound == 0.0:
            _ignores_displacement(law, bench)
            continue
        for level in LEVELS:
            steepest = max(_steepest(law, bench, level, size * level) for size in SLIPS)
            hold(
                steepest <= bound * (1.0 + slack(law, 1e-6)),
                f"dF/dD is {steepest / bound:.3g} times the stiffness it states, at zeta = {level} "
                f"under {type(normal_law).__name__}.",
            )


def _steepest(law: SteppedTangentialLaw, bench: Bench, level: float, size: float) -> float:
    """Return the largest scaled dF/dD as a contact at fixed load is sheared to and fro."""
    pressed = drive(law, bench, straight((0.0, level), steps=8)).state
    slip = straight((size, 0.0), (-size, 0.0), (0.5 * size, 0.0), steps=16).slip
    path = Path(slip, np.full_like(slip, level))
    answers = continue_from(law, bench, pressed, path, level=level)
    slopes = np.diff(answers.force, prepend=0.0) / np.diff(slip, prepend=0.0)
    return float(slopes.max())


def _ignores_displacement(law: SteppedTangentialLaw, bench: Bench) -> None:
    """Hold that the force of a law of stiffness 0 does not depend on displacement."""
    after = bench.contact(0.7)
    increment = bench.increment(0.1, after, bench.time / 16.0)
    moved = increment._replace(displacement=2.0 * increment.displacement)
    state = bench.start(law)
    forces = [law.advance(state, each, after, after)[0].force for each in (increment, moved)]
    hold(
        forces[0] == forces[1], "The law states stiffness 0, and its force depends on displacement."
    )


@check(SteppedTangentialLaw)
def tension(law: SteppedTangentialLaw) -> None:
    """Under a negative normal force abs(F) is at most mu times the friction load, and F is odd.

    The force of an adhesive contact becomes negative before separation; its friction load is what
    the normal law returns, or zero. Reversed slip reverses F to the last bit.
    """
    bench = Bench.of()
    for share in (0.0, 0.2):
        pulled = bench.contact(0.5)
        load = share * pulled.force
        pulled = pulled._replace(force=-0.3 * pulled.force, friction_load=load)
        forward, reversed_force = (_pull(law, bench, pulled, sense) for sense in (1.0, -1.0))
        limit = float(load / bench.force)
        over = worst(forward) - limit
        within(
            over,
            slack(law) * max(limit, 0.1),
            f"Under tension abs(F) exceeds mu times a friction load of {limit:.2g} P_max by "
            f"{over:.2g} mu P_max.",
        )
        hold(
            np.array_equal(forward, -reversed_force),
            "Under tension, reversed slip gives a force that is not the same reversed.",
        )


def _pull(law: SteppedTangentialLaw, bench: Bench, pulled: NormalContact, sense: float) -> Array:
    """Return the scaled forces of a sheared contact that comes under tension and is moved on."""
    pressed = drive(law, bench, straight((0.0, 0.7), (0.4 * sense, 0.7), steps=8)).state
    state, before, forces = pressed, bench.contact(0.7), []
    for moved in (0.1, 0.0, 0.3, -0.2, -0.9, 0.05):
        increment = bench.increment(moved * sense, pulled, bench.time / 64.0)
        response, state = law.advance(state, increment, before, pulled)
        before = pulled
        hold(
            float(response.friction_work) >= -1e-12 * bench.friction_force * bench.slip,
            f"Under tension friction work is {float(response.friction_work):.2g} J.",
        )
        forces.append(float(response.force) / bench.friction_force)
    return np.array(forces)
