"""Edge slip of many impacts: panels, events, and how long the next panel is to be.

The events of theory §5: slip stops (s psi falls to V), the front leaves its piece (or reaches
the centre), the shrinking edge catches the front.
"""

from __future__ import annotations

import numpy as np

from contactlab.numeric.lobatto import Array, lobatto, rows
from contactlab_laws.fronts.many.crossing import value
from contactlab_laws.fronts.many.impacts import DONE, Impacts
from contactlab_laws.fronts.many.panel import CAUGHT, LEAVES, NO_EVENT, NODES, STOPS, Panel, solve
from contactlab_laws.fronts.many.pieces import Rows
from contactlab_laws.fronts.phases import EdgeSlip

#: Radians of the fastest oscillation that one panel may hold: its square in x is 6 chi u at most.
LONGEST_SWING = 2.0
LONGEST = 0.8
#: A piece is left this much beyond the guess of when, so that one panel sees it left.
BEYOND, LEAST_REACH = 1.1, 1e-4
#: A locked piece that ends this near the centre (in parts of zeta) is left like a square root of x.
NEAR_CENTRE = 0.1
#: The least part of an unfitted panel in a piece laid down that is to lie before its event. Beyond
#: it the front may have a kink: at the other end of the piece, or where it is back at the edge.
PART_INSIDE = 0.6
#: Panels are refused this often in a row before an end is not fitted.
MOST_FITS = 6
#: An event with no more progress in x than this shortens no panel.
PROGRESS = 1e-7
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

    again = np.zeros_like(good)
    if not fitted:
        near, first = panel.leaves * panel.length, panel.tau * panel.length
        # singular ends are fitted; far beyond an event a panel is not to be trusted
        to_fit = (panel.leaves <= 1.0) & singular & (impacts.attempts[who] < MOST_FITS)
        to_fit &= near > 1e-9
        cut = (panel.tau <= 1.0) & ~to_fit & (first > PROGRESS)
        cut &= ~good | (laid & (panel.tau < PART_INSIDE))
        impacts.fitted[who[to_fit]] = True
        impacts.longest[who[to_fit]] = near[to_fit]
        part = np.minimum(1.02 * panel.tau, np.where(good, 1.0, shorter))
        _refuse(impacts, who[cut], (part * panel.length)[cut])
        again = to_fit | cut
    refused = ~good & ~again
    _refuse(impacts, who[refused], (shorter * panel.length)[refused])
    done = np.flatnonzero(good & ~again)
    if done.size:
        wanted = panel.length * np.clip(growth, 0.5, 3.0)
        # a panel kept short by its piece says nothing against longer ones
        wanted = np.where(held, np.maximum(wanted, impacts.estimated_length[who]), wanted)
        impacts.estimated_length[who[done]] = wanted[done]
        _accept(impacts, panel, done)


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


def _refuse(impacts: Impacts, who: Rows, length: Array) -> None:
    impacts.fitted[who] = False
    impacts.longest[who] = length
    impacts.attempts[who] += 1


def _accept(impacts: Impacts, panel: Panel, done: Rows) -> None:
    """Go to the event of some of the panels, or to their end, and on to the next phase."""
    who, event, tau = panel.who[done], panel.event[done], np.minimum(panel.tau[done], 1.0)
    weights = rows(lobatto(NODES), tau)
    spot = tau * (2.0 - tau) if panel.fitted else tau
    phase = panel.start[done] + panel.length[done] * spot
    impacts.phase[who] = phase
    impacts.change[who] += value(weights, panel.change[:, done])
    impacts.work[who] += value(weights, panel.work[:, done])
    impacts.slip[who] = value(weights, panel.sample.slip[:, done])
    impacts.force[who] = value(weights, panel.sample.response.force[:, done])
    impacts.longest[who] = np.inf
    impacts.fitted[who] = False
    impacts.attempts[who] = 0

    impacts.regime[who[(event == NO_EVENT) & (phase >= np.pi - 1e-12)]] = DONE
    stops = event == STOPS
    if stops.any():
        edge = np.sin(phase[stops]) ** 2
        depth = value(weights[stops], panel.depth[:, done[stops]])
        least = impacts.pieces["inner_q"][impacts.outermost[who[stops]]]
        impacts.lock(who[stops], np.maximum(edge - np.maximum(depth, 0.0), least))
    impacts.leave_piece(who[event == LEAVES])
    impacts.slip_back(who[event == CAUGHT])
