"""Encounters and collisions: what is refused, passed, told, and which scene they come to."""

import math

import attrs
import numpy as np
import pytest

from contactlab import (
    Collision,
    Encounter,
    HalfSpace,
    ImpactError,
    Material,
    RigidBody,
    Scene,
    Simulation,
    Sphere,
    Status,
    collide,
    create,
)
from tests.laws.normal_laws import ForceFree

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


GLASS = Material(young_modulus=70e9, poisson_ratio=0.2, density=2500.0)


BALL, PLATE = Sphere(0.01, STEEL), HalfSpace(GLASS)
#: The ball as a body by its numbers.
CENTRAL = {
    "body": RigidBody(
        mass=BALL.mass, inertia=0.4 * BALL.mass * 1e-4 * np.eye(3), material=STEEL,
        curvature_radius=0.01,
    ),
    "contact": (0.0, 0.0, -0.01),
}  # fmt: skip


DOWN = (0.0, 0.0, -1.0)


def meeting(**changes):
    given = {
        "body": BALL,
        "target": PLATE,
        "friction_coefficient": 0.2,
        "normal": DOWN,
        "velocity": (0.5, 0.0, -1.0),
        "spin": (0.0, -20.0, 0.0),
    }
    return Encounter(**(given | changes))


def test_a_plane_encounter_is_the_scene():
    """Drawing of the guide: z down is the normal, x to the right; spin turns about -y."""
    scene = Scene(BALL, PLATE, 0.2, 1.0, 0.5, 20.0)
    made, result = collide(meeting()), Simulation().run(scene)
    assert meeting().scene.slip_velocity == pytest.approx(scene.slip_velocity, rel=1e-15)
    assert meeting().scene.spin == pytest.approx(20.0, rel=1e-15)
    assert made.velocity[0] == pytest.approx(result.rebound_tangential_velocity, abs=1e-9)
    assert made.velocity[2] == pytest.approx(-result.rebound_normal_velocity, abs=1e-9)
    assert made.spin[1] == pytest.approx(-result.rebound_spin, abs=1e-7)
    assert made.friction_work == pytest.approx(result.motion.friction_work, rel=1e-8)
    assert np.array_equal(made.velocity[[1]], [0.0])


def test_gross_slip_by_hand():
    """mu (1 + e) M_n v1 against the slip, whichever way it points; the ball begins to roll.

    Rolling along x on a floor below is spin about y, rolling along y is spin about -x.
    """
    met = meeting(velocity=(6.0, 8.0, -1.0), spin=(0.0, 0.0, 5.0))
    impulse = 2.0 * BALL.mass
    made = collide(met)
    assert made.impulse == pytest.approx([-0.12 * impulse, -0.16 * impulse, impulse], rel=1e-14)
    turned = 0.2 * impulse * BALL.radius / (0.4 * BALL.mass * BALL.radius**2)
    assert made.spin == pytest.approx([-0.8 * turned, 0.6 * turned, 5.0], rel=1e-14)


def test_a_moving_half_space():
    wall = np.array([0.3, -0.2, 0.4])
    still, moving = (
        collide(meeting()),
        collide(meeting(velocity=(0.8, -0.2, -0.6), target_velocity=wall)),
    )
    assert moving.velocity - wall == pytest.approx(still.velocity, abs=1e-9)
    assert moving.target_velocity.tolist() == wall.tolist()
    assert moving.target_contact_velocity.tolist() == wall.tolist()


