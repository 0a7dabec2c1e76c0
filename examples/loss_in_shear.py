"""A lossy ball at an angle: three answers for one normal restitution.

A ball of rubber, wood or polymer rebounds with less than its normal speed because its material is
viscous. A viscous material damps shear as it damps pressure. A law with the loss in pressure alone
lets the contact point come back faster than a ball without any loss; with one loss for both the
contact point comes back more slowly, as measured balls do (``contactlab guide theory-loss``).

Writes ``loss_in_shear.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

import contactlab
from contactlab import Scene, Simulation
from contactlab.figures import law_style, name_curves, save

RESTITUTION, CHI = 0.5, 49 / 34  # chi of a solid sphere, nu = 0.3
tsuji = contactlab.create("normal.tsuji", restitution=RESTITUTION)
viscoelastic = contactlab.create("normal.viscoelastic", restitution=RESTITUTION)
elastic_shear = contactlab.create("tangential.springs", shear_loss=0.0)
LAWS = {
    "no loss": Simulation(),
    "loss in pressure alone": Simulation(normal=tsuji, tangential=elastic_shear),
    "one loss for both": Simulation(normal=viscoelastic),
}
psi1 = np.linspace(0.2, 5.0, 241)
scene = Scene.nondimensional(psi1=psi1, chi=CHI)
curves = {name: -law.sweep(scene).check().psi2 / psi1 for name, law in LAWS.items()}
for name, values in curves.items():
    print(f"{name:23s} at psi1 = 1: {values[40]:5.2f}, at most {values.max():.2f}")


def draw(axes: Axes) -> None:
    """Draw the slip restitution over psi1."""
    lines = []
    for number, values in enumerate(curves.values()):
        lines += axes.plot(psi1, values, **law_style(number))
    axes.axhline(0.0, color="grey", lw=0.8, zorder=0)
    axes.set(xlabel=r"angle of incidence $\psi_1$ (scaled)", xlim=(0.0, 5.0))
    axes.set_ylabel(r"slip restitution $\beta_0 = -\psi_2/\psi_1$")
    axes.set_title(f"Normal restitution {RESTITUTION} for the two that lose")
    name_curves(axes, lines, list(curves))


save(Path("loss_in_shear.png"), draw)
