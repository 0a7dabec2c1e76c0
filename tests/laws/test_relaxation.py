"""The restitution of a viscoelastic contact by its relaxation time, and back."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from contactlab_laws.viscoelastic.relaxation import LEAST, number_of, restitution_of


def integrated(a):
    """e of the motion itself, theory §15: dT = 2b dx, first loading, then unloading to b = 0."""

    def loading(_, state):
        b, rate = state
        return rate, -2.5 * b * (b**3 + 1.5 * a * rate * b)

    def unloading(_, state):
        b, rate = state
        return rate - 1.25 * a * b**3, -2.5 * b**4

    def turned(_, state):
        return state[1]

    def parted(_, state):
        return state[0]

    state = [0.0, 1.0]
    for slope, end in ((loading, turned), (unloading, parted)):
        end.terminal, end.direction = True, -1
        run = solve_ivp(
            slope, (0.0, 1e7), state, method="DOP853", events=end, rtol=1e-12, atol=1e-16
        )
        state = run.y_events[0][0]
    return -state[1]


@pytest.mark.parametrize("a", [1e-4, 0.01, 0.1, 0.4, 1.0, 3.0, 12.0])
def test_restitution_is_that_of_the_motion(a):
    e = integrated(a)
    assert e > LEAST
    assert restitution_of(a) == pytest.approx(e, abs=1e-9)
    assert number_of(e) == pytest.approx(a, rel=1e-7)


@pytest.mark.parametrize("a", [17.0, 40.0, 1000.0])
def test_strong_loss_is_the_asymptote(a):
    e = integrated(a)
    assert e < LEAST
    assert restitution_of(a) == pytest.approx(e, abs=5e-7, rel=3e-4)
    assert number_of(e) == pytest.approx(a, rel=2e-4)


def test_restitutions_of_the_theory():
    """§15, to the digits given."""
    found = restitution_of(np.array([0.05, 0.1, 0.2, 0.4, 1.0, 3.0]))
    assert found == pytest.approx(
        [0.912242, 0.836405, 0.712382, 0.538747, 0.28723, 0.0878], abs=5e-6
    )
    assert (1.0 - restitution_of(1e-6)) / 1e-6 == pytest.approx(1.892, abs=1e-3)


def test_there_and_back_without_a_jump():
    e = np.concatenate((np.geomspace(1e-9, 1.0, 400), 1.0 - np.geomspace(1e-15, 0.1, 50)))
    assert restitution_of(number_of(e)) == pytest.approx(e, rel=1e-10)
    below, above = number_of(LEAST * (1.0 - 1e-12)), number_of(LEAST)
    assert below == pytest.approx(above, rel=1e-7)
    assert (np.diff(number_of(np.sort(e))) <= 0.0).all()
    assert number_of(1.0) == 0.0
    assert restitution_of(0.0) == 1.0
    assert type(number_of(0.5)) is type(restitution_of(0.5)) is float
    assert number_of(1.0 - 1e-12) == pytest.approx(1e-12 / 1.892, rel=1e-3)
