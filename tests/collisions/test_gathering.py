"""Several contacts at once against other methods: ODEs, one contact, published waves (theory §18).

Velocities are in m/s and of impacts at v1 = 1 m/s. Where no source is named, they are those of
DOP853 at 1e-13, or of an independent program for springs, extrapolated.
"""

import re
from importlib.resources import files

import numpy as np
import pytest

from contactlab import (
    Body,
    Gathering,
    HalfSpace,
    Material,
    RigidBody,
    Sphere,
    Touch,
    collide,
    rebound,
)  # fmt: skip
from tests.collisions.gathered import RADIUS, STEEL, cushion, half_space, laws, row, three_balls

#: Errors of velocities over v1 at 50 springs and 200 steps, and extrapolated with 100 and 400.
USUAL, EXTRAPOLATED = 2e-4, 2e-5

#: Rows of equal balls without friction by DOP853: number of balls, gaps, velocities.
ROWS = (
    (3, 0.0, [-0.0709524, 0.0764030, 0.9945493]),
    (5, 0.0, [-0.0710850, -0.0302738, -0.0144636, 0.1270450, 0.9887774]),
    (5, [0.0, 1e-6, 1e-6, 1e-6], [-0.0571624, -0.0199372, -0.0078550, 0.0909743, 0.9939803]),
)


def extrapolated(make, answer):
    """Return an answer without its error of second order."""
    coarse, fine = (answer(collide(make(), laws(n, 4 * n))) for n in (50, 100))
    return (4.0 * fine - coarse) / 3.0


@pytest.mark.parametrize(("count", "gaps", "after"), ROWS)
def test_a_row_of_balls_is_an_ode(count, gaps, after):
    hit = collide(row(count, gaps=gaps))
    np.testing.assert_allclose(hit.velocity[:, 0], after, atol=USUAL)
    assert abs(hit.energy.relative_imbalance) < 1e-5
    assert hit.status.name == "SUCCESS"
    assert hit.spin.max() == 0.0


@pytest.mark.slow
def test_ten_balls_leave_as_many_do():
    """The first and the last two hardly depend on the number of balls."""
    after = collide(row(10)).velocity[:, 0]
    np.testing.assert_allclose(after[[0, -2, -1]], [-0.0710850, 0.1473903, 0.9858659], atol=USUAL)


@pytest.mark.slow
@pytest.mark.parametrize(("count", "gaps", "after"), ROWS)
def test_a_row_of_balls_extrapolated(count, gaps, after):
    found = extrapolated(lambda: row(count, gaps=gaps), lambda hit: hit.velocity[:, 0])
    np.testing.assert_allclose(found, after, atol=EXTRAPOLATED)


@pytest.mark.parametrize("radius", [1e-3, 0.3])
def test_a_row_of_balls_is_that_of_any_size_and_speed(radius):
    hit = collide(row(3, radius=radius, speed=0.1))
    np.testing.assert_allclose(hit.velocity[:, 0], 0.1 * np.array(ROWS[0][2]), atol=0.1 * USUAL)


#: Rows with friction, spin of the first about z of 100 rad/s, and loss: e of each contact, vx, vy.
LOSSY = (
    (3, [0.9, 0.5], [-0.081276, 0.314099, 0.767177], [-0.162191, 0.201164, -0.038973]),
    (5, 0.9, [-0.039729, -0.007417, 0.009253, 0.173314, 0.864578],
     [-0.155959, 0.188730, -0.042631, 0.012312, -0.002451]),
    (5, [1.0, 0.9, 0.8, 0.7], [-0.079179, -0.019134, 0.019859, 0.265643, 0.812811], None),
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("count", "e", "along", "across"), LOSSY)
def test_a_row_with_friction_and_loss_is_that_of_the_independent_program(count, e, along, across):
    hit = collide(row(count, mu=0.15, spin=100.0, e=e))
    np.testing.assert_allclose(hit.velocity[:, 0], along, atol=USUAL)
    if across is not None:
        np.testing.assert_allclose(hit.velocity[:, 1], across, atol=USUAL)
    assert abs(hit.energy.relative_imbalance) < 1e-6
    assert hit.energy.normal_loss > 0.0


