"""Rotating drum: grains that flow down a heap, and the heap at rest once the drum stops.

Slope of the heap and energies of the grains while the drum turns, by laws of friction, and again
after it has stopped. Each is a mean over independent fillings; its error is that of the mean.

Examples
--------
  python drum.py --lmp build/lmp --grains 2000 --fillings 4
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from engine import Array, Engine, Grains, arguments, engine, folder, friction, write

YOUNG, POISSON, DENSITY, DIAMETER = 1e6, 0.3, 2500.0, 0.005
MU, GRAVITY = 0.5, 9.81
#: Coefficient of LAMMPS's ``tsuji`` for which a head-on impact keeps 0.9 of its speed.
TSUJI = 0.8621
#: Laws by name: the words of LAMMPS's, and the ratio of tangential to normal damping.
LAWS = {
    "mindlin, xt = 0": ("mindlin", 0),
    "mindlin, xt = 1": ("mindlin", 1),
    "springs, xt = 0": ("springs8", 0),
    "springs, xt = 1": ("springs8", 1),
}
RADIUS = 14.0 * DIAMETER  # of the drum
SPIN = 3.5  # rad/s: a Froude number, spin² radius / gravity, of 0.09
TIME_STEP = 3e-5  # a fiftieth of a contact at 0.3 m/s
#: Turns before the mean and within it, and the time from the stop to the end.
BEGUN, TURNED, RESTED = 0.6, 1.0, 1.0
EVERY = 100  # steps between two rows


class Drum(NamedTuple):
    """Rows over time while the drum turns, and after.

    A row has the slope of the heap in degrees, and the energies of translation and of rotation
    of a grain over mass, gravity and diameter.
    """

    turning: Array
    resting: Array


def lattice(count: int) -> tuple[Array, float]:
    """Return the lowest places of a lattice in the drum, and the length of the drum."""
    pitch, length = 1.15 * DIAMETER, 7.0 * DIAMETER * count / 2000.0
    across = np.arange(-RADIUS, RADIUS, pitch)
    along = (np.arange(int(length / pitch)) + 0.5) * length / int(length / pitch)
    places = np.stack(np.meshgrid(across, across, along), axis=-1).reshape(-1, 3)
    places = places[np.hypot(places[:, 0], places[:, 1]) < RADIUS - 0.7 * DIAMETER]
    return places[np.argsort(places[:, 1], kind="stable")][:count], length


def turned(lammps: Engine, law: str, count: int, seed: int) -> Drum:
    """Return what one filling does while the drum turns, and after it stops."""
    random = np.random.default_rng(seed)
    places, length = lattice(count)
    diameter = DIAMETER * random.uniform(0.9, 1.1, count)
    grains = Grains(
        np.ones(count, int), diameter, np.full(count, DENSITY), places,
        random.normal(size=(count, 3)) * 0.1, np.zeros((count, 3)),
    )  # fmt: skip
    turn = 2.0 * np.pi / SPIN
    begun, measured, rest = (
        EVERY * round(time / TIME_STEP / EVERY) for time in (BEGUN * turn, TURNED * turn, RESTED)
    )
    words, damped = LAWS[law]
    ours = words.startswith("springs")
    sub = friction(words, MU).replace("NULL 0", f"NULL {damped}")
    model = f"hertz/material {YOUNG:g} {TSUJI} {POISSON} {sub} damping tsuji"
    mass = DENSITY * np.pi / 6.0 * np.mean(diameter**3)
    unit = count * mass * GRAVITY * DIAMETER
    script = f"""
units si
atom_style sphere
boundary f f p
newton off
comm_modify vel yes
read_data data
pair_style {lammps.pair if ours else "granular"}
pair_coeff * * {model}
timestep {TIME_STEP:g}
neighbor 0.001 bin
neigh_modify delay 0 every 1 check yes
variable angle equal {SPIN}*dt*ternary(step<{begun + measured},step,{begun + measured})
region drum cylinder z 0 0 {RADIUS:g} INF INF side in rotate v_angle 0 0 0 0 0 1
fix w all {lammps.region if ours else "wall/gran/region"} granular {model} region drum
fix g all gravity {GRAVITY} vector 0 -1 0
fix n all nve/sphere
compute t all ke
compute r all erotate/sphere
variable x equal xcm(all,x)
variable y equal xcm(all,y)
variable slope equal atan2(v_x,-v_y)*180/PI
variable t equal c_t/{unit:.9g}
variable r equal c_r/{unit:.9g}
thermo_style custom step v_slope v_t v_r
thermo_modify lost error format float %.9g
thermo {EVERY}
run {begun + measured + rest}
"""
    edge = np.array([RADIUS, RADIUS, 0.0]) * 1.01
    with folder() as name:
        write(grains, Path(name) / "data", -edge, np.array([*edge[:2], length]))
        text = lammps.run(script, Path(name))
    number = r" +(\S+)"
    rows = np.array(re.findall(rf"^ *\d+{number * 3} *$", text, flags=re.MULTILINE), float)
    first, stop = begun // EVERY, (begun + measured) // EVERY
    return Drum(rows[first:stop], rows[stop:])


def numbers(drum: Drum) -> Array:
    """Return what is told of a run: four numbers while it turns, and four of the rest."""
    slope, moved, spun = drum.turning.mean(axis=0)
    energy = drum.resting[:, 1:].sum(axis=1)
    at = [len(energy) // 4, len(energy) // 2, -1]
    return np.array([slope, moved, spun, spun / moved, drum.resting[-1, 0], *energy[at]])


def main() -> None:
    """Print the means with their errors."""
    parser = arguments(__doc__)
    parser.add_argument("--grains", type=int, default=2000)
    parser.add_argument("--fillings", type=int, default=4)
    given = parser.parse_args()
    lammps = engine(given)
    heads = ("slope, deg", "translation", "rotation", "ratio", "heap, deg", "1/4", "1/2", "end")
    print(" " * 16, *(f"{head:>17}" for head in heads))
    for law in LAWS:
        drums = [turned(lammps, law, given.grains, seed) for seed in range(given.fillings)]
        each = np.array([numbers(drum) for drum in drums])
        error = each.std(axis=0, ddof=1) / np.sqrt(given.fillings)
        cells = [f"{m:9.4g} ± {e:5.2g}" for m, e in zip(each.mean(axis=0), error, strict=True)]
        print(f"{law:16}", *(f"{cell:>17}" for cell in cells), flush=True)


if __name__ == "__main__":
    main()
