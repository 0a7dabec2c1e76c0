"""Results drawn by one call: what is on the Axes is what the result says."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactlab import Scene, Simulation
from contactlab.outcome.history_figure import draw_history


@pytest.fixture
def axes():
    return Figure().subplots()


@pytest.fixture(scope="module")
def many():
    psi1 = [3.0, 0.0, 5.0, 1.0]
    return Simulation(tangential="coulomb").run(Scene.nondimensional(psi1=psi1, chi=1.0))


def test_a_batch_is_psi2_over_psi1_in_order(axes, many):
    assert many.plot(axes=axes) is axes
    (line,) = axes.lines
    np.testing.assert_array_equal(line.get_xdata(), [0.0, 1.0, 3.0, 5.0])
    np.testing.assert_array_equal(line.get_ydata(), [0.0, 0.0, 0.0, 1.0])
    assert line.get_marker() == ""
    assert "psi_1" in axes.get_xlabel()


def test_any_columns_angles_in_degrees_too(axes, many):
    many.plot("psi1", "local_rebound_angle_deg", axes=axes)
    (line,) = axes.lines
    assert line.get_ydata()[-1] == pytest.approx(45.0)
    assert "°" in axes.get_ylabel()


def test_an_error_that_cannot_be_seen_has_no_band(axes, many):
    assert not many.plot(axes=axes).collections


def test_one_impact_is_its_force_over_time(axes):
    result = Simulation().run(Scene.nondimensional(psi1=2.0, chi=1.4), history=True)
    result.plot(axes=axes)
    force = axes.lines[-1].get_ydata()
    assert force.max() == pytest.approx(
        result.history.tangential_force.max() / result.motion.maximum_force
    )
    upper, lower = (line.get_ydata() for line in axes.lines[-3:-1])
    np.testing.assert_array_equal(upper, -lower)
    assert upper.max() == pytest.approx(1.0, abs=1e-3)
    assert draw_history(Figure().subplots(), result.history).get_xlabel() == "time (s)"


def test_a_quantity_that_no_impact_defines_is_refused(axes, many):
    with pytest.raises(ValueError, match="defined for none"):
        many.plot("psi1", "rebound_spin", axes=axes)


def test_a_single_impact_needs_a_history(axes):
    result = Simulation().run(Scene.nondimensional(psi1=2.0, chi=1.4))
    with pytest.raises(ValueError, match=r"history=True"):
        result.plot(axes=axes)
    with pytest.raises(ValueError, match="many impacts"):
        result.plot("psi1", axes=axes)
