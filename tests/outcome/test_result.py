"""What a result says, against the mechanics of rigid bodies and of Hertz, worked out by hand."""

import math

import attrs
import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, Sphere, collide, create
from contactlab.outcome.tables import sections
from tests.laws.normal_laws import Damped, LinearSpring
from tests.solve.any_scene import EXACT, OFF_CENTRE

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
RADIUS, FRICTION, SPEED, TANGENTIAL, SPIN = 0.01, 0.1, 2.0, 3.0, 40.0
KAPPA = 1.4 / 1.7
NUMBERS = (
    "psi1", "psi2", "psi_change", "normal_velocity", "couple", "rebound_slip_velocity",
    "rebound_normal_velocity", "rebound_tangential_velocity", "rebound_speed", "rebound_spin",
    "rebound_normal_spin", "target_rebound_spin", "normal_restitution", "tangential_restitution",
    "beta0", "incidence_angle", "rebound_angle", "local_rebound_angle",
)  # fmt: skip


def sliding(side=1.0, **laws):
    """A solid steel ball that slips from start to end: v_x falls from 3.4 to 2.0 m/s."""
    ball = Sphere(RADIUS, STEEL)
    scene = Scene(ball, HalfSpace(STEEL), FRICTION, SPEED, side * TANGENTIAL, side * SPIN)
    simulation = Simulation(tangential="coulomb", integrator="symplectic", **laws)
    return ball, simulation.run(scene).check()


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_velocities_after_slip_throughout(side):
    """Friction takes mu (1 + e) v1 from v, 5/2 of it over R from omega, 7/2 of it from v_x."""
    _, result = sliding(side)
    taken = FRICTION * 2.0 * SPEED
    assert result.rebound_normal_velocity == pytest.approx(-SPEED, rel=1e-14)
    assert side * result.rebound_tangential_velocity == pytest.approx(TANGENTIAL - taken)
    assert side * result.rebound_spin == pytest.approx(SPIN - 2.5 * taken / RADIUS)
    assert side * result.rebound_slip_velocity == pytest.approx(3.4 - 3.5 * taken)
    assert side * result.psi1 == pytest.approx(KAPPA * 3.4 / (FRICTION * SPEED))
    assert side * result.psi2 == pytest.approx(KAPPA * 2.0 / (FRICTION * SPEED))
    assert side * result.psi_change == pytest.approx(-KAPPA * 1.4 / (FRICTION * SPEED))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_angles_and_restitutions_after_slip_throughout(side):
    """Angles are those of paths with the normal, positive where the velocity is."""
    _, result = sliding(side)
    assert side * result.incidence_angle == pytest.approx(math.atan(1.5))
    assert side * result.rebound_angle == pytest.approx(math.atan(1.3))
    assert side * result.local_rebound_angle == pytest.approx(math.pi / 4.0)
    assert result.normal_restitution == pytest.approx(1.0)
    assert result.tangential_restitution == pytest.approx(2.6 / 3.0)
    assert result.beta0 == pytest.approx(-2.0 / 3.4)


def test_a_dissipative_rebound_leans_towards_the_surface():
    """Over the rate of separation, e v1, and less friction for a smaller normal impulse."""
    _, result = sliding(normal=Damped(damping=0.3))
    e = result.normal_restitution
    assert 0.5 < e < 0.9
    taken = FRICTION * (1.0 + e) * SPEED
    after = (3.4 - 3.5 * taken) / (e * SPEED), (TANGENTIAL - taken) / (e * SPEED)
    assert result.local_rebound_angle == pytest.approx(math.atan(after[0]), rel=1e-6)
    assert result.rebound_angle == pytest.approx(math.atan(after[1]), rel=1e-6)


