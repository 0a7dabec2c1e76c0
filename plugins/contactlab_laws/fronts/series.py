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

A series is a list of coefficients, plain numbers.
"""

from __future__ import annotations

from operator import mul
from typing import NamedTuple, TypeAlias

Series: TypeAlias = list[float]

#: Coefficients of a series: at 1e-12 a step then spans a quarter of the radius of convergence.
ORDER = 16
ORDERS = range(ORDER)


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


def product(a: Series, b: Series, n: int) -> float:
    """Return the coefficient n of a product."""
    total: float = sum(map(mul, a, b[n::-1]))
    return total


def value(series: Series, t: float) -> float:
    """Return the value at t by Horner's rule."""
    total = 0.0
    for coefficient in reversed(series):
        total = total * t + coefficient
    return total


class Forces:
    """V' and k' of one contact, order by order, from its u and the J."""

    def __init__(self, laws: Laws, u: Series, lack: Series) -> None:
        self.laws, self.u, self.lack = laws, u, lack
        self.square: Series = []
        self.fourth: Series = []
        self.rate: Series = []
        self.margin: Series = []

    def next(self, n: int) -> None:
        """Append the coefficients n."""
        press, relief, drive, spring = self.laws
        self.square.append(product(self.u, self.u, n))
        fourth, held = product(self.square, self.square, n), product(self.u, self.lack, n)
        self.fourth.append(fourth)
        self.rate.append(-2.5 * (press * fourth - relief * held))
        self.margin.append(2.5 * (drive * fourth - spring * held))


def stuck(laws: Laws, u: float, rate: float, margin: float, lack: float) -> list[Series]:
    """Return u, V, k, J and T over x while all sticks."""
    U, V, K, J, T, uk = [u], [rate], [margin], [lack], [0.0], []
    forces = Forces(laws, U, J)
    for n in ORDERS:
        share = 1.0 / (n + 1)
        forces.next(n)
        uk.append(product(U, K, n))
        J.append(2.0 * product(U, uk, n) * share)
        T.append(2.0 * U[n] * share)
        U.append(V[n] * share)
        V.append(forces.rate[n] * share)
        K.append(forces.margin[n] * share)
    return [U, V, K, J, T]


class Friction:
    """Time and friction work while the edge slips, order by order."""

    def __init__(self, u: Series, front: Series) -> None:
        self.u, self.front = u, front
        self.width: Series = []
        self.square: Series = []
        self.length: Series = []
        self.part: Series = []

    def next(self, n: int) -> float:
        """Return the coefficient n of (u - c)² (2u + c), the work over -u k dx."""
        u, c = self.u[n], self.front[n]
        self.width.append(u - c)
        self.length.append(2.0 * u + c)
        self.square.append(product(self.width, self.width, n))
        return product(self.square, self.length, n)


def along_drawn(
    laws: Laws, now: tuple[float, float, float], then: tuple[float, ...], *, fresh: bool
) -> list[Series]:
    """Return u, V, k; u, V, k, J on the memory; x_1, T and work while a drawn piece slips.

    Parameters
    ----------
    laws : Laws
    now : tuple of float
        u, V and k.
    then : tuple of float
        u, V, k and J where the front is on the memory.
    fresh : bool
        True where slip begins, with k = k_1 = 0: the variable is then x, else the one in which
        dx = c k_1 and dx_1 = u k.
    """
    U, V, K = ([each] for each in now)
    C, V1, K1, J = ([each] for each in then)
    X1, T, W = [0.0], [0.0], [0.0]
    ahead, back = Forces(laws, U, J), Forces(laws, C, J)
    friction, lost = Friction(U, C), []
    pace: Series = []  # dx
    run: Series = []  # dx_1
    gone: Series = []  # u k dx
    slope: Series = []
    start: Series = []
    known: Series = []
    for n in ORDERS:
        share = 1.0 / (n + 1)
        ahead.next(n)
        back.next(n)
        if fresh:
            pace.append(0.0 if n else 1.0)
            K.append(ahead.margin[n] * share)
            known.append(product(U, K[1:], n))
            run.append(_fresh(n, C, back.margin, run, slope, start, known))
            K1.append(slope[n])
            gone.append(product(U, K, n))
        else:
            pace.append(product(C, K1, n))
            run.append(product(U, K, n))
            gone.append(product(pace, run, n))
            K.append(product(ahead.margin, pace, n) * share)
            K1.append(product(back.margin, run, n) * share)
        lost.append(friction.next(n))
        W.append(-product(lost, gone, n) * share)
        T.append(2.0 * product(U, pace, n) * share)
        X1.append(run[n] * share)
        J.append(2.0 * product(C, gone, n) * share)
        U.append(product(V, pace, n) * share)
        V.append(product(ahead.rate, pace, n) * share)
        C.append(product(V1, run, n) * share)
        V1.append(product(back.rate, run, n) * share)
    return [U, V, K, C, V1, K1, J, X1, T, W]


