"""The least-squares problem by itself: weights, grids of starts, derivatives, F tests."""

import math

import numpy as np
import pytest
from scipy.stats import f as f_distribution

from contactlab.fitting.f_test import chance_of, orthonormal
from contactlab.fitting.problem import minimum, solved, starting
from tests.fitting.lines import X, line, option

Y = np.array([2.0, np.nan, 7.0, 9.0])
Z = np.array([6.0, 6.6, -7.0, np.nan])


def test_scales_are_stated_errors_or_the_rms_of_residuals():
    error = np.array([0.1, 0.2, 0.3, 0.4])
    found = line({"y": Y, "z": Z, "q": np.full(4, -4.0)}, errors={"z": error})
    plain = found.scales()
    assert plain["y"] == pytest.approx(math.sqrt((16.0 + 1.0 + 9.0) / 3.0))  # about their mean, 6
    assert plain["z"] is error
    assert plain["q"] == pytest.approx(4e-9)  # numbers that do not vary
    residuals = {name: np.array([[1.0, np.nan, 2.0, 2.0]]) for name in ("y", "z")}
    residuals["q"] = np.full((1, 4), 1e-3)
    told = found.scales(residuals)
    assert (told["y"], told["q"]) == (pytest.approx(math.sqrt(3.0)), pytest.approx(1e-3))
    assert told["z"] is error


def test_the_criterion_of_known_and_unknown_errors():
    """Sum of squares, 2 n log(scale) of each unknown scale, 2 for each parameter and scale."""
    measured = {"y": np.array([2.0, 4.5, 6.0, 8.5]), "z": np.array([6.0, 6.0, 6.2, np.nan])}
    values = np.array([2.0, 0.0])
    square, rms = 0.5, math.sqrt(0.125)
    half = 0.04 / 0.1**2
    known = {"z": np.full(4, 0.1)}
    found = line(measured, errors=known).criterion(values)
    assert found == pytest.approx(square / rms**2 + half + 8.0 * math.log(rms) + 2.0 * 3)
    both = line(measured).criterion(values)
    other = math.sqrt(0.04 / 3.0)
    logs = 8.0 * math.log(rms) + 6.0 * math.log(other)
    assert both == pytest.approx(4.0 + 3.0 + logs + 2.0 * 4)
    stated = known | {"y": np.full(4, 0.5)}
    assert line(measured, errors=stated).criterion(values) == pytest.approx(2.0 + half + 2.0 * 2)


@pytest.mark.parametrize(
    ("value", "ends"),
    [
        (2.0, (1.998, 2.002)),
        (-4.0, (-4.004, -3.996)),
        (0.0, (-0.001, 0.001)),
        (3.0, (2.997, 3.0)),
        (-5.0, (-5.0, -4.995)),
    ],
)
def test_derivatives_are_differences_inside_the_bounds(value, ends):
    """Of (a² - 1)², whose difference over the two ends is known."""
    found = line({"q": np.zeros(4)}, option("a", -5.0, 3.0))
    weighted, slopes = found.linearised(np.array([value]), {"q": 2.0})
    low, high = ((end**2 - 1.0) ** 2 for end in ends)
    assert weighted == pytest.approx([-((value**2 - 1.0) ** 2) / 2.0] * 4)
    assert slopes == pytest.approx(
        np.full((4, 1), -(high - low) / (ends[1] - ends[0]) / 2.0), abs=1e-9
    )
    assert found.model.calls == [3]  # one batch


