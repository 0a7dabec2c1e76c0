"""One step of order 8 beside scipy's own, and of many systems beside each alone."""

import numpy as np
import pytest
from scipy.integrate import DOP853

from contactlab.numeric.runge_kutta import Alone, attempt

POINTS = np.array([0.0, 0.1, 0.35, 0.8, 1.0])
TOLERANCE, WIDTH = 1e-6, 0.7


def pendulum(place):
    return np.array([place[1], -np.sin(place[0]), place[0] * place[1]])


BEGIN = np.array([[1.2, -0.4], [0.3, 1.0], [-2.0, 0.5]])


@pytest.mark.parametrize("item", [0, 1])
def test_a_step_is_that_of_scipy(item):
    """End, polynomial and error; scipy takes the mean over the values, not their sum."""
    solver = DOP853(
        lambda _, y: pendulum(y), 0.0, BEGIN[:, item], 10.0,
        first_step=WIDTH, rtol=TOLERANCE, atol=TOLERANCE,
    )  # fmt: skip
    begin = solver.y
    solver.step()
    assert solver.t == WIDTH
    dense = solver.dense_output()(POINTS * WIDTH)
    scale = TOLERANCE * (1.0 + np.maximum(np.abs(begin), np.abs(solver.y)))
    error = solver._estimate_error_norm(solver.K, WIDTH, scale) * np.sqrt(3.0)
    widths = np.array([WIDTH, WIDTH])
    tried = attempt(pendulum, BEGIN, widths, tolerance=TOLERANCE, points=POINTS)
    assert tried.course.shape == (5, 3, 2)
    assert pytest.approx(dense, rel=1e-13, abs=1e-14) == tried.course[..., item].T
    assert tried.course[-1, :, item] == pytest.approx(solver.y, rel=1e-14)
    assert tried.error[item] == pytest.approx(error, rel=1e-6)
    assert 1e-6 < tried.error[item] < 1.0


def test_each_system_has_a_width_of_its_own():
    widths = np.array([0.2, 0.7])
    both = attempt(pendulum, BEGIN, widths, tolerance=TOLERANCE, points=POINTS)
    for item, width in enumerate(widths):
        one = attempt(
            pendulum, BEGIN[:, [item]], np.array([width]), tolerance=TOLERANCE, points=POINTS
        )
        assert np.array_equal(one.course[..., 0], both.course[..., item])
        assert one.error[0] == both.error[item]


@pytest.mark.parametrize("item", [0, 1])
def test_a_step_in_plain_numbers_is_the_same(item):
    begin = BEGIN[:, item].tolist()

    def slope(place):
        return pendulum(np.array(place)).tolist()

    step = Alone(slope, begin, slope(begin), WIDTH, tolerance=TOLERANCE)
    many = attempt(pendulum, BEGIN, np.full(2, WIDTH), tolerance=TOLERANCE, points=POINTS)
    # The weights cancel to the tolerance, so sums in another order differ by eps over it.
    assert step.error == pytest.approx(many.error[item], rel=1e-9)
    assert step.last == pytest.approx(slope(step.end), rel=1e-15)
    for point, place in zip(POINTS.tolist(), many.course[..., item], strict=True):
        assert step.at(point) == pytest.approx(place, rel=1e-14)
    still = Alone(lambda _place: [0.0] * 3, begin, [0.0] * 3, WIDTH, tolerance=TOLERANCE)
    assert (still.error, still.end) == (0.0, begin)
    lost = Alone(lambda _place: [np.nan] * 3, begin, begin, WIDTH, tolerance=TOLERANCE)
    assert np.isnan(lost.error)


def test_what_does_not_move_has_no_error_and_what_is_no_number_has_none_either():
    still = attempt(np.zeros_like, BEGIN, np.ones(2), tolerance=TOLERANCE, points=POINTS)
    assert still.error.tolist() == [0.0, 0.0]
    assert np.array_equal(still.course, np.broadcast_to(BEGIN, (5, 3, 2)))

    def broken(place):
        return np.where(np.arange(2) == 1, np.nan, place)

    found = attempt(broken, BEGIN, np.ones(2), tolerance=TOLERANCE, points=POINTS)
    assert np.isnan(found.error).tolist() == [False, True]
