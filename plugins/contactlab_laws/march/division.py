"""Even steps of a normal motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterator

import numpy as np

from contactlab.contracts import (
    NormalContact,
    NormalMotion,
    NormalSample,
    Steps,
    TangentialLaw,
    Units,
    claims,
)
from contactlab.numeric.arrays import lock_arrays
from contactlab.numeric.types import Array, Real

#: Largest omega dt of the fastest tangential oscillation. From 2 on the leapfrog is unstable
#: (theory §4) and wrong by any amount. Below 2 it is stable, but at 1/2 the phase is off by 1 % a
#: radian already.
LARGEST_PHASE_STEP = 0.5
#: Largest phase error over an impact, in radians, for laws without microslip: an error of up to a
#: third of this over the range of psi2, at any chi. The leapfrog's phase runs ahead by
#: (omega dt)²/24 a radian; microslip damps the oscillation and the phase error with it.
LARGEST_LEAD = 0.05
#: Largest stretch of the steps, over their number squared: it keeps the second order. All steps are
#: stretched alike so that the samples of the load add up to its exact impulse: gross slip
#: throughout is then exact, and the energy books of the scheme close as before. Smooth loads need
#: less than the largest stretch, a load that begins as the root of time would need ever more.
MOST_STRETCH = 1.0
#: Friction load at separation over the greatest from which a contact breaks: others end at 1e-12.
BREAKS = 1e-6
#: Radius of the contact after the break, over that before.
VANISHES = 1e-6
#: Steps converted to plain numbers at a time: two million would fill 700 MB.
BLOCK = 4096
#: More steps are made anew for each impact: these take half a megabyte.
LONGEST_KEPT = 4000
#: Parts of a motion from which graded steps are made; least radius in them, over the largest.
GRADED, LEAST_RADIUS = 512, 1e-6


def resolving(radians: Real, law: TangentialLaw) -> Real:
    """Return the least steps that resolve a tangential oscillation through ``radians``."""
    steps = radians / LARGEST_PHASE_STEP
    if "partial_slip" not in claims(law):
        steps = np.maximum(steps, radians * np.sqrt(radians / (24.0 * LARGEST_LEAD)))
    return np.ceil(steps)


def midpoints(normal: NormalMotion, count: int, *, graded: bool = False) -> Steps:
    """Return ``count`` steps of the contact's duration, each sampled in its middle.

    Steps that are ``graded`` are short at first touch and at separation, where the force of a
    viscous contact goes as the root of time: they are even in the integral of dt/b.
    """
    key = "midpoints", count, graded
    return _make_once(normal, count, key, lambda motion: _midpoints(motion, count, graded))


def endpoints(normal: NormalMotion, count: int) -> Steps:
    """Return ``count`` steps of the contact's duration, each sampled at its end."""
    key = "endpoints", count
    return _make_once(normal, count, key, lambda motion: _endpoints(motion, count))


def _make_once(
    normal: NormalMotion, count: int, key: Hashable, make: Callable[[NormalMotion], Steps]
) -> Steps:
    """Return steps that equal motions share, and those that are equal in other units."""
    if count > LONGEST_KEPT:
        return make(normal)
    if (pattern := normal.pattern) is None:
        return normal.once(key, lambda: make(normal))
    one, units = pattern
    return _in_units(one.once(key, lambda: make(one)), units, len(normal.scene.shape))


def _in_units(steps: Steps, units: Units, axes: int) -> Steps:
    """Return the steps of one impact as those of impacts in other units, a batch of ``axes``."""
    time, approach, rate, force, radius = units
    shape = (-1,) + (1,) * axes

    def scaled(column: Array, unit: Real) -> Array:
        return lock_arrays(column.reshape(shape) * unit)

    return Steps(
        contact=NormalContact(*map(scaled, steps.contact, (force, radius, approach, force))),
        drift=scaled(steps.drift, time),
        kick=scaled(steps.kick, time),
        friction_load=scaled(steps.friction_load, force),
        time=scaled(steps.time, time),
        approach=scaled(steps.approach, approach),
        rate=scaled(steps.rate, rate),
    )


def _midpoints(normal: NormalMotion, count: int, graded: bool) -> Steps:
    fractions = _grade(normal, count) if graded else np.linspace(0.0, 1.0, 2 * count + 1)
    halves = np.array(normal.phase(fractions))
    halves[-1] = np.pi  # exactly, as the inverse is not
    ends = normal.at(_column(halves[::2], normal))
    times = np.asarray(ends.time)
    kick = times[1:] - times[:-1]
    impulse = np.asarray(ends.load_impulse)
    return _cut_at_parting(
        sample_steps(normal, halves[1::2], kick, impulse[1:] - impulse[:-1]), ends
    )


def _grade(normal: NormalMotion, count: int) -> Array:
    """Return fractions of the duration at the ends and middles of steps even in dt/b.

    The greatest approach is at an end of a step: the contact radius has a kink there.
    """
    shape = normal.scene.shape
    if normal.alike and shape:
        normal, shape = normal.take((0,) * len(shape)), ()
    u = np.linspace(0.0, 1.0, 2 * GRADED + 1)
    fractions = np.sin(0.5 * math.pi * u) ** 2
    sample = normal.at(_column(np.asarray(normal.phase(fractions)), normal))
    columns = np.broadcast_arrays(sample.rate, sample.contact.radius, np.empty((len(u), *shape)))
    rate, radius = (each.reshape(len(u), -1).T for each in columns[:2])
    found = [_even(u, fractions, *each, count) for each in zip(rate, radius, strict=True)]
    return np.stack(found, axis=-1).reshape(-1, *shape)


