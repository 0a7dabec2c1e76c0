"""Fields of the half-space: tractions along one direction, and instants by hand."""

import math

import numpy as np
import pytest

from contactlab import Scene, Simulation
from contactlab_laws.halfspace import picture
from contactlab_laws.halfspace.course import units
from contactlab_laws.halfspace.picture import Picture
from tests.laws.test_halfspace_parts import CHI, law, one


def small():
    """Pressure 2 at both instants, 0 at touch; tractions 1 and 2 at two rings, then 1 and 0."""
    values = np.zeros((5, 3, 1, 2))
    values[4, 1:] = 2.0
    values[0, 1, 0], values[1, 2, 0] = (1.0, 2.0), (2.0, 0.0)
    values[4, 2, 0, 1] = 0.0
    return Picture(np.array([0.0, 1.0, 3.0]), np.array([0.0, 0.5]), values)


@pytest.mark.parametrize(
    ("impulse", "last", "share"),
    [(-1.0, 1, 0.0), (0.0, 1, 0.0), (0.25, 1, 0.25), (1.0, 1, 1.0), (2.0, 2, 0.5), (9.0, 2, 1.0)],
)
def test_an_instant_between_two(impulse, last, share):
    assert picture._around(small(), impulse) == (last, share)
    found = picture._between(small(), impulse)
    expected = (1.0 - share) * small().values[:, last - 1] + share * small().values[:, last]
    assert found == pytest.approx(expected)


def test_two_instants_of_one_impulse_are_the_later():
    both = small()._replace(impulse=np.array([0.0, 0.0, 3.0]))
    assert picture._around(both, 0.0) == (1, 1.0)


def test_points_stick_below_the_limit_at_the_end_of_a_step():
    """Where the contact has gone by then: at its beginning."""
    assert picture._stuck(small(), 0.5).tolist() == [[True, False]]
    assert picture._stuck(small(), 2.0).tolist() == [[False, False]]
    made = small()
    made.values[0, 1, 0] = 1.0
    assert picture._stuck(made, 2.0).tolist() == [[False, True]]


def test_fields_along_one_direction():
    """Hertz's pressure at greatest compression; tractions that add up to the force."""
    slip = 1.2 * 0.4 * 0.5 / one().pair.stiffness_ratio
    scene = one(slip=slip)
    history = law(rings=16, angles=1).run(scene, history="fields").check().history
    shown = history.fields
    assert shown["traction_x"].shape == (len(history.time), 1, 16)
    assert shown["angle"][0] == pytest.approx([0.5 * math.pi])
    assert (shown["traction_y"] == 0.0).all()
    assert (shown["slip_y"] == 0.0).all()
    middle = int(np.argmax(history.normal_force))
    unit = units(Simulation().normal_motion(scene))
    radius = shown["radius"][middle]
    hertz = 1.5 * unit.force[0] / (math.pi * unit.length[0] ** 2)
    assert shown["pressure"][middle, 0] == pytest.approx(
        hertz * np.sqrt(1.0 - (radius / unit.length[0]) ** 2), rel=0.01, abs=0.03 * hertz
    )
    # Between inner edges c (e² - r²)^½: the weights of Hertz's own pressure carry its force.
    weights = 2.0 * np.pi * np.gradient(radius) * radius
    for k in range(len(history.time) // 4, 3 * len(history.time) // 4, 7):
        found = shown["traction_x"][k, 0] @ weights / (shown["pressure"][k, 0] @ weights)
        known = history.tangential_force[k] / history.normal_force[k]
        assert found == pytest.approx(known, abs=0.02)
    limit = 0.4 * shown["pressure"] * (1.0 + 1e-6)
    assert (np.abs(shown["traction_x"]) <= limit + 1e-9 * hertz).all()
    assert shown["stuck"][middle].any()
    assert not shown["stuck"][middle].all()
    assert not shown["stuck"][shown["pressure"] == 0.0].any()


def test_gross_slip_has_the_limit_everywhere_and_moves_as_the_bodies_do():
    scene = Scene.nondimensional(psi1=9.0, chi=CHI, friction_coefficient=0.4)
    history = law(rings=8, angles=2, extrapolate=False).run(scene, history="fields").history
    shown = history.fields
    touching = shown["pressure"] > 0.0
    assert shown["traction_x"][touching] == pytest.approx(0.4 * shown["pressure"][touching])
    assert not shown["stuck"].any()
    assert (np.diff(shown["slip_x"][:, 0, 0]) > 0.0).all()
