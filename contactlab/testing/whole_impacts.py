"""Checks of a tangential law's whole-impact answers, and of slip throughout."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from contactlab.contracts import NormalMotion, TangentialLaw, WholeImpact
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import spread
from contactlab.numeric.types import Real
from contactlab.registry.registry import REGISTRY
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.check import NotApplicableError, apply_if, check, hold, within
from contactlab.testing.compare import has_numbers
from contactlab.testing.impacts import CHI, PSI1
from contactlab.testing.laws import DampedHertz
from contactlab.testing.load_paths import Bench, scene, slack
from contactlab.testing.slip_speed import SLOWING, factor, varies
from contactlab.testing.ways import (
    INTEGRATION,
    ROUNDING,
    Way,
    bound_error,
    course,
    ways,
    whole_answers,
)

#: psi1 of these checks: ``PSI1``, the onset of slip throughout (46), and negative angles.
ANGLES = (0.0, *PSI1, *(4.0 * chi for chi in CHI), -0.3, -6.0)
#: psi1 over 4 chi of a grazing impact, in which every contact slips throughout.
GRAZING = 300.0
#: Points along a course, and the relative error of the trapezium rule over them.
POINTS, QUADRATURE = 20_001, 3e-4


class AnsweredImpact(NamedTuple):
    """One impact with a law's whole-impact answer."""

    psi1: float
    chi: float
    scene: Scene
    normal: NormalMotion
    answer: WholeImpact

    def __str__(self) -> str:
        """Return the impact in words, and the reason of the answer."""
        return f"psi1 = {self.psi1}, chi = {self.chi:.3g}, {self.answer.reason!r}"


def iterate_answers(law: TangentialLaw) -> Iterator[AnsweredImpact]:
    """Iterate over the impacts that have whole-impact answers."""
    normal_law = REGISTRY.create("normal.hertz")
    for chi, psi1 in itertools.product(CHI, ANGLES):
        impact = scene(psi1, chi)
        normal = normal_motion(normal_law, impact)
        for answer in whole_answers(law, normal):
            yield AnsweredImpact(psi1, chi, impact, normal, answer)


@check(TangentialLaw)
def whole_impacts(law: TangentialLaw) -> None:
    """A whole-impact answer agrees with the march of the same law (TangentialLaw, 3).

    The change of slip velocity, the energy lost and the course are compared.
    """
    marches = [way for way in ways(law) if way.integrator is not None]
    apply_if(marches, "No integrator can march it.")
    answered = [each for each in iterate_answers(law) if each.psi1 != 0.0]
    apply_if(answered, "The law has no whole-impact answer for an impact with slip.")
    for way, each in itertools.product(marches, answered):
        psi1, chi, impact, _, answer = each
        change = way.run(impact).change
        room, unit = bound_error(way), impact.pair.tangential_mass / impact.psi_scale**2
        error = abs(change - impact.psi(float(np.asarray(answer.slip_velocity_change))))
        within(
            error, room * 4.0 * chi, f"{each}: psi2 is {error:.2g} off the law's own run ({way})."
        )
        # The energy lost, and not the friction work of the march: energy books may not close.
        lost = -change * (psi1 + 0.5 * change)
        error = abs(lost - float(np.asarray(answer.friction_work)) / unit)
        within(
            error,
            room * 4.0 * chi * max(psi1, 1.0),
            f"{each}: the friction work is {error:.2g} off the energy lost in the law's own run "
            f"({way}).",
        )
        if answer.course is not None:
            _courses_agree(way, each, room)


def _courses_agree(way: Way, each: AnsweredImpact, room: float) -> None:
    """Hold that the course of a whole-impact answer agrees with the march."""
    marched, _ = course(way, each.psi1, each.chi)
    phases = np.linspace(0.0, np.pi, POINTS)
    sample = each.normal.at(phases)
    assert each.answer.course is not None
    change, force = each.answer.course(sample.load_impulse, sample.contact.friction_load)
    largest = float(each.scene.friction_coefficient) * float(each.normal.maximum_force)
    velocity = np.interp(marched.time, sample.time, each.scene.slip_velocity + change)
    gap = float(np.max(np.abs(each.scene.psi(marched.slip_velocity - velocity))))
    within(
        gap,
        2.0 * room * 4.0 * each.chi,
        f"{each}: along the course psi is {gap:.2g} off the law's own run ({way}).",
    )
    acting = np.interp(marched.time, sample.time, force)
    gap = float(np.max(np.abs(marched.tangential_force - acting))) / largest
    within(
        gap,
        2.0 * room,
        f"{each}: along the course the force is {gap:.2g} mu P_max off that of the law's own "
        f"run ({way}).",
    )


