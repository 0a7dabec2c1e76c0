"""Laws that outsiders would write keep the contracts, but for what is their nature."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.testing import parametrize_with_checks
from tests.laws.law_files import EXAMPLES, of_file
from tests.laws.outside_laws import (
    Adhesive,
    Heun,
    LinearDashpot,
    Plastic,
    RescaledSpring,
    Tsuji,
    Walton,
)

pytestmark = pytest.mark.slow

NORMAL = [Tsuji(), Tsuji(damping=0.5), Plastic(), Adhesive(), LinearDashpot()]
NORMAL += [Adhesive(pull=100.0, reach=1e-6)]
EXAMPLE = of_file(EXAMPLES / "custom_law.py", "MindlinCap")()
LAWS = [*NORMAL, RescaledSpring(), Walton(), Heun(), EXAMPLE]
PSI1 = np.array([0.3, 0.9, 1.5, 3.0])


@parametrize_with_checks(LAWS)
def test_conformance(law, check):
    check(law)


@pytest.mark.parametrize("law", NORMAL, ids=repr)
def test_a_damped_plastic_or_adhesive_law_expects_no_failure(law):
    assert not law.expected_failures


@pytest.mark.parametrize(
    "law", [RescaledSpring(), contactlab.create("tangential.springs")], ids=repr
)
def test_the_books_of_a_law_close_under_a_scheme_of_two_stages(law):
    """As the steps grow; what is left is the law's own, the same under one stage."""
    scene = Scene.nondimensional(psi1=PSI1, chi=1.4412)

    def imbalance(integrator):
        result = Simulation(tangential=law, integrator=integrator).run(scene).check()
        return np.asarray(result.energy.relative_imbalance)

    own = imbalance(contactlab.create("integrator.symplectic", steps=12_800))
    off = [np.abs(imbalance(Heun(steps=steps)) - own).max() for steps in (100, 400, 1600)]
    assert off[1] < 0.6 * off[0]
    assert off[2] < 0.6 * off[1]
