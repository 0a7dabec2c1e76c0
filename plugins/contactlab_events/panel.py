"""One collocation panel: Newton's method for the velocity at Lobatto nodes."""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.collocation import ON_NODE, Nodes, rows
from contactlab.contracts import ClosedFormMotion, Phase, PhaseResponse, PhaseState, ScaledContact

Array = NDArray[np.float64]

NEWTON_CAP = 25
#: Newton's method is quadratic: after a relative update this small, the error is rounding.
LAST_UPDATE = 1e-7
#: From this update on a panel shows whether a rough event comes within it.
LOOK_UPDATE = 0.1
#: Radians of the fastest oscillation that one panel may hold.
LONGEST_SWING = 9.0
#: A fitted length is not moved for less than this, relative; nor by more than half. What a move
#: leaves is its square.
FIT_MOVE, SHIFT_PART = 1e-10, 0.1
TINY = 1e-300
#: The square of a change beyond this is no number; a shorter panel changes less.
LARGEST_CHANGE = 1e150


class Solved(NamedTuple):
    """Converged values at a panel's nodes; ``change`` is counted from the panel's start.

    ``fitted`` is the event at which the panel was made to end, if any: its nodes are rooted then.
    """

    contact: ScaledContact
    response: PhaseResponse
    slip: Array
    change: Array
    velocity: Array
    force: Array
    time_matrix: Array
    time: Array
    length: float
    fitted: int | None


@attrs.frozen(eq=False, slots=False)
class PanelPath:
    """A finished panel, as values at its nodes: the ``Path`` that laws see."""

    solved: Solved
    nodes: Nodes
    origin: float

    def tau(self, x: Array) -> Array:
        """Return the panel coordinate of ``x``."""
        tau = (x - self.origin) / self.solved.length
        if self.solved.fitted is None:
            return tau
        return 1.0 - np.sqrt(np.maximum(0.0, 1.0 - tau))

    @cached_property
    def _columns(self) -> Array:
        solved, contact = self.solved, self.solved.contact
        return np.array(
            [
                solved.slip,
                solved.force,
                contact.approach,
                contact.radius,
                contact.time_rate * solved.velocity,
                contact.time_rate * contact.rate,
                self.nodes.plain[1],
            ]
        )

    def fields(self, x: Array) -> Array:
        """Return rows slip, force, approach, radius, d(slip)/dx, d(approach)/dx at each x."""
        nodes = self.nodes
        basis = nodes.points[:, None] - self.tau(x)
        basis += ON_NODE
        np.divide(nodes.weights[:, None], basis, out=basis)
        values = self._columns @ basis
        return np.asarray(values[:6] / values[6])

    def motion(self, x: Array) -> tuple[Array, Array, Array]:
        """Return (change of velocity in this panel, force, slip) at each x."""
        solved = self.solved
        basis = rows(self.nodes, self.tau(x))
        return basis @ solved.change, basis @ solved.force, basis @ solved.slip


class _Grid(NamedTuple):
    """A panel of one length: contact and dT/dtau at its nodes, integration over T, and T.

    ``drift`` is the slip if the velocity stayed as it was.
    """

    contact: ScaledContact
    rate: Array
    time_matrix: Array
    time: Array
    drift: Array

    @classmethod
    def of(
        cls,
        motion: ClosedFormMotion,
        nodes: Nodes,
        spacing: tuple[Array, Array],
        start: PhaseState,
        length: float,
    ) -> _Grid:
        """Lay ``nodes`` out from ``start``, spaced evenly or with ``nodes.rooted``."""
        spot, spread = spacing
        contact = motion.scaled(start.x + length * spot)
        rate = contact.time_rate * (length * spread)
        time = nodes.integral.dot(rate)
        drift = start.velocity * time
        drift += start.slip
        return cls(contact, rate, nodes.integral * rate, time, drift)


