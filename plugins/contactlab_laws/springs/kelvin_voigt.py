"""A step of springs of Kelvin and Voigt, elastic and viscous side by side (theory §15).

A spring at distance r has the limit l = b² - r² + j, j the excess by which the viscous pressure
exceeds Hertz's, and the force f = w + A w', abs(f) <= l. It sticks, w' = v, or slips,
w' = (±l - w)/A. Lengths along the radius are in units of the grid, w in the units of l.

In a step of time h, with the limits l0 and l1 at its ends, ``Direction.drag`` takes w0 to w1,
``solve_slip`` gives f1 = w1 + A v1 cut to l1. A limit that moves evenly is followed exactly. The
springs stand in the middle of cells, and the force is their share of Coulomb's limit, the sum of f
over that of l, so that slip throughout is exact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab.numeric.types import Array, Real
from contactlab_laws.jaeger.step import common
from contactlab_laws.springs.directions import Direction
from contactlab_laws.springs.doubling import fit_grid, place_springs
from contactlab_laws.springs.slip_velocity import (
    Slip,
    share_of_edge,
    share_of_middle,
    solve_slip,
)
from contactlab_laws.springs.turning import TINY, Vectors

#: Springs from which on their sum is the force of a contact that leaves.
FEW = 2


class Contact(NamedTuple):
    """Numbers of a viscous contact for the springs, each of shape (K,), K the impacts or 1.

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


class Motion(NamedTuple):
    """The tangential motion of a step, each of shape (items,).

    Attributes
    ----------
    move : array
        v h, scaled.
    drift : array
        h, in s.
    acted : array
        Share of the drift under the force of its end.
    limit : array
        Coulomb's limit at the end, in N.
    scale : float or array
        Scaled displacement per metre.
    slip : Slip
    """

    move: Vectors
    drift: Array
    acted: Array
    limit: Array
    scale: Real
    slip: Slip


class Begin(NamedTuple):
    """Springs before a step, on the grid of its end.

    Attributes
    ----------
    size : array, shape (K,)
    squares, limit : array, shape (springs, K)
        r² and l0.
    held, traction : array, shape (springs, items)
        w0 and f0.
    weight : array, shape (items,)
        As in ``Memory``.
    """

    size: Array
    squares: Array
    limit: Array
    held: Vectors
    traction: Vectors
    weight: Array


def move_springs(
    before: Memory,
    contact: Contact,
    motion: Motion,
    direction: Direction,
    *,
    grows: bool,
    splits: bool,
) -> tuple[Vectors, Array, Array, Memory]:
    """Return force (N), friction work and loss in shear (scaled), and the springs after a step."""
    items = before.deflection.shape[1:]
    between = 0.5 * (before.time + contact.time)
    time = np.where(before.time > 0.0, between, contact.time)  # 0 before first touch
    decay = motion.drift / np.maximum(time, TINY)  # h/A
    edge, excess, decay = (  # one number where all impacts agree
        np.atleast_1d(common(each, items)) for each in (contact.edge, contact.excess, decay)
    )

    begin = _begin(before, edge, direction, grows=grows, splits=splits)
    first, last = begin.limit, limit_springs(begin.squares, edge, excess)

    w: Vectors = begin.held
    part: Real = 1.0  # of the step, for which springs move
    if (edge > before.edge).any():
        earlier = before.edge, before.excess
        part, first = enter_springs(begin.squares, first, earlier, edge, excess)
        w = w * np.exp(-decay * (1.0 - part))  # a spring relaxes until the contact meets it
    w = direction.drag(w, part * motion.move, motion.move / decay, first, last, part * decay)

    total = last.sum(axis=0)
    touches = total > 0.0
    per_total = 1.0 / np.where(touches, total, 1.0)
    lead = contact.time * motion.scale
    share, traction, velocity = solve_slip(
        w, last, lead, motion.slip, per_total, direction, out=np.empty_like(w)
    )
    few = np.count_nonzero(last, axis=0) < FEW
    if few.any():
        pull = lead * direction.stretch(motion.slip.velocity)
        own = np.where(touches, share, share_of_edge(pull, edge, excess, before.share))
        pull = w[0] + lead * direction.stretch(velocity)
        left = share_of_middle(pull, edge, excess, before.share)
        share = np.where(few, np.where(edge > before.edge, own, left), share)

    weight = motion.limit * per_total
    early = (1.0 - motion.acted) * begin.weight * begin.traction
    force = early + motion.acted * weight * traction  # the mean of the step
    # springs that entered count as if they had moved all the time
    rise = direction.relax(w - begin.held) / np.maximum(part, TINY)
    # work on springs is lost in shear or stored; what is stored is lost after they leave
    loss = direction.product(force, rise)
    friction_work = direction.product(force, motion.move) - loss
    after = Memory(
        begin.size,
        edge,
        excess,
        contact.time,
        lead * direction.stretch(velocity),
        share,
        weight,
        w,
    )
    acts = motion.slip.acting * share
    return acts, np.maximum(friction_work.sum(axis=0), 0.0), loss.sum(axis=0), after


def _begin(
    before: Memory, edge: Array, direction: Direction, *, grows: bool, splits: bool
) -> Begin:
    """Return the springs before a step, on a grid that holds the contact after it."""
    size, held, springs = before.size, before.deflection, len(before.deflection)
    squares = square_places(size, springs)
    limit = limit_springs(squares, before.edge, before.excess)
    traction = direction.cut(held + before.lead, limit)
    if not grows:
        return Begin(size, squares, limit, held, traction, before.weight)
    reach = np.sqrt(edge + 0.0 * size)  # one for each size, where all impacts share an edge
    fitted, held, _ = fit_grid(size, held, reach, 1.0, spans=not splits)
    if fitted is size:
        return Begin(size, squares, limit, held, traction, before.weight)
    # as many springs over another length: forces go with w, and weigh more by the ratio of lengths
    traction = fit_grid(size, traction, reach, 1.0, spans=not splits)[1]
    ratio = np.where(size > 0.0, fitted / (size + TINY), 1.0)
    squares = square_places(fitted, springs)
    limit = limit_springs(squares, before.edge, before.excess)
    return Begin(fitted, squares, limit, held, traction, ratio * before.weight)


def square_places(size: Array, springs: int) -> Array:
    """Return r² of springs in the middle of cells, shape (springs, K)."""
    places = place_springs(size, springs)
    return places * places


def limit_springs(squares: Array, edge: Array, excess: Array) -> Array:
    """Return l of the springs."""
    inside = edge - squares
    return np.where(inside > 0.0, inside + excess, 0.0)


def enter_springs(
    squares: Array, least: Array, before: tuple[Array, Array], edge: Array, excess: Array
) -> tuple[Array, Array]:
    """Return the part of the step for which springs move, and their limit at its begin.

    ``before`` are b² and j of the step before, ``least`` the limit there. The edge moves evenly in
    r², and a spring that it meets begins with the excess of that time.
    """
    growth = edge - before[0]
    inside = edge - squares
    entering = (inside > 0.0) & (least <= 0.0)
    part = np.where(entering, inside / np.where(growth > 0.0, growth, 1.0), 1.0)
    part = np.minimum(part, 1.0)
    return part, np.where(entering, excess + (before[1] - excess) * part, least)