@pytest.mark.parametrize("restitution", [1.0, 0.8])
def test_of_the_moduli_only_the_ratio_counts(restitution):
    def scaled(material, factor):
        return attrs.evolve(material, shear_modulus=material.shear_modulus * factor)

    for target in (STEEL, GLASS):
        made = []
        for factor in (1.0, 1e-7):
            pair = Sphere(0.01, scaled(STEEL, factor)), HalfSpace(scaled(target, factor))
            met = meeting(body=pair[0], target=pair[1], spin=(0.0, -20.0, 3.0))
            made.append(collide(met, restitution=restitution))
        assert made[0].velocity == pytest.approx(made[1].velocity, abs=1e-13)
        assert made[0].spin == pytest.approx(made[1].spin, abs=1e-11)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"velocity": 1.0}, "velocity = 1.0: must be a vector of three numbers"),
        ({"spin": 0}, "spin = 0: must be a vector"),
        ({"velocity": np.ones((4, 2))}, "velocity"),
        ({"velocity": (0.0, np.nan, -1.0)}, "velocity"),
        ({"velocity": np.array([0.0, np.inf, -1.0])}, "velocity"),
        ({"velocity": (0.0, 0.0, -1e200)}, "velocity"),
        ({"velocity": ("a", "b", "c")}, "velocity"),
        ({"velocity": None}, "velocity"),
        ({"normal": (0.0, 0.0, 0.0)}, "normal"),
        ({"normal": [DOWN, (0, 0, 0)]}, "normal"),
        ({"normal": [DOWN] * 2, "velocity": [(0, 0, -1)] * 3}, r"normal \(2,\), velocity \(3,\)"),
        ({"target_spin": (1.0, 0.0, 0.0)}, "target_spin.*half-space does not spin"),
        ({"body": None}, "body"),
        ({"target": STEEL}, "target"),
        ({"friction_coefficient": -1.0}, "friction_coefficient"),
    ],
)
def test_refusals(changes, words):
    with pytest.raises(ValueError, match=words):
        meeting(**changes)


@pytest.mark.parametrize("bad", [None, 3, "tabulated"])
def test_what_collide_refuses(bad):
    with pytest.raises(ValueError, match="encounter"):
        collide(bad)
    with pytest.raises(ValueError, match="separating"):
        collide(meeting(), separating=bad)
    if bad is not None:
        with pytest.raises(ValueError, match=r"^simulation = .*must be a Simulation"):
            collide(meeting(), bad)


def test_refusals_of_what_is_meant_otherwise():
    with pytest.raises(ValueError, match=r"by name: restitution=0.95"):
        collide(meeting(), 0.95)
    with pytest.raises(ValueError, match="make a single Encounter"):
        collide([meeting(), meeting()])
    with pytest.raises(ValueError, match=r"collide\(encounter, simulation\)"):
        Simulation().run(meeting())


def test_refusals_of_a_batch_tell_the_first():
    normals, velocities = np.ones((2, 3, 3)), -np.ones((2, 3, 3))
    normals[1, 1:] = 0.0
    velocities[0, 2, 1] = np.nan
    with pytest.raises(ValueError, match=r"normal = \[0.0, 0.0, 0.0\].*of 2 has index \[1, 1\]"):
        meeting(normal=normals)
    with pytest.raises(ValueError, match=r"velocity = \[-1.0, nan, -1.0\].*1 has index \[0, 2\]"):
        meeting(velocity=velocities)
    with pytest.raises(ValueError, match=r"normal.shape = \(3, 5\).*np.moveaxis"):
        meeting(normal=np.ones((3, 5)))


def test_bodies_that_separate_are_refused_by_name():
    with pytest.raises(ValueError, match=r"velocity, target_velocity = -1.0: bodies separate"):
        collide(meeting(normal=(0, 0, 1)))
    with pytest.raises(
        ValueError, match=r"= 0.0: bodies separate, or rest: .*; let such pairs pass"
    ):
        collide(meeting(velocity=(1.0, 0.0, 0.0)))
    some = meeting(velocity=[(0.5, 0, -1), (0.5, 0, 1), (0.5, 0, 2)])
    for laws in (None, Simulation()):
        with pytest.raises(ValueError, match=r"first of 2 has index \[1\]"):
            collide(some, laws)


