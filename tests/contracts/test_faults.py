"""Faults of laws: which answers are malformed, who is blamed, and in which words."""

import math

import numpy as np
import pytest

import contactlab
from contactlab.contracts import Status
from contactlab.contracts.faults import LawFaultError, blaming, is_malformed, sentence

LAW = contactlab.create("tangential.coulomb")


@pytest.mark.parametrize(
    ("value", "shape", "bad"),
    [
        (1.0, (), False),
        (1, (), False),
        (np.float64(1.0), (), False),
        (np.int32(1), (2,), False),
        (1.0, (2, 3), False),
        (math.nan, (), False),  # real, though not finite
        (True, (), True),
        (np.bool_(True), (), True),
        (1j, (), True),
        (np.complex128(1.0), (), True),
        ("1", (), True),
        (None, (), True),
        ([1.0], (1,), True),
        (np.array(1.0), (), False),
        (np.array([1, 2]), (2,), False),
        (np.array([1, 2], dtype=np.uint8), (2,), False),
        (np.array([True, False]), (2,), True),
        (np.array([1j, 2.0]), (2,), True),
        (np.array([1.0, None]), (2,), True),
        (np.array([1.0]), (2,), True),  # of one impact
        (np.array([1.0]), (1,), False),
        (np.array([[1.0]]), (3, 2), True),
        (np.array([1.0, 2.0]), (3, 2), False),
        (np.array([[1.0], [2.0], [3.0]]), (3, 2), False),
        (np.array([1.0, 2.0]), (3,), True),
        (np.array([1.0]), (), True),
        (np.array([[1.0, 2.0]]), (2,), True),
        (np.array([1.0, 2.0, 3.0]), (3, 2), True),
    ],
)
def test_answers_are_real_numbers_that_broadcast_to_the_batch(value, shape, bad):
    assert is_malformed(value, shape) is bad


@pytest.mark.parametrize(
    ("time", "when"),
    [
        (None, ""),
        (0.0, ", time 0 s"),
        (1.23456789e-5, ", time 1.23457e-05 s"),
        (np.array([1.0, 3.0, 2.0]), ", time 3 s"),
        (np.array([[1.0], [0.5]]), ", time 1 s"),
        ("late", ""),
        (np.array([]), ""),
        (object(), ""),
    ],
)
def test_a_fault_is_told_with_its_step_and_time(time, when):
    told = sentence(LAW, "force nan", 3, time)
    assert told == f"At step 3{when}: force nan, from Coulomb in {LAW.__module__}."


def steps(error, step):
    """Raise an error in a step of a law."""
    with blaming(LAW) as blamed:
        assert blamed.step == 1
        blamed.step = step
        raise error


@pytest.mark.parametrize("error", [RuntimeError("no"), SystemExit(1), ArithmeticError()])
def test_an_error_is_blamed_on_the_law(error):
    with pytest.raises(LawFaultError) as fault:
        steps(error, 5)
    assert fault.value.status is Status.LAW_RAISED
    told = fault.value.detail
    assert str(fault.value) == told
    line = steps.__code__.co_firstlineno + 5
    assert told == (
        f"At step 5: {type(error).__name__}: {error} (steps, line {line}), "
        f"from Coulomb in {LAW.__module__}."
    )
    assert fault.value.__cause__ is error


@pytest.mark.parametrize("error", [KeyboardInterrupt(), LawFaultError(Status.UNSETTLED, "as is")])
def test_an_interruption_or_a_fault_told_before_passes_through(error):
    with pytest.raises(type(error)) as same:
        steps(error, 5)
    assert same.value is error
