"""Springs that share the loss of a viscous normal law: one relaxation time for both (theory §15).

A spring at distance r has the limit l = b² - r² + j, j the excess by which the viscous pressure
exceeds Hertz's, and the force f = w + A w' of a Kelvin-Voigt body, abs(f) <= l. It sticks, w' = v,
or slips, w' = (±l - w)/A. Radius, force, approach and rate of any viscous contact tell b, j and A.
Lengths along the radius are in units of the grid, w in the units of l.

The springs stand in the middle of cells, as those without loss. The step is of second order: a
limit that moves evenly is followed exactly, and the slip velocity where the force acts is solved
for. The force is the share of Coulomb's limit, so that slip throughout is exact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts import Increment, NormalContact, TangentialResponse
from contactlab.contracts.normal import NormalLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import flat, shape_as
from contactlab.numeric.types import Array, Real
from contactlab_laws.jaeger.bundle import spring_fields
from contactlab_laws.jaeger.partial_slip import Scales
from contactlab_laws.jaeger.step import common
from contactlab_laws.springs.doubling import crossing, fit_grid
from contactlab_laws.springs.turning import Vectors, beyond, drag_springs, relax, stretch

#: Rates below this times that at first touch say nothing of A: the law is asked at this one.
SLOWEST = 1e-3
#: Turns of Newton's method for the slip velocity where the force acts.
TURNS = 3
#: Feedback of the force on the slip velocity in a step, over the force, from which they are taken.
STIFF = 0.05
#: A grid that spans a contact known before spans this much more.
SPARE = 1.05
#: Rounding errors up to which impacts of a batch count as alike: their contacts come of a table.
ALIKE = 1e3
#: Added to numbers that divide, so that none is zero.
TINY = 1e-300


class Contact(NamedTuple):
    """What a viscous contact tells the springs, each of shape (K,), K the impacts or 1.

    Attributes
    ----------
    edge, excess : array
        b², and j: the limit is b² - r² + j inside b.
    time : array
        A times the loss in shear, in s.
    """

    edge: Array
    excess: Array
    time: Array


class Memory(NamedTuple):
    """The springs of a batch in one axis; never changed once made.

    Attributes
    ----------
    size : array, shape (K,)
        What the springs span.
    edge, excess : array, shape (K,)
        b² and j at the end of the last step.
    time : array, shape (items,)
        A there, in s; 0 before first touch.
    lead : array, shape (items,)
        A times the slip velocity there, complex for vectors.
    share : array, shape (items,)
        Force over Coulomb's limit, the same.
    weight : array, shape (items,)
        Coulomb's limit over the sum of l over the radius.
    deflection : array, shape (springs, items)
        w.
    """

    size: Array
    edge: Array
    excess: Array
    time: Array
    lead: Vectors
    share: Vectors
    weight: Array
    deflection: Vectors


class State(NamedTuple):
    """The springs of a batch of contacts, and what they need of scene and laws.

    Attributes
    ----------
    shape : tuple of int
        Shape of the batch.
    scales : Scales
        Units: floats, or arrays of shape (items,).
    radius : float or array
        Radius of the pair in m, as the scales.
    speed : float or array
        Rate at first touch in m/s.
    law, parts : NormalLaw, object
        The normal law and its state.
    shear_loss : float
    grows, splits : bool
        True for a grid that doubles where the contact outgrows it, and halves where it is small.
    memory : Memory
    cross : array, shape (items,), or None
        G* along the second axis over that along the first, of vectors on an ellipse.
    """

    shape: tuple[int, ...]
    scales: Scales
    radius: Real
    speed: Real
    law: NormalLaw
    parts: object
    shear_loss: float
    grows: bool
    splits: bool
    memory: Memory
    cross: Array | None = None


def start(
    scene: Scene,
    law: NormalLaw,
    springs: int,
    radius: Real,
    *,
    shear_loss: float,
    spanned: float | None = 1.0,
    grows: bool = False,
    vectors: bool = False,
) -> State:
    """Return contacts without traction, lengths in units of ``radius`` in m.

    ``spanned`` is what the springs span in this unit; None for a grid that follows the contact.
    """
    shape = scene.shape
    items = math.prod(shape)
    none, one = np.zeros(items), np.zeros(1)
    rows = np.zeros((springs, items), dtype=complex if vectors else float)
    size = np.full(items if grows else 1, spanned or 0.0)
    memory = Memory(size, one, one, none, rows[0], rows[0], none, rows)
    scales = Scales.at(scene, radius)
    if shape:
        scales = Scales._make(flat(each, shape) for each in scales)
    return State(
        shape,
        scales,
        flat(scene.pair.radius, shape) if shape else scene.pair.radius,
        scene.normal_speed,
        law,
        law.start(scene),
        shear_loss,
        grows,
        spanned is None,
        memory,
        crossing(scene) if vectors else None,
    )


def advance(
    state: State, increment: Increment, after: NormalContact
) -> tuple[TangentialResponse, State]:
    """Return force, friction work and loss in shear of the step, and the springs after it."""
    shape, scales, memory = state.shape, state.scales, state.memory
    sampled = increment.sampled
    vectors = memory.deflection.dtype.kind == "c"

    def row(value: Real) -> Array:
        return flat(value, shape) if shape else np.atleast_1d(np.asarray(value, dtype=float))

    def tangential(value: Real) -> Vectors:
        if not vectors:
            return row(value)
        value = np.asarray(value)
        return row(value[..., 0]) + 1j * row(value[..., 1])

    contact = told(state, after, None if sampled is None else sampled[:2], row)
    limit, acting = (row(each) for each in (after.friction_load, increment.friction_load))
    friction = scales.force / scales.normal_force
    still = np.zeros(memory.deflection.shape[1:])
    rates: tuple[Vectors, Vectors, Array] = still, still, still
    if sampled is not None:
        rates = tangential(sampled.slip), tangential(sampled.force), row(sampled.mobility)
    drive = Drive(
        tangential(increment.displacement) * scales.displacement,
        row(increment.drift),
        share_under_force(row(increment.duration), row(increment.drift)),
        *rates,
        friction * limit,
        friction * acting,
        scales.displacement,
        state.cross,
    )
    force, work, loss, memory = move_viscous(memory, contact, drive, state.grows, state.splits)
    work, loss = (shape_as(each * scales.metres, shape) for each in (work, loss))
    if vectors:
        acts = np.stack((force.real, force.imag), axis=-1).reshape(*shape, 2)
    else:
        acts = shape_as(force, shape)
    return TangentialResponse(acts, work, True, loss), state._replace(memory=memory)


def told(
    state: State,
    contact: NormalContact,
    motion: tuple[Real, Real] | None,
    spread: Callable[[Real], Array],
) -> Contact:
    """Return what contacts tell the springs, in the arrangement of ``spread``.

    ``motion`` is approach in m and its rate in m/s; None of a path that is slow.
    """
    scales = state.scales
    b, excess = limits(
        spread(contact.radius) / scales.radius, spread(contact.friction_load) / scales.normal_force
    )
    if motion is None:
        return Contact(b * b, 0.0 * excess, 0.0 * excess)
    # the viscous force over the rate, asked while the surfaces approach: no tension cuts it there
    approach, rate = motion
    rate = np.maximum(np.abs(rate), SLOWEST * state.speed)
    asked, _ = state.law.respond(state.parts, approach, rate)
    _, push = limits(
        spread(asked.radius) / scales.radius, spread(asked.force) / scales.normal_force
    )
    time = push * np.square(scales.radius) / (state.radius * spread(rate))
    return Contact(b * b, excess, state.shear_loss * time)


def limits(b: Array, load: Array) -> tuple[Array, Array]:
    """Return b and j of a contact of radius b under a load, of which Hertz's is b³."""
    with np.errstate(invalid="ignore"):
        excess = np.where(b > 0.0, (load - b**3) / (1.5 * (b + TINY)), 0.0)
    # in unloading the surfaces have parted outside of the radius that carries the load
    return np.where(excess < 0.0, np.cbrt(load), b), np.maximum(excess, 0.0)


