"""Collisions with a restitution instead of laws."""

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Encounter, RigidBody, Simulation, Sphere, collide
from contactlab_laws.tables.restituted_regions import RESTITUTED_ERROR
from tests.collisions.test_collision import BALL, meeting
from tests.collisions.test_collision_of_bodies import each_met
from tests.solve.any_scene import OFF_CENTRE
from tests.solve.test_eccentric import FLOOR, STEEL, rod


def test_a_restitution_is_that_of_springs_that_lose_as_the_normal_contact():
    rng = np.random.default_rng(11)
    met = meeting(
        target=BALL,
        velocity=rng.normal((0, 0, -5), size=(12, 3)),
        spin=40 * rng.normal(size=(12, 3)),
    )
    made = collide(met, restitution=0.8)
    laws = Simulation(
        normal=contactlab.create("normal.viscoelastic", restitution=0.8),
        tangential=contactlab.create("tangential.springs", springs=100),
        integrator=contactlab.create("integrator.symplectic", steps=800),
    )
    other = collide(met, laws)
    np.testing.assert_allclose(made.normal_velocity, other.normal_velocity, rtol=1e-7)
    scale = np.abs(other.slip_velocity_change).max()
    apart = np.abs(made.slip_velocity_change - other.slip_velocity_change).max()
    assert 0.0 < apart < 5e-4 * scale
    np.testing.assert_allclose(made.energy.imbalance, 0.0, atol=1e-12)
    assert made.result.laws["normal"].startswith("viscoelastic")
    elastic = collide(met)
    assert (np.abs(made.velocity - elastic.velocity).max(axis=1) > 1e-3).all()


def test_gross_slip_with_a_restitution():
    """Impulse mu (1 + e) M_n v1, theory §15."""
    met = meeting(friction_coefficient=0.01, velocity=(50.0, 0.0, -1.0))
    for e in (1.0, 0.9, 0.3, 0.0):
        drag = -collide(met, restitution=e).slip_velocity_change
        pair = met.pair
        full = 0.01 * (1.0 + e) * pair.normal_mass * 1.0 / pair.tangential_mass
        assert drag == pytest.approx(full, rel=1e-9)


def slower_is_bouncier(speed):
    """Restitution of viscoelastic spheres to first order: 1 - C v^(1/5)."""
    return 1.0 - 0.2 * speed**0.2


def test_a_restitution_of_each_pair_is_that_of_the_pair_alone():
    """By value, and by the speed of approach; out of the table too, and of bodies that separate."""
    rng = np.random.default_rng(3)
    count = 30
    met = meeting(
        target=BALL,
        velocity=rng.normal((0, 0, -3), 2, size=(count, 3)),
        spin=40 * rng.normal(size=(count, 3)),
    )
    speed, apart = -met.velocity[:, 2], ~met.approaching
    assert 0 < apart.sum() < count / 2
    e = rng.uniform(0.5, 1.0, count)
    e[::7], e[3] = 1.0, 0.3
    shaped = meeting(target=BALL, velocity=met.velocity[:, None], spin=met.spin[:, None])
    for given, each in (
        (e, e),
        (slower_is_bouncier, slower_is_bouncier(np.abs(speed))),
        (lambda _: 0.8, np.full(count, 0.8)),
        (lambda _: e, e),
    ):
        made = collide(met, restitution=given, separating="pass")
        assert made.normal_velocity[~apart] == pytest.approx(-(each * speed)[~apart], rel=1e-12)
        for k in range(count):
            one = collide(met.take(k), restitution=float(each[k]), separating="pass")
            assert made.spin[k] == pytest.approx(one.spin, rel=1e-12, abs=1e-10)
            assert made.velocity[k] == pytest.approx(one.velocity, rel=1e-12, abs=1e-12)
    made = collide(met, restitution=slower_is_bouncier, separating="pass")
    column = collide(shaped, restitution=slower_is_bouncier, separating="pass")
    assert (column.spin[:, 0] == made.spin).all()
    one = collide(met.take(1), restitution=slower_is_bouncier)
    assert one.spin == pytest.approx(made.spin[1], rel=1e-12)
    assert type(one.restitution) is float


