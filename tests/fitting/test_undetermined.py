"""Refusals of what data do not determine: limits, whole sentences, and advised impacts."""

import re

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation
from contactlab.fitting import determined
from contactlab.fitting.model import Model
from contactlab.fitting.parameters import Setup
from contactlab.fitting.problem import Problem
from tests.fitting.impacts import BODIES
from tests.fitting.lines import X, line, option

A, B = option("a"), option("b")


def test_as_many_numbers_as_parameters_are_enough():
    determined.check_enough(
        line({"y": np.array([1.0, np.nan]), "z": np.array([np.nan, 1.0])}, A, B)
    )
    few = line({"y": np.array([1.0, np.nan])}, A, B)
    words = "1 measured numbers cannot determine 2 parameters; measure more impacts, or fit fewer"
    with pytest.raises(ValueError, match=f"^{words}$"):
        determined.check_enough(few)


@pytest.mark.parametrize(("count", "refused"), [(1, True), (2, True), (3, False)])
def test_a_scatter_needs_more_numbers_than_parameters(count, refused):
    y = np.where(np.arange(4) < count, 1.0, np.nan)
    both = {"y": y, "z": np.ones(4)}
    if refused:
        words = (
            f"y: {count} measured, too few to find their scatter beside that of the other "
            "quantities; give a column y_error, measure more, or leave it out of those that are "
            "fitted"
        )
        with pytest.raises(ValueError, match=f"^{words}$"):
            determined.check_scatter(line(both, A, B))
    else:
        determined.check_scatter(line(both, A, B))
    determined.check_scatter(line(both, A, B, errors={"y": np.ones(4)}))
    determined.check_scatter(line({"y": y}, A, B))


def sloped(monkeypatch, slopes, *parameters, values=None, measured=None):
    """Return a problem with given derivatives of its numbers, and the values of its parameters."""
    slopes = np.array(slopes)
    monkeypatch.setattr(Problem, "linearised", lambda *_: (np.zeros(len(slopes)), slopes))
    monkeypatch.setattr(determined, "_advised", lambda _, __, place: f"advice {place}")
    problem = line(measured or {"y": np.ones(len(slopes))}, *parameters)
    return problem, np.ones(len(parameters)) if values is None else np.array(values)


@pytest.mark.parametrize(
    ("y", "z", "expected"),
    [
        (0.99e-4, 1.0, ["y"]),
        (1.0e-4, 1.0, []),
        (-1.0, 0.0, ["z"]),
        (0.0, 0.0, []),  # none of all: the parameters themselves are refused
    ],
)
def test_a_quantity_is_idle_below_a_share_of_its_size(y, z, expected, monkeypatch):
    measured = {"y": np.ones(2), "z": np.ones(1)}
    problem, values = sloped(monkeypatch, [[0.0], [y], [z]], A, measured=measured)
    assert determined.idle(problem, values) == expected
    problem, values = sloped(monkeypatch, [[0.0, 0.0], [0.0, y], [z, 0.0]], A, B, measured=measured)
    assert determined.idle(problem, values) == expected


def test_an_effect_is_that_of_the_full_change_of_a_parameter(monkeypatch):
    """A slope of 1e-5 over a value of 100 is 1e-3; over a range of 2 it is 2e-5."""
    problem, values = sloped(monkeypatch, [[1e-5]] * 4, A, values=[100.0])
    determined.check_determined(problem, values)
    problem, values = sloped(monkeypatch, [[1e-5]] * 4, option("a", 99.0, 101.0), values=[100.0])
    words = r"^the data do not determine a: no measured number depends on a; advice 0$"
    with pytest.raises(ValueError, match=words):
        determined.check_determined(problem, values)


@pytest.mark.parametrize(("slope", "refused"), [(1.9e-4, True), (2.01e-4, False)])
def test_the_effect_of_a_parameter_is_an_rms_over_the_numbers(slope, refused, monkeypatch):
    """One number of four: half of its slope; the limit is 1e-4."""
    slopes = [[1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, slope]]
    problem, values = sloped(monkeypatch, slopes, A, B)
    if refused:
        with pytest.raises(ValueError, match="do not determine b: no measured number depends on b"):
            determined.check_determined(problem, values)
    else:
        determined.check_determined(problem, values)


