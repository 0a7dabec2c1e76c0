"""Friction, incidence and inertia at the ends of what a float can hold, and beyond solving."""

import itertools
import math

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status
from contactlab.contracts import WholeImpactTangentialLaw
from contactlab.outcome.motion import Motion, sound

CHI = 49 / 34
FRICTION = (0.0, 1e-308, 1e-300, 1e-12, 1e3, 1e12, 1e300)
PSI1 = (0.0, 1e-308, 1e-300, 1e-12, 1.0, 1e15, 1e16, 1e300)
CHIS = (0.05, 0.5, CHI, 100.0, 1e5, 1e9, 1e12, 1e300)
#: Half a second each, but for one: incidences that no panel resolves.
EXTREMES = [
    pytest.param(psi1, chi, marks=pytest.mark.slow)
    if 0.0 < psi1 < 4.0 * chi and chi >= 1e5 and (psi1, chi) != (1e-12, 1e300)
    else (psi1, chi)
    for psi1, chi in itertools.product(PSI1, CHIS)
]


@pytest.fixture
def followed_by_python(monkeypatch):
    """Let Python's solver answer, which gives up earlier than the compiled one."""
    monkeypatch.setenv("CONTACTLAB_COMPILED", "0")


def integrate(law, scene):
    """Return the motion without the plan's short cuts, of laws that have others."""
    simulation = Simulation(tangential=law, integrator="events")
    if isinstance(simulation.tangential, WholeImpactTangentialLaw):
        return simulation.run(scene).motion
    normal = simulation.normal_motion(scene)
    motion = simulation.integrator.integrate(scene, normal, simulation.tangential)
    return sound(Motion.combine(normal, motion))


def paper_scene(psi1, chi):
    """Return the scene; None, with a ValueError checked, where the energy of slip overflows."""
    with np.errstate(over="ignore"):
        energy = 0.25 / chi * np.float64(psi1) ** 2
    if np.isfinite(energy):
        return Scene.nondimensional(psi1=psi1, chi=chi)
    with pytest.raises(ValueError, match=r"psi1, chi = .*kinetic energy of slip.*give less"):
        Scene.nondimensional(psi1=psi1, chi=chi)
    return None


def change(law, psi1, chi):
    motion = integrate(law, Scene.nondimensional(psi1=psi1, chi=chi))
    assert motion.status is Status.SUCCESS, motion.detail
    return motion.slip_velocity_change


def ball(friction, slip=0.3):
    steel = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)
    return Scene(Sphere(0.01, steel), HalfSpace(steel), friction, 1.0, slip, 0.0)


@pytest.mark.parametrize("chi", [1e-300, 1e-12, 0.05, CHI, 1e4, 1e12])
@pytest.mark.parametrize(
    "psi1", [1e-300, 1e-100, 1e-16, 1e-8, 1.0, 1e15, 1e154, 1e300, -1e-300, -2.0]
)
def test_a_rigid_body_to_relative_rounding(psi1, chi):
    """|change| = min(|psi1|, 4 chi) (paper §4.3), however small or large the two are."""
    if paper_scene(psi1, chi) is None:
        return
    expected = -math.copysign(min(abs(psi1), 4.0 * chi), psi1)
    assert change("coulomb", psi1, chi) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize("share", [1.0 - 1e-9, 1.0 - 2e-16, 1.0, 1.0 + 2e-16, 1.0 + 1e-9])
@pytest.mark.parametrize("chi", [0.05, CHI, 1e4])
def test_a_rigid_body_on_the_edge_of_full_slip(share, chi):
    psi1 = share * 4.0 * chi
    left = psi1 + change("coulomb", psi1, chi)
    assert left == pytest.approx(max(psi1 - 4.0 * chi, 0.0), abs=2e-15 * chi)


@pytest.mark.parametrize("psi1", [1e-300, 1e-12, 0.3, 2.0, 5.0, 7.0])
def test_a_rigid_body_keeps_its_books_and_history(psi1):
    scene = Scene.nondimensional(psi1=psi1, chi=CHI)
    result = Simulation(tangential="coulomb", integrator="events").run(scene, history=True).check()
    history, energy = result.history, 0.5 * psi1**2
    assert abs(result.energy.imbalance) <= 1e-14 * energy * scene.pair.tangential_mass
    assert history.slip_velocity[-1] == pytest.approx(result.psi2, abs=1e-15 * psi1)
    # Between the instants too velocity falls by force over mass, but where the force jumps.
    gained = np.diff(history.slip_velocity)
    force = history.tangential_force
    impulse = 0.5 * (force[1:] + force[:-1]) * np.diff(history.time) / scene.pair.tangential_mass
    smooth = (force[1:] > 0.0) | (force[:-1] == 0.0)
    assert gained[smooth] == pytest.approx(-impulse[smooth], abs=1e-3)
    assert (~smooth).sum() <= 2


