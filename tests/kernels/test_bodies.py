"""Bodies of any shape in C under sanitizers, beside ``collide`` of rigid bodies."""

import subprocess

import numpy as np
import pytest

import contactlab
from contactlab import Encounter, HalfSpace, Material, RigidBody, Simulation, Sphere, collide
from tests.impact.test_inverse_mass import turned_poles
from tests.kernels.test_kernels import needs_c, program

pytestmark = needs_c
APART, TURNS, RANGE = 16, 17, 18
BODY = 13
MOTION = slice(31, 43)


@pytest.fixture(scope="module", params=["c99", pytest.param("c++", marks=pytest.mark.slow)])
def bounced(request, tmp_path_factory):
    """Return a function of rows (n, 43) and e, of statuses, motions (n, 12), V, T and times."""
    folder = tmp_path_factory.mktemp("bodies")
    built = program("bodies", request.param, folder)

    def run(rows, e=1.0):
        np.column_stack([rows, np.full(len(rows), e)]).tofile(folder / "in")
        subprocess.run([built, folder / "in", folder / "out"], check=True, timeout=600)
        answers = np.fromfile(folder / "out").reshape(-1, 16)
        return answers[:, 0].astype(int), answers[:, 1:13], answers[:, 13:]

    return run


def rotations(draw, count):
    """Return random rotations, shape (count, 3, 3)."""
    turned, _ = np.linalg.qr(draw.normal(size=(count, 3, 3)))
    return turned * np.sign(np.linalg.det(turned))[:, None, None]


def stiffness(*materials):
    compliances = [(each.poisson_ratio, each.shear_modulus) for each in materials]
    pressed = sum((1.0 - nu) / (2.0 * shear) for nu, shear in compliances)
    return pressed / sum((2.0 - nu) / (4.0 * shear) for nu, shear in compliances)


def planar(count, seed):
    """Return (rows, masses, inertias) of pairs that move in a plane of symmetry of both.

    In it x is the normal and y along the surface; then all is turned in space.
    """
    draw = np.random.default_rng(seed)
    masses = 10.0 ** draw.uniform(-2.0, 2.0, (2, count))
    size = 10.0 ** draw.uniform(-1.5, 0.5, (2, count))
    spread = np.zeros((2, count, 3, 3))  # of the masses
    inner = draw.normal(size=(2, count, 2, 2))
    spread[..., :2, :2] = inner @ inner.swapaxes(-1, -2) + 0.05 * np.eye(2)
    spread[..., 2, 2] = draw.uniform(0.0, 1.0, (2, count))
    spread *= (masses * size**2 * 10.0 ** draw.uniform(-2.5, -0.5, (2, count)))[..., None, None]
    inertias = np.trace(spread, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) - spread
    arms, speeds, spins = np.zeros((3, 2, count, 3))
    angle = draw.uniform(-1.2, 1.2, (2, count))
    arms[..., 0], arms[..., 1] = size * np.cos(angle), size * np.sin(angle)
    arms[1, :, 0] *= -1.0
    speeds[..., :2] = draw.normal(size=(2, count, 2))
    spins[..., 2] = draw.normal(size=(2, count)) / size
    turns = rotations(draw, count)
    turned = np.einsum("nij,knj->kni", turns, arms), np.einsum("nij,knj->kni", turns, speeds)
    turned += (np.einsum("nij,knj->kni", turns, spins),)
    inertias = np.einsum("nia,knab,njb->knij", turns, inertias, turns)
    inertias = 0.5 * (inertias + inertias.swapaxes(-1, -2))
    rows = np.zeros((count, 43))
    for k in (0, 1):
        rows[:, BODY * k] = masses[k]
        rows[:, BODY * k + 1 : BODY * k + 10] = np.linalg.inv(inertias[k]).reshape(count, 9)
        rows[:, BODY * k + 10 : BODY * k + 13] = turned[0][k]
        rows[:, 31 + 6 * k : 34 + 6 * k] = turned[1][k]
        rows[:, 34 + 6 * k : 37 + 6 * k] = turned[2][k]
    rows[:, 26] = 10.0 ** draw.uniform(-1.0, 0.3, count)
    rows[:, 28:31] = turns[..., 0]
    return rows, masses, inertias