@pytest.mark.parametrize("laws", [None, {}, {"tangential": "coulomb"}])
def test_bodies_that_separate_pass_if_asked(laws):
    simulation = None if laws is None else Simulation(**laws)
    rng = np.random.default_rng(3)
    met = meeting(
        target=BALL,
        velocity=rng.normal(size=(4, 5, 3)),
        spin=rng.normal(size=(5, 3)),
        target_spin=rng.normal(size=3),
    )
    made = collide(met, simulation, separating="pass")
    away = met.velocity[..., 2] >= 0.0
    assert 0 < away.sum() < 20
    assert np.array_equal(made.collided, ~away)
    assert np.array_equal(made.velocity[away], met.velocity[away])
    assert np.array_equal(made.spin[away], np.broadcast_to(met.spin, (4, 5, 3))[away])
    assert np.all(made.friction_work[away] == 0.0)
    assert np.all(made.status == Status.SUCCESS)
    assert made.status.shape == (4, 5)
    alone = collide(met.take(~away), simulation)
    assert np.allclose(made.velocity[~away], alone.velocity, rtol=0.0, atol=1e-12)
    assert np.allclose(made.target_spin[~away], alone.target_spin, rtol=0.0, atol=1e-9)
    assert "pass through untouched" in str(made.plan)
    none = collide(meeting(normal=(0, 0, 1)), simulation, separating="pass")
    assert "pass through untouched" in str(none.plan)
    with pytest.raises(ValueError, match="no bodies met"):
        _ = none.result
    assert none.velocity.tolist() == [0.5, 0.0, -1.0]
    assert none.collided is False


def test_the_default_is_that_of_the_exact_law_from_the_table_and_solved():
    rng = np.random.default_rng(4)
    met = meeting(
        target=BALL, velocity=rng.normal((0, 0, -5), size=(40, 3)), spin=rng.normal(size=3)
    )
    made = collide(met)
    for table in (True, False):
        other = collide(met, Simulation(tangential=create("tangential.fronts", table=table)))
        assert np.allclose(made.velocity, other.velocity, rtol=0.0, atol=1e-8)
        assert np.allclose(made.friction_work, other.friction_work, rtol=1e-7, atol=0.0)
    assert np.allclose(
        made.result.motion.slip_velocity_change, made.slip_velocity_change, rtol=0.0, atol=1e-12
    )


def test_a_result_is_turned_back():
    met = meeting(target=Sphere(0.02, GLASS), target_spin=(3.0, 4.0, 5.0))
    result = Simulation(tangential="coulomb").run(met.scene)
    made = Collision.of(met, result)
    assert made.result is result
    assert np.array_equal(made.velocity, collide(met, Simulation(tangential="coulomb")).velocity)
    with pytest.raises(ValueError, match=r"result of encounter\.scene"):
        Collision.of(meeting(), result)
    with pytest.raises(ValueError, match="result = 3"):
        Collision.of(met, 3)


def test_alone_and_together_are_the_same():
    rng = np.random.default_rng(6)
    spheres = Sphere(rng.uniform(0.01, 0.02, 30), STEEL), Sphere(0.02, GLASS)
    met = Encounter(
        *spheres, rng.uniform(0.0, 1.0, 30), normal=rng.normal(size=3),
        velocity=rng.normal(size=(30, 3)), spin=9.0 * rng.normal(size=(30, 3)),
    )  # fmt: skip
    for e in (1.0, 0.9):
        made = collide(met, restitution=e, separating="pass")
        for k in range(30):
            one = collide(met.take(k), restitution=e, separating="pass")
            for name in ("velocity", "spin", "target_velocity", "target_spin", "impulse"):
                assert getattr(one, name) == pytest.approx(getattr(made, name)[k], abs=1e-9), name


def test_lists_tuples_and_arrays_are_the_same_vector():
    wanted = meeting(velocity=np.array([[0.5, 0.0, -1.0]]))
    for kind in (list, tuple, np.array, np.float32):
        met = meeting(velocity=kind([0.5, 0.0, -1.0]), normal=kind([0, 0, -1]))
        assert np.array_equal(met.velocity, wanted.velocity[0])
        assert (met.velocity.dtype, met.shape, met.normal.dtype) == (np.float64, (), np.float64)
        # all that are left out share one zero
        for vector in (met.velocity, met.target_velocity, wanted.velocity):
            with pytest.raises(ValueError, match="read-only"):
                vector[0] = 1.0
    for bad in ([math.nan, 0, 0], [1e101, 0, 0], [10**400, 0, 0], ["1", 0, 0]):
        with pytest.raises(ValueError, match=r"^velocity = "):
            meeting(velocity=bad)


