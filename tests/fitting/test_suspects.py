"""A wrong sign and a slip of the pen in measured numbers are found, and sound data left alone."""

import numpy as np
import pytest

from contactlab import Simulation, fit
from contactlab.fitting.suspects import suspects
from tests.fitting.impacts import ANGLES, BODIES, restitution, scene, table

SCATTER = 0.004 * np.random.default_rng(5).standard_normal(len(ANGLES))


def spins(sign):
    spin = Simulation().sweep(scene(0.12)).check().rebound_spin
    values = restitution(0.12) + SCATTER
    return table(values, **{"rebound_spin (rad/s)": sign * spin + 250.0 * SCATTER})


def test_a_spin_without_its_sign_is_found():
    notes = fit(spins(-1.0), BODIES).notes
    assert [note.split(":")[0] for note in notes] == ["rebound_spin"]
    assert "opposite signs" in notes[0]
    assert fit(spins(1.0), BODIES).notes == ()


def test_an_impact_far_from_the_others_is_found():
    values = restitution(0.12) + SCATTER
    values[4] += 0.15
    (note,) = fit(table(values), BODIES).notes
    assert "tangential_restitution: impact 5 is off by 0.1" in note


def test_a_law_that_does_not_hold_is_no_slip_of_the_pen():
    predicted = np.linspace(1.0, 2.0, 30)
    off = np.where(np.arange(30) < 6, 0.3, 0.01 * np.sin(np.arange(30)))
    (note,) = suspects({"psi2": predicted + off}, {"psi2": predicted})
    assert "6 of 30 impacts" in note


@pytest.mark.parametrize("count", [8, 12, 40, 400])
def test_normal_scatter_is_seldom_suspected(count):
    """Of normal scatter a number in some hundred millions is as far; a median of few varies."""
    rng = np.random.default_rng(count)
    predicted = np.ones(count)
    draws = predicted + 0.1 * rng.standard_normal((200, count))
    wrong = sum(bool(suspects({"psi2": one}, {"psi2": predicted})) for one in draws)
    assert wrong <= 10
