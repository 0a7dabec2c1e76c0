"""Spin about the normal of bodies that meet, answered by the half-space."""

import numpy as np
import pytest

from contactlab import Encounter, Material, RigidBody, Simulation, Sphere, collide, create
from contactlab.outcome.columns import columns, find_quantity
from contactlab.outcome.tables import sections
from contactlab.outcome.text_table import table
from tests.longer import longer
from tests.solve.test_normal_spin import KAPPA, MU, ROWS, SHAPES, met, unlike

HALF_SPACE = Simulation(tangential=create("tangential.halfspace", rings=32))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    ("psi1", "w", "chi", "chi_w", "psi2", "rest"), [ROWS[1], *longer(*ROWS[:1], *ROWS[2:])]
)
def test_the_half_space_answers_slip_and_spin(psi1, w, chi, chi_w, psi2, rest, shape):
    """Velocity and all three spins follow from psi2 and w2 of other programs."""
    encounter = met(psi1, w, chi, chi_w, shape=shape)
    made = collide(encounter, HALF_SPACE).check()
    assert "about the normal" not in " ".join(map(str, (*made.plan.left_out, *made.cautions)))
    assert "slip and spin share the friction" in str(made.plan)
    assert "without spin" not in str(made.plan)
    bound = 2e-3 if w <= 0.5 else 5e-3
    assert made.result.psi2 == pytest.approx(psi2, abs=bound)
    assert -made.result.w2 == pytest.approx(rest, abs=5e-5)  # the normal points down
    assert made.spin[2] == pytest.approx(encounter.spin[2] * rest / w, rel=1e-3)
    gyration2 = 1.0 / (2.0 * chi / KAPPA - 1.0)
    impulse = (psi2 - psi1) * MU / KAPPA / (1.0 + 1.0 / gyration2)
    assert made.velocity == pytest.approx(
        encounter.velocity * (1, 1, -1) + (impulse, 0, 0), abs=bound * MU
    )
    assert made.spin[1] == pytest.approx(-impulse / gyration2, abs=2.0 * bound * MU)
    assert made.spin[0] == pytest.approx(0.0, abs=1e-12)
    lost = kinetic(encounter, encounter) - kinetic(made, encounter)
    assert made.energy.start - made.energy.end == pytest.approx(lost, rel=1e-9)
    assert made.energy.friction_work == pytest.approx(lost, rel=4e-3)
    tangential = made.result.scene.pair.tangential_mass * (psi1 * MU / KAPPA) ** 2
    turning = gyration2 * encounter.spin[2] ** 2
    assert made.energy.start == pytest.approx(0.5 * (1.0 + tangential + turning), rel=1e-12)


def kinetic(bodies, encounter):
    """The kinetic energy of the ball of ``met`` with the velocities of ``bodies``."""
    body = encounter.body
    gyration2 = body.inertia[0, 0] if isinstance(body, RigidBody) else body.gyration_ratio**2
    return 0.5 * (bodies.velocity @ bodies.velocity + gyration2 * bodies.spin @ bodies.spin)


def test_a_ball_given_as_a_body_is_the_sphere():
    one, other = (collide(met(1.0, 0.5, shape=shape), HALF_SPACE) for shape in SHAPES)
    for name in ("velocity", "spin", "impulse"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), abs=1e-9)
    assert one.energy.end == pytest.approx(other.energy.end, rel=1e-9)
    spins = [each.result.rebound_normal_spin for each in (one, other)]
    assert spins == pytest.approx([-each.spin[2] for each in (one, other)], rel=1e-12)


def momenta(bodies, encounter):
    """Momentum of both spheres, and angular momentum about their common normal."""
    pairs = ((encounter.body, ""), (encounter.target, "target_"))
    linear = sum(body.mass * getattr(bodies, f"{name}velocity") for body, name in pairs)
    about = sum(
        body.mass * (body.gyration_ratio * body.radius) ** 2 * getattr(bodies, f"{name}spin")[0]
        for body, name in pairs
    )
    return linear, about


def test_unlike_spheres_share_the_couple_by_their_inertias():
    encounter = unlike()
    made = collide(encounter, HALF_SPACE).check()
    for before, after in zip(momenta(encounter, encounter), momenta(made, encounter), strict=True):
        assert after == pytest.approx(before, rel=1e-12)
    relative = made.spin[0] - made.target_spin[0]
    assert relative == pytest.approx(made.result.rebound_normal_spin, rel=1e-12)
    assert 0.9 * 110.0 < relative < 0.9999 * 110.0


