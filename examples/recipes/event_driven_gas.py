"""An event-driven gas of elastic spheres: from collision to collision, each by contactlab.collide.

Run with ``python event_driven_gas.py``. Every event costs a look at all pairs: for more than some
hundred spheres keep the times of the pairs whose spheres did not collide.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from contactlab import Encounter, Material, Sphere, collide

Array = NDArray[np.float64]

BALL = Sphere(0.01, Material(young_modulus=5e9, poisson_ratio=0.3, density=1200.0))


def beginning(
    side: int = 3, filled: float = 0.05, random: np.random.Generator | None = None
) -> tuple[float, Array, Array, Array]:
    """Return the edge of a periodic box and places, velocities and spins, shape (n, 3), in it."""
    random = np.random.default_rng(0) if random is None else random
    count = side**3
    edge = (count * 4.0 / 3.0 * np.pi * BALL.radius**3 / filled) ** (1.0 / 3.0)
    lattice = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3)
    velocity = random.normal(size=(count, 3))
    spin = random.normal(size=(count, 3)) / BALL.radius
    return edge, (lattice + 0.5) * edge / side, velocity - velocity.mean(axis=0), spin


def next_pair(
    place: Array, velocity: Array, edge: float
) -> tuple[float, tuple[int, int, Array] | None]:
    """Return the time until two spheres touch, both of them and the normal from one to other.

    None in their place: none touch in this time.
    """
    one, other = np.triu_indices(len(place), 1)
    apart, closing = place[other] - place[one], velocity[other] - velocity[one]
    apart -= edge * np.round(apart / edge)  # the nearest images
    along, speed = (apart * closing).sum(axis=1), (closing**2).sum(axis=1)
    left = along**2 - speed * ((apart**2).sum(axis=1) - 4.0 * BALL.radius**2)
    meets = (along < 0.0) & (left > 0.0)
    wait = np.full(len(one), np.inf)
    wait[meets] = (-along[meets] - np.sqrt(left[meets])) / speed[meets]
    # Until a pair has moved so far its nearest images are the only ones that can touch.
    safe = (0.5 * edge - 2.0 * BALL.radius) / np.sqrt(speed.max())
    pair = wait.argmin()
    if wait[pair] > safe:
        return safe, None
    soon = max(wait[pair], 0.0)
    return soon, (int(one[pair]), int(other[pair]), apart[pair] + soon * closing[pair])


def events(
    place: Array,
    velocity: Array,
    spin: Array,
    edge: float,
    friction: float = 0.3,
    restitution: float = 1.0,
) -> Iterator[tuple[float, Array, Array, Array, float]]:
    """Yield after every event the time since the last, places, velocities, spins, friction work."""
    since, work = 0.0, 0.0
    while True:
        wait, pair = next_pair(place, velocity, edge)
        place, since = (place + wait * velocity) % edge, since + wait
        if pair is None:
            continue
        one, other, normal = pair
        met = Encounter(
            BALL, BALL, friction, normal=normal,
            velocity=velocity[one], spin=spin[one],
            target_velocity=velocity[other], target_spin=spin[other],
        )  # fmt: skip
        made = collide(met, restitution=restitution)
        velocity, spin = velocity.copy(), spin.copy()
        velocity[one], velocity[other] = made.velocity, made.target_velocity
        spin[one], spin[other] = made.spin, made.target_spin
        work += made.friction_work
        yield since, place, velocity, spin, work
        since = 0.0


if __name__ == "__main__":
    edge, place, velocity, spin = beginning(side=4)
    course = events(place, velocity, spin, edge)
    for number, (*_, velocity, spin, work) in enumerate(course, 1):
        if number % 500 == 0:
            ratio = 0.4 * BALL.radius**2 * (spin**2).sum() / (velocity**2).sum()
            print(f"{number} collisions: {work:.4f} J lost, temperatures in the ratio {ratio:.3f}")
        if number == 2000:
            break