def test_a_ball_meets_cushion_and_cloth():
    hit = collide(cushion())
    np.testing.assert_allclose(hit["ball"].velocity, [0.7469866, -0.8914532, 0.1595385], atol=USUAL)
    spin = np.array([-6.5736, 28.4566, 22.0848])
    np.testing.assert_allclose(RADIUS * hit.spin[0], RADIUS * spin, atol=USUAL)


@pytest.mark.slow
def test_a_ball_meets_cushion_and_cloth_extrapolated():
    found = extrapolated(
        cushion, lambda hit: np.concatenate([hit.velocity[0], hit.spin[0] * RADIUS])
    )
    spin = RADIUS * np.array([-6.5736, 28.4566, 22.0848])
    after = [0.7469866, -0.8914532, 0.1595385, *spin]
    np.testing.assert_allclose(found, after, atol=EXTRAPOLATED)


@pytest.mark.slow
def test_the_cloth_carries_the_weight():
    hit = collide(cushion(loaded=True))
    np.testing.assert_allclose(hit.velocity[0], [0.74328, -0.89884, 0.14000], atol=USUAL)
    assert hit.first_touch[1] == 0.0
    assert not any("weight" in text for text in hit.cautions)


@pytest.mark.slow
def test_a_stiff_cloth_is_nearly_that_of_rigid_theory():
    """Rigid theory gives (.727, -.953, 0) and (-9.8, 27.7, 23.9): shear is the rest."""
    hit = collide(cushion(ratio=1000.0, e=(0.98, 0.1)))
    np.testing.assert_allclose(hit.velocity[0], [0.7323, -0.9562, 0.0049], atol=2e-3)
    np.testing.assert_allclose(hit.spin[0], [-8.7, 27.9, 23.4], atol=0.05)


@pytest.mark.slow
def test_the_table_of_the_guide_is_what_a_cushion_does():
    page = files("contactlab") / "guide" / "several-contacts.md"
    rows = re.findall(
        r"^\| (\d+) ((?:\| [\d.]+, [\d.]+ )+)\|$", page.read_text("utf-8"), re.MULTILINE
    )
    gaps = np.array([0.0, 1e-5, 1e-4, 1e-3])
    ball = Sphere(0.0286, Material(young_modulus=5e9, poisson_ratio=0.34, density=1700.0))
    moves = {"velocity": [1, 1, 0], "spin": np.array([-1, 1, 0]) / ball.radius}
    rubber = HalfSpace(Material(young_modulus=5e6, poisson_ratio=0.48))
    assert len(rows) == 3
    for ratio, told in rows:
        modulus = 5e6 / (1.0 - 0.48**2) * float(ratio) * (1.0 - 0.4**2)
        cloth = HalfSpace(Material(young_modulus=modulus, poisson_ratio=0.4))
        touches = [
            Touch(0, rubber, 0.14, normal=[0, 0.9165, 0.4], restitution=0.9),
            Touch(0, cloth, 0.2, normal=[0, 0, -1], restitution=0.5, gap=gaps),
        ]
        hit = collide(Gathering([Body(ball, **moves)], touches))
        numbers = np.reshape(re.findall(r"[\d.]+", told), (-1, 2)).astype(float)
        np.testing.assert_allclose(hit.velocity[:, 0, 1:] * [-1, 1], numbers, atol=6e-4)


@pytest.mark.slow
def test_a_ball_falls_on_two_that_lie():
    hit = collide(three_balls())
    assert hit["big"].velocity[2] == pytest.approx(0.904907, abs=USUAL)
    np.testing.assert_allclose(hit["left"].velocity, [-0.169425, 0.0, 0.368213], atol=USUAL)
    np.testing.assert_allclose(hit.spin[:2, 1], [25.856, -25.856], atol=0.03)
    mirrored = hit.velocity[0] * [-1.0, 1.0, 1.0]
    np.testing.assert_allclose(hit.velocity[1], mirrored, atol=1e-14)
    assert hit.touches[2] == 0.0
    assert np.isnan(hit.first_touch[2])
    assert any("touches[2] never closed" in str(each) for each in hit.plan.computed)


