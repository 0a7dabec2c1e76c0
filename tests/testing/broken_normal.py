"""Normal laws that break one clause of the contract each."""

from __future__ import annotations

from typing import ClassVar

import attrs
import numpy as np

import contactlab
from contactlab.contracts import NormalContact, NormalLaw
from tests.laws.outside_laws import Plastic
from tests.testing.fresh_faults import HERTZ, MOTION
from tests.testing.made import altered, broken

Viscoelastic = type(contactlab.create("normal.viscoelastic"))


class Altered(HERTZ):
    """Hertz's law with something done to the contact."""

    def alter(self, contact, approach, rate):
        raise NotImplementedError

    def respond(self, state, approach, rate):
        contact, state = super().respond(state, approach, rate)
        return self.alter(contact, approach, rate), state


class NegativeLoad(Altered):
    """Pulls behind first touch, and takes the pull for a friction load."""

    def alter(self, contact, approach, rate):
        force = contact.force - 1.0 * (contact.overlap > 0.0)
        return contact._replace(force=force, friction_load=force)


class LosesContact(Altered):
    """No contact any more where it is deep."""

    def alter(self, contact, approach, rate):
        shallow = 1.0 * (approach <= 1e-5)
        overlap = contact.overlap * (2.0 * shallow - 1.0)
        held = NormalContact(*(part * shallow for part in contact))
        return held._replace(overlap=overlap)


@attrs.frozen(kw_only=True)
class Stepwise(NormalLaw):
    """Hertz's force and radius, with something done to both; its motion is solved."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius", "hertzian_pressure"})

    def start(self, scene):
        pair = scene.pair
        return (4.0 / 3.0) * pair.effective_modulus, pair.radius, pair.normal_mass

    def respond(self, state, approach, rate):
        modulus, radius, mass = state
        inside = approach * (approach > 0.0)
        width = (radius * inside) ** 0.5
        dashpot = (mass * modulus * width) ** 0.5
        contact = NormalContact(modulus * width * inside, width, approach)
        return self.alter(contact, dashpot, rate), state

    def alter(self, contact, dashpot, rate):
        return contact


class Viscous(Stepwise):
    """Says that it is viscous."""

    offers: ClassVar[frozenset[str]] = frozenset({"viscous"})


class EndsUnderLoad(Stepwise):
    """Lets go at a depth that is not behind first touch."""

    def alter(self, contact, dashpot, rate):
        depth = contact.overlap - 2e-5
        gone = np.where(depth > 0.0, 1.0, 0.0)[()]
        return NormalContact(contact.force * gone, contact.radius * gone, depth)


class FirstOfTheMotion(HERTZ):
    """Of a batch the motion of the first radius, for all; impact by impact nothing is wrong."""

    def motion(self, scene):
        radius = np.ravel(scene.pair.radius)[0] + np.zeros(scene.shape)[()]
        pair = attrs.evolve(scene.pair, radius=radius)
        return attrs.evolve(super().motion(attrs.evolve(scene, pair=pair)), scene=scene)


class WritesIntoIt(Stepwise):
    """Shortens the approach that it was given, in place."""

    def respond(self, state, approach, rate):
        if np.ndim(approach):
            approach -= 1e-9
        return super().respond(state, approach, rate)


@attrs.frozen(kw_only=True)
class Remembers(NormalLaw):
    """Writes into its state."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius"})

    def start(self, scene):
        return [0.0]

    def respond(self, state, approach, rate):
        state[0] = np.maximum(state[0], approach)
        deep = approach * (approach > 0.0)
        return NormalContact(1e6 * state[0] * (deep > 0.0), deep, approach), state


class Moving(HERTZ):
    """Hertz's law with something done to its motion in closed form."""

    moving: ClassVar[type] = MOTION

    def motion(self, scene):
        return self.moving.of(self, scene)


class MovesAsIfHeavier(Moving):
    """A Hertz impact, of a mass that is not the pair's; it says that it is."""

    def motion(self, scene):
        pair = attrs.evolve(scene.pair, normal_mass=1.1 * scene.pair.normal_mass)
        motion = super().motion(attrs.evolve(scene, pair=pair))
        return attrs.evolve(motion, scene=scene)


