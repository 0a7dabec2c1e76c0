"""The compiled march of springs beside Python's, each the other's referee."""

import os
import signal
import threading
import time

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, Status
from contactlab_laws import compiled
from tests.longer import longer

needs_library = pytest.mark.skipif(compiled.library() is None, reason=compiled.tell())
#: Equal numbers of both; of lossy scenes where a rounding of the speed moves nothing.
EQUAL = 1e-12
KINDS = ("sphere", "plane", "circle", "ellipse")


@pytest.fixture
def both(monkeypatch):
    """Return a function of a call that gives its answers by the library and by Python."""

    def each(call):
        answers = []
        for word in "10":
            monkeypatch.setenv(compiled.VARIABLE, word)
            answers.append(call())
        return answers

    return each


def drawn(draw, kind, largest=60.0):
    """Return a random impact of a kind."""
    while True:
        try:
            return made(draw, kind, largest)
        except ValueError:  # no body has such numbers
            continue


def made(draw, kind, largest):
    chi, lam = np.exp(draw.uniform(np.log(0.3), np.log(largest))), draw.choice([0.2, 0.9])
    if kind == "sphere":
        return Scene.nondimensional(psi1=draw.uniform(-3.0, 3.0), chi=chi)
    rho = 10.0 ** draw.uniform(-2.0, 0.3)
    if kind == "plane":
        lam = draw.uniform(-lam, lam)
        return Scene.nondimensional(psi1=draw.uniform(-3.0, 3.0), chi=chi, lam=lam, rho=rho)
    own = draw.normal(size=(2, 2))
    chis = own @ own.T + 0.5 * np.eye(2)
    chis *= 2.0 * chi / np.trace(chis)
    ratio = draw.uniform(0.8, 1.25) if kind == "ellipse" else 1.0
    chis[1, 0] = ratio * chis[0, 1]
    return Scene.nondimensional(
        psi1=draw.uniform(-3.0, 3.0, 2), chi=chis, lam=draw.uniform(-0.6, 0.6, 2) * lam, rho=rho,
        **({"cross_stiffness_ratio": ratio} if kind == "ellipse" else {}),
    )  # fmt: skip


def simulation(e, springs, steps, **options):
    return Simulation(
        normal=contactlab.create("normal.viscoelastic", restitution=e) if e < 1.0 else "hertz",
        tangential=contactlab.create("tangential.springs", springs=springs, **options),
        integrator=contactlab.create("integrator.symplectic", steps=steps),
    )


def numbers(result):
    """Return psi2, and energies over that of the approach."""
    energy = result.energy
    parts = energy.friction_work, energy.shear_loss, energy.normal_loss
    unit = 0.5 * np.asarray(result.scene.pair.normal_mass) * result.scene.normal_speed**2
    return np.concatenate([np.ravel(result.psi2), *(np.ravel(each / unit) for each in parts)])


def off(one, other):
    found, expected = numbers(one), numbers(other)
    return np.abs(found - expected).max() / max(1.0, np.abs(expected).max())


@needs_library
@pytest.mark.parametrize("kind", KINDS)
def test_elastic_springs_are_those_of_python(both, kind):
    draw = np.random.default_rng(KINDS.index(kind))
    for springs, steps in ((2, 60), (12, 60), (25, 50)):
        scene = drawn(draw, kind)
        sim = simulation(1.0, springs, steps)
        one, other = both(lambda sim=sim, scene=scene: sim.run(scene).check())
        assert off(one, other) < EQUAL
        assert one.counters == other.counters
        assert one.motion.duration == pytest.approx(other.motion.duration, rel=1e-12)


@pytest.mark.parametrize(("law", "e"), [("viscoelastic", 0.2), ("hunt_crossley", 0.4)])
@pytest.mark.parametrize(("springs", "steps"), [(8, 400), (16, 200)])
def test_little_slip_comes_back_in_proportion(both, law, e, springs, steps):
    """All but the edge sticks, and the equations are linear: also of the last spring that leaves.

    A spin of a rolling ball that is off by a rounding was thrown back as one, or refused.
    """
    scene = Scene.nondimensional(psi1=[1e-6, 1e-9, 1e-14, -1e-14], chi=[[1.44], [0.05]])
    normal = contactlab.create(f"normal.{law}", restitution=e)
    sim = attrs.evolve(simulation(1.0, springs, steps, table=False), normal=normal)
    for found in both(lambda: sim.run(scene).check()):
        ratio = np.asarray(found.psi2 / scene.psi1)
        assert np.ptp(ratio, axis=1).max() < 1e-5
        assert (np.abs(ratio) < 1.0).all()


