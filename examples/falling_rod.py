"""A rod dropped on its end at 0° to 75°: the contact point after the impact, elastic and rigid.

A uniform steel rod (1 kg, 1 m, end radius 10 mm) falls without spin at 1 m/s on a steel floor with
friction 0.3. Pressure drags the end sideways, friction changes the approach: no sphere knows that.
Rigid-body theory, which engines of games and robots take, lets a steep rod stand on its end without
slip. Between elastic bodies the end comes back, and slides up to 0.4 m/s faster.

Writes ``falling_rod.png`` in the current folder.
"""

import math
from pathlib import Path

import numpy as np

from contactlab import Encounter, HalfSpace, Material, RigidBody, Simulation, collide
from contactlab.figures import law_style, name_curves, save

STEEL = Material.named("steel")


def dropped(degrees):
    """Return the rod at an angle from the vertical, its end on the floor."""
    angle = math.radians(degrees)
    axis = np.array([math.sin(angle), 0.0, math.cos(angle)])
    rod = RigidBody(
        mass=1.0,
        inertia=(np.eye(3) - np.outer(axis, axis)) / 12.0 + 1e-4 * np.outer(axis, axis),
        material=STEEL,
        curvature_radius=0.01,
    )
    return Encounter(
        rod, HalfSpace(STEEL), 0.3, normal=(0, 0, -1), velocity=(0, 0, -1), contact=-axis / 2
    )


angles = np.linspace(0.5, 75.0, 150)
after = {"elastic": [], "rigid": []}
for angle in angles:
    met = dropped(angle)
    for name, laws in (("elastic", None), ("rigid", Simulation(tangential="coulomb"))):
        result = collide(met, laws).check().result
        after[name].append((-result.normal_velocity, result.slip_velocity[0]))
curves = {name: np.array(values).T for name, values in after.items()}

print("angle   rebound: elastic, rigid   slip after: elastic, rigid (over the speed of approach)")
for angle in (0.5, 15.0, 30.0, 45.0, 60.0, 75.0):
    row = [np.interp(angle, angles, curve[k]) for k in (0, 1) for curve in curves.values()]
    print(f"{angle:4.1f}°   " + "  ".join(f"{value:7.3f}" for value in row))


def draw(axes):
    """Draw the slip of the end after the impact."""
    lines = []
    for number, (_, slip) in enumerate(curves.values()):
        lines += axes.plot(angles, slip, **law_style(number))
    axes.axhline(0.0, color="grey", lw=0.8, zorder=0)
    axes.set(xlabel="angle of the rod from the vertical, degrees", xlim=(0.0, 75.0))
    axes.set_ylabel("slip of the end after, over the speed of approach")
    name_curves(axes, lines, list(curves))


save(Path("falling_rod.png"), draw)
