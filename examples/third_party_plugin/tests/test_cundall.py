"""The law through the front door: found by name, made with an option, kept to its contract."""

import numpy as np
import pytest

import contactlab
from contactlab.testing import parametrize_with_checks


@parametrize_with_checks(["tangential.cundall"])
def test_conformance(law, check):
    """All of contactlab's own checks of a tangential law."""
    check(law)


def simulation(**options):
    law = contactlab.create("tangential.cundall", **options)
    steps = contactlab.create("integrator.symplectic", steps=800)
    return contactlab.Simulation(tangential=law, integrator=steps)


def test_coulomb_limit_and_separation_without_force():
    scene = contactlab.Scene.nondimensional(psi1=2.0, chi=1.4412)
    history = simulation().run(scene, history=True).check().history
    limit = history.normal_force  # mu = 1 in a non-dimensional scene
    # The law is given the mean normal force of a step, the history has the one in its middle.
    assert np.all(np.abs(history.tangential_force) <= limit + 1e-4 * limit.max())
    assert abs(history.tangential_force[-1]) < 1e-3


def test_books_balance_and_the_law_is_odd():
    psi1 = np.array([-3.0, -1.2, 0.4, 1.2, 3.0])
    result = simulation().run(contactlab.Scene.nondimensional(psi1=psi1, chi=1.4412)).check()
    assert np.max(np.abs(result.energy.relative_imbalance)) < 2e-3
    assert result.psi2[0] == pytest.approx(-result.psi2[4], abs=1e-12)
    assert result.psi2[1] == pytest.approx(-result.psi2[3], abs=1e-12)


def test_gross_slip_is_the_closed_form():
    result = simulation().run(contactlab.Scene.nondimensional(psi1=9.0, chi=1.4412)).check()
    assert result.psi2 == pytest.approx(9.0 - 4.0 * 1.4412, abs=1e-3)


@pytest.mark.parametrize("bad", [0.0, -1.0, float("nan"), float("inf"), "stiff", True])
def test_bad_option_is_refused_by_name(bad):
    with pytest.raises(ValueError, match="stiffness_ratio"):
        contactlab.create("tangential.cundall", stiffness_ratio=bad)
