"""Checks of impacts with any tangential law, in each way in which the law can be run."""

from __future__ import annotations

import copy
import itertools
from collections.abc import Iterator

import numpy as np

from contactlab.contracts import (
    AllStepsTangentialLaw,
    Integrator,
    PathTangentialLaw,
    TangentialLaw,
    TangentialMotion,
)
from contactlab.numeric.arrays import magnitude
from contactlab.outcome.history import Recorder
from contactlab.testing.check import CHANGES, GROWS, WHOLE, apply_if, check, hold, within
from contactlab.testing.compare import same
from contactlab.testing.load_paths import FRICTION, bodies, scene
from contactlab.testing.units import ODD_UNITS, in_units
from contactlab.testing.ways import ROUNDING, Way, bound_error, course, meet, ways, ways_of_bodies

#: Entries of a motion.
ENTRIES = (*TangentialMotion.numbers(), "status", "detail")
#: Entries that may be 0, one number for a batch.
NO_LOSS = ("shear_loss", "normal_spin_change")
#: Angles of incidence from nearly central to grazing, and inertia ratios.
PSI1 = (0.01, 0.3, 0.9, 1.2, 2.0, 3.5, 6.0, 40.0)
CHI = (0.4, 1.4411764706, 3.0)
#: Bound of the imbalance of the energy books, if a force begins or ends within a step.
BOOKS = 0.03
#: psi2 of partial slip, theory §5.
REFERENCE = {
    (1.4411764706, 0.1): 0.0205907061,
    (1.4411764706, 0.5): 0.0478310787,
    (1.4411764706, 1.2): -0.1805194095,
    (1.4411764706, 2.0): -0.8372100068,
    (1.4411764706, 4.0): -1.4365122247,
    (1.0, 0.5): -0.2650325763,
    (1.0, 2.0): -1.2952883031,
    (3.0, 1.0): 0.0633660877,
    (3.0, 3.0): 1.1585220552,
}


def iterate_impacts(
    law: TangentialLaw | Integrator,
) -> Iterator[tuple[Way, float, float, float, float]]:
    """Iterate over ways, psi1 and chi, with change of psi and friction work of each impact."""
    for way in ways_of_bodies(law):
        for chi, psi1 in itertools.product(CHI, PSI1):
            change, _, work = meet(way, psi1, chi)
            yield way, psi1, chi, change, work


@check(TangentialLaw, Integrator)
def impact_odd(law: TangentialLaw | Integrator) -> None:
    """An impact from the other side is the mirror image (theory §7)."""
    for way, psi1, chi, change, work in iterate_impacts(law):
        mirrored, _, work_back = meet(way, -psi1, chi)
        gap = max(abs(change + mirrored), abs(work - work_back)) / max(1.0, psi1)
        within(
            gap,
            1e-9,
            f"psi1 = -{psi1}, chi = {chi}: differs by {gap:.1e} from the mirror image ({way}).",
        )


@check(TangentialLaw)
def impact_units(law: TangentialLaw) -> None:
    """An impact does not depend on the units of length, time and mass (theory §7)."""
    for way, converted in zip(
        ways_of_bodies(law), ways_of_bodies(in_units(law, ODD_UNITS)), strict=True
    ):
        for chi, psi1 in itertools.product(CHI, PSI1):
            change, _, work = meet(way, psi1, chi)
            converted_change, _, converted_work = meet(converted, psi1, chi, units=ODD_UNITS)
            gap = max(abs(change - converted_change), abs(work - converted_work)) / max(1.0, psi1)
            within(
                gap,
                1e-8,
                f"psi1 = {psi1}, chi = {chi}: in other units psi2 differs by {gap:.1e} ({way}).",
            )


