"""Damped impacts on a wall in LAMMPS, against one loss for pressure and shear.

For each law: the largest and the rms error of psi2 at e = 0.7441 (Tsuji's damping), chi = 49/34,
six psi1 from stick to gross slip and ten sizes of the largest contact between two powers of two of
the radius. Springs with loss are followed by the kernel alone too, along the same steps.

Examples
--------
  python loss.py --lmp build/lmp
  python loss.py --lmp venv/bin/lmp --plugin plug/springsplugin.so --steps 200
"""

from __future__ import annotations

import ctypes
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
from engine import DUMP, SPRINGS, Array, Engine, Grains, arguments, engine, folder, friction, read
from engine import write as written
from numpy.polynomial import Polynomial
from rebounds import AFTER, BEFORE, DURATION, MU, SIZES, YOUNG, motion, rows

POISSON = 0.3
KAPPA = 2.0 * (1.0 - POISSON) / (2.0 - POISSON)
RADIUS = 0.01
#: Theory, P = zeta^1.5 + 0.2 zeta^0.25 V and shear that shares its loss: psi2 by psi1.
PSI2 = {0.5: -0.04377, 1.0: -0.13498, 2.0: -0.59223, 3.0: -0.99929, 4.0: -0.94568, 8.0: 2.97295}
ALPHA = 0.2 * np.sqrt(1.25)  # of Tsuji's damping, alpha sqrt(m k) delta^(1/4)
#: alpha by the coefficient that LAMMPS takes in its place.
TSUJI = Polynomial([1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218])
LAWS = ("mindlin 0", "mindlin 1", "springs8", "lossy4", "lossy8", "lossy12", "lossy50")
STEP = """
#include "contactlab_springs.h"
double springs_step(double *state, int n, const double *moved, const double *normal, double radius,
                    double limit, double unit, double modulus, double *force, double elastic,
                    double damping, const double *velocity, double time)
{
  return contactlab_springs_damped_step(state, n, moved, normal, radius, limit, unit, modulus,
                                        force, elastic, damping, velocity, time);
}
"""


class Wall(NamedTuple):
    """What spheres meet: their radius, Young's modulus of both, friction, Tsuji's damping.

    ``limited``: the damping makes no normal force that pulls.
    """

    radius: float
    young: float
    mu: float
    alpha: float
    limited: bool


def coefficient() -> float:
    """Return the coefficient from which LAMMPS's ``tsuji`` makes ALPHA."""
    roots = (TSUJI - ALPHA).roots()
    return float(next(each.real for each in roots if abs(each.imag) < 1e-9 and 0 < each.real < 1))


def settings() -> tuple[Array, Array]:
    """Return psi1 and size of each impact."""
    psi1, size = np.meshgrid(list(PSI2), SIZES)
    return psi1.ravel(), size.ravel()


def starts() -> tuple[Array, Array, Array, Array]:
    """Return mass, speed, slip and height of each sphere."""
    psi1, size = settings()
    speed, mass = motion(size, np.full_like(size, RADIUS), POISSON)
    wait = np.random.default_rng(1).uniform(0.2, 1.0, len(psi1)) * BEFORE * DURATION
    return mass, speed, psi1 * MU * speed / KAPPA, RADIUS + speed * wait


def count(steps: int) -> int:
    """Return the steps of a run; damped contacts last a little longer than elastic ones."""
    return int(steps * (1.0 + BEFORE + 2.0 * AFTER)) + 3


def in_lammps(lammps: Engine, law: str, steps: int) -> Array:
    """Return psi2 of the spheres."""
    mass, speed, slip, height = starts()
    place = rows(len(mass), 0.05)
    place[:, 2] = height
    zero = 0.0 * slip
    share = np.random.default_rng(2).uniform(0.0, 1.0, len(mass))  # of the slip that is spin
    velocity = np.stack([slip * (1.0 - share), zero, -speed], axis=1)
    spin = np.stack([zero, -slip * share / RADIUS, zero], axis=1)
    density = mass / (4.0 / 3.0 * np.pi * RADIUS**3)
    ones = np.ones(len(mass), int)
    grains = Grains(ones, 2.0 * RADIUS * ones, density, place, velocity, spin)
    name, _, damped = law.partition(" ")
    words = friction(name, MU).replace("NULL 0", f"NULL {damped}") if damped else friction(law, MU)
    model = f"hertz/material {YOUNG:.17g} {coefficient():.17g} {POISSON} {words} damping tsuji"
    ours = law.startswith(SPRINGS)
    script = f"""
units si
atom_style sphere
boundary f f f
newton off
comm_modify vel yes
read_data data
pair_style {lammps.pair if ours else "granular"}
pair_coeff * * {model} limit_damping
fix w all {lammps.wall if ours else "wall/gran"} granular {model} limit_damping zplane 0 NULL
fix n all nve/sphere
timestep {DURATION / steps:.17g}
neighbor 0.002 bin
neigh_modify delay 0 every 1 check yes
thermo {count(steps)}
{DUMP.format(every=count(steps))}
run {count(steps)}
"""
    low, high = place.min(axis=0) - 0.1, place.max(axis=0) + 0.1
    low[2] = 0.0
    with folder() as path:
        written(grains, Path(path) / "data", low, high)
        lammps.run(script, Path(path))
        after = read(Path(path) / "out")
    return KAPPA * (after[:, 0] - after[:, 4] * RADIUS) / (MU * speed)


