"""Rotating drum: grains that flow down a heap, and the heap at rest once the drum stops.

Slope of the heap and energies of the grains while the drum turns, by laws of friction, and again
after it has stopped. Each is a mean over independent fillings; its error is that of the mean.

Examples
--------
  python drum.py --lmp build/lmp --grains 2000 --fillings 4 --figure drum.png
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
    """Rows over time while the drum turns, and after; places (n, 2) and diameters at the end.

    A row has the slope of the heap in degrees, and the energies of translation and of rotation
    of a grain over mass, gravity and diameter.
    """

    turning: Array
    resting: Array
    place: Array
    diameter: Array


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
write_dump all custom out x y z diameter modify sort id format float %.9g
"""
    edge = np.array([RADIUS, RADIUS, 0.0]) * 1.01
    with folder() as name:
        write(grains, Path(name) / "data", -edge, [*edge[:2], length])
        text = lammps.run(script, Path(name))
        lines = (Path(name) / "out").read_text().splitlines()
    last = np.loadtxt(lines[lines.index("ITEM: ATOMS x y z diameter") + 1 :])
    number = r" +(\S+)"
    rows = np.array(re.findall(rf"^ *\d+{number * 3} *$", text, flags=re.MULTILINE), float)
    first, stop = begun // EVERY, (begun + measured) // EVERY
    return Drum(rows[first:stop], rows[stop:], last[:, :2], last[:, 3])


def numbers(drum: Drum) -> Array:
    """Return what is told of a run: four numbers while it turns, and four of the rest."""
    slope, moved, spun = drum.turning.mean(axis=0)
    energy = drum.resting[:, 1:].sum(axis=1)
    at = [len(energy) // 4, len(energy) // 2, -1]
    return np.array([slope, moved, spun, spun / moved, drum.resting[-1, 0], *energy[at]])


def draw(found: dict[str, list[Drum]], path: Path) -> None:
    """Draw the heap at rest, its slope before and after the stop, and the energy that is left."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.collections import EllipseCollection

    from contactlab.figures.style import QUIET, law_style, styled

    with styled("print", "two"):
        figure, (heap, slope, energy) = plt.subplots(
            1, 3, figsize=(7.0, 2.6), width_ratios=(1.0, 1.1, 1.4)
        )
        last = found["springs, xt = 1"][0]
        size = last.diameter / DIAMETER
        heap.add_collection(
            EllipseCollection(
                size, size, 0.0 * size, units="xy", offsets=last.place / DIAMETER,
                transOffset=heap.transData, facecolor="0.8", edgecolor="0.4", lw=0.3,
            )
        )  # fmt: skip
        heap.add_patch(plt.Circle((0.0, 0.0), RADIUS / DIAMETER, fill=False, color=QUIET))
        heap.set(xlim=(-15, 15), ylim=(-15, 15), aspect="equal", title="at rest, springs")
        heap.axis("off")
        for number, (law, drums) in enumerate(found.items()):
            look = {"color": law_style(number)["color"], "marker": "os^D"[number]}
            each = np.array([numbers(drum) for drum in drums])
            errors = each.std(axis=0, ddof=1) / np.sqrt(len(drums))
            slope.errorbar(
                [0.0 + 0.1 * number, 1.0 + 0.1 * number], each.mean(axis=0)[[0, 4]], errors[[0, 4]],
                ls="", ms=4, capsize=3, **look,
            )  # fmt: skip
            left = np.array([drum.resting[:, 1:].sum(axis=1) for drum in drums])
            time = EVERY * TIME_STEP * np.arange(left.shape[1])
            energy.semilogy(time, left.mean(axis=0), lw=1.0, color=look["color"], label=law)
        slope.set(title="slope of the heap, degrees", ylim=(0.0, 35.0), xlim=(-0.3, 1.6))
        slope.set_xticks([0.15, 1.15], ["turning", "at rest"])
        energy.set(title="energy over m g d of a grain", xlabel="time from the stop (s)")
        energy.legend(fontsize="small")
        figure.savefig(path)


def main() -> None:
    """Print the means with their errors, and draw them."""
    parser = arguments(__doc__.splitlines()[0])
    parser.add_argument("--grains", type=int, default=2000)
    parser.add_argument("--fillings", type=int, default=4)
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args()
    lammps = engine(given)
    found: dict[str, list[Drum]] = {}
    heads = ("slope, deg", "translation", "rotation", "ratio", "heap, deg", "1/4", "1/2", "end")
    print(" " * 16, *(f"{head:>17}" for head in heads))
    for law in LAWS:
        found[law] = [turned(lammps, law, given.grains, seed) for seed in range(given.fillings)]
        each = np.array([numbers(drum) for drum in found[law]])
        error = each.std(axis=0, ddof=1) / np.sqrt(given.fillings)
        cells = [f"{m:9.4g} ± {e:5.2g}" for m, e in zip(each.mean(axis=0), error, strict=True)]
        print(f"{law:16}", *(f"{cell:>17}" for cell in cells), flush=True)
    if given.figure:
        draw(found, given.figure)


if __name__ == "__main__":
    main()
