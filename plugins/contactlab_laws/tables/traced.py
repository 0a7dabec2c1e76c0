"""psi2 from both tables by functions of the array API standard, for libraries that trace: JAX.

The formulas are those of ``elastic`` and ``restituted``, without branches: each impact is computed
in a region, and conditions choose. An excluded formula gets a harmless number as its argument, so
that its derivatives stay finite.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any, TypeAlias

import numpy as np

from contactlab.numeric.array_api import Library, Operand, Traced
from contactlab.numeric.types import Array
from contactlab_laws.tables import elastic, restituted
from contactlab_laws.tables import regions as of
from contactlab_laws.tables.file import read
from contactlab_laws.tables.restituted_regions import (
    LOW,
    NODES,
    PER_WIDTH,
    RESTITUTED_CHI,
    SLIPPING,
    border,
)

#: A function of arrays, its slopes by each of its last arguments, and what joins the two: the
#: first arguments, so many, are not differentiated.
Differentiable: TypeAlias = Callable[..., Traced]
Slopes: TypeAlias = Callable[..., list[Traced]]
WithSlopes: TypeAlias = Callable[[Differentiable, Slopes, int], Differentiable]
#: A harmless number in place of the argument of a root.
HARMLESS = 0.5
#: Regions in which the first coordinate is a root, and those in which the second is.
ROOTS = (of.SMALL_NEAR, of.SLIP_BACK, of.SLIP_ON), (of.STUCK_ON, of.SLIP_ON)
#: Before the names of the elastic table among those of the table of restitutions.
ELASTIC = "elastic "


def without(value: Differentiable, *_: Slopes | int) -> Differentiable:
    """Return a function that the library differentiates itself."""
    return value


@cache
def elastic_constants() -> dict[str, Any]:
    """Return the elastic table, by powers of local coordinates from the middle of each patch.

    float32 keeps more digits so than by powers from an end. Where a coordinate is a root, patches
    that begin at 0 keep that origin: there low powers are missing, exactly, and with them slopes
    that are infinite.
    """
    stored = read(elastic.SHIPPED).arrays
    cells, terms = stored["cells"], stored["terms"].astype(np.float64)
    begins = cells[:, 3:].T.astype(np.float64)
    middles = np.where((begins == 0.0) & [np.isin(cells[:, 0], each) for each in ROOTS], 0.0, 0.5)
    shifts = [_shifting(each, elastic.NODES) for each in middles]
    return {
        "grid": elastic._grid(cells).ravel().astype(np.int32),
        "terms": (shifts[0].swapaxes(1, 2) @ terms @ shifts[1]).reshape(-1),
        "scales": np.exp2(cells[:, 1:3].T.astype(np.float64)),
        "starts": begins + middles,
        **{name: stored[name] for name in of.Cuts._fields},
    }


def _shifting(origins: Array, count: int) -> Array:
    """Return matrices of u^n by powers of u less each origin, shape (origins, count, count)."""
    powers = np.array([[math.comb(n, k) for k in range(count)] for n in range(count)], dtype=float)
    exponents = np.subtract.outer(np.arange(count), np.arange(count))
    return powers * np.asarray(origins)[:, None, None] ** np.maximum(exponents, 0)


@cache
def list_constants() -> dict[str, Any]:
    """Return the table of restitutions, and the elastic one."""
    table = restituted.load_table()
    return {
        "grid": table.grid.astype(np.int32),
        "starts": table.starts,
        "sizes": table.sizes,
        "terms": table.patches.terms.reshape(-1),
        "origins": table.patches.origins,
        "low": LOW,
        "per_width": PER_WIDTH,
        **{f"{ELASTIC}{name}": each for name, each in elastic_constants().items()},
    }


def rebound(
    xp: Library,
    constants: Mapping[str, Traced],
    psi1: Traced,
    chi: Traced,
    *,
    with_slopes: WithSlopes = without,
) -> Traced:
    """Return psi2 of elastic impacts, NaN where the table ends.

    Parameters
    ----------
    xp : module
        Functions of the array API standard.
    constants : mapping of str to array
        ``elastic_constants``, as arrays of that library.
    psi1, chi : array
        Numbers of the impacts, arrays of one shape and type.
    with_slopes : callable
        As in ``contracts.whole_impact.Tabulated``.
    """
    inside = xp.isfinite(psi1) & (chi > 0.0) & (chi <= of.LARGEST_CHI)
    sign = xp.where(psi1 < 0.0, -xp.ones_like(psi1), xp.ones_like(psi1))  # 1 at 0: odd and smooth
    speed = xp.where(inside, sign * psi1, HARMLESS)
    psi2 = _elastic(xp, constants, speed, xp.where(inside, chi, 1.0), with_slopes)
    return xp.where(inside, sign * psi2, xp.nan)


def rebound_with_loss(
    xp: Library,
    constants: Mapping[str, Traced],
    psi1: Traced,
    chi: Traced,
    e: Traced,
    *,
    joined: bool,
    with_slopes: WithSlopes = without,
) -> Traced:
    """Return psi2 of impacts with a restitution, NaN where the table ends.

    Parameters
    ----------
    xp : module
        Functions of the array API standard.
    constants : mapping of str to array
        ``list_constants``, as arrays of that library.
    psi1, chi, e : array
        Numbers of the impacts, arrays of one shape and type.
    joined : bool
        False if no e is above ``restituted.JOINED``, where the elastic table is needed too.
    with_slopes : callable
        As in ``contracts.whole_impact.Tabulated``.
    """
    inside = xp.isfinite(psi1) & (e >= 0.0) & (e <= 1.0)
    inside = inside & (chi >= RESTITUTED_CHI[0]) & (chi <= RESTITUTED_CHI[1])
    inside = inside & ((e < 1.0) | (chi <= of.LARGEST_CHI))
    sign = xp.where(psi1 < 0.0, -xp.ones_like(psi1), xp.ones_like(psi1))
    p = xp.where(inside, sign * psi1, HARMLESS)
    x, e = xp.where(inside, chi, 1.0), xp.where(inside, e, HARMLESS)
    full = p - 2.0 * x * (1.0 + e)
    psi2 = _partial(xp, constants, p, x, e, with_slopes)
    if joined:
        lossless = {
            name.removeprefix(ELASTIC): each
            for name, each in constants.items()
            if name.startswith(ELASTIC)
        }
        near = (e > restituted.JOINED) & (x <= of.LARGEST_CHI)
        y = xp.where(near, x, 1.0)
        one = xp.ones_like(e)
        step = _elastic(xp, lossless, p, y, with_slopes)
        step = step - _partial(xp, constants, p, y, one, with_slopes)
        psi2 = psi2 + xp.where(near, restituted._share(e) * step, 0.0)
    rest = xp.where(x < 0.5, 1.0 - 2.0 * x, 1.0)
    slow = xp.where((p > 0.0) & (p < 1.0), p, 1.0)
    dead = xp.where(x < 0.5, rest * slow ** (1.0 / rest), 0.0)
    psi2 = xp.where(e <= 0.0, xp.where(p > 0.0, dead, 0.0), psi2)
    psi2 = _bounded(xp, psi2, p, full)
    end = border(x, e)
    psi2 = xp.where(p < xp.where(end > 1.0, end, 1.0), psi2, full)
    return xp.where(inside, sign * psi2, xp.nan)


def _elastic(
    xp: Library, constants: Mapping[str, Traced], p: Traced, x: Traced, with_slopes: WithSlopes
) -> Traced:
    """Return psi2 of psi1 = p >= 0 and 0 < chi <= LARGEST_CHI."""
    full = p - 4.0 * x
    slips, big = p > 1.0, x >= 0.5
    through = slips & (p >= 4.0 * x - 1.0)
    epsilon, delta = abs(2.0 * x - 1.0), abs(p - 1.0)
    narrow = xp.where(epsilon > 0.0, epsilon, 1.0)
    ratio, height = delta / narrow, (x - 0.5) * of.PER_HEIGHT
    early = slips & ~through & (ratio > 0.0) & (ratio <= 1.0)
    share = xp.where(early, ratio, HARMLESS)
    t = share**0.2
    late, long = ratio > 1.0, t > of.CUT_END
    steep = _polynomial(constants["slip"][1:, ...], t - of.SLIP_MIDDLE)
    cut = constants["slip"][0, ...] + share * steep
    above_slip, b_slip = _across(xp, x, cut, of.CUT_TOP)
    stuck = xp.where(slips, 1.0, p)
    above_stuck, b_stuck = _across(xp, x, _polynomial(constants["stuck"], stuck), of.LARGEST_CHI)
    near = delta < epsilon
    tiny = xp.where(near & (delta > 0.0) & ~big, ratio, HARMLESS) ** 0.2
    wide = xp.where(delta > 0.0, delta, 1.0)

    def choose(*cases: Operand) -> Traced:
        """Return the case of each impact: late, long, above or below a cut; then those p <= 1."""
        slip_late, slip_long, slip_on, slip_back, stuck_on, stuck_back, small_near, small_far = (
            cases
        )
        slipping = xp.where(above_slip, slip_on, slip_back)
        slipping = xp.where(late, slip_late, xp.where(long, slip_long, slipping))
        sticking = xp.where(above_stuck, stuck_on, stuck_back)
        small = xp.where(near, small_near, small_far)
        return xp.where(slips, slipping, xp.where(big, sticking, small))

    region = choose(
        *(
            xp.full(p.shape, number, dtype=xp.int32)
            for number in (
                of.SLIP_LATE, of.SLIP_LONG, of.SLIP_ON, of.SLIP_BACK,
                of.STUCK_ON, of.STUCK_BACK, of.SMALL_NEAR, of.SMALL_FAR,
            )
        )
    )  # fmt: skip
    short, far = t * of.PER_SHORT, (t - of.CUT_END) * of.PER_LONG
    seam = _polynomial(constants["seam"], xp.where(b_slip > of.SEAM_FROM, b_slip, of.SEAM_FROM))
    seam = xp.where(seam < 1.0, seam, HARMLESS)  # below the cut b may be of any size
    on = xp.where(short < seam, 0.5 * short / seam, 0.5 + 0.5 * (short - seam) / (1.0 - seam))
    at_one = xp.where(delta > 0.0, tiny, 0.0)
    a = choose(ratio - 1.0, far, on, short, p, p, at_one, epsilon / wide)
    b = choose(height, height, b_slip, b_slip, b_stuck, b_stuck, epsilon, delta)
    measure = xp.where(slips | big | near, epsilon, delta)
    a, b = xp.where(through, HARMLESS, a), xp.where(through, HARMLESS, b)
    size = elastic.SIZE
    i, j = (_index(xp, each, size) for each in (a, b))
    patch = xp.take(constants["grid"], _flat(xp, (region * size + i) * size + j), axis=0)
    local = [
        each * _take(xp, constants["scales"][k, ...], patch, p.shape)
        - _take(xp, constants["starts"][k, ...], patch, p.shape)
        for k, each in enumerate((a, b))
    ]
    count = elastic.NODES
    g = _sum(xp, constants["terms"], patch, (count, count), local, p.shape, with_slopes)
    psi2 = p * (measure * g - 1.0)
    return xp.where(through, full, _bounded(xp, psi2, p, full))


def _bounded(xp: Library, psi2: Traced, p: Traced, full: Traced) -> Traced:
    """Return psi2 not below that of ``full`` slip, and within plus and minus psi1 = p."""
    psi2 = xp.where(psi2 < full, full, psi2)
    return xp.where(psi2 > p, p, xp.where(psi2 < -p, -p, psi2))


def _partial(
    xp: Library,
    constants: Mapping[str, Traced],
    p: Traced,
    x: Traced,
    e: Traced,
    with_slopes: WithSlopes,
) -> Traced:
    """Return psi2 by the table of restitutions, of impacts that stick at some time."""
    end, slips = border(x, e), p > 1.0
    inner = slips & (p < end)
    root = xp.where(inner, (end - p) / xp.where(inner, end - 1.0, 1.0), HARMLESS)
    u = xp.where(slips, 1.0 - root**0.5, p)
    region = xp.astype(x >= 0.5, xp.int32) + xp.astype(slips, xp.int32)
    for bound in SLIPPING:
        region = region + xp.astype(slips & (x >= bound), xp.int32)
    region = xp.where(slips & ~(x >= 0.5), xp.ones_like(region), region)
    flat, shape = _flat(xp, region), p.shape
    share = (x - _take(xp, constants["low"], flat, shape)) * _take(
        xp, constants["per_width"], flat, shape
    )
    where = xp.zeros_like(region)
    for k, each in enumerate((u, share, e)):
        size = _take(xp, constants["sizes"][k, ...], flat, shape)
        place = xp.astype(each * xp.astype(size, p.dtype), xp.int32)
        where = where * size + xp.where(place < 0, 0, xp.where(place < size, place, size - 1))
    where = where + _take(xp, constants["starts"], flat, shape)
    patch = xp.take(constants["grid"], _flat(xp, where), axis=0)
    local = [
        each - _take(xp, constants["origins"][k, ...], patch, shape)
        for k, each in enumerate((u, x, e))
    ]
    value = _sum(xp, constants["terms"], patch, NODES, local, shape, with_slopes)
    return xp.where(slips, value, p * value)


def _sum(
    xp: Library,
    terms: Traced,
    patch: Traced,
    counts: Sequence[int],
    local: Sequence[Traced],
    shape: tuple[int, ...],
    with_slopes: WithSlopes,
) -> Traced:
    """Return polynomials of local coordinates, whose terms are those of a patch.

    Their slopes are made apart, of rows of all terms: a library that differentiates each of the
    288 operations compiles for minutes.
    """

    def value(terms: Traced, patch: Traced, *local: Traced) -> Traced:
        return _horner(xp, terms, patch * math.prod(counts), counts, local, shape)

    def slopes(terms: Traced, patch: Traced, *local: Traced) -> list[Traced]:
        rows = xp.take(xp.reshape(terms, (-1, math.prod(counts))), patch, axis=0)
        powers = [_powers(xp, _flat(xp, each), n) for each, n in zip(local, counts, strict=True)]
        found = []
        for which in range(len(powers)):
            factors = [each[k == which] for k, each in enumerate(powers)]
            product = factors[0]
            for factor in factors[1:]:
                outer = product[:, :, None] * factor[:, None, :]
                product = xp.reshape(outer, (factor.shape[0], -1))
            found.append(xp.reshape(xp.sum(rows * product, axis=-1), shape))
        return found

    return with_slopes(value, slopes, 2)(terms, patch, *local)


def _powers(xp: Library, argument: Traced, count: int) -> tuple[Traced, Traced]:
    """Return powers of an argument, from 0 on, and their slopes, each of shape (items, count)."""
    powers = [xp.ones_like(argument)]
    for _ in range(count - 1):
        powers.append(powers[-1] * argument)
    slopes = [xp.zeros_like(argument), *(n * powers[n - 1] for n in range(1, count))]
    return xp.stack(powers, axis=-1), xp.stack(slopes, axis=-1)


def _horner(
    xp: Library,
    terms: Traced,
    first: Traced,
    counts: Sequence[int],
    local: Sequence[Traced],
    shape: tuple[int, ...],
) -> Traced:
    """Return polynomials of local coordinates by Horner's rule; terms begin at ``first``."""
    count, *others = counts
    width = math.prod(others)
    total: Traced | None = None
    for power in range(count - 1, -1, -1):
        start = first + power * width
        term = (
            _horner(xp, terms, start, others, local[1:], shape)
            if others
            else _take(xp, terms, start, shape)
        )
        total = term if total is None else total * local[0] + term
    assert total is not None
    return total


