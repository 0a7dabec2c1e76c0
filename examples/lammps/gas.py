"""A freely cooling granular gas: rotational over translational temperature, by laws of friction.

LAMMPS under each law, beside direct simulation (pairs drawn at random, each collision by
``contactlab.collide``). The ratio is the mean over the cooling from exp(-1) to exp(-3.5) of the
first energy; its error is that of the mean over independent gases.

Examples
--------
  python gas.py --lmp build/lmp --grains 1000 --gases 4 --figure gas.png
"""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

import numpy as np
from engine import SPRINGS, Array, Engine, Grains, arguments, engine, folder, friction, write

import contactlab
from contactlab import Encounter, Material, Sphere

YOUNG, POISSON, DENSITY, RADIUS = 2e9, 0.3, 2500.0, 0.01
FILLED, RESTITUTION = 0.1, 0.9
#: Coefficient of LAMMPS's ``tsuji`` for which a head-on impact keeps 0.9 of its speed.
TSUJI = 0.8621
LAWS = ("mindlin/force", "mindlin_rescale/force", "springs8")
SHOWN = (*LAWS[:2], "8 springs")
#: Logarithms of the first energy over the energy between which the ratio is averaged.
COOLED = (1.0, 3.5)
TIME_STEP = 4e-6  # a fiftieth of a contact at 0.5 m/s


def beginning(count: int, seed: int) -> tuple[Array, Array]:
    """Return velocities and spins, shape (count, 3), of temperatures in the ratio 0.7."""
    random = np.random.default_rng(seed)
    velocity = random.normal(size=(count, 3)) * 0.5
    velocity -= velocity.mean(axis=0)
    spin = random.normal(size=(count, 3)) * 0.5 * np.sqrt(0.7 / 0.4) / RADIUS
    return velocity, spin


def cooled(energy: Array, ratio: Array) -> float:
    """Return the mean ratio over the part of the cooling that counts."""
    fallen = np.log(energy[0] / energy)
    return float(ratio[(fallen >= COOLED[0]) & (fallen <= COOLED[1])].mean())


def in_lammps(lammps: Engine, law: str, mu: float, count: int, seed: int) -> float:
    """Return the ratio of one gas in LAMMPS."""
    velocity, spin = beginning(count, seed)
    side = int(np.ceil(count ** (1 / 3)))
    length = (count * 4.0 / 3.0 * np.pi * RADIUS**3 / FILLED) ** (1 / 3)
    lattice = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3)[:count]
    every = np.full(count, 1.0)
    place = (lattice + 0.5) * length / side
    grains = Grains(
        np.ones(count, int), 2.0 * RADIUS * every, DENSITY * every, place, velocity, spin
    )
    mass = DENSITY * 4.0 / 3.0 * np.pi * RADIUS**3
    first = 0.5 * mass * np.sum(velocity**2)
    style = lammps.pair if law.startswith(SPRINGS) else "granular"
    script = f"""
units si
atom_style sphere
boundary p p p
newton off
comm_modify vel yes
read_data data
pair_style {style}
pair_coeff * * hertz/material {YOUNG:g} {TSUJI} {POISSON} {friction(law, mu)} damping tsuji
fix n all nve/sphere
timestep {TIME_STEP:g}
neighbor 0.008 bin
neigh_modify delay 0 every 10 check yes
compute k all ke
compute r all erotate/sphere
variable k equal c_k
fix h all halt 1000 v_k < {first * np.exp(-COOLED[1]):.9g} error continue
thermo_style custom step c_k c_r
thermo_modify format float %.9g
thermo 1000
run 5000000
"""
    with folder() as name:
        write(grains, Path(name) / "data", np.zeros(3), np.full(3, length))
        text = lammps.run(script, Path(name))
    rows = re.findall(r"^ *(\d+) +(\S+) +(\S+) *$", text, flags=re.MULTILINE)
    _, moving, turning = np.array(rows, float).T
    return cooled(moving, turning / moving)