def by_python(rows, masses, inertias, materials, simulation=None):
    """Return the motion after ``collide``, by the exact law followed to 1e-12."""
    bodies = [
        RigidBody(material=material, mass=mass, inertia=inertia, curvature_radius=0.1)
        for material, mass, inertia in zip(materials, masses, inertias, strict=True)
    ]
    encounter = Encounter(
        *bodies, rows[:, 26], normal=rows[:, 28:31], velocity=rows[:, 31:34], spin=rows[:, 34:37],
        target_velocity=rows[:, 37:40], target_spin=rows[:, 40:43], contact=rows[:, 10:13],
        target_contact=rows[:, 23:26],
    )  # fmt: skip
    law = contactlab.create("tangential.fronts", table=False)
    exact = Simulation(
        tangential=law, integrator=contactlab.create("integrator.events", tolerance=1e-12)
    )
    found = collide(encounter, simulation or exact, separating="pass")
    after = found.velocity, found.spin, found.target_velocity, found.target_spin
    return np.hstack(after), found


def test_planar_bodies_are_those_of_collide(bounced):
    steel, brass = Material.named("steel"), Material.named("brass")
    rows, masses, inertias = planar(60, 1)
    rows[:, 27] = stiffness(steel, brass)
    status, found, left = bounced(rows)
    expected, collision = by_python(rows, masses, inertias, (steel, brass))
    met = collision.collided
    assert 10 < met.sum() < 50
    assert (status == np.where(met, 0, APART)).all()
    assert np.array_equal(found[~met], rows[~met, MOTION])
    # of the impact's own size: light bodies are thrown by heavy ones
    scale = np.maximum(np.abs(rows[:, MOTION]).max(axis=1), np.abs(expected).max(axis=1))
    assert (np.abs(found - expected).max(axis=1) / scale).max() < 1e-11
    assert left[met, 2] == pytest.approx(collision.result.motion.compressions)


@pytest.mark.parametrize(
    ("count", "e"),
    [(3, 0.8), *(pytest.param(25, e, marks=pytest.mark.slow) for e in (0.98, 0.8, 0.3))],
)
def test_bodies_with_loss_are_those_of_collide(bounced, count, e):
    """Slip that keeps its line, and slip that turns; springs march in both, as many."""
    steel, brass = Material.named("steel"), Material.named("brass")
    rows, masses, inertias = planar(count, 11)
    rows[:, 26] = np.minimum(rows[:, 26], 0.8)  # no jams
    rows[:, 27] = stiffness(steel, brass)
    rows[::2, 31:34] += np.random.default_rng(12).normal(size=rows[::2, 31:34].shape)
    status, found, left = bounced(rows, e)
    sim = Simulation(
        normal=contactlab.create("normal.viscoelastic", restitution=e),
        tangential=contactlab.create("tangential.springs", springs=50),
        integrator=contactlab.create("integrator.symplectic", steps=200),
    )
    expected, collision = by_python(rows, masses, inertias, (steel, brass), sim)
    met = collision.collided
    assert (status == np.where(met, 0, APART)).all()
    scale = np.maximum(np.abs(rows[:, MOTION]).max(axis=1), np.abs(expected).max(axis=1))
    assert (np.abs(found - expected).max(axis=1) / scale)[met].max() < 1e-3
    motion, speed = collision.result.motion, collision.result.scene.normal_speed
    assert left[met, 0] == pytest.approx(motion.normal_velocity / speed, abs=1e-3)


def test_without_friction_the_restitution_is_that_of_the_contact(bounced):
    rows, _, _ = planar(60, 13)
    rows[:, 26], rows[:, 27] = 0.0, 0.83
    status, _, left = bounced(rows, 0.6)
    assert set(status) == {0, APART}
    assert left[status == 0, 0] == pytest.approx(-0.6)
    for e in (-0.1, 0.0, 1.1, np.nan):
        assert RANGE in bounced(rows[status == 0], e)[0]


