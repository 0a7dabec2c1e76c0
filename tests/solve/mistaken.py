"""A contact, viscous friction and an integrator, sound but for one mistake that ``how`` names."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import ClassVar

import attrs
import numpy as np

from contactlab import create
from contactlab.contracts import (
    CausalTangentialLaw,
    CoupledIntegrator,
    CoupledTangentialLaw,
    Ends,
    Errors,
    NormalContact,
    NormalLaw,
    SteppedTangentialLaw,
    TangentialMotion,
    TangentialResponse,
)
from contactlab.contracts.contact import TOUCH
from contactlab.contracts.status import Status
from contactlab.contracts.whole_impact import WholeImpact
from contactlab.impact import kinetics
from contactlab.impact.hertz import hertz_stiffness

SOUND = create("integrator.symplectic", steps=20)
#: How often a normal law was asked.
ASKED = [0]


def depth_held(c):
    return {"overlap": abs(c.overlap) + TOUCH}


#: Mistakes of a contact, by its sound entries, the rate of approach and the stiffness.
CONTACTS = {
    "none": lambda _: {},
    "doubled": lambda c: {"force": c.force * (1.0 + (np.asarray(c.rate) < 0.0))},
    "2 % more": lambda c: {"force": c.force * (1.0 + 0.02 * (np.asarray(c.rate) < 0.0))},
    "negative": lambda c: {"radius": -c.radius},
    "negative where deep": lambda c: {
        "radius": c.radius * np.where(np.asarray(c.overlap) > 0.5, -1.0, 1.0)
    },
    "list": lambda c: {"force": np.atleast_1d(c.force).tolist()},
    "held": lambda c: {
        "force": c.stiffness * abs(c.overlap) ** 1.5 * np.sign(c.overlap), **depth_held(c)
    },
    "without force": lambda c: {"force": 0.0 * c.force, **depth_held(c)},
    "at rest": lambda c: {"force": 0.01 * c.rate + 0.0 * c.force, **depth_held(c)},
}  # fmt: skip


@attrs.frozen(kw_only=True)
class Contact(NormalLaw):
    """Hertz's contact."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "hertzian_pressure"})
    how: str = "none"
    number: int = 0

    def start(self, scene):
        return hertz_stiffness(scene), scene.pair.radius

    def respond(self, state, approach, rate):
        ASKED[0] += 1
        stiffness, size = state
        inside = np.maximum(approach, 0.0) + 0.0 * approach
        contact = NormalContact(stiffness * inside**1.5, (size * inside) ** 0.5, approach)
        given = SimpleNamespace(**contact._asdict(), rate=rate, stiffness=stiffness)
        return contact._replace(**CONTACTS[self.how](given)), state


def raising(a):
    if np.any(a.index == 1):
        raise ArithmeticError("that one")
    return {}


def spoilt(a):
    bad = (a.index == 1)[..., None] if np.ndim(a.force) > np.ndim(a.index) else a.index == 1
    return {"force": np.where(bad, math.nan, a.force)}


def pushing(a, sense=1.0):
    load = sense * 1e200 * np.asarray(a.load)
    vector = np.ndim(a.force) > np.ndim(a.index)
    force = np.stack([load, load], axis=-1) if vector else load
    return {"force": force, "friction_work": 0.0, "shear_loss": 0.0}


def listed(entry):
    return [np.asarray(entry).tolist()]


#: What viscous friction writes over though it may not, before it answers.
WRITTEN = {"moves": "displacement", "slows": "velocity", "loads": "friction_load"}
#: Mistakes of viscous friction, by its sound answer, the friction load and the index.
STEPS = {
    "raises": raising,
    "not finite": spoilt,
    "unsettled": lambda a: {"settled": a.index != 1},
    "cuts": lambda a: {
        "force": np.ravel(a.force)[:1], "friction_work": np.ravel(a.friction_work)[:1]
    },
    "pushes": pushing,
    "pulls": lambda a: pushing(a, -1.0),
    "work below zero": lambda a: {
        "friction_work": -a.friction_work, "shear_loss": 2.0 * a.friction_work
    },
    "loss below zero": lambda a: {
        "friction_work": 2.0 * a.friction_work, "shear_loss": -a.friction_work
    },
    "force listed": lambda a: {"force": listed(a.force)},
    "work listed": lambda a: {"friction_work": listed(a.friction_work)},
    "loss listed": lambda a: {"shear_loss": listed(a.shear_loss)},
    "settled listed": lambda _: {"settled": [True]},
    "settled nan": lambda _: {"settled": math.nan},
}  # fmt: skip