def share_under_force(duration: Array, drift: Array) -> Array:
    """Return the share of a drift under the force of its end, the rest being that of its begin.

    A drift goes from the middle of the time for which one force acts to the middle of the next.
    """
    half = 0.5 + 0.0 * (duration + drift)  # also where no body is moved by the force
    share: Array = np.divide(0.5 * duration, drift, out=half, where=duration * drift > 0.0)
    return np.minimum(share, 1.0)


class Drive(NamedTuple):
    """The tangential motion of a step, each of shape (items,); tangential ones may be complex.

    ``cross`` is that of ``State``.
    """

    move: Vectors
    drift: Array
    acted: Array
    slip: Vectors
    force: Vectors
    mobility: Array
    limit: Array
    acting: Array
    scale: Real
    cross: Array | None = None


def move_viscous(
    before: Memory, contact: Contact, drive: Drive, grows: bool, splits: bool
) -> tuple[Vectors, Array, Array, Memory]:
    """Return force (N), friction work and loss in shear (scaled), and the springs after a step."""
    items = before.deflection.shape[1:]
    # A in the middle of the step, and at its end
    middle = np.where(before.time > 0.0, 0.5 * (before.time + contact.time), contact.time)
    decay = drive.drift / np.maximum(middle, TINY)
    edge, excess, decay = (_column(each, items) for each in (contact.edge, contact.excess, decay))
    held, size, old = before.deflection, before.size, None
    ratio: Any = 1.0
    if grows or splits:
        reach = np.sqrt(edge + 0.0 * size)  # one for each size, where all impacts share an edge
        size, held, _ = fit_grid(size, held, reach, 1.0, spans=not splits, cross=drive.cross)
    squares = squared_places(size, len(held))
    least = profile(squares, before.edge, before.excess)
    if size is not before.size:  # as many springs over another length: tractions as they were
        cut = profile(squared_places(before.size, len(held)), before.edge, before.excess)
        old = _cut(before.deflection + before.lead, cut, drive.cross)
        old = fit_grid(before.size, old, reach, 1.0, spans=not splits)[1]
        ratio = np.where(before.size > 0.0, size / (before.size + TINY), 1.0)
    most = profile(squares, edge, excess)
    part, first = enter_step(squares, least, (before.edge, before.excess), edge, excess)
    lead = contact.time * drive.scale
    move = part * drive.move
    deflection = held * np.exp(-decay * (1.0 - part)) if first is not least else held
    asked = deflection, move, drive.move / decay, first, most, part * decay
    deflection = drag_springs(*asked, drive.cross) if np.iscomplexobj(held) else _slip(*asked)
    total = most.sum(axis=0)
    in_contact = total > 0.0
    per_total = 1.0 / np.where(in_contact, total, 1.0)
    weight = drive.limit * per_total
    share, traction, slip = solve_slip(
        deflection, most, lead, drive, per_total, out=np.empty_like(deflection)
    )
    if not in_contact.all():
        pulled = lead * stretch(drive.slip, drive.cross)
        share = np.where(in_contact, share, alone(pulled, excess, before.share))
    # the work on springs is lost or stored; what is stored is lost when a spring leaves, or after
    old = _cut(held + before.lead, least, drive.cross) if old is None else old
    mean = (1.0 - drive.acted) * ratio * before.weight * old + drive.acted * weight * traction
    # springs that entered count as if they had moved all the time: the force is their mean
    gained = _real(mean, relax(deflection - held, drive.cross) / np.maximum(part, TINY))
    work = _real(mean, drive.move) - gained
    carried = lead * stretch(slip, drive.cross)
    after = Memory(size, edge, excess, contact.time, carried, share, weight, deflection)
    force = drive.acting * share
    return force, np.maximum(work.sum(axis=0), 0.0), gained.sum(axis=0), after


