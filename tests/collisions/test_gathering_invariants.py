"""What any gathering keeps: momentum, energy, permutations, and the encounter that it contains."""

import attrs
import numpy as np
import pytest

from contactlab import (
    Body,
    Encounter,
    Gathering,
    HalfSpace,
    RigidBody,
    Simulation,
    Sphere,
    Touch,
    collide,
    create,
)
from contactlab.contracts.status import Status
from tests.collisions.gathered import STEEL, cushion, laws, random_gathering, row

VISCOUS = create("normal.viscoelastic", restitution=0.7)


def skew(e=1.0):
    """Return a row of five with spin, friction and gaps."""
    return row(5, mu=0.2, gaps=[0.0, 2e-6, 0.0, 1e-6], spin=80.0, e=e)


@pytest.mark.parametrize("e", [1.0, pytest.param(0.8, marks=pytest.mark.slow)])
def test_momentum_and_angular_momentum_are_kept(e):
    """Of balls whose contact points coincide: centres stand where the surfaces touch."""
    given = skew(e)
    hit = collide(given, None if e < 1.0 else laws(12, 50))
    mass = given.bodies[0].shape.mass
    inertia = 0.4 * mass * 0.01**2
    places = np.stack([[0.02 * k, 0.0, 0.0] for k in range(5)])
    before = np.stack([each.velocity for each in given.bodies])
    turning = np.stack([each.spin for each in given.bodies])
    np.testing.assert_allclose(hit.velocity.sum(axis=0), before.sum(axis=0), atol=1e-14)
    whole = [
        (mass * np.cross(places, v) + inertia * w).sum(axis=0)
        for v, w in ((before, turning), (hit.velocity, hit.spin))
    ]
    np.testing.assert_allclose(whole[1], whole[0], atol=1e-14 * mass * 0.1)


def test_the_impulse_is_that_on_the_first_body():
    given = skew()
    hit, mass = collide(given, laws(12, 50)), given.bodies[0].shape.mass
    np.testing.assert_allclose(hit.impulse[0], mass * (hit.velocity[0] - [1, 0, 0]), atol=1e-16)
    change = mass * hit.velocity[2]
    np.testing.assert_allclose(hit.impulse[2] - hit.impulse[1], change, atol=1e-16)


@pytest.mark.parametrize("e", [1.0, pytest.param([1.0, 0.9, 0.8, 0.7], marks=pytest.mark.slow)])
def test_contacts_permuted_and_bodies_exchanged_change_rounding(e):
    given, simulation = skew(e), laws(12, 50) if e == 1.0 else None
    hit = collide(given, simulation)
    order = [2, 0, 3, 1]
    touches = []
    for k in order:
        touch = given.touches[k]
        turned = {"first": touch.second, "second": touch.first, "normal": -touch.normal}
        touches.append(attrs.evolve(touch, **turned))
    other = collide(Gathering(given.bodies, touches), simulation)
    np.testing.assert_allclose(other.velocity, hit.velocity, atol=1e-13)
    np.testing.assert_allclose(0.01 * other.spin, 0.01 * hit.spin, atol=1e-13)
    np.testing.assert_allclose(other.impulse, -hit.impulse[order], atol=1e-13)
    np.testing.assert_allclose(other.maximum_force, hit.maximum_force[order], rtol=1e-10)


def test_a_frame_that_moves_changes_rounding():
    """Walls move along; the energy books are those of the relative motion."""
    given, wind = cushion(), np.array([0.7, -0.3, 0.2])
    touches = [attrs.evolve(each, target_velocity=wind) for each in given.touches]
    ball = attrs.evolve(given.bodies[0], velocity=given.bodies[0].velocity + wind)
    one, other = (
        collide(given, laws(12, 50)),
        collide(Gathering({"ball": ball}, touches), laws(12, 50)),
    )
    np.testing.assert_allclose(other.velocity - wind, one.velocity, atol=1e-13)
    assert other.energy.start == pytest.approx(one.energy.start, rel=1e-12)
    assert other.energy.end == pytest.approx(one.energy.end, rel=1e-12)


