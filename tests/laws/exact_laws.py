"""Short names for what these tests compose, and exact answers to hold it against."""

from functools import cache

import numpy as np

import contactlab
from contactlab import Scene, Simulation

CHI = 49.0 / 34.0


def simulation(law, integrator="symplectic", *, steps, **options):
    return Simulation(
        tangential=contactlab.create(f"tangential.{law}", **options),
        integrator=contactlab.create(f"integrator.{integrator}", steps=steps),
    )


def rebound(psi1, chi, *args, **options):
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    return simulation(*args, **options).run(scene).check().psi2


def marched_change(sim, psi1, chi):
    """psi2 - psi1 of the integrator itself, where the plan would take eq. (45)."""
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    normal = sim.normal_motion(scene)
    motion = sim.integrator.integrate(scene, normal, sim.tangential)
    return scene.psi(motion.slip_velocity_change)


@cache
def grid():
    """psi1 in (0, 4 chi] over chi in [0.35, 4], and the exact psi2."""
    chi = np.repeat([0.35, 0.6, 1.0, CHI, 2.2, 3.0, 4.0], 12)
    psi1 = np.tile((np.arange(12) + 0.5) / 12.0, 7) * 4.0 * chi
    return psi1, chi, Simulation().run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2


def rms(error):
    return float(np.sqrt(np.mean(np.square(error))))


def order(resolutions, errors):
    """The slope of log error over log resolution, by least squares."""
    return -np.polyfit(np.log(resolutions), np.log(errors), 1)[0]
