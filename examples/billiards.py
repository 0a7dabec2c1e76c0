"""A break shot with side spin, collision after collision: balls without cloth or air to slow them.

The only loss is friction where balls rub against each other and the cushions; when they have come
nearly to rest the cue ball is struck again. All motion stays in the plane of the table, and spin is
about the vertical: the line on a ball turns with it.

    python billiards.py --collisions 10000
"""

import argparse
from collections.abc import Iterator
from itertools import combinations
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.patches import Circle
from numpy.typing import NDArray

from contactlab import Encounter, HalfSpace, Material, Sphere, collide

Array = NDArray[np.float64]
#: Time, places, velocities, angles, spins, energy given and lost.
Event = tuple[float, Array, Array, Array, Array, float, float]
RESIN = Material(young_modulus=5.8e9, poisson_ratio=0.34, density=1750.0)
RADIUS = 0.0286  # m
BALL, CUSHION = Sphere(RADIUS, RESIN), HalfSpace(RESIN)
TABLE = np.array([1.6, 0.8])  # m
BALLS_FRICTION, CUSHION_FRICTION = 0.08, 0.3
CUE_SPEED, CUE_SPIN = 4.0, 150.0  # m/s, rad/s
GAP = 2e-4  # m, between balls of the rack, so that they meet one at a time
HALF = ("gold", "royalblue", "firebrick", "indigo", "darkorange", "seagreen", "maroon")
COLOURS = ("ivory", *HALF, "black", *HALF)
NEARLY_AT_REST = 0.02  # J, one per cent of a shot
FIRST, SECOND = np.array(list(combinations(range(16), 2))).T


def rack() -> Array:
    """Return places of 16 balls, the cue ball first; a little disorder, always the same."""
    step = 2.0 * RADIUS + GAP
    spots = [
        (row * 0.875 * step, (k - 0.5 * row) * step) for row in range(5) for k in range(row + 1)
    ]
    disorder = np.random.default_rng(8).uniform(-0.2, 0.2, (15, 2)) * GAP
    racked = np.array(spots) + disorder + (0.6 * TABLE[0], 0.5 * TABLE[1])
    return np.vstack(([0.15 * TABLE[0], 0.48 * TABLE[1]], racked))


def energy(velocity: Array, spin: Array) -> float:
    """Return the kinetic energy in J."""
    rolling = 0.4 * (RADIUS * spin) ** 2
    return float(0.5 * BALL.mass * ((velocity**2).sum() + rolling.sum()))


def next_event(place: Array, velocity: Array) -> tuple[float, int, int]:
    """Return time, ball, and other ball (or minus one less the axis of a cushion)."""
    apart, closing = place[SECOND] - place[FIRST], velocity[SECOND] - velocity[FIRST]
    along, speed = (apart * closing).sum(axis=1), (closing**2).sum(axis=1)
    left = along**2 - speed * ((apart**2).sum(axis=1) - 4.0 * RADIUS**2)
    with np.errstate(all="ignore"):
        meet = (-along - np.sqrt(left)) / speed
        wall = np.where(velocity > 0.0, TABLE - RADIUS - place, RADIUS - place) / velocity
    meet[~((along < 0.0) & (left >= 0.0))] = np.inf
    wall[velocity == 0.0] = np.inf
    pair, (ball, axis) = meet.argmin(), np.unravel_index(wall.argmin(), wall.shape)
    if meet[pair] < wall[ball, axis]:
        return max(float(meet[pair]), 0.0), int(FIRST[pair]), int(SECOND[pair])
    return max(float(wall[ball, axis]), 0.0), int(ball), -1 - int(axis)