def _even(u: Array, fractions: Array, rate: Array, radius: Array, count: int) -> Array:
    """Return the fractions of one motion."""
    inner = np.maximum(radius[1::2], LEAST_RADIUS * radius.max())
    along = np.concatenate(([0.0], np.cumsum(np.diff(fractions[::2]) / inner)))
    turn = int(np.argmax(rate <= 0.0))
    top = np.interp(0.0, -rate[turn - 1 : turn + 1], u[turn - 1 : turn + 1]) if turn else 0.5
    middle, first = np.interp(top, u[::2], along), count // 2
    wanted = np.concatenate(
        (
            np.linspace(0.0, middle, 2 * first + 1),
            np.linspace(middle, along[-1], 2 * (count - first) + 1)[1:],
        )
    )
    return np.asarray(np.sin(0.5 * math.pi * np.interp(wanted, along, u[::2])) ** 2)


def _endpoints(normal: NormalMotion, count: int) -> Steps:
    # The half steps after first touch and before separation have the force of their neighbours.
    fractions = np.linspace(0.0, 1.0, count + 1)
    edges = np.concatenate(([0.0], fractions[1:-1] + 0.5 / count, [1.0]))  # count + 1 of them
    phases = np.array(normal.phase(np.concatenate((fractions[1:], edges))))
    phases[[count - 1, -1]] = np.pi
    ends = normal.at(_column(phases[count:], normal))
    impulse = np.asarray(ends.load_impulse)
    loads = impulse[1:] - impulse[:-1]
    kick = np.asarray(normal.duration) / count
    shape = (count,) + (1,) * len(normal.scene.shape)
    return _cut_at_parting(sample_steps(normal, phases[:count], np.ones(shape) * kick, loads), ends)


def _cut_at_parting(steps: Steps, ends: NormalSample) -> Steps:
    """Return the steps, and one of no duration if the contact breaks under a friction load.

    A law then loses what its contact still stores, and its friction work contains that energy.
    """
    load = np.asarray(ends.contact.friction_load)
    if not np.any(load[-1] > BREAKS * load.max(axis=0)):
        return steps
    factors = (VANISHES**3, VANISHES, VANISHES**2, VANISHES**3)  # as Hertz's contact vanishes
    contact = [
        np.concatenate((entry, factor * entry[-1:]))
        for entry, factor in zip(steps.contact, factors, strict=True)
    ]
    last = [  # time, approach and rate where contact breaks: the last step may have its middle
        np.concatenate((column, np.broadcast_to(np.asarray(end)[-1:], column[-1:].shape)))
        for column, end in zip(steps[4:], ends[:3], strict=True)
    ]
    still = [np.concatenate((column, 0.0 * column[-1:])) for column in steps[1:4]]
    for column in (*contact, *still, *last):
        column.flags.writeable = False
    return Steps(NormalContact(*contact), *still, *last)


def sample_steps(normal: NormalMotion, phases: Array, kick: Array, load_impulse: Array) -> Steps:
    """Return steps that sample the contact at ``phases``, shape (K,) or (K, ...), read-only."""
    # ``kick`` is the time in s for which each force acts, ``load_impulse`` the exact integral of
    # the friction load over it in N s, both of shape (K, ...).
    time, approach, rate, contact, _ = normal.at(_column(phases, normal))
    drift = np.array(time)
    drift[1:] -= drift[:-1]
    sampled = np.sum(np.asarray(contact.friction_load) * kick, axis=0)
    with np.errstate(all="ignore"):
        stretch = np.where(sampled > 0.0, np.sum(load_impulse, axis=0) / sampled, 1.0)
    most = MOST_STRETCH / len(drift) ** 2
    stretch = np.clip(stretch, max(1.0 - most, 0.5), 1.0 + most)
    drift, kick = drift * stretch, kick * stretch
    full = np.zeros_like(drift + kick)  # values common to all impacts may lack the batch's axes
    steps = Steps(
        contact=NormalContact(*(full + entry for entry in contact)),
        drift=full + drift,
        kick=full + kick,
        friction_load=full + load_impulse / kick,
        time=full + time,
        approach=full + approach,
        rate=full + rate,
    )
    for column in (*steps.contact, *steps[1:]):
        column.flags.writeable = False
    return steps


def one_by_one(steps: Steps) -> Iterator[Steps]:
    """Iterate over the steps: arrays, or floats (faster) where all impacts share a value."""
    columns = [
        column.ravel() if column.size == len(column) else column
        for column in (*steps.contact, *steps[1:])
    ]
    for first in range(0, len(steps.time), BLOCK):
        parts = [column[first : first + BLOCK] for column in columns]
        rows = zip(*(part.tolist() if part.ndim == 1 else part for part in parts), strict=True)
        for row in rows:
            yield Steps(NormalContact(*row[:4]), *row[4:])


def _column(phases: Array, normal: NormalMotion) -> Array:
    """Return phases of shape (K,) in a shape that broadcasts with the batch; others unchanged."""
    return phases if phases.ndim > 1 else phases.reshape((-1,) + (1,) * len(normal.scene.shape))
