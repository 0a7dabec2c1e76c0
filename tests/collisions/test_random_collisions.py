"""What any collision of two bodies in space keeps, on random batches of unlike bodies."""

import attrs
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactlab import Encounter, HalfSpace, Material, Simulation, Sphere, collide

#: Encounters of a batch.
COUNT = 20
#: Largest radius, in m.
RADIUS = 0.1
STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
#: Rounding of sums of a few products, over the largest of them.
ROUNDING = 1e-14
#: Two evaluations of the same impact may lie on different sides of a seam of the table.
SAME = 1e-8

powers = st.floats(-3.0, 3.0).map(lambda power: 10.0**power)
seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


def spheres(rng, *, alike):
    """Unlike spheres, or as many of one kind."""
    size = None if alike else COUNT
    material = Material(
        young_modulus=10.0 ** rng.uniform(9.0, 11.6, size),
        poisson_ratio=rng.uniform(-0.5, 0.5, size),
        density=rng.uniform(500.0, 2e4, size),
    )
    radius, gyration = 10.0 ** rng.uniform(-4.0, -1.0, size), rng.uniform(0.5, 1.0, size)
    return Sphere(radius, material, gyration_ratio=gyration)


@st.composite
def encounters(draw, *, target=None):
    """Random batches; normals are turned so that the bodies approach, some of them hardly."""
    rng = draw(seeds)
    fast, turning = draw(powers), draw(st.one_of(st.just(0.0), powers))
    normal = rng.normal(size=(COUNT, 3))
    if draw(st.booleans()):
        normal = np.eye(3)[rng.integers(0, 3, COUNT)]
    velocity, other = fast * rng.normal(size=(2, COUNT, 3))
    if draw(st.booleans()):
        velocity = other + normal * (velocity - other)  # head-on but for the axes
    approach = ((velocity - other) * normal).sum(axis=1)
    normal = normal * np.sign(approach)[:, None]
    struck = spheres(rng, alike=draw(st.booleans())) if target is None else target
    spins = turning * rng.normal(size=(2, COUNT, 3)) * rng.integers(0, 2, (2, COUNT, 1))
    return Encounter(
        spheres(rng, alike=draw(st.booleans())),
        struck,
        draw(st.sampled_from((0.0, 1e-3, 0.1, 1.0))) * rng.uniform(0.0, 1.5, COUNT),
        normal=normal,
        velocity=velocity,
        spin=spins[0],
        target_velocity=other,
        target_spin=spins[1] if isinstance(struck, Sphere) else np.zeros(3),
    )


def close(one, other, scale, room):
    """Whether vectors agree, an encounter at a time."""
    gap = np.abs(np.asarray(one) - other).max(axis=-1)
    return bool(np.all(gap <= room * scale))


def column(number):
    return np.asarray(number)[..., None]


def inertia(sphere):
    return column(sphere.mass * sphere.gyration_ratio**2 * sphere.radius**2)


def unit(vector):
    return vector / np.linalg.norm(vector, axis=-1, keepdims=True)


def speeds(encounter):
    """The largest speed in each encounter, of centres and of rims."""
    found = np.linalg.norm(encounter.velocity, axis=-1)
    found = found + np.linalg.norm(encounter.target_velocity, axis=-1)
    for body, spin in (
        (encounter.body, encounter.spin),
        (encounter.target, encounter.target_spin),
    ):
        if isinstance(body, Sphere):
            found = found + body.radius * np.linalg.norm(spin, axis=-1)
    return found


def states(encounter, made):
    """Mass, inertia, velocity and spin of both bodies, before and after."""
    one, other = encounter.body, encounter.target
    return (
        (column(one.mass), inertia(one), encounter.velocity, encounter.spin),
        (column(other.mass), inertia(other), encounter.target_velocity, encounter.target_spin),
        (column(one.mass), inertia(one), made.velocity, made.spin),
        (column(other.mass), inertia(other), made.target_velocity, made.target_spin),
    )


