"""A thousand angles at once: a sweep, and where the ball comes back fastest.

Writes ``sweep.png`` in the current folder.
"""

from pathlib import Path

import numpy as np

import contactlab
from contactlab.figures import save

simulation = contactlab.Simulation(
    tangential=contactlab.create("tangential.annulus", annuli=20),
    integrator=contactlab.create("integrator.symplectic", steps=100),
)
psi1 = np.linspace(0.0, 6.0, 1000)
result = simulation.sweep(contactlab.Scene.nondimensional(psi1=psi1, chi=1.4412)).check()
steepest = np.argmin(result.psi2)
print(f"{len(result)} impacts in {result.run_time:.2f} s")
print(f"least psi2 = {result.psi2[steepest]:.3f} at psi1 = {psi1[steepest]:.2f}")
print(
    f"largest energy imbalance: {np.max(np.abs(result.energy.relative_imbalance)):.1e} of the start"
)
save(Path("sweep.png"), lambda axes: result.plot("psi1", "psi2", axes=axes))
