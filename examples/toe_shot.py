"""A golf ball hit by the toe and the heel of a driver.

A shot off the centre turns the club's head, and friction at its face turns the ball the other
way: the gear effect. The face bulges, so that the ball starts on the side of the shot, and the
spin is to bend its flight back. Rigid bodies tip the spin axis by 5° for a shot 25 mm off. The
surfaces of a viscoelastic ball spring back along the face: the ball has a third more backspin, and
its axis tips by 2° at most. Normal restitution is 0.8, that of a frictionless impact.

Writes ``toe_shot.png`` in the current folder.
"""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from contactlab import (
    Collision,
    Encounter,
    Material,
    RigidBody,
    Simulation,
    Sphere,
    collide,
    create,
)
from contactlab.figures import save_figure, styled

SPEED = 45.0  # m/s, of the head, along x; z is up, and the toe lies at negative y
LOFT = np.radians(10.5)
BULGE = 0.30  # m, radius of the face
RADIUS = 0.02134  # m, of the ball
DEPTH = 0.035  # m, from the centre of mass to the face

rubber = Material(young_modulus=1.5e8, poisson_ratio=0.45)
ball = Sphere(RADIUS, rubber, mass=0.0459)
head = RigidBody(
    mass=0.2,
    principal=[2.7e-4, 3.0e-4, 4.8e-4],
    material=Material.named("titanium"),
    curvature_radius=BULGE,
)


def shot(off: float, simulation: Simulation) -> Collision:
    """Return the collision of a ball hit ``off`` m towards the toe."""
    turned = off / BULGE
    face = np.array([np.cos(turned), -np.sin(turned), 0.0])
    face = np.cos(LOFT) * face + np.sin(LOFT) * np.array([0.0, 0.0, 1.0])
    place = np.array([DEPTH - 0.5 * off * off / BULGE, -off, 0.0])
    return collide(
        Encounter(
            ball,
            head,
            0.25,
            normal=-face,
            velocity=[0.0, 0.0, 0.0],
            target_velocity=[SPEED, 0.0, 0.0],
            target_contact=place,
        ),
        simulation,
    ).check()


# %%
# **Start, backspin and spin axis** over the place of the shot, under laws of one restitution.
places = np.linspace(-0.025, 0.025, 11)
found = {}
for name, law in (("viscoelastic", "springs"), ("rigid", "coulomb")):
    simulation = Simulation(normal=create("normal.viscoelastic", restitution=0.8), tangential=law)
    rows = []
    for off in places:
        after = shot(off, simulation)
        speed, spin = after.velocity, after.spin / (2.0 * np.pi) * 60.0
        # to the right of the target line: negative y; a spin axis that tips left is a draw
        start = np.degrees(np.arctan2(-speed[1], speed[0]))
        rows.append((start, -spin[1], np.degrees(np.arctan2(spin[2], -spin[1]))))
    found[name] = np.array(rows)
    toe = found[name][-3]
    print(
        f"{name:12s} 15 mm off the toe: starts {toe[0]:.1f}° right, "
        f"backspin {toe[1]:.0f} rpm, axis {toe[2]:.1f}°"
    )

# %%
# **The contact is wide**: its radius is half that of the ball. The theory of half-spaces is
# doubtful there, and the plan says so.
lossy = Simulation(normal=create("normal.viscoelastic", restitution=0.8), tangential="springs")
wide = shot(0.015, lossy).result.motion.maximum_radius / ball.radius
print(f"contact radius {wide:.2f} of the ball's")


def from_above(axes: Any) -> None:
    """Draw head, face and ball from above, 20 mm off; upwards is the target."""
    radius, off, bulge = 1e3 * RADIUS, 20.0, 1e3 * BULGE
    turn = np.linspace(-0.19, 0.19, 41)
    face = bulge * np.sin(turn), bulge * (np.cos(turn) - 1.0)
    back = np.linspace(0.0, np.pi, 41)
    body = face[0][-1] * np.cos(back), face[1][-1] - 75.0 * np.sin(back)
    axes.fill(*np.concatenate([face, body], axis=1), color="0.85")
    axes.plot(*face, color="0.3", linewidth=2.0)
    normal = np.array([off, np.sqrt(bulge**2 - off**2)]) / bulge
    centre = np.array([off, bulge * (normal[1] - 1.0)]) + radius * normal
    axes.add_patch(Circle((centre[0], centre[1]), radius, facecolor="white", edgecolor="black"))
    arrow = {"arrowstyle": "-|>", "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0}
    start = np.radians(np.interp(off, 1e3 * places, found["viscoelastic"][:, 0]))
    leaves = np.array([np.sin(start), np.cos(start)])
    for begin, way, colour in ((centre, leaves, "C1"), ((-38.0, -30.0), (0, 1), "0.3")):
        end = np.add(begin, 62.0 * np.array(way))
        axes.annotate("", end, begin, arrowprops=arrow | {"color": colour})
    axes.plot([centre[0]] * 2, centre[1] + np.array([0.0, 62.0]), ":", color="0.5", linewidth=1.0)
    axes.plot(0.0, -1e3 * DEPTH, "k+", markersize=9)
    small = {"fontsize": "small", "ha": "center"}
    axes.text(0.0, -1e3 * DEPTH - 14.0, "centre of mass", **small)
    axes.text(-38.0, 38.0, f"{SPEED:.0f} m/s", **small)
    axes.text(centre[0] + 8.0, centre[1] + 66.0, "starts to the right", color="C1", **small)
    axes.text(-60.0, -70.0, "heel", **small)
    axes.text(60.0, -70.0, "toe", **small)
    axes.set(aspect="equal", xlim=(-85, 85), ylim=(-92, 112), title="driver and ball from above")
    axes.axis("off")


with styled():
    figure = Figure(figsize=(9.5, 3.9), layout="constrained")
    sketch, *panels = figure.subplots(1, 3, width_ratios=(1.15, 1.0, 1.0))
    from_above(sketch)
    words = {"viscoelastic": "viscoelastic ball", "rigid": "rigid bodies"}
    titles = {1: "backspin (rpm)", 2: "spin axis, tipped for a draw (°)"}
    for axes, (column, what) in zip(panels, titles.items(), strict=True):
        for name, line in (("viscoelastic", "-"), ("rigid", "--")):
            axes.plot(1e3 * places, found[name][:, column], line, color="C0", label=words[name])
        axes.set(xlabel="heel    shot off the centre (mm)    toe", title=what)
        axes.axvline(0.0, color="0.7", linewidth=0.8)
    panels[0].set_ylim(bottom=0.0)
    panels[1].legend(loc="upper left")
    figure.supxlabel(
        f"The contact radius is {wide:.2f} of the ball's: half-space theory is doubtful there.",
        fontsize="small", color="#555555",
    )  # fmt: skip
    save_figure(figure, Path("toe_shot.png"))
