"""The processor time that an impact takes from the table, its arguments checked.

It also times an impact in a sweep of the law, a collision in space, and a product of two long
arrays, which tells how fast and how busy the machine is.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from time import process_time

import numpy as np

from contactlab import Encounter, Material, Scene, Simulation, Sphere, collide, rebound
from contactlab.numeric.types import Array
from contactlab_laws.tables.regions import LARGEST_CHI

#: The least time of these is taken: other work on the machine disturbs the rest.
REPEATS, FEW_REPEATS = 15, 4
SIZES = (1_000, 10_000, 100_000, 1_000_000)
SINGLES = 1_000


def mix(count: int) -> tuple[Array, Array]:
    """Return impacts over all of chi, psi1 up to a little beyond the beginning of full slip."""
    rng = np.random.default_rng(7)
    chi = rng.uniform(0.01, LARGEST_CHI, count)
    return rng.uniform(0.0, 1.05 * np.maximum(1.0, 4.0 * chi - 1.0)), chi


def unlike(count: int) -> Encounter:
    """Return encounters of spheres of all sizes, of steel and of glass, that move and spin."""
    rng = np.random.default_rng(7)
    steel = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
    glass = Material(young_modulus=70e9, poisson_ratio=0.2, density=2500.0)
    radius = rng.uniform(1e-3, 1e-2, (2, count))
    normal, velocity, other = rng.normal(size=(3, count, 3))
    spin, spin_of_other = 300.0 * rng.normal(size=(2, count, 3))
    approach = ((velocity - other) * normal).sum(axis=1)
    return Encounter(
        Sphere(radius[0], steel),
        Sphere(radius[1], glass),
        0.2,
        normal=normal * np.sign(approach)[:, None],
        velocity=velocity,
        spin=spin,
        target_velocity=other,
        target_spin=spin_of_other,
    )


def bench() -> list[tuple[str, float]]:
    """Return names and nanoseconds of processor time an impact."""
    rows = []
    for count in SIZES:
        psi1, chi = mix(count)
        least = _least(partial(rebound, psi1, chi))
        rows.append((f"{count} together", 1e9 * least / count))
    least = _least(partial(rebound, psi1, chi, derivatives=True))
    rows.append((f"{count} with derivatives", 1e9 * least / count))
    least = _least(partial(np.multiply, psi1, chi, out=np.empty(count)))
    rows.append((f"{count} products in NumPy", 1e9 * least / count))
    law, scene = Simulation(), Scene.nondimensional(psi1=psi1, chi=chi)
    least = _least(partial(law.sweep, scene), FEW_REPEATS)
    rows.append((f"{count} in a sweep", 1e9 * least / count))
    least = _least(partial(collide, unlike(count)), FEW_REPEATS)
    rows.append((f"{count} collisions in space", 1e9 * least / count))
    pairs = list(zip(psi1[:SINGLES].tolist(), chi[:SINGLES].tolist(), strict=True))

    def singly() -> None:
        for pair in pairs:
            rebound(*pair)

    rows.append(("one at a time", 1e9 * _least(singly) / SINGLES))
    return rows


def _least(call: Callable[[], object], repeats: int = REPEATS) -> float:
    times = []
    for _ in range(repeats):
        began = process_time()
        call()
        times.append(process_time() - began)
    return min(times)
