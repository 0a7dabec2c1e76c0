"""What is told of a fit: which of several causes, at and beside each limit, in full."""

import attrs
import numpy as np
import pytest
from scipy.stats import chi2

from contactlab.fitting import diagnosis
from contactlab.fitting.diagnosis import end_notes, error_notes, moved
from contactlab.fitting.fit_result import Estimate
from tests.fitting.lines import line, option


@attrs.frozen
class Given:
    """A table of which only the columns before the impact are needed."""

    given: tuple = ()


@pytest.mark.parametrize(
    ("certain", "possible", "unlikely", "slips", "others"),
    [
        ([], [], [], (), ("others",)),
        ([], ["maybe"], [], (), ("others", "maybe")),
        (["slip"], [], [], ("slip",), ()),
        ([], ["maybe"], ["unit"], ("unit",), ()),
        (["slip"], [], ["unit"], ("slip", "unit"), ()),
    ],
)
def test_a_slip_explains_all_else(certain, possible, unlikely, slips, others, monkeypatch):
    monkeypatch.setattr(diagnosis, "slips", lambda *_: (certain, possible))
    monkeypatch.setattr(diagnosis.plausible, "unlikely_numbers", lambda *_: unlikely)
    monkeypatch.setattr(diagnosis, "_others", lambda *_: ("others",))
    problem = line({"y": np.arange(1.0, 5.0)}, option("a"))
    found = diagnosis.diagnosed(problem, Given(), np.array([1.0]))
    assert (found.slips, found.others, found.robust) == (slips, others, [None])
    assert found.sentences == slips + others


@pytest.mark.parametrize(("count", "parameters", "has"), [(6, 1, True), (5, 1, False),
                                                         (7, 2, True), (6, 2, False)])  # fmt: skip
def test_six_numbers_and_one_more_for_each_further_parameter_have_a_robust_fit(
    count, parameters, has, monkeypatch
):
    monkeypatch.setattr(diagnosis, "slips", lambda *_: ([], []))
    monkeypatch.setattr(diagnosis.plausible, "unlikely_numbers", lambda *_: [])
    monkeypatch.setattr(diagnosis, "_others", lambda *_: ())
    x = np.arange(1.0, count + 1.0)
    names = [option(name, starts=(1.0,)) for name in "ab"[:parameters]]
    problem = line({"y": 2.0 * x}, *names, x=x)
    values = np.array([2.0, 0.0][:parameters])
    found = diagnosis.diagnosed(problem, Given(), values).robust
    assert found == (pytest.approx(values.tolist(), abs=1e-3) if has else [None] * parameters)


def test_a_robust_value_outside_of_its_interval_is_told():
    def estimate(robust):
        return Estimate(name="a", unit="1", value=1.0, standard_error=0.1, interval=(0.5, 1.5),
                        robust=robust)  # fmt: skip

    inside = {str(robust): estimate(robust) for robust in (None, 0.5, 1.0, 1.5)}
    assert moved(inside) == []
    assert moved(inside | {"low": estimate(0.49), "high": estimate(1.51234)}) == [
        f"a robust fit, which a few far numbers hardly move, gives {name} = {value}, outside of "
        "the interval: look at the impacts that are farthest off"
        for name, value in (("low", "0.49"), ("high", "1.512"))
    ]


SMALL = (
    "y: residuals are {} times the errors given: these are too small, or the law is not that of "
    "the data; intervals are widened by as much"
)
LARGE = (
    "y: residuals are {} times the errors given: these are too large; look at the unit of y_error, "
    "and whether they are standard errors"
)


def noted(ratio, count, *, values=None):
    """Return the notes on residuals whose rms per degree of freedom is ``ratio`` errors."""
    pulls = np.resize([1.0, -1.0], count) * ratio * np.sqrt((count - 1) / count)
    y = pulls if values is None else values
    off = line({"y": y, "z": np.full(count, 0.0)}, option("a"), errors={"y": np.ones(count)},
               x=np.zeros(count))  # fmt: skip
    return error_notes(off, np.array([0.0]))


@pytest.mark.parametrize(
    ("ratio", "count", "expected"),
    [
        (1.0, 40, []),
        (1.41, 40, []),  # chi square per degree of freedom 1.99
        (1.42, 40, [SMALL.format("1.4")]),
        (2.0, 4, []),  # chance does it once in 140 times
        (3.0, 4, [SMALL.format("3")]),
        (0.51, 40, []),
        (0.49, 40, [LARGE.format("0.49")]),
        (0.49, 8, []),
        (0.2, 8, [LARGE.format("0.2")]),
        (9.0, 1, []),  # no degree of freedom
        (9.0, 2, [SMALL.format("9")]),
    ],
)
def test_errors_that_the_scatter_contradicts(ratio, count, expected):
    """Beyond a factor of two in the square, or below one half, and beyond chance."""
    freedom = count - 1
    if freedom:
        square = freedom * ratio**2
        unlikely = (
            chi2.sf(square, freedom) < 1e-3 if ratio > 1 else chi2.cdf(square, freedom) < 1e-3
        )
        assert bool(expected) == (unlikely and (ratio**2 > 2.0 or ratio < 0.5))
    assert noted(ratio, count) == expected


def test_equal_numbers_do_not_show_their_scatter():
    assert noted(0.0, 20, values=np.full(20, 0.01)) == []
    assert noted(0.0, 20, values=np.full(20, 9.0)) == [SMALL.format("9.2")]
    assert noted(0.0, 20, values=np.array([0.01, *[0.0] * 19])) == [LARGE.format("0.0023")]


ENDS = "a lies at the end of its range, 0 to 2: the law may not be that of the data"


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (0.0, [ENDS]),
        (1.9e-6, [ENDS]),
        (2.1e-6, []),
        (1.0, []),
        (2.0 - 1.9e-6, [ENDS]),
        (2.0, [ENDS]),
    ],
)
def test_a_value_at_the_end_of_its_range_is_told(value, expected):
    """Nearer to it than a millionth of the range."""
    problem = line({"y": np.ones(4)}, option("a", 0.0, 2.0))
    assert end_notes(problem, np.array([value]), 3) == expected
    free = line({"y": np.ones(4)}, option("a"))
    assert end_notes(free, np.array([value]), 1) == []
    assert end_notes(free, np.array([value]), 0) == [
        "as many numbers as parameters: nothing is left to tell the scatter by"
    ]
