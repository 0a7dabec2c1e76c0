"""``tangential.fronts`` from its table, against itself solved."""

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status
from contactlab.cli.main import main
from contactlab_laws.fronts.law import REASON

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
GLASS = Material(young_modulus=70e9, poisson_ratio=0.2, density=2500.0)


def solved(tolerance=1e-9):
    return Simulation(
        tangential=contactlab.create("tangential.fronts", table=False),
        integrator=contactlab.create("integrator.events", tolerance=tolerance),
    )


def grid():
    psi1, chi = np.meshgrid((-4.0, -0.3, 0.0, 0.7, 1.0, 1.3, 2.5, 5.0, 40.0), (0.3, 1.44, 2.4, 4.0))
    return Scene.nondimensional(psi1=psi1.ravel(), chi=chi.ravel())


def random(count, seed):
    """Impacts of every chi in the table that do not slip throughout."""
    draw = np.random.default_rng(seed)
    chi = draw.uniform(0.02, 2.5, count)
    psi1 = draw.uniform(0.0, np.maximum(1.0, 4.0 * chi - 1.0)) * draw.choice([-1.0, 1.0], count)
    return Scene.nondimensional(psi1=psi1, chi=chi)


def test_it_is_the_exact_solution_within_what_it_declares():
    found, exact = Simulation().run(grid()).check(), solved().run(grid()).check()
    error = np.asarray(found.plan.psi2_error)
    assert np.all(np.abs(found.psi2 - exact.psi2) <= error)
    assert np.all(error <= 1.1e-9 * np.maximum(1.0, np.abs(grid().psi1)))
    assert np.all(error[np.abs(grid().psi1) == 40.0] < 1e-10)  # slips throughout: a closed form
    assert error[(np.abs(grid().psi1) == 0.3) & (grid().chi < 2.5)] == pytest.approx(1e-9, rel=0.01)
    work, other = found.motion.friction_work, exact.motion.friction_work
    assert np.allclose(work, other, rtol=0.0, atol=1e-6 * exact.energy.start)


def _differences(count, seed):
    """Largest differences of psi2 over max(1, |psi1|), and of work over the energy at the start."""
    scene = random(count, seed)
    found, exact = Simulation().sweep(scene).check(), solved(1e-10).sweep(scene).check()
    assert not found.plan.marched.any()
    assert exact.plan.marched.all()
    work = np.abs(found.energy.friction_work - exact.energy.friction_work) / exact.energy.start
    assert np.all(exact.energy.checked)
    error = np.abs(found.psi2 - exact.psi2) / np.maximum(1.0, np.abs(scene.psi1))
    return error.max(), work.max()


def test_velocities_and_work_are_those_of_impacts_that_are_followed():
    """The work is added up independently there."""
    psi2, work = _differences(80, 30)
    assert psi2 < 2e-10
    assert work < 2e-10


@pytest.mark.slow
def test_velocities_and_work_over_ten_thousand_impacts():
    psi2, work = _differences(10_000, 31)
    assert psi2 < 2e-10
    assert work < 2e-10


def test_plan_counters_and_ledger_say_it(monkeypatch):
    """Beyond the table impacts are followed, where nothing is compiled."""
    monkeypatch.setenv("CONTACTLAB_COMPILED", "0")
    result = Simulation().run(grid())
    told = str(result.plan)
    assert f"stepping through the contact (15 of 36 impacts): {REASON}" in told
    assert "energy check (15 of 36 impacts): " in told
    assert result.counters["tabulated"] == 15
    assert result.counters["panels"] > 0
    followed = np.asarray(grid().chi) > 2.5
    assert np.array_equal(
        result.plan.marched, followed & (np.abs(grid().psi1) < 15.0) & (grid().psi1 != 0.0)
    )
    assert np.count_nonzero(~result.energy.checked) == 15
    assert np.all(result.energy.imbalance[~result.energy.checked] == 0.0)
    parts = [result[k].energy.checked for k in range(36)]
    assert parts == result.energy.checked.tolist()
    assert result.energy.to_dict()["checked"] == parts
    swept = Simulation().sweep(grid())
    assert np.array_equal(swept.energy.checked, result.energy.checked)
    alone = Simulation().run(Scene.nondimensional(psi1=1.2, chi=1.44))
    assert (alone.energy.checked, alone.counters) == (False, {"tabulated": 1})
    beyond = Simulation().run(Scene.nondimensional(psi1=1.2, chi=4.0))
    assert beyond.energy.checked is True
    assert "energy check" not in str(beyond.plan)
    assert "energy check: " in str(alone.plan)


@pytest.mark.parametrize("how", [{"history": True}, {"history": "fields"}])
def test_a_history_follows_the_impact_and_checks_the_books(how):
    scene = Scene.nondimensional(psi1=1.2, chi=1.44)
    result = Simulation().run(scene, **how).check()
    assert result.plan.marched
    assert result.energy.checked
    assert np.isfinite(result.history.tangential_force).all()
    assert result.psi2 == pytest.approx(Simulation().run(scene).psi2, abs=2e-10)
    central = Simulation().run(Scene.nondimensional(psi1=9.0, chi=1.44), history=True)
    assert not central.plan.marched  # slips throughout: its course is known in closed form


@pytest.mark.parametrize(("tolerance", "marched"), [(1e-3, False), (1e-9, False), (9e-10, True)])
def test_a_tolerance_below_the_error_of_the_table_follows_the_impact(tolerance, marched):
    events = contactlab.create("integrator.events", tolerance=tolerance)
    for psi1 in (0.3, 3.0, np.array([0.3, 3.0])):
        plan = Simulation(integrator=events).plan(Scene.nondimensional(psi1=psi1, chi=1.44))
        assert np.all(plan.marched == marched)
        assert np.all(plan.psi2_error <= 1.1 * max(tolerance, 1e-9) * np.maximum(psi1, 1.0))


@pytest.mark.parametrize("friction", [0.0, 0.3, np.array([0.0, 0.1, 0.3])])
def test_in_si_with_and_without_friction(friction):
    ball = Sphere(0.01, STEEL)
    scene = Scene(ball, HalfSpace(GLASS), friction, 1.0, np.array([0.1, 0.4, -0.4]), 3.0)
    found, exact = Simulation().run(scene).check(), solved().run(scene).check()
    assert found.rebound_spin == pytest.approx(exact.rebound_spin, abs=1e-6)
    assert found.rebound_tangential_velocity == pytest.approx(
        exact.rebound_tangential_velocity, abs=1e-9
    )
    if np.ndim(friction) or friction:
        assert "unlike bodies" in str(found.plan)
    for k in range(3):
        alone = Simulation().run(scene.take(k)).check()
        assert alone.rebound_spin == pytest.approx(found.rebound_spin[k], abs=1e-7)


def test_the_books_are_told_in_words(tmp_path, capsys):
    file = tmp_path / "scene.toml"
    file.write_text("[nondimensional]\npsi1 = 1.2\nchi = 1.44\n", encoding="utf-8")
    assert main(["run", str(file)]) == 0
    told = capsys.readouterr().out
    assert "balances by construction" in told
    assert "added up" not in told


def test_a_sweep_gives_what_a_run_gives():
    scene = random(5000, 32)
    calls = []
    result = Simulation().sweep(scene, progress=lambda done, _: calls.append(done))
    assert calls[-1] == 5000
    assert set(result.status.tolist()) == {Status.SUCCESS}
    assert np.allclose(result.psi2, Simulation().run(scene).psi2, rtol=0.0, atol=1e-11)
