"""The slip front under the event-locating integrator: exact, everywhere and on every edge."""

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status
from tests.laws.bundle import extrapolated
from tests.laws.reference import TABLE
from tests.longer import longer

CHI = 1.4411764706
STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


CHIS = (0.35, 0.5, 0.5 + 1e-9, 0.8, CHI, 3.0, *longer(0.45, 0.55, 1.0, 8.0, 30.0))


def exact(tolerance=1e-9):
    integrator = contactlab.create("integrator.events", tolerance=tolerance)
    return Simulation(
        tangential=contactlab.create("tangential.fronts", table=False), integrator=integrator
    )


def scene(psi1, chi=CHI):
    return Scene.nondimensional(psi1=psi1, chi=chi)


def psi2(psi1, chi, tolerance=1e-9):
    return exact(tolerance).run(scene(psi1, chi)).check().psi2


@pytest.mark.parametrize(("chi", "psi1", "value"), TABLE)
def test_reference_table(chi, psi1, value):
    """Theory §5, to the digits printed."""
    assert psi2(psi1, chi) == pytest.approx(value, abs=1.01e-10)


def edges(chi):
    """Regime boundaries, each from both sides, and a range from tiny to beyond full slip."""
    borders = [1.0, max(1.0, 4.0 * chi - 1.0), 2.0 * chi]
    sides = [border * (1.0 + d) for border in borders for d in (-1e-3, -1e-9, 0.0, 1e-9, 1e-3)]
    return [*sides, 1e-6, 1e-3, 0.05, 0.3, 0.9, 1.2 * borders[1]]


@pytest.mark.parametrize("chi", CHIS)
def test_both_sides_of_every_boundary_against_a_tighter_tolerance(chi):
    for psi1 in edges(chi):
        coarse, fine = psi2(psi1, chi), psi2(psi1, chi, 1e-11)
        assert coarse == pytest.approx(fine, abs=1e-9 * max(1.0, psi1)), psi1
        assert abs(coarse) <= psi1 * (1.0 + 1e-9)
        assert abs(coarse - psi1) <= 4.0 * chi * (1.0 + 1e-9)


def test_continuous_across_every_boundary():
    for chi in (0.4, 0.5, 0.7, CHI, 3.0, 12.0):
        for border in (1.0, max(1.0, 4.0 * chi - 1.0), 2.0 * chi):
            below, above = psi2(border - 1e-9, chi), psi2(border + 1e-9, chi)
            assert abs(above - below) < 1e-7, (chi, border)


@pytest.mark.parametrize("psi1", [1e-6, 0.1, 0.5, 0.9, 1.0 - 1e-9])
def test_chi_one_half_never_slips(psi1):
    """At chi = 1/2: psi = psi1 V and F = psi1 P, so psi2 = -psi1."""
    result = exact().run(scene(psi1, 0.5), history=True).check()
    assert result.psi2 == pytest.approx(-psi1, rel=1e-12)
    assert result.history.tangential_force == pytest.approx(
        psi1 * result.history.normal_force, abs=1e-13
    )


@pytest.mark.parametrize(
    ("psi1", "chi"),
    [(1.0533194060090847, 183.78409170773173), *longer(
        (0.9987610244171012, 220.85085905811604), (1.000124712663441, 369.2576334038081)
    )],
)  # fmt: skip
def test_slip_too_short_to_show_at_the_points_looked_at_is_found(psi1, chi):
    """The edge slips for a thousandth of x; found by chance, it made psi2 jump by up to 6e-9."""
    near = psi1 + np.array([-1e-10, -1e-12, 0.0, 1e-12, 1e-10])
    found = exact().run(scene(near, chi)).check().psi2
    assert (np.abs(found - found[2]) < 2.0 * np.abs(near - psi1) + 1e-11).all()
    assert found[2] == pytest.approx(psi2(psi1, chi, 1e-12), abs=1e-10)


