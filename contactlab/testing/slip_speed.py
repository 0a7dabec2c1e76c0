"""Laws whose friction coefficient depends on the slip speed, the word ``slip_speed``.

At one slip speed such a law is Coulomb's, with a factor on mu. The checks of Coulomb's limit and of
memory therefore drive it at one speed, and take the factor of that speed from a long slip.
"""

from __future__ import annotations

from contactlab.contracts import NormalContact, SteppedTangentialLaw, claims
from contactlab.contracts.law import Law
from contactlab.numeric.types import Real
from contactlab.testing.check import apply_if, check, hold, within
from contactlab.testing.load_paths import Bench, slack

WORD = "slip_speed"
#: Bound of the change of the factor as a grazing impact slows by a part in 300.
SLOWING = 0.02
#: Steps of a long slip, and slip of each in units of that at which gross slip begins.
STEPS, MOVED = 24, 0.5
#: Normal load of the long slip, zeta; other than those that are checked.
LEVEL, LIGHT = 0.85, 0.4
#: Slip speeds in m/s.
SPEEDS = (1e-4, 1e-2, 0.1, 1.0, 10.0, 1e3)


def varies(law: Law) -> bool:
    """Return whether the friction coefficient of a law depends on the slip speed."""
    return WORD in claims(law)


def gross_force(
    law: SteppedTangentialLaw, bench: Bench, contact: NormalContact, duration: Real
) -> float:
    """Return F/(mu P_max) after a long slip in steps of ``MOVED``, each of a duration in s."""
    state, before, force = bench.start(law), bench.contact(0.0), 0.0
    for moved in (0.0, *[MOVED] * STEPS):
        increment = bench.increment(moved, contact, duration)
        response, state = law.advance(state, increment, before, contact)
        before, force = contact, float(response.force) / float(bench.friction_force)
    return force


def factor(law: Law, bench: Bench, speed: float) -> float:
    """Return the factor on mu at a slip speed in m/s; 1 for a law without the word."""
    if not varies(law):
        return 1.0
    apply_if(isinstance(law, SteppedTangentialLaw), "It answers to no step at one slip speed.")
    assert isinstance(law, SteppedTangentialLaw)
    duration = MOVED * bench.slip / abs(speed)
    found: float = gross_force(law, bench, bench.contact(LEVEL), duration) / LEVEL**1.5
    hold(
        0.0 <= found <= 1.0 + 1e-9,
        f"At a slip speed of {speed:.3g} m/s F is {found:.4g} mu P, not from 0 to mu P: of a law "
        f"with the word {WORD!r} the scene's mu is the greatest.",
    )
    return found


@check(SteppedTangentialLaw, word=(WORD, True))
def slip_speed(law: SteppedTangentialLaw) -> None:
    """At one slip speed F is mu times the load times a factor of that speed, from 0 to 1."""
    bench, factors = Bench.of(), []
    for speed in SPEEDS:
        factors.append(factor(law, bench, speed))
        light = gross_force(law, bench, bench.contact(LIGHT), MOVED * bench.slip / speed)
        gap = abs(light / LIGHT**1.5 - factors[-1])
        within(
            gap,
            slack(law, 1e-6),
            f"At a slip speed of {speed:.3g} m/s F/(mu P) is {gap:.2g} off at another load.",
        )
    hold(
        max(factors) - min(factors) > 1e-6,
        f"From {SPEEDS[0]:g} to {SPEEDS[-1]:g} m/s F/(mu P) is {factors[0]:.4g}: leave out the "
        f"word {WORD!r}.",
    )
