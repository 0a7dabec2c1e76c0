"""Laws with known exact answers, on which integrators and other laws are checked."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    Increment,
    NormalContact,
    NormalLaw,
    NormalMotion,
    PathTangentialLaw,
    ScaledContact,
    SteppedTangentialLaw,
    Stretch,
    TangentialResponse,
)
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import choose, greater, spread
from contactlab.numeric.types import Array, Real


class Stretched(NamedTuple):
    """Stiffness over normal force, in 1/m, and the displacement so far, in m."""

    stiffness: Real
    displacement: Real


@attrs.frozen(kw_only=True)
class PressedSpring(SteppedTangentialLaw):
    """F = c P D, smooth from first touch to separation, where the force vanishes.

    The force has no Coulomb limit: the law is for orders of convergence only.
    """

    api_version: ClassVar[int] = 2
    #: c P_max times the square of the unit of time, C²R/v1, over the tangential mass.
    strength: ClassVar[float] = 1.3

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return c P_max, in N/m."""
        unit = normal.maximum_approach / scene.normal_speed
        return self.strength * scene.pair.tangential_mass / np.square(unit)

    def start(self, scene: Scene, normal: NormalMotion) -> Stretched:
        """Return the spring without displacement."""
        nothing = spread(0.0, scene.shape)
        return Stretched(self.stiffness(scene, normal) / normal.maximum_force, nothing)

    def advance(
        self,
        state: Stretched,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, Stretched]:
        """Return the force of the stretched spring."""
        displacement = state.displacement + increment.displacement
        force = state.stiffness * after.force * displacement
        return TangentialResponse(force, 0.0 * force), Stretched(state.stiffness, displacement)

    @classmethod
    def rebound(cls, motion: ClosedFormMotion) -> float:
        """Return the slip velocity after an impact over the slip velocity before.

        The scaled equations v' = -strength P D, D' = v are solved along the phase.
        """
        from scipy.integrate import solve_ivp

        def slope(phase: float, state: Array) -> list[float]:
            contact = motion.scaled_at(phase)
            rate = contact.time_rate
            return [-rate * cls.strength * contact.force * state[1], rate * state[0]]

        solution = solve_ivp(
            slope, (0.0, math.pi), [1.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-14
        )
        return float(solution.y[0, -1])


class Slip(NamedTuple):
    """Friction coefficient with the sign of slip, and the force at the last instant, in N."""

    friction: Real
    force: Real


@attrs.frozen(kw_only=True)
class Slider(SteppedTangentialLaw):
    """F = mu times the friction load of the step, against the slip velocity at first touch.

    In slip throughout the impulse of the force is mu times the load impulse.
    """

    api_version: ClassVar[int] = 2

    def start(self, scene: Scene, normal: NormalMotion) -> Slip:
        """Return friction coefficient with the sign of slip, and no force."""
        friction = scene.friction_coefficient * np.sign(scene.slip_velocity)
        return Slip(friction if scene.shape else float(friction), 0.0 * friction)

    def advance(
        self,
        state: Slip,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, Slip]:
        """Return the force of slip, and the work of the mean force."""
        force = state.friction * increment.friction_load
        work = 0.5 * (force + state.force) * increment.displacement
        return TangentialResponse(force, work), Slip(state.friction, force)


class Yield(NamedTuple):
    """Stiffness in N/m, friction coefficient, and the force at the last instant, in N."""

    stiffness: Real
    friction: Real
    force: Real


@attrs.frozen(kw_only=True)
class Yielding(SteppedTangentialLaw):
    """A spring of the stiffness of the largest contact, and a slider; its energy books close."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return 2 G* a, in N/m."""
        return scene.pair.tangential_stiffness(normal.maximum_radius)

    def start(self, scene: Scene, normal: NormalMotion) -> Yield:
        """Return the spring without force."""
        nothing = spread(0.0, scene.shape)
        return Yield(self.stiffness(scene, normal), scene.friction_coefficient, nothing)

    def advance(
        self,
        state: Yield,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, Yield]:
        """Return the force of the spring up to Coulomb's limit, and the work of the slip."""
        trial = state.force + state.stiffness * increment.displacement
        limit = state.friction * after.friction_load
        force = np.minimum(np.maximum(trial, -limit), limit)
        slip = (trial - force) / state.stiffness
        work = np.maximum(0.5 * (force + state.force) * slip, 0.0)
        if not np.ndim(state.force):
            force, work = float(force), float(work)
        return TangentialResponse(force, work), state._replace(force=force)


@attrs.frozen
class Slide(Stretch):
    """Slip in one direction under the force P, scaled, from ``start`` to ``stop``."""

    start: float
    stop: float
    change: float
    work: float
    ratio: float

    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return the change of velocity, from ratio · (V - 1), and the force."""
        return self.ratio * (contact.rate - 1.0), contact.force


@attrs.frozen(kw_only=True)
class SlidingForEver(PathTangentialLaw):
    """Slip in one direction from first touch to separation.

    With ``fails`` the path is NaN from x = 1 on; with ``at_once`` the law raises at first touch.
    """

    api_version: ClassVar[int] = 2
    fails: bool = False
    at_once: bool = False

    def path(
        self, velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
    ) -> Iterator[Stretch]:
        """Yield one stretch, or one to x = 1 and one of NaN."""
        if self.at_once:
            raise ArithmeticError("as it was asked to")
        start = 0.0
        for stop in (1.0, math.pi):
            fall = motion.scaled_mass * (1.0 - motion.scaled_at(stop).rate)
            change = -inertia * fall * (math.nan if self.fails and start else 1.0)
            work = fall * (velocity + 0.5 * change)
            yield Slide(start, stop, change, work, inertia * motion.scaled_mass)
            start = stop


@attrs.frozen(kw_only=True)
class DampedHertz(NormalLaw):
    """Hertz's force times 1 + damping times the rate over v1 (Hunt & Crossley 1975)."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "hertzian_pressure"})
    damping: ClassVar[float] = 0.2

    def start(self, scene: Scene) -> Scene:
        """Return the scene, the only state."""
        return scene

    def respond(self, state: Scene, approach: Real, rate: Real) -> tuple[NormalContact, Scene]:
        """Return the contact; the force is negative for rates below -v1/damping only."""
        inside = greater(approach, 0.0)
        radius = (state.pair.radius * inside) ** 0.5
        hertz = (4.0 / 3.0) * state.pair.effective_modulus * radius * inside
        force = hertz * (1.0 + self.damping * rate / state.normal_speed)
        return NormalContact(force, radius, approach), state


@attrs.frozen(kw_only=True)
class SoftHertz(DampedHertz):
    """A tenth of Hertz's force: contacts 2.5 times as deep and 1.6 times as wide."""

    def respond(self, state: Scene, approach: Real, rate: Real) -> tuple[NormalContact, Scene]:
        """Return the contact."""
        contact, state = super().respond(state, approach, 0.0 * rate)
        return contact._replace(force=0.1 * contact.force), state


@attrs.frozen(kw_only=True)
class StronglyDampedHertz(DampedHertz):
    """``DampedHertz`` with a normal restitution of 0.62."""

    damping: ClassVar[float] = 0.9


@attrs.frozen(kw_only=True)
class PullingHertz(NormalLaw):
    """Hertz's force less a twentieth of its maximum; the friction load is Hertz's force.

    The surfaces pull near first touch and near separation, so that the load impulse is not
    (1 + e) M_n v1.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "hertzian_pressure"})
    pull: ClassVar[float] = 0.05

    def start(self, scene: Scene) -> tuple[Real, Real, Real]:
        """Return stiffness in N/m^1.5, radius in m and pull in N."""
        pair = scene.pair
        stiffness = (4.0 / 3.0) * pair.effective_modulus * pair.radius**0.5
        return stiffness, pair.radius, self.pull * hertz_scales(scene).force

    def respond(
        self, state: tuple[Real, Real, Real], approach: Real, rate: Real
    ) -> tuple[NormalContact, Any]:
        """Return the contact."""
        stiffness, radius, pull = state
        touching = choose(approach > 0.0, 1.0, 0.0)
        inside = approach * touching
        load = stiffness * inside**1.5
        return NormalContact(
            load - pull * touching, (radius * inside) ** 0.5, approach, load
        ), state
