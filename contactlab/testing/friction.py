"""Checks of a stepped law's friction: symmetry, units, Coulomb's limit, stiffness."""

from __future__ import annotations

import math

import numpy as np

from contactlab.contracts import NormalContact, SteppedTangentialLaw
from contactlab.numeric.arrays import lock_arrays
from contactlab.testing.check import GROWS, check, hold, within, worst
from contactlab.testing.load_paths import (
    STEPS_TO_KNOT,
    Bench,
    Path,
    drive,
    slack,
    straight,
    wandering,
)
from contactlab.testing.slip_speed import factor
from contactlab.testing.units import ODD_UNITS, in_units

#: Rounding of forces, over mu P_max.
ROUNDING = 1e-9
SEEDS = (11, 12, 13)
#: A long slip, over the slip at which gross slip begins.
FAR = 1e4
#: Bound of the relative difference of the work of gross slip from force times slip.
PAID = 1e-6


@check(SteppedTangentialLaw)
def odd_in_slip(law: SteppedTangentialLaw) -> None:
    """Reversing every displacement reverses every force (TangentialLaw, 1)."""
    bench = Bench.of()
    for seed in SEEDS:
        path = wandering(seed)
        forward = drive(law, bench, path)
        reversed_answers = drive(law, bench, Path(-path.slip, path.level))
        gap = worst(forward.force + reversed_answers.force)
        within(gap, ROUNDING, f"Reversed slip gives a force that differs by {gap:.1e} mu P_max.")
        gap = worst(forward.work - reversed_answers.work)
        within(gap, ROUNDING, f"Reversed slip gives a friction work that differs by {gap:.1e}.")
    far = straight((0.0, 0.5), (FAR, 0.9), (FAR - 1.0, 0.7))
    ahead = drive(law, bench, far).force
    gap = worst(ahead + drive(law, bench, Path(-far.slip, far.level)).force)
    within(
        gap,
        ROUNDING,
        f"Reversed slip, as far as {FAR:g} units, gives a force that differs by {gap:.1e} "
        "mu P_max.",
    )


@check(SteppedTangentialLaw)
def opposes_slip(law: SteppedTangentialLaw) -> None:
    """The force of a first, positive slip is positive or zero (TangentialResponse)."""
    force = drive(law, Bench.of(), straight((0.0, 0.7), (1.0, 0.7))).force
    hold(force.min() >= -ROUNDING, f"A first, positive slip meets a force of {force.min():.2g}.")


@check(SteppedTangentialLaw)
def units(law: SteppedTangentialLaw) -> None:
    """Answers do not depend on the units of length, time and mass (theory §7)."""
    converted = in_units(law, ODD_UNITS)
    for seed in SEEDS:
        path = wandering(seed)
        in_si = drive(law, Bench.of(), path)
        in_odd_units = drive(converted, Bench.of(units=ODD_UNITS), path)
        gap = max(worst(in_si.force - in_odd_units.force), worst(in_si.work - in_odd_units.work))
        within(gap, ROUNDING, f"In other units the answer differs by {gap:.1e} of mu P_max.")


@check(SteppedTangentialLaw)
def coulomb_limit(law: SteppedTangentialLaw) -> None:
    """The force never exceeds mu P (TangentialLaw, 1)."""
    for seed in SEEDS:
        path = wandering(seed)
        force, limit = np.abs(drive(law, Bench.of(), path).force), path.level**1.5
        over = force - limit
        worst = int(over.argmax())
        late = worst > 0 and abs(force[worst] - limit[worst - 1]) <= ROUNDING
        hold(
            over.max() <= slack(law),
            f"abs(F) exceeds mu P by {over.max():.2g} of mu P_max, at zeta = "
            f"{path.level[worst]:.2g}"
            + (": it is mu times the load at the start of the step." if late else "."),
        )


@check(SteppedTangentialLaw)
def separation(law: SteppedTangentialLaw) -> None:
    """Out of contact there is no force (TangentialLaw, 1)."""
    away = straight((0.0, 0.7), (0.4, 0.7), (0.5, 0.0), (0.6, -0.3))
    gone = drive(law, Bench.of(), away).force[away.level <= 0.0]
    hold(np.all(gone == 0.0), f"F = {np.max(np.abs(gone)):.2g} mu P_max out of contact.")


@check(SteppedTangentialLaw, nature=GROWS)
def normal_load_alone(law: SteppedTangentialLaw) -> None:
    """A change of normal load alone makes no tangential force (stepped contract, 2)."""
    bench = Bench.of()
    force = drive(law, bench, straight((0.0, 1.0), (0.0, 0.2), (0.0, 0.6))).force
    hold(np.all(force == 0.0), f"Pressing alone makes F = {worst(force):.2g} mu P_max.")
    path = straight((0.0, 0.4), (0.3, 0.4), (0.3, 1.0))
    held = drive(law, bench, path).force
    sheared = 2 * STEPS_TO_KNOT  # the third leg only presses
    rise = worst(held[sheared:]) - abs(held[sheared - 1])
    within(
        rise,
        slack(law),
        f"Pressing on a contact that is sheared adds {rise:.2g} mu P_max to its force.",
    )


