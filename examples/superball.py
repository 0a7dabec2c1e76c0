"""A superball reverses its contact point, an elastic ball cannot: Garwin's ball beside theory.

A superball that is thrown under a table comes back. Garwin (1969) explained it by a contact
point that leaves as fast as it came, the other way: psi2 = -psi1. An elastic ball with partial
slip does that at no angle. For rubber the contact point comes back with at most 0.59 of its
velocity, and slides on where the ball is thrown flat.

Writes ``superball.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

import contactlab
from contactlab import HalfSpace, Material, Scene, Sphere
from contactlab.figures import law_style, name_curves, save

RUBBER = Material.named("rubber")
CHI = Scene(Sphere(0.02, RUBBER), HalfSpace(RUBBER), 0.5, 1.0).chi
psi1 = np.linspace(0.01, 6.0, 600)
ratio = contactlab.rebound(psi1, CHI) / psi1
best = int(ratio.argmin())
print(f"rubber: chi = {CHI:.3f}")
print(f"the contact point comes back with at most {-ratio[best]:.2f} of its velocity,")
print(f"at psi1 = {psi1[best]:.2f}; Garwin's ball has 1 at every angle")


def draw(axes: Axes) -> None:
    """Draw the slip velocity after over before."""
    curves = {
        "elastic rubber": ratio,
        "rigid": np.maximum(1.0 - 4.0 * CHI / psi1, 0.0),
        "Garwin's superball": -np.ones(len(psi1)),
    }
    lines = []
    for number, values in enumerate(curves.values()):
        lines += axes.plot(psi1, values, **law_style(number))
    axes.axhline(0.0, color="grey", lw=0.8, zorder=0)
    axes.plot(psi1[best], ratio[best], "o", color=lines[0].get_color())
    axes.set(xlabel=r"local angle of incidence $\psi_1$", xlim=(0.0, 6.0), ylim=(-1.1, 0.5))
    axes.set_ylabel(r"velocity of the contact point, after over before")
    name_curves(axes, lines, list(curves))


save(Path("superball.png"), draw)
