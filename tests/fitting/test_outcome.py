"""The outcome of a fit: errors, intervals, bootstrap, sentences, and the order of laws."""

import re

import attrs
import numpy as np
import pytest

from contactlab import Simulation, fit
from contactlab.fitting import estimation, rank, read_measurements
from contactlab.fitting.diagnosis import Diagnosis
from contactlab.fitting.estimation import Ranked, in_order
from contactlab.outcome.result import ImpactError
from tests.fitting.impacts import BODIES, table
from tests.fitting.lines import line, option
from tests.fitting.made_fit import made

SLIPPING = np.array([45.0, 50.0, 55.0, 60.0, 65.0, 70.0])
SLOPE = 2.0 / np.tan(np.radians(SLIPPING))
PULLS = 0.002 * np.array([1.0, -1.2, 0.9, -0.8, 1.1, -1.0])
DATA = table(1.0 - 0.1 * SLOPE + PULLS, SLIPPING)


X = np.arange(1.0, 9.0)
Y = 2.0 * X - 1.0 + 0.1 * np.array([1.0, -2.0, 0.5, 1.5, -1.0, 0.7, -0.9, 0.3])
NOTHING = Diagnosis(slips=(), others=(), robust=[None, None])


def outcome(measured, values, monkeypatch, *, errors=None, parameters=None, x=X):
    """Return what is made of a straight line at these values, and the half-widths."""
    for name in ("unlikely_parameters", "error_notes", "end_notes"):
        monkeypatch.setattr(estimation, name, lambda *_: [])
    monkeypatch.setattr("tests.fitting.lines.Line.laws", lambda *_: "a line", raising=False)
    some = read_measurements({"psi1": x, "psi2": x})
    problem = line(measured, *(parameters or (option("a"), option("b"))), errors=errors, x=x)
    diagnosis = attrs.evolve(NOTHING, robust=[None] * len(values))
    return estimation._outcome(problem, some, np.array(values), diagnosis)


def test_errors_and_correlation_are_those_of_a_straight_line(monkeypatch):
    design = np.column_stack([X, np.ones(8)])
    values, (left,) = np.linalg.lstsq(design, Y, rcond=None)[:2]
    covariance = np.linalg.inv(design.T @ design)
    found, reaches = outcome({"y": Y}, values, monkeypatch)
    errors = np.sqrt(left / 6.0 * np.diag(covariance))
    told = [one.standard_error for one in found.parameters.values()]
    assert told == pytest.approx(errors, rel=1e-6)
    assert reaches == pytest.approx(2.446912 * errors, rel=1e-6)  # Student's t, 6 degrees
    for one, value, reach in zip(found.parameters.values(), values, reaches, strict=True):
        assert one.interval == pytest.approx((value - reach, value + reach))
    r = covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])
    assert found.correlation == pytest.approx(np.array([[1.0, r], [r, 1.0]]))
    assert found.reduced_chi_square is None
    assert found.predicted["y"] == pytest.approx(design @ values)


@pytest.mark.parametrize("error", [0.01, 1.0])
def test_stated_errors_are_widened_only(error, monkeypatch):
    design = np.column_stack([X, np.ones(8)])
    values, (left,) = np.linalg.lstsq(design, Y, rcond=None)[:2]
    found, _ = outcome({"y": Y}, values, monkeypatch, errors={"y": np.full(8, error)})
    assert found.reduced_chi_square == pytest.approx(left / 6.0 / error**2)
    own = np.sqrt(np.linalg.inv(design.T @ design)[0, 0])
    widest = max(error, np.sqrt(left / 6.0))
    assert found.parameters["a"].standard_error == pytest.approx(widest * own)


def test_stated_errors_of_as_many_numbers_as_parameters_stand_alone(monkeypatch):
    found, reaches = outcome(
        {"y": np.array([4.0])}, [4.0], monkeypatch, errors={"y": np.array([0.5])},
        parameters=[option("a")], x=np.ones(1),
    )  # fmt: skip
    one = found.parameters["a"]
    assert one.standard_error == pytest.approx(0.5)
    assert np.isnan([*one.interval, *reaches, found.reduced_chi_square]).all()