@pytest.mark.parametrize("normal", ["hertz", pytest.param(VISCOUS, marks=pytest.mark.slow)])
def test_one_contact_is_its_encounter(normal):
    rng, simulation = np.random.default_rng(3), laws(12, 50, normal)
    for _ in range(4):
        given = random_gathering(rng, most=2)
        touch = given.touches[0]
        names = given.places[0]
        if names[1] is None:
            continue
        one, two = (given.bodies[k] for k in names)
        met = Encounter(
            one.shape, two.shape, touch.friction_coefficient, normal=touch.normal,
            velocity=one.velocity, spin=one.spin, target_velocity=two.velocity,
            target_spin=two.spin, contact=touch.contact, target_contact=touch.target_contact,
        )  # fmt: skip
        if not met.approaching:
            met = attrs.evolve(met, normal=-met.normal)
        touch = Touch(
            0, 1, touch.friction_coefficient, normal=met.normal, contact=touch.contact,
            target_contact=touch.target_contact,
        )  # fmt: skip
        hit, alone = collide(Gathering([one, two], [touch]), simulation), collide(met, simulation)
        np.testing.assert_allclose(hit.velocity[0], alone.velocity, atol=1e-13)
        np.testing.assert_allclose(0.03 * hit.spin[1], 0.03 * alone.target_spin, atol=1e-13)
        np.testing.assert_allclose(hit.impulse[0], alone.impulse, atol=1e-13)
        for name in ("start", "end", "friction_work", "normal_loss"):
            told = getattr(hit.energy, name), getattr(alone.energy, name)
            assert told[0] == pytest.approx(told[1], abs=1e-12 * alone.energy.start)


def test_a_batch_is_each_of_its_gatherings():
    """Elastic gatherings keep every bit; of viscous springs sums round."""
    gaps, speeds = np.array([[0.0, 1e-6], [3e-6, 1e-4]]), np.array([1.0, 0.3])
    ball = Sphere(0.01, STEEL)

    def three(gap, speed):
        velocity = np.multiply.outer(speed, [1.0, 0.0, 0.0])
        bodies = [Body(ball, velocity=velocity, spin=[0, 0, 50.0]), Body(ball), Body(ball)]
        touches = [Touch(k, k + 1, 0.2, normal=[1, 0, 0], gap=[0.0, gap][k]) for k in (0, 1)]
        return Gathering(bodies, touches)

    simulation = laws(12, 50)
    hits = collide(three(gaps, speeds), simulation)
    assert hits.velocity.shape == (2, 2, 3, 3)
    assert hits.psi2.shape == (2, 2, 2, 2)
    assert hits.energy.start.shape == hits.status.shape == (2, 2)
    for index in np.ndindex(2, 2):
        alone = collide(three(gaps[index], speeds[index[1]]), simulation)
        for name in ("velocity", "spin", "impulse", "psi2", "first_touch", "maximum_force"):
            assert getattr(alone, name).tobytes() == getattr(hits, name)[index].tobytes()


def test_blocks_of_a_batch_cut_no_gathering(monkeypatch):
    """A batch in blocks of a gathering or two is that in one."""
    from contactlab.solve import coupled

    gaps = np.linspace(0.0, 5e-6, 20)
    whole = collide(row(4, gaps=[0.0, gaps, 0.0], mu=0.1), laws(12, 50))
    monkeypatch.setattr(coupled, "IN_CACHE", 80)
    cut = collide(row(4, gaps=[0.0, gaps, 0.0], mu=0.1), laws(12, 50))
    assert cut.velocity.tobytes() == whole.velocity.tobytes()
    assert cut.impulse.tobytes() == whole.impulse.tobytes()
    assert cut.touches.tobytes() == whole.touches.tobytes()


@pytest.mark.slow
def test_blocks_of_a_batch_keep_the_restitution_of_each_contact(monkeypatch):
    """Each has a loss of its own, known by its index: only sums round."""
    from contactlab.solve import coupled

    e = np.linspace(0.4, 1.0, 7)
    whole = collide(row(3, mu=0.1, e=[e, 0.9]))
    monkeypatch.setattr(coupled, "IN_CACHE", 200)
    cut = collide(row(3, mu=0.1, e=[e, 0.9]))
    np.testing.assert_allclose(cut.velocity, whole.velocity, atol=1e-14)
    alone = collide(row(3, mu=0.1, e=[e[5], 0.9]))
    np.testing.assert_allclose(cut.velocity[5], alone.velocity, atol=1e-14)