@check(TangentialLaw)
def whole_impact_form(law: TangentialLaw) -> None:
    """A whole-impact answer is finite, its work not negative, and its course leads to the answer.

    The impulse of the force along the course is the change of slip velocity times the mass, and
    the work of the force is the friction work, to the imbalance that ``books_bound`` declares.
    """
    from scipy.integrate import trapezoid  # help and lists import this file and need no scipy

    answered = list(iterate_answers(law))
    apply_if(answered, "The law has no whole-impact answer.")
    for each in answered:
        impact, answer = each.scene, each.answer
        mass, slip = float(impact.pair.tangential_mass), float(np.asarray(impact.slip_velocity))
        energy = 0.5 * mass * max(abs(slip), 1.0 / float(impact.psi_scale)) ** 2
        for name in ("slip_velocity_change", "friction_work"):
            value = getattr(answer, name)
            good = has_numbers(value, ()) and np.isfinite(value)
            hold(good, f"{each}: {name} = {value!r}.")
        change, work = float(answer.slip_velocity_change), float(answer.friction_work)
        hold(work >= -ROUNDING * energy, f"{each}: the friction work is {work:.2g} J.")
        if answer.course is None:
            continue
        sample = each.normal.at(np.linspace(0.0, np.pi, POINTS))
        load = sample.contact.friction_load
        gained, force = (np.asarray(column) for column in answer.course(sample.load_impulse, load))
        hold(
            gained.shape == force.shape == (POINTS,),
            f"{each}: its course answers shapes {gained.shape}, {force.shape} to {(POINTS,)}.",
        )
        largest = float(impact.friction_coefficient) * float(each.normal.total_load_impulse)
        gap = abs(gained[-1] - change) * mass / largest
        within(gap, ROUNDING, f"{each}: its course ends {gap:.2g} off its answer.")
        added = -float(trapezoid(force, np.asarray(sample.time)))
        within(
            abs(added - mass * change),
            QUADRATURE * largest,
            f"{each}: the force along its course gives an impulse of {added:.4g} N s, its "
            f"answer one of {mass * change:.4g} N s.",
        )
        lost = float(trapezoid(force * (slip + gained), np.asarray(sample.time)))
        bound = float(np.max(law.books_bound(impact)))
        room = QUADRATURE * max(energy, largest * abs(slip))
        room += bound * energy if np.isfinite(bound) else 0.0
        within(
            abs(lost - work),
            room,
            f"{each}: the force along its course does {lost:.4g} J of work, and its answer says "
            f"{work:.4g} J.",
        )


def changes(
    law: TangentialLaw, marches: list[Way], impact: Scene, normal: NormalMotion
) -> Iterator[tuple[Way | None, Real, str]]:
    """Iterate over changes of slip velocity (m/s) by ways and whole-impact answers, in words."""
    for way in marches:
        yield way, way.run(impact).motion.slip_velocity_change, str(way)
    for answer in whole_answers(law, normal):
        yield None, spread(answer.slip_velocity_change, ()), answer.reason


@check(TangentialLaw, nature="it makes no friction, or another than Coulomb's")
def sliding_impulse(law: TangentialLaw) -> None:
    """A grazing impact slips throughout: friction takes mu (1 + e) v1 M_n/M_t from v_x.

    The impacts are under Hertz's law, eq. (45), and a damped law; by the march and as
    whole-impact answers.
    """
    tried = 0
    for normal_law in (REGISTRY.create("normal.hertz"), DampedHertz()):
        try:
            marches = ways(law, normal_law)
        except NotApplicableError:
            continue
        for chi in CHI:
            impact = scene(GRAZING * 4.0 * chi, chi)
            normal = normal_motion(normal_law, impact)
            bounce = 1.0 - float(normal.final_rate) / float(impact.normal_speed)
            share = factor(law, Bench.of(), float(np.asarray(impact.slip_velocity)))
            expected = -2.0 * chi * bounce * share
            for way, change, how in changes(law, marches, impact, normal):
                tried += 1
                error = abs(float(impact.psi(change)) / expected - 1.0)
                room = 1e-6
                if way:  # the limit of a law with a grid differs by its discretisation
                    room = slack(law, 0.0) + (room if way.exact else INTEGRATION)
                room += SLOWING if varies(law) else 0.0
                within(
                    error,
                    room,
                    f"A grazing impact under {type(normal_law).__name__}, chi = {chi:.3g}, is "
                    f"{error:.2g} off mu (1 + e) v1 M_n/M_t ({how}).",
                )
    apply_if(tried, "There is no way to run it.")
