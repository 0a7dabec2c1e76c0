"""Outliers, patterns and leverage of a straight line through the origin, in closed form."""

import math
import re

import numpy as np
import pytest
from scipy.special import comb
from scipy.stats import f as f_distribution

from contactlab_fit import outliers, patterns
from contactlab_fit.outliers import Outliers
from contactlab_fit.problem import Problem
from tests.fitting.lines import line, option

NOISE = 0.01 * np.array([1.0, -1.0, 0.5, -0.7, 0.9, -0.4, 0.3, -0.8, 0.6, -0.5, 0.2, -0.1])


def through_origin(count, off=(), *, errors=None, more=None):
    """Return the problem y = 2 x with scatter and some numbers (from 0) far off."""
    x = np.arange(1.0, count + 1.0)
    y = 2.0 * x + np.resize(NOISE, count)
    for place, size in dict(off).items():
        y[place] += size
    return line({"y": y} | (more or {}), option("a", starts=(1.0, 2.0)), errors=errors, x=x)


def best(problem):
    y, x = problem.measured["y"], problem.model.x
    kept = np.isfinite(y)
    return np.array([x[kept] @ y[kept] / (x[kept] @ x[kept])])


@pytest.mark.parametrize("errors", [None, np.linspace(0.5, 2.0, 7)])
def test_the_scatter_is_the_median_deviation_of_normal_scatter(errors):
    """Over stated errors if there are some; wider by sqrt(n/(n - p))."""
    problem = through_origin(7, errors=None if errors is None else {"y": errors})
    weights = np.ones(7) if errors is None else errors
    scales = outliers.scatter(problem, np.array([2.0]))["y"]
    middle = np.median(np.abs(np.resize(NOISE, 7)) / weights)
    assert scales == pytest.approx(weights * 1.4826 * middle * math.sqrt(7.0 / 6.0), rel=1e-9)


def found(problem):
    values, scales = outliers.robust(problem, best(problem))
    assert values == pytest.approx([2.0], abs=0.02)
    return outliers.outliers(problem, values, scales)


@pytest.mark.parametrize(
    ("count", "off"),
    [
        (6, {3: 1.0}),
        (10, {0: -0.4, 5: 0.4, 8: 3.0}),
        (12, {2: -2.0}),
        (12, {1: 1.0, 7: 5.0}),
    ],
)
def test_the_chance_is_that_of_an_f_test_of_as_many_means(count, off):
    problem = through_origin(count, off)
    far = found(problem)
    assert far.places["y"].tolist() == sorted(off)
    kept = np.delete(np.arange(count), sorted(off))
    x, y = problem.model.x, problem.measured["y"]
    alone = x[kept] @ y[kept] / (x[kept] @ x[kept])
    assert far.values == pytest.approx([alone], rel=1e-6)
    assert np.isnan(far.rest.measured["y"]).nonzero()[0].tolist() == sorted(off)
    left = np.sum((y[kept] - alone * x[kept]) ** 2)
    whole = np.sum((y - best(problem) * x) ** 2)
    scales = outliers.robust(problem, best(problem))[1]
    least = (1e-4 * np.abs(y).max() / np.min(scales["y"])) ** 2 * np.min(scales["y"]) ** 2
    freedom = count - len(off) - 1
    ratio = (whole - left) / len(off) / ((left + least) / freedom)
    chance = f_distribution.sf(ratio, len(off), freedom) * comb(count, len(off))
    assert far.chance == pytest.approx(chance, rel=1e-4)


@pytest.mark.parametrize(
    ("count", "off"),
    [
        (5, {3: 1.0}),  # too few to show a scatter
        (12, {}),
        (12, {4: 0.03}),  # three times the scatter
        (10, {0: 3.0, 3: 3.0, 6: -3.0, 9: -3.0}),  # more than three of ten
    ],
)
def test_few_numbers_or_many_outliers_are_none(count, off):
    problem = through_origin(count, off)
    far = (
        found(problem) if len(off) < 4 else outliers.outliers(problem, np.array([2.0]), {"y": 0.01})
    )
    assert (far.chance, dict(far.places)) == (1.0, {})
    assert far.rest is problem


def test_a_quantity_keeps_more_numbers_than_there_are_parameters():
    """Of two numbers none can be left out: the other would be met whatever it is."""
    scales = {"y": 0.01, "z": 0.01}
    z = np.full(12, np.nan)
    z[:2] = 6.0, 9.0
    two = through_origin(12, more={"z": z})
    assert outliers.outliers(two, np.array([2.0]), scales).places == {}
    z[2] = 6.01
    three = through_origin(12, more={"z": z})
    assert outliers.outliers(three, np.array([2.0]), scales).places == {"z": [1]}