def test_an_interval_ends_at_the_ends_of_the_range(monkeypatch):
    parameters = [option("a", 1.99, 2.01), option("b", -1.5, -0.9)]
    found, reaches = outcome({"y": Y}, [2.0, -1.0], monkeypatch, parameters=parameters)
    assert reaches[0] > 0.01
    assert found.parameters["a"].interval == (1.99, 2.01)
    low, high = found.parameters["b"].interval
    assert (low, high) == pytest.approx((-1.0 - reaches[1], -0.9))


def test_sentences_stand_in_the_order_of_their_causes(monkeypatch):
    found = {}
    for slips in ((), ("slip",)):
        with monkeypatch.context() as patch:
            for name in ("unlikely_parameters", "moved", "error_notes", "end_notes"):
                patch.setattr(estimation, name, lambda *_, word=name: [word])
            patch.setattr("tests.fitting.lines.Line.laws", lambda *_: "", raising=False)
            some = read_measurements({"psi1": X, "psi2": X})
            problem = line({"y": Y}, option("a"), option("b"), x=X)
            told = attrs.evolve(NOTHING, slips=slips)
            found[slips] = estimation._outcome(problem, some, np.array([2.0, -1.0]), told)[0].notes
    assert found[()] == ("unlikely_parameters", "moved", "error_notes", "end_notes")
    assert found[("slip",)] == ("slip", "unlikely_parameters", "error_notes", "end_notes")


def interrupted_after(count, monkeypatch):
    """Let the bootstrap draw 0, 1, 2, ... and end it after ``count`` samples."""
    drawn = iter(range(count))

    def solved_again(*_):
        try:
            return np.array([float(next(drawn))])
        except StopIteration:
            raise KeyboardInterrupt from None

    monkeypatch.setattr(estimation, "_solved_again", solved_again)


def test_an_interruption_keeps_a_hundred_samples_or_none(monkeypatch):
    interrupted_after(100, monkeypatch)
    found = fit(DATA, BODIES, bootstrap=150)
    assert found.samples == 100
    assert found.notes[-1] == ("bootstrap: interrupted, intervals are those of 100 samples of 150")
    low, high = found.parameters["friction_coefficient"].bootstrap
    assert (low, high) == pytest.approx((0.025 * 99.0, 0.975 * 99.0))
    interrupted_after(99, monkeypatch)
    with pytest.raises(KeyboardInterrupt):
        fit(DATA, BODIES, bootstrap=150)


def test_a_bootstrap_that_ends_says_nothing(monkeypatch):
    interrupted_after(3, monkeypatch)
    found = fit(DATA, BODIES, bootstrap=3)
    assert (found.samples, found.notes) == (3, ())


def test_a_sample_has_the_residuals_widened_with_random_signs(monkeypatch):
    changes = []
    monkeypatch.setattr(
        estimation, "_solved_again", lambda _, change, values, __: changes.append(change) or values
    )
    found = fit(DATA, BODIES, bootstrap=40)
    residuals = found.residuals["tangential_restitution"]
    drawn = np.array([change["tangential_restitution"] / residuals + 1.0 for change in changes])
    assert np.abs(drawn) == pytest.approx(np.full((40, 6), np.sqrt(6.0 / 5.0)), rel=1e-6)
    assert 0.3 < np.mean(drawn > 0.0) < 0.7


def test_a_sample_is_the_fit_to_the_changed_numbers():
    problem = line({"y": Y, "z": 6.0 + 0.0 * X}, option("a"), option("b"), x=X)
    design = np.column_stack([X, np.ones(8)])
    scales = {"y": 1.0, "z": 1e6}
    found = estimation._solved_again(
        attrs.evolve(problem, errors={"y": np.ones(8), "z": np.full(8, 1e6)}),
        {"y": 0.5 * X + 2.0, "z": np.zeros(8)}, np.array([2.0, 0.0]), scales,
    )  # fmt: skip
    expected = np.linalg.lstsq(design, Y + 0.5 * X + 2.0, rcond=None)[0]
    assert found == pytest.approx(expected, rel=1e-5)


