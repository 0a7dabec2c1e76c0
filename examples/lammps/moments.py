"""Moments of LAMMPS's grains in one elastic impact on a wall: torsion and rolling.

Torsion: a ball that spins about the normal alone, under ``twisting marshall`` beside ``tangential
mindlin``, in SI and in cgs units, beside contactlab: sigma2 over sigma1. Rolling: a ball that rolls
freely keeps its velocity of 1 m/s in an elastic contact; what ``rolling sds`` leaves of it.

Examples
--------
  python moments.py --lmp lmp        # LAMMPS as it is: no plug-in is needed
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from engine import DUMP, Array, Engine, arguments, engine, folder, read

from contactlab import Encounter, HalfSpace, Material, Simulation, Sphere, collide

RADIUS, NU, DENSITY, MU = 0.025, 0.3, 7800.0, 0.8
#: A metre, and a kilogram per cubic metre.
UNITS = {"si": (1.0, 1.0), "cgs": (100.0, 1e-3)}
SIGMAS = np.array([0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0])
#: ``rolling sds``: stiffness and coefficient.
ROLLING = ((1e6, 0.01), (1e8, 0.1))
STEPS = 4000

DECK = """
units {units}
atom_style sphere
boundary f f f
comm_modify vel yes
region box block 0 {box} 0 {box} 0 {box} units box
create_box 1 box
create_atoms 1 single {middle} {middle} {height} units box
set group all diameter {diameter} density {density}
set group all omega 0 {roll} {turn}
velocity all set {along} 0 {down}
pair_style granular
pair_coeff * * hertz/material {law}
neighbor {skin} bin
fix move all nve/sphere
fix floor all wall/gran granular hertz/material {law} zplane 0 NULL
timestep {step}
thermo 1000000
run {steps}
"""


def young(contact: float) -> float:
    """Return Young's modulus for a largest contact of ``contact`` radii at 1 m/s."""
    return 2.5 * (1.0 - NU**2) * np.pi * DENSITY / contact**5


def in_lammps(
    lammps: Engine, units: str, contact: float, moment: str, along: float = 0.0, turn: float = 0.0
) -> Array:
    """Return velocity and spin in SI, shape (6,), after an impact at 1 m/s of a ball that rolls."""
    metre, dense = UNITS[units]
    modulus = young(contact) * dense * metre**2
    length, gap, time = RADIUS * metre, 1e-4 * RADIUS, 2.9432 * contact**2 * RADIUS
    given = {
        "units": units,
        "law": f"{modulus} 1.0 {NU} tangential mindlin NULL 0 {MU} {moment} "
        "damping coeff_restitution",
        "box": 10 * length,
        "middle": 5 * length,
        "height": (RADIUS + gap) * metre,
        "diameter": 2 * length,
        "density": DENSITY * dense,
        "roll": along / RADIUS,
        "turn": turn,
        "along": along * metre,
        "down": -metre,
        "skin": length,
        "step": time / STEPS,
        "steps": round(STEPS * (1.2 + gap / time)),
    }
    with folder() as name:
        lammps.run(DECK.format(**given) + DUMP.format(every=1) + "run 0\n", Path(name))
        made = read(Path(name) / "out")[0]
    return np.concatenate([made[:3] / metre, made[3:]])


def torsion(lammps: Engine) -> None:
    """Print sigma2 over sigma1 of spins about the normal."""
    for contact in (0.1, 0.3):
        turns = SIGMAS * MU / ((1.0 - NU) * contact * RADIUS)
        material = Material(young_modulus=young(contact), poisson_ratio=NU, density=DENSITY)
        spins = np.stack([0.0 * turns, 0.0 * turns, turns], axis=-1)
        met = Encounter(
            Sphere(RADIUS, material), HalfSpace(material), MU,
            normal=[0, 0, -1], velocity=[0, 0, -1], spin=spins,
        )  # fmt: skip
        exact = collide(met, Simulation(tangential="halfspace")).spin[:, 2] / turns
        print(f"\n{f'contact {contact} radii, sigma1':30}" + "".join(f"{s:8.2f}" for s in SIGMAS))
        print(f"{'contactlab':30}" + "".join(f"{each:8.3f}" for each in exact))
        for units in UNITS:
            found = [
                in_lammps(lammps, units, contact, "twisting marshall", turn=turn)[5] / turn
                for turn in turns
            ]
            print(f"{f'twisting marshall, {units}':30}" + "".join(f"{each:8.3f}" for each in found))


def rolling(lammps: Engine) -> None:
    """Print the velocity of a steel ball that rolls freely, after its impact."""
    print("\nvelocity of a ball that rolls at 1 m/s")
    for moment in ("", *(f"rolling sds {k:g} 0 {mu}" for k, mu in ROLLING)):
        made = in_lammps(lammps, "si", 0.05, moment, along=1.0)
        print(f"{moment or 'none':30}{made[0]:8.3f}")


def main() -> None:
    """Print both tables."""
    lammps = engine(arguments(__doc__).parse_args())
    torsion(lammps)
    rolling(lammps)


if __name__ == "__main__":
    main()