def test_bodies_exchanged_and_the_frame_turned_change_nothing():
    encounter = unlike()
    made = collide(encounter, HALF_SPACE)
    exchanged = collide(
        Encounter(
            encounter.target, encounter.body, 0.1, normal=-encounter.normal,
            velocity=encounter.target_velocity, spin=encounter.target_spin,
            target_velocity=encounter.velocity, target_spin=encounter.spin,
        ),
        HALF_SPACE,
    )  # fmt: skip
    assert exchanged.target_spin == pytest.approx(made.spin, rel=1e-9, abs=1e-9)
    assert exchanged.velocity == pytest.approx(made.target_velocity, rel=1e-9, abs=1e-12)
    turn, _ = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))
    turn *= np.linalg.det(turn)
    names = ("normal", "velocity", "spin", "target_velocity", "target_spin")
    vectors = {name: turn @ getattr(encounter, name) for name in names}
    turned = collide(unlike(**vectors), HALF_SPACE)
    for name in names[1:]:
        there = turn @ getattr(made, name)
        assert getattr(turned, name) == pytest.approx(there, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("units", [(1e3, 1e-3, 1e6), *longer(((3e-7, 2e5, 1e-9),))])
def test_other_units_give_the_same_collision(units):

    def collided(length, time, mass):
        steel = Material(
            young_modulus=208e9 * mass / (length * time**2), poisson_ratio=0.3,
            density=7850.0 * mass / length**3,
        )  # fmt: skip
        met = Encounter(
            Sphere(0.01 * length, steel), Sphere(0.006 * length, steel), 0.1,
            normal=(0, 0, -1), velocity=np.array((0.12, 0.0, -1.0)) * length / time,
            spin=np.array((0.0, 3.0, 100.0)) / time,
        )  # fmt: skip
        made = collide(met, HALF_SPACE).check()
        return np.array([made.velocity * time / length, made.spin * time, made.target_spin * time])

    assert collided(*units) == pytest.approx(collided(1.0, 1.0, 1.0), rel=1e-6, abs=1e-9)


def test_a_mirror_turns_the_spin_and_keeps_the_rest():
    spin = met(1.0, 0.5).spin
    made, other = (collide(met(1.0, 0.5, spin=sense * spin), HALF_SPACE) for sense in (1.0, -1.0))
    assert (other.velocity == made.velocity).all()
    assert (other.spin == made.spin * (1, 1, -1)).all()


def test_of_pairs_some_of_which_separate_those_that_meet_are_turned():
    encounter = unlike(velocity=[(1.0, 0.05, 0.0), (-1.0, 0.05, 0.0)])
    made = collide(encounter, HALF_SPACE, separating="pass").check()
    alone = collide(unlike(), HALF_SPACE)
    assert made.spin[0] == pytest.approx(alone.spin, rel=1e-12)
    assert made.target_spin[1].tolist() == [-70.0, 5.0, 0.0]
    assert made.energy.start[0] == pytest.approx(alone.energy.start, rel=1e-12)


@pytest.mark.parametrize("tilted", [True, False])
def test_a_normal_that_is_no_principal_axis_keeps_the_caution(tilted):
    """The couple would turn such a body about its slip too."""
    sine, cosine = (0.6, 0.8) if tilted else (0.0, 1.0)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]])
    ball = met(1.0, 0.5)
    inertia = turn @ np.diag([0.4, 0.4, 0.5]) @ turn.T
    body = RigidBody(mass=1.0, inertia=inertia, material=ball.body.material, curvature_radius=1.0)
    encounter = Encounter(
        body, ball.target, MU, normal=ball.normal, velocity=ball.velocity, spin=ball.spin,
        contact=(0.0, 0.0, -1.0),
    )  # fmt: skip
    made = collide(encounter, HALF_SPACE).check()
    assert made.result.rebound_normal_spin == pytest.approx(-made.spin[2], rel=1e-12)
    about = inertia[2] @ made.spin, inertia[2] @ ball.spin
    cautioned = "spin about the normal is ignored" in " ".join(made.cautions)
    assert cautioned is tilted
    assert bool(about[0] == pytest.approx(about[1], rel=1e-12)) is tilted
    assert (made.result.scene.normal_spin == 0.0) is tilted


def test_columns_of_files_have_the_spin_only_where_bodies_turn():
    law = Simulation(tangential=create("tangential.halfspace", rings=8))
    result = law.run(met(1.0, 0.5).scene)
    names = ("normal_spin", "rebound_normal_spin", "w1", "chi_w", "w2")
    told = {name: values for name, _, values in columns(result)}
    assert [told[name] for name in names] == [
        result.scene.normal_spin, result.rebound_normal_spin, result.scene.w1, result.scene.chi_w,
        result.w2,
    ]  # fmt: skip
    assert find_quantity("w2").of(result) == pytest.approx(result.w2)
    still = {name for name, *_ in columns(law.run(met(1.0, 0.0).scene))}
    assert not still & set(names)
    assert "w1=-0.5, chi_w=0.01" in str(result)
    assert "spin about the normal" in table(*sections(result)[0])