def told(places, *, count=12, more=None):
    problem = through_origin(count, more=more)
    measured = {name: np.where(np.isin(np.arange(count), places.get(name, ())), np.nan, values)
                for name, values in problem.measured.items()}  # fmt: skip
    rest = Problem(model=problem.model, measured=measured, errors={})
    arrays = {name: np.array(rows) for name, rows in places.items()}
    return outliers.describe_outliers(problem, Outliers(1e-9, arrays, rest, np.array([2.0])))


@pytest.mark.parametrize(
    ("number", "listed"),
    [
        (8, "impacts 1, 2, 3, 4, 5, 6, 7 and 8 are"),
        (9, "impacts 1, 2, 3, 4, 5, 6, 7, 8 and 1 more are"),
        (11, "impacts 1, 2, 3, 4, 5, 6, 7, 8 and 3 more are"),
    ],
)
def test_at_most_eight_impacts_are_listed(number, listed):
    (sentence,) = told({"y": list(range(number))}, count=24)
    assert sentence.startswith(f"y: {listed} off by up to 0.01, the others by ")


def test_a_change_between_two_rows_has_the_chance_of_its_f_test():
    """y = 2 x up to impact 6, 2.1 x from impact 7 on: one parameter more."""
    x = np.array([3.0, 1.0, 4.0, 1.5, 5.0, 9.0, 2.0, 6.0, 5.5, 3.5, 8.0, 7.0])
    y = np.where(np.arange(12) < 6, 2.0, 2.1) * x + NOISE
    problem = line({"y": y}, option("a"), x=x)
    seen = patterns.pattern(problem, best(problem), {"y": 0.01}, {"x": x})
    assert "a changes between impacts 6 and 7" in seen.words

    def left(columns):
        return np.sum((y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]) ** 2)

    plain = left(x[:, None])
    split = left(np.column_stack([x, x * (np.arange(12) >= 6)]))
    least = (1e-4 * np.abs(y).max()) ** 2
    chance = f_distribution.sf((plain - split) / (split / 10.0 + least), 1, 10)
    tests = 2 * (2 + 10) + 7  # over x and order: two curves, lines to the 3rd to 12th; changes
    assert seen.chance == pytest.approx(chance * tests, rel=1e-4)


@pytest.mark.parametrize(("slope", "way"), [(0.02, "climb"), (-0.02, "fall")])
def test_residuals_that_climb_up_to_a_value_are_told_with_their_size(slope, way):
    """A constant, and a line through 0 that ends at 8."""
    x = np.linspace(1.0, 12.0, 12)
    z = 6.0 + 0.1 * NOISE + np.where(x < 8.5, slope * x, 0.0)
    problem = line({"z": z}, option("a"), x=x)  # z = 3 a
    seen = patterns.pattern(problem, np.array([z.mean() / 3.0]), {"z": 0.01}, {"x": x})
    assert seen.chance < 1e-6
    assert f"residuals {way} with x, from " in seen.words
    assert "between 1 and 8:" in seen.words
    low, high = map(float, re.search(r"from (\S+) to (\S+) between", seen.words).groups())
    assert high - low == pytest.approx(7.0 * slope, rel=0.1)


def test_a_change_along_a_column_may_be_another_law():
    x = np.linspace(1.0, 12.0, 12)
    y = np.where(x < 6.5, 2.0, 2.1) * x + NOISE
    problem = line({"y": y}, option("a"), x=x)
    seen = patterns.pattern(problem, best(problem), {"y": 0.01}, {"x": x})
    assert "in the order of the rows (also that of x)" in seen.words


def test_a_number_alone_has_its_leverage():
    """Of y = a x at one large x: its share x²/sum(x²)."""
    x = np.array([1.0, 1.0, 10.0, 1.0])
    problem = line({"z": np.full(4, np.nan), "y": 2.0 * x}, option("a"), x=x)
    share = 100.0 / 103.0
    (sentence,) = patterns.leverage(problem, np.array([2.0]), {"z": 1.0, "y": 1.0})
    assert "y: impact 3 alone decides the fit" in sentence
    assert f"(leverage {share:.2f})" in sentence
    x[2] = 7.0  # 49/52 is below 0.95
    assert patterns.leverage(problem, np.array([2.0]), {"z": 1.0, "y": 1.0}) == []
    alone = line({"y": np.array([2.0])}, option("a"), x=np.ones(1))
    assert patterns.leverage(alone, np.array([2.0]), {"y": 1.0}) == []  # as many as parameters
    both = line({"z": np.array([6.0, np.nan]), "y": np.array([np.nan, 90.0])}, option("a"),
                x=np.array([0.0, 45.0]))  # fmt: skip
    (sentence,) = patterns.leverage(both, np.array([2.0]), {"z": 1.0, "y": 1.0})
    assert sentence.startswith("y: impact 2 alone decides the fit")