def test_progress_counts_searches_and_the_diagnosis(monkeypatch):
    starts = [np.array([0.1]), np.array([0.1]), np.array([3.0])]
    monkeypatch.setattr(estimation, "starting", lambda _: starts)
    calls = []
    fit(DATA, BODIES, progress=lambda *done: calls.append(done))
    assert calls == [(1, 4), (2, 4), (3, 4), (1, 1)]


def test_one_minimum_that_is_reached_twice_is_one(monkeypatch):
    ends = {1.0: 5.0, 2.0: 5.004, 3.0: 5.02, 4.0: 0.0, 5.0: 0.0009}
    monkeypatch.setattr(estimation, "starting", lambda _: [np.array([key]) for key in ends])
    monkeypatch.setattr(estimation, "solved", lambda _, start: np.array([ends[start[0]]]))
    problem = line({"y": 5.0 * X}, option("a"), x=X)
    found = [values[0] for values in estimation._solutions(problem)]
    assert found == [5.0, 5.02, 0.0]


def refused_fit(causes, monkeypatch):
    def refuse(*_):
        raise ValueError("refused")

    diagnosis = attrs.evolve(NOTHING, slips=tuple(causes), robust=[None])
    monkeypatch.setattr(estimation, "diagnosed", lambda *_, **__: diagnosis)
    monkeypatch.setattr(estimation.determined, "check_precise", refuse)
    with pytest.raises(ValueError, match="refused") as caught:
        fit(DATA, BODIES)
    return str(caught.value)


def test_a_refusal_tells_its_likely_causes_first(monkeypatch):
    assert refused_fit(["one", "two"], monkeypatch) == "one. two. As it is, refused"
    assert refused_fit([], monkeypatch) == "refused"


def test_quantities_that_no_parameter_moves_are_told_first(monkeypatch):
    """Under an elastic law the normal rebound is 1."""
    monkeypatch.setattr(estimation, "slips", lambda *_: (["a slip"], []))
    more = {"normal_restitution": np.full(6, 0.9), "rebound_normal_velocity (m/s)": np.full(6, 1.0)}
    found = fit(DATA | more, BODIES)
    words = "not met, for no parameter moves it under these laws"
    assert found.notes == (f"normal_restitution, rebound_normal_velocity: {words}", "a slip")
    assert list(found.counts) == ["tangential_restitution"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"bootstrap": 100_001}, "bootstrap = 100001: must be a whole number from 0 to 100000"),
        ({"parameters": ["friction_coefficient"] * 2},
         "parameters = ['friction_coefficient', 'friction_coefficient']: names one of them twice"),
    ],
)  # fmt: skip
def test_options_that_cannot_be(options, words):
    with pytest.raises(ValueError, match=f"^{re.escape(words)}$"):
        fit(DATA, BODIES, **options)
    with pytest.raises(ValueError, match="scene = None: must be given; a Scene, or a TOML file"):
        fit(DATA)


def test_laws_without_a_fit_come_last_in_the_order_given(monkeypatch):
    best = attrs.evolve(made(), aic=-20.0)
    fits = {"x": None, "a": made(), "y": None, "b": best, "c": attrs.evolve(best, aic=3.0)}
    laws = [Ranked(name=name, fit=each) for name, each in fits.items()]
    assert [law.name for law in in_order(laws)] == ["b", "a", "c", "x", "y"]
    assert laws[0].refusal == ""

    def failing(*_, simulation, **__):
        if simulation is None:
            return made()
        raise ImpactError("too few steps", status=None) if simulation == 1 else ValueError("bad")

    calls = []
    monkeypatch.setattr(estimation, "fit", failing)
    ranked = rank(DATA, BODIES, {"one": 1, "two": 2, "none": None},
                  progress=lambda *done: calls.append(done))  # fmt: skip
    assert [law.name for law in ranked] == ["none", "one", "two"]
    assert ranked[2].refusal == "bad"
    assert "too few steps" in ranked[1].refusal
    assert calls == [(1, 3), (2, 3), (3, 3)]


def test_the_default_of_a_ranking_is_friction_without_a_bootstrap():
    found = rank(DATA, BODIES, {"exact": None, "rigid": Simulation(tangential="coulomb")})
    assert [list(law.fit.parameters) for law in found] == [["friction_coefficient"]] * 2
    assert [law.fit.samples for law in found] == [0, 0]
