"""psi2 of spheres with a restitution, by Tsuji's law with Coulomb's law at every point.

Coordinates in which psi2(psi1, chi, e) is smooth: theory §11, "As a table". At one restitution
the table is four patches in psi1 and chi, which are kept; a restitution of each impact is a third
coordinate.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, cached_property, lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.polynomial.chebyshev import chebval, chebvander

from contactlab.compose.rebound import DAMPED_CHI, DAMPED_RESTITUTION
from contactlab.contracts import NormalMotion, Scene
from contactlab.numeric.checks import Real
from contactlab_laws.tables.file import Stored, read
from contactlab_laws.tables.patches import (
    Array,
    Patches,
    compiled_polynomial,
    polynomial,
    powers_of_chebyshev,
)

SHIPPED = Path(__file__).with_name("damped.npz")
CHI = DAMPED_CHI
#: Pieces of t = (1 - e)^(1/3), in which psi2 is smooth down to e = 1; the border is e = 0.9.
BORDERS = (0.0, 0.1 ** (1.0 / 3.0), 0.5 ** (1.0 / 3.0))
#: Pieces in psi1: the centre sticks until the end; it slips while a ring around it sticks; all of
#: the contact slips and sticks again; the centre slips for good.
STICKS, RINGS, TURNS, SLIPS = range(4)
#: Impacts computed together: fewer cost more calls, more leave the processor's cache.
CHUNK = 8192
#: Rings of impacts beyond the table, impacts followed together, and psi1 beyond which the change of
#: psi is its limit to 1e-4.
BEYOND, TOGETHER, LARGEST = 48, 1024, 1e4
#: Fewer impacts than this are computed one by one.
FEW = 12


def depth(restitution: Any) -> Any:
    """Return t = (1 - e)^(1/3)."""
    return np.cbrt(1.0 - restitution)


def inner(value: Any, low: float, high: float) -> Any:
    """Return ``value`` between ``low`` and ``high`` as a number in [-1, 1]."""
    return (2.0 * value - (low + high)) / (high - low)


def place(piece: int, psi1: Any, cuts: Any) -> Any:
    """Return the coordinate of ``psi1`` in a piece, in [-1, 1]."""
    if piece == STICKS:
        return 2.0 * psi1 / cuts[0] - 1.0
    if piece == SLIPS:
        return 2.0 * (cuts[-1] - 1.0) / (psi1 - 1.0) - 1.0
    low, high = cuts[piece - 1], cuts[piece]  # psi2 is smooth in the root of psi1 - low
    share = (psi1 - low) / (high - low)
    return 2.0 * (math.sqrt(share) if isinstance(share, float) else np.sqrt(share)) - 1.0


def rough(piece: int, psi1: Any, value: Any, chi: Any, e: Any) -> Any:
    """Return psi2 from the tabulated quantity: psi2/psi1, psi2, or psi2 less gross slip's."""
    if piece == STICKS:
        return value * psi1
    return value if piece != SLIPS else value + (psi1 - 2.0 * chi * (1.0 + e))


@attrs.frozen(eq=False, slots=False)
class Section:
    """The table at one restitution.

    Attributes
    ----------
    cuts : array, shape (3, terms)
        The three psi1 at which it is cut, by powers of chi in [-1, 1].
    patches : Patches
        One for each piece in psi1, by powers of ``place`` and of chi in [-1, 1].
    """

    cuts: Array
    patches: Patches

    @cached_property
    def single_cuts(self) -> list[Callable[[float], float]]:
        """The cuts as functions of plain floats."""
        return list(map(compiled_polynomial, self.cuts))

    @classmethod
    def of(cls, stored: Stored, restitution: float) -> Section:
        """Return the section of a table, whose terms are those of Chebyshev's polynomials."""
        t = float(depth(restitution))
        piece = int(t > BORDERS[1])
        cuts, terms = (stored.arrays[name][piece] for name in ("cuts", "terms"))
        basis = chebvander(inner(t, *BORDERS[piece : piece + 2]), terms.shape[-1] - 1)[0]
        cuts, terms = cuts @ basis, terms @ basis
        rows, columns = terms.shape[1:]
        along, across = (
            powers_of_chebyshev(count, stretch=1.0, shift=0.0) for count in (rows, columns)
        )
        counts = [[rows] * len(terms), [columns] * len(terms)]
        patches = Patches(np.zeros((2, len(terms))), along @ terms @ across.T, counts)
        return cls(cuts @ across.T, patches)


@cache
def shipped() -> Stored:
    """Return the file that came with the package."""
    return read(SHIPPED)


@lru_cache(maxsize=64)
def section(restitution: float) -> Section:
    """Return the table at a restitution."""
    return Section.of(shipped(), restitution)


