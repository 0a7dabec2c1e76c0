"""The annulus law against the paper's equations written plainly, and against the exact solution."""

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create
from contactlab_laws.annulus import step, tables
from contactlab_laws.march.division import endpoints
from tests.laws import plain
from tests.laws.exact_laws import CHI, grid, marched_change, order, rms, simulation
from tests.longer import longer


def impact(psi1, chi, annuli, steps, *, history=False, integrator="paper"):
    sim = simulation("annulus", integrator, steps=steps, annuli=annuli)
    return sim.run(Scene.nondimensional(psi1=psi1, chi=chi), history=history).check()


@pytest.mark.parametrize("chi", [0.4, CHI, 3.0, *longer(1.0)])
@pytest.mark.parametrize("psi1", [0.1, 1.2, 2.6, *longer(0.7)])
def test_equations_30_to_37(psi1, chi):
    """psi2 and the force at every step, to 1e-9."""
    steps, annuli = 300, 30
    psi2, forces = plain.along_the_exact_motion(psi1, chi, annuli=annuli, steps=steps)
    if psi1 >= max(
        1.0, 4.0 * chi - 1.0
    ):  # here the plan takes eq. (45) unless fields are asked for
        result = impact(psi1, chi, annuli, steps, history="fields")
    else:
        result = impact(psi1, chi, annuli, steps, history=True)
        assert impact(psi1, chi, annuli, steps).psi2 == pytest.approx(psi2, abs=1e-9)
    assert result.psi2 == pytest.approx(psi2, abs=1e-9)
    found = result.history.tangential_force / 1.25  # mu P_max of a non-dimensional scene
    assert found == pytest.approx(forces, abs=1e-9)


@pytest.mark.parametrize(("psi1", "chi"), [(0.1, 0.4), (1.2, CHI), (2.6, 3.0)])
def test_the_papers_own_march_of_the_normal_motion_is_as_near(psi1, chi):
    """Eqs (30)-(32) by the same steps: the answers come together as the square of the step."""
    apart = []
    for steps in (100, 200, 400):
        psi2, _ = plain.impact(psi1, chi, annuli=20, steps=steps)
        apart.append(abs(impact(psi1, chi, 20, steps).psi2 - psi2))
    assert apart[-1] < 1e-4
    assert order((100, 200, 400), apart) > 1.5


def test_a_force_at_a_sample_acts_from_half_way_to_its_neighbours():
    """The first from first touch, the last to separation: of the same length, loads apart."""
    count = 12
    normal = simulation("annulus", steps=count).normal_motion(
        Scene.nondimensional(psi1=1.0, chi=1.0)
    )
    steps = endpoints(normal, count)
    between = normal.at(normal.phase((np.arange(1, count) + 0.5) / count)).load_impulse
    assert np.cumsum(steps.friction_load * steps.kick)[:-1] == pytest.approx(between, rel=1e-9)


def test_tractions_over_the_contact_add_up_to_the_force():
    """In SI; as sums over annuli, whose means are not told, to a few per cent."""
    steel = Material.named("steel")
    scene = Scene(Sphere(0.01, steel), HalfSpace(steel), 0.2, 1.0, 0.3)
    result = simulation("annulus", steps=60, annuli=80).run(scene, history="fields").check()
    fields, history = result.history.fields, result.history
    radius = np.asarray(fields["radius"])
    edges = 0.5 * (radius[:, 1:] + radius[:, :-1])
    last = 2.0 * radius[:, -1:] - edges[:, -1:]
    areas = np.pi * np.diff(np.hstack([0.0 * last, edges, last]) ** 2, axis=1)
    found = (fields["traction"] * areas).sum(axis=1)
    largest = np.abs(history.tangential_force).max()
    assert found == pytest.approx(history.tangential_force, abs=0.03 * largest)


@pytest.mark.parametrize("annuli", [1, 2, 200])
def test_any_number_of_annuli(annuli):
    psi2, _ = plain.along_the_exact_motion(1.2, CHI, annuli=annuli, steps=100)
    assert impact(1.2, CHI, annuli, 100).psi2 == pytest.approx(psi2, abs=1e-9)


def test_worst_error_at_50_annuli_and_500_steps():
    """Over psi1 in (0, 4 chi], chi in [0.35, 4]; sign and size of the error are the paper's."""
    psi1, chi, psi2 = grid()
    error = impact(psi1, chi, 50, 500).psi2 - psi2
    assert np.abs(error).max() <= 0.03
    assert rms(error) > 1e-4  # else these are not the paper's annuli