def _random(count, most, seed, e=False):
    """Return gatherings of bodies of any shape, in which something approaches."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        given = random_gathering(rng, most=most)
        if e:
            touches = [
                attrs.evolve(each, restitution=rng.uniform(0.3, 1.0)) for each in given.touches
            ]
            given = Gathering(given.bodies, touches)
        try:
            given.scene  # noqa: B018 it refuses what parts
        except ValueError as error:
            assert "nothing approaches" in str(error)  # noqa: PT017
            continue
        found.append(given)
    return found


def _judge(found, books, simulation=None):
    """Judge the energy of gatherings, and return how many of them found no end."""
    endless = 0
    for given in found:
        hit = collide(given, simulation)
        if hit.status is not Status.SUCCESS:
            assert hit.status is Status.NOT_SEPARATED
            assert "touches: [" in hit.failures[0]
            assert hit.to_dict()["detail"] in hit.failures[0]
            assert np.isnan(hit.velocity).all()
            endless += 1
            continue
        assert abs(hit.energy.relative_imbalance) < books
        energies = [0.0, 0.0]
        for k, body in enumerate(given.bodies):
            inertia = body.shape.inertia
            for one, (v, w) in enumerate(
                ((body.velocity, body.spin), (hit.velocity[k], hit.spin[k]))
            ):
                energies[one] += 0.5 * body.shape.mass * v @ v + 0.5 * w @ inertia @ w
        assert energies[1] <= energies[0] * (1.0 + books)
        lost = hit.energy.start - hit.energy.end
        assert energies[0] - energies[1] == pytest.approx(lost, abs=1e-11 * energies[0])
    return endless


def test_random_gatherings_gain_no_energy():
    assert _judge(_random(12, 4, 5), 2e-3, laws(12, 50)) <= 2


@pytest.mark.slow
@pytest.mark.parametrize(
    ("count", "e", "springs", "books"),
    [(40, False, 50, 2e-4), (10, True, 50, 2e-4), (100, True, 12, 2e-3)],
)
def test_many_random_gatherings_gain_no_energy(count, e, springs, books):
    """Of 1,000 and 100 with loss all ended, books were off by 4.6e-4 and 4.2e-6 at most."""
    steps = create("integrator.symplectic", steps=50 if springs == 12 else 200)
    simulation = Simulation(
        tangential=create("tangential.springs", springs=springs), integrator=steps
    )
    assert _judge(_random(count, 8, 6, e), books, simulation) <= 0.1 * count


def bouncing():
    """Return a light ball that heavy ones pass to and fro: it meets both twice."""
    heavy, light = Sphere(0.02, STEEL), Sphere(0.005, STEEL)
    bodies = [Body(heavy, velocity=[1, 0, 0], spin=[0, 0, 40]), Body(light), Body(heavy)]
    touches = [Touch(k, k + 1, 0.2, normal=[1, 0, 0], gap=3e-5 * k) for k in (0, 1)]
    return Gathering(bodies, touches)


@pytest.mark.slow
@pytest.mark.parametrize(("make", "touches", "order"), [(skew, 1, 1.9), (bouncing, 2, 1.5)])
def test_the_order_is_two(make, touches, order):
    fine = collide(make(), laws(200, 800))
    finer = collide(make(), laws(400, 1600)).velocity
    exact = (4.0 * finer - fine.velocity) / 3.0
    each = (25, 50, 100)
    errors = [np.abs(collide(make(), laws(n, 4 * n)).velocity - exact).max() for n in each]
    slope = np.polyfit(np.log(each), np.log(errors), 1)[0]
    assert slope < -order
    assert fine.touches.max() == touches


def test_a_body_of_one_contact_with_two_walls_is_not_answered_contact_by_contact():
    """Answered alone each wall would reverse the ball: the velocity is off by .98 of v1."""
    given = cushion()
    scene = given.scene
    for answer in (
        lambda: Simulation().run(scene), lambda: Simulation().plan(scene),
        lambda: Simulation().sweep(scene), lambda: Simulation().sweep([scene]),
        lambda: laws().run(scene), lambda: laws().run(attrs.evolve(scene, encounter=None)),
        lambda: laws().run(scene.with_index(scene.index)),
        lambda: laws().run(scene.take(slice(0, 1))),
        lambda: scene.stack([scene, scene]), lambda: scene.take((0, 0)), lambda: scene.take(0),
        lambda: scene.take(np.array([[True, False]])),
    ):  # fmt: skip
        with pytest.raises(ValueError, match="gathering"):
            answer()


def test_a_sweep_into_a_folder_refuses_a_gathering(tmp_path):
    with pytest.raises(ValueError, match="gathering"):
        laws().sweep(cushion().scene, into=tmp_path / "folder")
    with pytest.raises(ValueError, match="gathering"):
        laws().sweep(cushion().scene, keep=tmp_path / "kept")


def test_an_integrator_that_knows_one_contact_is_refused():
    """A stranger's integrator answers each contact alone; one that claims more must show it."""
    from contactlab_laws.march.fixed import FixedSteps

    fixed = create("integrator.symplectic")

    @attrs.frozen(kw_only=True)
    class Alone(type(fixed)):
        offers = frozenset()

    @attrs.frozen(kw_only=True)
    class Boasting(type(fixed)):
        def integrate_coupled(self, scene, normal, tangential, observer=None):
            motion = super().integrate_coupled(scene, normal, tangential, observer)
            return attrs.evolve(motion, contacts=None)

    assert issubclass(Alone, FixedSteps)
    simulation = Simulation(tangential="springs", integrator=Alone())
    with pytest.raises(ValueError, match="marches each contact by itself"):
        collide(cushion(), simulation)
    hit = collide(cushion(), Simulation(tangential="springs", integrator=Boasting()))
    assert hit.status is Status.MALFORMED
    assert np.isnan(hit.velocity).all()


