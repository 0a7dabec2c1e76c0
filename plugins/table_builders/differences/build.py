"""Differences of psi2: of springs from Coulomb's law, of normal laws from Tsuji's.

``python -m table_builders differences build`` writes ``differences.csv`` of the package
``contactlab_laws.differences``: minutes.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator
from functools import cache
from typing import Any

import attrs
import numpy as np

from contactlab.contracts.law import claims
from contactlab.contracts.normal import NormalLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real
from contactlab.registry.registry import REGISTRY
from contactlab.runs.simulation import Simulation
from contactlab.solve.normal_motion import normal_motion
from contactlab_laws.differences.table import FILE, NODES, key

#: The impacts of the choice of a law: least and number of psi1, up to slip throughout and 1 more,
#: at each chi; as many again in ``NARROW``.
LEAST, COUNT, CHI = 0.2, 24, (0.8, 1.0, 1.2, 49.0 / 34.0, 1.6, 1.8)
NARROW = (0.7, 2.0)
#: The impacts of springs: numbers of psi1 at each node of chi, from 0 to 1 beyond slip throughout.
SPEEDS = 40
#: Springs, extrapolated from this number and half of it, with four steps each.
SPRINGS = 120
#: Rings of the half-space.
RINGS = 96
#: Laws whose restitution is an option, and its values.
CALIBRATED = ("tsuji", "hunt_crossley", "kuwabara_kono", "linear", "walton_braun")
RESTITUTION = (1.0, 0.99, 0.95, 0.9, 0.8, 0.65, 0.5, 0.4, 0.3, 0.2, 0.1)
#: Options of the other laws, in the units of ``impact``; they give some restitutions.
OTHERS: tuple[tuple[str, str, tuple[float, ...]], ...] = (
    ("thornton", "yield_velocity", (0.6, 0.3, 0.1, 0.03, 0.01)),
    ("jkr", "work_of_adhesion", (1e-3, 1e-2, 5e-2)),
    ("dmt", "work_of_adhesion", (1e-2, 5e-2)),
)


def impacts(e: float) -> tuple[Array, Array]:
    """Return psi1 and chi of the impacts, shape (impacts,)."""
    last = 2.0 * np.array(CHI) * (1.0 + e) + 1.0
    narrow = np.broadcast_to(np.linspace(*NARROW, COUNT)[:, None], (COUNT, len(CHI)))
    psi1 = np.concatenate((np.linspace(LEAST, last, COUNT), narrow)).ravel()
    return psi1, np.tile(CHI, 2 * COUNT)


def impact(psi1: Real, chi: Real) -> Scene:
    """Return the impacts of psi1 and chi of a ball of 1 kg and 1 m at 1 m/s, C = 1."""
    return attrs.evolve(Scene.nondimensional(psi1=psi1, chi=chi), has_units=True)


def springs(law: NormalLaw, psi1: Array, chi: Array, *, shear_loss: float = 1.0) -> Array:
    """Return psi2 by springs, extrapolated in their number, shape (impacts,)."""
    scene = impact(psi1, chi)
    psi2 = []
    for count in (SPRINGS // 2, SPRINGS):
        simulation = Simulation(
            normal=law,
            tangential=REGISTRY.create("tangential.springs", springs=count, shear_loss=shear_loss),
            integrator=REGISTRY.create("integrator.symplectic", steps=4 * count),
        )
        psi2.append(np.asarray(simulation.sweep(scene).check().psi2))
    return np.asarray(psi2[1] + (psi2[1] - psi2[0]) / 3.0)


def pointwise(law: NormalLaw, psi1: Array, chi: Array) -> Array:
    """Return psi2 with Coulomb's law at every point, shape (impacts,), by the half-space."""
    half_space = REGISTRY.create("tangential.halfspace", angles=1, rings=RINGS)
    scene = impact(psi1, chi)
    return np.asarray(Simulation(normal=law, tangential=half_space).sweep(scene).check().psi2)


@cache
def tsuji(e: float) -> Array:
    """Return psi2 of the impacts under Tsuji's law."""
    return pointwise(REGISTRY.create("normal.tsuji", restitution=e), *impacts(e))


def laws() -> Iterator[Any]:
    """Iterate over the normal laws that are measured."""
    for name in CALIBRATED:
        for e in RESTITUTION:
            yield REGISTRY.create(f"normal.{name}", restitution=e)
    for name, option, values in OTHERS:
        for value in values:
            yield REGISTRY.create(f"normal.{name}", **{option: value})


def by_springs(law: NormalLaw, e: float) -> Iterator[float]:
    """Yield the largest error of springs at each node of chi."""
    for chi in NODES:
        psi1 = np.linspace(0.0, 2.0 * chi * (1.0 + e) + 1.0, SPEEDS + 1)[1:]
        ratio = np.full(SPEEDS, chi)
        elastic = springs(law, psi1, ratio, shear_loss=0.0)
        yield float(np.abs(elastic - pointwise(law, psi1, ratio)).max())


@cache
def tsuji_sharing(e: float) -> Array:
    """Return psi2 of the impacts under Tsuji's law, whose loss springs share."""
    return springs(REGISTRY.create("normal.tsuji", restitution=e), *impacts(e))


def row(law: NormalLaw) -> list[str]:
    """Return the class of a law, its restitution, and the largest differences of psi2."""
    motion = normal_motion(law, impact(1.0, 1.0))
    e = round(-float(motion.final_rate), 6)
    psi1, chi = impacts(e)
    exact = pointwise(law, psi1, chi)
    choice = float(np.abs(tsuji(e) - exact).max())
    sharing = springs(law, psi1, chi) if "viscous" in claims(law) else exact
    shared = float(np.abs(tsuji_sharing(e) - sharing).max())
    sizes = choice, shared, *by_springs(law, e)
    return [key(law), f"{e:g}", *(f"{size:.1e}" for size in sizes)]


def write() -> None:
    """Measure all the laws and write the table; progress goes to stderr."""
    measured = []
    for law in laws():
        measured.append(row(law))
        print(*measured[-1], file=sys.stderr, flush=True)
    with FILE.open("w", encoding="utf-8", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        heads = [f"springs chi={chi:g}" for chi in NODES]
        lines.writerows([["law", "restitution", "choice", "shared", *heads], *measured])
