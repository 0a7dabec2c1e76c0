"""Impacts in YADE against the exact rebound, under its own friction and under contactlab's kernel.

Run with the Python that has contactlab; YADE has one of its own, and a compiler is needed.

Examples
--------
  python rebounds.py
  python rebounds.py --yade yade --springs 0 4 8 12
  python rebounds.py --damped --steps 200    # e = 0.7441, against one loss for pressure and shear
"""

import argparse
import json
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import contactlab

HERE = Path(__file__).resolve().parent
YOUNG, MU, RADIUS = 1e9, 0.3, 0.01
POISSON = (0.0, 0.3, 0.49)
SIZES = 0.005 * 2.0 ** np.linspace(0.0, 1.0, 10, endpoint=False)  # largest contact radius over R*
DURATION = 1e-4  # of every contact without damping, in s
#: Theory, P = zeta^1.5 + 0.2 zeta^0.25 V and shear that shares its loss, nu = 0.3: psi2 by psi1.
PSI2 = {0.5: -0.04377, 1.0: -0.13498, 2.0: -0.59223, 3.0: -0.99929, 4.0: -0.94568, 8.0: 2.97295}
BETA = 0.1 * np.sqrt(1.25 / 1.5)  # of YADE's damping, 2 beta sqrt(m dP/dz)
#: The kernel as a function that a library exports.
EXPORTED = """
#include "contactlab_springs.h"
double springs_step(double *state, int n, const double *moved, const double *normal, double radius,
                    double limit, double unit, double modulus, double *force, double elastic,
                    double damping, const double *velocity, double time)
{
  return contactlab_springs_damped_step(state, n, moved, normal, radius, limit, unit, modulus,
                                        force, elastic, damping, velocity, time);
}
"""


def library(folder: Path) -> Path:
    """Compile the kernel in a folder, and return the library."""
    words = [sys.executable, "-m", "contactlab", "kernel", "--out", str(folder)]
    subprocess.run(words, check=True, capture_output=True)
    (folder / "springs.c").write_text(EXPORTED)
    made = folder / "libspringskernel.so"
    files = [str(folder / "springs.c"), "-o", str(made)]
    subprocess.run(["cc", "-std=c99", "-O3", "-fPIC", "-shared", *files, "-lm"], check=True)
    return made


def pairs(angles: int, damped: bool) -> list[tuple[float, float, dict[str, float]]]:
    """Return psi1, kappa, and what YADE is told of each pair."""
    random = np.random.default_rng(1)
    table: list[tuple[float, float, dict[str, float]]] = []
    for poisson in (0.3,) if damped else POISSON:
        kappa = 2.0 * (1.0 - poisson) / (2.0 - poisson)
        for size in SIZES:
            for psi1 in PSI2 if damped else np.linspace(0.02, 7.0 * kappa + 0.3, angles):
                radius, modulus = 0.5 * RADIUS, YOUNG / (2.0 * (1.0 - poisson**2))
                overlap = size**2 * radius
                speed = 2.9432751843 * overlap / DURATION
                mass = 16.0 * modulus * np.sqrt(radius) * overlap**2.5 / (15.0 * speed**2)
                table.append((psi1, kappa, {
                    "poisson": poisson, "speed": speed, "slip": psi1 * MU * speed / kappa,
                    "density": 2.0 * mass / (4.0 / 3.0 * np.pi * RADIUS**3),
                    "share": random.uniform(), "gap": speed * DURATION * random.uniform(0.02, 0.1),
                }))  # fmt: skip
    return table


def main() -> None:
    """Print a table of errors of psi2."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--yade", default="yade", help="the command that runs YADE")
    parser.add_argument("--steps", type=int, default=50, help="steps a contact")
    parser.add_argument("--springs", type=int, nargs="+", default=[0, 4, 8, 12])
    parser.add_argument("--angles", type=int, default=40)
    parser.add_argument("--damped", action="store_true", help="impacts at e = 0.7441")
    asked = parser.parse_args()
    table = pairs(asked.angles, asked.damped)
    psi1, kappa = np.array([each[:2] for each in table]).T
    told = [each[2] for each in table]
    speed, slip, share, density = (
        np.array([each[name] for each in told]) for name in ("speed", "slip", "share", "density")
    )
    mass = density * 4.0 / 3.0 * np.pi * RADIUS**3
    first = 0.25 * mass * (slip**2 * ((1.0 - share) ** 2 + 0.4 * share**2) + speed**2)
    if asked.damped:
        exact = np.array([PSI2[each] for each in psi1])
    else:
        exact = contactlab.rebound(psi1, 1.75 * kappa)
    run = {
        "young": YOUNG, "mu": MU, "radius": RADIUS, "pairs": told,
        "time_step": DURATION / asked.steps, "steps": int(1.5 * asked.steps) + 3,
        "betan": BETA * asked.damped,
    }  # fmt: skip
    print(f"{'springs':>12} {'worst':>8} {'rms':>8} {'work/loss':>12}")
    for springs in asked.springs:
        with tempfile.TemporaryDirectory() as name:
            file = Path(name) / "pairs.json"
            file.write_text(json.dumps(run))
            words = [*shlex.split(asked.yade), "-n", "-x", str(HERE / "impacts.py"), str(file)]
            words += [str(library(Path(name))), str(springs)]
            found = {**os.environ, "PYTHONPATH": str(HERE)}
            done = subprocess.run(
                words, cwd=name, capture_output=True, text=True, check=False, env=found
            )
            if not file.with_suffix(".out").exists():
                raise RuntimeError(f"{asked.yade}:\n{done.stdout[-3000:]}\n{done.stderr[-1000:]}")
            answer = json.loads(file.with_suffix(".out").read_text())
        one, other = np.array(answer["bodies"]).reshape(-1, 2, 6).transpose(1, 0, 2)
        parted = other[:, 0] - one[:, 0]
        kept = 0.7441 if asked.damped else 1.0
        assert np.allclose(parted, kept * speed, rtol=1e-2), "an impact is not over, or lost energy"
        slip = one[:, 1] - other[:, 1] + RADIUS * (one[:, 5] + other[:, 5])
        error = kappa * slip / (MU * speed) - exact
        rms = np.sqrt(np.mean(error**2))
        squares = [
            (b[:, :3] ** 2 + 0.4 * RADIUS**2 * b[:, 3:] ** 2).sum(axis=1) for b in (one, other)
        ]
        pressed = 0.25 * mass * (speed**2 - parted**2)  # lost in the normal direction
        lost = np.sum(first - 0.5 * mass * sum(squares) - pressed)
        work = f"{answer['work'] / lost:12.4f}" if springs else ""
        name = springs or "none: YADE"
        print(f"{name:>12} {np.abs(error).max():8.3f} {rms:8.3f} {work}", flush=True)


if __name__ == "__main__":
    main()
