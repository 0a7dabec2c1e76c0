"""Stronge's lumped contact against a direct integration, and against marched springs."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import contactlab
from contactlab import Scene, Simulation
from contactlab_laws.stronge import stages
from contactlab_laws.stronge.stages import rebound
from tests.laws.exact_laws import order
from tests.laws.normal_laws import LinearSpring, in_si

CASES = [
    (psi1, chi, e)
    for chi in (0.3, 0.9, 49 / 34, 3.0, 8.0)
    for psi1 in (0.2, 0.95, 1.3, 2.5, 4.0)
    for e in (0.5, 0.9, 1.0)
]


def integrated(psi1, omega, e):
    """psi2 - psi1 by a Runge-Kutta method of eighth order, the cap met by its events."""
    end = 0.5 * np.pi * (1.0 + e)

    def load(t):
        return np.sin(t) if t < 0.5 * np.pi else np.cos((t - 0.5 * np.pi) / e)

    def slope(t):
        return np.cos(t) if t < 0.5 * np.pi else -np.sin((t - 0.5 * np.pi) / e) / e

    t, psi, u, sense = 0.0, psi1, 0.0, int(psi1 >= 1.0)
    while t < end - 1e-12:
        stop = 0.5 * np.pi if t < 0.5 * np.pi - 1e-12 else end
        t_before = t

        def rate(t, y, sense=sense):
            force = sense * load(t) if sense else y[1]
            return [-(omega**2) * force, sense * slope(t) if sense else y[0]]

        def up(t, y, start=t_before):
            return load(t) - y[1] + (1.0 if t < start + 1e-6 else 0.0)

        def down(t, y, start=t_before):
            return load(t) + y[1] + (1.0 if t < start + 1e-6 else 0.0)

        def grips(t, y, sense=sense, start=t_before):
            return sense * y[0] - slope(t) + (1.0 if t < start + 1e-9 else 0.0)

        events = [grips] if sense else [up, down]
        for event in events:
            event.terminal, event.direction = True, -1.0
        found = solve_ivp(rate, (t, stop), [psi, u], method="DOP853", rtol=1e-11, atol=1e-13,
                          events=events, max_step=0.02)  # fmt: skip
        t, (psi, u) = found.t[-1], found.y[:, -1]
        if found.status == 1:
            sense = 0 if sense else (1 if len(found.t_events[0]) else -1)
    return psi - psi1


@pytest.mark.parametrize(("psi1", "chi", "e"), CASES[::3] + CASES[1::6])
def test_closed_form_against_direct_integration(psi1, chi, e):
    omega = np.sqrt(2.0 * chi)
    assert rebound(psi1, omega, e).change == pytest.approx(integrated(psi1, omega, e), abs=2e-8)


def test_over_a_linear_spring_it_is_the_linear_spring_marched():
    """The lumped model is the spring and slider over an elastic linear contact; order 2."""
    scene = in_si(Scene.nondimensional(psi1=np.linspace(0.05, 6.0, 40), chi=49 / 34))
    exact = Simulation(normal=LinearSpring(), tangential="stronge").run(scene).check().psi2
    found, steps = [], (100, 200, 400, 800)
    for count in steps:
        march = contactlab.create("integrator.symplectic", steps=count)
        law = contactlab.create("tangential.linear_spring")
        sim = Simulation(normal=LinearSpring(), tangential=law, integrator=march)
        found.append(np.sqrt(np.mean((sim.run(scene).check().psi2 - exact) ** 2)))
    assert found[-1] < 2e-5
    assert order(steps, found) == pytest.approx(2.0, abs=0.3)


def test_gross_slip_throughout():
    """psi2 = psi1 - 2 chi (1 + e), with omega² = 2 chi."""
    assert rebound(50.0, 2.0, 0.6).change == pytest.approx(-4.0 * 1.6, rel=1e-14)


def test_plastic_impact_keeps_what_compression_gave():
    """e = 0: restitution takes no time; the spring lets go of what it holds."""
    ended = rebound(0.4, 1.7, 0.0)
    turn = 0.5 * np.pi * 1.7
    assert ended.change == pytest.approx(0.4 * (np.cos(turn) - 1.0), abs=1e-12)
    assert ended.work == pytest.approx(0.5 * 0.4**2 * np.sin(turn) ** 2, abs=1e-12)


def test_energy_lost_is_the_friction_work():
    for psi1, chi, e in CASES:
        ended = rebound(psi1, np.sqrt(2.0 * chi), e)
        lost = -ended.change * (psi1 + 0.5 * ended.change)
        assert ended.work == pytest.approx(lost, abs=1e-12 * psi1**2)


def test_stiffness_ratio_is_what_scales_psi():
    """Twice k_t/k_n is twice psi1 and chi, and half of the answer in psi."""
    law = contactlab.create("tangential.stronge", stiffness_ratio=2.0)
    once = Simulation(tangential=law).run(Scene.nondimensional(psi1=0.7, chi=0.6)).check().psi2
    twice = Simulation(tangential="stronge").run(Scene.nondimensional(psi1=1.4, chi=1.2)).check()
    assert once == pytest.approx(0.5 * twice.psi2, abs=1e-13)


def test_bodies_of_very_unlike_inertia_are_refused_with_a_sentence():
    result = Simulation(tangential="stronge").run(Scene.nondimensional(psi1=1.0, chi=1e9))
    assert not result.status
    assert "natural frequencies" in result.motion.detail


def stages_of(psi1, chi):
    """Return the senses of slip, 0 for stick, in their order; e = 1."""
    contact = stages.Contact(psi1, 0.0, 0.0, 0.0, int(psi1 >= 1.0))
    found = []
    for half in (stages.Half(1.0, True), stages.Half(1.0, False)):
        x = 0.0
        while x < 0.5 * np.pi:
            if not found or found[-1] != contact.sense:
                found.append(contact.sense)
            contact, x = stages.advance_stage(stages.ONE, contact, half, np.sqrt(2.0 * chi), x)
    return found


@pytest.mark.parametrize(
    ("chis", "most"), [(np.linspace(7 / 6, 7 / 4, 8), 3), ([3.0], 5), ([1000.0], 45)]
)
def test_the_stages_are_as_many_as_the_theory_page_says(chis, most):
    found = [
        stages_of(psi1, chi)
        for chi in chis
        for psi1 in np.geomspace(1e-2, 4.0 * chi, 60 if most < 45 else 150).tolist()
    ]
    assert max(len(each) for each in found) == most
    longest = max(found, key=len)
    assert all((0 in pair) and pair != (0, 0) for pair in itertools.pairwise(longest))


@pytest.mark.parametrize(("normal", "speed"), [("jkr", 0.08), ("dmt", 0.05), ("jkr", 1.0)])
def test_restitution_under_adhesion_is_that_of_the_motion(normal, speed):
    """e of the friction load's impulse, 1.285 for .997, gave psi2 .715 for .107."""
    steel = contactlab.Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)
    slips = speed * np.array([0.1, 0.5, 1.0, 2.0])
    body = contactlab.Sphere(1e-5, steel)
    scene = Scene(body, contactlab.HalfSpace(steel), 0.3, speed, slips)
    simulation = Simulation(normal=normal, tangential="stronge")
    result = simulation.run(scene).check()
    e = result.normal_restitution[0]
    assert e <= 1.0 + 1e-8
    expected = [rebound(psi1, np.sqrt(2.0 * scene.chi), e).change for psi1 in scene.psi1]
    assert result.psi_change == pytest.approx(expected, abs=1e-9)
    load = simulation.normal_motion(scene).total_load_impulse
    ratio = np.max(load) / (scene.pair.normal_mass * speed * (1.0 + e))
    assert ratio > 1.004
    assert any(
        f"up to {ratio:.3g} times that of the spring" in str(text) for text in result.plan.cautions
    )


def test_no_caution_of_a_pull_where_the_normal_law_has_none():
    for normal in ("hertz", "tsuji", "thornton"):
        scene = in_si(Scene.nondimensional(psi1=0.7, chi=1.2))
        plan = Simulation(normal=normal, tangential="stronge").plan(scene)
        assert not any("does not pull" in str(text) for text in plan.cautions)
