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


def begin(state: Sequence[float]) -> Rows:
    """Return series that begin with the numbers of a state."""
    return [[number] + [0.0] * ORDER for number in state]


def product(a: Series, b: Series, n: int) -> float:
    """Return the coefficient n of the product of two series."""
    total: float = sum(map(mul, a, b[n::-1]))
    return total


def lower(a: Series, b: Series, n: int) -> float:
    """Return the coefficient n of the product of two series, without a_n b_0."""
    total: float = sum(map(mul, a, b[n:0:-1]))
    return total


def value(series: Series, t: float) -> float:
    """Return the value at t by Horner's rule."""
    total: float = 0.0
    for coefficient in reversed(series):
        total = total * t + coefficient
    return total


class Contact:
    """A contact whose u, V and k are found order by order, with the J; V' and k' are kept."""

    def __init__(self, laws: Laws, u: Series, rate: Series, margin: Series, lack: Series) -> None:
        self.laws, self.rows = laws, (u, rate, margin, lack)
        self.square, self.fourth, self.forces, self.pulls = begin((0.0,) * 4)

    def press(self, n: int) -> None:
        """Find the coefficients n of V' and k'."""
        press, relief, drive, spring = self.laws
        u, _, _, lack = self.rows
        self.square[n] = product(u, u, n)
        self.fourth[n] = fourth = product(self.square, self.square, n)
        held = product(u, lack, n)
        self.forces[n] = -2.5 * (press * fourth - relief * held)
        self.pulls[n] = 2.5 * (drive * fourth - spring * held)

    def move(self, n: int, way: float = 1.0) -> None:
        """Find the coefficients n + 1 where the variable is x, or -x."""
        u, rate, margin, _ = self.rows
        share = way * SHARES[n]
        u[n + 1] = share * rate[n]
        rate[n + 1] = share * self.forces[n]
        margin[n + 1] = share * self.pulls[n]

    def move_along(self, n: int, pace: Series, share: float) -> None:
        """Find the coefficients n + 1 where x has the slope ``pace``, times (n + 1) ``share``."""
        u, rate, margin, _ = self.rows
        u[n + 1] = share * product(rate, pace, n)
        rate[n + 1] = share * product(self.forces, pace, n)
        margin[n + 1] = share * product(self.pulls, pace, n)


def along_whole(laws: Laws, state: Sequence[float], *, sticks: bool) -> Rows:
    """Return u, V, k, J, c, x and T while all sticks, c = u, or all slips, J = c = 0."""
    U, V, K, J, _, X, T = rows = begin(state)
    X[1] = 1.0
    contact = Contact(laws, U, V, K, J)
    for n, share in enumerate(SHARES):
        contact.press(n)
        contact.move(n)
        T[n + 1] = 2.0 * share * U[n]
        if sticks:
            J[n + 1] = 2.0 * share * product(contact.square, K, n)
    if sticks:
        rows[4] = U
    return rows


def follow_unlocking(laws: Laws, state: Sequence[float], *, inmost: bool) -> Rows:
    """Return u, V, k, J, c and T while a zone slips that was locked out of the other sign.

    There m + 2c² and J - (4/3) c³ are constant, and 2 c dc = u k dx. The variable is x or, for
    ``inmost`` fronts, one in which dx = 2 c and dc = u k: as c² goes through zero, c ends.
    """
    U, V, K, J, C, T = rows = begin(state)
    gone, run = begin((0.0, 0.0))
    contact = Contact(laws, U, V, K, J)
    for n, share in enumerate(SHARES):
        contact.press(n)
        gone[n] = product(U, K, n)
        twice = 2.0 * share
        if inmost:
            contact.move_along(n, C, twice)
            T[n + 1] = 2.0 * twice * product(U, C, n)
            C[n + 1] = share * gone[n]
            run[n] = 2.0 * product(C, gone, n)
            J[n + 1] = twice * product(C, run, n)
        else:
            contact.move(n)
            T[n + 1] = twice * U[n]
            run[n] = (0.5 * gone[n] - lower(run, C, n)) / C[0]
            C[n + 1] = share * run[n]
            J[n + 1] = twice * product(C, gone, n)
    return rows


def retrace(laws: Laws, state: Sequence[float], *, fresh: bool, back: bool) -> Rows:
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
    U, V, K, J, C, V1, K1, X1, T = rows = begin(state)
    way = -1.0 if back else 1.0
    motion, memory = Contact(laws, U, V, K, J), Contact(laws, C, V1, K1, J)
    lead, trail = (memory, motion) if back else (motion, memory)
    # u k of the leading contact, u k of the other or, where slip begins, that over x, and its pace
    gone, other, run = begin((0.0,) * 3)
    for n, share in enumerate(SHARES):
        lead.press(n)
        trail.press(n)
        lead.move(n, way)
        gone[n] = way * product(lead.rows[0], lead.rows[2], n)
        if not fresh:
            other[n] = product(trail.rows[0], trail.rows[2], n)
            run[n] = (gone[n] - lower(run, other, n)) / other[0]
        elif n == 0:
            run[0], other[0] = -1.0, -C[0] * trail.pulls[0]
        else:  # the coefficient sought stands in k_1 too, as k_1' is the pull times dx_1/dx
            own = C[0] * share * trail.pulls[0]
            rest = C[0] * share * lower(run, trail.pulls, n) + lower(K1, C, n + 1)
            known = lower(U, K, n + 1) - lower(other, run, n)
            run[n] = (known + rest) / (other[0] - own)
            other[n] = rest + own * run[n]
        trail.move_along(n, run, share)
        J[n + 1] = 2.0 * share * product(C, gone, n)
        T[n + 1] = 2.0 * share * (product(U, run, n) if back else U[n])
        X1[n + 1] = (0.0 if n else -1.0) if back else share * run[n]
    return rows
