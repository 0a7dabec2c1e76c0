"""One collocation panel: Newton's method for the velocity at Lobatto nodes."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    Phase,
    PhaseResponse,
    PhaseSample,
    PhaseState,
    ScaledContact,
)
from contactlab.numeric.lobatto import ON_NODE, Array, Nodes, rows, value_at

NEWTON_CAP = 25
#: Newton's method is quadratic: after a relative update this small, the error is rounding.
LAST_UPDATE = 1e-7
#: From this update on a panel shows whether a singular event comes within it.
LOOK_UPDATE = 0.1
#: Radians of the fastest oscillation that one panel may hold.
LONGEST_SWING = 9.0
#: A fitted length is not moved for less than this, relative; nor by more than half. What a move
#: leaves is its square.
FIT_MOVE, SHIFT_PART = 1e-10, 0.1
TINY = 1e-300
ROOT_CAP = 60
ROOT_WIDTH = 1e-15
#: An interpolated margin is known to no better than this part of its largest value.
ROUNDING = 2.0**-52
#: The square of a change beyond this is no number; a shorter panel changes less.
LARGEST_CHANGE = 1e150


@attrs.frozen(eq=False, slots=False)
class SolvedPanel:
    """A solved panel: converged values at its nodes, and the ``DenseOutput`` between them.

    Attributes
    ----------
    nodes : Nodes
    origin, length : float
        Where it begins, and how long it is, in x.
    sample : PhaseSample
        The motion at the nodes.
    change, force : ndarray, shape (nodes,)
        Change of psi since the panel's start, and F/(mu P_max).
    time_matrix, time : ndarray, shape (nodes, nodes) and (nodes,)
        Integration over T from the panel's start to each node, and T itself.
    fitted : int or None
        The event at which the panel was made to end, if any: its nodes are rooted then.
    """

    nodes: Nodes
    origin: float
    length: float
    sample: PhaseSample
    change: Array
    force: Array
    time_matrix: Array
    time: Array
    fitted: int | None

    def tau(self, x: Array) -> Array:
        """Return the panel coordinate of ``x``."""
        tau = (x - self.origin) / self.length
        return tau if self.fitted is None else 1.0 - np.sqrt(np.maximum(0.0, 1.0 - tau))

    @cached_property
    def _columns(self) -> Array:
        contact, slip, velocity, _ = self.sample
        slip_rate, approach_rate = contact.time_rate * velocity, contact.time_rate * contact.rate
        values = slip, self.force, contact.approach, contact.radius, slip_rate, approach_rate
        return np.array([*values, self.nodes.plain[1]])

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
        basis = rows(self.nodes, self.tau(x))
        return basis @ self.change, basis @ self.force, basis @ self.sample.slip


class _Grid(NamedTuple):
    """A panel of one length: contact and dT/dtau at its nodes, integration over T, and T.

    ``uniform_slip`` is the slip if the velocity stayed as it was.
    """

    contact: ScaledContact
    rate: Array
    time_matrix: Array
    time: Array
    uniform_slip: Array


@attrs.frozen(eq=False)
class Collocation:
    """The equations of motion of one impact, collocated at the nodes of a panel.

    Parameters
    ----------
    motion : ClosedFormMotion
        The normal motion.
    inertia : float
        In d psi/dT = -inertia F/(mu P_max).
    nodes : Nodes
    """

    motion: ClosedFormMotion
    inertia: float
    nodes: Nodes

    def grid(self, start: PhaseState, length: float, spacing: tuple[Array, Array]) -> _Grid:
        """Return the nodes from ``start`` on, spaced as ``nodes.plain`` or ``nodes.rooted``."""
        spot, spread = spacing
        contact = self.motion.scaled(start.x + length * spot)
        rate = contact.time_rate * (length * spread)
        time = self.nodes.integral.dot(rate)
        slip = start.velocity * time
        slip += start.slip
        return _Grid(contact, rate, self.nodes.integral * rate, time, slip)

    def solve(
        self, phase: Phase, start: PhaseState, length: float, guess: Array | None, *, fits: bool
    ) -> SolvedPanel | None:
        """Return a solved panel, of the given length unless a singular event comes within it.

        A panel with a singular event is fitted: it ends at the event, and its nodes crowd there.

        Parameters
        ----------
        phase : Phase
        start : PhaseState
        length : float
            In x.
        guess : ndarray, shape (nodes,), or None
            Of the change of velocity.
        fits : bool
            False to look for no event.

        Returns
        -------
        SolvedPanel or None
            None if Newton's method does not converge or the panel is too long for its nodes.
        """
        nodes, inertia = self.nodes, self.inertia
        spacing, fitted, looks = nodes.plain, None, fits and any(phase.singular_events)
        grid = self.grid(start, length, spacing)
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
            slip += grid.uniform_slip
            response = phase.respond(grid.contact, slip, memo)
            memo, force, gathered = response.memo, response.force, response.gathered
            if gathered is not None:
                force = force + time_matrix.dot(gathered * (start.velocity + change))
            residual = time_matrix.dot(force)
            residual *= inertia
            if last:
                change = -residual
                sample = PhaseSample(grid.contact, slip, start.velocity + change, response)
                found = sample, change, force, time_matrix, grid.time, fitted
                return SolvedPanel(nodes, start.x, length, *found)
            residual += change
            slope = gathered if response.stiffness is None else response.stiffness
            if step == 0 and slope is not None:
                swing = inertia * float((slope * grid.rate * grid.rate).max())
                if not swing < LONGEST_SWING**2:
                    return None
            delta = self._update(residual, response, time_matrix)
            change = change - delta
            size = float(change.dot(change)) / count + first_size
            update = (float(delta.dot(delta)) / size) ** 0.5
            if not update < 1e6:
                return None
            if fitted is not None:
                slip -= time_matrix.dot(delta)
                sample = PhaseSample(grid.contact, slip, start.velocity + change, response)
                shift = _shift(phase.margin(fitted, sample), spacing[0], length)
                if not abs(shift) < 0.5 * length:
                    return None
                if abs(shift) > FIT_MOVE * length:
                    change -= (inertia * shift) * (force * grid.contact.time_rate * spacing[0])
                    length += shift
                    grid = self.grid(start, length, spacing)
                    update = max(update, SHIFT_PART * abs(shift) / length)
            elif looks and update < LOOK_UPDATE:
                sample = PhaseSample(grid.contact, slip, start.velocity + change, response)
                event, part = _singular_event(phase, sample, nodes)
                if part < 1.0:
                    fitted, spacing, memo = event, nodes.rooted, ()
                    change = rows(nodes, part * spacing[0]) @ change
                    length *= part
                    grid = self.grid(start, length, spacing)
                    continue
            last = update < LAST_UPDATE or phase.linear
        return None

    def _update(self, residual: Array, response: PhaseResponse, time_matrix: Array) -> Array:
        """Return the solution of Newton's linear system; a singular one has none, and gives NaN."""
        stiffness, gathered = response.stiffness, response.gathered
        if stiffness is not None:
            matrix = (time_matrix * stiffness).dot(time_matrix)
        elif gathered is not None:
            matrix = time_matrix.dot(time_matrix * gathered)
        else:
            return residual
        matrix *= self.inertia
        matrix += self.nodes.identity
        try:
            return np.linalg.solve(matrix, residual)
        except np.linalg.LinAlgError:
            return np.full_like(residual, np.nan)


