"""Hunt and Crossley's law and the viscoelastic one: calibration, series, gross slip."""

import numpy as np
import pytest

import contactlab
from contactlab.impact.hertz import hertz_scales
from contactlab_laws.kuwabara_kono import viscosity_number
from tests.laws.by_hand import rebound
from tests.laws.exact_laws import order
from tests.laws.normal_impacts import CALIBRATED, psi2, restitution, scene
from tests.longer import longer

SPEEDS = np.array([1e-3, 1.0, 30.0])
CHI = 49 / 34


@pytest.mark.parametrize("e", CALIBRATED)
@pytest.mark.parametrize("name", ["hunt_crossley", "kuwabara_kono"])
def test_calibrated_restitution_at_any_speed(name, e):
    law = contactlab.create(f"normal.{name}", restitution=e)
    assert restitution(law, scene(SPEEDS)) == pytest.approx(e, rel=1e-7)


INTEGRATED = [
    *((number, "DOP853") for number in (0.01, 0.1, 1.0)),
    *longer((0.3, "Radau")),
]


@pytest.mark.parametrize(("number", "method"), INTEGRATED)
def test_viscoelastic_restitution_by_integration(number, method):
    """In SI by contactlab, in scaled variables by the test."""

    def force(z, rate):
        inside = max(z, 0.0)
        return 1.25 * inside**0.5 * (inside + 1.5 * number * rate)

    given = scene(0.7)
    time = number * hertz_scales(given).approach / given.normal_speed
    law = contactlab.create("normal.kuwabara_kono", relaxation_time=time)
    tolerance = 1e-8 if method == "DOP853" else 3e-8
    assert restitution(law, given) == pytest.approx(rebound(force, method=method), abs=tolerance)


def test_viscoelastic_restitution_is_its_series():
    """1 - e = C x - (3/5) C² x² + ..., x = 1.5 A (k/M)^(2/5) v^(1/5): theory §11."""
    speeds = 10.0 ** np.arange(-12.0, -4.0)
    given, time, constant = scene(speeds), 1e-6, 1.15344
    law = contactlab.create("normal.kuwabara_kono", relaxation_time=time)
    lost = 1.0 - restitution(law, given)
    assert np.polyfit(np.log(speeds), np.log(lost), 1)[0] == pytest.approx(0.2, abs=2e-3)
    pair = given.pair
    k = (4.0 / 3.0) * pair.effective_modulus * pair.radius**0.5
    x = 1.5 * time * (k / pair.normal_mass) ** 0.4 * speeds**0.2
    assert x[:2] == pytest.approx(x[0], rel=1.0)
    assert x[0] < 1e-3
    assert lost[:2] / x[:2] == pytest.approx(constant, rel=2e-3)
    second = (lost - constant * x) / x**2
    assert second[-1] == pytest.approx(-0.6 * constant**2, rel=0.1)


@pytest.mark.parametrize("number", [0.01, 0.3, 3.0])
def test_restitution_of_hunt_and_crossley_is_its_integral(number):
    """D (1 + e) = ln((1 + d)/(1 - e d)) of d = lambda v1, and 1 - e = 2 d/3 at first."""
    speed = 0.6
    law = contactlab.create("normal.hunt_crossley", damping=number / speed)
    e = restitution(law, scene(speed))
    assert number * (1.0 + e) == pytest.approx(
        np.log((1.0 + number) / (1.0 - e * number)), rel=1e-7
    )
    if number == 0.01:
        assert 1.0 - e == pytest.approx(2.0 * number / 3.0, rel=0.01)


@pytest.mark.parametrize("e", [0.5, 0.9])
def test_gross_slip_over_hunt_and_crossley_is_exact(e):
    """Its pressure is finite at first touch: slip throughout takes 2 chi (1 + e) from psi."""
    psi1 = np.array([10.0, 30.0])
    law = contactlab.create("normal.hunt_crossley", restitution=e)
    found = psi2(law, psi1, CHI, springs=20)
    assert found == pytest.approx(psi1 - 2.0 * CHI * (1.0 + e), abs=1e-8)


@pytest.mark.parametrize(("e", "bound"), [(0.95, 0.05), *longer((0.9, 0.1))])
def test_gross_slip_over_viscoelastic_contact_is_reached_asymptotically(e, bound):
    """Stuck until zeta = 1.5 A/(psi - 1): psi2 is more by (2/3) chi (1.5 A)^2.5/(psi1 - 1)^1.5.

    A in units of z_max/v1, to leading order: ``bound`` is relative.
    """
    psi1 = np.array([8.0, 12.0])
    law = contactlab.create("normal.kuwabara_kono", restitution=e)
    more = psi2(law, psi1, CHI, springs=400, steps=6400) - (psi1 - 2.0 * CHI * (1.0 + e))
    expected = 2.0 / 3.0 * CHI * (1.5 * viscosity_number(e)) ** 2.5 / (psi1 - 1.0) ** 1.5
    assert more == pytest.approx(expected, rel=bound, abs=2e-7)


@pytest.mark.parametrize(
    ("name", "other"), [("hunt_crossley", "damping"), ("kuwabara_kono", "relaxation_time")]
)
def test_two_options_for_one_thing_are_refused(name, other):
    create = contactlab.create
    with pytest.raises(
        ValueError, match=rf"restitution, {other} = [(].*[)]: only one.*leave one out"
    ):
        create(f"normal.{name}", **{"restitution": 0.9, other: 1e-6})
    with pytest.raises(ValueError, match=r"restitution = 1.2.*from 0.01 to 1"):
        create(f"normal.{name}", restitution=1.2)
    with pytest.raises(ValueError, match=rf"{other} = -1.0.*zero or positive"):
        create(f"normal.{name}", **{other: -1.0})
    untold, told = create(f"normal.{name}"), create(f"normal.{name}", restitution=0.9)
    assert untold != told  # nobody gave the number of the first
    assert restitution(untold, scene()) == restitution(told, scene())
    assert restitution(create(f"normal.{name}", **{other: 0.0}), scene()) == pytest.approx(1.0)


def test_restitution_of_a_material_falls_with_speed():
    law = contactlab.create("normal.hunt_crossley", damping=0.1)
    e = restitution(law, scene(np.array([0.01, 0.02, 0.04])))
    assert order([1.0, 2.0, 4.0], 1.0 / (1.0 - e)) == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("distance", [1e-6, 1e-12, 1e-13, 1e-15])
def test_a_restitution_next_to_one_is_calibrated(distance):
    """Theory §11: 1 - e = 1.1534 (1.5 A) (k/M)^(2/5) v1^(1/5), with k/M = 5/4 in scaled units."""
    number = viscosity_number(1.0 - distance)
    assert number == pytest.approx(distance / (1.1534 * 1.5 * 1.25**0.4), rel=1e-3, abs=2e-12)
