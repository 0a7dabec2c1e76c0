"""Random scenes on which declared and estimated numerical errors are held against true ones.

6,000 scenes of a fixed seed, all of them marched: partial slip, from the stick of the whole contact
to the edge of gross slip. A quarter has psi1 from .001 on, evenly in its logarithm; a third has chi
between .25 and .75. Each belongs to one of twelve resolutions of integrator and law.
"""

from typing import NamedTuple

import numpy as np

from contactlab import Scene

SEED, COUNT = 19, 6000
#: Steps of the integrator and parts (springs, annuli) of the law, taken in turn.
RESOLUTIONS = (
    (200, 50), (60, 15), (100, 50), (400, 50), (120, 30), (75, 20),
    (300, 25), (200, 35), (500, 80), (90, 10), (150, 64), (250, 100),
)  # fmt: skip


class Group(NamedTuple):
    """The scenes of one resolution, and where they stand among all."""

    steps: int
    parts: int
    index: np.ndarray
    scene: Scene


def numbers(count=COUNT):
    """Return psi1 and chi of the first ``count`` scenes."""
    draw = np.random.default_rng(SEED)
    kind, place, far, split = draw.random((4, COUNT))
    chi = np.where(kind < 1 / 3, 0.25 + 0.5 * place, 0.8 + 1.6 * place)
    chi = np.where(kind > 0.75, 0.05 * 400.0**place, chi)  # .05 to 20
    edge = np.maximum(1.0, 4.0 * chi - 1.0)  # gross slip from here on
    psi1 = np.where(split < 0.25, 0.001 * (1000.0 * edge) ** far, far * edge)
    return psi1[:count], chi[:count]


def groups(count=COUNT):
    """Return the first ``count`` scenes by their resolutions."""
    psi1, chi = numbers(count)
    found = []
    for number, (steps, parts) in enumerate(RESOLUTIONS):
        index = np.arange(number, count, len(RESOLUTIONS))
        scene = Scene.nondimensional(psi1=psi1[index], chi=chi[index])
        found.append(Group(steps, parts, index, scene))
    return found