def direct(mu: float, count: int, seed: int) -> float:
    """Return the ratio of one gas by direct simulation with the exact collision operator."""
    random = np.random.default_rng(seed)
    velocity, spin = beginning(count, seed)
    material = Material(young_modulus=YOUNG, poisson_ratio=POISSON, density=DENSITY)
    ball = Sphere(RADIUS, material)
    energy: list[float] = []
    ratio: list[float] = []
    while not energy or energy[0] / energy[-1] < np.exp(COOLED[1]):
        energy.append(np.sum(velocity**2))
        ratio.append(0.4 * RADIUS**2 * np.sum(spin**2) / energy[-1])
        first, second = random.permutation(count)[: count // 2 * 2].reshape(2, -1)
        normal = random.normal(size=(len(first), 3))
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        approach = np.sum((velocity[first] - velocity[second]) * normal, axis=1)
        meet = approach > random.uniform(0.0, 6.0 * np.sqrt(energy[-1] / count), len(first))
        if not meet.any():
            continue
        first, second = first[meet], second[meet]
        after = contactlab.collide(
            Encounter(
                ball, ball, mu, normal=normal[meet],
                velocity=velocity[first], spin=spin[first],
                target_velocity=velocity[second], target_spin=spin[second],
            ),
            restitution=RESTITUTION,
        )  # fmt: skip
        velocity[first], velocity[second] = after.velocity, after.target_velocity
        spin[first], spin[second] = after.spin, after.target_spin
    return cooled(np.array(energy), np.array(ratio))


def main() -> None:
    """Print the ratios with their errors, and draw them."""
    parser = arguments(__doc__)
    parser.add_argument("--grains", type=int, default=1000)
    parser.add_argument("--gases", type=int, default=4)
    parser.add_argument("--mu", type=float, nargs="+", default=[1.0])
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args()
    lammps = engine(given)
    found: dict[float, dict[str, tuple[float, float]]] = {}
    for mu in given.mu:
        print(f"mu = {mu}")
        gases = {"direct": partial(direct, mu, 10 * given.grains)}
        for law in LAWS:
            gases[law] = partial(in_lammps, lammps, law, mu, given.grains)
        found[mu] = {}
        for name, gas in gases.items():
            ratios = np.array([gas(seed) for seed in range(given.gases)])
            error = ratios.std(ddof=1) / np.sqrt(len(ratios))
            found[mu][name] = float(ratios.mean()), float(error)
            print(f"  {name:24} {ratios.mean():.3f} ± {error:.3f}", flush=True)
    if given.figure:
        draw(found, given.figure)


def draw(found: dict[float, dict[str, tuple[float, float]]], path: Path) -> None:
    """Draw the ratios, one column for each friction coefficient."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    from contactlab.outcome.style import QUIET, law_style, styled

    with styled("print", "two"):
        figure, panels = plt.subplots(1, len(found), figsize=(7.0, 2.2), squeeze=False)
        for axes, (mu, rows) in zip(panels[0], found.items(), strict=True):
            exact, error = rows["direct"]
            axes.axvspan(exact - error, exact + error, color="0.87", lw=0)
            axes.axvline(exact, color=QUIET, lw=1.0)
            axes.annotate(
                "direct simulation ", (exact - error, 1.0), xycoords=("data", "axes fraction"),
                ha="right", va="top", color="#555555", fontsize="small",
            )  # fmt: skip
            for place, name in enumerate(LAWS):
                look = {"color": law_style(place)["color"], "marker": "os^"[place]}
                axes.errorbar(rows[name][0], place, xerr=rows[name][1], ms=5, capsize=3, **look)
            axes.set_yticks(range(len(LAWS)), SHOWN if axes is panels[0, 0] else [""] * len(LAWS))
            axes.set_ylim(len(LAWS) - 0.5, -0.8)
            axes.set_xlabel("rotational over translational temperature")
            axes.set_title(rf"$\mu$ = {mu:g}", fontsize="medium")
        figure.savefig(path)


if __name__ == "__main__":
    main()