@pytest.mark.slow
def test_a_chain_of_many_contacts_is_sparse_and_like_a_short_one():
    """The first balls of 110 do what those of 60 do; a wave has not come back."""
    many, few = (collide(row(count), laws(2, 50)) for count in (110, 60))
    assert not isinstance(many._way.scene.links.inverse_mass, np.ndarray)
    assert isinstance(few._way.scene.links.inverse_mass, np.ndarray)
    np.testing.assert_allclose(many.velocity[:40, 0], few.velocity[:40, 0], atol=1e-7)
    own = 0.5 * many.gathering.bodies[0].shape.mass  # but for the part of the common motion
    assert many.energy.start == pytest.approx(own * 109 / 110, rel=1e-7)


@pytest.mark.slow
def test_a_rigid_body_of_history_and_dict():
    hit = collide(cushion(), laws(12, 50), history=True)
    columns = hit.history.normal_force
    assert columns.shape == (len(hit.history.time), 2)
    np.testing.assert_allclose(columns.max(axis=0), hit.maximum_force)
    assert hit.velocity.tobytes() == collide(cushion(), laws(12, 50)).velocity.tobytes()
    told = hit.to_dict()
    np.testing.assert_array_equal(told["velocity"], hit.velocity)
    assert told["bodies"] == ["ball"]
    assert hit.laws["tangential"].startswith("springs")
    assert hit.simulation is not None
    assert collide(row(3, e=0.9), history=False).simulation is None
    assert set(told["energy"]) >= {"start", "end", "imbalance"}


@pytest.mark.slow
def test_a_micron_of_gap_is_told():
    hit = collide(row(5))
    assert hit.plan.per_micron == pytest.approx(0.0209, abs=2e-4)
    assert any("a micron more moves a velocity by 0.021 of v1" in text for text in hit.cautions)
    batch = collide(row(3, gaps=[0.0, np.array([0.0, 1e-3])]), laws(12, 50))
    assert batch.plan.per_micron.shape == (2,)
    assert not any("micron" in text for text in batch.cautions)