@pytest.mark.parametrize(("angle", "refused"), [(0.001, True), (0.002, False)])
def test_effects_in_one_direction_are_not_told_apart(angle, refused, monkeypatch):
    """The least singular value of two unit vectors at a small angle is angle/sqrt(2)."""
    c = option("c")
    slopes = [[1.0, 5.0 * np.cos(angle), 0.0], [0.0, 5.0 * np.sin(angle), 0.0], [0.0, 0.0, 1.0]]
    problem, values = sloped(monkeypatch, slopes, A, B, c)
    if not refused:
        determined.check_determined(problem, values)
        return
    words = (
        "the data do not determine a and b: a change of a and b together leaves every measured "
        "number as it is; advice 0 advice 1"
    )
    with pytest.raises(ValueError, match=f"^{words}$"):
        determined.check_determined(problem, values)
    monkeypatch.setattr(determined, "_advised", lambda *_: "the same")
    with pytest.raises(ValueError, match=r"it is; the same$"):
        determined.check_determined(problem, values)


@pytest.mark.parametrize(
    ("parameter", "value", "reach", "refused"),
    [
        (option("a", 0.0, 2.0), 1.0, 1.0, False),
        (option("a", 0.0, 2.0), 1.0, 1.01, True),
        (A, 3.0, 3.0, False),
        (A, 3.0, 3.01, True),
        (A, 0.01, 0.05, False),
        (A, 0.01, 0.051, True),
    ],
)
def test_a_wide_interval_is_refused(parameter, value, reach, refused, monkeypatch):
    problem, _ = sloped(monkeypatch, [[1.0]] * 4, parameter)
    if not refused:
        determined.check_precise(problem, np.array([value]), np.array([reach]))
        return
    told = f"the measured numbers hardly depend on a: {value:g} ± {reach:.2g}; advice 0"
    with pytest.raises(ValueError, match=f"^the data do not determine a: {re.escape(told)}$"):
        determined.check_precise(problem, np.array([value]), np.array([reach]))


@pytest.mark.parametrize(("behind", "refused"), [(3.99, True), (4.0, False), (-1.0, True)])
def test_a_second_minimum_nearly_as_good_is_told(behind, refused, monkeypatch):
    monkeypatch.setattr(Problem, "criterion", lambda _, values: 10.0 + behind * (values[0] != 1.0))
    monkeypatch.setattr(determined, "_telling_apart", lambda _, both: f"measure {both.tolist()}")
    minima = [np.array([1.0, 2.0]), np.array([3.0, 4.56789])]
    problem = line({"y": X}, A, B)
    determined.check_single(problem, minima[:1])
    if not refused:
        determined.check_single(problem, minima)
        return
    words = (
        "the data do not determine a and b: they are met as well by a = 1, b = 2 and a = 3, "
        "b = 4.568; measure [[1.0, 2.0], [3.0, 4.56789]]"
    )
    with pytest.raises(ValueError, match=f"^{re.escape(words)}$"):
        determined.check_single(problem, minima)


ANGLES = determined.ANGLES_DEG
WHERE = "angles of incidence (degrees)"


def advised(monkeypatch, effects, *, scene=BODIES):
    """Return the advice for effects by quantity over the candidate impacts."""
    model = Model(setup=Setup(attrs.evolve(scene, normal_speed=[1.0]), None), parameters=(A,))
    asked = []

    def effect(at, _, place, name):
        asked.append(name)
        assert place == 0
        return np.array(effects[name])

    monkeypatch.setattr(determined, "_effect", effect)
    return determined._advised(model, np.array([1.0]), 0), asked


@pytest.mark.parametrize(
    ("normal", "tangential", "words"),
    [
        ({}, {20.0: 1.0}, f"measure tangential_restitution at {WHERE} of 20, best about 20"),
        (
            {30.0: 0.9},
            {6.0: 0.5, 20.0: 0.49, 40.0: 1.0},
            f"measure tangential_restitution at {WHERE} from 6 to 40, best about 40",
        ),
        ({80.0: 2.0, 1.0: 1.9}, {6.0: 1.0},
         f"measure normal_restitution at {WHERE} from 1 to 80, best about 80"),
    ],
)  # fmt: skip
def test_the_advised_impacts_have_half_of_the_greatest_effect(
    normal, tangential, words, monkeypatch
):
    effects = {
        f"{name}_restitution": [of.get(angle, 0.0) for angle in ANGLES]
        for name, of in (("normal", normal), ("tangential", tangential))
    }
    told, asked = advised(monkeypatch, effects)
    assert told == f"{words}, to determine a."
    assert asked == list(effects)