@np.errstate(under="ignore")  # small numbers may vanish, whatever a user has asked for
def rebound(psi1: Array, chi: Array, restitution: Real) -> Array:
    """Return psi2, shape (impacts,), by the table or by rings; odd in psi1 to the last bit.

    Parameters
    ----------
    psi1 : array, shape (impacts,)
    chi : array, shape (impacts,)
        Up to 10, as far as the rings were tried.
    restitution : float or array, shape (impacts,)
        e, below 1.
    """
    speed = np.abs(psi1)
    known = (chi >= CHI[0]) & (chi <= CHI[1]) & (restitution >= DAMPED_RESTITUTION)
    if known.all():
        psi2 = tabulated(speed, chi, restitution)
    else:
        psi2, each = np.empty(psi1.shape), np.broadcast_to(restitution, psi1.shape)
        if known.any():
            e = restitution if isinstance(restitution, float) else restitution[known]
            psi2[known] = tabulated(speed[known], chi[known], e)
        rows = np.flatnonzero(~known)
        for first in range(0, rows.size, TOGETHER):
            part = rows[first : first + TOGETHER]
            psi2[part] = by_rings(speed[part], chi[part], each[part])
    return np.copysign(psi2, psi2 * np.where(psi1 < 0.0, -1.0, 1.0))


def by_rings(psi1: Array, chi: Array, restitution: Array) -> Array:
    """Return psi2 of psi1 >= 0 by the law of the half-space, shape (impacts,)."""
    from contactlab_laws.halfspace.axisymmetric import rebound  # a table needs none of this

    values, which = np.unique(restitution, return_inverse=True)
    near = np.minimum(psi1, LARGEST)
    change = rebound([tsuji(e) for e in values.tolist()], which, near, chi, BEYOND) - near
    # no impact gains energy: not even by an error
    return np.asarray(np.clip(psi1 + change, -psi1, psi1))


def tsuji(e: float) -> NormalMotion:
    """Return the normal motion under Tsuji's law, in scaled units that of every impact."""
    from contactlab.compose.normal_motion import normal_motion
    from contactlab.compose.registry import REGISTRY

    law = REGISTRY.create("normal.tsuji", restitution=e)
    return normal_motion(law, Scene.nondimensional(psi1=1.0, chi=1.0))


def tabulated(speed: Array, chi: Array, restitution: Real) -> Array:
    """Return psi2 of psi1 = speed >= 0 from the table, shape (impacts,)."""
    psi2 = np.empty(speed.shape)
    parts = [slice(first, first + CHUNK) for first in range(0, speed.size, CHUNK)]
    if not isinstance(restitution, float):
        for part in parts:
            psi2[part] = _each(speed[part], chi[part], restitution[part])
        return psi2
    ours = section(restitution)
    if speed.size < FEW:
        pairs = zip(speed.tolist(), chi.tolist(), strict=True)
        return np.array([single(*pair, restitution, ours) for pair in pairs])
    for part in parts:
        psi2[part] = _together(speed[part], chi[part], restitution, ours)
    return psi2


def single(speed: float, chi: float, e: float, ours: Section) -> float:
    """Return psi2 of one impact, in plain floats."""
    y = inner(chi, *CHI)
    cuts = [cut(y) for cut in ours.single_cuts]
    piece = sum(speed > cut for cut in cuts)
    value = ours.patches.single[piece](place(piece, speed, cuts), y)
    return float(rough(piece, speed, value, chi, e))


def _together(speed: Array, chi: Array, e: float, ours: Section) -> Array:
    """Return psi2 of many impacts."""
    y = inner(chi, *CHI)
    cuts = np.array([polynomial(terms, y) for terms in ours.cuts])
    piece = (speed > cuts).sum(axis=0).astype(np.int16)
    at = np.empty_like(speed)
    parts = [(number, np.flatnonzero(piece == number)) for number in range(SLIPS + 1)]
    for number, rows in parts:
        at[rows] = place(number, speed[rows], cuts[:, rows])
    psi2 = ours.patches.values(piece, at, y)
    for number, rows in parts:
        psi2[rows] = rough(number, speed[rows], psi2[rows], chi[rows], e)
    return psi2


def _each(speed: Array, chi: Array, e: Array) -> Array:
    """Return psi2 of impacts with a restitution each: of ``Section``, to rounding."""
    stored, t, psi2 = shipped().arrays, depth(e), np.empty_like(speed)
    *_, columns, depths = stored["terms"].shape
    across = chebvander(inner(chi, *CHI), columns - 1).T
    for piece, ends in enumerate(pairwise(BORDERS)):
        rows = np.flatnonzero((t > BORDERS[1]) == piece)
        by_depth = chebvander(inner(t[rows], *ends), depths - 1).T
        both = (across.take(rows, axis=1)[:, None] * by_depth).reshape(columns * depths, -1)
        cuts = stored["cuts"][piece].reshape(-1, len(both)) @ both
        part = (speed[rows] > cuts).sum(axis=0)
        for number, table in enumerate(stored["terms"][piece]):
            mine = np.flatnonzero(part == number)
            values, who = table.reshape(-1, len(both)) @ both.take(mine, axis=1), rows[mine]
            at = place(number, speed[who], cuts.take(mine, axis=1))
            value = chebval(at, values, tensor=False)
            psi2[who] = rough(number, speed[who], value, chi[who], e[who])
    return psi2