class Hurried(MOTION):
    """A rate of time in plain floats that is not that of the arrays."""

    def scaled_at(self, phase):
        here = super().scaled_at(phase)
        return here._replace(time_rate=1.01 * here.time_rate)


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (NegativeLoad, "presses", "N is negative"),
    (LosesContact, "presses", "At the deepest approach the overlap says that there is no"),
    (EndsUnderLoad, "ends_unloaded", "Contact ends under load: the force is still"),
    (FirstOfTheMotion, "motion_batch", "impact 1 of a batch is off"),
    (WritesIntoIt, "contacts_read_only", "The law writes into what it was given"),
    (MovesAsIfHeavier, "motion_obeys_newton", "The rate is"),
    (Remembers, "contacts_pure", "The state that went in was changed"),
    *broken(Altered, "alter",
        ("PullsFromAfar", lambda contact, *_: contact._replace(force=contact.force - 1.0),
         "presses", "There is force out of contact"),
        ("GivesMore",
         lambda contact, _approach, rate: contact._replace(
             force=contact.force * np.where(rate < 0.0, 1.1, 1.0)[()]),
         "normal_passive", "from nothing"),
        ("Narrows",
         lambda contact, approach, _rate: contact._replace(
             radius=contact.radius * (1.0 - 0.8 * (approach > 1e-5))),
         "grows", "The radius falls by 0.8"),
        ("ReadsNanAsNoContact",
         lambda contact, *_: NormalContact(*[np.nan_to_num(part)[()] for part in contact]),
         "contacts_non_finite", "An approach of NaN gives a force of 0.0"),
        ("InNewtons",
         lambda contact, *_: contact._replace(force=contact.force * (1.0 + 1e-6 * contact.force)),
         "contacts_units", "In other units the force differs"),
        ("ComplexForce", lambda contact, *_: contact._replace(force=contact.force + 0j),
         "contacts", "force = 0j"),
        ("MeanApproach",
         lambda contact, *_: contact._replace(force=np.mean(contact.force) + 0.0 * contact.force),
         "contacts_batch", "Contact 0 of a batch that differs in normal_speed only"),
        ("NotItsMotion", lambda contact, *_: contact._replace(force=1.01 * contact.force),
         "motion_agrees", "The force of the motion is 1.0e-02 off"),
        ("Wide", lambda contact, *_: contact._replace(radius=1.01 * contact.radius),
         "elastic_hertz", "The radius is 0.01 off Hertz's"),
    ),
    *broken(Viscous, "alter",
        ("ViscousAtRestToo", lambda contact, dashpot, _: contact._replace(
             force=contact.force + 0.1 * dashpot),
         "viscous", "its force at rest is"),
        ("ViscousAndWider", lambda contact, *_: contact._replace(radius=1.1 * contact.radius),
         "viscous", "its radius is 0.1 off"),
        ("ViscousWithoutLoss", lambda contact, *_: contact,
         "viscous", "resists an approach no more than rest"),
    ),
    *altered(Viscoelastic, "respond",
        ("PartsLater", lambda contact, state, *_: (
             contact._replace(radius=1.01 * contact.radius), state),
         "kelvin_voigt", "its force is 0.029 off"),
    ),
    *broken(Viscoelastic, "respond",
        ("RelaxesAtNoOneTime", lambda state, approach, rate: Viscoelastic().respond(
             state, approach, rate * abs(rate)),
         "kelvin_voigt", "relaxation times differ"),
    ),
    *broken(Stepwise, "alter",
        ("PushesBothWays",
         lambda contact, dashpot, rate: contact._replace(
             force=contact.force + 0.2 * dashpot * abs(rate)),
         "normal_passive", "A closed cycle at rates (0.05, 1.0) of v1 gives"),
        ("ALittleWide", lambda contact, *_: contact._replace(radius=1.05 * contact.radius),
         "hertzian_pressure", "At rest its force is that of an elastic body, and b² is 1.1"),
        ("HalfAsWide", lambda contact, *_: contact._replace(radius=0.5 * contact.radius),
         "hertzian_pressure", "b² is 0.25 R z at greatest compression: less than"),
        ("WithoutItsRadius", lambda contact, *_: contact._replace(radius=0.0 * contact.radius),
         "radius", "but gives no radius"),
    ),
    *broken(Moving, "moving",
        ("ScaledOtherwise", Hurried, "motion_scaled", "off scaled"),
    ),
    *altered(HERTZ, "motion",
        ("Runaway",
         lambda motion, scene: attrs.evolve(motion, final_rate=-1.5 * scene.normal_speed),
         "rebounds", "The bodies part 1.5 times as fast"),
        ("StillApproaches",
         lambda motion, scene: attrs.evolve(motion, final_rate=0.1 * scene.normal_speed),
         "rebounds", "The bodies part -0.1 times as fast"),
        ("PartsSlowerThanItPushes",
         lambda motion, scene: attrs.evolve(motion, final_rate=-0.9 * scene.normal_speed),
         "rebounds", "The force adds up to an impulse that is 0.053 off"),
        ("MisstatesItsImpulse", lambda motion, _: attrs.evolve(
            motion, total_load_impulse=1.01 * motion.total_load_impulse),
         "rebounds", "The friction load's impulse is 0.01 off its integral"),
    ),
    *altered(Plastic, "respond",
        ("TwiceAsWide",
         lambda contact, state, *_: (contact._replace(radius=2.0 * contact.radius), state),
         "hertzian_pressure", "At rest b² comes to 4 R z_max"),
    ),
    *altered(Stepwise, "start",
        ("FirstBody", lambda modulus, radius, mass, _: (modulus, float(np.ravel(radius)[0]), mass),
         "contacts_batch", "Contact 1 of a batch that differs in radius only is off"),
    ),
]  # fmt: skip