def test_no_homogeneous_sphere_reverses_completely():
    """At nu = 1/2, chi = 7/6 the reversal is at most 0.597, at psi1 = 1.89 (theory §2)."""
    rubber = Material(young_modulus=2.4e6, poisson_ratio=0.5, density=1100.0)
    chi = Scene(Sphere(0.025, rubber), HalfSpace(rubber), 0.9, 3.0, 1.0).chi
    assert chi == pytest.approx(7.0 / 6.0)
    psi1 = np.linspace(1e-3, 4.0 * chi, 2001)
    reversal = -contactlab.rebound(psi1, chi) / psi1
    assert psi1[reversal.argmax()] == pytest.approx(1.89, abs=0.01)
    assert reversal.max() == pytest.approx(0.597, abs=5e-4)
    assert reversal[0] == pytest.approx(0.104, abs=1e-3)


def test_a_superball_that_reverses_completely_is_a_law_of_whole_impacts():
    """Garwin's ball: v' = (3/7) v - (4/7) omega R, from momentum and energy alone (theory §2)."""
    rubber = Material.named("rubber")
    bodies, radius = (Sphere(0.025, rubber), HalfSpace(rubber)), 0.025
    law = contactlab.create("tangential.walton", beta0=1.0)
    thrown = Scene(*bodies, 5.0, 3.0, 1.5, spin=20.0)
    result = Simulation(tangential=law).run(thrown).check()
    v, turning = 1.5, 20.0 * radius
    assert result.rebound_tangential_velocity == pytest.approx((3.0 * v - 4.0 * turning) / 7.0)
    assert result.rebound_spin * radius == pytest.approx((-10.0 * v - 3.0 * turning) / 7.0)
    elastic = Simulation().run(thrown).check()
    change = elastic.rebound_slip_velocity - (v + turning)
    assert elastic.rebound_tangential_velocity == pytest.approx(v + 2.0 / 7.0 * change)
    assert elastic.rebound_spin * radius == pytest.approx(turning + 5.0 / 7.0 * change)
    assert result.energy.friction_work == pytest.approx(0.0, abs=1e-12 * result.energy.start)


def test_small_incidence_has_its_own_limit():
    """psi2/psi1 tends to 0.23167 at chi = 1.4411765, by springs too (theory §2)."""
    assert psi2(1e-6, CHI) / 1e-6 == pytest.approx(0.23167, abs=1e-6)
    assert psi2(1e-12, CHI) / 1e-12 == pytest.approx(psi2(1e-6, CHI) / 1e-6, abs=1e-6)
    springs, _, _ = extrapolated([1e-3], CHI, 800, 2400)
    assert psi2(1e-3, CHI) == pytest.approx(springs[0], abs=1e-8)


@pytest.mark.parametrize("psi1", [1e-300, 1e-12, 0.3, 1.0, 2.0, 5.0, 7.0])
def test_odd_to_the_last_bit(psi1):
    forward, backward = exact().run(scene(psi1)), exact().run(scene(-psi1))
    assert forward.psi2 == -backward.psi2
    assert forward.energy.friction_work == backward.energy.friction_work


@pytest.mark.parametrize("psi1", [0.3, 1.2, 2.5, 4.0])
def test_units_do_not_matter(psi1):
    """One impact in m and mm, kg and t, fast and slow: the same psi2."""
    chi, friction = CHI, 0.3
    expected = psi2(psi1, chi)
    for radius, modulus, density, speed in ((0.01, 1.0, 1.0, 1.0), (10.0, 1e-6, 1e3, 1e-3)):
        steel = Material(young_modulus=208e9 * modulus, poisson_ratio=0.3, density=7850.0 * density)
        pair = Scene(Sphere(radius, steel), HalfSpace(steel), friction, speed, 0.0).pair
        slip = psi1 * friction * speed / pair.stiffness_ratio
        impact = Scene(Sphere(radius, steel), HalfSpace(steel), friction, speed, slip)
        assert impact.chi == pytest.approx(chi, rel=1e-9)
        result = exact().run(impact).check()
        assert result.psi2 == pytest.approx(psi2(impact.psi1, impact.chi), abs=1e-12)
        assert result.psi2 == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("chi", [0.4, 0.8, CHI, 3.0, 12.0])
def test_energy_books(chi):
    """Friction work, added up from traction and slip, is the energy lost."""
    for psi1 in np.linspace(0.1, 4.0 * chi + 0.5, 12):
        energy = exact().run(scene(float(psi1), chi)).check().energy
        assert energy.friction_work >= 0.0
        assert abs(energy.relative_imbalance) < 1e-9


