"""``tangential.tabulated``: the tabulated rebound as a law, against the exact solution."""

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status
from contactlab.compose.sweep import WHOLE_IMPACTS

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
GLASS = Material(young_modulus=70e9, poisson_ratio=0.2, density=2500.0)


def tabulated():
    return Simulation(tangential="tabulated")


def grid():
    psi1, chi = np.meshgrid((-4.0, -0.3, 0.0, 0.7, 1.0, 1.3, 2.5, 5.0, 40.0), (0.3, 1.44, 2.4, 4.0))
    return Scene.nondimensional(psi1=psi1.ravel(), chi=chi.ravel())


def test_it_is_the_exact_solution_within_what_it_declares():
    found, exact = tabulated().run(grid()).check(), Simulation().run(grid()).check()
    error = np.asarray(found.plan.psi2_error)
    assert np.all(np.abs(found.psi2 - exact.psi2) <= error)
    assert np.all(error <= 1.1e-9 * np.maximum(1.0, np.abs(grid().psi1)))
    assert np.all(error[np.abs(grid().psi1) == 40.0] < 1e-10)  # slips throughout: a closed form
    assert np.all(
        np.asarray(found.plan.psi2_error)[np.abs(grid().psi1) == 0.3]
        == pytest.approx(1e-9, rel=0.01)
    )
    work, other = found.motion.friction_work, exact.motion.friction_work
    assert np.allclose(work, other, rtol=0.0, atol=1e-6 * exact.energy.start)


def test_the_plan_says_where_the_work_comes_from():
    told = str(tabulated().plan(grid()))
    words = "friction work from the energy balance, not an independent sum"
    assert f"the rebound is tabulated; {words}" in told
    assert f"chi > 2.5, solved; {words}" in told
    assert not tabulated().plan(grid()).marched.any()
    alone = {
        chi: str(tabulated().plan(Scene.nondimensional(psi1=1.3, chi=chi))) for chi in (1.44, 4.0)
    }
    assert ["is tabulated" in alone[1.44], "solved" in alone[1.44]] == [True, False]
    assert ["is tabulated" in alone[4.0], "solved" in alone[4.0]] == [False, True]


@pytest.mark.parametrize("friction", [0.0, 0.3, np.array([0.0, 0.1, 0.3])])
def test_in_si_with_and_without_friction(friction):
    ball = Sphere(0.01, STEEL)
    scene = Scene(ball, HalfSpace(GLASS), friction, 1.0, np.array([0.1, 0.4, -0.4]), 3.0)
    found, exact = tabulated().run(scene).check(), Simulation().run(scene).check()
    assert found.rebound_spin == pytest.approx(exact.rebound_spin, abs=1e-6)
    assert found.rebound_tangential_velocity == pytest.approx(
        exact.rebound_tangential_velocity, abs=1e-9
    )
    if np.ndim(friction) or friction:
        assert "unlike bodies" in str(found.plan)
    for k in range(3):
        alone = tabulated().run(scene.take(k)).check()
        assert alone.rebound_spin == pytest.approx(found.rebound_spin[k], abs=1e-7)


def test_a_history_has_no_tangential_course_where_none_is_known():
    result = tabulated().run(Scene.nondimensional(psi1=0.5, chi=1.0), history=True)
    assert np.isnan(result.history.tangential_force).all()
    assert result.history.normal_force.max() > 0.0


def test_it_needs_the_elastic_impact():
    from tests.outside_laws import Tsuji

    with pytest.raises(ValueError, match="elastic_hertz"):
        Simulation(normal=Tsuji(), tangential="tabulated")


def test_a_sweep_takes_many_together():
    scene = Scene.nondimensional(psi1=np.linspace(0.0, 4.0, WHOLE_IMPACTS + 7), chi=1.3)
    calls = []
    result = tabulated().sweep(scene, progress=lambda done, _: calls.append(done))
    assert calls == [WHOLE_IMPACTS, WHOLE_IMPACTS + 7]
    assert set(result.status.tolist()) == {Status.SUCCESS}
    assert np.allclose(result.psi2, tabulated().run(scene).psi2, rtol=0.0, atol=1e-11)