@check(TangentialLaw, nature=GROWS)
def impact_bounds(law: TangentialLaw) -> None:
    """|psi2| is at most |psi1|, and psi changes by at most 4 chi (theory §7)."""
    for way, psi1, chi, change, _ in iterate_impacts(law):
        room = bound_error(way)
        after = psi1 + change
        within(
            abs(after),
            psi1 + room,
            f"psi1 = {psi1}, chi = {chi}: |psi2| = {abs(after):.4g}, energy from nothing ({way}).",
        )
        hold(
            -change <= 4.0 * chi * (1.0 + room) and change <= 4.0 * chi * (1.0 + room),
            f"psi1 = {psi1}, chi = {chi}: psi changes by {change:.4g}, more than mu P can.",
        )


@check(TangentialLaw, nature=CHANGES)
def impact_books(law: TangentialLaw) -> None:
    """The energy lost in an impact is the friction work, at any angle (theory §7)."""
    for way, psi1, chi, change, work in iterate_impacts(law):
        loss = -change * (psi1 + 0.5 * change)
        # The loss is over the energy of psi = 1 at least: no grid resolves a very small slip.
        missing = abs(loss - work) / (0.5 * max(psi1, 1.0) ** 2)
        within(
            missing,
            1e-6 if way.exact else BOOKS,
            f"psi1 = {psi1}, chi = {chi}: {missing:.1%} of the energy is unaccounted ({way}).",
        )


@check(TangentialLaw)
def impact_coulomb_limit(law: TangentialLaw) -> None:
    """The force never exceeds mu P along an impact (TangentialLaw, 1)."""
    followed = 0
    for way in ways_of_bodies(law):
        for chi, psi1 in itertools.product(CHI, (0.3, 1.2, 3.5)):
            history = course(way, psi1, chi)[0]
            if np.isnan(history.tangential_force).all():
                continue  # a whole-impact answer without a course
            followed += 1
            limit = FRICTION * history.normal_force
            largest = float(limit.max())
            over = float(np.max(np.abs(history.tangential_force) - limit)) / largest
            within(
                over,
                bound_error(way),
                f"psi1 = {psi1}, chi = {chi}: abs(F) exceeds mu P by {over:.2g} of mu P_max.",
            )
    apply_if(followed, "Its whole-impact answers have no course, and so no force to check.")


@check(TangentialLaw)
def impact_central(law: TangentialLaw) -> None:
    """A central impact makes no tangential force (TangentialLaw, 1)."""
    for way in ways_of_bodies(law):
        for chi in CHI:
            change, _, work = meet(way, 0.0, chi)
            least = ROUNDING if way.bodies else 0.0  # a sum of many steps, where nothing is zero
            sentence = f"psi1 = 0 gives psi2 = {change:.2g} ({way})."
            hold(abs(change) <= least and abs(work) <= least, sentence)


@check(TangentialLaw, Integrator)
def impact_repeatable(law: TangentialLaw | Integrator) -> None:
    """A run does not change the law, is repeatable, and does not depend on an observer."""
    for way in ways_of_bodies(law):
        kept = copy.deepcopy(law)
        first = meet(way, 1.2, 1.44)[1]
        meet(way, 3.5, 3.0)
        again = meet(way, 1.2, 1.44)[1]
        hold(same(first, again), f"The same impact, run twice, ends differently ({way}).")
        once, twice = (meet(way, 40.0, 1.44)[1] for _ in range(2))
        hold(same(once, twice), f"An impact that slips, run twice, ends differently ({way}).")
        hold(same(kept, law), f"A run changed the law ({way}).")
        watched = course(way, 1.2, 1.44)[1]
        gap = float(magnitude(watched.slip_velocity_change - first.slip_velocity_change))
        gap /= float(magnitude(first.slip_velocity_change)) or 1.0
        # a compiled solver shows no instants: what is watched is solved by another, to rounding
        compiled = isinstance(way.law, PathTangentialLaw) and bool(
            way.law.cost(scene(1.2, 1.44), None).solver
        )
        room = 1e-9 if isinstance(way.law, AllStepsTangentialLaw) else 1e-12 * compiled
        within(gap, room, f"Watched, an impact ends differently, by {gap:.1e} ({way}).")


