"""Eccentric impacts: theory §14's closed forms, reference values, invariants and rigid limits."""

import math
from concurrent.futures import ThreadPoolExecutor

import attrs
import numpy as np
import pytest

from contactlab import (
    Encounter,
    HalfSpace,
    Material,
    RigidBody,
    Scene,
    Simulation,
    Sphere,
    Status,
    collide,
    create,
)
from contactlab.runs import sweep as sweeping
from tests.longer import longer

STEEL = Material.named("steel")
FLOOR = HalfSpace(STEEL)
EXACT, RIGID = Simulation(), Simulation(tangential="coulomb")
planar = Scene.nondimensional


def springs(count, steps, **options):
    return Simulation(
        tangential=create("tangential.springs", springs=count),
        integrator=create("integrator.symplectic", steps=steps),
        **options,
    )


def rod(degrees, *, slip=0.0, friction=0.3, across=0.0, spin=(0.0, 0.0, 0.0)):
    """Return a uniform rod (1 kg, 1 m) struck on its end; the normal points down.

    At a positive angle the contact lies at -(sin, 0, cos)/2, so that lam > 0 for slip along x.
    """
    angle = math.radians(degrees)
    axis = np.array([math.sin(angle), 0.0, math.cos(angle)])
    inertia = (np.eye(3) - np.outer(axis, axis)) / 12.0 + 1e-4 * np.outer(axis, axis)
    body = RigidBody(mass=1.0, inertia=inertia, material=STEEL, curvature_radius=0.01)
    return Encounter(
        body, FLOOR, friction, normal=(0, 0, -1), velocity=(slip, across, -1.0), spin=spin,
        contact=-axis / 2.0,
    )  # fmt: skip


#: Theory §14, three programs apart by at most 1e-7, the digits of the exact one: V2 and psi2 along
#: the direction in which lam is positive for a positive angle.
PAINLEVE = -math.degrees(math.atan(0.5))
RODS = [
    (15.0, 0.0, 0.3, -0.924424232, 0.017427581),
    (30.0, 0.0, 0.3, -0.914173623, -2.052451847),
    (30.0, 0.5, 0.3, -0.826117112, -2.441775292),
    (-30.0, 0.5, 0.3, -1.0, 2.680383827),
    (PAINLEVE, 4.0, 2.0, -2.730483064, -0.238256699),
]


@pytest.mark.parametrize(("angle", "slip", "friction", "rate", "psi2"), RODS)
def test_the_rods_of_the_theory(angle, slip, friction, rate, psi2):
    """t1 points to where pressure drags the contact: against x for an angle below zero."""
    scene = rod(angle, slip=slip, friction=friction).scene
    result = EXACT.run(scene).check()
    along = math.copysign(1.0, angle)
    assert result.normal_velocity == pytest.approx(rate, abs=1e-8)
    assert along * result.psi2 == pytest.approx(psi2, abs=1e-8)
    assert result.energy.relative_imbalance == pytest.approx(0.0, abs=1e-9)
    rough = springs(50, 200).run(scene).check()
    assert rough.normal_velocity == pytest.approx(rate, abs=1e-3)
    assert along * rough.psi2 == pytest.approx(psi2, abs=1e-3)


def test_the_wedge_and_the_ball_of_the_theory():
    material = Material(young_modulus=1e9, poisson_ratio=0.45)
    wedge = RigidBody(
        mass=0.30, principal=(3e-4, 3e-4, 3e-4), material=material, curvature_radius=math.inf
    )
    ball = Sphere(0.0213, material, mass=0.04593)
    met = Encounter(
        wedge, ball, 0.4, normal=(1, 0, 0), velocity=(1.0, 1.0, 0.0), contact=(0.018, -0.010, 0.0)
    )
    result = EXACT.run(met.scene).check()
    assert result.scene.planar
    along = math.copysign(1.0, float(result.psi1))
    assert result.normal_velocity == pytest.approx(-0.995238203, abs=1e-8)
    assert along * result.psi2 == pytest.approx(-1.112262048, abs=1e-8)


def random_planar(count, seed, *, most=3.0):
    """Return random planar scenes with abs(lam) below ``most``; a third of them may jam."""
    rng = np.random.default_rng(seed)
    chi = np.exp(rng.uniform(math.log(0.2), math.log(8.0), count))
    lam = rng.uniform(-most, most, count)
    eta = 0.98 * rng.uniform(0.0, 1.0, count) * 2.0 * chi / lam
    return planar(psi1=rng.uniform(-6.0, 6.0, count), chi=chi, lam=lam, eta=eta)


def test_beside_no_coupling_the_exact_law_is_the_spheres():
    """At the border one way of solving ends and the other begins: nothing jumps."""
    rng = np.random.default_rng(2)
    psi1, chi = rng.uniform(-7.0, 7.0, 60), np.exp(rng.uniform(-1.2, 2.0, 60))
    result = EXACT.run(planar(psi1=psi1, chi=chi, lam=1e-11, eta=1e-11)).check()
    assert np.asarray(result.scene.inverse_mass)[:, 0, 1].all()
    followed = Simulation(
        tangential=create("tangential.fronts", table=False),
        integrator=create("integrator.events", tolerance=1e-12),
    )
    exact = followed.run(Scene.nondimensional(psi1=psi1, chi=chi)).check()
    assert np.abs(result.psi2 - exact.psi2).max() < 1e-10
    assert np.abs(result.normal_velocity + 1.0).max() < 1e-10
    spheres = EXACT.run(planar(psi1=psi1, chi=chi, lam=0.0)).check()
    assert np.abs(result.psi2 - spheres.psi2).max() < 1e-9