def _singular_event(phase: Phase, sample: PhaseSample, nodes: Nodes) -> tuple[int, float]:
    """Return the first singular event in a panel, and about its tau, or 1."""
    best = 0, 1.0
    for event, singular in enumerate(phase.singular_events):
        if not singular:
            continue
        margin = phase.margin(event, sample)
        k = int((margin < 0.0).argmax())
        if k:
            ends, values = nodes.points[k - 1 : k + 1], margin[k - 1 : k + 1]
            tau = root(nodes, margin, (tuple(ends.tolist()), tuple(values.tolist())), most=2)
            if tau < best[1]:
                best = event, tau
    return best


def root(
    nodes: Nodes,
    values: Array,
    bracket: tuple[tuple[float, float], tuple[float, float]],
    most: int = ROOT_CAP,
) -> float:
    """Return the root of the interpolant of ``values`` by the Illinois method.

    Parameters
    ----------
    nodes : Nodes
    values : array, shape (nodes,)
    bracket : pair of pairs of float
        Two points and the values there, the first of which is not negative.
    most : int
        Iterations; two, which know the interpolant's curvature, for a first guess.
    """
    (a, b), (fa, fb) = bracket
    if fa <= 0.0:
        return a
    side = 0
    scale = max(ROOT_WIDTH * (fa - fb), ROUNDING * float(np.abs(values).max()))
    t = a
    for _ in range(most):
        t = (fa * b - fb * a) / (fa - fb)
        ft = value_at(nodes, t, values)
        if abs(ft) <= scale or b - a < ROOT_WIDTH:
            break
        if ft > 0.0:
            a, fa, fb = t, ft, 0.5 * fb if side == 1 else fb
            side = 1
        else:
            b, fb, fa = t, ft, 0.5 * fa if side == -1 else fa
            side = -1
    return t


def _shift(margin: Array, spot: Array, length: float) -> float:
    """Return how much longer a panel must be for ``margin`` to end at zero, by a secant."""
    one, two = margin[-2:].tolist()
    return float(two * (1.0 - spot[-2].item()) * length / (one - two)) if one != two else np.inf