def test_friction_work_of_next_to_no_slip():
    """For small psi1 all is in proportion: the work to the square of psi1, and to what is lost."""
    psi1 = 10.0 ** -np.arange(2.0, 8.0)
    for chi in (0.8, CHI, 13.7):
        energy = exact().run(scene(psi1, chi)).check().energy
        assert (np.abs(energy.imbalance) < 1e-4 * energy.friction_work).all()
        share = energy.friction_work / psi1**2
        assert share == pytest.approx(share[-2], rel=2e-2)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-9, *longer(1e-5)])
def test_books_stay_within_what_is_declared(tolerance):
    """Where they are worst, too: psi1 next to 1; and of friction work that is next to nothing."""
    draw = np.random.default_rng(5)
    near = 1.0 + draw.choice([-1.0, 1.0], 20) * 10.0 ** draw.uniform(-14, -1, 20)
    psi1 = np.concatenate((10.0 ** draw.uniform(-12, 1.5, 20), near))
    chi = 10.0 ** draw.uniform(-1, 1.5, 40)
    law = contactlab.create("tangential.fronts")
    result = exact(tolerance=tolerance).run(Scene.nondimensional(psi1=psi1, chi=chi)).check()
    found = np.abs(result.energy.relative_imbalance)
    assert found.max() < 0.5 * (law.books_bound(result.scene) + 10.0 * tolerance)
    assert found[np.abs(psi1 - 1.0) > 1e-7].max() < 10.0 * tolerance


@pytest.mark.parametrize("chi", [0.45, CHI, *longer(3.0, 8.0)])
@pytest.mark.parametrize("psi1", [-0.7, 0.3, 1.2, 2.5])
def test_history_keeps_coulombs_law_and_agrees_with_springs(chi, psi1):
    result = exact().run(scene(psi1, chi), history=True).check()
    history = result.history
    assert (np.diff(history.time) >= 0.0).all()
    limit = history.normal_force
    assert (np.abs(history.tangential_force) <= limit + 1e-11 * limit.max()).all()
    assert history.tangential_force[-1] == pytest.approx(0.0, abs=1e-14)
    assert history.slip_velocity[-1] == pytest.approx(result.psi2, abs=1e-12)
    assert history.slip_velocity[0] == psi1
    steps = 400
    _, forces, _ = extrapolated([psi1], chi, 600, steps)
    x = np.arcsin(np.sqrt(np.clip(history.approach, 0.0, 1.0)))
    x = np.where(history.normal_velocity < 0.0, np.pi - x, x)
    ours = np.interp(np.linspace(0, np.pi, steps + 1), x, history.tangential_force / limit.max())
    assert ours == pytest.approx(forces[:, 0], abs=2e-3)


def test_the_history_changes_nothing():
    for psi1 in (0.3, 2.0, 7.0):
        assert exact().run(scene(psi1), history=True).psi2 == exact().run(scene(psi1)).psi2


def test_a_batch_gives_what_its_impacts_give():
    psi1 = np.array([[-2.0, 0.0, 0.3], [1.0, 4.0, 9.0]])
    batch = exact().run(Scene.nondimensional(psi1=psi1, chi=CHI)).check()
    single = [exact().run(scene(float(value))).psi2 for value in psi1.ravel()]
    assert batch.psi2.ravel() == pytest.approx(single, abs=1e-15)
    kept = exact().run(Scene.nondimensional(psi1=psi1, chi=CHI), history=True)
    assert kept.history.slip_velocity[-1] == pytest.approx(batch.psi2, abs=1e-12)


def test_re_sticking_while_loading_and_reversals_are_found():
    """chi = 8 re-sticks while loading; first slip ends at V = (2 chi - psi1)/(2 chi - 1)."""
    result = exact().run(scene(4.0, 8.0), history=True).check()
    force, limit = result.history.tangential_force, result.history.normal_force
    slips = np.isclose(np.abs(force), limit, rtol=1e-9)
    first = int(np.argmax(~slips[1:]))
    assert result.history.normal_velocity[first] == pytest.approx(12.0 / 15.0, abs=0.01)
    assert len(np.flatnonzero(np.diff(np.sign(result.history.slip_velocity)))) >= 3