def differ(both, draw, kind, largest):
    """Return how much both differ, and how much Python if a rounding changes the speed."""
    scene, e = drawn(draw, kind, largest), draw.choice([0.9, 0.5, 0.1])
    loss = draw.choice([1.0, 1.0, 0.5, 2.0])
    sim = simulation(e, int(draw.choice([12, 25])), 40, shear_loss=float(loss))
    one, other = both(lambda: sim.run(scene))
    assert one.status is other.status
    if one.status is not Status.SUCCESS:  # as coarse steps are off in their books
        return 0.0, 0.0
    moved = 0.0
    if (found := off(one, other)) >= EQUAL:
        near = [
            sim.run(attrs.evolve(scene, normal_speed=scene.normal_speed * (1.0 + k * 2.0**-52)))
            for k in (-4, -3, -2, 2, 3, 4)
        ]
        moved = max(off(each.check(), other) for each in near)
    return found, moved


@needs_library
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("count", "largest"), [(1, 2.0), pytest.param(25, 60.0, marks=pytest.mark.slow)]
)
def test_springs_with_loss_are_those_of_python(both, kind, count, largest):
    """Where a branch is decided by rounding, by no more than a rounding of the speed moves."""
    draw = np.random.default_rng(10 * count + KINDS.index(kind))
    for _ in range(count):
        found, moved = differ(both, draw, kind, largest)
        assert found < max(EQUAL, 3.0 * moved)


@needs_library
@pytest.mark.parametrize(
    "normal",
    ["tsuji", "hunt_crossley", "kuwabara_kono", pytest.param("jkr", marks=pytest.mark.slow)],
)
def test_springs_along_any_known_motion_are_those_of_python(both, normal):
    """Contacts of a batch that differ have a table each; adhesion breaks under a load."""
    options = {"tsuji": {"restitution": 0.7}, "jkr": {"work_of_adhesion": 0.05}}
    law = contactlab.create(f"normal.{normal}", **options.get(normal, {}))
    steel = contactlab.Material(young_modulus=2e9, poisson_ratio=0.3, density=1200.0)
    ball = contactlab.Sphere(radius=0.01, material=steel)
    scene = Scene(
        sphere=ball, target=contactlab.HalfSpace(steel), friction_coefficient=0.3,
        normal_speed=np.array([1.0, 2.0]), tangential_velocity=0.5,
    )  # fmt: skip
    sim = Simulation(normal=law, tangential="springs", integrator="symplectic")
    for each in (scene, scene.take(0)):
        one, other = both(lambda each=each: simulate(sim, each))
        assert off(one, other) < EQUAL


def simulate(sim, scene):
    """Return a result in 20 springs and 60 steps."""
    laws = sim.tangential, sim.integrator
    law, integrator = (
        attrs.evolve(each, **{each.resolution: value})
        for each, value in zip(laws, (20, 60), strict=True)
    )
    return attrs.evolve(sim, tangential=law, integrator=integrator).run(scene).check()


@needs_library
@pytest.mark.parametrize("e", [1.0, 0.8])
def test_a_batch_is_its_impacts(e):
    draw = np.random.default_rng(4)
    scene = Scene.nondimensional(
        psi1=draw.uniform(-3.0, 3.0, (3, 4)), chi=draw.uniform(0.5, 30.0, (3, 4)), lam=0.2, rho=0.3
    )
    many = Simulation(normal=simulation(e, 8, 60).normal, tangential="springs").run(scene).check()
    for place in ((0, 0), (1, 2), (2, 3)):
        one = Simulation(normal=simulation(e, 8, 60).normal, tangential="springs")
        alone = one.run(scene.take(place)).check()
        assert alone.psi2 == pytest.approx(many.psi2[place], abs=1e-12)
        assert alone.plan.psi2_error == pytest.approx(many.plan.psi2_error[place])