def test_the_books_are_those_of_the_free_ball():
    """½ m v² + ½ I omega² before less after, over all its motion, is the friction work."""
    ball, result = sliding()
    inertia = 0.4 * ball.mass * RADIUS**2

    def kinetic(normal, tangential, spin):
        return 0.5 * ball.mass * (normal**2 + tangential**2) + 0.5 * inertia * spin**2

    lost = kinetic(SPEED, TANGENTIAL, SPIN) - kinetic(
        result.rebound_normal_velocity, result.rebound_tangential_velocity, result.rebound_spin
    )
    books = result.energy
    assert books.friction_work == pytest.approx(lost, rel=1e-12)
    # At the contact counts what a force there can change: 2/7 of the mass in slip.
    assert books.start == pytest.approx(0.5 * ball.mass * (SPEED**2 + 3.4**2 / 3.5), rel=1e-14)
    assert books.end == pytest.approx(0.5 * ball.mass * (SPEED**2 + 2.0**2 / 3.5), rel=1e-13)
    assert books.start - books.end == pytest.approx(lost, rel=1e-12)
    assert books.normal_loss == 0.0
    written = books.to_dict()
    assert written["relative_imbalance"] == pytest.approx(0.0, abs=1e-13)
    assert written["start"] == books.start


def test_the_greatest_force_and_compression_of_a_hertz_impact():
    """½ m v1² = 8/15 E* sqrt(R) z^2.5 at greatest compression, where P = 4/3 E* sqrt(R) z^1.5."""
    ball, result = sliding()
    modulus = 208e9 / (2.0 * (1.0 - 0.3**2))
    deepest = (0.5 * ball.mass * SPEED**2 * 15.0 / (8.0 * modulus * RADIUS**0.5)) ** 0.4
    assert result.motion.maximum_approach == pytest.approx(deepest, rel=1e-12)
    force = 4.0 / 3.0 * modulus * RADIUS**0.5 * deepest**1.5
    assert result.motion.maximum_force == pytest.approx(force, rel=1e-12)
    assert result.motion.maximum_radius == pytest.approx((RADIUS * deepest) ** 0.5, rel=1e-12)


@pytest.mark.parametrize("batch", [False, True])
def test_the_greatest_force_and_compression_of_a_linear_spring(batch):
    """P_max = v1 sqrt(k m) and z_max = v1 sqrt(m/k)."""
    speeds = np.array([0.5, 2.0]) if batch else 2.0
    ball = Sphere(RADIUS, STEEL)
    stiffness = 1e7
    simulation = Simulation(normal=LinearSpring(stiffness=stiffness), tangential="coulomb")
    result = simulation.run(Scene(ball, HalfSpace(STEEL), FRICTION, speeds, 1.0)).check()
    force = speeds * math.sqrt(stiffness * ball.mass)
    assert result.motion.maximum_force == pytest.approx(force, rel=1e-6)
    assert result.motion.maximum_approach == pytest.approx(force / stiffness, rel=1e-6)


def test_without_bodies_there_is_no_centre_and_no_spin():
    result = Simulation(tangential="coulomb").run(Scene.nondimensional(psi1=6.0, chi=1.0))
    assert result.rebound_tangential_velocity is None
    assert result.rebound_spin is None
    assert result.rebound_angle is None
    assert result.tangential_restitution is None
    assert result.local_rebound_angle == pytest.approx(math.atan(2.0))


def test_restitutions_of_what_did_not_move_are_no_numbers():
    ball = Sphere(RADIUS, STEEL)
    scene = Scene(ball, HalfSpace(STEEL), FRICTION, SPEED, 0.0, [0.0, SPIN])
    result = Simulation(tangential="coulomb").run(scene).check()
    assert np.isnan(result.tangential_restitution).all()
    assert np.isnan(result.beta0).tolist() == [True, False]


def made(varied):
    """One impact of a ball that turns, or a batch of two that differ in one number."""

    def of(name, value):
        return value * np.array([1.0, 1.1]) if name == varied else value

    shear, strength = of("shear_modulus", 8e10), of("yield_stress", 3e9)
    soft = Material(shear_modulus=shear, poisson_ratio=0.3, density=7850.0, yield_stress=strength)
    ball = Sphere(of("radius", 0.01), STEEL, gyration_ratio=of("gyration_ratio", 0.6))
    entries = {"friction_coefficient": 0.2, "normal_speed": 1.0, "tangential_velocity": 0.5}
    entries |= {"spin": 3.0, "normal_spin": 2.0}
    return Scene(ball, HalfSpace(soft), **{name: of(name, each) for name, each in entries.items()})