def test_the_spin_of_a_body_whose_moment_of_inertia_is_no_float():
    """Friction gives it the spin, scaled, of a body 1e298 times as large."""
    small = Sphere(1e-300, STEEL, mass=1e-30)
    met = Encounter(small, small, 0.1, normal=(1, 0, 0), velocity=(1, 1, 0))
    large = Encounter(
        *[attrs.evolve(small, radius=0.01)] * 2, 0.1, normal=(1, 0, 0), velocity=(1, 1, 0)
    )
    assert collide(met).spin[2] == pytest.approx(1e298 * collide(large).spin[2], rel=1e-12)


def test_no_friction_no_slip_and_vast_slip():
    calm = collide(meeting(friction_coefficient=0.0))
    assert calm.velocity.tolist() == [0.5, 0.0, 1.0]
    assert calm.spin.tolist() == [0.0, -20.0, 0.0]
    central = collide(meeting(velocity=DOWN, spin=(0, 0, 7)))
    assert central.velocity.tolist() == [0.0, 0.0, 1.0]
    assert central.spin.tolist() == [0.0, 0.0, 7.0]
    vast = collide(meeting(velocity=(1e90, 0.0, -1.0)))
    assert vast.friction_work == pytest.approx(0.4 * BALL.mass * 1e90, rel=1e-12)


def test_numbers_that_a_float_cannot_hold_are_refused():
    with pytest.raises(ValueError, match="friction_coefficient"):
        collide(meeting(friction_coefficient=1e250, velocity=(1e60, 0, -1e60)))
    light = Sphere(0.01, STEEL, mass=1e-290)
    with pytest.raises(ValueError, match="mass times speed"):
        collide(meeting(body=light, velocity=(0.0, 0.0, -1e-9)))


def test_the_plan_says_what_passes_through():
    assert "its friction is left out" not in str(collide(meeting()).plan)
    spinning = collide(meeting(spin=(0.0, 1.0, 2.0)))
    assert "spin about the normal: its friction is left out" in str(spinning.plan)
    assert "energy check" in str(spinning.plan)
    assert not spinning.energy.checked


@pytest.mark.parametrize("body", [{}, CENTRAL])
def test_the_books_are_checked_where_the_impact_is_followed(body):
    apart = meeting(velocity=[(0.5, 0.0, -1.0), (0.5, 0.0, 1.0)], **body)
    for laws, followed in (({}, False), ({"tangential": "springs"}, True)):
        checked = collide(apart, Simulation(**laws), separating="pass").energy.checked
        assert checked.tolist() == [followed, True]


@pytest.mark.parametrize("body", [{}, CENTRAL])
@pytest.mark.parametrize("laws", [None, Simulation()])
def test_the_books_have_the_shape_of_the_encounters(laws, body):
    books = collide(meeting(friction_coefficient=[0.1, 0.2], **body), laws).energy
    entries = (books.start, books.end, books.friction_work, books.shear_loss, books.imbalance)
    assert [np.shape(each) for each in (*entries, books.checked)] == 6 * [(2,)]
    books = collide(meeting(**body), laws).energy
    assert {*map(type, (books.start, books.end, books.shear_loss))} == {float}


def test_a_failure_is_a_status():
    made = collide(meeting(), Simulation(normal=ForceFree(), tangential="coulomb"))
    assert made.status is Status.NOT_SEPARATED
    assert np.isnan(made.velocity[0])
    with pytest.raises(ImpactError):
        made.check()


def test_a_failure_has_the_index_of_its_encounter_where_others_pass():
    """The bodies of encounters 0 and 2 part; a soft ball sticks in 1 and bounces off in 3."""
    soft = Material(young_modulus=1e6, poisson_ratio=0.45, density=1000.0)
    met = Encounter(
        Sphere(1e-4, soft), HalfSpace(soft), 0.3, normal=DOWN,
        velocity=[(1.0, 0, 1.0), (0.1, 0, -1e-3), (0, 0, 1.0), (1.0, 0, -10.0)],
    )  # fmt: skip
    made = collide(met, Simulation(normal="jkr", tangential="springs"), separating="pass")
    names = ["SUCCESS", "NOT_SEPARATED", "SUCCESS", "SUCCESS"]
    assert [status.name for status in made.status] == names
    assert [*made.failures] == [1]
    told = made.to_dict()
    assert told["status"] == names
    assert [bool(detail) for detail in told["detail"]] == [False, True, False, False]
    assert told["detail"][1] in made.failures[1]
    with pytest.raises(ImpactError, match="impact 1: ") as caught:
        made.check()
    assert caught.value.status is Status.NOT_SEPARATED


