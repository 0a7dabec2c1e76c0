"""Impacts in LAMMPS against the exact rebound: spheres on a wall, pairs of unlike spheres in space.

For each law: the largest and the rms error of psi2 over psi1 up to 4 chi, Poisson's ratios 0, 0.3
and 0.49 (chi from 1.18 to 1.75) and ten sizes of the largest contact between two powers of two of
the radius. Impacts are elastic.

Examples
--------
  python rebounds.py --lmp build/lmp
  python rebounds.py --lmp "mpirun -np 2 build/lmp" --save two.npz
  python rebounds.py --lmp venv/bin/lmp --plugin plug/springsplugin.so
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from engine import (
    DUMP,
    OWN,
    SPRINGS,
    Array,
    Engine,
    Grains,
    arguments,
    engine,
    folder,
    friction,
    read,
    write,
)

import contactlab
from contactlab import Encounter, Material, Sphere

YOUNG, MU = 1e9, 0.3
POISSON = (0.0, 0.3, 0.49)
SIZES = 0.005 * 2.0 ** np.linspace(0.0, 1.0, 10, endpoint=False)  # largest contact radius over R
ANGLES = 40
DURATION = 1e-4  # of every contact, in s
#: Time to meet and to part, in durations.
BEFORE, AFTER = 0.1, 0.2


def motion(size: Array, radius: Array, poisson: float) -> tuple[Array, Array]:
    """Return speed and normal mass for which the contact grows to ``size`` and lasts DURATION."""
    modulus = YOUNG / (2.0 * (1.0 - poisson**2))
    overlap = size**2 * radius
    speed = 2.9432751843 * overlap / DURATION
    return speed, 16.0 * modulus * np.sqrt(radius) * overlap**2.5 / (15.0 * speed**2)


def settings(poisson: float) -> tuple[Array, Array, float]:
    """Return psi1 and size of each impact, shape (n,), and kappa."""
    kappa = 2.0 * (1.0 - poisson) / (2.0 - poisson)
    psi1 = np.linspace(0.02, 4.0 * 1.75 * kappa + 0.3, ANGLES)
    psi1, size = (each.ravel() for each in np.meshgrid(psi1, SIZES))
    return psi1, size, kappa


def script(law: str, poisson: float, style: str, wall: str, steps: int, newton: str) -> str:
    """Return the input of one run."""
    model = f"hertz/material {YOUNG:.17g} 0 {poisson} {friction(law, MU)} damping velocity"
    fix = f"fix w all {wall} granular {model} zplane 0 NULL" if wall else ""
    count = int(steps * (1.0 + BEFORE + AFTER)) + 3
    return f"""
