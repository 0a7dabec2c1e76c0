"""A rod that is dropped at 0° to 75°, and Painlevé's rod, which jams.

Rigid-body theory lets the end of a dropped steel rod rebound as fast as the end came, at every
tilt. An elastic contact rebounds with less, because energy that the contact stores along the
surface returns as slip. MuJoCo's default contact is damped; set elastic, MuJoCo follows the rigid
lines to within 0.04 m/s. On the right a rod slides into the jam of Painlevé: friction presses the
bodies together faster than pressure parts them, and rigid-body forces have no answer. The
elastic contact stops the slip, then throws the rod off faster than the rod came.

Writes ``any_two_bodies.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

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
#: 4.0.0, whose contact parameters and time step, 2 ms, are the defaults; friction 0.3, no gravity.
MUJOCO = np.array([
    (0, 0.136, 0.000), (15, 0.140, -0.002), (30, 0.201, -0.247),
    (45, 0.238, -0.404), (60, 0.212, -0.280), (75, 0.167, -0.072),
])  # fmt: skip

steel = Material.named("steel")
down = np.array([0.0, 0.0, -1.0])


def dropped(degrees):
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
    for encounter in map(dropped, angles):
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

with styled():
    figure = Figure(figsize=(9.5, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    for column, what, color in ((2, "rebound", "C0"), (0, "slip", "C1")):
        for name, line in (("elastic", "-"), ("rigid", "--")):
            speed = ends[name][:, column]
            left.plot(angles, speed, line, color=color, label=f"{what}, {name}")
        left.plot(*MUJOCO[:, [0, 1 if column else 2]].T, "o", color=color, label=f"{what}, MuJoCo")
    left.set(xlabel="tilt of the rod (°)", ylabel="velocity of the end (m/s)")
    left.set_title("A steel rod dropped at 1 m/s")
    left.legend(loc="upper right", bbox_to_anchor=(1.0, 0.9), ncols=2, columnspacing=1.0)
    slip = past.slip_velocity / jam.slip_velocity
    right.plot(past.time, past.normal_velocity, color="C0", label="approach (below 0: leaves)")
    right.plot(past.time, slip, color="C1", label="slip, over that at touch")
    right.axhline(0.0, color="0.6", linewidth=0.8)
    right.set(xlabel="time (scaled)", ylabel="velocity (scaled)")
    right.set_title("Painlevé's rod: friction drives it in first")
    right.legend(loc="lower left")
    save_figure(figure, Path("any_two_bodies.png"))
