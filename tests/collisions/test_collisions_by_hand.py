"""Directions and speeds at a contact in space, and collisions of round numbers, by hand."""

import math

import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Simulation, Sphere, Status, collide
from tests.outcome.made import BALL, SOFT

SMALL = Sphere(0.25, SOFT, mass=2.0, gyration_ratio=0.5)


def met(**changes):
    """Return an encounter along z: u = (1, 1, 2) m/s, R1 w1 + R2 w2 = (2, 2, 3.5) m/s."""
    given = {
        "normal": (0.0, 0.0, 2.0), "velocity": (1.0, 2.0, 3.0), "target_velocity": (0.0, 1.0, 1.0),
        "spin": (4.0, 0.0, 7.0), "target_spin": (0.0, 8.0, 0.0),
    }  # fmt: skip
    return Encounter(BALL, SMALL, 0.5, **(given | changes))


def test_directions_and_speeds_at_the_contact():
    """Slip is (1, 1, 0) + (2, 2, 3.5) x (0, 0, 1) = (3, -1, 0)."""
    root = math.sqrt(10.0)
    for one in (met(), met(spin=[(4.0, 0.0, 7.0)] * 2)):
        normal, along, approach, slip = one.meeting()
        assert [np.ravel(each)[0] for each in normal] == [0.0, 0.0, 1.0]
        assert [np.ravel(each)[-1] for each in along] == pytest.approx([3 / root, -1 / root, 0.0])
        assert np.ravel(approach)[0] == 2.0
        assert np.ravel(slip)[-1] == pytest.approx(root)
        scene = one.scene
        assert scene.shape == one.shape
        assert np.ravel(scene.normal_speed)[0] == 2.0
        assert np.ravel(scene.tangential_velocity)[0] == pytest.approx(2.0 / root)  # u along slip
        assert np.ravel(scene.slip_velocity)[-1] == pytest.approx(root)
        assert np.ravel(scene.spin)[0] == pytest.approx(8.0 / root / 0.5)
    calm = met(target_velocity=(1.0, 2.0, 1.0), spin=(0.0, 0.0, 1.0), target_spin=(0.0, 0.0, 3.0))
    assert calm.meeting()[1:] == ((0.0, 0.0, 0.0), 2.0, 0.0)
    wall = Encounter(
        BALL, HalfSpace(SOFT), 0.5, normal=(0, 0, 1), velocity=(1, 0, 1), spin=(0, 2, 0)
    )
    assert wall.meeting().slip == pytest.approx(2.0)


def sliding(**changes):
    """Return two balls in gross slip, at 1 m/s along x and 40 m/s along y: mu = 1/10."""
    given = {"normal": (1, 0, 0), "velocity": (1.0, 40.0, 0.0), "spin": (5.0, 0.0, 0.0)}
    return Encounter(BALL, BALL, 0.1, **(given | changes))


@pytest.mark.parametrize("batch", [False, True])
@pytest.mark.parametrize("laws", [None, {"tangential": "coulomb"}])
def test_two_balls_in_gross_slip(laws, batch):
    """M_n (1 + e) v1 = 2 N s along, a tenth of it across, at an arm of 0.5 m; I = 0.125 kg m²."""
    given = sliding(velocity=[(1.0, 40.0, 0.0)] * 2, normal=[(1, 0, 0)] * 2)
    if not batch:
        given = given.take(1)
    made = collide(given, None if laws is None else Simulation(**laws))
    expected = {
        "velocity": [0.0, 39.9, 0.0], "target_velocity": [1.0, 0.1, 0.0],
        "spin": [5.0, 0.0, -0.8], "target_spin": [0.0, 0.0, -0.8], "impulse": [-2.0, -0.2, 0.0],
        "contact_velocity": [0.0, 39.5, 0.0], "target_contact_velocity": [1.0, 0.5, 0.0],
    }  # fmt: skip
    for name, vector in expected.items():
        found = getattr(made, name)
        assert found.shape == (*given.shape, 3)
        assert found.reshape(-1, 3)[-1] == pytest.approx(vector, rel=1e-9, abs=1e-9), name
    # M_t = 1/5 kg: slip loses 0.2/0.2 = 1 m/s, and 0.2 (40 - 1/2) J
    assert np.ravel(made.slip_velocity_change)[0] == pytest.approx(-1.0)
    assert np.ravel(made.friction_work)[0] == pytest.approx(7.9)
    assert np.ravel(made.normal_velocity)[0] == pytest.approx(-1.0)
    assert np.all(made.collided)
    books, turning = made.energy, 0.5 * 0.0625 * 5.0**2  # 1/J = 2/I about the normal
    assert np.ravel(books.start)[0] == pytest.approx(0.5 + 0.1 * 1600.0 + turning)
    assert np.ravel(books.end)[0] == pytest.approx(0.5 + 0.1 * 39.0**2 + turning)
    assert np.ravel(books.imbalance)[0] == pytest.approx(0.0, abs=1e-9)
    assert np.asarray(books.checked).dtype == bool
    assert np.all(books.checked == (laws is not None))  # without laws the books close themselves
    assert made.vectors() == {
        name: np.asarray(getattr(made, name)).tolist()
        for name in (
            "velocity", "spin", "target_velocity", "target_spin", "impulse", "contact_velocity",
            "target_contact_velocity",
        )
    }  # fmt: skip


