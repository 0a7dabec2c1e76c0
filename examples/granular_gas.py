"""Spin of a cooling granular gas: its share of the energy under four laws of friction.

Grains in free flight that meet at random (direct-simulation Monte Carlo: a box without walls,
pairs drawn in proportion to the speed at which they meet, anywhere on the disc that they show
each other) lose energy at every collision. At first no grain spins. Friction feeds the rotation
until the two temperatures keep a ratio, and the law of friction decides which: rigid spheres,
the capped springs of discrete-element codes and Walton's constants each miss that of elastic
spheres with partial slip. The grains are of glass, e = 0.9 and mu = 1. With 20,000 grains and
40 collisions of each the ratios are 0.69 for elastic spheres, 0.77 with Walton's constants,
0.65 with capped springs, and 0.53 for rigid spheres.

    python granular_gas.py --grains 20000

Writes ``granular_gas.png`` in the current folder.
"""

import argparse
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

import contactlab
from contactlab import Encounter, Material, Simulation, Sphere, collide
from contactlab.figures import law_style, save

Array = NDArray[np.float64]
RESTITUTION, FRICTION = 0.9, 1.0
GRAIN = Sphere(0.5e-3, Material.named("soda-lime glass"))
SPEED = 0.1  # m/s, of each component at first
MOST = 0.3  # probability that the fastest pair of a round collides
TSUJI = contactlab.create("normal.tsuji", restitution=RESTITUTION)
#: Laws by name; None is ``collide(..., restitution=)``, partial slip from a table.
LAWS = {
    "Walton's constants": Simulation(normal=TSUJI, tangential="walton"),
    "elastic spheres": None,
    "capped springs": Simulation(normal=TSUJI, tangential="mindlin_cap"),
    "rigid friction": Simulation(normal=TSUJI, tangential="coulomb"),
}


def normals(approach: Array, random: np.random.Generator) -> Array:
    """Return normals, shape (n, 3), for impacts evenly over the disc that a pair shows."""
    ahead = approach / np.linalg.norm(approach, axis=1)[:, None]
    aside = np.cross(ahead, random.normal(size=ahead.shape))
    aside /= np.linalg.norm(aside, axis=1)[:, None]
    share = 0.998 * random.random(len(ahead))[:, None]  # the most grazing are left out
    normal: Array = np.sqrt(1.0 - share) * ahead + np.sqrt(share) * aside
    return normal


def cool(
    law: Simulation | None, grains: int, collisions: float, seed: int = 1976
) -> tuple[Array, Array]:
    """Return collisions a grain, and the rotational over the translational temperature."""
    random = np.random.default_rng(seed)
    velocity, spin = random.normal(0.0, SPEED, (grains, 3)), np.zeros((grains, 3))
    velocity -= velocity.mean(axis=0)  # the gas as a whole rests; it would not cool
    done, course, ratio = 0.0, [0.0], [0.0]
    while done < collisions:
        one, other = random.permutation(grains)[: grains - grains % 2].reshape(2, -1)
        approach = velocity[one] - velocity[other]
        speed = np.linalg.norm(approach, axis=1)
        meets = random.random(len(one)) < MOST * speed / speed.max()
        one, other = one[meets], other[meets]
        if not len(one):
            continue
        met = Encounter(
            GRAIN, GRAIN, FRICTION, normal=normals(approach[meets], random),
            velocity=velocity[one], spin=spin[one],
            target_velocity=velocity[other], target_spin=spin[other],
        )  # fmt: skip
        made = collide(met, law) if law else collide(met, restitution=RESTITUTION)
        velocity[one], spin[one] = made.velocity, made.spin
        velocity[other], spin[other] = made.target_velocity, made.target_spin
        done += 2.0 * len(one) / grains
        course.append(done)
        ratio.append(0.4 * GRAIN.radius**2 * (spin**2).sum() / (velocity**2).sum())
    return np.array(course), np.array(ratio)


def main() -> None:
    parser = argparse.ArgumentParser(description="Spin of a cooling granular gas.")
    parser.add_argument("--grains", type=int, default=2000)
    parser.add_argument("--collisions", type=float, default=40.0, help="a grain")
    asked = parser.parse_args()
    gases = {name: cool(law, asked.grains, asked.collisions) for name, law in LAWS.items()}
    print("rotational over translational temperature, mean of the last quarter")
    for name, (course, ratio) in gases.items():
        last = ratio[course > 0.75 * asked.collisions]
        print(f"{name:20s} {last.mean():.2f} ± {last.std():.2f}")

    def draw(axes: Axes) -> None:
        """Draw the ratio over the collisions, each curve with its name."""
        for number, (name, (course, ratio)) in enumerate(gases.items()):
            look = law_style(number)
            axes.plot(course, ratio, **look)
            axes.annotate(
                name, (course[-1], ratio[course > 0.75 * asked.collisions].mean()), (5, 0),
                textcoords="offset points", color=look["color"], va="center",
            )  # fmt: skip
        axes.set(xlabel="collisions of a grain", ylabel=r"$T_{\mathrm{rot}}/T_{\mathrm{tr}}$")
        axes.set_xlim(0.0, 1.33 * asked.collisions)
        axes.set_ylim(bottom=0.0)

    save(Path("granular_gas.png"), draw)


if __name__ == "__main__":
    main()
