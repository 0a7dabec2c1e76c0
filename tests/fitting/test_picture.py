"""The picture of a fit."""

import attrs
import numpy as np
from matplotlib.figure import Figure

from contactlab import Simulation
from contactlab.outcome.style import label
from contactlab_fit import fit
from contactlab_fit.figures import draw_measurements
from tests.fitting.impacts import ANGLES, BODIES, restitution, table


def test_impacts_at_one_angle_are_no_step_of_the_curve():
    """Twice the same angles: the curve goes through each once, the points are all there."""
    angles = np.tile(ANGLES, 2)
    found = fit(table(restitution(0.12, angles), angles), BODIES)
    axes = draw_measurements(Figure().add_subplot(), {"exact": found}, "tangential_restitution")
    curve, points = axes.lines[:2]
    x, y = curve.get_data()
    assert (np.diff(x) > 0.0).all()
    np.testing.assert_allclose(y[np.searchsorted(x, ANGLES)], restitution(0.12), atol=1e-6)
    assert sorted(points.get_xdata()) == sorted(angles)


def test_measurements_without_an_angle_are_drawn_against_what_varied():
    """At the normal speed of the scene, and with a column that is the same throughout."""
    slip = np.array([0.1, 0.2, 0.3, 0.4])
    rebounds = Simulation().sweep(attrs.evolve(BODIES, tangential_velocity=slip)).check()
    measured = {"spin (rad/s)": np.zeros(4), "tangential_velocity (m/s)": slip,
                "tangential_restitution": rebounds.tangential_restitution}  # fmt: skip
    found = fit(measured, BODIES)
    axes = draw_measurements(Figure().add_subplot(), {"exact": found}, "tangential_restitution")
    assert axes.get_xlabel() == label("tangential_velocity", "m/s")
    assert sorted(axes.lines[1].get_xdata()) == slip.tolist()