@pytest.mark.parametrize(
    "varied",
    [
        "", "friction_coefficient", "normal_speed", "tangential_velocity", "spin", "normal_spin",
        "radius", "gyration_ratio", "shear_modulus", "yield_stress",
    ],
)  # fmt: skip
def test_every_number_has_the_shape_of_the_scene(varied):
    """The incidence of impacts that differ in friction alone is an angle for each."""
    scene = made(varied)
    result = Simulation(tangential="stronge").run(scene).check()
    energy = result.energy
    named = {name: getattr(result, name) for name in NUMBERS}
    named |= {name: getattr(energy, name) for name in ("start", "end", "friction_work", "checked")}
    assert {name: np.shape(each) for name, each in named.items()} == dict.fromkeys(
        named, scene.shape
    )
    assert scene.shape or {*map(type, named.values())} == {float, bool}


def test_the_result_of_one_impact_is_no_batch():
    result = Simulation(tangential="coulomb").run(Scene.nondimensional(psi1=6.0, chi=1.0))
    with pytest.raises(TypeError, match="cannot be indexed"):
        result[0]
    with pytest.raises(TypeError, match="no length"):
        len(result)


def test_the_table_of_a_ball_on_a_ball_has_the_target_at_rest_before():
    """What the sphere loses the target gains: momentum of both along normal and surface."""
    ball, target = Sphere(RADIUS, STEEL), Sphere(2.0 * RADIUS, STEEL)
    scene = Scene(ball, target, FRICTION, SPEED, TANGENTIAL, SPIN)
    result = Simulation(tangential="coulomb").run(scene).check()
    rows = {name: numbers for name, *numbers, _ in sections(result)[0].rows}
    for name in ("normal velocity", "tangential velocity"):
        before, after = rows[name]
        still, moved = rows[f"target: {name}"]
        assert still == 0.0
        assert target.mass * abs(moved) == pytest.approx(ball.mass * abs(before - after), rel=1e-9)
    assert rows["target: spin"][0] == 0.0


@pytest.mark.parametrize("speed", [2.0, np.array([1.0, 2.0, 3.0])])
def test_a_scene_given_another_speed_has_no_velocity_of_its_encounter(speed):
    """Friction alone may be another."""
    assert EXACT.run(attrs.evolve(OFF_CENTRE.scene, normal_speed=speed)).velocity_in_space is None
    rougher = EXACT.run(attrs.evolve(OFF_CENTRE.scene, friction_coefficient=0.1))
    made = collide(attrs.evolve(OFF_CENTRE, friction_coefficient=0.1))
    assert rougher.velocity_in_space == pytest.approx(made.velocity, rel=1e-12)


def test_what_is_filled_at_once_has_every_entry_of_its_class():
    """An entry that a class gains is not forgotten where its objects are filled without checks."""
    planar = Scene.nondimensional(psi1=1.2, chi=1.4, lam=0.2, eta=0.1)
    central = Scene.nondimensional(psi1=1.2, chi=1.4412)
    ball, floor = Sphere(RADIUS, STEEL), HalfSpace(STEEL)
    meeting = Encounter(
        ball, floor, friction_coefficient=FRICTION, normal=(0, 0, 1), velocity=(1.0, 0.0, SPEED)
    )
    hit = collide(meeting, Simulation())
    results = [Simulation().run(central), Simulation().run(planar), hit.result]
    normal = create("normal.hertz").motion(planar)
    exact = create("tangential.fronts")
    course = exact.solve_coupled(planar, normal, 1e-9)
    answers = exact.whole_impacts(central, create("normal.hertz").motion(central))
    for made in (*results, *[each.motion for each in results], hit, normal, course, *answers):
        assert {field.name for field in attrs.fields(type(made))} <= vars(made).keys(), type(made)
