"""Laws of paths, of whole impacts and of all steps at once that break one clause each."""

from __future__ import annotations

import math
from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import (
    AllStepsResponse,
    AllStepsTangentialLaw,
    NormalContact,
    PathTangentialLaw,
    Stretch,
    WholeImpactTangentialLaw,
    sliding,
)
from contactlab.contracts.tangential import Increment
from tests.testing.broken_laws import Sound
from tests.testing.made import broken


class AllAtOnce(Sound, AllStepsTangentialLaw):
    """A sound spring and slider: all steps at once, which for such a law is the same loop."""

    def advance_all(self, scene, normal, steps):
        state, forces, work = self.start(scene, normal), [], 0.0
        velocity, mass = scene.slip_velocity, scene.pair.tangential_mass
        contact = NormalContact(0.0, 0.0, 0.0, 0.0)
        for row in zip(*steps.contact, *steps[1:4], strict=True):
            before, contact, (drift, kick, load) = contact, NormalContact(*row[:4]), row[4:]
            given = Increment(velocity * drift, velocity, load, kick)
            response, state = self.advance(state, given, before, contact)
            velocity = velocity - response.force * kick / mass
            forces.append(response.force)
            work = work + response.friction_work
        return self.told(AllStepsResponse(np.array(forces), work, True))

    def told(self, response):
        return response


class OtherwiseAtOnce(AllAtOnce):
    """A little weaker where all steps are taken at once."""

    def told(self, response):
        return response._replace(force=0.99 * response.force)


class Knowing(Sound):
    """A spring and a slider, which knows of grazing impacts as wholes."""

    def whole_impacts(self, scene, normal):
        where = np.abs(scene.psi1) >= 5.0 * np.asarray(scene.chi)
        known = sliding(scene, normal, where=where, reason="grazing", stops=False)
        return (*super().whole_impacts(scene, normal), self.told(known, scene))

    def told(self, known, scene):
        return known


def by_course(change):
    """Return a change of an answer: another change of velocity and force along its course."""

    def told(known, scene):
        def course(impulse, load):
            return change(known, *known.course(impulse, load))

        return attrs.evolve(known, course=course)

    return told


class KnowsTooMuch(Knowing):
    """Says that every impact grazes."""

    def told(self, known, scene):
        return attrs.evolve(known, where=True)


@attrs.frozen(kw_only=True)
class Whole(WholeImpactTangentialLaw):
    """Slip until it stops, with something done to the answer."""

    api_version: ClassVar[int] = 2

    def whole_impacts(self, scene, normal):
        known = sliding(scene, normal, where=True, reason="rigid", stops=True)
        return (*super().whole_impacts(scene, normal), self.told(known, scene))

    def told(self, known, scene):
        return known


class Changed(Whole):
    """Another change of the slip velocity."""

    def change(self, known, scene):
        raise NotImplementedError

    def told(self, known, scene):
        change = self.change(known.slip_velocity_change, scene)
        return attrs.evolve(known, slip_velocity_change=change)


class WholeTooLong(Whole):
    """Slips under a twentieth more of friction than there is, if it does not stop."""

    def told(self, known, scene):
        change = 1.05 * known.slip_velocity_change
        return attrs.evolve(known, slip_velocity_change=change, course=None)


class MovesTheCentral(WholeImpactTangentialLaw):
    """Makes a force of normal load alone."""

    api_version: ClassVar[int] = 2

    def whole_impacts(self, scene, normal):
        known = sliding(scene, normal, where=True, reason="rigid", stops=True)
        change = known.slip_velocity_change + 1e-3 * scene.normal_speed
        return (attrs.evolve(known, slip_velocity_change=change),)


COUNT = {"impacts": 0}


class WholeWears(Whole):
    """Weaker with every impact that any such law has seen."""

    def told(self, known, scene):
        COUNT["impacts"] += 1
        share = 1.0 / (1.0 + 0.01 * COUNT["impacts"])
        return attrs.evolve(known, slip_velocity_change=share * known.slip_velocity_change)


@attrs.frozen
class Slide(Stretch):
    """Gross slip with a factor on the force."""

    factor: float
    change: float
    work: float
    start: ClassVar[float] = 0.0
    stop: ClassVar[float] = math.pi

    def states(self, contact):
        return 0.5 * self.change * (1.0 - contact.rate), self.factor * contact.force


@attrs.frozen(kw_only=True)
class Paths(PathTangentialLaw):
    """Slips in one direction for ever, under some factor times Coulomb's force."""

    api_version: ClassVar[int] = 2
    force: ClassVar[float] = 1.0
    power: ClassVar[float] = 1.0

    def factor(self, motion):
        return self.force

    def path(self, velocity, inertia, motion, tolerance):
        factor = self.factor(motion)
        fall = 2.0 * motion.scaled_mass * factor
        change = -inertia * fall
        yield Slide(factor, change, self.power * fall * (velocity + 0.5 * change))


class PushesAlong(Paths):
    """Speeds slip up."""

    force: ClassVar[float] = -0.5


class SlipsWhateverItClaims(Paths):
    offers: ClassVar[frozenset] = frozenset({"partial_slip"})


