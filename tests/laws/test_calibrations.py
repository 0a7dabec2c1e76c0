"""Normal laws with a constant of the material in place of a restitution, and back."""

import math

import pytest

from contactlab import Scene, Simulation, create
from contactlab.impact.hertz import hertz_scales
from contactlab_laws.hunt_crossley import damping_number
from contactlab_laws.thornton import Thornton
from tests.laws.normal_laws import in_si


def restitution(scene=None, **laws):
    """Return e of an impact under the one law given: its options by its name."""
    ((name, options),) = laws.items()
    scene = in_si(Scene.nondimensional(psi1=1.0, chi=1.2)) if scene is None else scene
    motion = Simulation(normal=create(f"normal.{name}", **options)).normal_motion(scene)
    return -float(motion.final_rate) / float(scene.normal_speed)


@pytest.mark.parametrize("e", [0.3, 0.9, 0.999])
def test_the_damping_number_of_hunt_and_crossley(e):
    """d (1 + e) = ln((1 + d)/(1 - e d)), and the impact comes back with e."""
    d = damping_number(e)
    assert d * (1.0 + e) == pytest.approx(math.log((1.0 + d) / (1.0 - e * d)), rel=1e-9)
    assert (1.0 - e) / e < d < 1.0 / e
    scene = in_si(Scene.nondimensional(psi1=1.0, chi=1.2))
    found = restitution(hunt_crossley={"damping": d / float(scene.normal_speed)})
    assert found == pytest.approx(e, abs=1e-6)
    assert damping_number(1.0) == 0.0


@pytest.mark.parametrize(("number", "e"), [(0.0, 1.0), (0.02, None)])
def test_a_relaxation_time_is_a_number_of_the_impact(number, e):
    """A v1/z_max: the loss is, to first order, the work of the damping along Hertz's motion."""
    scene = in_si(Scene.nondimensional(psi1=1.0, chi=1.2))
    unit = hertz_scales(scene).approach / scene.normal_speed
    found = restitution(kuwabara_kono={"relaxation_time": number * unit})
    if e is not None:
        assert found == pytest.approx(e, abs=1e-7)
        return
    # The loss is that of the damping force 1.5 A k z^½ z' along Hertz's motion: with zeta and V
    # of V² = 1 - zeta^2.5 it is 2 * 1.5 * 1.25 of the integral of zeta^½ V over zeta.
    from scipy.integrate import quad

    integral = quad(lambda z: math.sqrt(z) * math.sqrt(1.0 - z**2.5), 0.0, 1.0)[0]
    lost = 2.0 * 1.5 * number * 1.25 * 2.0 * integral
    assert 1.0 - found**2 == pytest.approx(lost, rel=0.05)


def test_the_two_ways_to_say_where_a_sphere_yields():
    """The pressure at the centre, (2 E*/pi) sqrt(z_y/R), of the slowest impact that yields."""
    scene = Scene.nondimensional(psi1=1.0, chi=1.2)
    speed = 0.3 * float(scene.normal_speed)
    by_speed = Thornton(yield_velocity=speed).start(scene)
    pair = scene.pair
    energy = 0.5 * pair.normal_mass * speed**2
    assert 0.4 * by_speed.stiffness * by_speed.yielding**2.5 == pytest.approx(energy)
    pressure = 2.0 * pair.effective_modulus / math.pi * math.sqrt(by_speed.yielding / pair.radius)
    by_pressure = Thornton(yield_pressure=pressure).start(scene)
    assert by_pressure == pytest.approx(by_speed)
    assert by_speed.deepest == 0.0