@given(encounters())
@pytest.mark.slow
def test_momentum(met):
    made = collide(met)
    before = column(met.body.mass) * met.velocity + column(met.target.mass) * (met.target_velocity)
    after = column(met.body.mass) * made.velocity + column(met.target.mass) * (made.target_velocity)
    heavy = np.maximum(met.body.mass, met.target.mass)
    assert close(after, before, heavy * speeds(met), ROUNDING)
    given_to_it = column(met.body.mass) * (made.velocity - met.velocity)
    assert close(made.impulse, given_to_it, heavy * speeds(met), ROUNDING)


@given(encounters(), seeds)
def test_angular_momentum_about_any_point(met, rng):
    point = 3.0 * RADIUS * rng.normal(size=3)
    made = collide(met)
    radius = column(met.body.radius), column(met.target.radius)
    arms = -point, unit(met.normal) * (radius[0] + radius[1]) - point
    totals, scale = [], 0.0
    for first in (0, 2):
        total = 0.0
        for arm, (mass, moment, velocity, spin) in zip(
            arms, states(met, made)[first : first + 2], strict=True
        ):
            total = total + mass * np.cross(arm, velocity) + moment * spin
            reach = (RADIUS + np.linalg.norm(arm, axis=-1)) * mass[..., 0]
            scale = scale + reach * speeds(met)
        totals.append(total)
    assert close(*totals, scale, ROUNDING)


@given(encounters(target=HalfSpace(STEEL)))
def test_a_half_space_goes_on_and_takes_no_moment_about_the_contact(met):
    made = collide(met)
    assert np.array_equal(made.target_velocity, met.target_velocity)
    arm = -unit(met.normal) * column(met.body.radius)
    mass, moment = column(met.body.mass), inertia(met.body)
    before = mass * np.cross(arm, met.velocity) + moment * met.spin
    after = mass * np.cross(arm, made.velocity) + moment * made.spin
    scale = met.body.mass * met.body.radius * speeds(met)
    assert close(after, before, scale, ROUNDING)


@given(encounters())
def test_energy_loss_is_friction_work(met):
    made = collide(met)
    energies = [
        0.5 * (mass * velocity**2 + moment * spin**2).sum(axis=-1)
        for mass, moment, velocity, spin in states(met, made)
    ]
    before, after = energies[0] + energies[1], energies[2] + energies[3]
    assert np.all(np.abs(before - after - made.friction_work) <= ROUNDING * before)
    assert np.all(made.friction_work >= 0.0)
    assert np.all(np.abs(made.energy.imbalance) <= ROUNDING * made.energy.start)


@given(encounters())
def test_spin_about_the_normal_passes_through(met):
    made, normal = collide(met), unit(met.normal)
    for body, before, after in (
        (met.body, met.spin, made.spin),
        (met.target, met.target_spin, made.target_spin),
    ):
        gap = ((after - before) * normal).sum(axis=-1)
        assert np.all(np.abs(gap) <= ROUNDING * speeds(met) / body.radius)


def approach_and_slip(velocity, spin, target_velocity, target_spin, met):
    """Rate of approach, and slip vector, from the contact points themselves."""
    normal = unit(met.normal)
    mine = velocity + column(met.body.radius) * np.cross(spin, normal)
    other = target_velocity - column(met.target.radius) * np.cross(target_spin, normal)
    rate = ((mine - other) * normal).sum(axis=-1)
    return rate, mine - other - rate[:, None] * normal, mine, other


