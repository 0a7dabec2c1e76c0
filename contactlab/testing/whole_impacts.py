"""Checks of what a tangential law knows of whole impacts, and of gross slip."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import trapezoid

from contactlab.compose.answers import answers
from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.registry import REGISTRY
from contactlab.contracts import NormalLaw, NormalMotion, TangentialLaw, WholeImpact
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import spread
from contactlab.testing.bench import scene, slack
from contactlab.testing.check import NotApplicableError, apply_if, check, hold
from contactlab.testing.compare import well_formed
from contactlab.testing.impacts import CHI, PSI1
from contactlab.testing.laws import DampedHertz
from contactlab.testing.ways import INTEGRATION, ROUNDING, Way, allowed, course, ways

#: Angles of these checks: those of impacts, where gross slip begins (46), and the other side.
ANGLES = (0.0, *PSI1, *(4.0 * chi for chi in CHI), -0.3, -6.0)
#: So much slip that no contact comes to rest, over 4 chi.
GRAZING = 300.0
#: Points along a course, and what the trapezium rule makes of it there.
POINTS, QUADRATURE = 20_001, 3e-4


class Known(NamedTuple):
    """What a law knows of one impact."""

    psi1: float
    chi: float
    scene: Scene
    normal: NormalMotion
    answer: WholeImpact

    def __str__(self) -> str:
        """Return which impact, and why it is known."""
        return f"psi1 = {self.psi1}, chi = {self.chi:.3g}, {self.answer.reason!r}"


def known(law: TangentialLaw, normal_law: NormalLaw | None = None) -> Iterator[Known]:
    """Iterate over the impacts that the law answers as wholes."""
    normal_law = normal_law or REGISTRY.create("normal.hertz")
    for chi, psi1 in itertools.product(CHI, ANGLES):
        given = scene(psi1, chi)
        normal = normal_motion(normal_law, given)
        for _, answer in answers(given, normal, law, history=False):
            yield Known(psi1, chi, given, normal, answer)


@check(TangentialLaw)
def whole_impacts(law: Any) -> None:
    """Where a law that can be marched answers a whole impact, its own march agrees (Law, 4).

    In the change of slip velocity, the energy lost and the course.
    """
    marches = [way for way in ways(law) if way.integrator is not None]
    apply_if(marches, "It is no law that an integrator follows.")
    found = [each for each in known(law) if each.psi1 != 0.0]
    apply_if(found, "It knows of no impact with slip as a whole.")
    for way, each in itertools.product(marches, found):
        psi1, chi, given, _, answer = each
        change = way.run(given).change
        room, unit = allowed(way), given.pair.tangential_mass / given.psi_scale**2
        off = abs(change - given.psi(float(np.asarray(answer.slip_velocity_change))))
        hold(
            off <= room * 4.0 * chi,
            f"{each}: psi2 is {off:.2g} off the law's own run ({way})."
            f" Bound: {room * 4.0 * chi:.2g}.",
        )
        # Not the work that the march adds up: a law may be known to keep no books.
        lost = -change * (psi1 + 0.5 * change)
        off = abs(lost - float(np.asarray(answer.friction_work)) / unit)
        hold(
            off <= room * 4.0 * chi * max(psi1, 1.0),
            f"{each}: the friction work is {off:.2g} off the energy lost in the law's own run "
            f"({way})."
            f" Bound: {room * 4.0 * chi * max(psi1, 1.0):.2g}.",
        )
        if answer.course is not None:
            _courses_agree(way, each, room)


def _courses_agree(way: Way, each: Known, room: float) -> None:
    """Hold that the course of an answer is that of the march."""
    marched, _ = course(way, each.psi1, each.chi)
    phases = np.linspace(0.0, np.pi, POINTS)
    sample = each.normal.at(phases)
    assert each.answer.course is not None
    change, force = each.answer.course(sample.load_impulse, sample.contact.friction_load)
    largest = float(each.scene.friction_coefficient) * float(each.normal.maximum_force)
    velocity = np.interp(marched.time, sample.time, each.scene.slip_velocity + change)
    gap = float(np.max(np.abs(each.scene.psi(marched.slip_velocity - velocity))))
    hold(
        gap <= 2.0 * room * 4.0 * each.chi,
        f"{each}: along the course psi is {gap:.2g} off the law's own run ({way})."
        f" Bound: {2.0 * room * 4.0 * each.chi:.2g}.",
    )
    acting = np.interp(marched.time, sample.time, force)
    gap = float(np.max(np.abs(marched.tangential_force - acting))) / largest
    hold(
        gap <= 2.0 * room,
        f"{each}: along the course the force is {gap:.2g} mu P_max off that of the law's own "
        f"run ({way})."
        f" Bound: {2.0 * room:.2g}.",
    )


@check(TangentialLaw)
def whole_impact_form(law: Any) -> None:
    """An answer for a whole impact is a finite number, its work not negative, its course its own.

    Along the course the force adds up to the change of slip velocity and to the friction work.
    """
    found = list(known(law))
    apply_if(found, "It knows of no impact as a whole.")
    for each in found:
        given, answer = each.scene, each.answer
        mass, slip = float(given.pair.tangential_mass), float(np.asarray(given.slip_velocity))
        energy = 0.5 * mass * max(abs(slip), 1.0 / float(given.psi_scale)) ** 2
        for name in ("slip_velocity_change", "friction_work"):
            value = getattr(answer, name)
            good = well_formed(value, ()) and np.isfinite(value)
            hold(good, f"{each}: {name} = {value!r}.")
        change, work = float(answer.slip_velocity_change), float(answer.friction_work)
        hold(work >= -ROUNDING * energy, f"{each}: the friction work is {work:.2g} J.")
        if answer.course is None:
            continue
        sample = each.normal.at(np.linspace(0.0, np.pi, POINTS))
        load = sample.contact.friction_load
        gained, force = (np.asarray(one) for one in answer.course(sample.load_impulse, load))
        hold(
            gained.shape == force.shape == (POINTS,),
            f"{each}: its course answers shapes {gained.shape}, {force.shape} to {(POINTS,)}.",
        )
        most = float(given.friction_coefficient) * float(each.normal.total_load_impulse)
        gap = abs(gained[-1] - change) * mass / most
        hold(
            gap <= ROUNDING,
            f"{each}: its course ends {gap:.2g} off its answer. Bound: {ROUNDING:.2g}.",
        )
        added = -float(trapezoid(force, sample.time))
        hold(
            abs(added - mass * change) <= QUADRATURE * most,
            f"{each}: the force along its course gives an impulse of {added:.4g} N s, its "
            f"answer one of {mass * change:.4g} N s."
            f" Bound: {QUADRATURE * most:.2g}.",
        )
        lost = float(trapezoid(force * (slip + gained), sample.time))
        hold(
            abs(lost - work) <= QUADRATURE * max(energy, most * abs(slip)),
            f"{each}: the force along its course does {lost:.4g} J of work, and its answer says "
            f"{work:.4g} J."
            f" Bound: {QUADRATURE * max(energy, most * abs(slip)):.2g}.",
        )


@check(TangentialLaw)
def sliding_impulse(law: Any) -> None:
    """A grazing impact slips throughout: friction takes mu (1 + e) v1 M_n/M_t from v_x.

    Under Hertz's law, where that is eq. (45), and under a damped one; by the march, and by what
    the law knows of whole impacts.
    """
    tried = 0
    for normal_law in (REGISTRY.create("normal.hertz"), DampedHertz()):
        try:
            marches = ways(law, normal_law)
        except NotApplicableError:
            continue
        for chi in CHI:
            given = scene(GRAZING * 4.0 * chi, chi)
            normal = normal_motion(normal_law, given)
            bounce = 1.0 - float(normal.final_rate) / float(given.normal_speed)
            taken = -2.0 * chi * bounce
            for way in marches:
                tried += 1
                off = abs(way.run(given).change / taken - 1.0)
                # Discs and steps apart: a law with a grid slips at a limit of its own.
                room = slack(law, 0.0) + (1e-6 if way.exact else INTEGRATION)
                hold(
                    off <= room,
                    f"A grazing impact under {type(normal_law).__name__}, chi = {chi:.3g}, is "
                    f"{off:.2g} off mu (1 + e) v1 M_n/M_t ({way})."
                    f" Bound: {room:.2g}.",
                )
            for _, answer in answers(given, normal, law, history=False):
                change = spread(answer.slip_velocity_change, ())
                off = abs(float(given.psi(change)) / taken - 1.0)
                hold(
                    off <= 1e-6,
                    f"A grazing impact under {type(normal_law).__name__}, chi = {chi:.3g}, is "
                    f"{off:.2g} off mu (1 + e) v1 M_n/M_t ({answer.reason})."
                    " Bound: 1e-6.",
                )
    apply_if(tried, "There is no way to run it.")