@check(SteppedTangentialLaw)
def gross_slip(law: SteppedTangentialLaw) -> None:
    """A large displacement leads to F = mu P, and its friction work is F times slip."""
    path = straight((0.0, 0.7), (4.0, 0.7), (8.0, 0.7))
    answers = drive(law, Bench.of(), path)
    bench = Bench.of()
    limit = factor(law, bench, float(bench.slip / bench.time)) * 0.7**1.5
    gap = abs(float(answers.force[-1]) - limit)
    within(gap, slack(law), f"F = {answers.force[-1]:.4g} mu P_max where mu P is {limit:.4g}.")
    work = float(np.sum(answers.work[2 * STEPS_TO_KNOT :]))
    paid = 4.0 * float(answers.force[-1])
    within(
        abs(work - paid),
        PAID * paid,
        f"Friction work of gross slip by 4.0 is {work / paid:.7g} times force times slip: "
        f"{work:.4g} at a force of {answers.force[-1]:.4g}.",
    )


@check(SteppedTangentialLaw)
def non_finite(law: SteppedTangentialLaw) -> None:
    """NaN as slip or contact is refused, or gives NaN; never a finite force."""
    bench = Bench.of()
    state = drive(law, bench, straight((0.0, 0.7), (0.3, 0.7), steps=8)).state
    before, nan = bench.contact(0.7), math.nan
    sound = bench.increment(0.1, before, bench.time / 16.0)
    nan_slip = sound._replace(displacement=nan, velocity=nan)
    nan_load = sound._replace(friction_load=nan)
    for what, increment, after in (
        ("slip", nan_slip, before),
        ("normal contact", nan_load, NormalContact(nan, nan, nan, nan)),
    ):
        try:
            response, _ = law.advance(state, increment, before, after)
        except (ValueError, ArithmeticError):
            continue
        clean = bool(response.settled) and math.isfinite(response.force)
        hold(not clean, f"NaN as {what} gives F = {response.force!r}, as if nothing were wrong.")
    _non_finite_in_a_batch(law)


def _non_finite_in_a_batch(law: SteppedTangentialLaw) -> None:
    """Hold that NaN as the slip of one contact of a batch is refused, or gives NaN only there."""
    bench = Bench.of((3,))
    before = bench.contact(lock_arrays(np.full(3, 0.7)))
    slip = np.array([0.1, 0.2, 0.3])
    state, increment = (
        bench.start(law),
        bench.increment(lock_arrays(slip), before, bench.time / 16.0),
    )
    spoiled = np.where([False, True, False], math.nan, slip)
    nan_increment = bench.increment(lock_arrays(spoiled), before, bench.time / 16.0)
    sound, _ = law.advance(state, increment, before, before)
    try:
        response, _ = law.advance(state, nan_increment, before, before)
    except (ValueError, ArithmeticError):
        return
    force = np.asarray(response.force)
    clean = np.broadcast_to(response.settled, 3) & np.isfinite(force)
    hold(
        not clean[1],
        f"NaN as the slip of one contact of a batch gives F = {force[1]:.3g} N there, as if "
        "nothing were wrong.",
    )
    others = [0, 2]
    alike = np.asarray(sound.force)[others]
    hold(  # a product of matrices rounds as the size of its batch has it
        np.all(np.abs(force[others] - alike) <= ROUNDING * np.abs(alike)),
        "NaN as the slip of one contact of a batch changes the force of the others.",
    )


@check(SteppedTangentialLaw)
def last_step(law: SteppedTangentialLaw) -> None:
    """Force and work of a step that ends with almost no load are bounded by the load before.

    An integrator may sample the contact at the ends of steps. The load after the last step is then
    zero or rounding, while the mean load of the step is not.
    """
    bench, moved, level = Bench.of(), 0.1, 0.7
    before = bench.contact(level)
    for slip in (0.2, 2.0):
        state = drive(law, bench, straight((0.0, level), (slip, level), steps=16)).state
        for remaining in (1e-6, 1e-12, 1e-32, 0.0):
            after = bench.contact(remaining)
            increment = bench.increment(moved, after, bench.time / 64.0)
            increment = increment._replace(friction_load=0.4 * before.friction_load)
            response, _ = law.advance(state, increment, before, after)
            force = abs(float(response.force)) / float(bench.friction_force)
            work = float(response.friction_work) / (bench.friction_force * bench.slip)
            largest = (1.0 + slack(law)) * level**1.5
            within(
                force,
                largest,
                f"F = {force:.2g} mu P_max as the load falls to zeta = {remaining:.1g}.",
            )
            # At most the step slips, and the deflection that the load had held.
            hold(
                -ROUNDING <= work <= largest * (moved + level),
                f"Friction work of {work:.2g} in a step of {moved} as the load falls to zeta = "
                f"{remaining:.1g}.",
            )