@pytest.mark.parametrize(
    ("restitution", "word"),
    [
        (1.2, "restitution = 1.2: must be from"), (lambda v: np.nan * v, "must be from"),
        (lambda v: np.where(v > 0.5, 1.01, 1.0), "index"), (lambda v: v[:2], "shape"),
        (lambda _: [[0.9], [0.9, 0.8]], "shape"), (lambda _: None, "real number"),
        (lambda _: "0.9", "real number"),
    ],
)  # fmt: skip
def test_refused_restitutions(restitution, word):
    met = meeting(velocity=[(0, 0, -1), (0, 0, -0.1), (0, 0, -1)])
    with pytest.raises(ValueError, match=word):
        collide(met, restitution=restitution)


def test_a_restitution_stands_in_place_of_laws():
    for given in (0.9, slower_is_bouncier):
        with pytest.raises(ValueError, match="restitution"):
            collide(meeting(), Simulation(), restitution=given)


def test_the_plan_of_many_restitutions_is_as_short_as_that_of_one():
    """Its cautions are those of the least restitution; the errors are those of each."""
    velocity = np.random.default_rng(4).normal((0, 0, -6), size=(3000, 3))
    e = np.append(0.4, np.linspace(0.5, 0.9, 2999))
    plan = collide(meeting(velocity=velocity), restitution=e).plan
    lines = str(plan).splitlines()
    assert len(lines) < 12
    assert "left out: stepping through the contact: " in str(plan)
    assert plan.psi2_error.max() == pytest.approx(RESTITUTED_ERROR, rel=0.05)
    assert "by default" not in str(plan)
    few = collide(meeting(velocity=velocity[:3]), restitution=[0.62, 0.7, 0.9]).plan
    assert all(f"At e = {each:g}" in str(few) for each in (0.62, 0.7, 0.9))


def test_the_plan_of_a_restitution_says_who_answered():
    """It is not the springs, but their table."""
    plan = collide(meeting(), restitution=0.9).plan
    assert "the answer is in the table of restitutions" in str(plan)
    assert "springs" not in str(plan).partition("caution")[0]
    assert "equal damping" in str(plan)
    assert plan.psi2_error == pytest.approx(RESTITUTED_ERROR, rel=0.05)
    batch = collide(meeting(velocity=[(0.5, 0, -1), (0, 0, -1)], spin=(0, 0, 0)), restitution=0.9)
    assert batch.plan.psi2_error.max() == pytest.approx(RESTITUTED_ERROR, rel=0.05)
    assert "springs" in str(collide(meeting(), Simulation(tangential="springs")).plan)


def test_a_restitution_for_each_pair_is_that_of_each_alone():
    rng = np.random.default_rng(7)
    count = 300
    e = np.where(rng.random(count) < 0.1, 1.0, rng.uniform(0.5, 1.0, count))
    speeds = np.stack([rng.uniform(0, 3, count), np.zeros(count), -np.ones(count)], axis=-1)
    met = meeting(velocity=speeds)
    made = collide(met, restitution=e)
    for k in range(0, count, 7):
        alone = collide(met.take(k), restitution=float(e[k]))
        assert made.velocity[k] == pytest.approx(alone.velocity, abs=1e-12)
    assert made.normal_velocity == pytest.approx(-e, rel=1e-14)