@attrs.frozen
class Slider(CausalTangentialLaw):
    """Viscous friction; ``how`` may also name what it declares as ``value``."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"vectors"})
    how: str = "none"
    value: object = None
    damping: float = 0.1

    def _or(self, name, value):
        return self.value if self.how == name else value

    def start(self, scene, normal):
        damping = self.damping * np.max(scene.pair.tangential_mass / normal.duration)
        return damping, np.asarray(scene.index)

    def stiffness(self, scene, normal):
        return self._or("stiffness", CausalTangentialLaw.stiffness(self, scene, normal))

    def books_bound(self, scene):
        return self._or("books_bound", math.inf)

    def errors(self, scene, normal, steps, accuracy=None):
        return self._or("errors", Errors())

    def advance(self, state, increment, before, after):
        if self.how in WRITTEN:
            entry = getattr(after if self.how == "loads" else increment, WRITTEN[self.how])
            if isinstance(entry, np.ndarray):
                entry[...] *= 0.5
        damping, index = state
        force = np.asarray(increment.velocity) * damping
        work = np.abs(force * increment.displacement)
        work = work.sum(axis=-1) if work.ndim > np.ndim(index) else work
        answer = TangentialResponse(force[()], work[()], True, 0.0 * work[()])
        if self.how not in STEPS:
            return answer, state
        given = SimpleNamespace(**answer._asdict(), load=after.friction_load, index=index)
        return answer._replace(**STEPS[self.how](given)), state


@attrs.frozen
class Seeded(Slider):
    """Keeps the index that a random seed would come from."""

    seen: ClassVar[list[int]] = []

    def start(self, scene, normal):
        self.seen.extend(np.ravel(scene.index).tolist())
        return Slider.start(self, scene, normal)


@attrs.frozen
class Undecided(Slider):
    """Cannot say whether it runs."""

    def accept(self, scene):
        raise TypeError("unknown scene")


@attrs.frozen
class Liar(Slider, CoupledTangentialLaw):
    """Answers both motions as told: NaN, an error for one impact, or books that do not close."""

    def whole_impacts(self, scene, normal):
        self._raise(scene)
        change = self._change(scene)
        where = np.ones(scene.shape, dtype=bool) if scene.shape else True
        return (
            WholeImpact(
                where=where, slip_velocity_change=change, friction_work=0.0 * abs(change),
                reason="told",
            ),
        )  # fmt: skip

    def _raise(self, scene):
        if self.how == "raises" and np.any(np.asarray(scene.index) == 1):
            raise RuntimeError("that one")

    def _change(self, scene):
        factor = {"nan": math.nan, "books": -1.0, "raises": -1e-9}[self.how]
        return factor * np.asarray(scene.slip_velocity)

    def solve_coupled(self, scene, normal, accuracy, observer=None):
        self._raise(scene)
        ones = np.ones(scene.shape)
        rate = -scene.normal_speed * ones
        if self.how == "raises":  # a small impulse along n alone keeps the energy
            W = np.asarray(scene.inverse_mass)
            push = scene.normal_speed / W[..., 0, 0] * 1e-9
            rate = (1.0 - 1e-9) * scene.normal_speed * ones
            slip = -W[..., 0, 1:] * np.asarray(push)[..., None]
            change = slip[..., 0] if scene.planar else slip
        else:
            change = self._change(scene) * np.ones((*scene.shape, *kinetics.slip_axes(scene)))
        status = np.full(scene.shape, Status.SUCCESS, dtype=object)
        return TangentialMotion(
            slip_velocity_change=change, friction_work=0.0 * ones,
            status=status if scene.shape else Status.SUCCESS,
            detail=np.full(scene.shape, "", dtype=object) if scene.shape else "", counters={},
            normal=Ends(duration=ones, final_rate=rate, maximum_radius=ones, maximum_approach=ones,
                        maximum_force=ones, dissipation=0.0 * ones, compressions=ones),
        )  # fmt: skip


@attrs.frozen
class Bounded(Liar):
    """Declares a bound of the books that it does not hold."""

    def books_bound(self, scene):
        return 0.01


#: What an integrator answers in place of its motion, or entries in place of those.
MOTIONS = {
    "none": lambda _: None,
    "tuple": lambda motion: (motion.slip_velocity_change, motion.friction_work),
    "complex": lambda motion: {"slip_velocity_change": motion.slip_velocity_change + 0j},
    "column": lambda _: {"friction_work": np.full((1, 1), 0.1)},
    "empty": lambda motion: {"slip_velocity_change": np.ravel(motion.slip_velocity_change)[:0]},
    "word": lambda _: {"status": "SUCCESS"},
    "no status": lambda _: {"status": None},
}


@attrs.frozen(kw_only=True)
class Spoiling(CoupledIntegrator):
    """Symplectic steps."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[type]] = frozenset({SteppedTangentialLaw})
    how: str

    def integrate(self, scene, normal, tangential, observer=None):
        return self._spoil(SOUND.integrate(scene, normal, tangential, observer))

    def integrate_coupled(self, scene, normal, tangential, observer=None):
        return self._spoil(SOUND.integrate_coupled(scene, normal, tangential, observer))

    def _spoil(self, motion):
        found = MOTIONS[self.how](motion)
        return attrs.evolve(motion, **found) if isinstance(found, dict) else found
