"""A wooden egg that bounces ten times.

The egg is dropped on granite, tilted by 35°, without spin. Its contact is off the line of
centres, so each bounce turns part of the fall into spin, or spin into height, and the next
bounce meets another side of the egg. Between two bounces the egg flies freely, and the next touch
is found to rounding. The contact is elastic: energy is lost to friction alone.

Writes ``egg.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from numpy.typing import NDArray
from scipy.optimize import brentq

from contactlab import Encounter, HalfSpace, Material, RigidBody, Simulation, collide, shapes
from contactlab.figures import save_figure, styled

Array = NDArray[np.float64]
GRAVITY = 9.81
LONG, SHORT = 0.03, 0.022
BOUNCES = 10
down = np.array([0.0, 0.0, -1.0])
wood = Material(young_modulus=10e9, poisson_ratio=0.3, density=700.0)
floor = HalfSpace(Material.named("granite"))


def touching(tilt: float) -> tuple[RigidBody, Array]:
    """Return body and contact vector of the egg, its long axis tilted from the vertical."""
    axis = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    axes = np.stack((axis, [0.0, 1.0, 0.0], np.cross(axis, [0.0, 1.0, 0.0])), axis=1)
    return shapes.ellipsoid(semi_axes=[LONG, SHORT, SHORT], material=wood, normal=down, axes=axes)


def support(tilt: float) -> float:
    """Return the height of the centre over the lowest point."""
    return float(np.hypot(LONG * np.cos(tilt), SHORT * np.sin(tilt)))


def flown(height: float, velocity: Array, tilt: float, turning: float) -> float:
    """Return the time of the next touch."""

    def gap(time: float) -> float:
        rise = height + (velocity[2] - 0.5 * GRAVITY * time) * time
        return float(rise - support(tilt + turning * time))

    times = np.arange(1, 20_000) * 1e-4
    later = times[np.argmax([gap(time) < 0.0 for time in times])]
    return float(brentq(gap, later - 1e-4, later, xtol=1e-14))


def bounced(simulation: Simulation | None = None) -> tuple[Array, list[tuple[float, float]]]:
    """Return rows of time, centre, tilt and energies of height, flight and spin; and speeds."""
    place, tilt = np.array([0.0, 0.0, 0.12]), np.radians(35.0)
    velocity, turning = np.zeros(3), 0.0
    rows, speeds, now = [], [], 0.0
    for _ in range(BOUNCES):
        time = flown(place[2], velocity, tilt, turning)
        place = place + velocity * time + 0.5 * GRAVITY * time**2 * down
        velocity, tilt, now = velocity + GRAVITY * time * down, tilt + turning * time, now + time
        body, contact = touching(tilt)
        encounter = Encounter(
            body, floor, 0.3, normal=down, velocity=velocity,
            spin=[0.0, turning, 0.0], contact=contact,
        )  # fmt: skip
        after = collide(encounter, simulation).check()
        velocity, turning = after.velocity, after.spin[1]
        speeds.append((velocity[0], velocity[2]))
        flight = 0.5 * body.mass * velocity @ velocity
        spin = 0.5 * body.inertia[1, 1] * turning**2
        height = body.mass * GRAVITY * (place[2] - SHORT)
        rows.append((now, *place, tilt, height, flight, spin))
    return np.array(rows), speeds[:-1]


elastic, flights = bounced()
rigid, _ = bounced(Simulation(tangential="coulomb"))
first = 0.12 - SHORT  # m above the lowest place of the centre
mass = touching(0.0)[0].mass
for name, rows in (("elastic", elastic), ("rigid", rigid)):
    left = rows[:, 5:].sum(axis=1) / (mass * GRAVITY * first)
    print(f"{name:8s} energy left after 1, 5, 10 bounces:", left[[0, 4, 9]].round(3))

with styled():
    figure = Figure(figsize=(9.5, 5.2), layout="constrained")
    top, bottom = figure.subplots(2, 1, height_ratios=(2, 3))
    for number, (_, x, _, z, tilt, *_) in enumerate(elastic, 1):
        turned = 90.0 - np.degrees(tilt)
        top.add_patch(Ellipse((x, z), 2 * LONG, 2 * SHORT, angle=turned, fill=False, color="C0"))
        top.text(x, z, str(number), ha="center", va="center", fontsize="small")
    for start, stop, (speed, rise) in zip(elastic[:-1], elastic[1:], flights, strict=True):
        time = np.linspace(0.0, stop[0] - start[0], 40)
        height = start[3] + (rise - 0.5 * GRAVITY * time) * time
        top.plot(start[1] + speed * time, height, color="0.6", linewidth=0.8)
    top.axhline(0.0, color="0.4")
    top.set(xlabel="place (m)", ylabel="height (m)", aspect="equal", ylim=(-0.005, 0.14))
    top.set_title("The egg at its ten touches, and the path of its centre")
    count, lost = np.arange(1, BOUNCES + 1), []
    for name, rows, line in (("elastic", elastic, "-"), ("rigid", rigid, "--")):
        energy = rows[:, 5:] / (mass * GRAVITY * first)
        lost.append(1.0 - energy[-1].sum())
        bottom.plot(count, energy.sum(axis=1), "k" + line, label=f"all, {name}")
        bottom.plot(count, energy[:, 2], "C1" + line, label=f"spin, {name}")
    bottom.set(xlabel="after bounce", ylabel="energy over that of the drop", ylim=(0.0, 1.05))
    bottom.set_xticks(count)
    bottom.set_title("Friction takes {:.0%} of the energy; of a rigid egg's {:.1%}".format(*lost))
    bottom.legend(loc="center right")
    save_figure(figure, Path("egg.png"))
