"""Orders of convergence, regressed over several resolutions against the exact solution."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from tests.laws.exact_laws import CHI, grid, order, rebound, rms
from tests.laws.normal_laws import Damped, in_si
from tests.laws.reference import TABLE

STEPS = (50, 100, 200, 400)
PARTS = (6, 12, 24, 48)


def errors(law, integrator, resolutions):
    """Rms errors of psi2 over the grid; a resolution is (steps, options of the law)."""
    psi1, chi, psi2 = grid()
    return [
        rms(rebound(psi1, chi, law, integrator, steps=steps, **options) - psi2)
        for steps, options in resolutions
    ]


def test_the_exact_values_are_exact():
    """What the orders are measured against, at theory's table: two methods that agree."""
    chi, psi1, psi2 = np.array(TABLE).T
    found = Simulation().run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2
    assert found == pytest.approx(psi2, abs=2e-10)


@pytest.mark.parametrize("integrator", ["symplectic", "paper"])
def test_order_in_steps_is_what_the_integrator_declares(integrator):
    declared = 2  # what a count of steps promises
    found = order(STEPS, errors("springs", integrator, [(n, {"springs": 300}) for n in STEPS]))
    assert found == pytest.approx(declared, abs=0.3)


def test_second_order_in_springs():
    """At 1600 steps, so that the steps' error is out of the way."""
    found = order(PARTS, errors("springs", "symplectic", [(1600, {"springs": n}) for n in PARTS]))
    assert found == pytest.approx(2.0, abs=0.3)


def test_second_order_in_both_together():
    found = order(STEPS, errors("springs", "symplectic", [(n, {"springs": n // 4}) for n in STEPS]))
    assert found == pytest.approx(2.0, abs=0.3)


@pytest.mark.slow
@pytest.mark.parametrize("integrator", ["symplectic", "paper"])
def test_the_papers_annuli_are_of_order_four_thirds(integrator):
    """Whatever the steps: conditions in the middles of annuli see the edge of stick in whole
    annuli only, and the limit of friction at the edge of contact likewise."""
    found = order(PARTS, errors("annulus", integrator, [(300, {"annuli": n}) for n in PARTS]))
    assert found == pytest.approx(4.0 / 3.0, abs=0.3)


def test_late_springs_would_cost_an_order():
    """Second order rests on springs moving from their own contact time: a bundle whose springs
    move for the whole step they are met in is of first order, and this test can tell."""
    psi1, chi, psi2 = grid()
    scale = 2.94327518431757
    found = []
    for steps in STEPS:
        s = (np.arange(300) + 0.5) / 300
        drift = scale / steps
        zeta, v, psi, w = 0.0, 1.0, psi1.copy(), np.zeros((300, len(psi1)))
        while zeta >= 0.0:
            zeta += v * drift
            limit = np.maximum(zeta - s * s, 0.0)[:, None]
            w = np.clip(w + psi * drift, -limit, limit)
            v -= 1.25 * max(zeta, 0.0) ** 1.5 * drift
            psi = psi - 2.5 * chi * 1.5 * w.mean(axis=0) * drift
        found.append(rms(psi - psi2))
    assert order(STEPS, found) < 1.5


@pytest.mark.parametrize("law", ["coulomb"])
def test_a_rigid_law_is_exact_at_any_step(law):
    """No order at all: the step in which slip stops takes the force that stops it."""
    psi1 = np.array([0.5, 2.0, 4.0 * CHI - 0.1, 7.0])
    for steps in (3, 30):
        found = rebound(psi1, CHI, law, steps=steps)
        assert found == pytest.approx(np.maximum(psi1 - 4.0 * CHI, 0.0), abs=1e-12)


@pytest.mark.parametrize("integrator", ["symplectic", "paper"])
def test_a_normal_force_that_depends_on_the_rate_leaves_the_order(integrator):
    """Psi2 of a damped impact, against many more steps; its restitution needs none."""
    scene = in_si(Scene.nondimensional(psi1=1.2, chi=CHI))
    springs = contactlab.create("tangential.springs", springs=100)

    def answer(steps):
        march = contactlab.create(f"integrator.{integrator}", steps=steps)
        result = Simulation(normal=Damped(), tangential=springs, integrator=march).run(scene)
        return result.check().psi2, result.normal_restitution

    steps, (fine, restitution) = [100, 200, 400], answer(3200)
    answers = [answer(count) for count in steps]
    assert order(steps, [abs(psi2 - fine) for psi2, _ in answers]) == pytest.approx(2.0, abs=0.3)
    assert [e for _, e in answers] == [restitution] * 3
