"""Several contacts at once: a cradle, a cushion and its cloth, a rack of balls, a box on its face.

The gap between two balls of a cradle decides whether they are struck at once or one after another.
At a gap of the depth of a contact, twenty micrometres, the answer is that of a sequence already. A
micrometre moves the first ball by a fifth of its velocity, so that no cradle is one of the two.

A ball that rolls into a cushion is pressed on its cloth meanwhile, which carries its weight when
the impact begins. Gaps of a few micrometres between the fifteen balls of a rack move their speeds
from break to break. A box that lands flat does so on four corners, and a tilt of a twentieth of a
degree decides how it leaves.

Writes ``several_contacts.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from contactlab import (
    Body,
    Gathering,
    HalfSpace,
    Material,
    Simulation,
    Sphere,
    Touch,
    collide,
    create,
    shapes,
)
from contactlab.figures import save_figure, styled

steel = Material.named("steel")
quick = Simulation(
    tangential=create("tangential.springs", springs=12),
    integrator=create("integrator.symplectic", steps=60),
)
down = np.array([0.0, 0.0, -1.0])

# A cradle of five, for many gaps between the balls: one batch.
ball = Sphere(0.01, steel)
gaps = np.geomspace(1e-8, 1e-3, 61)
cradle = Gathering(
    [Body(ball, velocity=[1.0, 0.0, 0.0]), *(Body(ball) for _ in range(4))],
    [Touch(k, k + 1, 0.0, normal=[1.0, 0.0, 0.0], gap=gaps if k else 0.0) for k in range(4)],
)
swung = collide(cradle, quick)
print("cradle, closed:      ", swung.velocity[0, :, 0].round(3), "m/s")
print("cradle, gaps of 1 mm:", swung.velocity[-1, :, 0].round(3), "m/s")

# A ball that rolls into a cushion at 45°, with the weight on the cloth and without.
ivory = Material(young_modulus=5e9, poisson_ratio=0.34, density=1700.0)
rubber = HalfSpace(Material(young_modulus=5e6, poisson_ratio=0.48))
slate = HalfSpace(Material(young_modulus=5e7, poisson_ratio=0.4))
billiard = Sphere(0.0286, ivory)


def rolling(weight: float) -> Gathering:
    """Return a rolling ball that meets a cushion, with a weight in N on its cloth."""
    spin = np.array([-1.0, 1.0, 0.0]) / billiard.radius
    shot = Body(billiard, velocity=[1.0, 1.0, 0.0], spin=spin, force=weight * down)
    return Gathering(
        {"ball": shot},
        [
            Touch("ball", rubber, 0.14, normal=[0.0, 0.9165, 0.4], restitution=0.9),
            Touch("ball", slate, 0.2, normal=down, restitution=0.5, loaded=weight > 0.0),
        ],
    )


shot = collide(rolling(billiard.mass * 9.81), history=True)
print("cushion, with weight:   ", shot["ball"].velocity.round(3), "m/s")
print("cushion, without weight:", collide(rolling(0.0))["ball"].velocity.round(3), "m/s")

# Fifteen balls in a rack, struck at 8 m/s; gaps of up to 5 µm differ from break to break.
rng, breaks = np.random.default_rng(1), 12
size = 2.0 * billiard.radius
rows = [(k, j) for k in range(5) for j in range(k + 1)]
places = np.array([[k * size * np.sqrt(0.75), (j - 0.5 * k) * size, 0.0] for k, j in rows])
cue = Body(billiard, velocity=[8.0, 0.0, 0.0], position=[-size, 0.0, 0.0])
rack = Gathering.of_spheres(
    [cue, *(Body(billiard, position=place) for place in places)],
    friction_coefficient=0.06,
    reach=1e-9,
)
open_by = rng.uniform(0.0, 5e-6, (len(rack.touches), breaks))
loose = [
    Touch(each.first, each.second, 0.06, normal=each.normal, gap=gap if k else 0.0)
    for k, (each, gap) in enumerate(zip(rack.touches, open_by, strict=True))
]
broken = collide(Gathering(rack.bodies, loose), quick)
speeds = np.linalg.norm(broken.velocity, axis=-1)
corners, spread = speeds[:, [11, 15]].mean(), np.ptp(speeds, axis=0)
told = f"gaps move ball {spread.argmax()} most, by {spread.max():.2f} m/s"
print(f"break: corner balls leave at {corners:.2f} m/s; {told}")

# A box that lands flat, or nearly.
tilts = np.radians([0.0, 0.005, 0.05])
for tilt in tilts:
    c, s = np.cos(tilt), np.sin(tilt)
    box, contacts, off = shapes.flat_box(
        sides=[0.1, 0.1, 0.04], corner_radius=0.003, material=steel, normal=down, reach=1e-3,
        axes=[[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]],
    )  # fmt: skip
    floor = HalfSpace(steel)
    touches = [
        Touch("box", floor, 0.3, normal=down, contact=each, gap=gap)
        for each, gap in zip(contacts, off, strict=True)
    ]
    fallen = collide(Gathering({"box": Body(box, velocity=down)}, touches), quick)["box"]
    told = f"up {fallen.velocity[2]:.3f} m/s, spin {fallen.spin[1]:.2f} rad/s"
    print(f"box, tilted by {np.degrees(tilt):.3f}°: {told}")

with styled():
    figure = Figure(figsize=(9.0, 2.9), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    for k in range(5):
        left.semilogx(gaps * 1e6, swung.velocity[:, k, 0], label=f"ball {k + 1}")
    depth = gaps[0] * 1e6 / swung.plan.gap_over_depth[0, 1]
    left.axvline(depth, color="0.7", linewidth=0.8)
    left.annotate(" depth of\n a contact", (depth, 0.55), fontsize="x-small")
    left.set(xlabel="gaps (µm)", ylabel="velocity after (m/s)", title="cradle of five")
    left.legend(fontsize="x-small", loc="center left")
    forces, time = shot.history.normal_force, shot.history.time[:, 0] * 1e3
    for k, name in enumerate(("cushion", "cloth")):
        middle.plot(time, forces[:, k], label=name)
    middle.set(xlabel="time (ms)", ylabel="force (N)", title="cushion and cloth")
    middle.legend(fontsize="x-small")
    right.plot(np.arange(16), speeds.T, ".", color="0.4", markersize=3)
    right.set(xlabel="ball (0: cue ball)", ylabel="speed after (m/s)", title="twelve breaks")
    save_figure(figure, Path("several_contacts.png"))