def ball(nu, radius, mass):
    return Sphere(radius, Material(young_modulus=1e9, poisson_ratio=nu, density=1e3), mass=mass)


def test_spheres_are_those_of_collide(bounced):
    """Slip in any direction, spin about the normal that passes through, and a wall."""
    draw, count = np.random.default_rng(2), 30
    one, other = ball(0.3, 0.02, 0.1), ball(0.45, 0.05, 0.7)
    normal = rotations(draw, count)[..., 0]
    rows = np.zeros((count, 43))
    for k, (body, sense) in enumerate(((one, 1.0), (other, -1.0))):
        rows[:, BODY * k] = body.mass
        moment = body.mass * body.gyration_ratio**2 * body.radius**2
        rows[:, BODY * k + 1 : BODY * k + 10 : 4] = 1.0 / moment
        rows[:, BODY * k + 10 : BODY * k + 13] = sense * body.radius * normal
    rows[:, 26], rows[:, 27] = 0.4, stiffness(one.material, other.material)
    rows[:, 28:31] = 3.0 * normal
    rows[:, MOTION] = draw.normal(size=(count, 12)) * np.tile([2.0, 40.0], 2).repeat(3)
    rows[:, 31:34] += 6.0 * normal
    law = contactlab.create("tangential.fronts", table=False)
    exact = Simulation(
        tangential=law, integrator=contactlab.create("integrator.events", tolerance=1e-12)
    )
    for wall in (False, True):
        target = HalfSpace(other.material) if wall else other
        if wall:
            rows[:, BODY], rows[:, 40:43] = 0.0, 0.0
        given = {"velocity": rows[:, 31:34], "spin": rows[:, 34:37]}
        given |= {"target_velocity": rows[:, 37:40], "target_spin": rows[:, 40:43]}
        collision = collide(Encounter(one, target, 0.4, normal=normal, **given), exact)
        after = (getattr(collision, name) for name in given)
        status, found, _ = bounced(rows)
        assert not status.any()
        assert found == pytest.approx(np.hstack([*after]), abs=1e-10)  # spins are some 100 rad/s


def conserved(rows, moved, masses, inertias):
    """Return momentum, angular momentum about the contact, and energy, before and after."""
    out = []
    for motion in (rows[:, MOTION], moved):
        linear, angular, energy = 0.0, 0.0, 0.0
        for k in (0, 1):
            speed, spin = motion[:, 6 * k : 6 * k + 3], motion[:, 6 * k + 3 : 6 * k + 6]
            turning = np.einsum("nij,nj->ni", inertias[k], spin)
            push = masses[k][:, None] * speed
            linear = linear + push
            arm = rows[:, BODY * k + 10 : BODY * k + 13]
            angular = angular + turning - np.cross(arm, push)
            energy = energy + 0.5 * ((push * speed).sum(axis=1) + (turning * spin).sum(axis=1))
        out.append((linear, angular, energy))
    return out


@pytest.mark.parametrize("count", [300, pytest.param(100_000, marks=pytest.mark.slow)])
def test_momentum_is_kept_and_energy_never_grows(bounced, count):
    rows, masses, inertias = planar(count, 3)
    rows[:, 27] = 0.83
    rows[::3, 26] *= 5.0  # jams
    status, moved, left = bounced(rows)
    assert set(status) <= {0, APART, TURNS}
    assert (status == TURNS).mean() < 2e-3  # thin bodies: rounding turns their slip, as for collide
    kept = status != TURNS
    rows, masses, inertias = rows[kept], masses[:, kept], inertias[:, kept]
    moved, left, status = moved[kept], left[kept], status[kept]
    before, after = conserved(rows, moved, masses, inertias)
    scale = (
        np.abs(moved).max(axis=1) * masses.max(axis=0)
        + np.abs(rows[:, MOTION]).max(axis=1) * masses.max(axis=0)
    )[:, None]
    for first, second in zip(before[:2], after[:2], strict=True):
        assert (np.abs(first - second) / scale).max() < 1e-9
    assert (after[2] <= before[2] * (1.0 + 1e-10)).all()
    normal, parting = rows[:, 28:31], 0.0
    for k, sense in ((0, 1.0), (1, -1.0)):
        arm = rows[:, BODY * k + 10 : BODY * k + 13]
        speed, spin = moved[:, 6 * k : 6 * k + 3], moved[:, 6 * k + 3 : 6 * k + 6]
        parting = parting + sense * ((speed + np.cross(spin, arm)) * normal).sum(axis=1)
    assert (parting < 0.0).all()
    assert left[status == 0, 2].max() > 1.0


