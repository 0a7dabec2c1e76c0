"""Taylor series of the equations of an eccentric impact, in its three phases (theory §14).

With u the contact radius (zeta = u²), V the rate of approach, s the sign in which the edge slips or
would, k = V - s psi, J = (2/3)(P - s F), c the radius within which all sticks, and dT = 2 u dx,

    u' = V    V' = -2.5 u [(1 + s lam) u³ - 1.5 s lam J]    J' = 2 u c k    (' = d/dx)
    k' = 2.5 u [(2 chi + s eta - 1 - s lam) u³ - (3 chi - 1.5 s lam) J]

Stuck, c = u. Slipping, c runs back along the memory. A piece of memory that was drawn while all
stuck obeys the equations of sticking: it is followed backwards beside the motion, and no curve is
kept. Its contact radius is the front c, its J is the J of the motion. As m = const along both,
dx : dx_1 = c k_1 : u k, which is regular wherever k and k_1 are not both zero. Where slip begins
they are, and x_1 = x_0 - (x - x_0) + ... follows order by order.

A series is a list of coefficients, plain numbers; those of many impacts are an array, of shape
(orders, impacts).
"""

from __future__ import annotations

from operator import mul
from typing import Any, NamedTuple, TypeAlias

import numpy as np

#: Coefficients of one impact in a list, or those of many in the rows of an array.
Series: TypeAlias = Any
#: A number of one impact, or those of many.
Number: TypeAlias = Any

#: Last coefficient of a series: at 1e-12 a step then spans a quarter of the radius of convergence.
ORDER = 16
ORDERS = range(ORDER)


class Laws(NamedTuple):
    """The numbers in the equations: 1 + s lam, 1.5 s lam, 2 chi + s eta - 1 - s lam, 3 chi - ..."""

    press: Number
    relief: Number
    drive: Number
    spring: Number

    @classmethod
    def of(cls, sign: int, chi: float, lam: float, eta: float) -> Laws:
        """Return the numbers for slip of one sign."""
        press, relief = 1.0 + sign * lam, 1.5 * sign * lam
        return cls(press, relief, 2.0 * chi + sign * eta - press, 3.0 * chi - relief)


def blank(count: int, like: Number) -> list[Series]:
    """Return series of zeros, for as many impacts as ``like`` has numbers."""
    if isinstance(like, float):
        return [[0.0] * (ORDER + 1) for _ in range(count)]
    return list(np.zeros((count, ORDER + 1, like.size)))


def product(a: Series, b: Series, n: int) -> Number:
    """Return the coefficient n of a product."""
    if isinstance(a, list):
        return sum(map(mul, a, b[n::-1]))
    return np.einsum("ij,ij->j", a[: n + 1], b[n::-1])


def difference(a: Series, b: Series) -> Series:
    """Return a - b."""
    return [x - y for x, y in zip(a, b, strict=True)] if isinstance(a, list) else a - b


def negative(a: Series) -> Series:
    """Return -a."""
    return [-x for x in a] if isinstance(a, list) else -a


def value(series: Series, t: Number) -> Number:
    """Return the value at t by Horner's rule."""
    total: Number = 0.0
    for coefficient in reversed(series):
        total = total * t + coefficient
    return total


class Forces:
    """V' and k' of one contact, order by order, from its u and the J."""

    def __init__(self, laws: Laws, u: Series, lack: Series) -> None:
        self.laws, self.u, self.lack = laws, u, lack
        self.square, self.fourth, self.rate, self.margin = blank(4, u[0])

    def next(self, n: int) -> None:
        """Find the coefficients n."""
        press, relief, drive, spring = self.laws
        self.square[n] = product(self.u, self.u, n)
        fourth, held = product(self.square, self.square, n), product(self.u, self.lack, n)
        self.fourth[n] = fourth
        self.rate[n] = -2.5 * (press * fourth - relief * held)
        self.margin[n] = 2.5 * (drive * fourth - spring * held)


class Friction:
    """The friction work while the edge slips, order by order."""

    def __init__(self, u: Series, front: Series) -> None:
        self.u, self.front = u, front
        self.width, self.square, self.length = blank(3, u[0])

    def next(self, n: int) -> Number:
        """Return the coefficient n of (u - c)² (2u + c), the work over -u k dx."""
        u, c = self.u[n], self.front[n]
        self.width[n] = u - c
        self.length[n] = 2.0 * u + c
        self.square[n] = product(self.width, self.width, n)
        return product(self.square, self.length, n)


def along_stick(laws: Laws, u: Number, rate: Number, margin: Number, lack: Number) -> list[Series]:
    """Return u, V, k, J and T over x while all sticks."""
    U, V, K, J, T, uk = rows = blank(6, u)
    U[0], V[0], K[0], J[0] = u, rate, margin, lack
    forces = Forces(laws, U, J)
    for n in ORDERS:
        share = 1.0 / (n + 1)
        forces.next(n)
        uk[n] = product(U, K, n)
        J[n + 1] = 2.0 * product(U, uk, n) * share
        T[n + 1] = 2.0 * U[n] * share
        U[n + 1] = V[n] * share
        V[n + 1] = forces.rate[n] * share
        K[n + 1] = forces.margin[n] * share
    return rows[:5]


