"""Edge slip of many impacts: panels, events, and how long the next panel is to be.

The events of theory §5: slip stops (s psi falls to V), the front leaves its piece (or reaches
the centre), the shrinking edge catches the front.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab.collocation import Array, lobatto, rows
from contactlab_fronts.many.crossing import NEVER, first_crossing, value
from contactlab_fronts.many.impacts import DONE, UNSOLVED, Impacts
from contactlab_fronts.many.panel import NODES, Panel, solve
from contactlab_fronts.many.pieces import Rows
from contactlab_fronts.phases import EdgeSlip

Flags = NDArray[np.bool_]

NO_EVENT, STOPS, LEAVES, CAUGHT = range(4)
#: Radians of the fastest oscillation that one panel may hold: its square in x is 6 chi u at most.
LONGEST_SWING = 2.0
LONGEST = 0.8
#: A piece is left this much beyond the guess of when, so that one panel sees it left.
BEYOND, LEAST_REACH = 1.1, 1e-4
#: A locked piece that ends this near the centre (in parts of zeta) is left like a square root of x.
NEAR_CENTRE = 0.1
#: An unfitted panel may hold this part of its length beyond the piece it was solved in.
PART_INSIDE = 0.6
#: Panels are refused this often in a row before an impact is given up, or an end is not fitted.
MOST_ATTEMPTS, MOST_FITS = 40, 6
#: Events this often in a row with no more progress than this are looked for later in the panel.
MOST_IDLE, PROGRESS = 4, 1e-7
#: psi1 below this is solved to the same absolute error.
LEAST_SCALE = 1e-6
#: Moves of psi, in parts of the tolerance, at which iteration stops and a panel is good.
SETTLED, CONVERGED = 1e-3, 1e-2

#: Part of the tolerance aimed at: most panels are far better, and with this the worst are nearly as
#: good as those of one impact.
SAFETY = 0.1


def advance(impacts: Impacts, who: Rows, tolerance: float) -> None:
    """Take one panel for impacts of one kind: of ``Impacts.laid`` and of ``Impacts.fitted``.

    Panels are refused, and come again shorter or fitted to an event, if they did not converge
    or are not resolved.
    """
    laid, fitted = bool(impacts.laid(who[:1])[0]), bool(impacts.fitted[who[0]])
    piece, sign = impacts.pieces.piece(impacts.outermost[who], laid=laid), impacts.sign[who]
    slipping = EdgeSlip(sign, (piece,))
    singular = piece.singular_inner_end(sign)
    if not laid:
        singular |= piece.inner_q < NEAR_CENTRE * np.sin(impacts.phase[who]) ** 2
    free = _length(impacts, who)
    reach = impacts.longest[who] if fitted else _reach(impacts, who, slipping)
    held = reach < free
    length = reach if fitted else np.minimum(free, reach)
    limit = SAFETY * tolerance * np.clip(impacts.first[who], LEAST_SCALE, 1.0)
    panel = solve(impacts, who, slipping, length, SETTLED * limit, fitted=fitted)
    impacts.panels[who] += 1

    converged = panel.update < CONVERGED * limit
    growth = 0.9 * (limit / (panel.tail + 1e-300)) ** (1.0 / NODES)
    good = converged & (panel.tail < limit)
    shorter = np.where(converged, np.clip(growth, 0.2, 0.8), 0.5)

    tau, event, leaves = _events(panel, impacts.idle[who] > MOST_IDLE)
    if fitted:
        event = np.where(tau > 1.0, LEAVES, event)
        again = np.zeros_like(good)
    else:
        # singular ends are fitted; far beyond a kink a panel is not to be trusted
        near = leaves * panel.length
        to_fit = (leaves <= 1.0) & singular & (impacts.attempts[who] < MOST_FITS) & (near > 1e-9)
        cut = (leaves <= 1.0) & ~to_fit & (near > PROGRESS)
        cut &= ~good | (laid & (leaves < PART_INSIDE))
        impacts.fitted[who[to_fit]] = True
        impacts.longest[who[to_fit]] = near[to_fit]
        part = np.minimum(1.02 * leaves, np.where(good, 1.0, shorter))
        _refuse(impacts, who[cut], (part * panel.length)[cut])
        again = to_fit | cut
    refused = ~good & ~again
    _refuse(impacts, who[refused], (shorter * panel.length)[refused])
    done = np.flatnonzero(good & ~again)
    if done.size:
        wanted = panel.length * np.clip(growth, 0.5, 3.0)
        # a panel kept short by its piece says nothing against longer ones
        wanted = np.where(held, np.maximum(wanted, impacts.estimated_length[who]), wanted)
        _accept(impacts, who[done], panel, done, tau[done], event[done], wanted[done])


def _length(impacts: Impacts, who: Rows) -> Array:
    """Return the longest panel that the oscillation and the last error estimate allow."""
    phase = impacts.phase[who]
    # the square of the fastest oscillation in x is 2.4 inertia u at most
    swing = LONGEST_SWING / np.sqrt(2.4 * impacts.inertia[who] * np.sin(phase) + 0.5)
    length = np.minimum(np.minimum(np.pi - phase, LONGEST), swing)
    return np.asarray(
        np.minimum(length, np.minimum(impacts.longest[who], impacts.estimated_length[who]))
    )


def _reach(impacts: Impacts, who: Rows, slipping: EdgeSlip) -> Array:
    """Return a guess of the length after which zeta - s D has fallen by M = r t + a t²/2."""
    sign, now = impacts.sign[who], impacts.motion.scaled(impacts.phase[who])
    margin = slipping.profile[-1].inner_margin(sign, now, impacts.slip[who])
    fall = now.time_rate * (sign * impacts.velocity(who) - now.rate)
    pull = impacts.inertia[who] * sign * impacts.force[who]
    gain = (now.force / impacts.motion.scaled_mass - pull) * now.time_rate**2
    inside = fall * fall + 2.0 * margin * gain
    reach = 2.0 * margin / (fall + np.sqrt(np.maximum(inside, 0.0)) + 1e-300)
    known = (inside > 0.0) & (reach > 0.0)
    return np.where(known, np.maximum(BEYOND * reach, LEAST_REACH), np.inf)


def _events(panel: Panel, idle: Flags) -> tuple[Array, Rows, Array]:
    """Return (tau, which) of the first event, and the tau at which the piece is left."""
    nodes = lobatto(NODES)
    stops, caught = (first_crossing(nodes, panel.margins[event]) for event in (0, 2))
    leaves = np.full(stops.shape, NEVER)
    if not panel.fitted:
        leaves = first_crossing(nodes, panel.margins[1])
    for found in (stops, caught):
        found[idle & (found < nodes.points[1])] = NEVER
    tau = np.minimum(np.minimum(stops, caught), leaves)
    event = np.where(tau == stops, STOPS, np.where(tau == caught, CAUGHT, LEAVES))
    return np.minimum(tau, NEVER), np.where(tau > 1.0, NO_EVENT, event), leaves


def _refuse(impacts: Impacts, who: Rows, length: Array) -> None:
    impacts.fitted[who] = False
    impacts.longest[who] = length
    impacts.attempts[who] += 1
    impacts.regime[who[impacts.attempts[who] > MOST_ATTEMPTS]] = UNSOLVED


def _accept(
    impacts: Impacts, who: Rows, panel: Panel, columns: Rows, tau: Array, event: Rows, wanted: Array
) -> None:
    """Go to the event, or to the end of the panel, and on to the next phase.

    Parameters
    ----------
    impacts : Impacts
    who, columns : ndarray of int
        Impacts, and which of the panels are theirs.
    panel : Panel
    tau : ndarray
        Panel coordinate of the event; above 1 if there is none.
    event : ndarray of int
    wanted : ndarray
        Length that the error estimate asks for, in x.
    """
    tau = np.minimum(tau, 1.0)
    weights = rows(lobatto(NODES), tau)
    phase = panel.phase(columns, tau)
    progress = phase - impacts.phase[who]
    impacts.phase[who] = phase
    impacts.change[who] += value(weights, panel.change[:, columns])
    impacts.work[who] += value(weights, panel.work[:, columns])
    impacts.slip[who] = value(weights, panel.sample.slip[:, columns])
    impacts.force[who] = value(weights, panel.sample.response.force[:, columns])
    impacts.estimated_length[who] = wanted
    impacts.longest[who] = np.inf
    impacts.fitted[who] = False
    impacts.attempts[who] = 0
    impacts.idle[who] = np.where(progress < PROGRESS, impacts.idle[who] + 1, 0)

    impacts.regime[who[(event == NO_EVENT) & (phase >= np.pi - 1e-12)]] = DONE
    stops = event == STOPS
    if stops.any():
        edge = np.sin(phase[stops]) ** 2
        depth = value(weights[stops], panel.margins[2][:, columns[stops]])
        least = impacts.pieces["inner_q"][impacts.outermost[who[stops]]]
        impacts.lock(who[stops], np.maximum(edge - np.maximum(depth, 0.0), least))
    impacts.leave_piece(who[event == LEAVES])
    impacts.slip_back(who[event == CAUGHT])
