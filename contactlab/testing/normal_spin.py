"""Checks of laws that answer spin about the normal, and of those that do not (theory §17)."""

from __future__ import annotations

import attrs
import numpy as np

from contactlab.contracts import TangentialLaw
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.outcome.result import ImpactResult
from contactlab.runs.simulation import Simulation
from contactlab.testing import limits
from contactlab.testing.check import check, hold, hold_success, within, worst
from contactlab.testing.load_paths import scene, slack
from contactlab.testing.ways import Way, ways

#: Word of the laws that answer spin about the normal.
ANSWERS, LEAVES = ("normal_spin", True), ("normal_spin", False)
#: psi1 of impacts that stick, slip in part, and slip throughout; w and chi_w of the spin.
PSI1, CHI, RIM, TURNING = (0.0, 0.5, 2.0, 9.0), 1.4412, 0.4, 0.02
#: psi1 in the check of all other laws.
FEW = PSI1[:3]
#: Bounds of psi2 and w2 by rounding, and a w that moves nothing.
ROUNDING, HARDLY = 1e-9, 1e-9
#: Least change of w for the checks that follow how it falls.
LEAST = 1e-6


def add_spin(psi1: float, w1: float) -> Scene:
    """Return the impact of the other checks with spin about the normal."""
    still = scene(psi1, CHI)
    unit = attrs.evolve(still, pair=attrs.evolve(still.pair, inverse_spin_mass=1.0))
    pair = attrs.evolve(still.pair, inverse_spin_mass=TURNING / float(unit.chi_w))
    return attrs.evolve(still, pair=pair, normal_spin=w1 / float(kinetics.rim(still, 1.0)))


def run(way: Way, psi1: float, w1: float) -> ImpactResult:
    """Return the result of an impact under a law, of its whole-impact answers if it has any."""
    limits.begin(f"an impact, psi1 = {psi1}, w = {w1} ({way})")
    simulation = Simulation(normal=way.normal, tangential=way.law, integrator=way.integrator)
    result = simulation.run(add_spin(psi1, w1))
    hold_success(result.motion, f"psi1 = {psi1}, w = {w1}: {{}} ({way})")
    return result


@check(TangentialLaw, word=ANSWERS)
def spin_is_odd(law: TangentialLaw) -> None:
    """The other sense of spin keeps psi2, and turns the change of the spin (tangential, 10)."""
    for way in ways(law):
        for psi1 in PSI1:
            one, other = run(way, psi1, RIM), run(way, psi1, -RIM)
            for gap, what in ((one.psi2 - other.psi2, "psi2"), (one.w2 + other.w2, "w2")):
                within(
                    worst(gap),
                    ROUNDING,
                    f"psi1 = {psi1}, w = ±{RIM}: of both senses {what} differs by "
                    f"{worst(gap):.2g} ({way}).",
                )


@check(TangentialLaw, word=ANSWERS)
def spin_slows(law: TangentialLaw) -> None:
    """Friction takes spin, less than would return it faster, and no energy comes of it."""
    for way in ways(law):
        for psi1 in PSI1:
            result = run(way, psi1, RIM)
            lost = RIM - float(result.w2)
            words = f"psi1 = {psi1}, w = {RIM}: w2 = {float(result.w2):.6g} ({way})."
            hold(LEAST < lost <= 2.0 * RIM, f"{words} It must fall, and not below {-RIM}.")
            energy = result.energy
            gain = worst(np.maximum(energy.end / energy.start - 1.0, 0.0))
            within(gain, ROUNDING, f"{words} The bodies gain {gain:.2g} of their energy.")


@check(TangentialLaw, word=ANSWERS)
def spin_vanishes(law: TangentialLaw) -> None:
    """A spin that vanishes leaves the answer without spin, to the law's own error."""
    for way in ways(law):
        for psi1 in PSI1:
            still, hardly = run(way, psi1, 0.0), run(way, psi1, HARDLY)
            gap = worst(hardly.psi2 - still.psi2)
            declared = still.plan.psi2_error + hardly.plan.psi2_error
            room = ROUNDING + (slack(law) if np.isnan(declared) else float(declared))
            within(
                gap,
                room,
                f"psi1 = {psi1}: w = {HARDLY} moves psi2 by {gap:.2g} from that of w = 0 ({way}).",
            )
            hold(float(still.w2) == 0.0, f"psi1 = {psi1}: w2 is not 0 where w is ({way}).")


@check(TangentialLaw, word=LEAVES)
def spin_is_left(law: TangentialLaw) -> None:
    """A law without the word changes no spin about the normal, and psi2 does not feel it."""
    for way in ways(law):
        for psi1 in FEW:
            still, spinning = run(way, psi1, 0.0), run(way, psi1, RIM)
            gap = max(worst(spinning.psi2 - still.psi2), worst(spinning.w2 - RIM))
            within(
                gap,
                ROUNDING,
                f"psi1 = {psi1}, w = {RIM}: psi2 or w2 moves by {gap:.2g}, and the law has not "
                f"the word normal_spin ({way}).",
            )
