"""A column of a plug-in whose function fails for some impacts, or needs a history."""

import warnings

import numpy as np
import pytest

from contactlab import Scene, Simulation
from contactlab.outcome.columns import QUANTITIES, columns
from contactlab.plugin import Column
from contactlab.registration.installed import PluginWarning
from tests.present import column

PSI1 = np.array([0.5, 1.2, 6.0])


def fails(result):
    """psi2, which a single impact with psi1 = 1.2 has not."""
    if np.any(np.asarray(result.psi1) == 1.2):
        raise ZeroDivisionError("no such number")
    return result.psi2


@pytest.mark.parametrize("shape", [(3,), (3, 1), (1, 3)])
def test_the_impact_for_which_it_fails_is_nan_and_told_and_the_others_stand(shape):
    result = Simulation().run(Scene.nondimensional(psi1=PSI1.reshape(shape), chi=1.44))
    with column(Column("odd", "1", value=fails)), pytest.warns(PluginWarning) as told:
        (values,) = (values for name, _, values in columns(result) if name == "odd")
    assert np.isnan(values).ravel().tolist() == [False, True, False]
    assert values.ravel()[[0, 2]] == pytest.approx(result.psi2.ravel()[[0, 2]], rel=1e-15)
    (one,) = told
    assert str(one.message).startswith("column odd: NaN for 1 of 3 impacts, its function failed: ")
    assert "ZeroDivisionError: no such number" in str(one.message)


def test_a_single_impact_for_which_it_fails_is_nan_and_told():
    result = Simulation().run(Scene.nondimensional(psi1=1.2, chi=1.44))
    with column(Column("odd", "1", value=fails)), pytest.warns(PluginWarning, match="1 of 1"):
        assert np.isnan(QUANTITIES["odd"].of(result))


def test_one_for_single_impacts_alone_serves_a_batch():
    law = Simulation().run(Scene.nondimensional(psi1=PSI1, chi=1.44))
    with column(Column("one", "1", value=lambda result: float(result.psi2))), no_warning():
        assert QUANTITIES["one"].of(law) == pytest.approx(law.psi2, rel=1e-15)


def no_warning():
    return warnings.catch_warnings(action="error")


def test_one_that_needs_a_history_has_no_value_without():
    scene = Scene.nondimensional(psi1=1.2, chi=1.44)
    count = Column("count", "1", value=lambda r: r.history.time.size, needs=("history",))
    with column(count), no_warning():
        assert np.isnan(QUANTITIES["count"].of(Simulation().run(scene)))
        assert QUANTITIES["count"].of(Simulation().run(scene, history=True)) > 10
