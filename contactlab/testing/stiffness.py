"""Checks of a stepped law's stated stiffness, and of its friction under a normal pull."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.registry import REGISTRY
from contactlab.contracts import SteppedTangentialLaw
from contactlab.testing.bench import (
    HEAVY,
    Bench,
    Path,
    continue_from,
    drive,
    scene,
    slack,
    straight,
)
from contactlab.testing.check import check, hold
from contactlab.testing.laws import SoftHertz

#: Normal loads at which slopes are taken; at the last the contact is the largest there is.
LEVELS = (0.05, 0.3, 0.7, 1.0)
#: Slips up to which they are taken: of a spring at rest, and of one that gross slip has reached.
SLIPS = (1e-3, 2.0)


@check(SteppedTangentialLaw)
def stiffness(law: Any) -> None:
    """``stiffness`` bounds dF/dD, so that a step can be known to be stable (stepped, 6).

    In contacts as large as Hertz's, and larger: under a softer normal law.
    """
    for normal_law in (REGISTRY.create("normal.hertz"), SoftHertz()):
        if not law.needs <= normal_law.offers:
            continue
        bench = Bench.along(normal_motion(normal_law, scene(0.0, HEAVY)))
        bound = float(law.stiffness(bench.scene, bench.normal)) * bench.slip / bench.friction_force
        hold(bound >= 0.0 and math.isfinite(bound), f"stiffness = {bound!r}.")
        if bound == 0.0:
            _ignores_displacement(law, bench)
            continue
        for level in LEVELS:
            found = max(_steepest(law, bench, level, size * level) for size in SLIPS)
            hold(
                found <= bound * (1.0 + slack(law, 1e-6)),
                f"dF/dD is {found / bound:.3g} times the stiffness it states, at zeta = {level} "
                f"under {type(normal_law).__name__}.",
            )


def _steepest(law: Any, bench: Bench, level: float, size: float) -> float:
    """Return the largest dF/dD as a contact at fixed load is sheared to and fro.

    Parameters
    ----------
    law : SteppedTangentialLaw
    bench : Bench
    level : float
        zeta at which the load is kept.
    size : float
        Amplitude of the slip, scaled.
    """
    pressed = drive(law, bench, straight((0.0, level), steps=8)).state
    slip = straight((size, 0.0), (-size, 0.0), (0.5 * size, 0.0), steps=16).slip
    path = Path(slip, np.full_like(slip, level))
    found = continue_from(law, bench, pressed, path, level=level)
    slopes = np.diff(found.force, prepend=0.0) / np.diff(slip, prepend=0.0)
    return float(slopes.max())


def _ignores_displacement(law: Any, bench: Bench) -> None:
    """Hold that a law which states no stiffness takes no notice of displacement."""
    after = bench.contact(0.7)
    given = bench.increment(0.1, after, bench.time / 16.0)
    moved = given._replace(displacement=2.0 * given.displacement)
    state = bench.start(law)
    forces = [law.advance(state, each, after, after)[0].force for each in (given, moved)]
    hold(forces[0] == forces[1], "It states stiffness 0, and its force depends on displacement.")


@check(SteppedTangentialLaw)
def tension(law: Any) -> None:
    """Where the surfaces pull abs(F) is within mu times the friction load, and odd to the bit.

    An adhesive contact comes to a pull at the end: its force is negative, its friction load is
    what the normal law says, or nothing.
    """
    bench = Bench.of()
    for share in (0.0, 0.2):
        pulled = bench.contact(0.5)
        load = share * pulled.force
        pulled = pulled._replace(force=-0.3 * pulled.force, friction_load=load)
        there, back = (_pulled(law, bench, pulled, sense) for sense in (1.0, -1.0))
        limit = load / bench.force
        over = float(np.nan_to_num(np.max(np.abs(there)) - limit, nan=np.inf))
        hold(
            over <= slack(law) * max(limit, 0.1),
            f"Under tension abs(F) exceeds mu times a friction load of {limit:.2g} P_max by "
            f"{over:.2g} mu P_max."
            f" Bound: {slack(law) * max(limit, 0.1):.2g}.",
        )
        hold(
            np.array_equal(there, -back),
            "Under tension, reversed slip gives a force that is not the same reversed.",
        )


def _pulled(law: Any, bench: Bench, pulled: Any, sense: float) -> Any:
    """Return the forces as a sheared contact comes under tension and is sheared on.

    Parameters
    ----------
    law : SteppedTangentialLaw
    bench : Bench
    pulled : NormalContact
        Under tension.
    sense : float
        Sign of the slip.
    """
    pressed = drive(law, bench, straight((0.0, 0.7), (0.4 * sense, 0.7), steps=8)).state
    state, before, forces = pressed, bench.contact(0.7), []
    for moved in (0.1, 0.0, 0.3, -0.2, -0.9, 0.05):
        given = bench.increment(moved * sense, pulled, bench.time / 64.0)
        response, state = law.advance(state, given, before, pulled)
        before = pulled
        hold(
            float(response.friction_work) >= -1e-12 * bench.friction_force * bench.slip,
            f"Under tension friction work is {float(response.friction_work):.2g} J.",
        )
        forces.append(float(response.force) / bench.friction_force)
    return np.array(forces)