@needs_library
def test_a_history_is_that_of_the_answer():
    """Python follows the history, in as many springs and steps."""
    scene = Scene.nondimensional(psi1=0.8, chi=1.3, lam=0.19, eta=1.7)
    sim = Simulation(tangential="springs", integrator="symplectic")
    with_history = sim.run(scene, history=True).check()
    assert off(sim.run(scene).check(), with_history) < EQUAL
    assert len(with_history.history.time) == with_history.counters["steps"]


@needs_library
def test_a_law_that_is_derived_from_springs_is_never_compiled(both):
    """It may answer otherwise; here half the force of springs."""
    springs = type(contactlab.create("tangential.springs"))

    @attrs.frozen(kw_only=True)
    class Half(springs):
        api_version = 2

        def advance(self, state, increment, before, after):
            response, state = super().advance(state, increment, before, after)
            half = {"force": 0.5 * response.force, "friction_work": 0.5 * response.friction_work}
            return response._replace(**half), state

        def advance_all(self, scene, normal, steps):
            return None

    scene = Scene.nondimensional(psi1=1.2, chi=1.3, lam=0.2, rho=0.5)
    sim = Simulation(tangential=Half(springs=20), integrator="symplectic")
    one, other = both(lambda: sim.run(scene))
    assert one.check().psi2 == other.psi2
    assert one.psi2 != pytest.approx(simulation(1.0, 20, 200).run(scene).psi2, abs=0.01)


@needs_library
def test_what_fails_has_the_status_and_the_sentence_of_python(both):
    """Impacts that last too long, and one of a batch whose steps are too few."""
    scene = Scene.nondimensional(psi1=[0.5, 1.0], chi=[1.3, 900.0], lam=[0.1, 0.3], rho=0.5)
    few = attrs.evolve(
        simulation(1.0, 4, 30),
        integrator=contactlab.create("integrator.symplectic", steps=30, refine=False),
    )
    for given in (scene, scene.take(1)):
        one, other = both(lambda given=given: few.run(given))
        assert np.array_equal(one.status, other.status)
        assert np.array_equal(one.motion.detail, other.motion.detail)
    assert one.status is Status.TOO_FEW_STEPS


@needs_library
def test_impacts_that_last_too_long_are_told_as_by_python(both, monkeypatch):
    """Were they given up after a half of the approach without friction."""
    monkeypatch.setattr("contactlab_laws.march.coupled_steps.LONGEST", 0.5)
    scene = Scene.nondimensional(psi1=[0.5, 1.0], chi=[1.3, 2.0], lam=[0.1, 0.3], rho=0.5)
    for given in (scene, scene.take(1)):
        one, other = both(lambda given=given: simulation(1.0, 4, 60).run(given))
        assert np.array_equal(one.status, other.status)
        assert np.isnan(one.psi2).all()
    assert one.motion.detail == other.motion.detail
    assert one.status is Status.NOT_SEPARATED
    assert "durations of the approach without friction and 1 compression" in one.motion.detail


@needs_library
@pytest.mark.skipif(not hasattr(signal, "SIGINT"), reason="no such signal")
@pytest.mark.parametrize("lam", [0.0, *longer(0.2)])
def test_control_c_is_heard_within_a_second(lam):
    scene = Scene.nondimensional(
        psi1=np.full(50, 0.5), chi=3.0, **({"lam": lam, "rho": 0.5} if lam else {})
    )
    sim = simulation(0.8, 2000, 20_000)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job ignores it
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            sim.run(scene)
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - begun < 30.0  # of minutes; a busy machine takes its time


@needs_library
def test_beside_the_table_of_restitutions_both_marches_agree(both):
    """Python's has springs at the ends of cells, half kicks, and a course of its own."""
    chi, e, psi1 = np.array([0.29, 3.01]), np.array([0.999, 0.8]), np.array([0.9, 4.0])
    one, other = both(lambda: contactlab.rebound(psi1, chi, restitution=e))
    assert one == pytest.approx(other, abs=1e-4)
    assert not np.array_equal(one, other)


@needs_library
def test_beside_the_table_one_impact_is_that_of_many():
    psi1, chi = np.array([-0.6, 4.0, 8.0]), np.array([0.05, 3.01, 12.0])
    e = np.array([0.3, 0.8, 0.1])
    many = contactlab.rebound(psi1, chi, restitution=e)
    alone = [contactlab.rebound(p, c, restitution=r) for p, c, r in zip(psi1, chi, e, strict=True)]
    assert alone == pytest.approx(many, abs=1e-12)
