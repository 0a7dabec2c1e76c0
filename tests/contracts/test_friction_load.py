"""The friction load of a law that pulls and leaves it to the core: max(P, 0), with its kink."""

import math
from typing import ClassVar

import attrs
import numpy as np
import pytest
from scipy.integrate import quad

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.contracts import NormalContact, NormalLaw, TangentialResponse
from contactlab.solve.normal_motion import normal_motion
from contactlab.solve.solved_motion import ACCURACY
from tests.laws.outside_laws import Adhesive, Heun, RescaledSpring
from tests.longer import longer

STEEL = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)


def scene(slip=2.0, *, speed=1.0):
    """Return a steel sphere of 10 mm on steel."""
    return Scene(Sphere(0.005, STEEL), HalfSpace(STEEL), 0.2, speed, slip)


@attrs.frozen(kw_only=True)
class Pulling(Adhesive):
    """Hertz's force less a pull; the friction load is left to the core."""

    def respond(self, state, approach, rate):
        contact, state = super().respond(state, approach, rate)
        return contact._replace(friction_load=None), state


@attrs.frozen(kw_only=True)
class Cohesive(NormalLaw):
    """Luding's elastic-plastic-cohesive law: k1 z, then k2 (z - z0), at least -kc z.

    z0 = (1 - k1/k2) z_max, in units of a stiffness that gives about Hertz's duration.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius"})

    loading: float = 1e7
    unloading: float = 3e7
    cohesion: float = 5e6
    own_load: bool = False

    def start(self, scene):
        return 0.0, scene.pair.radius

    def respond(self, state, approach, rate):
        deepest, radius = np.maximum(state[0], approach), state[1]
        inside = approach * (approach > 0.0)
        left = (1.0 - self.loading / self.unloading) * deepest
        upper = np.minimum(self.loading * inside, self.unloading * (approach - left))
        force = np.maximum(upper, -self.cohesion * inside) * (approach > 0.0)
        load = force * (force > 0.0) if self.own_load else None
        if np.ndim(approach) == 0:
            force, deepest = float(force), float(deepest)
            load = None if load is None else float(load)
        contact = NormalContact(force, (radius * inside) ** 0.5, approach, load)
        return contact, (deepest, radius)


@attrs.frozen(kw_only=True)
class MeanSpring(RescaledSpring):
    """A spring of constant stiffness, cut at mu times the mean friction load of the step."""

    def advance(self, state, increment, before, after):
        modulus, friction, stretch, before_force = state
        stiffness = 1e-5 * modulus
        trial = stiffness * (stretch + increment.displacement)
        limit = friction * increment.friction_load
        force = np.clip(trial, -limit, limit)
        work = 0.5 * (force + before_force) * (trial - force) / stiffness
        work = float(np.maximum(work, 0.0))
        force, stretch = float(force), float(force / stiffness)
        return TangentialResponse(force, work), state._replace(stretch=stretch, force=force)


def by_hand(law, mass, speed):
    """Duration, final rate and load impulse of ``Cohesive``: a sine, a cosine, and a hyperbola."""
    first, second, third = (math.sqrt(k / mass) for k in (law.loading, law.unloading, law.cohesion))
    deepest = speed / first
    left = (1.0 - law.loading / law.unloading) * deepest
    swing = deepest - left
    turn = law.unloading * left / (law.unloading + law.cohesion)  # where the pull is greatest
    angle = math.acos((turn - left) / swing)
    rate = swing * second * math.sin(angle)
    # turn cosh - (rate/third) sinh = 0 ends it.
    last = math.atanh(turn * third / rate)
    duration = 0.5 * math.pi / first + angle / second + last / third
    final = math.sqrt(rate**2 - (third * turn) ** 2)
    return duration, -final, mass * (speed + swing * second)


@pytest.mark.parametrize("own_load", [False, *longer(True)])
@pytest.mark.parametrize(
    ("unloading", "cohesion"),
    [
        (1.5e7, 1e7),
        *(
            pytest.param(*pair, marks=pytest.mark.slow)
            for pair in ((3e7, 1e6), (3e7, 5e6), (5e7, 1e6), (1e8, 5e5))
        ),
    ],
)
def test_cohesive_law_keeps_the_declared_error(unloading, cohesion, own_load):
    """Its load impulse was off by 28 times what is declared, its rate by as much."""
    law = Cohesive(unloading=unloading, cohesion=cohesion, own_load=own_load)
    speeds = np.array([0.03, 1.0, 4.0])
    together = normal_motion(law, scene(speed=speeds))
    for index, speed in enumerate(speeds.tolist()):
        alone = normal_motion(law, scene(speed=speed))
        duration, rate, impulse = by_hand(law, alone.scene.pair.normal_mass, speed)
        assert alone.accuracy == ACCURACY
        assert alone.total_load_impulse == pytest.approx(impulse, rel=0.1 * ACCURACY)
        assert alone.final_rate == pytest.approx(rate, rel=ACCURACY)
        assert alone.duration == pytest.approx(duration, rel=ACCURACY)
        array = normal_motion(law, scene(speed=np.array([speed])))
        for name in ("duration", "final_rate", "total_load_impulse", "maximum_force"):
            found = np.broadcast_to(getattr(together, name), 3)[index]
            assert found == pytest.approx(np.ravel(getattr(array, name))[0], rel=1e-9), name
            # one impact and many cross the kink in steps of their own: 1.2e-8 between them
            assert found == pytest.approx(getattr(alone, name), rel=0.2 * ACCURACY), name


CASES = [(20.0, 1e-6), (200.0, 2e-7), (500.0, 2e-6), (1.0, 1e-8), (600.0, 3e-6)]


@pytest.mark.parametrize("law", [*(Pulling(pull=p, reach=r) for p, r in CASES), Cohesive(),
                                 Cohesive(unloading=1e8, cohesion=5e5, own_load=True)])  # fmt: skip
def test_friction_load_is_nowhere_negative(law):
    """It went down to -1.7 N: a polynomial ran over the kink of max(P, 0)."""
    motion = normal_motion(law, scene())
    for count in (50, 400, 20_000):
        sample = motion.at(np.linspace(0.0, np.pi, count + 1))
        assert sample.contact.friction_load.min() >= 0.0
        assert np.diff(sample.load_impulse).min() >= -1e-15 * motion.total_load_impulse
    assert sample.contact.force.min() < 0.0, "the contact never pulls: nothing is tested"
    off = np.abs(sample.contact.friction_load - np.maximum(sample.contact.force, 0.0)).max()
    assert off <= 1e-6 * motion.maximum_force


@pytest.mark.parametrize(("pull", "reach"), CASES)
def test_load_impulse_of_a_pulling_law_is_its_integral(pull, reach):
    """By quadrature over the approach: both halves are alike, as energy is kept."""
    law, given = Pulling(pull=pull, reach=reach), scene()
    pair, speed = given.pair, given.normal_speed
    stiffness = (4.0 / 3.0) * pair.effective_modulus * pair.radius**0.5

    def energy(depth):
        spring = 0.4 * stiffness * (depth**2.5 - reach**2.5) - pull * (depth - reach)
        return speed**2 - 2.0 * spring / pair.normal_mass

    low, high = reach, 1e-3
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if energy(middle) > 0.0 else (low, middle)
    zero = (pull / stiffness) ** (2.0 / 3.0)  # where the force changes its sign
    # Inwards from touch or from there, outwards to there: m dv is the impulse of the force alone.
    inward = energy(max(zero, reach)) ** 0.5
    outward = energy(zero) ** 0.5
    expected = pair.normal_mass * (inward + outward)
    motion = normal_motion(law, given)
    assert motion.total_load_impulse == pytest.approx(expected, rel=1e-8)

    def slowness(share):  # depth = high - share², which takes the root at the turn away
        depth = high - share * share
        return 2.0 * share / energy(depth) ** 0.5 if share else 2.0 * (
            0.5 * pair.normal_mass / (stiffness * high**1.5 - pull)
        ) ** 0.5  # fmt: skip

    ways = [
        quad(slowness, 0.0, (high - end) ** 0.5, epsabs=0.0, epsrel=1e-10, limit=200)[0]
        for end in (reach, 0.0)
    ]
    assert motion.duration == pytest.approx(sum(ways), rel=1e-7)


@pytest.mark.parametrize("pull", [20.0, 500.0])
@pytest.mark.parametrize(
    ("law", "integrator"),
    [
        (MeanSpring(), "symplectic"),
        (MeanSpring(), "paper"),
        (MeanSpring(), Heun(steps=100)),
        (RescaledSpring(), "symplectic"),
        ("springs", "paper"),
    ],
)
@pytest.mark.parametrize("slip", [0.05, 2.0])
def test_both_directions_are_alike(law, integrator, pull, slip):
    """clip(-mu P, mu P) is one-sided where P < 0: psi2 of 2 and -2 m/s differed by 2e-3."""
    normal = Pulling(pull=pull, reach=2e-6)
    simulation = Simulation(normal=normal, tangential=law, integrator=integrator)
    forth, back = (simulation.run(scene(sign * slip)).check() for sign in (1.0, -1.0))
    assert forth.psi2 == -back.psi2
    assert forth.motion.friction_work == back.motion.friction_work


@pytest.mark.parametrize("integrator", ["symplectic", "paper"])
@pytest.mark.parametrize("steps", [20, 300])
@pytest.mark.parametrize("normal", ["hertz", "tsuji", Pulling(pull=500.0, reach=2e-6), Cohesive()])
def test_no_step_is_given_a_negative_load(normal, integrator, steps):
    seen = []

    class Watched(RescaledSpring):
        def advance(self, state, increment, before, after):
            seen.append((increment.friction_load, before.friction_load, after.friction_load))
            return super().advance(state, increment, before, after)

    march = contactlab.create(f"integrator.{integrator}", steps=steps)
    Simulation(normal=normal, tangential=Watched(), integrator=march).run(scene()).check()
    assert len(seen) >= steps
    assert np.min(seen) >= 0.0
