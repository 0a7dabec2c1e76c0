"""Where in a solved panel the first event happens."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab.collocation import Nodes, row
from contactlab.contracts import Phase
from contactlab_events.panel import Solved

Array = NDArray[np.float64]

#: A margin starts at zero if it is this small, or this part of its largest.
ZERO = 1e-14
ZERO_PART = 1e-9
#: A quotient of a margin that starts at zero is negative if below this part of its size.
NOISE = 1e-12
#: A margin that stays zero is no event: its size is taken to be at least this many velocities.
STILL = 10.0
ROOT_CAP = 60
ROOT_WIDTH = 1e-15


def first_event(nodes: Nodes, phase: Phase, solved: Solved) -> tuple[int, float] | None:
    """Return (event, tau) of the first margin that falls below zero, or None.

    An event to which the panel is fitted is not looked for.
    """
    events = [event for event in range(len(phase.rough)) if event != solved.fitted]
    if not events:
        return None
    known = solved.contact, solved.slip, solved.velocity, solved.response
    table = np.array([phase.margin(event, *known) for event in events])
    finer = table @ nodes.to_fine
    lowest = finer.min(axis=1).tolist()
    firsts, largest = table[:, 0].tolist(), np.abs(table).max(axis=1).tolist()
    best: tuple[int, float] | None = None
    for place, event in enumerate(events):
        first = firsts[place]
        if first > ZERO and (lowest[place] > 0.0 or first > ZERO_PART * largest[place]):
            if lowest[place] > 0.0:
                continue
            margin, fine, noise, begin = table[place], finer[place], 0.0, 0
        else:
            margin, noise, begin = _quotient(nodes, table[place], first, solved)
            fine = margin @ nodes.to_fine
        below = fine[begin:] < noise
        k = int(below.argmax())
        if not below[k]:
            continue
        k += begin
        if k == 0:
            return event, 0.0
        left, right = nodes.fine[k - 1].item(), nodes.fine[k].item()
        if best is not None and left > best[1]:
            continue
        root = _root(nodes, margin, (left, right), (fine[k - 1].item(), fine[k].item()))
        if best is None or root < best[1]:
            best = event, root
    return best


def _quotient(
    nodes: Nodes, margin: Array, first: float, solved: Solved
) -> tuple[Array, float, int]:
    """Divide a margin that is zero at the start by tau, so that only its own sign counts.

    Returns the quotient, the level below which it is negative and not noise, and the first
    of the finer points to look at.
    """
    size = max(float(np.abs(margin).max()), STILL * float(np.abs(solved.velocity).max()))
    quotient = np.empty_like(margin)
    quotient[1:] = (margin[1:] - first) / nodes.points[1:]
    quotient[0] = nodes.slope @ margin
    # If the nodes say it begins inside the phase, the interpolant's first wiggle is noise.
    inside = quotient[1] > 0.0 or quotient[0] > 0.0
    begin = nodes.second if inside else 0
    return quotient, -NOISE * size, begin


def _root(
    nodes: Nodes, values: Array, ends: tuple[float, float], at_ends: tuple[float, float]
) -> float:
    """Return the root of the interpolant between two points (Illinois method)."""
    (a, b), (fa, fb) = ends, at_ends
    if fa <= 0.0:
        return a
    side = 0
    scale = ROOT_WIDTH * (fa - fb)
    t = a
    for _ in range(ROOT_CAP):
        t = (fa * b - fb * a) / (fa - fb)
        ft = float(row(nodes, t) @ values)
        if abs(ft) <= scale or b - a < ROOT_WIDTH:
            break
        if ft > 0.0:
            a, fa = t, ft
            if side == 1:
                fb *= 0.5
            side = 1
        else:
            b, fb = t, ft
            if side == -1:
                fa *= 0.5
            side = -1
    return t
