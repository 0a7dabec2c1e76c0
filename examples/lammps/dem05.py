"""Oblique impacts on a wall, LAMMPS's benchmark DEM-05, from partial slip to gross slip.

The spin after the impact by each tangential sub-model, beside contactlab with the same restitution
and its loss shared by pressure and shear: errors in per cent. Then the restitution that a damping
makes of its coefficient. The input script is ``in.oblique``.

Examples
--------
  python dem05.py --lmp build/lmp
  python dem05.py --lmp lmp --plugin build/springsplugin.so
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from engine import Array, Engine, arguments, engine, folder

from contactlab import Encounter, HalfSpace, Material, Simulation, Sphere, collide, create

DECK = Path(__file__).resolve().parent / "in.oblique"
SLIPS = np.array([0.2, 0.4, 0.7, 1.0, 4.0, 6.0])
MU = 0.3
LAWS = {
    name: f"{name} NULL 0.0 {MU}" for name in ("mindlin", "mindlin/force", "mindlin_rescale/force")
} | {
    "springs8, elastic": f"mindlin_springs NULL 0.0 {MU} 8",
    "springs8": f"mindlin_springs NULL NULL {MU} 8",
}


def exact(restitution: float, springs: int = 400) -> Array:
    """Return velocities along and up, and spins, shape (n, 3), by contactlab."""
    material = Material(young_modulus=1e5, poisson_ratio=0.3, density=1.0)
    sphere, wall = Sphere(0.5, material), HalfSpace(material)
    velocity = np.stack([SLIPS, 0.0 * SLIPS, -1.0 + 0.0 * SLIPS], axis=-1)
    met = Encounter(sphere, wall, MU, normal=[0, 0, -1], velocity=velocity)
    simulation = None
    if restitution < 1.0:
        simulation = Simulation(
            normal=create("normal.tsuji", restitution=restitution),
            tangential=create("tangential.springs", springs=springs),
        )
    made = collide(met, simulation)
    return np.stack([made.velocity[:, 0], made.velocity[:, 2], made.spin[:, 1]], axis=-1)


def in_lammps(
    lammps: Engine,
    law: str,
    coefficient: float,
    *,
    damping: str = "coeff_restitution",
    step: float = 2e-4,
) -> Array:
    """Return velocities along and up, and spins, shape (n, 3), in LAMMPS."""
    given = {"pair": lammps.pair, "wall": lammps.wall, "law": f'"{law}"'}
    given |= {"e": f"{coefficient}", "damping": damping, "dt": f"{step}"}
    head = "".join(f"variable {name} index {value}\n" for name, value in given.items())
    with folder() as name:
        lammps.run(head + DECK.read_text("utf-8"), Path(name))
        lines = (Path(name) / "out.oblique").read_text().splitlines()
    return np.array([line.split()[1:] for line in lines[-len(SLIPS) :]], dtype=float)


def main() -> None:
    """Print a table for each restitution."""
    given = arguments(__doc__).parse_args()
    lammps = engine(given)
    for restitution in (1.0, 0.9):
        true = exact(restitution)
        print(f"\n{f'e = {restitution}: vx':22}" + "".join(f"{slip:9.1f}" for slip in SLIPS))
        print(f"{'exact spin':22}" + "".join(f"{spin:9.4f}" for spin in true[:, 2]))
        for name, law in LAWS.items():
            error = 100.0 * (in_lammps(lammps, law, restitution)[:, 2] / true[:, 2] - 1.0)
            print(f"{name:22}" + "".join(f"{each:+8.1f}%" for each in error))
    print("\nrestitution of a coefficient, in steps of 2e-4 and 2e-5")
    for damping, coefficient in (("coeff_restitution", 0.9), ("tsuji", 0.9), ("tsuji", 0.8621)):
        made = [
            in_lammps(lammps, LAWS["mindlin"], coefficient, damping=damping, step=step)[0, 1]
            for step in (2e-4, 2e-5)
        ]
        print(f"{damping:20}{coefficient:8}" + "".join(f"{each:9.5f}" for each in made))


if __name__ == "__main__":
    main()