def test_springs_agree_with_the_exact_law_in_time_depth_and_work():
    scene = random_planar(12, 17, most=0.9)
    exact, rough = EXACT.run(scene).check(), springs(50, 400).run(scene).check()
    for name in ("duration", "maximum_approach", "maximum_force", "maximum_radius"):
        found, expected = (getattr(each.motion, name) for each in (rough, exact))
        room = 1e-4 if name == "duration" else 3e-3
        assert np.abs(found / expected - 1.0).max() < room, name
    work = rough.motion.friction_work / exact.energy.start
    expected = exact.motion.friction_work / exact.energy.start
    assert np.abs(work - expected).max() < 3e-3


def slip_throughout(count, seed):
    """Return scenes that slip throughout, and psi2 of their closed form."""
    rng = np.random.default_rng(seed)
    chi, lam = rng.uniform(0.3, 3.0, count), rng.uniform(-0.9, 2.0, count)
    eta = 0.95 * rng.uniform(0.0, 1.0, count) * 2.0 * chi / lam
    k = (2.0 * chi + eta) / (1.0 + lam)
    psi1 = np.maximum(1.0, 2.0 * k - 1.0) * (1.0 + rng.uniform(0.001, 2.0, count))
    return planar(psi1=psi1, chi=chi, lam=lam, eta=eta), psi1 - 2.0 * k


def test_slip_throughout_is_a_closed_form():
    scene, psi2 = slip_throughout(200, 3)
    result = EXACT.run(scene).check()
    assert np.abs(result.normal_velocity + 1.0).max() < 1e-12
    assert np.abs(result.psi2 / psi2 - 1.0).max() < 1e-11
    rough = springs(12, 400).run(scene).check()
    assert np.abs(rough.normal_velocity + 1.0).max() < 1e-3


@pytest.mark.slow
def test_slip_throughout_by_many_springs():
    scene, psi2 = slip_throughout(50, 4)
    fine = springs(400, 4000).run(scene).check()
    assert np.abs(fine.normal_velocity + 1.0).max() < 1e-6
    assert np.abs(fine.psi2 - psi2).max() < 1e-6 * np.abs(psi2).max()


