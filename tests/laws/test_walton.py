"""Walton's law of hard spheres, under the restitution of any normal law."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from tests.laws.normal_laws import Damped, in_si


@pytest.mark.parametrize("normal", ["hertz", Damped()])
@pytest.mark.parametrize("beta0", [-1.0, 0.0, 0.4, 1.0])
def test_the_lesser_of_two_impulses(normal, beta0):
    chi, psi1 = 1.2, np.array([-3.0, 0.1, 1.0, 2.5, 5.0, 40.0])
    law = contactlab.create("tangential.walton", beta0=beta0)
    result = Simulation(normal=normal, tangential=law).run(
        in_si(Scene.nondimensional(psi1=psi1, chi=chi))
    )
    e = result.check().normal_restitution
    lost = np.minimum(2.0 * chi * (1.0 + e), (1.0 + beta0) * np.abs(psi1))
    assert result.psi2 == pytest.approx(psi1 - np.sign(psi1) * lost, abs=1e-9)
    assert result.energy.relative_imbalance == pytest.approx(0.0, abs=1e-9)


def test_no_beta0_is_the_rigid_law():
    scene = Scene.nondimensional(psi1=np.linspace(-8.0, 8.0, 33), chi=49 / 34)
    hard = contactlab.create("tangential.walton", beta0=0.0)
    rigid = Simulation(tangential="coulomb").run(scene).check().psi2
    assert Simulation(tangential=hard).run(scene).check().psi2 == pytest.approx(rigid, abs=1e-12)


def test_beta0_out_of_range_is_refused():
    with pytest.raises(ValueError, match=r"beta0 = 1\.5: must lie in \[-1, 1\]"):
        contactlab.create("tangential.walton", beta0=1.5)
