"""Taylor series of the five equations of an impact, in its phases (theory §14).

With u the contact radius (zeta = u²), V the rate of approach, s the sign in which the edge slips or
would, k = V - s psi, J = (2/3)(P - s F), c the radius within which all sticks, and dT = 2 u dx,

    u' = V    V' = -2.5 u [(1 + s lam) u³ - 1.5 s lam J]    J' = 2 u c k    (' = d/dx)
    k' = 2.5 u [(2 chi + s eta - 1 - s lam) u³ - (3 chi - 1.5 s lam) J]

Stuck, c = u. Slipping, c runs back along the memory. A piece of memory that was drawn while all
stuck obeys the equations of sticking: it is followed backwards beside the motion, and no curve is
kept. Its contact radius is the front c, its J is the J of the motion. As m = const along both,
dx : dx_1 = u_1 k_1 : u k, with u_1 = c. The variable is that of the two whose u k is the smaller.
Where slip begins both are zero, and x_1 = x_0 - (x - x_0) + ... follows order by order.

A series is a list of coefficients. ``contactlab_impact.h`` is the same in C.
"""

from __future__ import annotations

from collections.abc import Sequence
from operator import mul
from typing import NamedTuple, TypeAlias

#: Coefficients, and several series.
Series: TypeAlias = list[float]
Rows: TypeAlias = list[Series]

#: Last coefficient of a series: at 1e-12 a step then spans a quarter of the radius of convergence.
ORDER = 20
#: 1/(n + 1), by which the coefficient n of a slope is the coefficient n + 1.
SHARES = [1.0 / (n + 1) for n in range(ORDER)]


class Laws(NamedTuple):
    """The numbers in the equations: 1 + s lam, 1.5 s lam, 2 chi + s eta - 1 - s lam, 3 chi - ..."""

    press: float
    relief: float
    drive: float
    spring: float

    @classmethod
    def of(cls, sign: int, chi: float, lam: float, eta: float) -> Laws:
        """Return the numbers for slip of one sign."""
        press, relief = 1.0 + sign * lam, 1.5 * sign * lam
        return cls(press, relief, 2.0 * chi + sign * eta - press, 3.0 * chi - relief)


def blank(count: int) -> list[Series]:
    """Return series of zeros."""
    return [[0.0] * (ORDER + 1) for _ in range(count)]


def product(a: Series, b: Series, n: int) -> float:
    """Return the coefficient n of the product of two series."""
    total: float = sum(map(mul, a, b[n::-1]))
    return total


def lower(a: Series, b: Series, n: int) -> float:
    """Return the coefficient n of the product of two series, without a_n b_0."""
    total: float = sum(map(mul, a, b[n:0:-1]))
    return total


def difference(a: Series, b: Series) -> Series:
    """Return a - b."""
    return [x - y for x, y in zip(a, b, strict=True)]


def negative(a: Series) -> Series:
    """Return -a."""
    return [-x for x in a]


def value(series: Series, t: float) -> float:
    """Return the value at t by Horner's rule."""
    total: float = 0.0
    for coefficient in reversed(series):
        total = total * t + coefficient
    return total


class Forces:
    """V' and k' of one contact, order by order, from its u and the J."""

    def __init__(self, laws: Laws, u: Series, lack: Series) -> None:
        self.laws, self.u, self.lack = laws, u, lack
        self.square, self.fourth, self.rate, self.margin = blank(4)

    def next(self, n: int) -> tuple[float, float]:
        """Find, and return, the coefficients n."""
        press, relief, drive, spring = self.laws
        u = self.u
        self.square[n] = product(u, u, n)
        self.fourth[n] = fourth = product(self.square, self.square, n)
        held = product(u, self.lack, n)
        self.rate[n] = rate = -2.5 * (press * fourth - relief * held)
        self.margin[n] = margin = 2.5 * (drive * fourth - spring * held)
        return rate, margin


def along_stick(laws: Laws, state: Sequence[float]) -> Rows:
    """Return u, V, k, J, x and T while all sticks, from their values."""
    U, V, K, J, X, T = rows = blank(6)
    for row, begin in zip(rows, state, strict=False):
        row[0] = begin
    X[1] += 1.0
    forces = Forces(laws, U, J)
    for n, share in enumerate(SHARES):
        rate, margin = forces.next(n)
        J[n + 1] = 2.0 * share * product(forces.square, K, n)
        T[n + 1] = 2.0 * share * U[n]
        U[n + 1] = share * V[n]
        V[n + 1] = share * rate
        K[n + 1] = share * margin
    return rows


def along_gross(laws: Laws, state: Sequence[float]) -> Rows:
    """Return u, V, k, J = 0 and T while all slips."""
    U, V, K, J, T = rows = blank(5)
    for row, begin in zip(rows, state, strict=False):
        row[0] = begin
    forces = Forces(laws, U, J)
    for n, share in enumerate(SHARES):
        rate, margin = forces.next(n)
        T[n + 1] = 2.0 * share * U[n]
        U[n + 1] = share * V[n]
        V[n + 1] = share * rate
        K[n + 1] = share * margin
    return rows