def test_no_friction_is_a_closed_form():
    """V2 = -1, and pressure drags the contact by 2 W_nt/W_nn of the speed."""
    met = attrs.evolve(rod(30.0), friction_coefficient=0.0)
    for simulation in (EXACT, springs(10, 400)):
        result = simulation.run(met.scene).check()
        W = result.scene.inverse_mass
        assert result.normal_velocity == pytest.approx(-1.0, abs=1e-4)
        assert result.rebound_slip_velocity == pytest.approx(-2.0 * W[0, 1] / W[0, 0], rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("scene", [random_planar(20, 6), random_planar(20, 6).take(3)])
def test_without_friction_pressure_alone_drags_the_surfaces(scene):
    """V2 = -e and psi2 = psi1 - (1 + e) eta under any normal law; a stepped law agrees."""
    for e in (1.0, 0.6):
        normal = create("normal.tsuji", restitution=e) if e < 1.0 else "hertz"
        result = Simulation(normal=normal, tangential="frictionless").run(scene).check()
        assert result.normal_velocity == pytest.approx(-e, abs=1e-9)
        assert result.psi2 == pytest.approx(scene.psi1 - (1.0 + e) * scene.eta, rel=1e-9)
        assert np.all(result.energy.friction_work == 0.0)
        smooth = attrs.evolve(scene, friction_coefficient=1e-9 * scene.friction_coefficient)
        marched = Simulation(normal=normal, tangential="springs", integrator="symplectic")
        slip = marched.run(smooth).check().rebound_slip_velocity
        assert result.rebound_slip_velocity == pytest.approx(slip, rel=1e-3, abs=1e-6)


def test_no_impact_gains_energy_and_the_books_close():
    scene = random_planar(50, 5)
    exact = EXACT.run(scene).check()
    assert (exact.energy.end <= exact.energy.start).all()
    assert np.abs(exact.energy.relative_imbalance).max() < 1e-9
    # fifty steps leave the energy of the approach at 1e-4
    rough = springs(12, 50).run(random_planar(500, 6)).check()
    assert (rough.energy.end <= rough.energy.start * (1.0 + 1e-4)).all()
    assert (rough.energy.end > rough.energy.start).mean() < 2e-3
    fine = springs(100, 400).run(scene).check()
    assert np.abs(fine.energy.relative_imbalance).max() < 1e-4
    assert np.median(np.abs(fine.psi2 - exact.psi2)) < 1e-4


def random_in_space(count, seed):
    """Return scenes of random positive definite W, of condition up to 100."""
    rng = np.random.default_rng(seed)
    axes = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    values = np.exp(rng.uniform(0.0, math.log(100.0), (count, 3)))
    W = np.einsum("nij,nj,nkj->nik", axes, values, axes)
    W /= W[:, :1, :1]
    mu = rng.uniform(0.1, 1.0, count)
    mu *= np.minimum(1.0, 3.0 / (mu * np.hypot(W[:, 0, 1], W[:, 0, 2])))
    lam = mu[:, None] * W[:, 0, 1:]
    return Scene.nondimensional(
        psi1=rng.uniform(-3.0, 3.0, (count, 2)), chi=0.5 * W[:, 1:, 1:], lam=lam, rho=mu * mu
    )


def test_in_space_no_impact_gains_energy():
    rough = springs(12, 50).run(random_in_space(600, 7)).check()
    assert (rough.energy.end <= rough.energy.start).all()
    fine = springs(50, 200).run(random_in_space(30, 8)).check()
    assert np.abs(fine.energy.relative_imbalance).max() < 1e-3


@pytest.mark.slow
def test_of_a_hundred_thousand_impacts_none_gains_energy():
    rough = springs(12, 50).run(random_in_space(100_000, 9)).check()
    assert (rough.energy.end <= rough.energy.start).all()


def test_in_space_the_steps_are_of_second_order_where_slip_turns():
    encounter = rod(-35.0, slip=0.3, across=0.6)
    scene = encounter.scene
    assert not scene.planar
    answers = {
        steps: np.append(result.psi2, result.normal_velocity)
        for steps in (100, 200, 400, 800)
        for result in [springs(60, steps).run(scene).check()]
    }
    steps = np.log([100, 200, 400])
    errors = [np.abs(answers[each] - answers[800]).max() for each in (100, 200, 400)]
    assert -np.polyfit(steps, np.log(errors), 1)[0] > 1.8
    # the springs' own limit, theory §14; there r = (sin 35°, 0, -cos 35°)/2 and lam < 0
    fine = springs(100, 1000).run(scene).check()
    assert fine.normal_velocity == pytest.approx(-0.953597, abs=2e-5)
    t1 = np.sign(scene.psi1[0])
    assert t1 * fine.psi2[0] == pytest.approx(2.967245, abs=1e-4)
    assert abs(fine.psi2[1]) == pytest.approx(0.039106, abs=1e-4)


def rotation(seed):
    matrix = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return matrix * np.linalg.det(matrix)


def test_a_rotation_of_the_frame_rotates_the_answer():
    turn = rotation(1)
    for met, laws in ((rod(30.0, slip=0.5), EXACT), (rod(35.0, slip=0.3, across=0.6), None)):
        body = attrs.evolve(met.body, inertia=turn @ met.body.inertia @ turn.T)
        turned = Encounter(
            body, FLOOR, 0.3, normal=turn @ met.normal, velocity=turn @ met.velocity,
            contact=turn @ met.contact,
        )  # fmt: skip
        one, other = collide(met, laws), collide(turned, laws)
        assert other.velocity == pytest.approx(turn @ one.velocity, abs=1e-11)
        assert other.spin == pytest.approx(turn @ one.spin, abs=1e-10)


def two_bodies(count, seed):
    """Return random pairs of bodies that meet."""
    rng = np.random.default_rng(seed)

    def body():
        axes = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
        return RigidBody(
            mass=rng.uniform(0.1, 3.0, count), principal=0.05 * rng.uniform(0.5, 1.0, (count, 3)),
            axes=axes, material=STEEL, curvature_radius=rng.uniform(0.5, 1.0, count),
        )  # fmt: skip

    normal = rng.normal(size=(count, 3))
    normal /= np.linalg.norm(normal, axis=-1)[:, None]
    return Encounter(
        body(), body(), 0.4, normal=normal,
        velocity=normal + 0.3 * rng.normal(size=(count, 3)), spin=rng.normal(size=(count, 3)),
        target_velocity=0.1 * rng.normal(size=(count, 3)), target_spin=rng.normal(size=(count, 3)),
        contact=0.2 * normal + 0.1 * rng.normal(size=(count, 3)),
        target_contact=-0.2 * normal + 0.1 * rng.normal(size=(count, 3)),
    )  # fmt: skip


def momenta(met, made):
    """Return momentum and angular momentum about the contact, after less before."""
    changes = []
    for name, body, arm in (
        ("", met.body, met.contact), ("target_", met.target, met.target_contact),
    ):  # fmt: skip
        push = body.mass[:, None] * (
            getattr(made, f"{name}velocity") - getattr(met, f"{name}velocity")
        )
        turn = getattr(made, f"{name}spin") - getattr(met, f"{name}spin")
        spin = np.einsum("nij,nj->ni", body.inertia, turn)
        changes.append((push, spin - np.cross(arm, push)))
    return [first + second for first, second in zip(*changes, strict=True)]


def test_momentum_and_angular_momentum_are_kept_and_bodies_may_be_exchanged():
    met = two_bodies(60, 10)
    laws = springs(12, 60)
    made = collide(met, laws, separating="pass")
    assert all(np.abs(each).max() < 1e-12 for each in momenta(met, made))
    other = Encounter(
        met.target, met.body, 0.4, normal=-met.normal, velocity=met.target_velocity,
        spin=met.target_spin, target_velocity=met.velocity, target_spin=met.spin,
        contact=met.target_contact, target_contact=met.contact,
    )  # fmt: skip
    back = collide(other, laws, separating="pass")
    assert np.abs(back.target_velocity - made.velocity).max() < 1e-11
    assert np.abs(back.spin - made.target_spin).max() < 1e-9
    energy = made.energy
    lost = sum(
        0.5 * body.mass * ((before**2).sum(-1) - (after**2).sum(-1))
        + 0.5 * np.einsum("ni,nij,nj->n", w0, body.inertia, w0)
        - 0.5 * np.einsum("ni,nij,nj->n", w1, body.inertia, w1)
        for body, before, after, w0, w1 in (
            (met.body, met.velocity, made.velocity, met.spin, made.spin),
            (met.target, met.target_velocity, made.target_velocity, met.target_spin,
             made.target_spin),
        )
    )  # fmt: skip
    assert lost[made.collided] == pytest.approx(energy.start - energy.end, abs=1e-11)


def as_bodies(met):
    """Return the spheres of an encounter as bodies with tensors and contacts."""
    normal = met.normal / np.linalg.norm(met.normal, axis=-1)[..., None]
    bodies = []
    for ball, sense in ((met.body, 1.0), (met.target, -1.0)):
        inertia = ball.mass * ball.gyration_ratio**2 * ball.radius**2 * np.ones(3)
        body = RigidBody(
            mass=ball.mass, principal=inertia, material=STEEL, curvature_radius=ball.radius
        )
        bodies.append((body, sense * ball.radius * normal))
    (body, contact), (target, target_contact) = bodies
    return Encounter(
        body, target, met.friction_coefficient, normal=met.normal, velocity=met.velocity,
        spin=met.spin, target_velocity=met.target_velocity, target_spin=met.target_spin,
        contact=contact, target_contact=target_contact,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("separating", "shape"),
    [("pass", (6,)), ("pass", (1, 2, 3)), ("refuse", (2, 3)),
     *longer(("pass", (2, 3)), ("refuse", (6,)), ("refuse", (1, 2, 3)))],
)  # fmt: skip
def test_batches_of_every_shape_collide_as_their_pairs(shape, separating):
    pairs = two_bodies(6, 14)
    if separating == "refuse":
        pairs = attrs.evolve(pairs, velocity=pairs.velocity + 3.0 * pairs.normal)
    place = np.arange(6).reshape(shape)
    laws = springs(8, 40)
    made = collide(pairs.take(place), laws, separating=separating)
    assert made.velocity.shape == (*shape, 3)
    for k, where in enumerate(np.ndindex(shape)):
        alone = collide(pairs.take(slice(k, k + 1)), laws, separating="pass")
        assert made.velocity[where] == pytest.approx(alone.velocity[0], abs=1e-12)
        assert made.target_spin[where] == pytest.approx(alone.target_spin[0], abs=1e-11)
        assert made.status[where] is Status.SUCCESS


def test_spheres_as_bodies_collide_as_spheres():
    rng = np.random.default_rng(11)
    one, other = Sphere(0.01, STEEL), Sphere(0.02, STEEL)
    normal = rng.normal(size=(200, 3))
    met = Encounter(
        one, other, 0.2, normal=normal,
        velocity=normal + 0.5 * rng.normal(size=(200, 3)),
        spin=30.0 * rng.normal(size=(200, 3)), target_spin=30.0 * rng.normal(size=(200, 3)),
    )  # fmt: skip
    expected = collide(met, separating="pass")
    made = collide(as_bodies(met), separating="pass")
    for name in ("velocity", "target_velocity", "spin", "target_spin"):
        size = np.abs(getattr(expected, name)).max()
        assert np.abs(getattr(made, name) - getattr(expected, name)).max() < 1e-9 * size


def test_spheres_down_the_path_of_bodies_answer_as_spheres():
    """In space, by springs; the scene is told that its motion need not stay in a plane."""
    rng = np.random.default_rng(12)
    psi1, chi = rng.uniform(0.0, 5.0, 60), rng.uniform(0.8, 1.8, 60)
    turn = rng.uniform(0.0, 2.0 * np.pi, 60)
    slip = psi1[:, None] * np.stack((np.cos(turn), np.sin(turn)), axis=-1)
    mu = 0.3
    scene = Scene.nondimensional(
        psi1=slip, chi=chi[:, None, None] * np.eye(2), lam=np.zeros((60, 2)), rho=mu * mu
    )
    result = springs(100, 400).run(scene).check()
    from contactlab import rebound

    expected = rebound(psi1, chi)[:, None] * slip / psi1[:, None]
    assert np.abs(result.normal_velocity + 1.0).max() < 1e-4
    assert mu * np.abs(result.psi2 - expected).max() < 1e-4


def rigid_rod(degrees, friction, slip, kappa):
    """Return the rod of ``rod`` with a stiffness ratio of its own."""
    a, b = math.sin(math.radians(degrees)) / 2.0, math.cos(math.radians(degrees)) / 2.0
    W_nn, W_tt, W_nt = 1.0 + 12.0 * a * a, 1.0 + 12.0 * b * b, 12.0 * a * b
    return planar(
        psi1=kappa * slip / friction, chi=0.5 * kappa * W_tt / W_nn,
        lam=friction * W_nt / W_nn, eta=kappa * W_nt / (friction * W_nn),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("angle", "friction", "slip"),
    [(30, 0.3, 0.0), (-30, 0.3, 0.5), (30, 0.3, 0.5), (60, 0.2, 0.3),
     *longer((15, 0.3, 0.0), (PAINLEVE, 2, 4))],
)  # fmt: skip
def test_stiff_contacts_tend_to_rouths_construction(angle, friction, slip):
    """The distance falls as the root of 1/kappa, or faster."""
    apart = []
    for kappa in (1e4, 1e5):
        scene = rigid_rod(angle, friction, slip, kappa)
        soft, hard = EXACT.run(scene).check(), RIGID.run(scene).check()
        change = friction * (soft.psi2 - hard.psi2) / kappa
        apart.append(math.hypot(soft.normal_velocity - hard.normal_velocity, change))
        assert hard.energy.relative_imbalance == pytest.approx(0.0, abs=1e-12)
    assert apart[0] < 6e-3
    assert apart[1] < 0.36 * apart[0] + 1e-12


def test_rouths_construction_by_hand():
    """A rod of 30° that is dropped: slip one way all through, as friction cannot hold it."""
    scene = rigid_rod(30, 0.3, 0.0, 1.0)
    W = np.array([[1.75, 12 * math.sqrt(3) / 16], [12 * math.sqrt(3) / 16, 3.25]])
    fall, drag = W[0, 0] - 0.3 * W[0, 1], W[0, 1] - 0.3 * W[1, 1]
    result = RIGID.run(scene).check()
    assert result.normal_velocity == pytest.approx(-1.0)
    assert result.psi2 * 0.3 == pytest.approx(-2.0 * drag / fall)


def test_keller_in_space_is_the_limit_of_stiff_contacts():
    kappa, mu = 1e3, 0.3
    scene = Scene.nondimensional(
        psi1=np.array((1.0, 2.0)) * kappa, chi=np.diag((0.7582, 1.00655)) * kappa,
        lam=(-0.212817, 0.0), rho=mu * mu / kappa,
    )  # fmt: skip
    rigid, soft = RIGID.run(scene).check(), springs(40, 2000).run(scene).check()
    assert soft.normal_velocity == pytest.approx(rigid.normal_velocity, abs=1e-4)
    assert mu * np.abs(soft.psi2 - rigid.psi2).max() / kappa < 2e-4


@pytest.mark.slow
def test_a_damped_law_marches_with_friction():
    """Without friction the restitution of a body is that of the law."""
    for laws in ("tsuji", "hunt_crossley"):
        simulation = springs(20, 400, normal=create(f"normal.{laws}", restitution=0.7))
        smooth = attrs.evolve(rod(30.0), friction_coefficient=0.0)
        assert simulation.run(smooth.scene).check().normal_restitution == pytest.approx(
            0.7, abs=2e-3
        )
    made = collide(rod(30.0), restitution=0.7)
    assert made.result.normal_restitution < 0.75
    assert "frictionless impact" in str(made.plan)
    assert abs(made.energy.relative_imbalance) < 1e-3


def test_history_and_summary():
    result = EXACT.run(rod(PAINLEVE, slip=4.0, friction=2.0).scene, history=True).check()
    history = result.history
    assert (np.diff(history.time) >= 0.0).all()
    assert history.normal_force.max() == pytest.approx(result.motion.maximum_force, rel=0.02)
    # friction presses the bodies together: the approach grows at first
    assert history.normal_velocity.max() > 1.2 * result.scene.normal_speed
    limit = 2.0 * history.normal_force
    assert (np.abs(history.tangential_force) <= limit * (1.0 + 1e-9) + 1e-6).all()
    marched = springs(30, 200).run(rod(30.0).scene, history=True)
    assert marched.history.slip_velocity.shape == (marched.counters["steps"],)
    turning = springs(30, 200).run(rod(30.0, across=0.5).scene, history=True)
    assert turning.history.slip_velocity.shape == (turning.counters["steps"], 2)
    assert [*turning.history.columns()][-2:] == ["tangential_force_1", "tangential_force_2"]
    assert "SUCCESS" in repr(result)
    assert result.check() is result


@pytest.mark.parametrize(
    "scene",
    [rod(30.0, slip=0.5).scene, planar(psi1=2.0, chi=3.0, lam=0.3, eta=0.2)],
    ids=["a rod", "a slip that needs more steps than the approach"],
)
def test_the_adaptive_integrator_keeps_its_tolerance(scene):
    simulation = Simulation(
        tangential=create("tangential.springs", springs=400),
        integrator=create("integrator.adaptive", tolerance=1e-5),
    )
    result = simulation.run(scene).check()
    assert result.psi2 == pytest.approx(EXACT.run(scene).psi2, abs=2e-4)


@pytest.mark.parametrize("integrator", ["symplectic", "adaptive"])
def test_an_impact_that_needs_too_many_steps_costs_its_batch_nothing(integrator):
    """The second is so stiff along the surface that 10^9 steps would be needed."""
    scene = Scene.nondimensional(
        psi1=np.array([1.0, 1.0, 2.0]), chi=np.array([0.8, 1e14, 0.8]), lam=0.2, eta=2.0
    )
    simulation = Simulation(tangential="springs", integrator=integrator)
    result = simulation.run(scene)
    assert list(result.status) == [Status.SUCCESS, Status.TOO_FEW_STEPS, Status.SUCCESS]
    assert "needs at least" in result.failures[1]
    assert np.isnan(result.psi2[1])
    for place in (0, 2):
        alone = simulation.run(scene.take(place))
        assert result.psi2[place] == pytest.approx(alone.psi2, abs=1e-9)
        assert alone.counters["steps"] > 0
    assert simulation.run(scene.take(1)).status is Status.TOO_FEW_STEPS


@pytest.mark.parametrize(
    ("lam", "left", "told"),
    [(0.9, 1e-5, None), (3.0, 0.2, None), (3.0, 0.05, 0.07),
     *longer((-2.0, 0.004, 0.4), (8.0, 5e-4, 1.2))],
)  # fmt: skip
def test_steps_caution_where_friction_jams_and_the_mass_is_nearly_singular(lam, left, told):
    """``left`` is 1 - W_nt²/(W_nn W_tt); the exact law has no such caution."""
    chi, psi1 = np.geomspace(0.5, 10.0, 12), np.linspace(-5.0, 5.0, 12)
    scene = planar(psi1=psi1, chi=chi, lam=lam, eta=(1.0 - left) * 2.0 * chi / lam)
    law = springs(50, 200)
    found = [str(each) for each in law.plan(scene).cautions if "singular" in str(each)]
    assert [f"up to {told:g};" in each for each in found] == [True] * (told is not None)
    exact, rough = EXACT.run(scene).check(), law.run(scene)
    assert not any("singular" in str(each) for each in exact.plan.cautions)
    off = np.abs(rough.normal_velocity - exact.normal_velocity) / np.maximum(
        1.0, np.abs(exact.normal_velocity)
    )
    assert np.nanmax(off) < (told or 0.03)


@pytest.mark.parametrize("count", [50, *longer(150)])
def test_exact_impacts_side_by_side_answer_as_alone(count):
    """Alone and with a history gross slip is timed step by step, in a batch as Hertz's motion."""
    scene = random_planar(count, 31)
    together = EXACT.run(scene).check()
    for place, one in enumerate(together):
        alone = EXACT.run(scene.take(place), history=place % 2 == 0).check()
        for name in ("psi2", "normal_velocity"):
            assert getattr(one, name) == pytest.approx(getattr(alone, name), rel=1e-9)
        for name in ("duration", "friction_work", "maximum_approach"):
            value = getattr(one.motion, name)
            assert value == pytest.approx(getattr(alone.motion, name), rel=1e-8, abs=1e-12)


HARD = [
    # psi1, chi, lam, lam eta over 2 chi
    (1e6, 0.5, -1000.0, 0.99), (1e6, 3.0, -1000.0, 0.99),
    *longer((1e6, 3.0, -30.0, 0.9999)),
    (20.0, 0.5, -1000.0, 0.99), (1e6, 0.5, 2.0, 1.0 - 1e-6), (1e-12, 0.5, 1000.0, 0.99),
]  # fmt: skip


@pytest.mark.parametrize(("psi1", "chi", "lam", "share"), HARD)
def test_jams_of_bodies_that_hardly_move_end_with_balanced_books_or_a_status(psi1, chi, lam, share):
    """Jams at up to 1e9 times the speed of approach ended never, or with twice the energy."""
    scene = planar(psi1=psi1, chi=chi, lam=lam, eta=share * 2.0 * chi / lam)
    for simulation in (EXACT, Simulation(tangential="springs")):
        result = simulation.run(scene)
        if result.status is Status.SUCCESS:
            assert result.energy.end <= result.energy.start * (1.0 + 1e-3)
            assert abs(result.energy.relative_imbalance) < 0.06
        else:
            assert math.isnan(result.psi2)
            assert result.status in (Status.UNRESOLVED, Status.UNBALANCED)


def test_a_stopped_sweep_keeps_what_is_done_and_resumes_on_other_workers(tmp_path, monkeypatch):
    monkeypatch.setattr(sweeping, "block_for", lambda *_: 1000)
    scene, folder = random_planar(2500, 15), tmp_path / "kept"

    def stop(done, total):
        assert total == 2500
        raise KeyboardInterrupt

    stopped = RIGID.sweep(scene, progress=stop, keep=folder, return_partial=True)
    assert [each is Status.INTERRUPTED for each in stopped.status[[0, 999, 1000, -1]]] == [
        False, False, True, True,
    ]  # fmt: skip
    whole = RIGID.run(scene).check()
    assert stopped.psi2[:1000] == pytest.approx(whole.psi2[:1000], rel=1e-15)
    assert np.isnan(stopped.psi2[1000:]).all()
    counts = []
    with ThreadPoolExecutor(2) as executor:
        resumed = RIGID.sweep(
            scene, keep=folder, executor=executor, progress=lambda done, _: counts.append(done)
        )
    assert len(counts) == 2
    for name in ("psi2", "normal_velocity"):
        assert (getattr(resumed.check(), name) == getattr(whole, name)).all()
    with pytest.raises(ValueError, match="another sweep"):
        RIGID.sweep(random_planar(2500, 16), keep=folder)


@pytest.mark.parametrize(
    "name", ["linear_spring", "mindlin_cap", "mindlin_deresiewicz", "thornton_yin"]
)
def test_laws_that_need_no_future_run_in_the_plane(name):
    result = Simulation(tangential=name).run(rod(30.0, slip=2.0).scene).check()
    throughout = EXACT.run(rod(-30.0, slip=0.5).scene)
    assert result.normal_velocity == pytest.approx(-1.0, abs=0.3)
    slipping = Simulation(tangential=name).run(rod(-30.0, slip=0.5).scene).check()
    assert slipping.normal_velocity == pytest.approx(throughout.normal_velocity, abs=0.02)
    assert slipping.psi2 == pytest.approx(throughout.psi2, abs=0.05)


REFUSED = [
    (lambda: RigidBody(mass=1.0, material=STEEL, curvature_radius=1.0), "inertia"),
    (lambda: RigidBody(mass=1.0, inertia=np.diag((1.0, 1.0, 3.0)), material=STEEL,
                       curvature_radius=1.0), "no body has it"),
    (lambda: RigidBody(mass=1.0, inertia=np.diag((1.0, 1.0, -0.5)), material=STEEL,
                       curvature_radius=1.0), "positive definite"),
    (lambda: RigidBody(mass=1.0, inertia=[[1, 0.5, 0], [0, 1, 0], [0, 0, 1]], material=STEEL,
                       curvature_radius=1.0), "symmetric"),
    (lambda: RigidBody(mass=1.0, inertia=np.eye(2), material=STEEL, curvature_radius=1.0),
     "inertia.shape"),
    (lambda: RigidBody(mass=-1.0, inertia=np.eye(3), material=STEEL, curvature_radius=1.0), "mass"),
    (lambda: RigidBody(mass=1.0, principal=(1, 1, 1), axes=np.ones((3, 3)), material=STEEL,
                       curvature_radius=1.0), "axes"),
    (lambda: attrs.evolve(rod(30.0), contact=(0, 0, 0)), "contact"),
    (lambda: Encounter(Sphere(0.01, STEEL), FLOOR, 0.1, normal=(0, 0, -1), velocity=(0, 0, -1),
                       contact=(0, 0, -0.01)), "belongs to a RigidBody"),
    (lambda: collide(attrs.evolve(rod(30.0), body=attrs.evolve(
        rod(30.0).body, curvature_radius=math.inf))), "curved"),
    (lambda: planar(psi1=1.0, chi=1.0, lam=2.0, eta=1.5), "lam eta"),
    (lambda: planar(psi1=1.0, chi=1.0, lam=1.0, eta=-1.0), "lam"),
    (lambda: planar(psi1=1.0, chi=1.0, lam=1.0), "eta, rho"),
    (lambda: planar(psi1=1.0, chi=1.0, lam=1.0, rho=0.4), "lam eta"),
    (lambda: planar(psi1=1.0, chi=1.0, lam=1.0, rho=1.0, eta=1.0), "eta, rho"),
    (lambda: planar(psi1=1.0, chi=1.0, lam=0.1, rho=1.0, poisson_ratio=0.3,
                    friction_coefficient=0.2), "contradicts"),
    (lambda: planar(psi1=1.0, chi=1.0, lam=0.1, eta=0.2, poisson_ratio=0.3,
                    friction_coefficient=0.3), r"lam / eta = \[0.5\]: contradicts"),
    (lambda: planar(psi1=[1.0, 0.0], chi=np.eye(2), lam=[0.1, 0.0, 0.0], rho=1.0), "lam.shape"),
    (lambda: Scene(Sphere(0.01, STEEL), FLOOR, 0.1, 1.0, inverse_mass=np.eye(3)),
     "inverse_mass"),
    (lambda: Simulation(tangential="annulus").run(rod(30.0).scene), "use tangential='fronts'"),
    (lambda: Simulation(tangential="fronts").run(rod(30.0, across=0.5).scene), "slip along one"),
    (lambda: Simulation(tangential="mindlin_deresiewicz").run(rod(30.0, across=0.5).scene),
     "use tangential='springs', integrator='symplectic'"),
    (lambda: collide(two_bodies(3, 1), restitution=[0.5, 0.6]), "restitution"),
]  # fmt: skip


@pytest.mark.parametrize(("act", "words"), REFUSED)
def test_refusals(act, words):
    with pytest.raises(ValueError, match=words):
        act()


@pytest.mark.slow
def test_an_estimated_error_is_the_distance_from_the_exact_answer():
    """In nine of ten impacts within a factor of three; in space beside the springs' own limit."""
    scene = random_planar(30, 15)
    exact, rough = EXACT.run(scene).check(), springs(30, 120)
    estimate = rough.run(scene, estimate_error=True).check().psi2_error_estimate
    ratio = estimate / np.abs(rough.run(scene).psi2 - exact.psi2)
    assert np.mean((ratio > 1 / 3) & (ratio < 3.0)) > 0.9
    turning = rod(-35.0, slip=0.3, across=0.6).scene
    found = rough.run(turning, estimate_error=True)
    limit = springs(200, 500).run(turning).psi2
    assert found.psi2_error_estimate == pytest.approx(np.linalg.norm(found.psi2 - limit), rel=0.5)
    assert f"about {found.psi2_error_estimate:.1g}, estimated" in str(found)
    assert EXACT.run(rod(30.0).scene, estimate_error=True).psi2_error_estimate < 1e-9
    assert np.isnan(RIGID.run(turning, estimate_error=True).psi2_error_estimate)


SOFT = Material(young_modulus=3e3, poisson_ratio=0.3, density=0.2)
MILD = Material(young_modulus=2e11, poisson_ratio=0.3, density=7850.0, yield_stress=3e8)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, ()),
        ({"friction_coefficient": 30.0}, ("friction_coefficient = 30",)),
        ({"contact": (0.02, 0.0, 0.1)}, ("contact lies behind the centre of mass",)),
        ({"contact": (0.05, 0.0, -2.0)}, ("radii of gyration",)),
        ({"velocity": (0.2, 0.0, -700.0)}, ("speed of sound",)),
        ({"material": SOFT}, ("density", "shear_modulus")),
        ({"material": MILD}, ("yield",)),
        ({"contact": (0, 0, -0.1), "material": MILD, "bending_period": 1.0}, ("yield", "rings")),
    ],
)  # fmt: skip
def test_cautions_of_any_two_bodies(changes, words):
    """Of eccentric impacts and, in the last row, where friction does not change the approach."""
    material, period = changes.pop("material", STEEL), changes.pop("bending_period", None)
    body = RigidBody(
        mass=33.0, principal=(0.132, 0.132, 0.132), material=material, curvature_radius=0.05,
        bending_period=period,
    )  # fmt: skip
    met = Encounter(
        body, HalfSpace(material),
        **{"friction_coefficient": 0.3, "normal": (0.0, 0.0, -1.0), "velocity": (0.2, 0.0, -1.0),
           "contact": (0.02, 0.0, -0.1)} | changes,
    )  # fmt: skip
    found = collide(met).cautions
    assert all(any(word in text for text in found) for word in words)
    assert len(set(found)) == len(found)
    assert words or not found