def test_the_default_is_exact_and_says_so():
    assert Simulation() == Simulation(tangential="fronts", integrator="events")
    plan = Simulation().plan(scene(1.2))
    assert "numerical error of psi2: below 1.2e-09" in str(plan)
    assert plan.psi2_error <= 1e-9 * 1.2 * (1.0 + 2e-3)
    assert exact().plan(scene(1.2)).psi2_error <= 1e-9 * 1.2 * (1.0 + 1e-9)
    paper = Simulation(tangential="annulus", integrator="paper").plan(scene(1.2))
    assert np.isnan(paper.psi2_error)


def test_without_an_integrator_the_best_that_fits_is_taken():
    assert type(Simulation(tangential="annulus").integrator).__name__ == "Symplectic"
    assert Simulation(tangential="coulomb").integrator == exact().integrator


@pytest.mark.parametrize("psi1", [0.5, -1.2, 2.5, 7.0])
def test_fields_show_the_front(psi1):
    history = exact().run(scene(psi1), history="fields").check().history
    fields, largest = history.fields, history.contact_radius.max()
    assert (fields["front"] <= history.contact_radius + 1e-9 * largest).all()
    slipping = fields["slipping"] != 0
    assert not (slipping & fields["stuck"]).any()
    touching = fields["radius"] < history.contact_radius[:, None]
    assert ((slipping | fields["stuck"]) == touching).mean() > 0.999
    # all rings slip one way exactly where the force is at its limit
    gross = (fields["front"] == 0.0) & (history.normal_force > 0.0)
    limit = np.abs(history.tangential_force) > (1.0 - 1e-9) * history.normal_force
    assert (gross[2:-2] == limit[2:-2]).mean() > 0.99


def test_laws_that_cannot_run_under_events_are_refused():
    with pytest.raises(ValueError, match="runs laws of steps, and fronts is not one"):
        Simulation(tangential="fronts", integrator="paper")
    with pytest.raises(ValueError, match=r"runs laws of events, and annulus is not one"):
        Simulation(tangential="annulus", integrator="events")


@pytest.mark.parametrize("tolerance", [0.0, -1.0, 1.0, 1e-20])
def test_tolerances_out_of_range_are_refused(tolerance):
    with pytest.raises(ValueError, match="tolerance"):
        contactlab.create("integrator.events", tolerance=tolerance)


def test_fields_and_extremes():
    assert exact().run(scene(1e16), history="fields").check().psi_change == pytest.approx(-4 * CHI)
    assert exact().run(scene(0.0)).check().psi2 == 0.0
    sim, spoiled = exact(), scene(1.0)
    normal = sim.normal_motion(spoiled)
    object.__setattr__(spoiled, "tangential_velocity", float("nan"))
    motion = sim.integrator.integrate(spoiled, normal, sim.tangential)
    assert motion.status is Status.NON_FINITE


@pytest.mark.parametrize("psi1", [1e-300, 1e-3, *longer(1e-12, 1e-6)])
@pytest.mark.parametrize("chi", [0.35, 0.5, CHI, 30.0])
def test_rounding_of_a_small_incidence_makes_no_speed(psi1, chi):
    """At chi = 1/2 the bodies part with -psi1: all that is lost, is lost in rounding."""
    assert abs(psi2(psi1, chi)) <= psi1
    assert psi2(psi1, chi) / psi1 == pytest.approx(psi2(1e-4, chi) / 1e-4, abs=3e-3)


@pytest.mark.slow
def test_a_wide_sample_against_a_tighter_tolerance():
    """400 random impacts, chi from 0.35 to 30."""
    rng = np.random.default_rng(5)
    for chi in np.exp(rng.uniform(np.log(0.35), np.log(30.0), 400)).tolist():
        psi1 = float(rng.uniform(0.0, 1.0) ** 1.5 * max(4.0 * chi - 1.0, 1.0) * 1.03)
        difference = psi2(psi1, chi) - psi2(psi1, chi, 1e-11)
        assert abs(difference) <= 1e-9 * max(1.0, psi1), (psi1, chi)