def along_drawn(laws: Laws, state: Sequence[float], *, fresh: bool, back: bool) -> Rows:
    """Return u, V, k, J; c, V_1, k_1 on the memory, what is left of it in x_1; and T.

    Parameters
    ----------
    laws : Laws
    state : tuple
        Their values.
    fresh : bool
        True where slip begins, with k = k_1 = 0.
    back : bool
        True if x_1, which falls, is the variable, and not x.
    """
    U, V, K, J, C, V1, K1, X1, T = rows = blank(9)
    for row, begin in zip(rows, state, strict=False):
        row[0] = begin
    way = -1.0 if back else 1.0
    (u, v, k), (u1, v1, k1) = ((C, V1, K1), (U, V, K)) if back else ((U, V, K), (C, V1, K1))
    lead, trail = Forces(laws, u, J), Forces(laws, u1, J)
    # u k of both, the pace of the other, and its k over x where slip begins
    gone, other, run, slope = blank(4)
    for n, share in enumerate(SHARES):
        ahead = way * share
        rate, margin = lead.next(n)
        trail.next(n)
        u[n + 1] = ahead * v[n]
        v[n + 1] = ahead * rate
        k[n + 1] = ahead * margin
        if fresh:
            known = lower(U, K, n + 1)
            run[n] = _fresh(n, C, trail.margin, run, slope, other, known)
            k1[n + 1] = slope[n]
            gone[n] = product(u, k, n)
        else:
            gone[n] = way * product(u, k, n)
            other[n] = product(u1, k1, n)
            run[n] = (gone[n] - lower(run, other, n)) / other[0]
            k1[n + 1] = share * product(trail.margin, run, n)
        u1[n + 1] = share * product(v1, run, n)
        v1[n + 1] = share * product(trail.rate, run, n)
        J[n + 1] = 2.0 * share * product(C, gone, n)
        T[n + 1] = 2.0 * share * (product(U, run, n) if back else U[n])
        X1[n + 1] = (0.0 if n else -1.0) if back else share * run[n]
    return rows


def _fresh(
    n: int,
    front: Series,
    back: Series,
    run: Series,
    slope: Series,
    start: Series,
    known: float,
) -> float:
    """Return the coefficient n of dx_1/dx where slip begins, from (c K_1) dx_1/dx = u K.

    K = k/x and K_1 = k_1/x are ``slope`` and its like; ``start`` is c K_1, ``known`` u K. The
    coefficient stands in K_1 too, as k_1' = ``back`` dx_1/dx.
    """
    if n == 0:
        slope[0] = -back[0]
        start[0] = -front[0] * back[0]
        return -1.0
    part = SHARES[n] * lower(run, back, n)
    rest = front[0] * part + lower(slope, front, n)
    own = SHARES[n] * back[0]
    # run[n], the coefficient sought, is still zero
    coefficient = (known - lower(start, run, n) + rest) / (start[0] - front[0] * own)
    slope[n] = part + own * coefficient
    start[n] = rest + front[0] * own * coefficient
    return coefficient


def along_locked(laws: Laws, state: Sequence[float], *, inmost: bool) -> Rows:
    """Return u, V, k, J, c and T while a zone slips that was locked out of the other sign.

    There m + 2c² and J - (4/3) c³ are constant, and 2 c dc = u k dx. The variable is x or, for
    ``inmost`` fronts, one in which dx = 2 c and dc = u k: as c² goes through zero, c ends.
    """
    U, V, K, J, C, T = rows = blank(6)
    for row, begin in zip(rows, state, strict=False):
        row[0] = begin
    gone, run = blank(2)
    forces = Forces(laws, U, J)
    for n, share in enumerate(SHARES):
        rate, margin = forces.next(n)
        gone[n] = product(U, K, n)
        if inmost:
            twice = 2.0 * share
            U[n + 1] = twice * product(V, C, n)
            V[n + 1] = twice * product(forces.rate, C, n)
            K[n + 1] = twice * product(forces.margin, C, n)
            T[n + 1] = 2.0 * twice * product(U, C, n)
            C[n + 1] = share * gone[n]
            run[n] = 2.0 * product(C, gone, n)
            J[n + 1] = twice * product(C, run, n)
        else:
            U[n + 1] = share * V[n]
            V[n + 1] = share * rate
            K[n + 1] = share * margin
            T[n + 1] = 2.0 * share * U[n]
            run[n] = (0.5 * gone[n] - lower(run, C, n)) / C[0]
            C[n + 1] = share * run[n]
            J[n + 1] = 2.0 * share * product(C, gone, n)
    return rows