def test_a_restitution_that_depends_on_the_speed():
    speeds = [(0.5, 0.0, -1.0), (0.5, 0.0, -2.0), (0.5, 0.0, 1.0)]
    met = meeting(velocity=speeds)

    def softer(speed):
        assert np.shape(speed) == (3,)
        return 1.0 - 0.1 * speed

    made = collide(met, restitution=softer, separating="pass")
    assert made.normal_velocity[:2] == pytest.approx([-0.9, -1.6])
    assert made.velocity[2].tolist() == list(speeds[2])
    one = collide(met.take(0), restitution=lambda speed: 1.0 - 0.1 * speed)
    assert one.velocity == pytest.approx(made.velocity[0], abs=1e-12)
    with pytest.raises(ValueError, match="restitution"):
        collide(met.take(0), restitution=lambda speed: 1.5 * speed)
    with pytest.raises(ValueError, match="shape"):
        collide(met.take(slice(0, 2)), restitution=lambda _: [0.9] * 3)


@pytest.mark.slow
def test_the_plan_of_bodies_says_once_whose_restitution_it_is():
    met = rod(-35.0, slip=0.3)
    several = attrs.evolve(met, friction_coefficient=[0.3, 0.4, 0.5])
    for each, e in ((met, 0.8), (several, [0.5, 0.8, 1.0])):
        said = map(str, collide(each, restitution=e).plan.computed)
        told = [text for text in said if text.startswith("restitution")]
        assert len(told) == 1
        assert "frictionless" in told[0]
    for none in (collide(met), collide(meeting(), restitution=0.8)):
        assert "frictionless" not in str(none.plan)


@pytest.mark.parametrize("e", [0.0, 0.005, 0.3])
def test_a_sphere_given_as_a_body_rebounds_as_little(e):
    """Down to clay, whose contact point stops where it grips; across, and in batches."""
    ball = Sphere(0.01, STEEL)
    inertia = 0.4 * ball.mass * 0.01**2 * np.eye(3)
    body = RigidBody(mass=ball.mass, inertia=inertia, material=STEEL, curvature_radius=0.01)
    velocity = [(0.3, 0.2, -1.0), (5.0, 0.0, -1.0)]
    about = {"normal": (0, 0, -1), "velocity": velocity, "spin": (0.0, 3.0, 0.0)}
    as_ball = collide(Encounter(ball, FLOOR, 0.3, **about), restitution=e)
    as_body = collide(Encounter(body, FLOOR, 0.3, contact=(0, 0, -0.01), **about), restitution=e)
    for name in ("velocity", "spin"):
        scale = np.abs(getattr(as_ball, name)).max()
        found, expected = getattr(as_body, name), getattr(as_ball, name)
        np.testing.assert_allclose(found, expected, atol=1e-9 * scale)
    lost = as_body.friction_work + as_body.energy.shear_loss  # of a sphere both are one number
    np.testing.assert_allclose(lost, as_ball.friction_work, rtol=1e-7)
    assert np.abs(as_body.energy.relative_imbalance).max() < 1e-12
    if e == 0.0:
        grips, slips = as_body.contact_velocity
        assert np.abs(grips).max() < 1e-12
        assert slips[0] == pytest.approx(5.0 - 0.01 * 3.0 - 0.3 * 3.5, rel=1e-9)


@pytest.mark.parametrize("e", [0.0, 0.005, [0.5, 0.0]])
def test_bodies_that_hardly_rebound_are_refused_where_friction_changes_the_approach(e):
    met = attrs.evolve(rod(-35.0, slip=0.3), friction_coefficient=0.3 * np.ones(np.shape(e)))
    with pytest.raises(ValueError, match=r"restitution = 0.0.*must be from 0.01 for this body"):
        collide(met, restitution=e)


@pytest.mark.slow
@each_met
@pytest.mark.parametrize("restitution", [0.3, 0.9])
def test_cautions_of_a_restitution(met, restitution):
    """A given restitution is not called taken by default."""
    made = collide(met, restitution=restitution)
    slides = met is OFF_CENTRE and restitution == 0.3  # from touch to separation: mu decides
    told = any("equal damping" in text for text in made.cautions)
    assert told is not slides
    assert not any("using" in text for text in made.cautions)
    assert not any("default" in str(clause) for clause in made.result.plan.computed)
