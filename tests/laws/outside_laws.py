"""Laws as an outsider would write them, from the contracts alone: 15 to 80 lines each."""

from typing import ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    Increment,
    Integrator,
    NormalContact,
    NormalLaw,
    Sample,
    Status,
    SteppedTangentialLaw,
    TangentialMotion,
    TangentialResponse,
)
from contactlab.numeric.checks import NON_NEGATIVE, POSITIVE, Rule, count, quantity
from tests.testing.fresh_sound import HardSphere

RESTITUTION = Rule(lambda value: (value > 0.0) & (value <= 1.0), "must lie in (0, 1]")


@attrs.frozen(kw_only=True)
class Tsuji(NormalLaw):
    """Hertz with damping that gives one restitution at all speeds, ended as force vanishes.

    P = k z^1.5 + 2 beta sqrt(1.25 M k) z^¼ z', Tsuji, Tanaka & Ishida (1992).
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius", "hertzian_pressure"})

    damping: float = quantity("1", rule=NON_NEGATIVE, default=0.07)

    def start(self, scene):
        pair = scene.pair
        stiffness = (4.0 / 3.0) * pair.effective_modulus * pair.radius**0.5
        return stiffness, pair.normal_mass, pair.radius

    def respond(self, state, approach, rate):
        stiffness, mass, radius = state
        inside = approach * (approach > 0.0)
        dashpot = 2.0 * self.damping * (1.25 * mass * stiffness) ** 0.5 * inside**0.25
        force = stiffness * inside**1.5 + dashpot * rate
        # Contact has ended where the force would pull.
        touching = np.logical_not((inside <= 0.0) | (force <= 0.0))
        overlap = np.where(touching, approach, -abs(approach))
        force, radius = force * touching, (radius * inside) ** 0.5 * touching
        if np.ndim(force) == 0:
            return NormalContact(float(force), float(radius), float(overlap)), state
        return NormalContact(force, radius, overlap), state

    @staticmethod
    def restitution(damping):
        """e(beta) of a linear dashpot ended as the force vanishes (Schwager & Pöschel 2007)."""
        root = np.sqrt(1.0 - damping**2)
        angle = np.arctan2(2.0 * damping * root, 1.0 - 2.0 * damping**2)
        return np.exp(-(damping / root) * (np.pi - angle))


class Flat(NamedTuple):
    """Loading stiffness k1 and unloading k2, pair radius, greatest approach so far."""

    loading: object
    unloading: object
    radius: object
    deepest: object


@attrs.frozen(kw_only=True)
class Plastic(NormalLaw):
    """Walton & Braun (1986): linear loading, stiffer unloading to a remaining indentation."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius", "hertzian_pressure"})

    restitution: float = quantity("1", rule=RESTITUTION, default=0.8)
    stiffness: float = quantity("N/m", rule=POSITIVE, default=1e7)

    def start(self, scene):
        stiffness = self.stiffness
        return Flat(stiffness, stiffness / self.restitution**2, scene.pair.radius, 0.0)

    def respond(self, state, approach, rate):
        deepest = np.maximum(state.deepest, approach * 1.0)
        lasting = deepest * (1.0 - self.restitution**2)
        left = approach - lasting
        force = np.minimum(state.loading * approach, state.unloading * left)
        touching = np.logical_not(force <= 0.0)
        radius = np.sqrt(state.radius * np.maximum(approach, 0.0)) * touching
        overlap = np.where(left > 0.0, approach, left)
        if np.ndim(approach) == 0:
            contact = NormalContact(float(force * touching), float(radius), float(overlap))
        else:
            contact = NormalContact(force * touching, radius, overlap)
        return contact, state._replace(deepest=deepest)


@attrs.frozen(kw_only=True)
class Adhesive(NormalLaw):
    """Hertz's force less a constant pull while the surfaces touch, to a distance behind touch.

    The friction limit is taken of the Hertz part, which is never negative.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius", "hertzian_pressure"})

    pull: float = quantity("N", rule=NON_NEGATIVE, default=1.0)
    reach: float = quantity("m", rule=NON_NEGATIVE, default=1e-8)

    def start(self, scene):
        pair = scene.pair
        return (4.0 / 3.0) * pair.effective_modulus * pair.radius**0.5, pair.radius

    def respond(self, state, approach, rate):
        stiffness, radius = state
        depth = approach + self.reach
        inside = depth * (depth > 0.0)
        load = stiffness * inside**1.5
        force = load - self.pull * (depth > 0.0)
        return NormalContact(force, (radius * inside) ** 0.5, depth, load), state


@attrs.frozen(kw_only=True)
class LinearDashpot(NormalLaw):
    """P = k z + c z', ended as the force vanishes; no radius."""

    api_version: ClassVar[int] = 2

    stiffness: float = quantity("N/m", rule=POSITIVE, default=1e5)
    damping: float = quantity("1", rule=NON_NEGATIVE, default=0.1)

    def start(self, scene):
        return 2.0 * self.damping * (self.stiffness * scene.pair.normal_mass) ** 0.5

    def respond(self, state, approach, rate):
        force = self.stiffness * approach + state * rate
        touching = np.logical_not(force <= 0.0)
        overlap = np.where(touching, 1.0, -1.0) * np.maximum(abs(approach), 1e-300)
        force = force * touching
        if np.ndim(force) == 0:
            return NormalContact(float(force), 0.0, float(overlap)), state
        return NormalContact(force, 0.0 * force, overlap), state