IMPACTS = {"count": 0}


class Wears(Paths):
    """Weaker with every impact that any such law has seen."""

    def factor(self, motion):
        IMPACTS["count"] += 1
        return 1.0 / (1.0 + 0.01 * IMPACTS["count"])


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (OtherwiseAtOnce, "all_steps", "differs by"),
    (KnowsTooMuch, "whole_impacts", "off the law's own run (KnowsTooMuch by Symplectic)"),
    (WholeTooLong, "impact_bounds", "psi changes by -1.68, more than mu P can"),
    (MovesTheCentral, "impact_central", "psi1 = 0, chi = 0.4: UNBALANCED The contact slips inf"),
    (WholeWears, "impact_repeatable", "run twice, ends differently (as whole impacts)"),
    (PushesAlong, "impact_bounds", "energy from nothing (PushesAlong by Events)"),
    (SlipsWhateverItClaims, "impact_reference", "off (SlipsWhateverItClaims by Events)"),
    (Wears, "impact_repeatable", "run twice, ends differently"),
    *broken(Knowing, "told",
        ("KnowsHalfTheWork",
         lambda known, _scene: attrs.evolve(
             known, friction_work=0.5 * known.friction_work, course=None),
         "whole_impacts", "off the energy lost in the law's own run"),
        ("ShortImpulse",
         lambda known, _scene: attrs.evolve(
             known, slip_velocity_change=0.99 * known.slip_velocity_change, course=None),
         "whole_impacts", "'grazing': psi2 is 0.0",
         "sliding_impulse", "0.01 off mu (1 + e) v1 M_n/M_t (grazing)"),
    ),
    *broken(Whole, "told",
        ("WholeOfOtherWork",
         lambda known, _scene: attrs.evolve(known, friction_work=1.01 * known.friction_work),
         "whole_impact_form", "psi1 = 0.3, chi = 0.4, 'rigid': the force along its"),
        ("WholeOfNan",
         lambda known, _scene: attrs.evolve(known, friction_work=np.nan * known.friction_work),
         "whole_impact_form", "'rigid': friction_work = "),
        ("WholeWithoutBooks",
         lambda known, _scene: attrs.evolve(known, friction_work=0.5 * known.friction_work),
         "impact_books", "of the energy is unaccounted (as whole impacts)"),
        ("WholeOnePercentShort",
         lambda known, _scene: attrs.evolve(
             known, slip_velocity_change=0.99 * known.slip_velocity_change),
         "sliding_impulse", "0.01 off mu (1 + e) v1 M_n/M_t (as whole impacts)"),
        ("NegativeAsAWhole",
         lambda known, _scene: attrs.evolve(known, friction_work=-known.friction_work),
         "whole_impact_form", "the friction work is -"),
    ),
    *broken(Whole, "offers",
        ("WholeClaims", frozenset({"partial_slip"}), "impact_reference", "off (as whole impacts)"),
    ),
    *broken(Paths, "force",
        ("TooStrong", 1.2, "impact_coulomb_limit", "abs(F) exceeds mu P by 0.2"),
        ("PathOfNan", float("nan"),
         "impact_odd", "NON_FINITE At step 1: velocity, work or x is not finite"),
    ),
    *broken(Paths, "power",
        ("TooWeakInTheBooks", 0.5, "impact_books", "UNRESOLVED At step 2: the energy books miss"),
    ),
    *broken(Paths, "factor",
        ("PathInMetres", lambda motion: 1.0 / (1.0 + 100.0 * motion.maximum_radius),
         "impact_units", "differs by"),
    ),
    *broken(Knowing, "told",  # the right end, by a course that hurries
        ("KnowsAnotherCourse", by_course(lambda known, change, force: (
            known.slip_velocity_change * (change / known.slip_velocity_change) ** 0.5, force)),
         "whole_impacts", "along the course psi is"),
    ),
    *broken(Whole, "told",
        ("WholeBeyondCoulomb", by_course(lambda _, change, force: (change, 2.0 * force)),
         "impact_coulomb_limit", "abs(F) exceeds mu P by 0.74 of mu P_max",
         "whole_impact_form", "the force along its course gives an impulse of"),
    ),
    *broken(Changed, "change",
        ("WholeNotOdd",
         lambda known, scene: known * np.where(scene.slip_velocity > 0.0, 1.0, 0.9),
         "impact_odd", "(as whole impacts)"),
        ("WholeInMetres", lambda known, scene: 1.0 / (1.0 + 10.0 * scene.pair.radius) * known,
         "impact_units", "(as whole impacts)"),
        ("WholeTooStrong", lambda _, scene: -2.04 * scene.slip_velocity * np.ones(scene.shape),
         "impact_bounds", "energy from nothing (as whole impacts)"),
        ("WholeStopsAnything", lambda _, scene: -1.0 * scene.slip_velocity * np.ones(scene.shape),
         "impact_bounds", "psi changes by -2, more than mu P can"),
        ("WholeOfTheFirst", lambda known, scene: known * scene.pair.tangential_mass / (
            np.ravel(scene.pair.tangential_mass)[0]),
         "impact_batch", "(as whole impacts)"),
    ),
]  # fmt: skip
