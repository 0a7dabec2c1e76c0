"""A dropped rod, one that jams, and a thousand bricks: steel at any tilt, and Painlevé's rod.

Rigid-body theory lets the end of a dropped steel rod rebound as fast as the end came, at every
tilt. An elastic contact rebounds with less, because energy that the contact stores along the
surface returns as slip. MuJoCo without damping follows the rigid lines; its default contact is
damped. On the right a rod slides into the jam of Painlevé: friction presses the bodies together
faster than pressure parts them, and rigid-body forces have no answer. The elastic contact stops
the slip, then throws the rod off faster than the rod came.

In the second picture a thousand bricks fall on a corner each, in one call: the nearer the corner
lies below the centre of mass, the higher the brick rebounds.

Writes ``any_two_bodies.png`` and ``thousand_poses.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from contactlab import (
    Encounter,
    HalfSpace,
    Material,
    Scene,
    Simulation,
    collide,
    shapes,
)
from contactlab.figures import save_figure, styled

#: Tilt in degrees, rebound and slip of the end in m/s: a capsule of this rod on a plane in MuJoCo
#: 4.0.0 without damping (solref -1e8 0, solimp 0.9999 0.9999 0.001, elliptic cone, Runge-Kutta,
#: steps of 10 µs); friction 0.3, no gravity.
MUJOCO = np.array([
    (0, 1.000, 0.000), (15, 1.000, 0.000), (30, 1.000, -0.433),
    (45, 1.000, -0.736), (60, 1.000, -0.572), (75, 1.000, -0.262),
])  # fmt: skip

steel = Material.named("steel")
down = np.array([0.0, 0.0, -1.0])


def dropped(degrees: float) -> Encounter:
    """Return a rod that falls at 1 m/s, tilted from the vertical."""
    angle = np.radians(degrees)
    axis = [np.sin(angle), 0.0, np.cos(angle)]
    body, contact = shapes.rod(length=1.0, radius=0.02, material=steel, normal=down, axis=axis)
    return Encounter(body, HalfSpace(steel), 0.3, normal=down, velocity=down, contact=contact)


# %%
# **Rebound and slip of the end**, from velocities and spins after the impact.
angles = np.arange(0, 76)
ends = {}
for name, simulation in (("elastic", None), ("rigid", Simulation(tangential="coulomb"))):
    points = []
    for tilt in angles:
        encounter = dropped(float(tilt))
        after = collide(encounter, simulation).check()
        points.append(after.velocity + np.cross(after.spin, encounter.contact))
    ends[name] = np.array(points)
    print(f"{name:8s} 30°: rebound {ends[name][30, 2]:.3f}, slip {ends[name][30, 0]:.3f} m/s")

# %%
# **Painlevé's rod**: lam < -1, in units in which the approach begins at 1.
jam = Scene.nondimensional(psi1=1.647059, chi=0.875, lam=-1.5, eta=-0.308824)
result = Simulation().run(jam, history=True).check()
past = result.history
print(f"Painlevé's rod leaves at {result.normal_restitution:.3f} times the speed of approach")

# %%
# **A thousand bricks**, each turned another way, and one call for all of them.
x, y, z, w = np.moveaxis(np.random.default_rng(1).normal(size=(1000, 4)), -1, 0)
turns = np.array([
    [w * w + x * x - y * y - z * z, 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), w * w - x * x + y * y - z * z, 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), w * w - x * x - y * y + z * z],
]) / (x * x + y * y + z * z + w * w)  # fmt: skip
bricks, corners = shapes.box(
    sides=[0.08, 0.05, 0.03],
    corner_radius=0.004,
    material=steel,
    normal=down,
    axes=np.moveaxis(turns, -1, 0),
)
fallen = Encounter(bricks, HalfSpace(steel), 0.3, normal=down, velocity=down, contact=corners)
thrown = collide(fallen).check()
aside = np.linalg.norm(corners[:, :2], axis=-1) * 1e3
slipping = np.linalg.norm(thrown.contact_velocity[:, :2], axis=-1)
up = thrown.velocity[:, 2]
print(f"of 1000 bricks {np.sum(up < 0)} go on down with their centre, fastest {-up.min():.2f} m/s")

with styled():
    figure = Figure(figsize=(9.5, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    for column, what, color in ((2, "rebound", "C0"), (0, "slip", "C1")):
        for name, line in (("elastic", "-"), ("rigid", "--")):
            left.plot(angles, ends[name][:, column], line, color=color)
        left.plot(*MUJOCO[:, [0, 1 if column else 2]].T, "o", color=color, mfc="white")
        left.text(77.5, ends["elastic"][-1, column], what, color=color, va="center")
    key = [
        Line2D([], [], color="0.3", label="elastic: contactlab"),
        Line2D([], [], color="0.3", ls="--", label="rigid bodies"),
        Line2D([], [], color="0.3", ls="", marker="o", mfc="white", label="MuJoCo, no damping"),
    ]
    left.set(xlabel="tilt of the rod (°)", ylabel="velocity of the end (m/s)", xlim=(-3.0, 90.0))
    left.axhline(0.0, color="0.6", linewidth=0.8, zorder=0)
    left.set_title("A steel rod dropped at 1 m/s")
    left.legend(handles=key, loc="center right", bbox_to_anchor=(0.9, 0.7))
    slip = past.slip_velocity / jam.slip_velocity
    right.plot(past.time, past.normal_velocity, color="C0", label="approach, below 0 it leaves")
    right.plot(past.time, slip, color="C1", label="slip, below 0 it is reversed")
    right.axhline(0.0, color="0.6", linewidth=0.8)
    right.set(xlabel="time (scaled)", ylabel="velocity over that at first touch")
    right.set_title("Painlevé's rod: friction first drives it in")
    right.legend(loc="lower left")
    save_figure(figure, Path("any_two_bodies.png"))
    figure = Figure(figsize=(6.4, 3.8), layout="constrained")
    third = figure.subplots()
    dots = third.scatter(aside, up, c=slipping, s=8, cmap="viridis")
    figure.colorbar(dots, ax=third, label="slip of the corner after it (m/s)")
    third.axhline(0.0, color="0.6", linewidth=0.8, zorder=0)
    third.set(xlabel="corner aside of the centre of mass (mm)")
    third.set_ylabel("velocity of the centre, upwards (m/s)")
    third.set_title("A thousand bricks dropped at 1 m/s")
    save_figure(figure, Path("thousand_poses.png"))