def play(collisions: int) -> Iterator[Event]:
    """Yield time, places, velocities, angles, spins, energy given and lost after each collision."""
    place, velocity = rack(), np.zeros((16, 2))
    angle, spin, time, given, lost = np.zeros(16), np.zeros(16), 0.0, 0.0, 0.0
    for _ in range(collisions):
        if (left := energy(velocity, spin)) <= NEARLY_AT_REST:
            velocity, spin = velocity.copy(), spin.copy()
            velocity[0], spin[0] = (CUE_SPEED, 0.0), CUE_SPIN
            given += energy(velocity, spin) - left
            yield time, place, velocity, angle, spin, given, lost
        wait, one, other = next_event(place, velocity)
        time, place, angle = time + wait, place + wait * velocity, angle + wait * spin
        velocity, spin = velocity.copy(), spin.copy()
        normal = place[other] - place[one] if other >= 0 else np.zeros(2)
        target: Sphere | HalfSpace = BALL
        friction = BALLS_FRICTION
        struck: dict[str, Any] = {}
        if other < 0:
            target, friction = CUSHION, CUSHION_FRICTION
            normal[-1 - other] = np.sign(velocity[one, -1 - other])
        else:
            struck = {
                "target_velocity": (*velocity[other], 0.0),
                "target_spin": (0, 0, spin[other]),
            }
        met = Encounter(
            BALL, target, friction, normal=(*normal, 0.0),
            velocity=(*velocity[one], 0.0), spin=(0.0, 0.0, spin[one]), **struck,
        )  # fmt: skip
        made = collide(met)
        velocity[one], spin[one] = made.velocity[:2], made.spin[2]
        if other >= 0:
            velocity[other], spin[other] = made.target_velocity[:2], made.target_spin[2]
        lost += float(made.friction_work)
        yield time, place, velocity, angle, spin, given, lost


def draw(shot: list[Event], frames: int, seconds: float, path: str) -> None:
    """Write an animation: as many frames, evenly over the first seconds."""
    figure = plt.figure(figsize=(6.4, 3.5), facecolor="saddlebrown")
    axes = figure.add_axes((0.03, 0.05, 0.94, 0.86), facecolor="darkgreen", aspect="equal")
    axes.set(xlim=(0.0, TABLE[0]), ylim=(0.0, TABLE[1]), xticks=[], yticks=[])
    discs = [Circle((0, 0), RADIUS, color=colour) for colour in COLOURS]
    inks = ["black" if colour in ("ivory", "gold") else "white" for colour in COLOURS]
    marks = [axes.plot([], [], color=ink, lw=2.0)[0] for ink in inks]
    (trail,) = axes.plot([], [], color="white", lw=0.8, alpha=0.5)
    title = figure.text(0.03, 0.945, "", color="white", family="monospace", size=9)
    for disc in discs:
        axes.add_patch(disc)
    times = np.array([event[0] for event in shot])
    seen = []

    def show(frame: int) -> None:
        now = seconds * frame / frames
        count = np.searchsorted(times, now, side="right") - 1
        time, place, velocity, angle, spin, given, lost = shot[count]
        place, angle = place + (now - time) * velocity, angle + (now - time) * spin
        arm = 0.9 * RADIUS * np.stack((np.cos(angle), np.sin(angle)), axis=1)
        for disc, mark, centre, end in zip(discs, marks, place, arm, strict=True):
            disc.center = centre
            mark.set_data(*np.stack((centre - end, centre + end), axis=1))
        seen.append(place[0])
        trail.set_data(*np.array(seen[-12:]).T)
        title.set_text(
            f"{now:4.1f} s   {count:3} collisions   {lost / given:6.2%} lost to friction"
        )

    film = FuncAnimation(figure, show, frames, init_func=lambda: None)
    film.save(path, PillowWriter(fps=20), dpi=90)
    plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description="A break shot with side spin.")
    parser.add_argument("--collisions", type=int, default=300)
    parser.add_argument("--frames", type=int, default=120)
    asked = parser.parse_args()
    shot = list(play(asked.collisions))
    time, _, velocity, _, spin, given, lost = shot[-1]
    left = energy(velocity, spin)
    print(f"{asked.collisions} collisions in {time:.1f} s of play")
    print(f"kinetic energy {given:.4f} J given, {left:.4f} J left; friction took {lost:.4f} J")
    print(f"what does not add up: {abs(given - left - lost) / given:.0e} of it")
    draw(shot, asked.frames, min(time, 5.0), "billiards.gif")


if __name__ == "__main__":
    main()
