"""Spheres with a restitution: one loss for pressure and shear, tabulated (theory §15).

The tables hold psi2 and the energy lost in shear.

Impacts that slip throughout, and those of e = 0, are known in closed form.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from contactlab.numeric.array_api import Computed
from contactlab.numeric.arrays import part_of
from contactlab.numeric.types import Array, Mask, Real
from contactlab_laws.tables import elastic
from contactlab_laws.tables.file import read
from contactlab_laws.tables.patches import Single
from contactlab_laws.tables.regions import LARGEST_CHI
from contactlab_laws.tables.restituted_regions import (
    NODES,
    REGIONS,
    SLIPPING,
    Table,
    border,
    index,
)

SHIPPED = Path(__file__).with_name("restituted.npz")
SHEAR = Path(__file__).with_name("restituted_shear.npz")
#: Fewer impacts than this are computed one by one; so many are taken together at most.
FEW, BLOCK = 12, 1 << 15
#: e above which psi2 goes over to the elastic table, so that no jump is seen at 1.
JOINED = 0.99
#: Least e of a course, at which the loss in shear below is taken.
LEAST = 0.01
#: Imaginary step for derivatives: its square vanishes.
STEP = 1e-30


@cache
def load_table(path: Path = SHIPPED) -> Table:
    """Return a table that came with the package."""
    return Table.of(read(path))


@lru_cache(maxsize=16)
def section(e: float, path: Path = SHIPPED) -> Table:
    """Return a table at one restitution."""
    return load_table(path).at(e)


def rebound(psi1: Any, chi: Any, restitution: Any, *, derivatives: bool = False) -> Any:
    """Return psi2, odd in psi1 to the last bit, abs(psi2) <= abs(psi1).

    Parameters
    ----------
    psi1 : float or array, shape (impacts,)
        Finite.
    chi : float or array, shape (impacts,)
        From 0.3 to 3.
    restitution : float or array, shape (impacts,)
        e, from 0 to 1, 1 excluded.
    derivatives : bool
        Whether to return (psi2, d psi2/d psi1, d psi2/d chi, d psi2/d e); arrays only.
    """
    if isinstance(psi1, float):
        return single(psi1, chi, restitution)
    alike = isinstance(restitution, float)
    if psi1.size < FEW:
        e = (restitution,) * psi1.size if alike else restitution.tolist()
        psi2 = np.array(list(map(single, psi1.tolist(), chi.tolist(), e)))
    else:
        psi2 = _by_blocks(np.abs(psi1), chi, restitution)
        np.negative(psi2, out=psi2, where=psi1 < 0.0)
    if not derivatives:
        return psi2
    by_psi1, by_chi, by_e = gradient(
        np.abs(psi1), chi, np.full(psi1.shape, restitution) if alike else restitution
    )
    sign = np.copysign(1.0, psi1)
    return psi2, by_psi1, by_chi * sign, by_e * sign


@np.errstate(under="ignore")  # small numbers may vanish
def _by_blocks(speed: Array, chi: Array, restitution: Real) -> Array:
    """Return psi2 of psi1 = speed >= 0, shape (impacts,)."""
    psi2 = np.empty_like(speed)
    for first in range(0, speed.size, BLOCK):
        part = slice(first, first + BLOCK)
        psi2[part] = _solve_block(speed[part], chi[part], part_of(restitution, part))
    return psi2


def _solve_block(speed: Array, chi: Array, e: Real) -> Array:
    """Return psi2 of a block of impacts."""
    psi2 = full_slip(speed, chi, e)
    who = np.flatnonzero(sticks(speed, chi, e))
    if not who.size:
        return psi2
    p, x, own = speed[who], chi[who], part_of(e, who)
    found = _partial(p, x, own)
    near = np.asarray(own > JOINED)
    if near.any():
        rows = np.flatnonzero(np.broadcast_to(near, p.shape) & (x <= LARGEST_CHI))
        found[rows] += _share(part_of(own, rows)) * _step(p[rows], x[rows])
    if np.any(own == 0.0):
        found = np.where(own == 0.0, without_rebound(p, x), found)
    # no impact gains energy, nor more impulse than full slip gives: not even by an error
    found = np.maximum(found, psi2[who])
    psi2[who] = np.clip(found, -p, p)
    return np.asarray(psi2)


def full_slip(speed: Array, chi: Array, e: Real) -> Array:
    """Return psi2 of slip throughout."""
    return np.asarray(speed - 2.0 * chi * (1.0 + e))


def sticks(speed: Real, chi: Real, e: Real) -> Mask:
    """Return whether impacts do not slip throughout."""
    found: Mask = speed < np.maximum(border(chi, e), 1.0)
    return found


def shear_loss(psi1: Array, chi: Array, restitution: Real) -> Array:
    """Return the energy lost in shear over m_t (mu v1/kappa)²/2, shape (impacts,).

    To 2e-3 max(1, psi1)², for chi from 0.3 to 3; 0 of impacts that slip throughout, as of the
    marched ones. It is that of ``JOINED`` times a line in e above, and that of ``LEAST`` below.
    """
    if psi1.size < FEW:
        e = np.broadcast_to(restitution, psi1.shape).tolist()
        return np.array(list(map(single_shear_loss, psi1.tolist(), chi.tolist(), e)))
    speed, lost = np.abs(psi1), np.zeros(psi1.shape)
    who = np.flatnonzero(sticks(speed, chi, np.minimum(restitution, JOINED)))
    if not who.size:
        return lost
    e = part_of(restitution, who)
    most: Real = np.clip(e, LEAST, JOINED)
    most = float(most) if isinstance(e, float) else most
    found = _partial(speed[who], chi[who], most, SHEAR, power=2)
    lost[who] = np.maximum(found, 0.0) * np.minimum((1.0 - e) / (1.0 - JOINED), 1.0)
    return lost


def single_shear_loss(psi1: float, chi: float, e: float) -> float:
    """Return ``shear_loss`` of one impact, in plain floats."""
    speed, most = abs(psi1), min(max(e, LEAST), JOINED)
    if speed >= 1.0 and speed >= border(chi, min(e, JOINED)):
        return 0.0
    found = _single(speed, chi, most, border(chi, most), SHEAR, power=2)
    return max(found, 0.0) * min((1.0 - e) / (1.0 - JOINED), 1.0)


def _partial(speed: Array, chi: Array, e: Real, path: Path = SHIPPED, *, power: int = 1) -> Array:
    """Return psi2, or another quantity, from its table; of complex numbers too.

    Where the contact sticks first it is tabulated over a power of psi1.
    """
    slips = speed.real > 1.0
    u, rows = speed.copy(), np.flatnonzero(slips)
    end = border(chi[rows], part_of(e, rows))
    u[rows] = 1.0 - np.sqrt((end - speed[rows]) / (end - 1.0))
    if isinstance(e, float):
        found = section(e, path).values(slips, u, chi)
    else:
        found = load_table(path).values(slips, u, chi, e)
    return np.multiply(found, speed if power == 1 else speed**power, out=found, where=~slips)


def _share(e: Computed) -> Computed:
    """Return the share of ``_step`` at e above ``JOINED``."""
    return ((e - JOINED) / (1.0 - JOINED)) ** 2


def _step(speed: Array, chi: Array) -> Array:
    """Return the elastic psi2 less that of the table at e = 1, which is its error."""
    return np.asarray(elastic.values(elastic.load_table(), speed, chi) - _partial(speed, chi, 1.0))


def without_rebound(speed: Array, chi: Array) -> Array:
    """Return psi2 of e = 0 where an impact does not slip throughout."""
    rest = np.maximum(1.0 - 2.0 * chi, np.finfo(float).tiny)
    return np.asarray(rest * np.minimum(speed, 1.0) ** (1.0 / rest))


@np.errstate(under="ignore")
def gradient(speed: Array, chi: Array, e: Array) -> tuple[Array, Array, Array]:
    """Return d psi2/d psi1, d psi2/d chi and d psi2/d e for psi1 = speed >= 0.

    By a complex step: the imaginary part of psi2 at psi1 + ih over h, and so on.
    """
    by_psi1, by_chi, by_e = np.ones_like(speed), -2.0 * (1.0 + e), -2.0 * chi
    who = np.flatnonzero(sticks(speed, chi, e))
    p, x, own = (np.concatenate((each[who],) * 3).astype(complex) for each in (speed, chi, e))
    for k, each in enumerate((p, x, own)):
        each[k * who.size : (k + 1) * who.size] += 1j * STEP
    slopes = (_partial(p, x, own).imag / STEP).reshape(3, -1)
    near = np.flatnonzero((e[who] > JOINED) & (chi[who] <= LARGEST_CHI))
    if near.size:
        q, y, own = speed[who][near], chi[who][near], e[who][near]
        slopes[2, near] += 2.0 * np.sqrt(_share(own)) / (1.0 - JOINED) * _step(q, y)
        p, x = np.concatenate((q, q)).astype(complex), np.concatenate((y, y)).astype(complex)
        p[: q.size] += 1j * STEP
        x[q.size :] += 1j * STEP
        ours = (_partial(p, x, 1.0).imag / STEP).reshape(2, -1)
        exact = elastic.gradient(elastic.load_table(), q, y)
        slopes[:2, near] += _share(own) * (np.array(exact) - ours)
    by_psi1[who], by_chi[who], by_e[who] = slopes
    return by_psi1, by_chi, by_e


@lru_cache(maxsize=64)
def _keep(_: float, __: Path) -> dict[int, Callable[[float, float], float]]:
    """Return the patches at one restitution in plain numbers, those that were asked for."""
    return {}


@cache
def _plain(path: Path) -> tuple[list[int], list[list[int]], list[int]]:
    """Return grid, sizes and starts of a shipped table in plain numbers."""
    table = load_table(path)
    return table.grid.tolist(), table.sizes.T.tolist(), table.starts.tolist()


def single(psi1: float, chi: float, e: float) -> float:
    """Return psi2 of one impact, in plain floats."""
    speed = abs(psi1)
    least = speed - 2.0 * chi * (1.0 + e)
    end = border(chi, e)
    if speed >= 1.0 and speed >= end:
        return least if psi1 >= 0.0 else -least
    if e == 0.0:
        psi2 = (1.0 - 2.0 * chi) * speed ** (1.0 / (1.0 - 2.0 * chi)) if chi < 0.5 else 0.0
    else:
        psi2 = _single(speed, chi, e, end)
        if e > JOINED and chi <= LARGEST_CHI:
            exact = elastic.rebound(speed, chi)
            psi2 += _share(e) * (exact - _single(speed, chi, 1.0, border(chi, 1.0)))
        psi2 = max(psi2, least, -speed)
        psi2 = min(psi2, speed)
    return psi2 if psi1 >= 0.0 else -psi2


def _single(
    speed: float, chi: float, e: float, end: float, path: Path = SHIPPED, *, power: int = 1
) -> float:
    """Return psi2 of one impact from its table, or another quantity, as ``_partial`` does."""
    if speed > 1.0:
        region = 2 + (chi >= SLIPPING[0]) + (chi >= SLIPPING[1])
        u, unit = 1.0 - math.sqrt((end - speed) / (end - 1.0)), 1.0
    else:
        region, u, unit = int(chi >= 0.5), speed, speed**power
    grid, sizes, starts = _plain(path)
    (rows, columns, layers), (_, low, high) = sizes[region], REGIONS[region]
    i, j = index(u, rows), index((chi - low) / (high - low), columns)
    patch = grid[starts[region] + (i * columns + j) * layers + index(e, layers)]
    kept = _keep(e, path)
    value = kept.get(patch)
    if value is None:
        patches = load_table(path).patches
        *origin, start = patches.origins[:, patch].tolist()
        by_e = (e - start) ** np.arange(NODES[2])
        value = kept[patch] = Single(np.array(origin), patches.terms[patch] @ by_e, kept, patch)
    return unit * value(u, chi)