def _across(xp: Library, x: Traced, cut: Traced, top: float) -> tuple[Traced, Traced]:
    """Return whether chi is above a cut, and the second coordinate on its side."""
    above, beyond = x >= cut, x > cut
    root = xp.where(beyond & (cut < top), (x - cut) / xp.where(cut < top, top - cut, 1.0), HARMLESS)
    below = (x - 0.5) / xp.where(cut > 0.5, cut - 0.5, 1.0)
    return above, xp.where(beyond, root**0.5, xp.where(above, 0.0, below))


def _polynomial(terms: Traced, argument: Traced) -> Traced:
    """Return the polynomial with ``terms``, lowest first."""
    total = terms[-1, ...]
    for power in range(terms.shape[0] - 2, -1, -1):
        total = total * argument + terms[power, ...]
    return total


def _index(xp: Library, share: Traced, size: int) -> Traced:
    """Return the places of coordinates in [0, 1] in a grid."""
    place = xp.astype(share * size, xp.int32)
    return xp.where(place < 0, 0, xp.where(place < size, place, size - 1))


def _flat(xp: Library, index: Traced) -> Traced:
    """Return an index as one axis: ``take`` of the standard needs one."""
    return xp.reshape(index, (-1,))


def _take(xp: Library, values: Traced, index: Traced, shape: tuple[int, ...]) -> Traced:
    """Return ``values`` at an index of one axis, in the shape of the impacts."""
    return xp.reshape(xp.take(values, index, axis=0), shape)