def test_a_plan_without_a_run_is_that_of_the_run():
    given, simulation = row(3, mu=0.2, gaps=[0.0, 5e-6]), laws(12, 50)
    plan, run = simulation.plan(given), collide(given, simulation).plan
    assert str(plan) == str(run)
    np.testing.assert_array_equal(plan.gap_over_depth, run.gap_over_depth)
    assert plan.per_micron == run.per_micron
    batch = simulation.plan(row(3, gaps=[0.0, np.array([0.0, 1e-4])]))
    assert batch.gap_over_depth.shape == (2, 2)
    with pytest.raises(ValueError, match="fields are those of one contact"):
        simulation.plan(given, history="fields")
    with pytest.raises(ValueError, match="nothing approaches"):
        simulation.plan(row(3, speed=-1.0))


def test_a_weight_that_nothing_carries_is_told():
    hit = collide(cushion(force=[0, 0, -9.81 * 0.1406]), laws(12, 50))
    assert any("g T/v1 = 0.056" in text for text in hit.cautions)


def test_spin_about_a_normal_is_told_of_its_contact():
    given = row(3)
    turning = attrs.evolve(given.bodies[2], spin=[50.0, 0.0, 0.0])
    given = Gathering([*given.bodies[:2], turning], given.touches)
    (told,) = [str(each) for each in laws(12, 50).plan(given).cautions if "spin" in str(each)]
    assert "spin about the normal of touches[1]" in told


def test_contacts_that_are_near_are_told():
    hit = collide(cushion(), laws(12, 50))
    assert any("feel one another through the body" in text for text in hit.cautions)


def test_one_contact_alone_has_no_gap_that_counts():
    """It begins where the bodies touch, however far they are drawn by a force."""
    ball = Body(Sphere(0.01, STEEL), velocity=[0, 0, -1e-3], force=[0, 0, -0.3])
    given = Gathering([ball], [Touch(0, HalfSpace(STEEL), 0.2, normal=[0, 0, -1])])
    told = [str(each) for each in laws(12, 50).plan(given).cautions]
    assert any("force on bodies[0]" in text for text in told)
    assert not any("gaps" in text for text in told)


LIGHT = attrs.evolve(STEEL, density=7.8)
FLAT = RigidBody(mass=1.0, inertia=np.eye(3) * 1e-3, material=STEEL, curvature_radius=0.01)


@pytest.mark.parametrize(
    ("body", "friction", "contact", "words"),
    [
        (Sphere(0.01, LIGHT), 0.2, (0, 0, 0), "is the density in g/cm³?"),
        (Sphere(12.0, STEEL), 0.2, (0, 0, 0), "is the length in mm?"),
        (Sphere(0.01, STEEL), 30.0, (0, 0, 0), "is the number in per cent"),
        (FLAT, 0.2, (-0.01, 0, 0), "lies behind the centre of mass"),
    ],
)
def test_numbers_of_a_contact_raise_the_doubts_of_its_encounter(body, friction, contact, words):
    bodies = [Body(body, velocity=[1, 0, 0]), Body(Sphere(0.01, STEEL)), Body(Sphere(0.01, STEEL))]
    first = Touch(0, 1, friction, normal=[1, 0, 0], contact=contact)
    given = Gathering(bodies, [first, Touch(1, 2, 0.2, normal=[1, 0, 0])])
    simulation = laws(12, 50)
    assert any(words in text for text in collide(given.alone(0), simulation).cautions)
    (told,) = [str(each) for each in simulation.plan(given).cautions if words in str(each)]
    assert told.startswith("touches[0]: ")


def test_bodies_of_any_shape_between_walls():
    body = RigidBody(mass=1.0, inertia=np.eye(3) * 1e-3, material=STEEL, curvature_radius=0.01)
    wall = HalfSpace(STEEL)
    touches = [
        Touch(0, wall, 0.2, normal=[0, 0, -1], contact=[0.02, 0, -0.03]),
        Touch(0, wall, 0.2, normal=[0, 0, -1], contact=[-0.02, 0, -0.03]),
    ]
    hit = collide(Gathering([Body(body, velocity=[0, 0, -1])], touches), laws(12, 50))
    np.testing.assert_allclose(hit.impulse[0, 2], hit.impulse[1, 2], rtol=1e-10)
    assert hit.impulse[0, 2] > 0.0