@pytest.mark.parametrize("speed", [0.4, pytest.param(1.2, marks=pytest.mark.slow)])
def test_a_plate_on_four_points_is_one_contact_of_a_point_mass(speed):
    body = RigidBody(mass=0.1, inertia=np.eye(3) * 1e-4, material=STEEL, curvature_radius=0.01)
    points = [[x, y, 0.0] for x in (-0.05, 0.05) for y in (-0.05, 0.05)]
    plate = Gathering(
        [Body(body, velocity=[speed, 0, -1])],
        [Touch(0, HalfSpace(STEEL), 0.3, normal=[0, 0, -1], contact=point) for point in points],
    )
    hit, kappa = collide(plate, laws(100, 400)), 1.4 / 1.7
    slip = np.linalg.norm(hit.psi2, axis=-1)
    np.testing.assert_allclose(slip, abs(rebound(kappa * speed / 0.3, 0.5 * kappa)), atol=1.5e-4)
    assert hit.velocity[0, 2] == pytest.approx(1.0, abs=1e-6)
    # four of a stiffness are one of four times as much: T goes as K^(-2/5)
    alone = 2.9432751 * (1.25 * 0.1 / (4.0 * 4.0 / 3.0 * 0.5 * 2.1e11 / 0.91 * 0.1)) ** 0.4
    np.testing.assert_allclose(hit.duration, alone, rtol=6e-3)


def test_a_tilted_block_lands_on_two_corners():
    inertia = np.eye(3) * 2.0 / 3.0 * 0.05**2
    rigid = Material(young_modulus=1e30, poisson_ratio=0.3)
    block = RigidBody(mass=1.0, inertia=inertia, material=rigid, curvature_radius=0.005)
    floor = half_space(1.1e11, 0.82)
    corners = [([-0.05, 0.0, -0.05], 8e-6), ([0.05, 0.0, -0.05], 0.0)]
    touches = [Touch(0, floor, 0.3, normal=[0, 0, -1], contact=c, gap=gap) for c, gap in corners]
    hit = collide(Gathering([Body(block, velocity=[0.5, 0, -1])], touches))
    np.testing.assert_allclose(hit.velocity[0], [-0.093441, 0.0, 1.068436], atol=USUAL)
    assert 0.05 * hit.spin[0, 1] == pytest.approx(0.05 * -2.2209, abs=USUAL)


@pytest.mark.parametrize("gap", [0.0, 3e-6, 1e-3])
def test_each_wall_of_a_corner_is_met_by_itself(gap):
    wall = HalfSpace(STEEL)
    touches = [
        Touch(0, wall, 0.0, normal=[1, 0, 0]),
        Touch(0, wall, 0.0, normal=[0, 1, 0], gap=gap),
    ]
    hit = collide(Gathering([Body(Sphere(0.01, STEEL), velocity=[1, 0.7, 0])], touches))
    np.testing.assert_allclose(hit.velocity[0], [-1.0, -0.7, 0.0], atol=2e-6)


@pytest.mark.slow
def test_a_wave_in_a_chain_is_that_of_nesterenko():
    chain = row(80)
    hit = collide(chain, history=True)
    forces, times = hit.history.normal_force, hit.history.time
    peak = [forces[:, k].max() for k in (40, 60)]
    tops = []
    for k in (40, 60):
        i = int(forces[:, k].argmax())
        y0, y1, y2 = forces[i - 1 : i + 2, k]
        step = times[i, k] - times[i - 1, k]
        tops.append(times[i, k] + 0.5 * step * (y0 - y2) / (y0 - 2.0 * y1 + y2))
    speed = 20 * 0.02 / (tops[1] - tops[0])
    assert peak[0] == pytest.approx(849.21, rel=2e-4)
    assert speed == pytest.approx(683.17, rel=2e-4)
    long_wave = (
        0.6802 * (2.0 * 2.1e11 / (0.02 * 7800.0**1.5 * 0.91)) ** (1 / 3) * peak[0] ** (1 / 6)
    )
    assert speed / long_wave == pytest.approx(1.01246, abs=3e-4)
    above = times[forces[:, 50] > 0.5 * peak[0], 50]
    assert (above[-1] - above[0]) * speed / 0.02 == pytest.approx(1.412, abs=0.01)


def test_a_gathering_tells_its_own_way_to_a_history_and_plain_numbers_of_energy():
    done = collide(three_balls())
    with pytest.raises(AttributeError, match=r"several contacts collide\(gathering, history=True"):
        _ = done.history.time
    assert "float64" not in repr(done.energy)
