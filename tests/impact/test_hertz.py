"""Section 2.1: the normal contact, eqs (2)-(9), against closed forms and other codes."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.contracts import NormalLaw
from contactlab.impact.hertz import hertz_scales
from contactlab.solve.normal_motion import normal_motion

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
RIGID = Material(shear_modulus=1e30, poisson_ratio=0.3)
UNIT = Scene.nondimensional(psi1=0.0, chi=1.0)


def hertz():
    return contactlab.create("normal.hertz")


def respond(scene, approach):
    law = hertz()
    return law.respond(law.start(scene), approach, 0.0)[0].complete


def test_radius_and_force_are_eqs_2_and_4():
    contact = respond(Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.1, 1.0), 1e-6)
    radius = math.sqrt(0.01 * 1e-6)
    shear = STEEL.shear_modulus
    assert contact.radius == pytest.approx(radius, rel=1e-14)
    assert contact.force == pytest.approx(4 * radius**3 * shear / (3 * 0.01 * 0.7), rel=1e-14)


def test_out_of_contact_there_is_no_force():
    contact = respond(UNIT, -1e-3)
    assert (contact.force, contact.radius) == (0.0, 0.0)
    assert contact.overlap < 0


def test_nan_stays_nan_instead_of_no_contact():
    """Theory §6: one NaN must not read as "no contact"."""
    assert math.isnan(respond(UNIT, math.nan).force)
    assert np.isnan(respond(UNIT, np.array([0.1, math.nan])).force).tolist() == [False, True]


def test_batch_equals_one_by_one():
    approaches = np.linspace(-1.0, 2.0, 7)
    batch = respond(UNIT, approaches)
    for index, approach in enumerate(approaches.tolist()):
        assert [entry[index] for entry in batch] == pytest.approx(
            list(respond(UNIT, approach)), rel=1e-15
        )


@pytest.mark.parametrize(
    "phase", [0.0, 1e-6, 0.1, 1.0, math.pi / 2 - 1e-7, math.pi / 2, 2.0, 3.1, math.pi]
)
def test_closed_form_motion_keeps_energy_and_time(phase):
    """Theory §3: V² + zeta^2.5 = 1, and T against quadrature of dT/dx."""
    motion = hertz().motion(UNIT)
    time, approach, rate, contact, impulse = motion.at(phase)
    assert rate**2 + approach**2.5 == pytest.approx(1.0, abs=1e-14)
    assert contact.force == pytest.approx(1.25 * approach**1.5, rel=1e-13)
    assert contact.friction_load == contact.force
    assert impulse == pytest.approx(1.0 - rate, abs=1e-14)
    scaled = motion.scaled_at(phase)
    assert scaled.force * 1.25 == pytest.approx(contact.force, rel=1e-13)
    assert [scaled.approach, scaled.radius, scaled.rate] == pytest.approx(
        [approach, contact.radius, rate], abs=1e-14
    )
    exact, _ = quad(lambda x: motion.scaled_at(x).time_rate, 0.0, phase, epsabs=1e-13, epsrel=1e-13)
    assert time == pytest.approx(exact, abs=1e-12)


def test_motion_obeys_newton():
    """dV/dT = -P/M and d(zeta)/dT = V by central differences in the phase."""
    motion = hertz().motion(UNIT)
    step = 1e-5
    for phase in (0.3, 1.0, 1.6, 2.5):
        ahead, behind, here = motion.at(phase + step), motion.at(phase - step), motion.at(phase)
        duration = ahead[0] - behind[0]
        assert (ahead[1] - behind[1]) / duration == pytest.approx(here[2], rel=1e-6)
        assert (ahead[2] - behind[2]) / duration == pytest.approx(-here[3].force, rel=1e-6)


def test_duration_and_restitution_to_nine_digits_with_the_closed_form():
    """Eq. (7) and e = 1 to 1e-9."""
    scene = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.2, 1.5, 0.4)
    result = Simulation(tangential="coulomb", integrator="symplectic").run(scene)
    assert result.motion.duration == pytest.approx(hertz_scales(scene).duration, rel=1e-9)
    assert result.normal_restitution == pytest.approx(1.0, abs=1e-9)


class OpenHertz(NormalLaw):
    """Hertz's force, its closed form withheld."""

    api_version = 2
    start = staticmethod(hertz().start)
    respond = staticmethod(hertz().respond)


def test_the_solved_motion_finds_duration_and_restitution():
    """Section 2.1: eq. (7) checks the integration of (2), (5), (6)."""
    scene = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.2, 1.5, 0.4)
    found, scales = normal_motion(OpenHertz(), scene), hertz_scales(scene)
    assert found.duration == pytest.approx(scales.duration, rel=1e-8)
    assert -found.final_rate / 1.5 == pytest.approx(1.0, abs=1e-9)
    assert found.maximum_radius == pytest.approx(scales.radius, rel=1e-6)
    assert found.maximum_approach == pytest.approx(scales.approach, rel=1e-6)
    assert found.maximum_force == pytest.approx(scales.force, rel=1e-6)
    exact = hertz().motion(scene)
    for fraction in (0.01, 0.2, 0.5, 0.77, 0.99):
        here, there = found.at(found.phase(fraction)), exact.at(exact.phase(fraction))
        assert here.time == pytest.approx(there.time, rel=1e-7)
        assert here.rate == pytest.approx(there.rate, abs=1e-7 * 1.5)
        assert here.approach == pytest.approx(there.approach, abs=1e-7 * scales.approach)


@pytest.mark.parametrize(
    ("modulus", "ratio", "density", "speed", "two", "radius", "force", "approach", "time"),
    [
        (48e9, 0.20, 2800.0, 20.0, True, 0.01, 10.70e3, 274.96e-6, 40.48e-6),
        (20e9, 0.25, 2500.0, 20.0, True, 0.01, 7108.0, None, None),
        (70e9, 0.30, 2699.0, 0.2, False, 0.1, 11.357e3, 49.85e-6, 727.5e-6),
        (40e9, 0.35, 1800.0, 0.2, False, 0.1, 7233.0, None, None),
    ],
)
def test_against_the_hertz_scalars_of_other_codes(
    modulus, ratio, density, speed, two, radius, force, approach, time
):
    """Chung & Ooi (2011), tests 1 and 2, digitised from plots in other codes: 0.5 %, times 1 %."""
    sphere = Sphere(radius, Material(young_modulus=modulus, poisson_ratio=ratio, density=density))
    scene = Scene(sphere, sphere if two else HalfSpace(RIGID), 0.1, speed)
    scales = hertz_scales(scene)
    peak = respond(scene, scales.approach).force
    assert peak == pytest.approx(force, rel=5e-3)
    if approach is not None:
        assert scales.approach == pytest.approx(approach, rel=5e-3)
        assert scales.duration == pytest.approx(time, rel=1e-2)