def newton(
    phase: Phase,
    motion: ClosedFormMotion,
    nodes: Nodes,
    start: PhaseState,
    length: float,
    inertia: float,
    guess: Array | None,
    *,
    fits: bool,
) -> Solved | None:
    """Return a solved panel, of the given length unless a rough event comes within it.

    A panel with a rough event is fitted: it ends at the event, and its nodes crowd there.

    Parameters
    ----------
    phase : Phase
    motion : ClosedFormMotion
    nodes : Nodes
    start : PhaseState
    length : float
        In x.
    inertia : float
    guess : ndarray, shape (nodes,), or None
        Of the change of velocity.
    fits : bool
        False to look for no event.

    Returns
    -------
    Solved or None
        None if Newton's method does not converge or the panel is too long for its nodes.
    """
    spacing, fitted, rough = nodes.plain, None, fits and any(phase.rough)
    grid = _Grid.of(motion, nodes, spacing, start, length)
    change = guess
    if change is None:  # force as it was, growing as it did
        half_growth = 0.5 * inertia * start.force_rate
        change = grid.time * (-inertia * start.force - half_growth * grid.time)
    if not float(np.abs(change).max()) < LARGEST_CHANGE:
        return None
    count = len(change)
    # a float to the power of 2 raises OverflowError
    first_size = float(change.dot(change)) / count + start.velocity * start.velocity + TINY
    memo: tuple[Array, ...] = ()
    last = False
    for step in range(NEWTON_CAP):
        time_matrix = grid.time_matrix
        slip = time_matrix.dot(change)
        slip += grid.drift
        response = phase.respond(grid.contact, slip, memo)
        memo, force, gathered = response.memo, response.force, response.gathered
        if gathered is not None:
            force = force + time_matrix.dot(gathered * (start.velocity + change))
        residual = time_matrix.dot(force)
        residual *= inertia
        if last:
            change = -residual
            velocity = start.velocity + change
            return Solved(
                grid.contact, response, slip, change, velocity, force, time_matrix, grid.time,
                length, fitted,
            )  # fmt: skip
        residual += change
        slope = gathered if response.stiffness is None else response.stiffness
        if step == 0 and slope is not None:
            swing = inertia * float((slope * grid.rate * grid.rate).max())
            if not swing < LONGEST_SWING**2:
                return None
        delta = _update(residual, response, inertia, time_matrix, nodes)
        change = change - delta
        size = float(change.dot(change)) / count + first_size
        update = (float(delta.dot(delta)) / size) ** 0.5
        if not update < 1e6:
            return None
        if fitted is not None:
            slip -= time_matrix.dot(delta)
            margin = phase.margin(fitted, grid.contact, slip, start.velocity + change, response)
            shift = _shift(margin, spacing[0], length)
            if not abs(shift) < 0.5 * length:
                return None
            if abs(shift) > FIT_MOVE * length:
                change -= (inertia * shift) * (force * grid.contact.time_rate * spacing[0])
                length += shift
                grid = _Grid.of(motion, nodes, spacing, start, length)
                update = max(update, SHIFT_PART * abs(shift) / length)
        elif rough and update < LOOK_UPDATE:
            known = grid.contact, slip, start.velocity + change, response
            event, part = _rough_event(phase, known, nodes)
            if part < 1.0:
                fitted, spacing, memo = event, nodes.rooted, ()
                change = rows(nodes, part * spacing[0]) @ change
                length *= part
                grid = _Grid.of(motion, nodes, spacing, start, length)
                continue
        last = update < LAST_UPDATE or phase.linear
    return None


def _rough_event(phase: Phase, known: Any, nodes: Nodes) -> tuple[int, float]:
    """Return the first rough event of a panel, and its tau by linear interpolation; 1 if none."""
    best = 0, 1.0
    for event, rough in enumerate(phase.rough):
        if not rough:
            continue
        margin = phase.margin(event, *known)
        k = int((margin < 0.0).argmax())
        if k and margin[k] < 0.0:
            before, after = margin[k - 1 : k + 1].tolist()
            left, right = nodes.points[k - 1 : k + 1].tolist()
            best = min(best, (event, left + (right - left) * before / (before - after)), key=_tau)
    return best


def _tau(found: tuple[int, float]) -> float:
    return found[1]


def _update(
    residual: Array, response: PhaseResponse, inertia: float, time_matrix: Array, nodes: Nodes
) -> Array:
    """Solve the linear system of Newton's method; a singular one has no answer."""
    stiffness, gathered = response.stiffness, response.gathered
    if stiffness is not None:
        matrix = (time_matrix * stiffness).dot(time_matrix)
    elif gathered is not None:
        matrix = time_matrix.dot(time_matrix * gathered)
    else:
        return residual
    matrix *= inertia
    matrix += nodes.identity
    try:
        return np.linalg.solve(matrix, residual)
    except np.linalg.LinAlgError:
        return np.full_like(residual, np.nan)


def _shift(margin: Array, spot: Array, length: float) -> float:
    """Return how much longer a panel must be for ``margin`` to end at zero, by a secant."""
    one, two = margin[-2:].tolist()
    return float(two * (1.0 - spot[-2].item()) * length / (one - two)) if one != two else np.inf
