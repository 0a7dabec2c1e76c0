"""The energy of the spring bundle: none from nothing, the books close."""

import itertools

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from tests.laws.exact_laws import CHI, grid, simulation


def test_energy_books_close_to_second_order():
    psi1, chi, _ = grid()
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    worst = [
        np.abs(
            simulation("springs", steps=4 * n, springs=n).run(scene).energy.relative_imbalance
        ).max()
        for n in (25, 50, 100)
    ]
    assert worst[2] < 2e-4
    assert worst[0] / worst[2] > 8.0


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
@pytest.mark.parametrize("chi", [3.0, 1000.0])
def test_few_springs_make_no_energy(count, chi):
    """However stiff the contact, and however many steps let it oscillate.

    A factor on the force that grows without bound as the contact meets its first spring
    gave |psi2| up to 6 |psi1| here.
    """
    psi1 = np.concatenate(([1e-3, 1e-2, 0.1, 0.3, 0.98, 1.2], np.linspace(0.02, 4.0, 20)))
    for steps in (728, 2000):
        result = simulation("springs", steps=steps, springs=count).run(
            Scene.nondimensional(psi1=psi1, chi=chi)
        )
        assert (np.abs(result.check().psi2) <= 1.02 * psi1).all()


@pytest.mark.parametrize("count", [1, 2, 3, 10, 50])
def test_books_stay_within_what_the_law_declares(count):
    """With as few steps as the integrators allow, and bodies from slow to quick to turn."""
    psi1 = np.concatenate(([1e-3, 0.98, 1.0, 1.2, 10.0], np.linspace(0.02, 4.0, 12)))
    for chi, integrator in itertools.product((0.05, 0.5, CHI, 8.0, 100.0), ("symplectic", "paper")):
        chosen = contactlab.create("tangential.springs", springs=count)
        steps = contactlab.create(f"integrator.{integrator}", steps=7)
        result = Simulation(tangential=chosen, integrator=steps).run(
            Scene.nondimensional(psi1=psi1, chi=chi)
        )
        assert np.abs(result.energy.relative_imbalance).max() < chosen.books_bound(result.scene)
        result.check()


def test_finer_laws_declare_tighter_books():
    """A bound that grew with the parts would bound nothing: all the energy is 1."""
    scene = Scene.nondimensional(psi1=1.0, chi=CHI)
    bounds = [
        contactlab.create("tangential.springs", springs=count).books_bound(scene)
        for count in (1, 2, 10, 50, 200)
    ]
    assert bounds == sorted(bounds, reverse=True)
    assert 0.03 < bounds[-1] < bounds[0] < 0.3
