"""Swap one law for another: the same impact under three laws of friction.

Writes ``law_swap.png`` in the current folder: what the three say of all angles.
"""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from contactlab import Scene, Simulation
from contactlab.figures import law_style, name_curves, save

scene = Scene.nondimensional(psi1=1.2, chi=1.4412)
all_angles = Scene.nondimensional(psi1=np.linspace(0.0, 7.0, 141), chi=1.4412)
curves = {}
print("law            psi2     friction work  energy out of balance")
for law in ("annulus", "coulomb", "frictionless"):
    simulation = Simulation(tangential=law, integrator="symplectic")
    result = simulation.run(scene).check()
    energy = result.energy
    print(f"{law:12s} {result.psi2:8.5f}  {energy.friction_work:12.5f}  {energy.imbalance:12.1e}")
    curves[law] = simulation.sweep(all_angles).check().psi2


def draw(axes: Axes) -> None:
    """Draw the rebound under each law."""
    lines = []
    for number, psi2 in enumerate(curves.values()):
        lines += axes.plot(all_angles.psi1, psi2, **law_style(number))
    axes.set(
        xlabel=r"local angle of incidence $\psi_1$",
        ylabel=r"local angle of reflexion $\psi_2$",
        xlim=(0.0, 7.0),
    )
    name_curves(axes, lines, list(curves))


save(Path("law_swap.png"), draw)
