"""A golf ball hit by the toe and the heel of a driver.

A shot off the centre turns the club's head, and friction at its face turns the ball the other
way: the gear effect. The face bulges, so that the ball starts on the side of the shot, and the
spin is to bend its flight back. Rigid bodies tip the spin axis by 5° for a shot 25 mm off. The
surfaces of a viscoelastic ball spring back along the face: the ball has a third more backspin, and
its axis tips by 2° at most. Normal restitution is 0.8, that of a frictionless impact.

Writes ``toe_shot.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from contactlab import Encounter, Material, RigidBody, Simulation, Sphere, collide, create
from contactlab.figures import save_figure, styled

SPEED = 45.0  # m/s, of the head, along x; z is up, and the toe lies at negative y
LOFT = np.radians(10.5)
BULGE = 0.30  # m, radius of the face
DEPTH = 0.035  # m, from the centre of mass to the face

rubber = Material(young_modulus=1.5e8, poisson_ratio=0.45)
ball = Sphere(0.02134, rubber, mass=0.0459)
head = RigidBody(
    mass=0.2,
    principal=[2.7e-4, 3.0e-4, 4.8e-4],
    material=Material.named("titanium"),
    curvature_radius=BULGE,
)


def shot(off, simulation):
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

with styled():
    figure = Figure(figsize=(9.5, 3.6), layout="constrained")
    names = ("start, right of the target (°)", "backspin (rpm)", "spin axis, tipped for a draw (°)")
    for axes, column, what in zip(figure.subplots(1, 3), range(3), names, strict=True):
        for name, line in (("viscoelastic", "-"), ("rigid", "--")):
            axes.plot(1e3 * places, found[name][:, column], line, color="C0", label=name)
        axes.set(xlabel="shot off the centre (mm)\nheel          toe", title=what)
        axes.axvline(0.0, color="0.7", linewidth=0.8)
    axes.legend()
    save_figure(figure, Path("toe_shot.png"))
