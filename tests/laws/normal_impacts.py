"""What tests of normal laws share: a steel ball, its restitution, psi2 by springs."""

import numpy as np

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.solve.normal_motion import normal_motion
from tests.laws.normal_laws import in_si
from tests.longer import longer

STEEL = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)
#: Restitutions over the range that laws are calibrated in.
CALIBRATED = (
    *(0.05, 0.999, 1.0),
    *longer(0.1, 0.3, 0.5, 0.7, 0.9, 0.99),
)


def scene(speed=1.0, slip=0.5):
    """Return a steel sphere of 10 mm on steel."""
    return Scene(Sphere(0.005, STEEL), HalfSpace(STEEL), 0.2, speed, slip * speed)


def restitution(law, given):
    """Return e of an impact, or of each of a batch."""
    return -normal_motion(law, given).final_rate / given.normal_speed


def psi2(law, psi1, chi, *, springs=200, steps=None):
    """Return psi2 of a batch under ``springs`` that are elastic in shear."""
    tangential = contactlab.create("tangential.springs", springs=springs, shear_loss=0.0)
    march = contactlab.create("integrator.symplectic", steps=steps or 4 * springs)
    sim = Simulation(normal=law, tangential=tangential, integrator=march)
    scene = in_si(Scene.nondimensional(psi1=np.array(psi1, dtype=float), chi=chi))
    return sim.run(scene).check().psi2