def kernel(path: Path) -> ctypes.CDLL:
    """Compile the kernel in a folder, and return it as a library."""
    words = [sys.executable, "-m", "contactlab", "kernel", "--out", str(path)]
    subprocess.run(words, check=True, capture_output=True)
    (path / "step.c").write_text(STEP)
    files = [str(path / "step.c"), "-o", str(path / "step.so")]
    subprocess.run(["cc", "-std=c99", "-O2", "-fPIC", "-shared", *files, "-lm"], check=True)
    library = ctypes.CDLL(str(path / "step.so"))
    number, numbers = ctypes.c_double, ctypes.POINTER(ctypes.c_double)
    library.springs_step.restype = number
    library.springs_step.argtypes = [
        numbers, ctypes.c_int, numbers, numbers, *[number] * 4, numbers, number, number, numbers,
        number,
    ]  # fmt: skip
    return library


def followed(
    library: ctypes.CDLL, springs: int, start: Array, *, wall: Wall, time: float, count: int
) -> Array:
    """Return velocities up and of slip, shape (n, 2), after impacts by the kernel alone.

    ``start``: mass, speed of approach, slip and height of each sphere, shape (n, 4). The steps are
    those of velocity Verlet; forces take velocities of half a step ago, as LAMMPS does.
    """
    triple = ctypes.c_double * 3
    normal, young = triple(0.0, 0.0, 1.0), wall.young / (2.0 * (1.0 - POISSON**2))
    shear = 8.0 * wall.young / (4.0 * (2.0 - POISSON) * (1.0 + POISSON))
    answers = []
    for mass, speed, first, height in start:
        state, force = (ctypes.c_double * (2 + 3 * springs))(), triple()
        fall, slip, load, pull, last = -speed, first, 0.0, 0.0, None
        for _ in range(count):
            fall += 0.5 * time * load / mass
            slip += 0.5 * time * 3.5 * pull / mass
            height += time * fall
            load = pull = 0.0
            if height < wall.radius:
                overlap = wall.radius - height
                touch = np.sqrt(wall.radius * overlap)
                elastic = 4.0 / 3.0 * young * touch * overlap
                damping = wall.alpha * np.sqrt(mass * elastic / overlap)
                load = elastic - damping * fall
                load = max(load, 0.0) if wall.limited else load
                velocity = slip if last is None or state[0] == 0.0 else 1.5 * slip - 0.5 * last
                library.springs_step(
                    state, springs, triple(time * slip), normal, touch, wall.mu * max(load, 0.0),
                    wall.radius, shear, force, wall.mu * elastic, shear / (2.0 * young) * damping,
                    triple(velocity), time,
                )  # fmt: skip
                pull, last = force[0], slip
            fall += 0.5 * time * load / mass
            slip += 0.5 * time * 3.5 * pull / mass
        answers.append((fall, slip))
    return np.array(answers)


def alone(library: ctypes.CDLL, springs: int, steps: int) -> Array:
    """Return psi2 by the kernel alone."""
    wall = Wall(RADIUS, YOUNG, MU, TSUJI(coefficient()), limited=True)
    start = np.stack(starts(), axis=-1)
    time = DURATION / steps
    slip = followed(library, springs, start, wall=wall, time=time, count=count(steps))[:, 1]
    return KAPPA * slip / (MU * start[:, 1])


def main() -> None:
    """Print a table of errors."""
    parser = arguments(__doc__)
    parser.add_argument("--laws", nargs="+", default=LAWS, help='such as "mindlin 1" (xt), lossy8')
    parser.add_argument("--steps", type=int, default=50, help="steps a contact")
    given = parser.parse_args()
    lammps, expected = engine(given), np.array([PSI2[psi1] for psi1 in settings()[0]])
    print(f"{'law':16} {'worst':>8} {'rms':>8} {'beside the kernel alone':>26}")
    with folder() as path:
        library = kernel(Path(path))
        for law in given.laws:
            found = in_lammps(lammps, law, given.steps)
            error, apart = found - expected, ""
            if law.startswith("lossy"):
                apart = f"{np.abs(found - alone(library, int(law[5:]), given.steps)).max():26.1e}"
            print(f"{law:16} {np.abs(error).max():8.4f} {np.sqrt(np.mean(error**2)):8.4f} {apart}")


if __name__ == "__main__":
    main()
