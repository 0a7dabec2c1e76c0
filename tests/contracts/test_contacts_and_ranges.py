"""Contacts without friction load or tension, and the range of psi2, at and beside their bounds."""

import math
import warnings

import numpy as np
import pytest

from contactlab import Scene
from contactlab.contracts import NormalContact
from contactlab.contracts.contact import without_tension
from contactlab.impact.error_model import range_of
from contactlab.testing.load_paths import scene

NAN = math.nan


@pytest.mark.parametrize(
    ("force", "load", "complete"),
    [(3.0, None, 3.0), (-3.0, None, 0.0), (0.0, None, 0.0), (3.0, 1.0, 1.0), (-3.0, 0.5, 0.5)],
)
def test_a_contact_without_friction_load_has_its_pressure(force, load, complete):
    assert NormalContact(force, 1.0, 1.0, load).complete == (force, 1.0, 1.0, complete)
    many = NormalContact(np.array([force, 1.0]), 1.0, 1.0, load).complete
    assert np.broadcast_to(many.friction_load, 2)[0] == complete


def test_a_contact_of_nan_has_a_load_of_nan():
    assert math.isnan(NormalContact(NAN, 1.0, 1.0).complete.friction_load)
    loads = NormalContact(np.array([NAN, -1.0, 2.0]), 1.0, 1.0).complete.friction_load
    assert loads == pytest.approx([NAN, 0.0, 2.0], nan_ok=True)
    assert not np.signbit(loads[1])


@pytest.mark.parametrize(
    ("force", "approach", "expected"),
    [
        (2.0, 0.5, (2.0, 0.1, 0.5)),
        (0.0, 0.5, (0.0, 0.0, -0.5)),
        (-1.0, 0.5, (0.0, 0.0, -0.5)),
        (-1.0, -0.5, (0.0, 0.0, -0.5)),
        (2.0, -0.5, (2.0, 0.1, 0.5)),
        (2.0, 0.0, (2.0, 0.1, 1e-300)),
        (0.0, 0.0, (0.0, 0.0, -1e-300)),
        (NAN, 0.5, (NAN, 0.1, 0.5)),
    ],
)
def test_a_contact_without_tension_ends_where_nothing_presses(force, approach, expected):
    contact = without_tension(force, 0.1, approach)
    assert contact[:3] == pytest.approx(expected, nan_ok=True, rel=1e-12, abs=0.0)
    assert contact.friction_load is None
    many = without_tension(np.array([force, 1.0]), np.array([0.1, 0.2]), np.array([approach, 1.0]))
    assert [entry[0] for entry in many[:3]] == pytest.approx(expected, nan_ok=True, abs=0.0)
    assert [entry[1] for entry in many[:3]] == [1.0, 0.2, 1.0]


@pytest.mark.parametrize(
    ("psi1", "chi", "width"),
    [  # in psi: the lesser of 4 chi and of 2 psi1
        (1.0, 0.4, 1.6),
        (-1.0, 0.4, 1.6),
        (0.8, 0.4, 1.6),
        (0.5, 0.4, 1.0),
        (-0.5, 0.4, 1.0),
        (0.0, 0.4, 0.0),
        (40.0, 3.0, 12.0),
    ],
)
def test_the_range_is_the_lesser_of_gross_slip_and_twice_the_slip_velocity(psi1, chi, width):
    impact = scene(psi1, chi)
    unit = 0.3 * 0.83 / impact.pair.stiffness_ratio
    found = range_of(impact)
    assert found == pytest.approx((unit, width * unit, abs(psi1) * unit), rel=1e-12)
    many = range_of(scene(np.array([psi1, 1.0]), chi))
    assert many.width[0] == pytest.approx(width * unit, rel=1e-12)
    assert many.speed[0] == pytest.approx(abs(psi1) * unit, rel=1e-12)


def test_the_range_of_a_huge_scene_warns_of_nothing():
    pair = scene(1.0, 1.0).pair
    huge = Scene(None, None, np.array([1e305, 0.3]), np.array([1e5, 0.83]), 0.1, pair=pair)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = range_of(huge)
    assert found.unit[0] == math.inf
    assert found.width == pytest.approx([0.2, 0.2])