@pytest.mark.parametrize(
    ("starts", "expected"),
    [
        ((-2.0, -1.1, 0.0, 0.8, 2.0), [-1.1, 0.8]),
        ((-3.0, 0.9, 5.0), [0.9]),
        ((-1.2, -0.2, 0.5), [-1.2, 0.5]),  # a minimum at either end of the grid
        ((-1.0, 1.0), [-1.0]),  # the first of two alike that are neighbours
        (tuple(np.linspace(-1.5, 1.5, 7)), [-1.0, 1.0]),
    ],
)
def test_searches_start_at_the_least_costs_of_the_grid(starts, expected):
    """(a² - 1)² has minima at -1 and 1; the best start comes first."""
    found = starting(line({"q": np.array([0.0, 0.0, 0.0, 1e-9])}, option("a", starts=starts)))
    cost = [(value**2 - 1.0) ** 2 for value in expected]
    expected = [expected[place] for place in np.argsort(cost, kind="stable")]
    assert [start[0] for start in found] == pytest.approx(expected)


def test_quantities_are_weighted_by_their_own_residuals():
    """Likelihood of two means of one number: the weights are those of the scatter about it."""
    rng = np.random.default_rng(3)
    y, z = 2.0 * X + 0.01 * rng.standard_normal(4), 6.3 + 0.3 * rng.standard_normal(4)
    one = option("a", starts=(1.0,))
    found = solved(line({"y": y, "z": z}, one), np.array([1.0]))[0]
    for _ in range(50):
        weights = 1.0 / np.mean((y - found * X) ** 2), 1.0 / np.mean((z - 3.0 * found) ** 2)
        above = weights[0] * (X @ y) + weights[1] * 3.0 * z.sum()
        found_again = above / (weights[0] * (X @ X) + weights[1] * 36.0)
        found, before = found_again, found
    assert found == pytest.approx(before, rel=1e-12)
    assert solved(line({"y": y, "z": z}, one), np.array([1.0]))[0] == pytest.approx(found, rel=1e-5)


def test_a_search_begins_and_ends_inside_the_bounds():
    bounded = line({"y": 2.0 * X}, option("a", 0.0, 1.5))
    assert minimum(bounded, np.array([9.0]), {"y": 1.0})[0] == pytest.approx(1.5, abs=1e-6)
    assert minimum(bounded, np.array([-9.0]), {"y": 1.0})[0] == pytest.approx(1.5, abs=1e-6)


def test_a_robust_loss_is_hardly_moved_by_one_far_number():
    far = 2.0 * X + np.array([0.0, 0.0, 0.0, 50.0])
    one = line({"y": far}, option("a"))
    plain = minimum(one, np.array([1.0]), {"y": 1e-2})[0]
    assert plain == pytest.approx(2.0 + 200.0 / 30.0)
    robust = minimum(one, np.array([1.0]), {"y": 1e-2}, loss="soft_l1")[0]
    assert robust == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize(("numbers", "least"), [(12, 0.0), (12, 0.3), (6, 0.0), (5, 0.0)])
def test_the_chance_of_added_terms(numbers, least):
    """By lstsq and scipy's distribution; 1 with fewer than three degrees of freedom."""
    rng = np.random.default_rng(numbers)
    slopes, terms = rng.standard_normal((numbers, 1)), rng.standard_normal((numbers, 2))
    residuals = rng.standard_normal(numbers) + terms @ [2.0, 0.0]

    def left(columns):
        found = np.linalg.lstsq(columns, residuals, rcond=None)[0]
        return float(np.sum((residuals - columns @ found) ** 2))

    freedom = numbers - 3
    plain, curved = left(slopes), left(np.hstack([slopes, terms]))
    ratio = (plain - curved) / 2.0 / (curved / freedom + least)
    expected = f_distribution.sf(ratio, 2, freedom) if freedom >= 3 else 1.0
    assert chance_of(residuals, slopes, terms, least) == pytest.approx(expected, rel=1e-9)


def test_columns_of_zeros_span_nothing():
    columns = np.array([[3.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 0.0, 1e-9]])
    basis = orthonormal(columns)
    assert basis.shape == (3, 2)
    assert basis.T @ basis == pytest.approx(np.eye(2))
    assert basis @ (basis.T @ columns) == pytest.approx(columns, abs=1e-12)
