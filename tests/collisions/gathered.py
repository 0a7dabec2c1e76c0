"""Gatherings that several tests pose."""

import numpy as np

from contactlab import (
    Body,
    Gathering,
    HalfSpace,
    Material,
    RigidBody,
    Simulation,
    Sphere,
    Touch,
    create,
)  # fmt: skip

STEEL = Material(young_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
#: Mass and radius of a billiard ball.
RADIUS, MASS = 0.02625, 0.1406


def each(value, count):
    """Return one value for each of some contacts."""
    return value if isinstance(value, list) else [value] * count


def row(count, *, radius=0.01, mu=0.0, gaps=0.0, e=1.0, spin=0.0, speed=1.0):
    """Return a row of equal steel balls, the first of which moves."""
    ball = Sphere(radius, STEEL)
    first = Body(ball, velocity=[speed, 0, 0], spin=[0, 0, spin])
    bodies = [first, *(Body(ball) for _ in range(count - 1))]
    pairs = zip(each(gaps, count - 1), each(e, count - 1), strict=True)
    return Gathering(
        bodies,
        [
            Touch(k, k + 1, mu, normal=[1, 0, 0], gap=gap, restitution=one)
            for k, (gap, one) in enumerate(pairs)
        ],
    )


def half_space(modulus, kappa):
    """Return a half-space of an effective modulus and a ratio of stiffness, under a rigid body."""
    nu = (2.0 - 2.0 * kappa) / (2.0 - kappa)
    return HalfSpace(Material(young_modulus=modulus * (1.0 - nu * nu), poisson_ratio=nu))


def cushion(*, loaded=False, ratio=10.0, e=(1.0, 1.0), speed=1.0, force=None):
    """Return a rolling ball that meets a cushion; its cloth is ``ratio`` times as stiff."""
    rigid = Material(young_modulus=1e19, poisson_ratio=0.3, density=1.0)
    weight = 9.81 * MASS if loaded else 0.0
    ball = Body(
        Sphere(RADIUS, rigid, mass=MASS),
        velocity=speed * np.array([1.0, 1.0, 0.0]),
        spin=speed * np.array([-1.0, 1.0, 0.0]) / RADIUS,
        force=[0, 0, -weight] if force is None else force,
    )
    wall, cloth = half_space(6.5e6, 0.684), half_space(6.5e6 * ratio, 0.75)
    return Gathering(
        {"ball": ball},
        [
            Touch("ball", wall, 0.14, normal=[0, np.sqrt(0.84), 0.4], restitution=e[0]),
            Touch("ball", cloth, 0.212, normal=[0, 0, -1], restitution=e[1], loaded=loaded),
        ],
    )


def laws(springs=50, steps=200, normal="hertz"):
    """Return springs in even steps."""
    return Simulation(
        normal=normal,
        tangential=create("tangential.springs", springs=springs),
        integrator=create("integrator.symplectic", steps=steps),
    )


def three_balls():
    """Return a big ball that falls on two small ones, which touch each other and a plane."""
    big, small, plane = Sphere(0.02, STEEL), Sphere(0.01, STEEL), HalfSpace(STEEL)
    up = np.sqrt(0.03**2 - 0.01**2)
    bodies = {
        "left": Body(small, position=[-0.01, 0, 0]),
        "right": Body(small, position=[0.01, 0, 0]),
        "big": Body(big, velocity=[0, 0, -1], position=[0, 0, up]),
    }
    return Gathering(
        bodies,
        [
            Touch("big", "left", 0.3, normal=[-0.01, 0, -up]),
            Touch("big", "right", 0.3, normal=[0.01, 0, -up]),
            Touch("left", "right", 0.3, normal=[1, 0, 0]),
            Touch("left", plane, 0.3, normal=[0, 0, -1]),
            Touch("right", plane, 0.3, normal=[0, 0, -1]),
        ],
    )


def random_gathering(rng, *, most=8):
    """Return bodies of any shape at up to ``most`` contacts with gaps, friction and loss."""
    contacts = int(rng.integers(2, most + 1))
    count = int(rng.integers(2, contacts + 2))
    bodies = []
    for _ in range(count):
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        body = RigidBody(
            mass=rng.uniform(0.1, 3.0),
            principal=rng.uniform(0.7, 1.3, 3) * 1e-3,
            axes=turn,
            material=STEEL,
            curvature_radius=rng.uniform(0.005, 0.05),
        )
        velocity, spin = rng.normal(size=3), 20.0 * rng.normal(size=3)
        bodies.append(Body(body, velocity=velocity, spin=spin))
    touches = []
    plane = HalfSpace(STEEL)
    for k in range(contacts):
        first = k % count
        second = int(rng.integers(0, count))
        other = plane if second == first else second
        arms = rng.normal(size=(2, 3)) * 0.03
        more = {} if other is plane else {"target_contact": arms[1]}
        touches.append(
            Touch(
                first, other, rng.uniform(0.0, 1.0), normal=rng.normal(size=3), contact=arms[0],
                gap=rng.choice([0.0, rng.uniform(0.0, 1e-4)]), **more,
            )
        )  # fmt: skip
    return Gathering(bodies, touches)