def solve_slip(
    deflection: Vectors, most: Array, lead: Array, drive: Drive, per_total: Real, *, out: Vectors
) -> tuple[Vectors, Vectors, Vectors]:
    """Return share of Coulomb's limit, tractions, and the slip velocity that they belong to.

    From the force of the last step one turn is of second order; where the force moves the slip
    velocity much, as by a long relaxation in a light body, Newton's method is. ``out`` takes the
    tractions.
    """
    share = np.divide(drive.force, drive.acting, out=0.0 * drive.force, where=drive.acting > 0.0)
    stiff = lead * drive.mobility * drive.acting * per_total
    cross = drive.cross
    traction = np.add(deflection, lead * stretch(drive.slip, cross), out=out)
    _cut(traction, most, cross)
    found = np.ones(len(traction)).dot(traction) * per_total
    slip = np.broadcast_to(drive.slip, share.shape)
    hard = np.flatnonzero(stiff * np.count_nonzero(most, axis=0) > STIFF)
    if not hard.size:
        return found, traction, slip
    few = [np.broadcast_to(each, share.shape)[hard] for each in (lead, stiff, per_total)]
    push = (drive.mobility * drive.acting)[hard]
    one, at, limits = share[hard], drive.slip[hard], most[:, hard if most.shape[1] > 1 else 0, ...]
    limits = limits.reshape(len(most), -1)
    slip, cross = slip.copy(), None if cross is None else cross[hard]
    for _ in range(TURNS):
        slip[hard] = at
        pulled = deflection[:, hard] + few[0] * stretch(at, cross)
        stuck = (np.abs(pulled) < limits).sum(axis=0)
        _cut(pulled, limits, cross)
        new = one + (pulled.sum(axis=0) * few[2] - one) / (1.0 + few[1] * stuck)
        at, one = at + (one - new) * push, new
    found[hard], traction[:, hard] = one, pulled
    return found, traction, slip


