"""Dense flow: grains in simple shear at constant volume, by laws of friction.

Ratio of shear stress to pressure, and pressure over density (diameter x shear rate)^2, in a
periodic box that is sheared. Each is a mean over the strain after a first part, and over
independent packs; its error is that of the mean over the packs.

Examples
--------
  python dense_flow.py --lmp build/lmp --grains 400 --packs 4 --figure dense_flow.png
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from engine import SPRINGS, Array, Engine, Grains, arguments, engine, folder, friction, write

YOUNG, POISSON, DENSITY, RADIUS = 1e8, 0.3, 2500.0, 0.01
SHEAR_RATE = 5.0
#: Coefficient of LAMMPS's ``tsuji`` for which a head-on impact keeps 0.9 of its speed.
TSUJI = 0.8621
LAWS = ("mindlin/force", "mindlin_rescale/force", "springs8")
SHOWN = (*LAWS[:2], "8 springs")
TIME_STEP = 2e-5  # a fiftieth of a contact at 0.3 m/s, three times shear rate times diameter
#: Strain before the mean, and within it.
BEGUN, SHEARED = 2.0, 8.0
EVERY = 50  # steps between two stresses of the mean


def sheared(lammps: Engine, law: str, mu: float, count: int, seed: int, filled: float) -> Array:
    """Return shear stress over pressure, scaled pressure and contacts a grain of one pack."""
    random = np.random.default_rng(seed)
    side = int(np.ceil(count ** (1 / 3)))
    lattice = np.stack(np.meshgrid(*[np.arange(side, dtype=float)] * 3), axis=-1).reshape(-1, 3)[
        :count
    ]
    pitch = 2.5 * RADIUS
    diameter = 2.0 * RADIUS * random.uniform(0.85, 1.15, count)
    grains = Grains(
        np.ones(count, int), diameter, np.full(count, DENSITY), (lattice + 0.5) * pitch,
        random.normal(size=(count, 3)) * 0.1, np.zeros((count, 3)),
    )  # fmt: skip
    final = (np.sum(np.pi / 6.0 * diameter**3) / filled) ** (1.0 / 3.0)
    steps = [round(strain / SHEAR_RATE / TIME_STEP) for strain in (BEGUN, SHEARED)]
    style = lammps.pair if law.startswith(SPRINGS) else "granular"
    script = f"""
units si
atom_style sphere
boundary p p p
newton off
comm_modify vel yes
read_data data
change_box all triclinic
pair_style {style}
pair_coeff * * hertz/material {YOUNG:g} {TSUJI} {POISSON} {friction(law, mu)} damping tsuji
timestep {TIME_STEP:g}
neighbor 0.004 bin
neigh_modify delay 0 every 1 check yes
fix n all nve/sphere
fix d all deform 1 x final 0 {final:.9g} y final 0 {final:.9g} z final 0 {final:.9g}
thermo 100000
run 10000
unfix d
fix d all deform 1 xy erate {SHEAR_RATE} remap v
compute t all temp/deform
compute p all pressure t
compute c all contact/atom
compute m all reduce ave c_c
run {steps[0]}
variable p equal (c_p[1]+c_p[2]+c_p[3])/3
variable s equal -c_p[4]
thermo_style custom step v_p v_s c_m
thermo {EVERY}
run {steps[1]}
"""
    with folder() as name:
        write(grains, Path(name) / "data", np.zeros(3), np.full(3, side * pitch))
        text = lammps.run(script, Path(name))
    rows = re.findall(r"^ *\d+ +(\S+) +(\S+) +(\S+) *$", text, flags=re.MULTILINE)
    sampled = np.array(rows[-(steps[1] // EVERY) :], float)
    pressure, shear, contacts = sampled.mean(axis=0)
    unit = DENSITY * (2.0 * RADIUS * SHEAR_RATE) ** 2
    return np.array([shear / pressure, pressure / unit, contacts])


def main() -> None:
    """Print the means with their errors, and draw them."""
    parser = arguments(__doc__)
    parser.add_argument("--grains", type=int, default=400)
    parser.add_argument("--packs", type=int, default=4)
    parser.add_argument("--mu", type=float, nargs="+", default=[0.1, 0.3, 0.5])
    parser.add_argument("--filled", type=float, default=0.59, help="share of the box")
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args()
    lammps = engine(given)
    found: dict[float, dict[str, Array]] = {}
    print(f"{'mu':>4} {'law':24} {'stress ratio':>16} {'pressure':>16} {'contacts':>16}")
    for mu in given.mu:
        found[mu] = {}
        for law in LAWS:
            packs = range(given.packs)
            each = np.array(
                [sheared(lammps, law, mu, given.grains, seed, given.filled) for seed in packs]
            )
            error = each.std(axis=0, ddof=1) / np.sqrt(given.packs)
            found[mu][law] = np.array([each.mean(axis=0), error])
            cells = " ".join(f"{m:8.4g} ± {e:5.2g}" for m, e in found[mu][law].T)
            print(f"{mu:4g} {law:24} {cells}", flush=True)
    if given.figure:
        draw(found, given.figure)


def draw(found: dict[float, dict[str, Array]], path: Path) -> None:
    """Draw stress ratio and pressure over the friction coefficient, laws side by side."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import LogLocator

    from contactlab.outcome.style import law_style, styled

    names = ("shear stress over pressure", r"pressure over $\rho\,(d\,\dot\gamma)^2$")
    with styled("print", "two"):
        figure, panels = plt.subplots(1, 2, figsize=(7.0, 2.8))
        for column, (axes, name) in enumerate(zip(panels, names, strict=True)):
            for number, (law, shown) in enumerate(zip(LAWS, SHOWN, strict=True)):
                means, errors = np.array([rows[law][:, column] for rows in found.values()]).T
                place = np.arange(len(found)) + 0.18 * (number - 1)
                look = {"color": law_style(number)["color"], "marker": "os^"[number]}
                axes.errorbar(place, means, errors, ls="", ms=4, capsize=3, label=shown, **look)
            axes.set(xlabel=r"friction coefficient $\mu$", ylabel=name)
            axes.set_xticks(range(len(found)), [f"{mu:g}" for mu in found])
        panels[1].set_yscale("log")
        panels[1].yaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
        panels[1].yaxis.set_major_formatter("{x:g}")
        panels[1].yaxis.set_minor_formatter("")
        panels[0].legend(loc="lower right")
        figure.savefig(path)


if __name__ == "__main__":
    main()
