"""The table of rebounds with loss, against rings that lose in pressure and shear."""

import numpy as np
import pytest

from contactlab import rebound
from contactlab_laws.viscoelastic.relaxation import restitution_of
from tests.halfspace.viscous_rings import rebound as by_rings


@pytest.mark.parametrize("a", [0.1, 0.4])
def test_springs_are_coulombs_law_at_every_point(a):
    """By rings that lose in pressure and shear, in whose solution there are no springs."""
    psi1, chi = np.array([0.9, 1.1, 2.0]), np.array([1.44, 7 / 6, 1.0])
    table = rebound(psi1, chi, restitution=restitution_of(a))
    assert by_rings(psi1, chi, a, 64) == pytest.approx(table, abs=1e-3)