def along_gross(laws: Laws, u: Number, rate: Number, margin: Number) -> list[Series]:
    """Return u, V, k, J = 0 and T over x while all slips."""
    U, V, K, _, T, square = rows = blank(6, u)
    U[0], V[0], K[0] = u, rate, margin
    for n in ORDERS:
        share = 1.0 / (n + 1)
        square[n] = product(U, U, n)
        fourth = product(square, square, n)
        T[n + 1] = 2.0 * U[n] * share
        U[n + 1] = V[n] * share
        V[n + 1] = -2.5 * laws.press * fourth * share
        K[n + 1] = 2.5 * laws.drive * fourth * share
    return rows[:5]


def along_drawn(
    laws: Laws, now: tuple[Number, ...], then: tuple[Number, ...], left: Number, *, fresh: bool
) -> list[Series]:
    """Return u, V, k, J, T; u, V, k on the memory, what is left of it, and work.

    Parameters
    ----------
    laws : Laws
    now : tuple
        u, V and k.
    then : tuple
        u, V, k and J where the front is on the memory.
    left : number
        Length of the memory in x, which the front runs back along.
    fresh : bool
        True where slip begins, with k = k_1 = 0: the variable is then x, else the one in which
        dx = c k_1 and dx_1 = u k.
    """
    U, V, K, J, T, C, V1, K1, X1, W = rows = blank(10, left)
    U[0], V[0], K[0] = now
    C[0], V1[0], K1[0], J[0] = then
    X1[0] = left
    ahead, back = Forces(laws, U, J), Forces(laws, C, J)
    friction = Friction(U, C)
    # dx, dx_1, u k dx, and what the work is made of
    pace, run, gone, lost, slope, start, known = blank(7, left)
    for n in ORDERS:
        share = 1.0 / (n + 1)
        ahead.next(n)
        back.next(n)
        if fresh:
            pace[n] = 0.0 if n else 1.0
            K[n + 1] = ahead.margin[n] * share
            known[n] = product(U, K[1:], n)
            run[n] = _fresh(n, C, back.margin, run, slope, start, known)
            K1[n + 1] = slope[n]
            gone[n] = product(U, K, n)
        else:
            pace[n] = product(C, K1, n)
            run[n] = product(U, K, n)
            gone[n] = product(pace, run, n)
            K[n + 1] = product(ahead.margin, pace, n) * share
            K1[n + 1] = product(back.margin, run, n) * share
        lost[n] = friction.next(n)
        W[n + 1] = -product(lost, gone, n) * share
        T[n + 1] = 2.0 * product(U, pace, n) * share
        X1[n + 1] = run[n] * share
        J[n + 1] = 2.0 * product(C, gone, n) * share
        U[n + 1] = product(V, pace, n) * share
        V[n + 1] = product(ahead.rate, pace, n) * share
        C[n + 1] = product(V1, run, n) * share
        V1[n + 1] = product(back.rate, run, n) * share
    return rows


def _fresh(
    n: int, front: Series, back: Series, run: Series, slope: Series, start: Series, known: Series
) -> Number:
    """Return the coefficient n of dx_1/dx where slip begins, from (c K_1) dx_1/dx = u K.

    K = k/x and K_1 = k_1/x are ``slope`` and its like; ``start`` is c K_1, ``known`` u K. The
    coefficient stands in K_1 too, as k_1' = ``back`` dx_1/dx.
    """
    share = 1.0 / (n + 1)
    if n == 0:
        slope[0] = -back[0]
        start[0] = -front[0] * back[0]
        return -1.0
    part = product(back[1:], run, n - 1) * share
    rest = front[0] * part + product(front[1:], slope, n - 1)
    middle = product(start[1:], run[1:], n - 2) if n > 1 else 0.0
    own = back[0] * share
    coefficient = (known[n] - middle + rest) / (start[0] - front[0] * own)
    slope[n] = part + own * coefficient
    start[n] = rest + front[0] * own * coefficient
    return coefficient


def along_locked(laws: Laws, now: tuple[Number, ...], front: Number, base: Number) -> list[Series]:
    """Return u, V, k, J, T, c and work while a zone slips that was locked out of the other sign.

    There m + 2c² and J - (4/3) c³ = ``base`` are constant; in the variable dx = 2c, dc = u k.
    """
    U, V, K, J, T, C, W = rows = blank(7, front)
    U[0], V[0], K[0] = now
    C[0] = front
    square, run, gone, lost = blank(4, front)
    forces, friction = Forces(laws, U, J), Friction(U, C)
    for n in range(ORDER + 1):
        share = 1.0 / (n + 1)
        square[n] = product(C, C, n)
        J[n] = (4.0 / 3.0) * product(square, C, n) + (0.0 if n else base)
        if n == ORDER:
            break
        forces.next(n)
        run[n] = product(U, K, n)
        gone[n] = product(C, run, n)
        lost[n] = friction.next(n)
        W[n + 1] = -2.0 * product(lost, gone, n) * share
        T[n + 1] = 4.0 * product(U, C, n) * share
        U[n + 1] = 2.0 * product(V, C, n) * share
        V[n + 1] = 2.0 * product(forces.rate, C, n) * share
        K[n + 1] = 2.0 * product(forces.margin, C, n) * share
        C[n + 1] = run[n] * share
    return rows