def test_what_has_no_answer_has_a_status_and_changes_nothing(bounced):
    rows, _, _ = planar(400, 5)
    rows[:, 27] = 0.83
    status, _, _ = bounced(rows)
    rows = rows[status == 0][:14]
    rows[0, 31:34] += np.cross(rows[0, 28:31], rows[0, 10:13])  # slip out of the plane
    rows[1, 11] += 0.3
    rows[2:5, 0] = -1.0, np.nan, 2e130
    rows[5, 26], rows[6, 27], rows[7, 28:31] = -0.1, np.nan, 0.0
    rows[8, 36], rows[9, 4], rows[10, 29] = np.inf, np.nan, np.inf
    rows[11, [0, BODY]], rows[12, 27], rows[13, 26] = 0.0, 0.0, np.inf
    status, found, _ = bounced(rows)
    assert status.tolist() == [TURNS] * 2 + [RANGE] * 12
    assert np.array_equal(found, rows[:, MOTION], equal_nan=True)


def test_the_unit_of_mass_and_the_order_of_bodies_do_not_matter(bounced):
    rows, _, _ = planar(200, 6)
    rows[:, 27] = 0.83
    status, found, _ = bounced(rows)
    rows, found = rows[status == 0], found[status == 0]
    for unit in (1e-120, 1e120):
        scaled = rows.copy()
        scaled[:, [0, BODY]] *= unit
        scaled[:, 1:10] /= unit
        scaled[:, BODY + 1 : BODY + 10] /= unit
        _, again, _ = bounced(scaled)
        assert again == pytest.approx(found, rel=1e-9, abs=1e-9)
    swapped = rows.copy()
    swapped[:, :BODY], swapped[:, BODY : 2 * BODY] = rows[:, BODY : 2 * BODY], rows[:, :BODY]
    swapped[:, 28:31] *= -1.0
    swapped[:, 31:37], swapped[:, 37:43] = rows[:, 37:43], rows[:, 31:37]
    _, again, _ = bounced(swapped)
    assert again[:, :6] == pytest.approx(found[:, 6:], rel=1e-9, abs=1e-9)


def test_a_slip_that_is_rounding_turns_by_nothing(bounced):
    encounter, rows = turned_poles(60, 1e-9, 0.0), np.zeros((60, BODY * 2 + 2 + 15))
    rows[:, 0], rows[:, 26], rows[:, 27] = encounter.body.mass, 0.3, 0.8
    rows[:, 1:10] = np.linalg.inv(encounter.body.inertia).reshape(60, 9)
    rows[:, 10:13], rows[:, 28:31] = encounter.contact, encounter.normal
    rows[:, 31:34] = encounter.velocity
    status, moved, _ = bounced(rows)
    assert not status.any()
    assert moved[:, :3] == pytest.approx(-encounter.velocity, abs=1e-8)


def test_without_friction_any_two_bodies_rebound(bounced):
    """The rate of approach turns round; slip may lie across."""
    rows, masses, inertias = planar(100, 7)
    rows[:, 31:34] += np.random.default_rng(8).normal(size=(100, 3))
    rows[:, 26], rows[:, 27] = 0.0, 0.83
    status, moved, _ = bounced(rows)
    assert set(status) == {0, APART}
    before, after = conserved(rows, moved, masses, inertias)
    assert after[2] == pytest.approx(before[2], rel=1e-11)
    met = status == 0
    assert np.abs(moved[met] - rows[met, MOTION]).max() > 0.1
