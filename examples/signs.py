"""Signs of velocities and spins: a ball before and after the impact, and which way is positive.

The ball moves down and to the right. Its tangential velocity is positive to the right, its
normal speed towards the target, and its spin where it moves the lowest point of the ball to the
right, so that it adds to the slip of the contact point. A ball that rolls to the right has a
negative spin. After the impact the same signs hold: a ball that leaves has a negative normal
velocity. Numbers and arrows of the rebound are those of the exact law.

Writes ``signs.png`` in the current folder.
"""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.figures import save_figure, styled

Point = tuple[float, float]
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


def arrow(axes: Any, start: Point, vector: tuple[Any, Any], colour: str) -> None:
    """Draw an arrow."""
    tip = np.add(start, vector)
    look = {"arrowstyle": "-|>", "color": colour, "lw": 1.8, "shrinkA": 0.0, "shrinkB": 0.0}
    axes.annotate("", tip, start, arrowprops=look)


def turning(axes: Any, centre: Point, spin: float, colour: str) -> None:
    """Draw a spin as an arc with an arrow head: anticlockwise if positive."""
    first, last = (20.0, 160.0) if spin > 0.0 else (160.0, 20.0)
    axes.add_patch(Arc(centre, 1.2, 1.2, theta1=20.0, theta2=160.0, color=colour, lw=1.8))
    near, end = (np.radians(last - (last - first) * share) for share in (0.08, 0.0))
    points = [np.add(centre, (0.6 * np.cos(turn), 0.6 * np.sin(turn))) for turn in (near, end)]
    axes.annotate("", points[1], points[0], arrowprops={"arrowstyle": "-|>", "color": colour})


with styled():
    figure = Figure(figsize=(7.2, 3.6))
    axes = figure.subplots()
    axes.axhspan(-0.75, 0.0, color="#E4E4E4")
    axes.axhline(0.0, color="black", lw=1.0)
    axes.text(-3.7, -0.5, "target", va="center")
    motions = {
        "before": (scene.tangential_velocity, scene.normal_speed, scene.spin),
        "after": (after, -result.normal_restitution * scene.normal_speed, turned),
    }
    for place, (when, (along, into, spin)) in zip((-2.0, 2.2), motions.items(), strict=True):
        centre, slip = (place, 1.0), along + spin * RADIUS
        axes.add_patch(Circle(centre, 1.0, fill=False, lw=1.2))
        axes.plot(*centre, "o", color="black", ms=3)
        axes.plot(place, 0.0, "o", color="black", ms=5)
        arrow(axes, centre, (along, 0.0), BLUE)
        arrow(axes, centre, (0.0, -0.8 * into), BLUE)
        turning(axes, centre, spin, RED)
        arrow(axes, (place, -0.14), (slip, 0.0), "black")
        lines = (
            (1.4, rf"$\omega = {spin:+.0f}$ rad/s", RED),
            (1.0, f"$v = {along:+.2f}$ m/s", BLUE),
            (0.6, f"$v_n = {into:+.2f}$ m/s", BLUE),
        )
        for height, words, colour in lines:
            axes.text(place + 1.15, height, words, color=colour, va="center")
        words = rf"slip $v + \omega R = {slip:+.2f}$ m/s"
        axes.text(place, -0.42, words, ha="center", va="center")
        axes.text(place, 2.25, when, ha="center", fontsize="large")
    arrow(axes, (-3.7, 0.5), (0.5, 0.0), "black")
    arrow(axes, (-3.7, 0.5), (0.0, -0.5), "black")
    axes.text(-3.1, 0.5, "$x$", va="center")
    axes.text(-3.6, 0.15, "$n$", va="center")
    axes.set(xlim=(-3.8, 4.7), ylim=(-0.75, 2.6), aspect="equal")
    axes.axis("off")
    save_figure(figure, Path("signs.png"))
