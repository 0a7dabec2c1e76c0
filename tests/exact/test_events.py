"""Other laws under the event-locating integrator."""

import numpy as np
import pytest

from contactlab import Scene, Simulation
from contactlab.closed_forms import rigid_body_rebound

CHI = 1.4411764706


@pytest.mark.parametrize("chi", [0.3, 1.0, CHI, 8.0])
@pytest.mark.parametrize("share", [-2.0, -0.5, 1e-9, 0.1, 0.25, 0.999999, 1.0, 1.000001, 3.0])
def test_rigid_coulomb_is_exact(share, chi):
    """psi2 = 0 below 4 chi, psi1 - 4 chi above: to rounding, since slip's end is located."""
    psi1 = share * 4.0 * chi
    result = Simulation(tangential="coulomb", integrator="events").run(
        Scene.nondimensional(psi1=psi1, chi=chi), history=True
    )
    assert result.check().psi2 == pytest.approx(rigid_body_rebound(psi1, chi), abs=1e-11)
    assert abs(result.energy.relative_imbalance) < 1e-11


def test_sliding_stops_at_its_instant():
    """Slip ends where mu times the normal impulse has taken all of psi1: 2 chi (1 - V) = psi1."""
    result = Simulation(tangential="coulomb", integrator="events").run(
        Scene.nondimensional(psi1=2.0, chi=CHI), history=True
    )
    history = result.history
    rolling = np.abs(history.slip_velocity) < 1e-12
    ended = 1.0 - 2.0 / (2.0 * CHI)
    assert (rolling == (history.normal_velocity <= ended)).all()
    assert 20 < rolling.sum() < len(rolling) - 20
    assert (history.tangential_force[rolling] == 0.0).all()
    sliding = history.tangential_force[~rolling]
    assert sliding == pytest.approx(history.normal_force[~rolling], rel=1e-12)
    gone = 2.0 - 2.0 * CHI * (1.0 - history.normal_velocity[~rolling])
    assert history.slip_velocity[~rolling] == pytest.approx(gone, abs=1e-12)


def test_laws_of_whole_impacts_fit_every_integrator():
    scene = Scene.nondimensional(psi1=2.0, chi=CHI)
    values = [
        Simulation(tangential="coulomb", integrator=name).run(scene).check().psi2
        for name in ("events", "paper", "symplectic")
    ]
    assert values == pytest.approx([0.0, 0.0, 0.0], abs=1e-11)


def test_frictionless_under_events():
    result = Simulation(tangential="frictionless", integrator="events").run(
        Scene.nondimensional(psi1=2.0, chi=CHI), history=True
    )
    assert result.check().psi2 == 2.0
