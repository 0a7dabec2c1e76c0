"""Impacts that are answered as wholes, and batches of one."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, Status
from contactlab.impact.hertz import rigid_body_rebound
from tests.laws.ending_laws import Raising
from tests.laws.normal_laws import in_si
from tests.laws.outside_laws import Plastic, Tsuji, Walton

CHI = 49.0 / 34.0


@pytest.mark.parametrize("integrator", ["symplectic", "paper", "adaptive"])
@pytest.mark.parametrize("shape", [(1,), (1, 1)])
@pytest.mark.parametrize("psi1", [0.5, 1.2, -3.0])
def test_a_batch_of_one_is_the_impact_to_the_last_bit(integrator, shape, psi1):
    """It took the steps one by one, of the arrays of a batch: 50 times the time, other bits."""
    sim = Simulation(
        tangential=contactlab.create("tangential.annulus", annuli=10),
        integrator=contactlab.create(f"integrator.{integrator}"),
    )
    if integrator == "adaptive":
        sim = Simulation(
            tangential=sim.tangential,
            integrator=contactlab.create("integrator.adaptive", tolerance=1e-2),
        )
    alone = sim.run(Scene.nondimensional(psi1=psi1, chi=CHI)).check()
    batch = sim.run(Scene.nondimensional(psi1=np.full(shape, psi1), chi=CHI)).check()
    assert batch.psi2.shape == shape
    assert batch.psi2.item() == alone.psi2
    assert batch.motion.friction_work.item() == alone.motion.friction_work
    assert batch.counters == alone.counters


@pytest.mark.parametrize("normal", ["hertz", Tsuji(), Plastic(restitution=0.6, stiffness=1.0)])
@pytest.mark.parametrize("law", ["coulomb", Walton(beta=0.4)])
def test_a_whole_law_needs_no_march_under_any_normal_law(normal, law):
    """The same numbers whatever integrator is named, alone and in a batch."""
    psi1 = np.array([-9.0, -0.3, 0.0, 0.3, 2.0, 9.0])
    scene = in_si(Scene.nondimensional(psi1=psi1, chi=CHI))
    found = [
        Simulation(normal=normal, tangential=law, integrator=name).run(scene).check()
        for name in ("symplectic", "paper", "adaptive", "events")
    ]
    assert not found[0].plan.marched.any()
    for other in found[1:]:
        assert other.psi2.tolist() == found[0].psi2.tolist()
    e = found[0].normal_restitution
    if law == "coulomb":
        assert found[0].psi2 == pytest.approx(rigid_body_rebound(psi1, CHI, e), abs=1e-6)
    else:
        sticks = 1.4 * np.abs(psi1)
        slips = np.minimum(2.0 * CHI * (1.0 + e), sticks)
        assert found[0].psi2 == pytest.approx(np.sign(psi1) * (np.abs(psi1) - slips), abs=1e-6)
    for index, value in enumerate(psi1.tolist()):
        alone = Simulation(normal=normal, tangential=law).run(
            in_si(Scene.nondimensional(psi1=value, chi=CHI))
        )
        assert alone.check().psi2 == pytest.approx(found[0].psi2[index], abs=1e-12)
    assert np.abs(found[0].energy.relative_imbalance).max() < 1e-9


def test_no_friction_and_no_slip_are_known_of_any_law():
    for law in ("springs", "annulus", "mindlin_cap", "fronts"):
        result = Simulation(tangential=law).run(Scene.nondimensional(psi1=[0.0, 9.0], chi=CHI))
        assert not result.check().plan.marched.any()
        assert result.psi2[0] == 0.0
        assert result.psi2[1] == pytest.approx(9.0 - 4.0 * CHI, rel=1e-14)
        assert result.status.tolist() == [Status.SUCCESS] * 2


@pytest.mark.parametrize("shape", [(9,), (3, 3)])
def test_a_whole_law_that_raises_loses_the_impacts_that_it_raises_for_and_no_other(shape):
    psi1 = np.linspace(0.0, 8.0, 9).reshape(shape)
    result = Simulation(tangential=Raising()).run(Scene.nondimensional(psi1=psi1, chi=CHI))
    failed = result.status != Status.SUCCESS
    assert failed.tolist() == (psi1 > 5.0).tolist()
    assert set(result.status[failed]) == {Status.LAW_RAISED}
    assert result.psi2[~failed].tolist() == psi1[~failed].tolist()
    assert np.isnan(result.psi2[failed]).all()