def _real(first: Vectors, second: Vectors) -> Any:
    """Return the products, of complex numbers the inner products."""
    return (np.conj(first) * second).real if np.iscomplexobj(first) else first * second


def _cut(traction: Vectors, most: Array, cross: Array | None = None) -> Vectors:
    """Cut tractions to their limit, in place, and return them."""
    if traction.dtype.kind == "c":
        return np.subtract(traction, beyond(traction, most, cross), out=traction)
    np.minimum(traction, most, out=traction)
    return np.maximum(traction, -most, out=traction)


def _column(value: Array, items: tuple[int, ...]) -> Array:
    """Return one number where all impacts agree, as an array."""
    return np.atleast_1d(common(value, items))


def squared_places(size: Array, springs: int) -> Array:
    """Return r² of springs in the middle of cells, shape (springs, K)."""
    places: Array = np.multiply.outer(np.arange(springs) + 0.5, size / springs)
    return places * places


def profile(squares: Array, edge: Array, excess: Array) -> Array:
    """Return l of the springs."""
    inside = edge - squares
    return np.where(inside > 0.0, inside + excess, 0.0)


def enter_step(
    squares: Array, least: Array, before: tuple[Array, Array], edge: Array, excess: Array
) -> tuple[Any, Array]:
    """Return the part of the step for which springs move, and their limit at its begin.

    ``before`` are b² and j of the step before, ``least`` the limit there.
    """
    growth = edge - before[0]
    if not (growth > 0.0).any():
        return 1.0, least
    inside = edge - squares
    entering = (inside > 0.0) & (least <= 0.0)
    part = np.where(entering, inside / np.where(growth > 0.0, growth, 1.0), 1.0)
    part = np.minimum(part, 1.0)
    return part, np.where(entering, excess + (before[1] - excess) * part, least)


def relaxing(first: Array, most: Array, decay: Array) -> tuple[Array, Array]:
    """Return the share of w that relaxes in a step, and the limit of what comes in its place.

    The limit of the springs goes evenly from ``first`` to ``most``.
    """
    gone = -np.expm1(-decay)
    return gone, first * gone + (most - first) * (1.0 - gone / np.maximum(decay, TINY))


def _slip(
    held: Vectors, move: Vectors, _: Vectors, first: Array, most: Array, decay: Array
) -> Vectors:
    """Return w along one line: held by the limit, which goes evenly from ``first`` to ``most``."""
    gone, span = relaxing(first, most, decay)
    free = held * (1.0 - gone)
    return np.asarray(np.minimum(np.maximum(held + move, free - span), free + span))


def alone(pull: Vectors, excess: Real, share: Vectors) -> Vectors:
    """Return the share of a contact that is smaller than a cell: of its edge, or as it was."""
    begun = excess > 0.0
    ratio = pull / np.where(begun, excess, 1.0)
    ratio = ratio / np.maximum(np.abs(ratio), 1.0)
    return np.asarray(np.where(begun, ratio, share))


def fields(state: State) -> dict[str, Any]:
    """Return radius, displacement and limit (m), stuck and slipping, shape (*shape, springs).

    The displacement is that of an elastic spring under the same force; ``relax`` is w in m.
    """
    memory, scales, shape = state.memory, state.scales, state.shape
    springs, items = memory.deflection.shape
    places = np.multiply.outer(np.arange(springs) + 0.5, memory.size / springs)
    limit = profile(places * places, memory.edge, memory.excess)
    traction = _cut(memory.deflection + memory.lead, limit, state.cross)
    rows = (
        np.broadcast_to(each, (springs, items)).T.reshape(*shape, springs)
        for each in (places * scales.radius, memory.deflection, traction, limit)
    )
    radius, deflection, traction, limit = rows
    metres = np.asarray(scales.metres).reshape(*shape, 1)
    told = spring_fields(radius, traction, limit, metres=metres)
    relaxed = spring_fields(radius, deflection, limit, metres=metres)["displacement"]
    return {**told, "relaxed": relaxed}
