"""The picture of a fit."""

import numpy as np
from matplotlib.figure import Figure

from contactlab import fit
from contactlab.figures.fitting import measured_and_laws
from tests.fitting.impacts import ANGLES, BODIES, restitution, table


def test_impacts_at_one_angle_are_no_step_of_the_curve():
    """Twice the same angles: the curve goes through each once, the points are all there."""
    angles = np.tile(ANGLES, 2)
    found = fit(table(restitution(0.12, angles), angles), BODIES)
    axes = measured_and_laws(Figure().add_subplot(), {"exact": found}, "tangential_restitution")
    curve, points = axes.lines[:2]
    np.testing.assert_array_equal(curve.get_xdata(), ANGLES)
    np.testing.assert_allclose(curve.get_ydata(), restitution(0.12), atol=1e-6)
    assert sorted(points.get_xdata()) == sorted(angles)
