"""The force f1 = w1 + A v1 of viscous springs at the slip velocity to which it leads (§15)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Real
from contactlab_laws.springs.directions import Direction
from contactlab_laws.springs.turning import TINY, Vectors

#: Turns of Newton's method for the slip velocity where the force acts.
TURNS = 3
#: Viscous excess over the square of the edge up to which it is a rounding.
PRESSED = 1e-12
#: Feedback of the force on the slip velocity in a step, over the force, from which turns are taken.
STIFF = 0.05


class Slip(NamedTuple):
    """The slip velocity where the force of a step acts, each of shape (items,).

    Attributes
    ----------
    velocity : array
        That under the force of the last step, in m/s.
    force : array
        The force of the last step, in N.
    mobility : array
        What a force takes off the velocity, in m/(s N).
    acting : array
        Coulomb's limit of the force, in N.
    """

    velocity: Vectors
    force: Vectors
    mobility: Array
    acting: Array

    def of(self, where: NDArray[np.intp]) -> Slip:
        """Return the slip velocity of some impacts."""
        shape = np.shape(self.velocity)
        return Slip(
            np.broadcast_to(self.velocity, shape)[where],
            np.broadcast_to(self.force, shape)[where],
            np.broadcast_to(self.mobility, shape)[where],
            np.broadcast_to(self.acting, shape)[where],
        )


def solve_slip(
    w: Vectors,
    limit: Array,
    lead: Array,
    slip: Slip,
    per_total: Real,
    direction: Direction,
    *,
    out: Vectors,
) -> tuple[Vectors, Vectors, Vectors]:
    """Return share of Coulomb's limit, tractions, and the slip velocity that they belong to.

    From the force of the last step one turn is of second order; where the force moves the slip
    velocity much, as by a long relaxation in a light body, Newton's method is. ``out`` takes the
    tractions.
    """
    traction = np.add(w, lead * direction.stretch(slip.velocity), out=out)
    direction.cut(traction, limit)
    share = np.ones(len(traction)).dot(traction) * per_total
    velocity = np.broadcast_to(slip.velocity, share.shape)
    feedback = lead * slip.mobility * slip.acting * per_total  # of one spring that sticks
    hard = np.flatnonzero(feedback * np.count_nonzero(limit, axis=0) > STIFF)
    if not hard.size:
        return share, traction, velocity

    columns = (np.broadcast_to(each, share.shape)[hard] for each in (lead, feedback, per_total))
    few = Newton(
        w[:, hard],
        limit[:, hard if limit.shape[1] > 1 else 0, ...].reshape(len(limit), -1),
        np.array([*columns]),
        slip.of(hard),
        direction.of(hard),
    )
    velocity = velocity.copy()
    share[hard], traction[:, hard], velocity[hard] = few.solve()
    return share, traction, velocity


class Newton(NamedTuple):
    """Impacts whose force moves their slip velocity much in a step, arguments of ``solve_slip``.

    ``columns`` are ``lead``, what a spring that sticks feeds back, and ``per_total``.
    """

    w: Vectors
    limit: Array
    columns: Array
    slip: Slip
    direction: Direction

    def solve(self) -> tuple[Vectors, Vectors, Vectors]:
        """Return share, tractions and slip velocity by Newton's method."""
        lead, feedback, per_total = self.columns
        slip, direction, acting = self.slip, self.direction, self.slip.acting
        share = np.divide(slip.force, acting, out=0.0 * slip.force, where=acting > 0.0)
        push, after = slip.mobility * acting, slip.velocity
        for _ in range(TURNS):
            velocity = after
            traction = self.w + lead * direction.stretch(velocity)
            sticks = (np.abs(traction) < self.limit).sum(axis=0)
            direction.cut(traction, self.limit)
            off = traction.sum(axis=0) * per_total - share
            found = share + off / (1.0 + feedback * sticks)
            share, after = found, velocity + (share - found) * push
        return share, traction, velocity


def share_of_edge(pull: Vectors, edge: Real, excess: Real, share: Vectors) -> Vectors:
    """Return the share of a growing contact that meets no spring yet: of its edge, or as it was."""
    pressed = excess > PRESSED * edge  # that of an elastic contact is a rounding
    ratio = pull / np.where(pressed, excess, 1.0)
    ratio = ratio / np.maximum(np.abs(ratio), 1.0)
    return np.asarray(np.where(pressed, ratio, share))


def share_of_middle(pull: Vectors, edge: Real, excess: Real, share: Vectors) -> Vectors:
    """Return the share of a contact smaller than a cell, whose springs pull alike; or as it was.

    All of them stick inside of c, the root of b² + j - abs(pull): Cattaneo's contact without j.
    """
    touches = edge > 0.0
    far, least = np.abs(pull), np.where(touches, edge, 1.0)
    limit = least + excess
    b, c = np.sqrt(least), np.sqrt(np.minimum(np.maximum(limit - far, 0.0), least))
    slips = np.minimum(np.maximum(far - excess, 0.0), least) / (b + c)  # b - c, without rounding
    force = far * c + slips * (limit - (least + b * c + c * c) / 3.0)
    whole = b * (limit - least / 3.0)
    direction = pull / np.maximum(far, TINY)
    return np.asarray(np.where(touches, direction * force / whole, share))