class Held(NamedTuple):
    """Twice G*, friction coefficient, spring displacement and force."""

    modulus: object
    friction: object
    stretch: object
    force: object


@attrs.frozen(kw_only=True)
class RescaledSpring(SteppedTangentialLaw):
    """A spring of stiffness (4/3) G* b whose stretch shrinks with the contact radius."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset] = frozenset({"radius"})
    expected_failures: ClassVar[dict] = {
        "normal_load_alone": "the stretch stays as the contact grows, and so the force grows",
        "closed_cycles": "the energy of a stretch that stays grows with the stiffness",
        "random_paths": "the energy of a stretch that stays grows with the stiffness",
        "partial_unloading": "sheared, then pressed more, the stiffer spring returns more energy",
        "books": "the energy books leave out what the changing stiffness adds or removes",
        "impact_books": "the energy books leave out what the changing stiffness adds or removes",
    }

    def start(self, scene, normal):
        nothing = np.zeros(scene.shape) if scene.shape else 0.0
        modulus = (4.0 / 3.0) * scene.pair.effective_shear_modulus
        return Held(modulus, scene.friction_coefficient, nothing, nothing)

    def advance(self, state, increment, before, after):
        wide = before.radius + (before.radius == 0.0)
        shrunk = np.where(after.radius < before.radius, after.radius / wide, 1.0)
        trial = state.stretch * shrunk + increment.displacement
        stiffness = state.modulus * after.radius
        limit = state.friction * after.friction_load
        force = np.clip(stiffness * trial, -limit, limit)
        # Where the stiffness is zero the spring has let go: 0/0 would be taken for slip.
        stretch = np.where(stiffness > 0.0, force / (stiffness + (stiffness == 0.0)), 0.0)
        work = np.maximum(0.5 * (force + state.force) * (trial - stretch), 0.0)
        if np.ndim(state.force) == 0:
            force, stretch, work = float(force), float(stretch), float(work)
        return TangentialResponse(force, work), Held(*state[:2], stretch, force)

    def stiffness(self, scene, normal):
        return (4.0 / 3.0) * scene.pair.effective_shear_modulus * normal.maximum_radius


@attrs.frozen(kw_only=True)
class Walton(HardSphere):
    """Walton's law of hard spheres: slip, or a constant restitution beta of the slip velocity."""

    beta: float = quantity("1", rule=RESTITUTION, default=0.4)

    def restitution(self, scene):
        return self.beta


@attrs.frozen(kw_only=True)
class Heun(Integrator):
    """The Runge-Kutta method of Heun over even steps: two stages, the first one thrown away."""

    api_version: ClassVar[int] = 2
    resolution: ClassVar[str] = "steps"
    needs: ClassVar[frozenset[type]] = frozenset({SteppedTangentialLaw})
    expected_failures: ClassVar[dict] = {
        "faults_named": "what a law raises it leaves to the simulation, which knows no culprit",
    }

    steps: int = count(default=400)

    def integrate(self, scene, normal, tangential, observer=None):
        law, mass, shape = tangential, scene.pair.tangential_mass, scene.shape
        state = law.start(scene, normal)
        velocity = scene.slip_velocity + np.zeros(shape)
        force, work, change = 0.0 * velocity, 0.0 * velocity, 0.0 * velocity
        before, settled = self._at(normal, 0.0), np.ones(shape, dtype=bool)
        for step in range(self.steps):
            after = self._at(normal, (step + 1.0) / self.steps)
            kick = after.time - before.time
            load = (after.load_impulse - before.load_impulse) / kick
            ahead = force
            for trial in (True, False):
                moved = kick * velocity
                if not trial:
                    moved = kick * (velocity - 0.25 * (force + ahead) * kick / mass)
                given = Increment(_plain(moved), _plain(velocity), _plain(load), _plain(kick))
                answer, new = law.advance(state, given, before.contact, after.contact)
                ahead, settled = answer.force, settled & answer.settled
            slowed = 0.5 * (force + ahead) * kick / mass
            change, work = change - slowed, work + answer.friction_work
            velocity = scene.slip_velocity + change
            force, state, before = ahead, new, after
            if observer is not None:
                observer(
                    Sample(
                        time=after.time,
                        approach=after.approach,
                        normal_velocity=after.rate,
                        contact=after.contact,
                        slip_velocity=velocity,
                        tangential_force=force,
                        fields=lambda: law.fields(state),  # noqa: B023
                    )
                )
        status = np.where(settled, Status.SUCCESS, Status.UNSETTLED).astype(object)
        return TangentialMotion(
            slip_velocity_change=_plain(change),
            friction_work=_plain(work),
            status=status if shape else status.item(),
            detail="" if settled.all() else "In some step the friction law found no answer.",
        )

    @staticmethod
    def _at(normal, fraction):
        found = normal.at(normal.phase(np.asarray(fraction)))
        contact = NormalContact(*(_plain(entry) for entry in found.contact))
        return found._replace(contact=contact)


def _plain(value):
    return float(value) if np.ndim(value) == 0 else value