def test_advice_where_everything_or_nothing_has_an_effect(monkeypatch):
    some, none = np.full(14, 1e-4), np.full(14, 0.99e-4)
    flat = {"normal_restitution": none, "tangential_restitution": some}
    told, _ = advised(monkeypatch, flat)
    assert told == f"measure tangential_restitution to determine a, at any {WHERE}."
    told, _ = advised(monkeypatch, dict.fromkeys(flat, none))
    assert told == "no rebound of these laws depends on a: fix it, or choose others."


def test_a_scene_without_bodies_is_advised_by_psi1(monkeypatch):
    scene = Scene.nondimensional(psi1=[1.0, 2.0, 3.0], chi=[1.0, 1.2, 3.0])
    impacts, x, words = determined._candidates(scene)
    assert impacts.chi == 1.2
    assert (x.tolist(), words) == (determined.INCIDENCES.tolist(), "psi1")
    assert impacts.psi1.tolist() == x.tolist()
    psi2 = np.where(x == 5.0, 1.0, 0.0)
    monkeypatch.setattr(
        determined, "_effect", lambda *a: psi2 if a[3] == "psi2" else np.zeros(len(x))
    )
    model = Model(setup=Setup(scene, Simulation()), parameters=(A,))
    told = determined._advised(model, np.array([1.0]), 0)
    assert told == "measure psi2 at psi1 of 5, best about 5, to determine a."


def test_candidates_have_the_median_speed_and_no_spin():
    scene = attrs.evolve(
        BODIES, normal_speed=[3.0, 0.3, 30.0], tangential_velocity=[4.0, 0.4, 40.0], spin=[7.0] * 3
    )
    impacts, x, words = determined._candidates(scene)
    assert (x.tolist(), words) == (ANGLES.tolist(), WHERE)
    assert impacts.normal_speed == pytest.approx(5.0 * np.cos(np.radians(ANGLES)))
    assert impacts.tangential_velocity == pytest.approx(5.0 * np.sin(np.radians(ANGLES)))
    assert not np.any(impacts.spin)
    assert impacts.friction_coefficient == BODIES.friction_coefficient


def test_two_sets_of_values_are_told_apart_where_they_differ_most(monkeypatch):
    told = {20.0: (0.5, 0.123456), 40.0: (0.1, 0.3)}
    first, second = (np.array([told.get(angle, (0.0, 0.0))[k] for angle in ANGLES]) for k in (0, 1))
    monkeypatch.setattr(
        Model, "predicted", lambda _, __, names: {names[0]: np.array([first, second])}
    )
    scene = attrs.evolve(BODIES, normal_speed=[1.0])
    model = Model(setup=Setup(scene, None), parameters=(A,))
    assert determined._telling_apart(model, np.zeros((2, 1))) == (
        f"measure tangential_restitution at {WHERE} of about 20: 0.5 of the first, 0.123 of the "
        "second."
    )


def test_an_effect_near_the_end_of_a_range_is_one_sided():
    """Of q = (a² - 1)² at a = 2, no higher: over the lower half of the step alone."""
    problem = line({"q": X}, option("a", 0.0, 2.0))
    effect = determined._effect(problem.model, np.array([2.0]), 0, "q")
    below = ((2.0 - 0.05 * 2.0) ** 2 - 1.0) ** 2
    assert effect == pytest.approx([(9.0 - below) / 0.1 * 2.0] * 4)
    problem = line({"q": X}, option("a", 2.0, 9.0))
    effect = determined._effect(problem.model, np.array([2.0]), 0, "q")
    above = ((2.0 + 0.05 * 2.0) ** 2 - 1.0) ** 2
    assert effect == pytest.approx([(above - 9.0) / 0.1 * 2.0] * 4)