def _fresh(
    n: int, front: Series, back: Series, run: Series, slope: Series, start: Series, known: Series
) -> float:
    """Return the coefficient n of dx_1/dx where slip begins, from (c K_1) dx_1/dx = u K.

    K = k/x and K_1 = k_1/x are ``slope`` and its like; ``start`` is c K_1, ``known`` u K. The
    coefficient stands in K_1 too, as k_1' = ``back`` dx_1/dx.
    """
    share = 1.0 / (n + 1)
    if n == 0:
        slope.append(-back[0])
        start.append(-front[0] * back[0])
        return -1.0
    part = sum(map(mul, back[1 : n + 1], run[n - 1 :: -1])) * share
    rest = front[0] * part + sum(map(mul, front[1 : n + 1], slope[n - 1 :: -1]))
    middle = sum(map(mul, start[1:n], run[n - 1 : 0 : -1])) if n > 1 else 0.0
    own = back[0] * share
    coefficient: float = (known[n] - middle + rest) / (start[0] - front[0] * own)
    slope.append(part + own * coefficient)
    start.append(rest + front[0] * own * coefficient)
    return coefficient


def along_locked(
    laws: Laws, now: tuple[float, float, float], front: float, base: float
) -> list[Series]:
    """Return u, V, k, c, T and work while a zone slips that was locked out of the other sign.

    There m + 2c² and J - (4/3) c³ = ``base`` are constant; in the variable dx = 2c, dc = u k.
    """
    U, V, K = ([each] for each in now)
    C, T, W = [front], [0.0], [0.0]
    J: Series = []
    square: Series = []
    run: Series = []
    gone: Series = []
    lost: Series = []
    forces, friction = Forces(laws, U, J), Friction(U, C)
    for n in ORDERS:
        share = 1.0 / (n + 1)
        square.append(product(C, C, n))
        J.append((4.0 / 3.0) * product(square, C, n) + (0.0 if n else base))
        forces.next(n)
        run.append(product(U, K, n))
        gone.append(product(C, run, n))
        lost.append(friction.next(n))
        W.append(-2.0 * product(lost, gone, n) * share)
        T.append(4.0 * product(U, C, n) * share)
        U.append(2.0 * product(V, C, n) * share)
        V.append(2.0 * product(forces.rate, C, n) * share)
        K.append(2.0 * product(forces.margin, C, n) * share)
        C.append(run[n] * share)
    return [U, V, K, C, T, W]


#: Places in a step at which events are looked for, and where a root has been found.
LOOKS, ROOT_VALUE, ROOT_WIDTH, ROOT_CAP = 8, 1e-17, 1e-16, 80


def first_fall(events: list[tuple[Series, bool]], end: float) -> tuple[float, int]:
    """Return where the first of some series falls below zero in (0, end], and which; (end, -1).

    A series marked True begins at zero: the fall of the series over t is looked for.
    """
    where, which = end, -1
    for index, (series, fresh) in enumerate(events):
        found = _fall(series[1:] if fresh else series, where)
        if found is not None:
            where, which = found, index
    return where, which


def _fall(series: Series, end: float) -> float | None:
    """Return the first place at which a series is negative, seen at ``LOOKS`` places."""
    step = end / LOOKS
    seen = [series[0]]
    for look in range(1, LOOKS + 1):
        t = step * look
        here = value(series, t)
        seen.append(here)
        before = seen[look - 1]
        if here < 0.0:
            return _root(series, t - step, t, before, here)
        if look > 1 and before < seen[look - 2] and before < here:  # a dip, perhaps below zero
            slope, bend = 0.5 * (here - seen[look - 2]), here + seen[look - 2] - 2.0 * before
            t = step * (look - 1 - slope / bend)
            lowest = value(series, t)
            if lowest < 0.0:
                return _root(series, step * (look - 2), t, seen[look - 2], lowest)
    return None


def _root(series: Series, a: float, b: float, at_a: float, at_b: float) -> float:
    """Return the root between a and b by the Illinois method."""
    if at_a <= 0.0:
        return a
    side, t = 0, a
    for _ in range(ROOT_CAP):
        t = (at_a * b - at_b * a) / (at_a - at_b)
        here = value(series, t)
        if abs(here) < ROOT_VALUE or b - a < ROOT_WIDTH:
            break
        if here > 0.0:
            a, at_a, at_b = t, here, 0.5 * at_b if side > 0 else at_b
            side = 1
        else:
            b, at_b, at_a = t, here, 0.5 * at_a if side < 0 else at_a
            side = -1
    return t
