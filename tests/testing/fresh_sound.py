"""Sound laws in small methods: ``fresh_faults`` overrides one method of one of them at a time."""

from __future__ import annotations

import math
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    NormalLaw,
    PathTangentialLaw,
    SteppedTangentialLaw,
    Stretch,
    TangentialResponse,
    WholeImpact,
    WholeImpactTangentialLaw,
    without_tension,
)
from contactlab.numeric.checks import count, quantity


class Memory(NamedTuple):
    """Friction coefficient, places (m), stiffness (N/m), displacement and limit (m) of springs."""

    friction: Any
    places: Any
    stiffness: Any
    stretch: Any
    limit: Any


@attrs.frozen(kw_only=True)
class Brush(SteppedTangentialLaw):
    """Springs along the contact radius, each held at its share of mu times the friction load."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})
    offers: ClassVar[frozenset[str]] = frozenset({"partial_slip"})
    resolution: ClassVar[str | None] = "springs"

    expected_failures: ClassVar[dict[str, str]] = {
        "coulomb_at_a_point_damped": "each spring is limited separately",
    }

    springs: int = count(default=50, most=10_000)

    def friction(self, scene):
        return scene.friction_coefficient

    def modulus(self, scene):
        return scene.pair.effective_shear_modulus

    def start(self, scene, normal):
        width = np.asarray(normal.maximum_radius)[..., None] / self.springs
        places = width * (np.arange(self.springs) + 0.5)
        stiffness = 2.0 * np.asarray(self.modulus(scene))[..., None] * width
        stretch = np.zeros((*scene.shape, self.springs))
        return Memory(self.friction(scene), places, stiffness, stretch, stretch)

    def profile(self, places, radius):
        return np.maximum(radius**2 - places**2, 0.0)

    def limits(self, state, contact):
        profile = self.profile(state.places, np.asarray(contact.radius)[..., None])
        load = np.asarray(state.friction * contact.friction_load)[..., None]
        total = state.stiffness * profile.sum(axis=-1, keepdims=True)
        return load * profile / (total + (total == 0.0))  # the limits add up to mu L

    def advance(self, state, increment, before, after):
        limit = self.limits(state, after)
        old, trial = state.stretch, state.stretch + np.asarray(increment.displacement)[..., None]
        new = np.minimum(np.maximum(trial, -limit), limit)
        force = (state.stiffness * new).sum(axis=-1)
        work = (0.5 * state.stiffness * (old + new) * (trial - new)).sum(axis=-1)
        work = np.maximum(work, 0.0)
        if force.ndim == 0:
            force, work = float(force), float(work)
        return TangentialResponse(force, work), state._replace(stretch=new, limit=limit)

    def fields(self, state):
        return {"radius": state.places, "displacement": state.stretch, "limit": state.limit}

    def stiffness(self, scene, normal):
        return 2.0 * self.modulus(scene) * normal.maximum_radius


class Spring(NamedTuple):
    """Stiffness (N/m), or stiffness over radius (Pa); friction coefficient; force (N)."""

    stiffness: Any
    friction: Any
    force: Any


@attrs.frozen(kw_only=True)
class Slider(SteppedTangentialLaw):
    """A spring of one stiffness, half of Mindlin's of the largest contact, and a slider."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})

    def stiffness(self, scene, normal):
        return scene.pair.effective_shear_modulus * normal.maximum_radius

    def friction(self, scene):
        return scene.friction_coefficient

    def start(self, scene, normal):
        nothing = np.zeros(scene.shape) if scene.shape else 0.0
        return Spring(self.stiffness(scene, normal), self.friction(scene), nothing)

    def limit(self, state, before, after):
        return state.friction * after.friction_load

    def held(self, state, increment, before, after):
        """Force before the displacement of the step."""
        return state.force

    def advance(self, state, increment, before, after):
        held = self.held(state, increment, before, after)
        trial = held + state.stiffness * increment.displacement
        limit = self.limit(state, before, after)
        force = np.minimum(np.maximum(trial, -limit), limit)
        work = 0.5 * (force + held) * (trial - force) / state.stiffness
        return TangentialResponse(force, np.maximum(work, 0.0)), state._replace(force=force)