def test_bodies_and_the_numbers_of_the_theory_are_one_impact():
    """Bodies in SI, and psi1, chi, lam and eta or rho of their scene, rebound alike."""
    flat = rod(25.0, slip=0.4).scene
    same = planar(psi1=flat.psi1, chi=flat.chi, lam=flat.lam, eta=flat.eta)
    assert EXACT.run(same).psi2 == pytest.approx(EXACT.run(flat).psi2, abs=1e-9)
    turning = two_bodies(8, 21).scene
    numbers = {name: getattr(turning, name) for name in ("psi1", "chi", "lam", "rho")}
    same = Scene.nondimensional(**numbers)
    laws = springs(8, 40)
    assert laws.run(same).psi2 == pytest.approx(laws.run(turning).psi2, abs=1e-9)
    assert same.rho == pytest.approx(turning.rho, rel=1e-12)


def test_a_plan_tells_space_from_a_plane():
    space, plane = (
        str(springs(4, 20).plan(s)) for s in (random_in_space(2, 9), random_planar(2, 9))
    )
    words = "where the slip turns"
    assert words in space
    assert words not in plane
    assert "numerical error of the normal restitution: the laws state no bound" in space
    assert "out-of-plane motion (planar)" in plane
    assert "out-of-plane motion (planar)" not in space


@pytest.mark.parametrize("friction", [1e5, 1e6])
@pytest.mark.parametrize("slip", [0.0, 0.5])
def test_books_beyond_what_is_declared_raise_the_declared_error(friction, slip):
    """For mu from 10 on e is linear in 1/mu: 1e3 and 1e4 give the limit to 1e-8."""
    scene = rod(45.0, slip=slip, friction=friction).scene
    result = Simulation().run(scene).check()
    e = [
        Simulation().run(rod(45.0, slip=slip, friction=mu).scene).normal_restitution
        for mu in (1e3, 1e4)
    ]
    limit = e[1] + (e[1] - e[0]) * (1e-4 - 1.0 / friction) / (1e-3 - 1e-4)
    assert abs(result.normal_restitution - limit) <= result.plan.restitution_error
    assert result.plan.restitution_error > abs(result.energy.relative_imbalance)
    told = f"the normal restitution: below {result.plan.restitution_error:.2g}"
    assert told in str(result.plan)
