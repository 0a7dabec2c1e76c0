"""Cost of a whole step of LAMMPS: a sheared pack of grains, each law against ``mindlin/force``.

A dense pack is made once, then sheared at constant volume by each law in turn, several times; the
least processor time counts.

Examples
--------
  python cost.py --lmp build/lmp --grains 5000
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from engine import SPRINGS, Engine, Grains, arguments, engine, folder, friction, write

YOUNG, MU, RADIUS, FILLED = 1e8, 0.5, 0.01, 0.6
DENSITY, TIME_STEP = 2500.0, 2e-6
LAWS = ("mindlin/force", "springs4", "springs6", "springs8", "springs12")


def model(law: str) -> str:
    """Return the coefficients of a law."""
    return f"hertz/material {YOUNG:g} 0.7 0.3 {friction(law, MU)} damping tsuji"


def settings(style: str, law: str, begin: str) -> str:
    """Return the settings of a run."""
    return f"""
units si
atom_style sphere
boundary p p p
newton off
comm_modify vel yes
{begin}
pair_style {style}
pair_coeff * * {model(law)}
timestep {TIME_STEP:g}
neighbor 0.002 bin
neigh_modify delay 0 every 1 check yes
thermo 100000
"""


def packed(lammps: Engine, count: int, place: Path) -> None:
    """Write a data file of a dense pack: loose grains, pressed together and sheared a little."""
    random = np.random.default_rng(1)
    side = int(np.ceil(count ** (1 / 3)))
    lattice = np.stack(np.meshgrid(*[np.arange(side, dtype=float)] * 3), axis=-1).reshape(-1, 3)[
        :count
    ]
    pitch = 2.25 * RADIUS
    diameter = 2.0 * RADIUS * random.uniform(0.85, 1.15, count)
    grains = Grains(
        np.ones(count, int), diameter, np.full(count, DENSITY), (lattice + 0.5) * pitch,
        random.normal(size=(count, 3)) * 0.3, np.zeros((count, 3)),
    )  # fmt: skip
    write(grains, place / "data", np.zeros(3), np.full(3, side * pitch))
    final = (np.sum(np.pi / 6.0 * diameter**3) / FILLED) ** (1.0 / 3.0)
    script = settings("granular", "mindlin/force", "read_data data")
    script += f"""
fix n all nve/sphere
fix d all deform 1 x final 0 {final:.9g} y final 0 {final:.9g} z final 0 {final:.9g}
run 20000
unfix d
run 2000
write_data pack nocoeff
"""
    lammps.run(script, place)


def seconds(lammps: Engine, law: str, steps: int, place: Path) -> tuple[float, float]:
    """Return processor seconds of the loop on each process, and contacts a grain."""
    style = lammps.pair if law.startswith(SPRINGS) else "granular"
    # A data file has no history: grains begin without a memory.
    script = settings(style, law, "read_data pack\nchange_box all triclinic")
    script += f"""
fix n all nve/sphere
fix d all deform 1 xy erate 20 remap v
compute c all contact/atom
compute m all reduce ave c_c
thermo_style custom step c_m
run {steps // 5}
thermo {steps}
run {steps}
"""
    text = lammps.run(script, place)
    loops = re.findall(r"Loop time of (\S+) on", text)
    contacts = re.findall(r"^ *\d+ +(\S+) *$", text, flags=re.MULTILINE)
    used = re.findall(r"(\S+)% CPU use", text)
    return float(loops[-1]) * float(used[-1]) / 100.0, float(contacts[-1])


def main() -> None:
    """Print ratios."""
    parser = arguments(__doc__)
    parser.add_argument("--grains", type=int, default=5000)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=5)
    given = parser.parse_args()
    lammps = engine(given)
    times: dict[str, list[float]] = {law: [] for law in LAWS}
    contacts = 0.0
    with folder() as name:
        packed(lammps, given.grains, Path(name))
        for _ in range(given.repeats):
            for law in LAWS:
                loop, contacts = seconds(lammps, law, given.steps, Path(name))
                times[law].append(loop)
    print(f"{given.grains} grains, {contacts:.1f} contacts a grain")
    base = min(times[LAWS[0]])
    for law, each in times.items():
        step = min(each) / given.steps
        print(f"{law:15} {1e3 * step:8.3f} ms a step, {min(each) / base:5.2f} of {LAWS[0]}")


if __name__ == "__main__":
    main()