@pytest.mark.parametrize("law", ["fronts", "coulomb", "frictionless"])
@pytest.mark.parametrize("friction", FRICTION)
@pytest.mark.parametrize("slip", [0.0, 0.3, -0.3])
def test_any_friction_coefficient(law, friction, slip):
    """Right by the integrator itself, or a status; warnings are errors here."""
    scene = ball(friction, slip)
    motion = integrate(law, scene)
    assert motion.status is Status.SUCCESS
    # 4 chi in psi, without forming psi
    grip = 2.0 * friction * float(scene.pair.normal_mass / scene.pair.tangential_mass)
    found = motion.slip_velocity_change
    if law == "frictionless" or slip == 0.0:
        assert found == 0.0
    elif law == "coulomb" or grip < 1e-3 * abs(slip):
        assert found == pytest.approx(-math.copysign(min(grip, abs(slip)), slip), rel=1e-12)
    else:  # sticks: the limit of vanishing psi1, whatever the coefficient
        limit = integrate(law, ball(1e6, slip)).slip_velocity_change
        assert found == pytest.approx(limit, rel=1e-4)
        assert -motion.slip_velocity_change / slip == pytest.approx(0.7683, abs=1e-3)


@pytest.mark.parametrize("friction", [1e12, 1e154, 1e300])
@pytest.mark.parametrize("law", ["fronts", "coulomb"])
def test_friction_work_under_a_huge_coefficient(law, friction):
    result = Simulation(tangential=law, integrator="events").run(ball(friction)).check()
    assert result.energy.friction_work > 0.0
    assert abs(result.energy.relative_imbalance) < 1e-6


@pytest.mark.parametrize(("psi1", "chi"), EXTREMES)
def test_any_incidence_and_inertia(psi1, chi):
    """Never an exception or a warning; slip throughout is eq. (45), a refusal says what to do."""
    scene = paper_scene(psi1, chi)
    if scene is None:
        return
    motion = integrate("fronts", scene)
    if motion.status is Status.UNRESOLVED:
        assert chi > 1e4
        assert "law of steps" in motion.detail or chi > 1e15
        return
    assert motion.status is Status.SUCCESS
    found = motion.slip_velocity_change
    if psi1 >= max(1.0, 4.0 * chi - 1.0):
        assert found == pytest.approx(-4.0 * chi, rel=1e-14)
    else:
        assert -2.0 * psi1 * (1.0 + 1e-9) <= found <= 0.0


@pytest.mark.slow
@pytest.mark.parametrize("chi", [1e7, 1e9, 1e12])
@pytest.mark.parametrize("psi1", [1e-3, 1.2, 100.0, "chi"])
@pytest.mark.usefixtures("followed_by_python")
def test_what_cannot_be_solved_is_given_up(psi1, chi):
    scene = Scene.nondimensional(psi1=chi if psi1 == "chi" else psi1, chi=chi)
    result = Simulation().run(scene)
    assert result.status is Status.UNRESOLVED
    assert "More than 3000 panels" in result.motion.detail
    assert f"chi = {chi:.3g}" in result.motion.detail
    assert 2900 < result.counters["solves"] <= 3000


@pytest.mark.slow
@pytest.mark.usefixtures("followed_by_python")
def test_each_impact_of_a_batch_says_what_failed_in_it():
    result = Simulation().run(Scene.nondimensional(psi1=0.5, chi=[1e6, 2.0, 1e7]))
    assert list(result.failures) == [0, 2]
    assert "at chi = 1e+06" in result.failures[0]
    assert "at chi = 1e+07" in result.failures[2]


@pytest.mark.slow
@pytest.mark.parametrize(("psi1", "chi"), [(0.3, 5e4), (1.9e5, 1e5), (3.9e6, 1e6)])
@pytest.mark.usefixtures("followed_by_python")
def test_heavy_inertia_that_can_be_solved_still_is(psi1, chi):
    """To ten times the tolerance, and beyond chi = 1e4 in a third fewer solves than before."""
    answers = [
        Simulation(integrator=contactlab.create("integrator.events", tolerance=tolerance)).run(
            Scene.nondimensional(psi1=psi1, chi=chi)
        )
        for tolerance in (1e-8, 1e-9)
    ]
    coarse, fine = (answer.check().motion.slip_velocity_change for answer in answers)
    assert coarse == pytest.approx(fine, abs=1e-7 * max(1.0, psi1))
    assert answers[1].counters["solves"] < 3000