@given(encounters())
def test_contact_points_part_as_the_scene_says(met):
    made = collide(met)
    before, slip, _, _ = approach_and_slip(
        met.velocity, met.spin, met.target_velocity, met.target_spin, met
    )
    after, slip_after, mine, other = approach_and_slip(
        made.velocity, made.spin, made.target_velocity, made.target_spin, met
    )
    scale = speeds(met)
    assert np.all(np.abs(after + before) <= ROUNDING * scale)
    assert close(made.contact_velocity, mine, scale, ROUNDING)
    assert close(made.target_contact_velocity, other, scale, ROUNDING)
    size = np.linalg.norm(slip, axis=-1)
    assert np.allclose(met.scene.slip_velocity, size, rtol=0.0, atol=ROUNDING * scale.max())
    along = slip / (size + (size == 0.0))[:, None]
    change = along * column(made.slip_velocity_change)
    assert close(slip_after - slip, change, scale, 1e-12)


@given(encounters(), seeds)
def test_rotation_of_the_frame(met, rng):
    turned, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turned[:, 0] *= np.sign(np.linalg.det(turned))  # a mirror would turn spins over
    names = ("normal", "velocity", "spin", "target_velocity", "target_spin")
    again = attrs.evolve(met, **{name: getattr(met, name) @ turned.T for name in names})
    one, other = collide(met), collide(again)
    compare(met, one, other, lambda vector: vector @ turned.T)


@given(encounters(), seeds)
def test_galilean_shift(met, rng):
    shift = speeds(met).max() * rng.normal(size=3)
    again = attrs.evolve(
        met, velocity=met.velocity + shift, target_velocity=met.target_velocity + shift
    )
    one, other = collide(met), collide(again)
    scale = speeds(again)
    for name in ("velocity", "target_velocity"):
        assert close(getattr(one, name) + shift, getattr(other, name), scale, SAME)
    compare(met, one, other, lambda spin: spin, names=("spin", "target_spin"), scale=scale)


@given(encounters())
def test_exchange_of_the_bodies(met):
    again = Encounter(
        met.target,
        met.body,
        met.friction_coefficient,
        normal=-met.normal,
        velocity=met.target_velocity,
        spin=met.target_spin,
        target_velocity=met.velocity,
        target_spin=met.spin,
    )
    one, other = collide(met), collide(again)
    scale = speeds(met)
    assert close(one.velocity, other.target_velocity, scale, SAME)
    assert close(one.target_velocity, other.velocity, scale, SAME)
    assert close(one.spin, other.target_spin, scale / met.body.radius, SAME)
    assert close(one.target_spin, other.spin, scale / met.target.radius, SAME)


def compare(met, one, other, changed, *, names=None, scale=None):
    """Hold that two collisions of the same bodies agree, the first after ``changed``."""
    scale = speeds(met) if scale is None else scale
    for name in names or ("velocity", "target_velocity", "spin", "target_spin"):
        radius = met.body.radius if name == "spin" else met.target.radius
        size = scale / radius if "spin" in name else scale
        assert close(changed(getattr(one, name)), getattr(other, name), size, SAME), name


@pytest.mark.parametrize("laws", [{}, {"tangential": "coulomb"}])
def test_any_law_keeps_momentum_and_books(laws):
    rng = np.random.default_rng(5)
    one = Sphere(rng.uniform(0.01, 0.02, 20), STEEL)
    v, w = rng.normal(size=(20, 3)), 50.0 * rng.normal(size=(20, 3))
    met = Encounter(one, Sphere(0.01, STEEL), 0.3, normal=v, velocity=v, spin=w, target_spin=-w)
    made = collide(met, Simulation(**laws)).check()
    rows = states(met, made)
    before, after = (sum(m * v for m, _, v, _ in rows[k : k + 2]) for k in (0, 2))
    assert close(after, before, met.body.mass * speeds(met), ROUNDING)
    energy = [sum(0.5 * (m * v**2 + i * w**2).sum(axis=-1) for m, i, v, w in rows[k : k + 2])
              for k in (0, 2)]  # fmt: skip
    assert np.allclose(energy[0] - energy[1], made.friction_work, rtol=0.0, atol=1e-6 * energy[0])