@attrs.frozen(kw_only=True)
class Mindlin(SteppedTangentialLaw):
    """F grows by 2 G* b dD within mu P; the force of area that leaves contact is let go."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})
    expected_failures: ClassVar[dict[str, str]] = {
        "books": "the books leave out what the spring loses as the contact shrinks",
        "impact_books": "the books leave out what the spring loses as the contact shrinks",
    }

    def modulus(self, scene):
        """Stiffness over the contact radius, in Pa."""
        return 2.0 * scene.pair.effective_shear_modulus

    def start(self, scene, normal):
        nothing = np.zeros(scene.shape) if scene.shape else 0.0
        return Spring(self.modulus(scene), scene.friction_coefficient, nothing)

    def advance(self, state, increment, before, after):
        stiffness = state.stiffness * after.radius
        softness = 1.0 / (stiffness + (stiffness == 0.0))
        kept = np.minimum(after.radius / (before.radius + (before.radius == 0.0)), 1.0)
        held = np.where(before.radius > 0.0, kept, 1.0) * state.force
        trial = held + stiffness * increment.displacement
        limit = state.friction * after.friction_load
        force = np.minimum(np.maximum(trial, -limit), limit)
        work = np.maximum(0.5 * (held + force) * (trial - force) * softness, 0.0)
        if np.ndim(state.force) == 0:
            force, work = float(force), float(work)
        return TangentialResponse(force, work), state._replace(force=force)

    def stiffness(self, scene, normal):
        return self.modulus(scene) * normal.maximum_radius


@attrs.frozen(kw_only=True)
class HardSphere(WholeImpactTangentialLaw):
    """The lesser of two impulses: of gross slip, and of a restitution of the slip velocity."""

    api_version: ClassVar[int] = 2

    def slip(self, scene):
        return scene.slip_velocity

    def mass(self, scene):
        return scene.pair.tangential_mass

    def friction(self, scene):
        return scene.friction_coefficient

    def impulse(self, scene, normal):
        """Impulse of the friction load, in N s."""
        return normal.total_load_impulse

    def restitution(self, scene):
        """Slip velocity after over before, reversed, where the contact does not slide."""
        return 0.4

    def whole_impacts(self, scene, normal):
        mass, slip = self.mass(scene), self.slip(scene)
        speed = np.abs(slip)
        sliding = self.friction(scene) * self.impulse(scene, normal) / mass
        lost = np.minimum(sliding, (1.0 + self.restitution(scene)) * speed)
        change, work = -np.sign(slip) * lost, mass * lost * (speed - 0.5 * lost)
        answer = self.answer(scene, change, work)
        return (*super().whole_impacts(scene, normal), answer)

    def answer(self, scene, change, work):
        return WholeImpact(
            where=True, slip_velocity_change=change, friction_work=work, reason="hard spheres"
        )


@attrs.frozen(kw_only=True)
class Tabled(HardSphere):
    """A slip restitution that falls with psi1, read from a table of some knots."""

    resolution: ClassVar[str | None] = "knots"

    knots: int = count(default=12, least=2, most=100_000)

    def restitution(self, scene):
        x = np.linspace(0.0, 40.0, self.knots)
        return np.interp(np.abs(scene.psi1), x, 0.6 * np.exp(-0.3 * x))

    def answer(self, scene, change, work):
        """Answer without a declared error."""
        return attrs.evolve(super().answer(scene, change, work), psi2_error=np.nan)


@attrs.frozen(kw_only=True)
class Press(NormalLaw):
    """Hertz's force times one and a dashpot (Hunt & Crossley 1975)."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "hertzian_pressure"})

    damping: float = quantity("1", default=0.1)

    def modulus(self, scene):
        return scene.pair.effective_modulus

    def radius(self, scene):
        return scene.pair.radius

    def speed(self, scene):
        return scene.normal_speed

    def start(self, scene):
        stiffness = (4.0 / 3.0) * self.modulus(scene) * self.radius(scene) ** 0.5
        return stiffness, self.radius(scene), self.damping / self.speed(scene)

    def dashpot(self, damping, rate):
        return 1.0 + damping * rate

    def respond(self, state, approach, rate):
        stiffness, radius, damping = state
        inside = approach * (approach > 0.0)
        force = stiffness * inside**1.5 * self.dashpot(damping, rate)
        return without_tension(force, self.width(radius * inside), approach), state

    def width(self, square):
        return square**0.5


class Slip(Stretch):
    """F = P, and psi falls in proportion to V, until psi is zero; a factor on the work."""

    power: ClassVar[float] = 1.0

    def __init__(self, velocity, inertia, motion):
        self.start, self.ratio = 0.0, inertia * motion.scaled_mass
        last, rest = motion.scaled_at(math.pi).rate, 1.0 - velocity / self.ratio
        self.stop = float(motion.phase_at_rate(rest)) if rest > last else math.pi
        self.change = -velocity if rest > last else -self.ratio * (1.0 - last)
        self.work = -self.power * self.change * (velocity + 0.5 * self.change) / inertia

    def states(self, contact):
        return self.ratio * (contact.rate - 1.0), contact.force


class Roll(Stretch):
    """No force, to the end."""

    def __init__(self, before):
        self.start, self.stop = before.stop, math.pi
        self.change, self.work = before.change, before.work

    def states(self, contact):
        return self.change + 0.0 * contact.force, 0.0 * contact.force


@attrs.frozen(kw_only=True)
class SlipThenRoll(PathTangentialLaw):
    """Friction of rigid bodies, as a path of two stretches."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"elastic_hertz"})

    slip: ClassVar[type] = Slip

    def path(self, velocity, inertia, motion, tolerance):
        slip = self.slip(velocity, inertia, motion)
        yield slip
        if slip.stop < math.pi:
            yield Roll(slip)


SOUND = (Brush, Slider, Mindlin, HardSphere, Tabled, Press, SlipThenRoll)
