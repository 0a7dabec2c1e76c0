"""The outcome of a fit: errors of two parameters, bootstrap, progress, and the order of laws."""

import attrs
import numpy as np
import pytest

from contactlab import Simulation
from contactlab_fit import fit, rank
from contactlab_fit.estimation import Ranked, in_order
from tests.fitting.impacts import ANGLES, BODIES, scene, table
from tests.fitting.made_fit import made
from tests.laws.outside_laws import Walton
from tests.longer import longer

SLIPPING = np.array([45.0, 50.0, 55.0, 60.0, 65.0, 70.0])
SLOPE = 1.0 / np.tan(np.radians(SLIPPING))
PULLS = np.array([1.0, -1.2, 0.9, -0.8, 1.1, -1.0])
DATA = table(1.0 - 0.2 * SLOPE + 0.002 * PULLS, SLIPPING)
LOSSY = Simulation(normal="tsuji", tangential="coulomb")


@pytest.mark.parametrize("stated", [None, (0.01, 0.004), *longer(((0.0005, 0.0002),))])
def test_errors_and_correlation_of_two_parameters(stated):
    """In gross slip e_t = 1 - mu (1 + e)/tan(angle), beside e itself; errors stated or not."""
    e_n = 0.8 + 0.001 * PULLS[::-1] * np.array([1.0, 1.0, -1.0, 1.0, 1.0, 1.0])
    data = table(1.0 - 0.18 * SLOPE + 0.002 * PULLS, SLIPPING, normal_restitution=e_n)
    if stated:
        data["tangential_restitution_error"] = np.full(6, stated[0])
        data["normal_restitution_error"] = np.full(6, stated[1])
    found = fit(data, BODIES, parameters=["friction_coefficient", "restitution"], simulation=LOSSY)
    mu, e = found["friction_coefficient"], found["normal.restitution"]
    assert (mu, e) == pytest.approx((0.1, 0.8), rel=0.01)
    sizes = stated or tuple(found.rms.values())
    jacobian = np.concatenate([
        np.column_stack([-(1.0 + e) * SLOPE, -mu * SLOPE]) / sizes[0],
        np.column_stack([np.zeros(6), np.ones(6)]) / sizes[1],
    ])  # fmt: skip
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    squares = sum(
        np.sum((r / s) ** 2) for r, s in zip(found.residuals.values(), sizes, strict=True)
    )
    widened = max(squares / 10.0, 1.0) if stated else squares / 10.0
    errors = np.sqrt(widened * np.diag(covariance))
    for one, error in zip(found.parameters.values(), errors, strict=True):
        assert one.standard_error == pytest.approx(error, rel=1e-3)
        reach = 2.228139 * error  # Student's t, 10 degrees of freedom
        assert one.interval == pytest.approx((one.value - reach, one.value + reach), rel=1e-3)
    r = covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])
    assert found.correlation == pytest.approx(np.array([[1.0, r], [r, 1.0]]), rel=1e-3)
    assert found.reduced_chi_square == (pytest.approx(squares / 10.0) if stated else None)


@pytest.mark.parametrize(
    ("after", "kept"),
    [(100, True), *longer((99, False), (101, True))],
)
def test_an_interruption_keeps_a_hundred_samples_or_none(after, kept):
    def progress(done, total):
        assert total == 150
        if done == after:
            raise KeyboardInterrupt

    if not kept:
        with pytest.raises(KeyboardInterrupt):
            fit(DATA, BODIES, bootstrap=150, progress=progress)
        return
    found = fit(DATA, BODIES, bootstrap=150, progress=progress)
    assert found.samples == after
    assert f"{after} samples of 150" in found.notes[-1]
    assert found.parameters["friction_coefficient"].bootstrap is not None


def test_samples_of_the_bootstrap_turn_the_signs_of_widened_residuals():
    """The farthest sample from the estimate has each sign turned against the straight line."""
    found = fit(DATA, BODIES, bootstrap=200)
    one = found.parameters["friction_coefficient"]
    residuals = found.residuals["tangential_restitution"]
    farthest = np.sqrt(6.0 / 5.0) * np.abs(0.5 * SLOPE * residuals).sum() / (SLOPE @ SLOPE)
    low, high = one.bootstrap
    assert one.value - 1.001 * farthest <= low < one.value - 0.5 * farthest
    assert one.value + 0.5 * farthest < high <= one.value + 1.001 * farthest
    assert (found.samples, found.notes) == (200, ())


def test_progress_counts_searches_and_the_diagnosis():
    calls = []
    fit(DATA, BODIES, progress=lambda *done: calls.append(done))
    *searches, last = calls
    assert searches == [(k + 1, len(searches) + 1) for k in range(len(searches))]
    assert (bool(searches), last) == (True, (1, 1))


def test_a_refusal_tells_its_likely_causes_first():
    """A spin of the wrong sign: no friction makes any of it."""
    spin = Simulation().sweep(scene(0.12)).check().rebound_spin
    columns = {"angle_deg": ANGLES, "speed (m/s)": np.full(12, 2.0), "rebound_spin (rad/s)": -spin}
    with pytest.raises(ValueError, match=r"^rebound_spin looks .* As it is, the data do not"):
        fit(columns, BODIES)


def test_laws_without_a_fit_come_last_in_the_order_given():
    best = attrs.evolve(made(), aic=-20.0)
    fits = {"x": None, "a": made(), "y": None, "b": best, "c": attrs.evolve(best, aic=3.0)}
    laws = [Ranked(name=name, fit=each) for name, each in fits.items()]
    assert [law.name for law in in_order(laws)] == ["b", "a", "c", "x", "y"]


@attrs.frozen(kw_only=True)
class Unfinished(Walton):
    """Walton's law without an answer."""

    def whole_impacts(self, scene, normal):
        raise RuntimeError("no answer")


def test_the_reasons_of_laws_without_a_fit_are_kept():
    calls = []
    laws = {"one": Simulation(tangential=Unfinished()), "none": None,
            "two": Simulation(tangential="frictionless")}  # fmt: skip
    ranked = rank(DATA, BODIES, laws, progress=lambda *done: calls.append(done))
    assert [law.name for law in ranked] == ["none", "one", "two"]
    assert "no answer" in ranked[1].refusal
    assert "do not determine" in ranked[2].refusal
    assert calls == [(1, 3), (2, 3), (3, 3)]
