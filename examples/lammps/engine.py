"""LAMMPS from Python: a file of grains in, an input script run, velocities out."""

from __future__ import annotations

import argparse
import shlex
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Tangential sub-models of LAMMPS with a memory of the displacement or the force.
OWN = ("mindlin", "mindlin/force", "mindlin_rescale", "mindlin_rescale/force")
#: How the names of laws by springs begin.
SPRINGS = ("springs", "lossy")


class Grains(NamedTuple):
    """Grains in SI units: type, diameter, density (n,); position, velocity, spin (n, 3)."""

    kind: NDArray[np.int64]
    diameter: Array
    density: Array
    position: Array
    velocity: Array
    spin: Array


class Engine(NamedTuple):
    """A command that runs LAMMPS, and the plug-in that it loads, if any."""

    command: str
    plugin: Path | None

    @property
    def pair(self) -> str:
        """Name of the pair style that has ``mindlin_springs``."""
        return "granular/springs" if self.plugin else "granular"

    @property
    def wall(self) -> str:
        """Name of the wall fix that has ``mindlin_springs``."""
        return "wall/gran/springs" if self.plugin else "wall/gran"

    @property
    def region(self) -> str:
        """Name of the fix of a region's wall that has ``mindlin_springs``."""
        return "wall/gran/region/springs" if self.plugin else "wall/gran/region"

    def run(self, script: str, folder: Path) -> str:
        """Run an input script in a folder and return what LAMMPS prints."""
        load = f"plugin load {self.plugin}\n" if self.plugin else ""
        (folder / "in.lammps").write_text(load + script)
        words = [*map(_absolute, shlex.split(self.command)), "-in", "in.lammps"]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"{self.command}:\n{done.stdout[-3000:]}\n{done.stderr[-1000:]}")
        return done.stdout


def _absolute(word: str) -> str:
    """Return a path to a program from the root: LAMMPS runs in another folder."""
    return str(Path(word).absolute()) if "/" in word and Path(word).exists() else word


def arguments(description: str | None) -> argparse.ArgumentParser:
    """Return a parser of the engine's options, with the first line of a description."""
    parser = argparse.ArgumentParser(description=(description or "").partition("\n")[0])
    parser.add_argument("--lmp", default="lmp", help='command, such as "mpirun -np 2 build/lmp"')
    parser.add_argument("--plugin", type=Path, help="springsplugin.so, for a program without it")
    return parser


def engine(given: argparse.Namespace) -> Engine:
    """Return the engine that the options name."""
    return Engine(given.lmp, given.plugin and given.plugin.resolve())


def friction(law: str, mu: float) -> str:
    """Return the words of a tangential sub-model: of ``OWN``, ``springs8``, or ``lossy8``.

    Springs are elastic, or share the loss of the normal force.
    """
    if law.startswith(SPRINGS):
        loss, springs = ("NULL", law[5:]) if law.startswith("lossy") else ("0", law[7:])
        return f"tangential mindlin_springs NULL {loss} {mu:.17g} {springs}"
    return f"tangential {law} NULL 0 {mu:.17g}"


def write(grains: Grains, path: Path, low: Array, high: Array, kinds: int = 1) -> None:
    """Write grains as a data file, in a box from ``low`` to ``high``."""
    lines = ["grains", "", f"{len(grains.diameter)} atoms", f"{kinds} atom types", ""]
    for axis, least, most in zip("xyz", low, high, strict=True):
        lines.append(f"{least:.17g} {most:.17g} {axis}lo {axis}hi")
    lines += ["", "Atoms # sphere", ""]
    rows = zip(grains.kind, grains.diameter, grains.density, grains.position, strict=True)
    for number, (kind, diameter, density, place) in enumerate(rows, 1):
        numbers = " ".join(f"{each:.17g}" for each in (diameter, density, *place))
        lines.append(f"{number} {kind} {numbers}")
    lines += ["", "Velocities", ""]
    for number, row in enumerate(np.hstack([grains.velocity, grains.spin]), 1):
        lines.append(f"{number} " + " ".join(f"{each:.17g}" for each in row))
    path.write_text("\n".join(lines) + "\n")


def read(path: Path) -> Array:
    """Return velocities and spins, shape (n, 6), of the last frame of a dump sorted by id."""
    lines = path.read_text().splitlines()
    start = max(i for i, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
    return np.loadtxt(lines[start + 1 :], ndmin=2)[:, 1:7]


def folder() -> tempfile.TemporaryDirectory[str]:
    """Return a temporary folder for one run."""
    return tempfile.TemporaryDirectory(prefix="grains-")


DUMP = """
dump d all custom {every} out id vx vy vz omegax omegay omegaz
dump_modify d sort id format float %.17g
"""