@pytest.mark.parametrize("passes", [200, 1])
def test_a_batch_gives_what_its_impacts_give_one_by_one(passes, monkeypatch):
    """Too few passes settle no division: those impacts are then marched one by one."""
    monkeypatch.setattr(step, "MOST_PASSES", passes)
    psi1 = np.array([0.05, 0.8, -1.3, 2.2, 4.1])
    chi = np.array([CHI, 0.7, 1.4, 2.0, CHI])
    together = impact(psi1, chi, 20, 100)
    for k in range(len(psi1)):
        alone = impact(float(psi1[k]), float(chi[k]), 20, 100)
        assert together.psi2[k] == pytest.approx(alone.psi2, abs=1e-11)
        assert together.motion.friction_work[k] == pytest.approx(
            alone.motion.friction_work, abs=1e-11
        )


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
@pytest.mark.parametrize(("psi1", "chi"), [(0.1, CHI), (1.2, CHI), (2.0, 3.0), (0.6, 0.4)])
def test_blocks_of_steps_are_step_by_step(psi1, chi, integrator):
    """An observer forces step by step."""
    at_once = impact(psi1, chi, 40, 200, integrator=integrator)
    stepped = impact(psi1, chi, 40, 200, integrator=integrator, history="fields")
    assert at_once.psi2 == pytest.approx(stepped.psi2, abs=1e-11)
    works = at_once.motion.friction_work, stepped.motion.friction_work
    assert works[0] == pytest.approx(works[1], abs=1e-11)


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
@pytest.mark.parametrize("psi1", [4.0 * CHI - 1.0, -7.0, 1e6])
def test_whole_slip_comes_to_the_closed_form(psi1, integrator):
    """Eq. (45), to the error of the annuli: they make a little less of the friction."""
    errors = []
    for annuli in (10, 20, 40):
        sim = simulation("annulus", integrator, steps=400, annuli=annuli)
        errors.append(1.0 - marched_change(sim, psi1, CHI) / (-np.sign(psi1) * 4.0 * CHI))
    assert 0.0 < errors[-1] < 1.5e-3
    assert order((10, 20, 40), errors) > 1.0


@pytest.mark.parametrize("displacement", ["midpoint", "mean"])
def test_many_annuli_have_the_answers_of_one_solve_a_step(displacement, monkeypatch):
    """The kept responses of all divisions are exchanges after exchanges; a solve is none."""
    simulation = Simulation(
        tangential=create("tangential.annulus", annuli=130, displacement=displacement),
        integrator=create("integrator.symplectic", steps=130),
    )
    scene = Scene.nondimensional(psi1=1.3, chi=CHI)
    kept = simulation.run(scene)
    monkeypatch.setattr(tables, "LARGEST_TABLE", 100)
    tables.tables.cache_clear()
    solved = simulation.run(scene)
    tables.tables.cache_clear()
    assert kept.psi2 == pytest.approx(solved.psi2, abs=1e-12)
    assert kept.motion.friction_work == pytest.approx(solved.motion.friction_work, abs=1e-12)


def stuck_share(result):
    """Return time over duration, and the share of the area in contact that sticks."""
    fields = result.history.fields
    stuck, slips = np.asarray(fields["stuck"], dtype=bool), np.asarray(fields["slipping"]) != 0
    radius = np.asarray(fields["radius"])[0]
    area = radius * np.gradient(radius)
    share = (stuck * area).sum(axis=1) / ((stuck | slips) * area).sum(axis=1).clip(1e-12)
    return result.history.time / result.motion.duration, share


@pytest.mark.parametrize(("psi1", "took"), [(1.2, 0.17), (1.5, 0.24)])
def test_outermost_annuli_stick_falsely_while_few_are_in_contact(psi1, took):
    """From a tenth of the area to all of it; exactly, all sticks at once (theory §6)."""
    scene = Scene.nondimensional(psi1=psi1, chi=CHI)
    annuli = impact(psi1, CHI, 50, 1000, history="fields")
    exact = Simulation().run(scene, history="fields").check()
    springs = Simulation(tangential="springs").run(scene, history="fields").check()
    for result, expected in ((annuli, took), (exact, 0.0), (springs, 0.0)):
        time, share = stuck_share(result)
        spread = time[np.argmax(share > 0.999)] - time[np.argmax(share > 0.1)]
        assert spread == pytest.approx(expected, abs=0.01)
        assert ("caution: stick and slip of annuli" in str(result.plan)) is (result is annuli)
    assert annuli.psi2 == pytest.approx(exact.psi2, abs=0.006)
    without = impact(psi1, CHI, 50, 1000, history=True)
    assert "stick and slip of annuli" not in str(without.plan)


def test_microslip_begins_while_the_contact_grows_and_annuli_slip_before():
    scene = Scene.nondimensional(psi1=1.2, chi=CHI)
    begins = []
    for result in (
        Simulation().run(scene, history="fields").check(),
        impact(1.2, CHI, 50, 1000, history="fields"),
    ):
        time, share = stuck_share(result)
        full = np.argmax(share > 0.999)
        begins.append(time[full + np.argmax(share[full:] < 0.999)])
        assert time[np.argmax(result.history.contact_radius)] == pytest.approx(0.5, abs=0.01)
    assert begins == pytest.approx([0.40, 0.19], abs=0.01)
