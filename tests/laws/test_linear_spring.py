"""The linear spring and slider: free oscillations, damped ones, books, and the cap."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.contracts import Increment
from tests.laws.exact_laws import order
from tests.laws.normal_laws import LinearSpring, in_si

#: Above it no slip ends the oscillation: the cap is 1e6 of what the spring needs.
STUCK = 1e-6


def answer(psi1, chi, steps, **options):
    """psi2 over an elastic linear contact, which lasts pi by its own clock."""
    law = contactlab.create("tangential.linear_spring", **options)
    march = contactlab.create("integrator.symplectic", steps=steps)
    scene = in_si(Scene.nondimensional(psi1=psi1, chi=chi))
    sim = Simulation(normal=LinearSpring(), tangential=law, integrator=march)
    return sim.run(scene).check()


@pytest.mark.parametrize("damping", [0.0, 0.1, 0.4])
def test_a_contact_that_sticks_is_a_damped_oscillator(damping):
    """k_t/k_n = r: omega² = r M_n/M_t by Omega² = k_n/M_n, decay c/(2 M_t); second order."""
    chi, ratio = 0.11, 0.6
    inertia = 2.0 * chi  # M_n/M_t with kappa = 1
    omega, decay = np.sqrt(ratio * inertia), damping * np.sqrt(ratio) * inertia
    turn = np.sqrt(omega**2 - decay**2)
    exact = np.exp(-decay * np.pi) * (np.cos(turn * np.pi) - decay / turn * np.sin(turn * np.pi))
    found = []
    for steps in (50, 100, 200, 400):
        history = free(STUCK, chi, steps, stiffness_ratio=ratio, damping=damping)
        found.append(abs(history - exact))
    assert order((50, 100, 200, 400), found) == pytest.approx(2.0, abs=0.3)


def free(psi1, chi, steps, **options):
    """psi2/psi1 with the cap taken away: the law is asked with a friction load without end."""
    law = contactlab.create("tangential.linear_spring", **options)
    scene = in_si(Scene.nondimensional(psi1=psi1, chi=chi))
    normal = Simulation(normal=LinearSpring()).normal_motion(scene)
    state, velocity, mass = law.start(scene, normal), psi1, scene.pair.tangential_mass
    step = float(normal.duration) / steps
    contact = normal.at(np.pi / 2).contact._replace(friction_load=1e9)
    for number in range(steps):
        drift = 0.5 * step if number == 0 else step
        given = Increment(velocity * drift, velocity, 1e9, step)
        response, state = law.advance(state, given, contact, contact)
        velocity -= response.force * step / mass
    return velocity / psi1


@pytest.mark.parametrize("damping", [0.0, 0.3])
def test_the_books_close_as_the_square_of_the_steps(damping):
    psi1 = np.linspace(0.1, 6.0, 25)
    steps = (100, 200, 400, 800)
    off = [
        np.max(np.abs(answer(psi1, 49 / 34, count, damping=damping).energy.relative_imbalance))
        for count in steps
    ]
    assert off[-1] < 2e-3
    if damping:
        assert order(steps, off) > 0.8
    else:
        assert order(steps, off) == pytest.approx(2.0, abs=0.5)


def test_the_default_is_the_ratio_of_the_bodies():
    steel = contactlab.Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
    ball = contactlab.Sphere(0.01, steel)
    scene = Scene(ball, contactlab.HalfSpace(steel), 0.2, 1.0, 0.1)
    kappa = float(scene.pair.stiffness_ratio)
    given = contactlab.create("tangential.linear_spring", stiffness_ratio=kappa)
    left = Simulation(tangential="linear_spring").run(scene).check()
    assert left.psi2 == Simulation(tangential=given).run(scene).check().psi2


def test_force_is_within_the_cap_with_a_dashpot_too():
    law = contactlab.create("tangential.linear_spring", damping=0.5)
    scene = Scene.nondimensional(psi1=np.linspace(0.1, 6.0, 30), chi=49 / 34)
    history = Simulation(tangential=law).run(scene, history=True).check().history
    assert (np.abs(history.tangential_force) <= history.normal_force * (1.0 + 1e-12)).all()


@pytest.mark.parametrize(("option", "value"), [("stiffness_ratio", 0.0), ("damping", -0.1)])
def test_bad_options_are_refused(option, value):
    with pytest.raises(ValueError, match=option):
        contactlab.create("tangential.linear_spring", **{option: value})