def test_a_collision_is_read_only_and_says_what_it_is():
    made = collide(meeting(velocity=[(0.5, 0, -1)] * 3))
    with pytest.raises(ValueError, match="read-only"):
        made.velocity[0] = 1.0
    assert repr(made) == "Collision(3 of 3 encounters collided; SUCCESS)"
    passed = collide(meeting(normal=(0, 0, 1)), separating="pass")
    assert repr(passed).endswith("; separate, passed through)")
    with pytest.raises(attrs.exceptions.FrozenInstanceError):
        made.velocity = 1.0


def test_three_spins_for_a_vector_are_not_taken_silently():
    scene = Scene(BALL, PLATE, 0.2, 1.0, 0.5, np.array([0.0, 10.0, 3.0]))
    for plan in (
        Simulation().plan(scene),
        Simulation().run(scene).plan,
        Simulation().sweep(scene).plan,
    ):
        assert "spin: three numbers were read as three impacts" in str(plan.cautions[-1])
    two = Scene(BALL, PLATE, 0.2, 1.0, np.array([0.5, 1.0, 2.0]), np.array([0.0, 10.0, 3.0]))
    assert "three numbers" not in str(Simulation().plan(two))
    paper = Scene.nondimensional(psi1=np.array([1.0, 2.0, 3.0]), chi=1.0)
    assert "three numbers" not in str(Simulation().plan(paper))


def test_the_struck_body_of_a_result():
    """Momentum and slip of the two add up, and a half-space takes no notice."""
    other = Sphere(0.02, GLASS)
    result = Simulation().run(Scene(BALL, other, 0.2, 1.0, 0.5, 20.0)).check()
    gained = other.mass * result.target_rebound_normal_velocity
    assert BALL.mass * (1.0 - result.rebound_normal_velocity) == pytest.approx(gained, rel=1e-14)
    gained = other.mass * result.target_rebound_tangential_velocity
    lost = BALL.mass * (0.5 - result.rebound_tangential_velocity)
    assert lost == pytest.approx(gained, rel=1e-14)
    slip = result.rebound_tangential_velocity - result.target_rebound_tangential_velocity
    slip += result.rebound_spin * BALL.radius + result.target_rebound_spin * other.radius
    assert slip == pytest.approx(result.rebound_slip_velocity, rel=1e-13)
    still = Simulation().run(Scene(BALL, PLATE, 0.2, 1.0, 0.5, 20.0))
    assert still.target_rebound_normal_velocity == still.target_rebound_spin == 0.0
    paper = Simulation().run(Scene.nondimensional(psi1=1.0, chi=1.0))
    assert paper.target_rebound_tangential_velocity is None


def test_scenes_by_speed_and_angle():
    scene = Scene.at_angle(BALL, PLATE, 0.2, speed=2.0, angle_deg=[30.0, -30.0], spin=3.0)
    assert scene.normal_speed == pytest.approx([np.sqrt(3.0)] * 2)
    assert scene.tangential_velocity == pytest.approx([1.0, -1.0])
    assert scene.spin == 3.0
    for wrong in ({"angle_deg": 90.0}, {"speed": 0.0}, {"speed": "fast"}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            Scene.at_angle(BALL, PLATE, 0.2, **({"speed": 1.0, "angle_deg": 3.0} | wrong))


def test_what_a_collision_has_not_itself_is_found_in_its_result():
    ball = Sphere(0.0286, Material(young_modulus=5e9, poisson_ratio=0.34, density=1700.0))
    done = collide(Encounter(ball, ball, 0.1, normal=[1, 0, 0], velocity=[2, 0, 0]))
    with pytest.raises(AttributeError, match=r"it is in \.result: write \.result\.psi2"):
        _ = done.psi2
    assert done.result.psi2 == 0.0