def test_a_batch_of_which_some_pass_and_some_have_another_restitution():
    e = np.array([1.0, 0.5, 0.5, 1.0])
    speeds = [(1.0, 40.0, 0.0), (1.0, 40.0, 0.0), (-1.0, 40.0, 0.0), (2.0, 40.0, 0.0)]
    made = collide(sliding(velocity=speeds), restitution=e, separating="pass")
    assert made.collided.tolist() == [True, True, False, True]
    assert made.velocity[:, 0] == pytest.approx([0.0, 0.25, -1.0, 0.0])
    assert made.normal_velocity == pytest.approx([-1.0, -0.5, -1.0, -2.0])
    assert made.slip_velocity_change == pytest.approx([-1.0, -0.75, 0.0, -2.0], rel=2e-3)
    assert repr(made) == "Collision(3 of 4 encounters collided; SUCCESS)"
    assert made.status.tolist() == [Status.SUCCESS] * 4
    assert [str(clause) for clause in made.plan.left_out][-2:] == [
        "spin about the normal: its friction is left out",
        "collision (1 of 4 impacts): the bodies separate, they pass through untouched",
    ]
    assert made.result.normal_restitution == pytest.approx([1.0, 0.5, 1.0])
    assert made.result.laws["normal"].startswith("viscoelastic")


def test_a_ball_that_passes_is_told_by_its_words():
    alone = collide(sliding(velocity=(-1.0, 40.0, 0.0)), separating="pass")
    assert repr(alone) == (
        "Collision(velocity=[-1. 40.  0.], spin=[5. 0. 0.]; separate, passed through)"
    )
    assert str(alone).splitlines()[1:] == [
        "  body: velocity (-1, 40, 0) m/s, spin (5, 0, 0) rad/s",
        "  target: velocity (0, 0, 0) m/s, spin (0, 0, 0) rad/s",
    ]
    assert alone.check(cautions=True) is alone
    hit = collide(sliding())
    assert repr(hit).endswith("; SUCCESS)")


def test_the_least_length_of_a_normal():
    """Its square is a normal float; the first of a batch that is too short is named."""
    short = (0.0, 0.0, 1e-100)
    assert met(normal=short).meeting().approach == 2.0
    assert met(normal=[short, (0.0, 0.0, 1.0)]).meeting().approach.tolist() == [2.0, 2.0]
    with pytest.raises(ValueError, match=r"not zero \(the first of 1 has index \[1\]\);"):
        met(normal=[short, (0.0, 0.0, 0.0)])


@pytest.mark.parametrize("batch", [False, True])
def test_the_least_speed_of_approach(batch):
    """At the bound they meet: in gross slip of mu = 1/10 each half of the impulse counts."""
    speed = 1e-100
    rows = [(speed, 1.0, 0.0), (math.nextafter(speed, 0.0), 1.0, 0.0)]
    given = [sliding(velocity=rows)] if batch else [sliding(velocity=row) for row in rows]
    made = [collide(each, separating="pass") for each in given]
    assert [bool(one) for each in made for one in np.ravel(each.collided)] == [True, False]
    changes = [one for each in made for one in np.ravel(each.slip_velocity_change).tolist()]
    assert changes == [pytest.approx(-speed), 0.0]
    rates = [one for each in made for one in np.ravel(each.normal_velocity).tolist()]
    assert rates == [-speed, rows[1][0]]
