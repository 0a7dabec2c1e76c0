"""Closed-form motions in SI and scaled: one told by the other, greatest values by search."""

import math

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create

STEEL = Material.named("steel")
LAWS = [
    ("hertz", {}, 1.0),
    ("tsuji", {"restitution": 0.7}, 0.7),
    ("tsuji", {"restitution": 0.05}, 0.05),
    ("linear", {"restitution": 0.5}, 0.5),
    ("linear", {"restitution": 1.0}, 1.0),
    ("linear", {"restitution": 0.9, "stiffness": 1e7}, 0.9),
]


def impact(speed=0.7):
    return Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.3, speed, 0.15)


def motion(name, options, speed=0.7):
    return Simulation(normal=create(f"normal.{name}", **options)).normal_motion(impact(speed))


@pytest.mark.parametrize(("name", "options", "e"), LAWS)
def test_greatest_values_and_ends(name, options, e):
    made, pair = motion(name, options), impact().pair
    phases = np.linspace(0.0, math.pi, 4001)
    sample = made.at(phases)
    assert sample.approach.max() == pytest.approx(made.maximum_approach, rel=1e-6)
    assert sample.contact.force.max() == pytest.approx(made.maximum_force, rel=1e-5)
    assert sample.contact.radius.max() == pytest.approx(made.maximum_radius, rel=1e-6)
    assert made.maximum_radius == pytest.approx(math.sqrt(0.01 * made.maximum_approach))
    assert sample.time[[0, -1]] == pytest.approx([0.0, made.duration], rel=1e-9)
    assert sample.rate[[0, -1]] == pytest.approx([0.7, -e * 0.7], rel=1e-9)
    assert made.final_rate == pytest.approx(-e * 0.7)
    momentum = pair.normal_mass * 0.7
    assert sample.load_impulse[[0, -1]] == pytest.approx([0.0, (1.0 + e) * momentum], abs=1e-12)
    assert made.total_load_impulse == pytest.approx((1.0 + e) * momentum)


@pytest.mark.parametrize(("name", "options", "e"), LAWS)
def test_rates_are_slopes_and_newton_holds(name, options, e):
    """The approach by the trapezoidal rule of the rate, the momentum by that of the force."""
    made, pair = motion(name, options), impact().pair
    sample = made.at(made.phase(np.linspace(0.0, 1.0, 2001)))
    step = np.diff(sample.time)
    assert step == pytest.approx(np.full(2000, made.duration / 2000), rel=1e-6)
    gone = np.cumsum(0.5 * (sample.rate[1:] + sample.rate[:-1]) * step)
    assert sample.approach[1:] == pytest.approx(gone, abs=1e-5 * made.maximum_approach)
    force = sample.contact.force
    passed = np.cumsum(0.5 * (force[1:] + force[:-1]) * step)
    scale = pair.normal_mass * 0.7
    assert sample.load_impulse[1:] == pytest.approx(passed, abs=1e-3 * scale)
    assert pair.normal_mass * (0.7 - sample.rate) == pytest.approx(
        sample.load_impulse, abs=1e-12 * scale
    )


@pytest.mark.parametrize(("name", "options", "e"), LAWS)
def test_scaled_motions_are_those_in_si_over_their_greatest_values(name, options, e):
    made = motion(name, options)
    phases = np.array([0.3, 1.2, 2.0, 2.9])
    sample, scaled = made.at(phases), made.scaled(phases)
    assert scaled.phase.tolist() == phases.tolist()
    assert scaled.approach * made.maximum_approach == pytest.approx(sample.approach)
    assert scaled.radius * made.maximum_radius == pytest.approx(sample.contact.radius)
    assert scaled.rate * 0.7 == pytest.approx(sample.rate)
    assert scaled.force * made.maximum_force == pytest.approx(sample.contact.force)
    h = 1e-5
    pace = (made.at(phases + h).time - made.at(phases - h).time) / (2.0 * h)
    unit = made.maximum_approach / 0.7
    assert scaled.time_rate * unit == pytest.approx(pace, rel=1e-5)
    # V' = -P/M, with time in units of the greatest approach over the speed.
    slope = (made.at(phases + h).rate - made.at(phases - h).rate) / (2.0 * h) / 0.7
    assert slope / scaled.time_rate == pytest.approx(-scaled.force / made.scaled_mass, rel=1e-5)
    for k, phase in enumerate(phases.tolist()):
        alone = made.scaled_at(phase)
        assert alone == pytest.approx([column[k] for column in scaled])
        assert all(type(value) is float for value in alone)
    assert made.phase_at_rate(scaled.rate) == pytest.approx(phases, abs=1e-9)


@pytest.mark.parametrize(("name", "options", "e"), LAWS)
def test_a_part_of_a_batch_moves_as_alone(name, options, e):
    speeds = np.array([0.7, 0.2])
    part = motion(name, options, speeds).take(1)
    alone = motion(name, options, 0.2)
    for field in ("duration", "maximum_radius", "maximum_force", "final_rate"):
        assert getattr(part, field) == pytest.approx(getattr(alone, field))
