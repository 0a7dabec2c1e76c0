"""The annulus law's energy books: what closes, and how well (theory §6)."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab_laws.annulus.tables import tables

CHI = 1.4411764706


def imbalance(displacement, annuli, steps, psi1=0.5, integrator="symplectic"):
    """Energy missing over that of the tangential motion at the start."""
    sim = Simulation(
        tangential=contactlab.create(
            "tangential.annulus", annuli=annuli, displacement=displacement
        ),
        integrator=contactlab.create(f"integrator.{integrator}", steps=steps),
    )
    result = sim.run(Scene.nondimensional(psi1=psi1, chi=CHI)).check()
    tangential = 0.5 * result.scene.pair.tangential_mass * psi1**2
    return result.energy.imbalance / tangential


@pytest.mark.parametrize("annuli", [1, 2, 10, 50])
def test_force_weights_and_mean_compliance_are_reciprocal(annuli):
    """Betti: W B symmetric and positive definite; not so for displacements in the middles."""
    table = tables(annuli, True)
    product = table.weight[:, None] * table.compliance
    assert product == pytest.approx(product.T, abs=1e-13)
    assert (np.linalg.eigvalsh(product) > 0).all()
    if annuli > 1:
        middle = tables(annuli)
        product = middle.weight[:, None] * middle.compliance
        assert np.abs(product - product.T).max() > 1e-4


@pytest.mark.parametrize("annuli", [4, 10])
def test_books_close_to_rounding_with_means(annuli):
    assert abs(imbalance("mean", annuli, 800)) < 1e-12


@pytest.mark.parametrize("annuli", [20, 50])
def test_books_close_with_means_as_the_steps_are_refined(annuli):
    """At fixed n the imbalance vanishes with the steps, at second order or nearly."""
    steps = [100, 200, 400, 800]
    missing = [abs(imbalance("mean", annuli, count)) for count in steps]
    assert missing[-1] < 1e-5
    assert -np.polyfit(np.log(steps), np.log(missing), 1)[0] > 1.5


def test_books_do_not_close_with_midpoints_whatever_the_step():
    """5 % at n = 10: the quadrature's defect, not the steps'."""
    assert imbalance("midpoint", 10, 800) == pytest.approx(-0.05, abs=0.01)
    assert imbalance("midpoint", 10, 1600) == pytest.approx(-0.05, abs=0.01)


def test_means_are_as_accurate_as_midpoints():
    exact = -0.1805194095
    errors = {}
    for displacement in ("midpoint", "mean"):
        law = contactlab.create("tangential.annulus", annuli=40, displacement=displacement)
        sim = Simulation(tangential=law, integrator="symplectic")
        errors[displacement] = abs(sim.run(Scene.nondimensional(psi1=1.2, chi=CHI)).psi2 - exact)
    assert errors["mean"] < 2 * errors["midpoint"]


@pytest.mark.parametrize("bad", ["middle", "", None, 3])
def test_bad_displacement(bad):
    with pytest.raises(ValueError, match="displacement"):
        contactlab.create("tangential.annulus", displacement=bad)
