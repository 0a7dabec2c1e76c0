"""Which way is positive: a ball before and after the impact, with every sign that contactlab uses.

The ball moves down and to the right. Its tangential velocity is positive to the right, its
normal speed towards the target, and its spin where it moves the lowest point of the ball to the
right, so that it adds to the slip. A ball that rolls to the right has a negative spin. The ball
that leaves, dashed, is drawn as the exact law has it.

Writes ``signs.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.figures import save_figure, styled

RADIUS, BLUE, RED = 0.01, "#0072B2", "#D55E00"
pmma = Material.named("pmma")
bodies = Sphere(RADIUS, pmma), HalfSpace(pmma)
scene = Scene(*bodies, 0.5, normal_speed=1.0, tangential_velocity=0.9, spin=60.0)
result = Simulation().run(scene).check()
after, turned = result.rebound_tangential_velocity, result.rebound_spin
print(f"before: v = {scene.tangential_velocity:.2f} m/s, spin {scene.spin:.0f} rad/s")
print(f"the contact point slips with v + omega R = {scene.slip_velocity:.2f} m/s")
print(f"after:  v = {after:.2f} m/s, spin {turned:.0f} rad/s")
rolling = Scene(*bodies, 0.5, normal_speed=1.0, tangential_velocity=0.9, spin=-0.9 / RADIUS)
print(f"rolling to the right: spin {rolling.spin:.0f} rad/s, slip {rolling.slip_velocity:.2f} m/s")


def arrow(axes, start, vector, words, colour, offset=(6, 0)):
    """Draw an arrow with its name at the tip."""
    tip = np.add(start, vector)
    axes.annotate("", tip, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.8})
    axes.annotate(words, tip, offset, textcoords="offset points", color=colour, va="center")


def turning(axes, centre, spin, words, colour):
    """Draw a spin as an arc with an arrow head: anticlockwise if positive."""
    first, last = (20.0, 160.0) if spin > 0.0 else (160.0, 20.0)
    axes.add_patch(Arc(centre, 1.2, 1.2, theta1=20.0, theta2=160.0, color=colour, lw=1.8))
    near, end = (np.radians(last - (last - first) * share) for share in (0.08, 0.0))
    points = [np.add(centre, (0.6 * np.cos(turn), 0.6 * np.sin(turn))) for turn in (near, end)]
    axes.annotate("", points[1], points[0], arrowprops={"arrowstyle": "-|>", "color": colour})
    axes.text(centre[0] - 0.35, centre[1] + 0.72, words, color=colour, ha="center", va="center")


with styled():
    figure = Figure(figsize=(7.2, 3.4))
    axes = figure.subplots()
    axes.axhspan(-0.5, 0.0, color="#E4E4E4")
    axes.axhline(0.0, color="black", lw=1.0)
    axes.text(-3.3, -0.27, "target", va="center")
    arrow(axes, (-2.2, -0.27), (0.7, 0.0), "x", "black")
    before, left = (-1.6, 1.9), (1.7, 1.9)
    for centre, style in ((before, "-"), (left, "--")):
        axes.add_patch(Circle(centre, 1.0, fill=False, ls=style, lw=1.2))
        axes.plot(*centre, "o", color="black", ms=3)
    arrow(axes, before, (1.3, 0.0), r"$v > 0$", BLUE)
    arrow(axes, before, (0.0, -1.4), r"$v_1 > 0$", BLUE)
    turning(axes, before, scene.spin, r"$\omega > 0$", RED)
    arrow(axes, left, (1.3 * after / 0.9, 0.0), r"$v > 0$", BLUE)
    arrow(axes, left, (0.0, 1.4), r"$v_z < 0$", BLUE)
    turning(axes, left, turned, r"$\omega < 0$", RED)
    axes.set(xlim=(-3.5, 3.2), ylim=(-0.5, 3.4), aspect="equal")
    axes.set_title("before the impact (solid) and after (dashed)", fontsize="medium")
    axes.axis("off")
    save_figure(figure, Path("signs.png"))