@check(TangentialLaw, Integrator)
def impact_batch(law: TangentialLaw | Integrator) -> None:
    """A batch of impacts of unlike bodies ends as each impact does alone (Integrator, 3)."""
    psi1 = np.array([[-2.0, 0.0, 0.3], [1.2, 5.0, 40.0]])
    chi = np.array([[0.4, 1.0, 1.5], [1.5, 3.0, 3.0]])
    friction = np.linspace(0.1, 0.7, psi1.size).reshape(psi1.shape)
    impacts = scene(psi1, chi, bodies=bodies(*psi1.shape), friction=friction)
    room = 1e-9 if isinstance(law, Integrator) else 1e-8
    for way in ways_of_bodies(law):
        change, motion, work = way.run(impacts)
        for name in ENTRIES:
            entry = getattr(motion, name)
            none = name in NO_LOSS and entry == 0.0  # one number for all
            hold(
                np.shape(entry) == psi1.shape or none, f"{name} has not the batch's shape ({way})."
            )
        for place in np.ndindex(psi1.shape):
            alone, _, alone_work = way.run(impacts.take(place))
            changed, worked = (float(np.asarray(each)[place]) for each in (change, work))
            off, work_off = (
                changed - float(np.asarray(alone)),
                worked - float(np.asarray(alone_work)),
            )
            gap = max(abs(off), abs(work_off))
            gap /= max(1.0, abs(float(psi1[place])))
            within(gap, room, f"Impact {place} of a batch is off by {gap:.1e} in psi ({way}).")


@check(TangentialLaw)
def impact_after_another(law: TangentialLaw) -> None:
    """An impact does not depend on scenes that were run before (Law, 1)."""
    first = scene(1.2, CHI[1])
    second = scene(2.0, CHI[2], bodies=1.6, friction=0.6)
    stacked = scene(
        *(np.full((1, 1, 1), number) for number in (2.0, CHI[2])), bodies=1.6, friction=0.6
    )
    for way in ways_of_bodies(law):
        way.run(first)
        alone, _, _ = way.run(second)
        gap = abs(float(np.ravel(way.run(stacked).change)[0]) - float(alone))
        within(
            gap,
            1e-8,
            f"An impact of other bodies, run after another scene of its shape, is {gap:.2g} off in "
            f"psi. Is something kept from one scene for the next ({way})?",
        )


@check(TangentialLaw, claim="partial_slip", nature=WHOLE)
def impact_reference(law: TangentialLaw) -> None:
    """Impacts with partial slip end as the exact solution does (theory §5)."""
    for way in ways_of_bodies(law):
        for (chi, psi1), psi2 in REFERENCE.items():
            error = abs(psi1 + meet(way, psi1, chi)[0] - psi2)
            within(
                error,
                1e-8 if way.exact else bound_error(way),
                f"psi1 = {psi1}, chi = {chi}: psi2 is {error:.2g} off ({way}).",
            )


@check(AllStepsTangentialLaw)
def all_steps(law: AllStepsTangentialLaw) -> None:
    """All steps at once give the same as step by step, for a batch too (AllStepsTangentialLaw)."""
    way = next(iter(ways(law)))
    for chi, psi1 in itertools.product(CHI, PSI1):
        _, motion, _ = meet(way, psi1, chi)
        _, watched = course(way, psi1, chi)
        gap = abs(float(watched.slip_velocity_change / motion.slip_velocity_change) - 1.0)
        within(gap, 1e-8, f"psi1 = {psi1}, chi = {chi}: differs by {gap:.1e}.")
    for chis in (CHI[1], np.linspace(CHI[0], CHI[-1], len(PSI1))):
        impacts = scene(np.array(PSI1), chis)
        at_once = way.run(impacts)
        recorder = Recorder(impacts.shape, with_fields=False, stepwise=True)
        stepped = way.run(impacts, recorder)
        for together, single in ((at_once.change, stepped.change), (at_once.work, stepped.work)):
            gap = float(np.max(np.abs(together - single) / np.maximum(1.0, PSI1)))
            within(gap, 1e-8, f"A batch of shape {impacts.shape}: differs by {gap:.1e}.")