units si
atom_style sphere
boundary f f f
newton {newton}
comm_modify vel yes
read_data data
pair_style {style}
pair_coeff * * {model}
{fix}
fix n all nve/sphere
timestep {DURATION / steps:.17g}
neighbor 0.002 bin
neigh_modify delay 0 every 1 check yes
thermo {count}
{DUMP.format(every=count)}
run {count}
"""


def rows(count: int, pitch: float) -> Array:
    """Return places on a square lattice in the plane z = 0, shape (count, 3)."""
    side = int(np.ceil(np.sqrt(count)))
    place = np.arange(count, dtype=float)
    return pitch * np.stack([place % side, place // side, 0.0 * place], axis=1)


def solved(
    lammps: Engine, law: str, grains: Grains, poisson: float, wall: str, steps: int, newton: str
) -> Array:
    """Return velocities and spins after the impacts, shape (n, 6)."""
    style = lammps.pair if law.startswith(SPRINGS) else "granular"
    low, high = grains.position.min(axis=0) - 0.1, grains.position.max(axis=0) + 0.1
    if wall:
        low[2] = 0.0
    with folder() as name:
        write(grains, Path(name) / "data", low, high)
        lammps.run(script(law, poisson, style, wall, steps, newton), Path(name))
        return read(Path(name) / "out")


def on_a_wall(
    lammps: Engine, law: str, poisson: float, steps: int, newton: str
) -> tuple[Array, Array]:
    """Return the errors of psi2 of spheres on a wall, and all velocities."""
    psi1, size, kappa = settings(poisson)
    radius = 0.01
    speed, mass = motion(size, np.full_like(size, radius), poisson)
    count = len(psi1)
    wait = np.random.default_rng(1).uniform(0.2, 1.0, count) * BEFORE * DURATION
    place = rows(count, 0.05)
    place[:, 2] = radius + speed * wait
    slip = psi1 * MU * speed / kappa
    zero = 0.0 * slip
    share = np.random.default_rng(2).uniform(0.0, 1.0, count)  # of the slip that is spin
    velocity = np.stack([slip * (1.0 - share), zero, -speed], axis=1)
    spin = np.stack([zero, -slip * share / radius, zero], axis=1)  # slip: v_x - omega_y R
    density = mass / (4.0 / 3.0 * np.pi * radius**3)
    kind = np.ones(count, int)
    grains = Grains(kind, np.full(count, 2.0 * radius), density, place, velocity, spin)
    wall = lammps.wall if law.startswith(SPRINGS) else "wall/gran"
    after = solved(lammps, law, grains, poisson, wall, steps, newton)
    assert np.allclose(after[:, 2], speed, rtol=5e-3), "an impact is not over, or lost energy"
    psi2 = kappa * (after[:, 0] - after[:, 4] * radius) / (MU * speed)
    return psi2 - contactlab.rebound(psi1, 1.75 * kappa), after


def in_space(
    lammps: Engine, law: str, poisson: float, steps: int, newton: str
) -> tuple[Array, Array]:
    """Return the sizes of the errors of psi2 of pairs of unlike spheres, and all velocities."""
    psi1, size, kappa = settings(poisson)
    random, count = np.random.default_rng(3), len(psi1)
    radii = random.uniform(0.005, 0.015, (2, count))
    pair = radii[0] * radii[1] / radii.sum(axis=0)
    speed, normal_mass = motion(size, pair, poisson)
    density = random.uniform(0.3, 3.0, (2, count))
    masses = density * radii**3
    density *= normal_mass * masses.sum(axis=0) / masses.prod(axis=0) / (4.0 / 3.0 * np.pi)
    normal = random.normal(size=(count, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    along = np.cross(normal, random.normal(size=(count, 3)))
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    spins = random.normal(size=(2, count, 3)) * (speed / pair)[:, None] * 0.3
    # The slip of the first sphere on the second is psi1 along ``along``, spins included.
    turning = np.cross(radii[0, :, None] * spins[0] + radii[1, :, None] * spins[1], normal)
    slip = (psi1 * MU * speed / kappa)[:, None] * along
    relative = speed[:, None] * normal + slip - turning
    share = random.uniform(0.2, 0.8, (count, 1))
    velocities = np.stack([share * relative, (share - 1.0) * relative])
    wait = random.uniform(0.2, 1.0, count) * BEFORE * DURATION
    first = rows(count, 0.08)
    apart = radii.sum(axis=0)[:, None] * normal + wait[:, None] * relative
    # They touch at ``wait``, with the normal that was drawn.
    grains = Grains(
        np.ones(2 * count, int),
        2.0 * radii.ravel(),
        density.ravel(),
        np.concatenate([first, first + apart]),
        velocities.reshape(-1, 3),
        spins.reshape(-1, 3),
    )
    after = solved(lammps, law, grains, poisson, "", steps, newton)
    spheres = [
        Sphere(radii[k], Material(young_modulus=YOUNG, poisson_ratio=poisson, density=density[k]))
        for k in (0, 1)
    ]
    met = Encounter(
        spheres[0], spheres[1], MU, normal=normal, velocity=velocities[0], spin=spins[0],
        target_velocity=velocities[1], target_spin=spins[1],
    )  # fmt: skip
    exact = contactlab.collide(met)
    found = after.reshape(2, count, 6)

    def psi(velocity: Array, spin: Array, target: Array, target_spin: Array) -> Array:
        turning = np.cross(radii[0, :, None] * spin + radii[1, :, None] * target_spin, normal)
        moved = velocity - target + turning
        moved -= np.sum(moved * normal, axis=1, keepdims=True) * normal
        return (kappa / (MU * speed))[:, None] * moved

    mine = psi(found[0, :, :3], found[0, :, 3:], found[1, :, :3], found[1, :, 3:])
    exactly = psi(exact.velocity, exact.spin, exact.target_velocity, exact.target_spin)
    return np.linalg.norm(mine - exactly, axis=1), after


def main() -> None:
    """Print a table of errors."""
    parser = arguments(__doc__)
    parser.add_argument("--laws", nargs="+", default=[*OWN, "springs4", "springs8", "springs12"])
    parser.add_argument("--steps", type=int, default=50, help="steps a contact")
    parser.add_argument("--newton", choices=("on", "off"), default="off")
    parser.add_argument("--save", type=Path, help="velocities, to compare two runs")
    given = parser.parse_args()
    lammps = engine(given)
    kept: dict[str, Any] = {}
    print(f"{'law':24} {'wall: worst':>12} {'rms':>8} {'pairs: worst':>14} {'rms':>8}")
    for law in given.laws:
        cells = []
        for way in (on_a_wall, in_space):
            answers = [way(lammps, law, nu, given.steps, given.newton) for nu in POISSON]
            error = np.concatenate([each[0] for each in answers])
            kept[f"{law} {way.__name__}"] = np.concatenate([each[1] for each in answers])
            cells += [np.abs(error).max(), np.sqrt(np.mean(error**2))]
        print(
            f"{law:24} {cells[0]:12.3f} {cells[1]:8.3f} {cells[2]:14.3f} {cells[3]:8.3f}",
            flush=True,
        )
    if given.save:
        np.savez(given.save, **kept)


if __name__ == "__main__":
    main()
