"""Thornton's and Walton and Braun's laws: restitution, contact radius, gross slip."""

import numpy as np
import pytest

import contactlab
from contactlab.impact.hertz import hertz_scales
from contactlab.solve.normal_motion import normal_motion
from tests.laws.normal_impacts import CALIBRATED, psi2, restitution, scene
from tests.longer import longer

CHI = 49 / 34


def thornton(ratio):
    """E of Thornton (1997), eq. (36), r = v_y/v < 1; theory §11."""
    r = ratio
    share = r / (r + 2.0 * np.sqrt(1.2 - r**2 / 5.0))
    return np.sqrt(6.0 * np.sqrt(3.0) / 5.0) * np.sqrt(1.0 - r**2 / 6.0) * share**0.25


RATIOS = [1e-4, 0.1, 0.999, *longer(1e-2, 0.5, 0.9)]


@pytest.mark.parametrize("ratio", RATIOS)
def test_restitution_of_thornton_is_his_formula(ratio):
    speed = 0.8
    law = contactlab.create("normal.thornton", yield_velocity=ratio * speed)
    assert restitution(law, scene(speed)) == pytest.approx(thornton(ratio), rel=1e-6)


def test_restitution_of_thornton_falls_as_the_fourth_root_of_speed():
    speeds = 10.0 ** np.arange(2.0, 6.0)
    law = contactlab.create("normal.thornton", yield_velocity=1e-3)
    e = restitution(law, scene(speeds))
    assert np.polyfit(np.log(speeds), np.log(e), 1)[0] == pytest.approx(-0.25, abs=1e-5)


def test_slower_than_the_yield_velocity_it_is_hertz():
    law, given = contactlab.create("normal.thornton", yield_velocity=0.5), scene(0.49)
    motion, scales = normal_motion(law, given), hertz_scales(given)
    assert -motion.final_rate == pytest.approx(0.49, rel=1e-8)
    for entry in ("duration", "maximum_radius", "maximum_approach", "maximum_force"):
        expected = getattr(scales, entry.removeprefix("maximum_"))
        assert getattr(motion, entry) == pytest.approx(expected, rel=2e-6), entry


def test_yield_pressure_is_the_greatest_of_the_slowest_impact_that_yields():
    """p_0 = 3 P/(2 pi a²) of Hertz's theory at v_y."""
    velocity = 0.1
    hertz = hertz_scales(scene(velocity))
    pressure = 1.5 * hertz.force / (np.pi * hertz.radius**2)
    laws = [
        contactlab.create("normal.thornton", yield_pressure=pressure),
        contactlab.create("normal.thornton", yield_velocity=velocity),
    ]
    one, other = (restitution(law, scene(1.0)) for law in laws)
    assert one == pytest.approx(other, rel=1e-9)
    with pytest.raises(ValueError, match=r"yield_velocity, yield_pressure = .*only one"):
        contactlab.create("normal.thornton", yield_velocity=0.1, yield_pressure=1e9)


@pytest.mark.parametrize("e", CALIBRATED)
def test_restitution_of_walton_and_braun(e):
    """sqrt(k1/k2), at any speed and stiffness."""
    for options in ({}, {"stiffness": 1e6}):
        law = contactlab.create("normal.walton_braun", restitution=e, **options)
        assert restitution(law, scene(np.array([0.01, 1.0, 20.0]))) == pytest.approx(e, rel=1e-7)


@pytest.mark.parametrize(
    ("name", "options"),
    [("thornton", {"yield_velocity": 0.01}), ("walton_braun", {"restitution": 0.5})],
)
def test_contact_is_wider_in_unloading(name, options):
    """Of the same force: the cap is flatter; and continuous where the motion turns."""
    law, given = contactlab.create(f"normal.{name}", **options), scene()
    motion = normal_motion(law, given)
    sample = motion.at(np.linspace(0.0, np.pi, 4001))
    turn = int(np.argmax(sample.approach))
    assert motion.maximum_radius**2 == pytest.approx(
        given.pair.radius * motion.maximum_approach, rel=1e-6
    )
    jumps = np.abs(np.diff(sample.contact.radius[turn - 20 : turn + 20]))
    assert jumps.max() < 1e-3 * motion.maximum_radius
    # At the same approach the contact in unloading is narrower, and ends before z = 0.
    depth = 0.9 * motion.maximum_approach
    forth, back = (
        np.interp(depth, *pair)
        for pair in (
            (sample.approach[:turn], sample.contact.radius[:turn]),
            (sample.approach[:turn:-1], sample.contact.radius[:turn:-1]),
        )
    )
    assert back < 0.97 * forth
    assert sample.approach[-1] > 0.4 * motion.maximum_approach
    if name == "thornton":  # at the same force it is wider
        force = 0.3 * motion.maximum_force
        forth = np.interp(force, sample.contact.force[:turn], sample.contact.radius[:turn])
        back = np.interp(force, sample.contact.force[:turn:-1], sample.contact.radius[:turn:-1])
        assert back > 1.05 * forth


def test_gross_slip_over_thornton_is_exact():
    """Up to first yield the pressure is Hertz's, and it never grows: 2 chi (1 + e)."""
    psi1 = np.array([8.0, 30.0])
    law = contactlab.create("normal.thornton", yield_velocity=0.05)
    expected = psi1 - 2.0 * CHI * (1.0 + thornton(0.05))
    assert psi2(law, psi1, CHI, springs=20) == pytest.approx(expected, abs=1e-8)


@pytest.mark.slow
def test_gross_slip_over_walton_and_braun_is_reached_asymptotically():
    """Stuck until zeta = (0.8/psi)²: psi2 is more by 0.2 chi (0.8/psi1)⁴, to leading order."""
    psi1, e = np.array([5.5, 7.0]), 0.7
    law = contactlab.create("normal.walton_braun", restitution=e)
    more = psi2(law, psi1, CHI, springs=400, steps=6400) - (psi1 - 2.0 * CHI * (1.0 + e))
    assert more == pytest.approx(0.2 * CHI * (0.8 / psi1) ** 4, rel=0.15, abs=1e-6)
