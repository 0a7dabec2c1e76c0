"""psi2 of planar central impacts by springs that lose as the normal contact does (theory §15).

Each impact has its own relaxation time and steps; impacts that share both share one normal motion.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Real
from contactlab_laws.viscoelastic.motion import Course, course

#: Displacements of springs that are followed together: they stay in the processor's cache.
TOGETHER = 1 << 17
#: Change of a half kick with psi above which the force at the end of a step is found by Newton's
#: method, else by one pass; the most turns, and the change of psi that ends them.
STIFF, TURNS, SETTLED = 0.1, 30, 1e-14
#: a that stands for 0: exp(-h/a) = 0.
LEAST = 1e-300


def rebound(psi1: Array, chi: Array, number: Real, *, springs: int, steps: int) -> Array:
    """Return psi2 of psi1 >= 0, shape (impacts,).

    Parameters
    ----------
    psi1, chi : array, shape (impacts,)
    number : float or array, shape (impacts,)
        a = A v1/(C² R) of each impact.
    springs : int
        Springs within the largest contact.
    steps : int
        Steps of an impact, an even number.
    """
    psi2, width = np.empty(psi1.shape), max(TOGETHER // (springs + 1), 1)
    a, alike = np.maximum(np.atleast_1d(number), LEAST), np.ndim(number) == 0
    path = course(a, steps) if alike else None
    for first in range(0, psi1.size, width):
        part = slice(first, first + width)
        own = a if alike else a[part]
        psi2[part] = _follow_once(psi1[part], chi[part], own, path or course(own, steps), springs)
    return np.clip(psi2, -psi1, psi1)


def extrapolate_steps(psi1: Array, chi: Array, number: Real, *, springs: int, steps: int) -> Array:
    """Return psi2 of ``rebound``, extrapolated from half as many springs and steps."""
    coarse, fine = (
        rebound(psi1, chi, number, springs=springs // part, steps=steps // part) for part in (2, 1)
    )
    return np.clip(fine + (fine - coarse) / 3.0, -psi1, psi1)


class Contact(NamedTuple):
    """The contact at the end of a step, a column for each motion.

    Attributes
    ----------
    limit : array, shape (live springs, motions)
    edge : array
        Limit at the edge.
    outer : array of int
        The last spring in contact.
    spacing, rest : array
        Between springs, and half the distance from the last one to the edge.
    """

    limit: Array
    edge: Array
    outer: NDArray[np.intp]
    spacing: Array
    rest: Array

    def total(self, values: Array, at_edge: Array) -> Array:
        """Return the integral of values, 0 out of contact, by trapezoids up to the edge."""
        last = values[self.outer, np.arange(values.shape[1])]
        inner = values.sum(axis=0) - 0.5 * (values[0] + last)
        whole: Array = self.spacing * inner + self.rest * (last + at_edge)
        return whole


@np.errstate(under="ignore", over="ignore")
def _follow_once(psi1: Array, chi: Array, number: Array, path: Course, springs: int) -> Array:
    """Return psi2 of impacts; ``number`` and ``path`` have one column, or one for each."""
    # The step of second order of §15: half a kick, the displacement w under a limit that is
    # linear in the step, half a kick. Kicks are the share of Coulomb's limit times the exact
    # impulse of P, so that slip throughout is exact.
    spacing = path.radius[path.turn] / springs
    squares = (spacing * np.arange(springs + 1)[:, None]) ** 2
    decays = np.exp(-path.duration / number)
    means = -np.expm1(-path.duration / number) * (number / path.duration)
    gains = path.rate[:-1] - path.rate[1:]
    stiffness = 1.9 * number * path.duration * path.radius[1:]
    stiff = chi.max() * stiffness.max(axis=1) > STIFF
    psi, share, w = psi1.copy(), np.minimum(psi1, 1.0), np.zeros((springs + 1, psi1.size))
    rooms, limits, past = np.empty((2, *w.shape)), np.zeros(squares.shape), np.zeros(squares.shape)
    for step, duration in enumerate(path.duration[:-1], start=1):
        kick, mean, decay = chi * gains[step - 1], means[step - 1], decays[step - 1]
        ahead, b = psi - kick * share, path.radius[step]
        outer = np.maximum(np.ceil(b / spacing).astype(np.intp) - 1, 0)
        live = int(outer.max()) + 1
        limits, past = past, limits
        inside, limit, now, held, bound = squares[:live], limits[:live], w[:live], *rooms[:, :live]
        np.multiply(path.top[step] - inside, inside < b * b, out=limit)
        room = (1.0 - mean) * limit + (mean - decay) * past[:live]
        drift = ahead * duration
        np.multiply(now, decay, out=held)
        now += drift
        if step <= path.turn:
            least = int(np.min(path.radius[step - 1] / spacing))
            ring = slice(least, live)
            _enter(now[ring], room[ring], limit[ring], inside[ring], drift, number, path, step)
        np.maximum(now, np.subtract(held, room, out=bound), out=now)
        np.minimum(now, np.add(held, room, out=bound), out=now)
        edge = np.maximum(number * path.rate[step], 0.0)
        contact = Contact(limit, edge, outer, spacing, 0.5 * (b - outer * spacing))
        known = contact, now, number, ahead, kick, share, bound
        psi, share = _one_pass(*known)
        if stiff[step - 1]:
            settled = chi * stiffness[step - 1] > STIFF
            for each, other in zip((psi, share), _settle(*known), strict=True):
                np.copyto(each, other, where=settled)
    return np.asarray(psi - chi * gains[-1] * 2.0 * share)


def _enter(
    w: Array,
    room: Array,
    limit: Array,
    inside: Array,
    drift: Array,
    number: Array,
    path: Course,
    step: int,
) -> None:
    """Set displacement and room of springs that enter within a step, each for its share of it."""
    before, after = path.radius[step - 1 : step + 1] ** 2
    enters = (inside >= before) & (inside < after)
    part = np.where(enters, (after - inside) / (after - before), 1.0)
    last, first = path.rate[step], path.rate[step - 1]
    time = part * path.duration[step - 1]
    at_entry = number * (last + (first - last) * part)
    mean = -np.expm1(-time / number) * (number / time)
    own = (1.0 - mean) * limit + (mean - np.exp(-time / number)) * at_entry
    np.copyto(room, own, where=enters)
    np.copyto(w, drift * part, where=enters)


def _friction(contact: Contact, w: Array, reach: Array, room: Array) -> Array:
    """Return the forces of springs w + a psi within their limits, in ``room``."""
    np.add(w, reach, out=room)
    np.maximum(room, -contact.limit, out=room)
    return np.minimum(room, contact.limit, out=room)


def _one_pass(
    contact: Contact, w: Array, number: Array, ahead: Array, kick: Array, share: Array, room: Array
) -> tuple[Array, Array]:
    """Return psi and the share of Coulomb's limit at the end of a step, by one pass."""
    reach = number * (ahead - kick * share)
    force = contact.total(
        _friction(contact, w, reach, room), np.clip(reach, -contact.edge, contact.edge)
    )
    share = force / contact.total(contact.limit, contact.edge)
    return ahead - kick * share, share


def _settle(
    contact: Contact, w: Array, number: Array, ahead: Array, kick: Array, share: Array, room: Array
) -> tuple[Array, Array]:
    """Return the answer of ``_one_pass`` by Newton's method."""
    psi, load = ahead - kick * share, contact.total(contact.limit, contact.edge)
    for _ in range(TURNS):
        reach = number * psi
        force = _friction(contact, w, reach, room)
        share = contact.total(force, np.clip(reach, -contact.edge, contact.edge)) / load
        sticks = np.where(np.abs(force) < contact.limit, number, 0.0)
        slope = contact.total(sticks, np.where(np.abs(reach) < contact.edge, number, 0.0)) / load
        change = (psi - ahead + kick * share) / (1.0 + kick * slope)
        psi = psi - change
        if np.max(np.abs(change) - SETTLED * np.abs(psi)) <= SETTLED:
            break
    return ahead - kick * share, share
