"""What few springs buy: largest errors of psi2 of a solid sphere, as the guide states them."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation

CHI = 49.0 / 34.0


@pytest.mark.parametrize(
    ("springs", "worst", "typical"),
    [(1, 0.24, 0.135), (2, 0.039, 0.0195), (3, 0.0225, 0.0095), (4, 0.0129, 0.0055),
     (8, 0.003, 0.0011)],
)  # fmt: skip
@pytest.mark.parametrize("steps", [50, 400])
def test_largest_error_of_few_springs(springs, worst, typical, steps):
    psi1 = np.linspace(0.02, 4.0 * CHI, 200)
    simulation = Simulation(
        tangential=contactlab.create("tangential.springs", springs=springs),
        integrator=contactlab.create("integrator.symplectic", steps=steps),
    )
    psi2 = simulation.run(Scene.nondimensional(psi1=psi1, chi=CHI)).check().psi2
    error = np.abs(psi2 - contactlab.rebound(psi1, CHI))
    assert error.max() == pytest.approx(worst, rel=0.2)
    assert error.max() <= worst
    assert np.sqrt(np.mean(error**2)) <= typical
