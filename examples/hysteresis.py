"""Hysteresis loops of three laws of friction: what each contact forgets.

A ball is pressed on another and moved to and fro. At constant load every contact with friction
loses a loop of energy in each cycle, even far below gross slip, because it slips at its rim;
Mindlin and Deresiewicz gave the area of the loop. A single spring cut off at Coulomb's limit has
no such loop: it loses nothing before it slips as a whole. On the right the displacement is held
and the load swings. The elastic contact gives up some force once. The spring of a common
discrete-element code loses some in every cycle, until nothing is left.

Writes ``hysteresis.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from contactlab import Material, Scene, Sphere, create, load_path
from contactlab.figures import law_style, name_curves, save_figure, styled

FRICTION, APPROACH, REACH, CYCLES = 0.3, 1e-6, 0.6, 6
ball = Sphere(0.01, Material.named("steel"))
scene = Scene(ball, ball, FRICTION, normal_speed=1.0)
gross = FRICTION * APPROACH / scene.pair.stiffness_ratio  # displacement at which all slips
laws = {
    "elastic": create("tangential.springs", springs=200),
    "capped spring": create("tangential.mindlin_cap"),
    "rescaled spring": create("tangential.mindlin_cap", form="increment_rescaled"),
}

# %%
# **Constant load.** Two cycles; the second is the closed loop.
turn = np.linspace(0.0, 4.0 * np.pi, 801)
moved = REACH * np.sin(turn)
loops = {}
for name in ("elastic", "capped spring"):
    path = load_path(scene, np.full(801, APPROACH), gross * moved, tangential=laws[name]).check()
    unit = FRICTION * path.normal_force[0]
    loops[name] = path.friction_force / unit
    lost = (path.work[-1] - path.work[400]) / (unit * gross)
    print(f"{name:15s} loses {lost:.4f} of mu P D_s in a cycle")
rest = 1.0 - REACH
area = 8.0 * (REACH - 0.4 * (1.0 - rest**2.5)) - 4.0 * REACH * (1.0 - rest**1.5)
print(f"Mindlin and Deresiewicz: {area:.4f}")

# %%
# **A load that swings** between all and half of the approach, at a displacement that is held.
swing = np.concatenate([np.linspace(1.0, 0.5, 41)[1:], np.linspace(0.5, 1.0, 41)[1:]])
level = np.concatenate([np.ones(61), np.tile(swing, CYCLES)])
pushed = np.concatenate([np.linspace(0.0, 0.1, 61), np.full(80 * CYCLES, 0.1)])
cycles = np.arange(80 * CYCLES + 1) / 80.0
held = {}
for name in ("elastic", "rescaled spring"):
    path = load_path(scene, APPROACH * level, gross * pushed, tangential=laws[name]).check()
    held[name] = path.friction_force[60:] / path.friction_force[60]
    print(f"{name:15s} holds {held[name][-1]:.2f} of its force after {CYCLES} cycles of the load")

with styled():
    figure = Figure(figsize=(9.5, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    for axes, curves in ((left, loops), (right, held)):
        axes.axhline(0.0, color="grey", lw=0.8, zorder=0)
        lines = []
        for name, force in curves.items():
            style = law_style(list(laws).index(name))
            lines += axes.plot(moved if axes is left else cycles, force, **style)
        name_curves(axes, lines, list(curves))
    left.set(
        xlabel=r"displacement over that of gross slip $D/D_\mathrm{s}$",
        ylabel=r"friction force $F/(\mu P)$",
        title="constant load",
    )
    right.set(
        xlabel="cycles of the load",
        ylabel="friction force over that at first",
        title="displacement held",
        xlim=(0.0, CYCLES),
        ylim=(0.0, 1.08),
    )
    save_figure(figure, Path("hysteresis.png"))
