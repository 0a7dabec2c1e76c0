"""Checks of Coulomb's limit: friction coefficient, friction load and load impulse."""

from __future__ import annotations

import numpy as np

from contactlab.contracts import SteppedTangentialLaw, TangentialLaw
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.check import NotApplicableError, apply_if, check, within
from contactlab.testing.impacts import CHI
from contactlab.testing.laws import PullingHertz
from contactlab.testing.load_paths import Bench, continue_from, drive, scene, slack, straight
from contactlab.testing.slip_speed import MOVED, SLOWING, factor, gross_force, varies
from contactlab.testing.ways import INTEGRATION, ways
from contactlab.testing.whole_impacts import GRAZING, changes

#: dF/dD at rest over 2 G* b, Mindlin's and Di Renzo & Di Maio's; bound of the difference.
MINDLIN, NEAR = (1.0, 2.0 / 3.0), 0.03

#: Friction coefficients of grazing impacts, and the bound of the power's difference from 1.
FRICTION, POWER = (0.02, 0.1, 0.3, 0.9), 1e-3
#: Friction load over normal force; below 1 for a contact whose surfaces attract each other.
SHARES = (0.6, 1.0, 1.5)
#: Normal load of the contact, zeta.
LEVEL = 0.7


@check(TangentialLaw)
def friction_coefficient(law: TangentialLaw) -> None:
    """The impulse of slip throughout is proportional to mu (TangentialLaw, 1)."""
    for way in ways(law):
        impulses = []
        for friction in FRICTION:
            psi1 = GRAZING * 4.0 * CHI[1]
            if varies(law):  # at one slip speed
                psi1 *= FRICTION[-1] / friction
            impact = scene(psi1, CHI[1], friction=friction)
            change = float(np.asarray(way.run(impact).motion.slip_velocity_change))
            impulses.append(abs(change) * float(np.asarray(impact.pair.tangential_mass)))
        apply_if(all(impulses), "The law makes no force in slip throughout.")
        power = float(np.polyfit(np.log(FRICTION), np.log(impulses), 1)[0])
        within(
            abs(power - 1.0),
            POWER,
            f"The impulse of grazing impacts goes with mu to the power {power:.3g}, not 1: at mu = "
            f"{FRICTION[0]} and {FRICTION[-1]} it is {impulses[0]:.3g} and {impulses[-1]:.3g} N s "
            f"({way}).",
        )


@check(SteppedTangentialLaw)
def friction_load(law: SteppedTangentialLaw) -> None:
    """In gross slip F is mu times the friction load, even if that differs from P (stepped, 3)."""
    bench = Bench.of()
    pressed = bench.contact(LEVEL)
    for share in SHARES:
        contact = pressed._replace(friction_load=share * pressed.force)
        duration = bench.time / 40.0
        force = gross_force(law, bench, contact, duration)
        full = factor(law, bench, float(MOVED * bench.slip / duration)) * LEVEL**1.5
        within(
            abs(force - share * full),
            slack(law, 1e-6),
            f"In gross slip F = {force:.4g} mu P_max, where mu times the friction load is "
            f"{share * full:.4g} and mu times the normal force {full:.4g}.",
        )


@check(TangentialLaw)
def load_impulse(law: TangentialLaw) -> None:
    """Slip throughout takes mu times the load impulse, also under a normal law that pulls."""
    pulling, tried = PullingHertz(), 0
    try:
        marches = ways(law, pulling)
    except NotApplicableError:
        marches = []
    for chi in CHI:
        impact = scene(GRAZING * 4.0 * chi, chi)
        normal = normal_motion(pulling, impact)
        mass = float(np.asarray(impact.pair.tangential_mass))
        share = factor(law, Bench.of(), float(np.asarray(impact.slip_velocity)))
        friction = share * float(np.asarray(impact.friction_coefficient))
        expected = friction * float(normal.total_load_impulse)
        # a law that cannot run under this normal law is not asked for wholes either
        for _, change, origin in changes(law, marches, impact, normal) if marches else ():
            apply_if(change != 0.0, "The law makes no force in slip throughout.")
            tried += 1
            error = abs(abs(float(np.asarray(change))) * mass / expected - 1.0)
            within(
                error,
                slack(law, 0.0) + INTEGRATION + (SLOWING if varies(law) else 0.0),
                f"Under a normal law that pulls, chi = {chi:.3g}: the impulse of a grazing impact "
                f"is {error:.2g} off mu times the impulse of the friction load ({origin}).",
            )
    apply_if(tried, "There is no way to run it under a normal law that pulls.")


@check(SteppedTangentialLaw)
def at_rest_stiffness(law: SteppedTangentialLaw) -> None:
    """A stiffness that grows with the contact radius is Mindlin's 2 G* b, or 2/3 of that.

    2 G* b is the slope dF/dD of a contact that sticks all over; Di Renzo & Di Maio (2005) take
    2/3 of this slope. G* is the effective shear modulus of the pair, 1/G* = sum (2 - nu)/(4 G),
    four times the G* of discrete-element codes.
    """
    bench, ratios = Bench.of(), []
    for level in (0.3, 0.6, 1.0):
        pressed = drive(law, bench, straight((0.0, level), steps=40)).state
        small = 1e-4 * level
        # The second step has no displacement, and so no force of a dashpot.
        path = straight((small, level), (small, level), steps=1)
        path = path._replace(level=np.full_like(path.slip, level))
        force = continue_from(law, bench, pressed, path, level=level).force[-1]
        ratios.append(float(force) / (1.5 * level**0.5 * small))
    mean = float(np.mean(ratios))
    grows = mean > 0.0 and float(np.ptp(ratios)) <= 0.02 * mean
    apply_if(grows, "Its stiffness does not grow in proportion to the contact radius.")
    nearest = min(MINDLIN, key=lambda factor: abs(mean - factor))
    within(
        abs(mean - nearest),
        NEAR,
        f"dF/dD of a contact at rest is {mean:.4g} times 2 G* b, at every normal load. Mindlin's "
        "stiffness is once 2 G* b, with the G* of the pair.",
    )
