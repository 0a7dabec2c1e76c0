"""Vector springs in space beside rings whose tractions obey Coulomb's law at every ring."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, create
from tests.laws.rings_in_space import extrapolated, impact

NONE = (0.0, 0.0)
SPRINGS = Simulation(
    tangential=create("tangential.springs", springs=200),
    integrator=create("integrator.symplectic", steps=800),
)


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_slip_throughout_is_the_closed_form(angle):
    """psi2 = psi1 - 4 chi along the slip, whatever its direction (theory §14)."""
    along = np.array([np.cos(angle), np.sin(angle)])
    rate, slip = impact(5.0 * along, 1.2 * np.eye(2), NONE, 1.0, rings=16, steps=100)
    assert rate == pytest.approx(-1.0, abs=1e-6)
    assert slip == pytest.approx(0.2 * along, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("psi1", "chi"), [(2.0, 1.2), (3.0, 2.58), (4.03, 2.58)])
def test_in_a_plane_the_rings_are_the_exact_solution(psi1, chi):
    _, slip = extrapolated((0.0, psi1), chi * np.eye(2), NONE, 1.0, rings=32, steps=200)
    assert slip == pytest.approx([0.0, contactlab.rebound(psi1, chi)], abs=0.005)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("psi1", "chi", "lam", "rho", "rate", "psi2"),
    [
        ((1.5, 1.0), (1.0, 2.0), NONE, 1.0, -1.0, (-1.07931, 0.13832)),
        ((0.823529, 1.647059), (0.624398, 0.828930), (-0.212817, 0.0), 0.109286,
         -0.953597, (2.967245, -0.039106)),
    ],
)  # fmt: skip
def test_the_impacts_of_the_theory(psi1, chi, lam, rho, rate, psi2):
    found = extrapolated(psi1, np.diag(chi), lam, rho, rings=32, steps=200)
    assert found[0] == pytest.approx(rate, abs=2e-3)
    assert found[1] == pytest.approx(psi2, abs=2e-3)


@pytest.mark.slow
def test_springs_are_off_by_no_more_than_their_caution_says():
    """Slip turns by a half circle: another law for the surface, and not a matter of steps."""
    psi1, chi = (-3.113, 2.56), np.diag([1.2, 2.58])
    _, truth = extrapolated(psi1, chi, NONE, 0.313, rings=32, steps=200)
    scene = Scene.nondimensional(psi1=psi1, chi=chi, lam=NONE, rho=0.313)
    off = np.abs(SPRINGS.run(scene).psi2 - truth).max()
    assert 0.04 < off < 0.1
    assert any("up to 0.1" in str(each) for each in SPRINGS.plan(scene).cautions)
