"""The caution about elastic coupling of unlike bodies (theory §9)."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from contactlab.impact.cautions import OUTSIDE
from contactlab.impact.scene import Scene
from contactlab.impact.table import between_nodes, read_rows
from contactlab.numeric.types import Array, Mask, Real

#: Shift of psi2 by one-way coupling, to 0.002, by the half-space law; its builder is
#: ``python -m table_builders coupling build``. The nodes are psi1, chi, nu, and Lambda.
FILE = Path(__file__).with_name("coupling.csv")
#: Beginning of the caution of coupling.
LEFT_OUT = "model: unlike bodies, so pressure causes some slip, which is ignored"
#: Smallest shift of psi2 with a caution.
LEAST_SHIFT = 1e-3
#: Excess over an axis of the table that counts as rounding, over its end.
ROUNDING = 1e-9


class Nodes(NamedTuple):
    """The table: its axes, and the size of the shift, shape (psi1, chi, nu, Lambda)."""

    axes: tuple[Array, Array, Array, Array]
    size: Array


@cache
def nodes() -> Nodes:
    """Return the table; the shift vanishes at psi1 = 0 and at Lambda = 0."""
    headings, rows = read_rows(FILE)
    numbers = np.array([float(name.partition("=")[2]) for name in headings[3:]])
    psi1, chi, poisson = (np.unique(column) for column in rows[:, :3].T)
    size = np.zeros((len(psi1) + 1, len(chi), len(poisson), len(numbers) + 1))
    at = [np.searchsorted(*pair) for pair in zip((psi1, chi, poisson), rows.T, strict=False)]
    size[at[0] + 1, at[1], at[2], 1:] = np.abs(rows[:, 3:])
    return Nodes((np.r_[0.0, psi1], chi, poisson, np.r_[0.0, numbers]), size)


def coupling_number(scene: Scene) -> Real:
    """Return Lambda = kappa beta/mu, beta Dundurs' constant; infinite without friction."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        strength: Real = np.abs(scene.pair.stiffness_ratio * scene.pair.dundurs_beta)
        return np.where(strength == 0.0, 0.0, np.divide(strength, scene.friction_coefficient))


def coupling_shift(scene: Scene) -> Real:
    """Return the size of the shift of psi2 by one-way coupling, without unit.

    The size is linear between the nodes of a table of half-space solutions. A shift of 0.005 or
    more exceeds it by a factor of 4 at most. Without friction the size is 0. Beyond the last
    psi1 of the table all of the contact slips, and the shift falls as 1/psi1². Other entries are
    clipped to the range of the table.

    Parameters
    ----------
    scene : Scene
        One impact, or a batch of shape ``(...,)``.

    Returns
    -------
    array, shape (...,)
        Not negative; the table is known to 0.002.
    """
    (axes, size), kappa = nodes(), np.asarray(scene.pair.stiffness_ratio)
    psi1, last = np.abs(scene.psi1), axes[0][-1]
    nu = (2.0 - 2.0 * kappa) / (2.0 - kappa)
    entries = (psi1, scene.chi, nu, coupling_number(scene))
    shift = between_nodes(entries, axes, size)
    shift = shift * np.minimum(1.0, last / np.maximum(psi1, last)) ** 2
    return np.where(np.asarray(scene.friction_coefficient) == 0.0, 0.0, shift)


def measures_coupling(scene: Scene) -> Mask:
    """Return where the table of ``coupling_shift`` has an impact; theory goes beyond its psi1.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    bool or array of bool, shape (...,)
    """
    (_, *axes), kappa = nodes().axes, np.asarray(scene.pair.stiffness_ratio)
    nu = (2.0 - 2.0 * kappa) / (2.0 - kappa)
    within: Mask = True
    for entry, axis in zip((scene.chi, nu, coupling_number(scene)), axes, strict=True):
        slack = ROUNDING * axis[-1]
        within = within & (entry >= axis[0] - slack) & (entry <= axis[-1] + slack)
    return within


def coupling(scene: Scene) -> tuple[str, ...]:
    """Return the cautions of unlike bodies, whose normal pressure shears the contact."""
    beta = scene.pair.dundurs_beta
    if beta == 0.0 if isinstance(beta, float) else not np.any(beta):
        return ()
    shape = np.broadcast_shapes(scene.shape, (1,))
    number, shift, known = (
        np.broadcast_to(each, shape).ravel()
        for each in (coupling_number(scene), coupling_shift(scene), measures_coupling(scene))
    )
    told = shift >= LEAST_SHIFT
    if not told.any():
        return ()
    sized = np.where(told & known, shift, 0.0)
    worst = int(np.argmax(sized if sized.any() else shift))
    size = f"{'up to ' if scene.shape else ''}about {shift[worst]:.1g}"
    if not sized.any():
        size = OUTSIDE
    elif np.any(told & ~known):
        size += f", in some impacts {OUTSIDE}"
    return (f"{LEFT_OUT}. Effect on psi2: {size} (Lambda = {number[worst]:.2g}).",)
