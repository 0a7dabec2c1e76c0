"""Throw of billiard balls: elastic contact against the published no-slip formula.

The cue ball meets an object ball off its centre, at a cut angle. Friction between the two drags
the object ball aside: it leaves some degrees nearer to the path of the cue ball than along the
line of centres. Players call it throw. The published formula, for a cue ball that slides
without spin, is tan(throw) = min(mu, tan(cut)/7): either the balls slip to the end, or their
surfaces come to rest against each other, as rigid bodies do. Elastic surfaces spring back, and
throw up to half as far again. At a cut of 20 degrees and 0.45 m/s the formula gives 3.0 degrees
and the elastic law 4.4: a prediction to be measured.

The formula is that of D. G. Alciatore's technical proof A.14, and the friction, which falls
with the sliding speed, that of A.28 (2007, billiards.colostate.edu; a fit to Marlow's data).
The ball is of phenolic resin.

Writes ``throw_of_billiard_balls.png`` in the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from contactlab import Encounter, Material, Sphere, collide
from contactlab.figures import ordered_colours, save

Array = NDArray[np.float64]
BALL = Sphere(0.028575, Material.named("phenolic resin"))
SPEEDS = {0.45: "slow, 0.45 m/s", 1.34: "medium, 1.34 m/s", 3.1: "fast, 3.1 m/s"}
CUTS = np.radians(np.linspace(0.5, 75.0, 150))


def friction(sliding: Array) -> Array:
    """Return mu at a sliding speed in m/s, by technical proof A.28."""
    return 9.951e-3 + 0.108 * np.exp(-1.088 * sliding)


def no_slip(cut: Array, mu: Array) -> Array:
    """Return the throw by the published formula, in degrees."""
    return np.degrees(np.arctan(np.minimum(mu, np.tan(cut) / 7.0)))


def elastic(cut: Array, speed: float) -> Array:
    """Return the throw of elastic balls, in degrees."""
    normal = np.stack((np.cos(cut), np.sin(cut), 0.0 * cut), axis=-1)
    velocity = np.broadcast_to([speed, 0.0, 0.0], normal.shape)
    met = Encounter(BALL, BALL, friction(speed * np.sin(cut)), normal=normal, velocity=velocity)
    made = collide(met).check()
    direction = np.arctan2(made.target_velocity[:, 1], made.target_velocity[:, 0])
    return np.degrees(cut - direction)


def draw(axes: Axes) -> None:
    """Draw both throws over the cut angle, the elastic one solid."""
    degrees = np.degrees(CUTS)
    for (speed, name), colour in zip(SPEEDS.items(), ordered_colours(3), strict=True):
        throw = elastic(CUTS, speed)
        axes.plot(degrees, throw, color=colour)
        axes.plot(
            degrees, no_slip(CUTS, friction(speed * np.sin(CUTS))), "--", color=colour, lw=1.0
        )
        axes.annotate(name, (degrees[-60], throw[-60]), (0, 7), textcoords="offset points",
                      color=colour)  # fmt: skip
    axes.set(xlabel="cut angle (°)", ylabel="throw of the object ball (°)", xlim=(0, 75))
    axes.set_ylim(bottom=0.0, top=6.6)
    axes.text(2.0, 6.05, "solid: elastic balls\ndashed: min($\\mu$, tan(cut)/7)", va="center")


print("cut  speed   elastic  published")
for speed in SPEEDS:
    for cut_deg in (10, 20, 30):
        cut = np.radians([float(cut_deg)])
        (throw,), (formula,) = elastic(cut, speed), no_slip(cut, friction(speed * np.sin(cut)))
        print(f"{cut_deg:2d}°  {speed:.2f} m/s  {throw:5.2f}°   {formula:5.2f}°")
save(Path("throw_of_billiard_balls.png"), draw)
