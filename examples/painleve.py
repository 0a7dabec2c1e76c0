"""Painlevé's rod: where rigid bodies have no answer, elastic bodies have one.

A rod slides over a rough floor (friction 2) with its end ahead. Friction then turns the end into
the floor faster than pressure pushes it out: for rigid bodies no finite force answers the laws of
motion. Between elastic bodies the contact jams for a moment. The approach grows, slip stops, and
the end jumps off faster than it came, with energy from the slip.

Writes ``painleve.png`` in the current folder.
"""

import math
from pathlib import Path

import numpy as np

from contactlab import Encounter, HalfSpace, Material, RigidBody, Simulation
from contactlab.figures import law_style, name_curves, save

STEEL = Material.named("steel")
ANGLE = math.atan(0.5)
axis = np.array([-math.sin(ANGLE), 0.0, math.cos(ANGLE)])
rod = RigidBody(
    mass=1.0,
    inertia=(np.eye(3) - np.outer(axis, axis)) / 12.0 + 1e-4 * np.outer(axis, axis),
    material=STEEL,
    curvature_radius=0.01,
)
met = Encounter(
    rod, HalfSpace(STEEL), 2.0, normal=(0, 0, -1), velocity=(4, 0, -1), contact=-axis / 2
)
result = Simulation().run(met.scene, history=True).check()
history, energy = result.history, result.energy
slip = history.slip_velocity[:, 0] * np.sign(history.slip_velocity[0, 0])
print(f"lam = {-abs(result.scene.lam):.2f}: below -1 friction presses the bodies together")
print(f"approach 1 m/s, slip {slip[0]:.2f} m/s before")
print(f"leaves at {-result.normal_velocity:.3f} m/s, slip {slip[-1]:.3f} m/s after")
print(f"energy {energy.start:.3f} J before, {energy.end:.3f} J after; friction took the rest")


def draw(axes):
    """Draw approach and slip over time, through the jam."""
    time = 1e6 * history.time
    curves = {"approach of the end": history.normal_velocity, "slip": slip}
    lines = []
    for number, values in enumerate(curves.values()):
        lines += axes.plot(time, values, **law_style(number))
    peak = int(history.normal_velocity.argmax())
    axes.axvspan(0.0, time[peak], color="0.92", zorder=0, lw=0)
    axes.text(0.5 * time[peak], 2.2, "jam", ha="center")
    axes.axhline(0.0, color="grey", lw=0.8, zorder=0)
    axes.set(xlabel="time, µs", xlim=(0.0, time[-1]), ylabel="velocity of the contact point, m/s")
    name_curves(axes, lines, list(curves))


save(Path("painleve.png"), draw)
