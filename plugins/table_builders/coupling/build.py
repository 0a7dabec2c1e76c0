"""Build the table of the shift of psi2 by coupling of unlike bodies; minutes of processor time."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from contactlab import Scene, Simulation, create
from contactlab.numeric.types import Array, Real

#: Nodes. psi1 has more of them around 1, where coupling acts most: below 1 the contact sticks at
#: first touch, above 1 it slips. chi runs from a shell of nu = 0.5 to a ball with a dense core.
PSI1 = (
    *(0.25, 0.5, 0.75, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75),
    *(2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 12.0),
)
CHI = (0.83, 1.0, 1.2, 1.44, 1.75, 2.2)
POISSON_RATIO = (0.0, 0.5)
COUPLING_NUMBER = (0.25, 0.5, 1.0, 2.0, 4.0)
#: At 32 rings and 8 angles the shift is known to about 2e-3.
RINGS, ANGLES = 32, 8


def shift(psi1: Real, chi: Real, poisson_ratio: float, numbers: Sequence[float]) -> Array:
    """Return psi2 with one-way coupling less psi2 without, shape (numbers, ...)."""
    scene = {"psi1": psi1, "chi": chi, "poisson_ratio": poisson_ratio}
    like = _psi2("none", Scene.nondimensional(**scene))
    rows = [Scene.nondimensional(**scene, coupling_number=number) for number in numbers]
    return np.array([_psi2("one_way", row) - like for row in rows])


def build(file: Path) -> None:
    """Solve the impacts at the nodes, and write the table."""
    lines = [
        "# psi2 with one-way coupling of unlike bodies less psi2 without: tangential.halfspace, "
        f"{RINGS} rings, {ANGLES} angles, known to about 0.002.",
        "# Written by: python -m table_builders coupling build",
        "psi1,chi,poisson_ratio," + ",".join(f"Lambda={each:g}" for each in COUPLING_NUMBER),
    ]
    for chi, poisson in itertools.product(CHI, POISSON_RATIO):
        found = shift(np.array(PSI1), chi, poisson, COUPLING_NUMBER)
        for psi1, row in zip(PSI1, found.T, strict=True):
            numbers = ",".join(f"{each:.4f}" for each in row)
            lines.append(f"{psi1:g},{chi:g},{poisson:g},{numbers}")
        print(f"chi = {chi:g}, nu = {poisson:g}", flush=True)
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _psi2(coupling: str, scene: Scene) -> Array:
    """Return psi2 with that coupling; every step of every impact must settle."""
    law = create(
        "tangential.halfspace", coupling=coupling, rings=RINGS, angles=ANGLES, extrapolate=False
    )
    return np.asarray(Simulation(tangential=law).run(scene).check().psi2)
