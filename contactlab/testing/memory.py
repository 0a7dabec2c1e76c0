"""Checks of a stepped law's memory at fixed normal load: turning points, partial slip."""

from __future__ import annotations

import numpy as np

from contactlab.contracts import SteppedTangentialLaw
from contactlab.testing.check import WHOLE, check, within
from contactlab.testing.load_paths import Bench, Path, continue_from, drive, slack, straight

#: Normal load zeta at which the memory is tried, and steps of a leg.
LEVEL = 0.8
STEPS = 40
#: Steps out of contact before the bodies meet again.
APART = (1, 2, 5)
#: Steps of a contact without displacement.
STILL = 400


@check(SteppedTangentialLaw, nature="it has no memory")
def turning_points(law: SteppedTangentialLaw) -> None:
    """Masing: unloading is loading doubled, and a closed loop leaves no memory (theory §7)."""
    bench, press = Bench.of(), (0.0, LEVEL)
    for turn in (0.3, 0.6, 1.5):
        loading = drive(law, bench, straight(press, (turn, LEVEL), steps=STEPS)).force[STEPS:]
        path = straight(press, (turn, LEVEL), (-turn, LEVEL), steps=STEPS)
        unloading = drive(law, bench, path).force[2 * STEPS :]
        gap = float(np.max(np.abs(loading[-1] - unloading - 2.0 * loading)))
        within(
            gap,
            2.0 * slack(law, 1e-6),
            f"Turned at slip {turn}, unloading is {gap:.2g} mu P_max off twice the loading curve.",
        )
        loop = [(0.4 * turn, LEVEL), (turn, LEVEL), (1.4 * turn, LEVEL)]
        looped = drive(law, bench, straight(press, (turn, LEVEL), *loop, steps=STEPS)).force
        direct = straight(press, (turn, LEVEL), (1.4 * turn, LEVEL), steps=STEPS)
        straight_on = drive(law, bench, direct).force
        gap = float(np.max(np.abs(looped[-STEPS:] - straight_on[-STEPS:])))
        within(
            gap,
            slack(law, 1e-6),
            f"A closed loop at slip {turn} is not forgotten: {gap:.2g} mu P_max.",
        )


@check(SteppedTangentialLaw, claim="partial_slip", nature=WHOLE)
def cattaneo_mindlin(law: SteppedTangentialLaw) -> None:
    """At fixed P, F/(mu P) = 1 - (1 - xi)^1.5: slip from the edge inwards (theory §7)."""
    path = straight((0.0, LEVEL), (1.3 * LEVEL, LEVEL), steps=65)
    force = drive(law, Bench.of(), path).force[65:] / LEVEL**1.5
    xi = np.minimum(path.slip[65:] / LEVEL, 1.0)
    gap = np.abs(force - (1.0 - (1.0 - xi) ** 1.5))
    within(
        gap.max(),
        slack(law, 1e-3),
        f"F/(mu P) is {gap.max():.2g} off Cattaneo and Mindlin's, at xi = {xi[gap.argmax()]:.2g}.",
    )


@check(SteppedTangentialLaw)
def contact_again(law: SteppedTangentialLaw) -> None:
    """After separation, for one step or more, a contact begins without memory (stepped, 1)."""
    bench = Bench.of()
    touched = straight((0.0, LEVEL), (0.5, LEVEL), steps=16)
    sheared = drive(law, bench, touched)
    second_path = straight((0.0, LEVEL), (0.3, LEVEL), steps=16)
    fresh = drive(law, bench, second_path).force
    for apart in APART:
        away = Path(np.full(apart, 0.5), np.full(apart, -0.1))
        apart_answers = continue_from(
            law, bench, sheared.state, away, slip=0.5, level=LEVEL, count=len(second_path.slip)
        )
        force = continue_from(law, bench, apart_answers.state, second_path, level=-0.1).force
        pressed, gap = (float(np.max(np.abs(part))) for part in (force[:16], force - fresh))
        within(
            gap,
            slack(law, 1e-9),
            f"After {apart} step(s) out of contact, contact is made again: pressing alone gives "
            f"F = {pressed:.2g} mu P_max, {gap:.2g} off a first contact. The law still remembers "
            "the contact before.",
        )


@check(SteppedTangentialLaw)
def held_still(law: SteppedTangentialLaw) -> None:
    """Without displacement a contact keeps its force over any number of steps.

    The first step does not count, because a dashpot loses its force there.
    """
    bench = Bench.of()
    sheared = drive(law, bench, straight((0.0, LEVEL), (0.3, LEVEL), steps=16)).state
    still = Path(np.full(STILL, 0.3), np.full(STILL, LEVEL))
    force = continue_from(law, bench, sheared, still, slip=0.3, level=LEVEL).force
    gap = float(np.max(np.abs(force - force[1])[1:]))
    within(
        gap,
        slack(law, 1e-9),
        f"Held still for {STILL} steps, the force of {force[1]:.3g} mu P_max changes by "
        f"{gap:.2g}: it depends on the number of steps, not on the displacement.",
    )
