"""Location of the first event in a solved panel."""

from __future__ import annotations

import numpy as np

from contactlab.contracts import Phase
from contactlab.numeric.lobatto import Array, Nodes, dips, value_at
from contactlab_laws.events.panel import SolvedPanel, root

#: A margin starts at zero if it is this small, or this part of its largest.
ZERO = 1e-14
ZERO_PART = 1e-9
#: A minimum between the points looked at is deeper than this part of the margin's size, or
#: without effect.
SHALLOWEST = 1e-9
#: A quotient of a margin that starts at zero is negative if below this part of its size.
NOISE = 1e-12
#: A margin that stays zero is no event: its size is taken to be at least this many velocities.
STILL = 10.0


def first_event(phase: Phase, panel: SolvedPanel) -> tuple[int, float] | None:
    """Return (event, tau) of the first margin that falls below zero, or None.

    An event to which the panel is fitted is not looked for.
    """
    events = [event for event in range(len(phase.singular_events)) if event != panel.fitted]
    if not events:
        return None
    nodes = panel.nodes
    table = np.array([phase.margin(event, panel.sample) for event in events])
    finer = table @ nodes.to_fine
    lowest = finer.min(axis=1).tolist()
    firsts, largest = table[:, 0].tolist(), np.abs(table).max(axis=1)
    size = np.maximum(largest, STILL * np.abs(panel.sample.velocity).max())
    hidden: dict[int, tuple[int, float]] = {}
    for index, k, tau in zip(*dips(nodes, table.T, finer.T, -SHALLOWEST * size), strict=True):
        hidden.setdefault(int(k), (int(index), float(tau)))
    best: tuple[int, float] | None = None
    for k, event in enumerate(events):
        if firsts[k] > ZERO and lowest[k] > 0.0 and k not in hidden:
            continue
        margin, fine, noise, begin = table[k], finer[k], 0.0, 0
        if not (firsts[k] > ZERO and firsts[k] > ZERO_PART * largest[k]):
            margin, noise, begin = _quotient(nodes, margin, float(size[k]))
            fine = margin @ nodes.to_fine
        below = fine[begin:] < noise
        end = begin + int(below.argmax()) if below.any() else len(fine)
        if end == 0:
            return event, 0.0
        dip, tau = hidden.get(k, (end, 1.0))
        if dip < end:
            end, right, after = dip, tau, value_at(nodes, tau, margin)
        elif end < len(fine):
            right, after = nodes.fine[end].item(), fine[end].item()
        else:
            continue
        left, before = nodes.fine[end - 1].item(), fine[end - 1].item()
        if best is not None and left > best[1]:
            continue
        tau = root(nodes, margin, ((left, right), (before, after)))
        if best is None or tau < best[1]:
            best = event, tau
    return best


def _quotient(nodes: Nodes, margin: Array, size: float) -> tuple[Array, float, int]:
    """Return a margin that is zero at the start over tau, so that only its own sign counts.

    Besides it the level below which it is negative and not noise, and the first of the finer
    points to look at.
    """
    quotient = np.empty_like(margin)
    quotient[1:] = (margin[1:] - margin[0]) / nodes.points[1:]
    quotient[0] = nodes.slope @ margin
    # If the nodes say it begins inside the phase, the interpolant's first wiggle is noise.
    inside = quotient[1] > 0.0 or quotient[0] > 0.0
    return quotient, -NOISE * size, nodes.second if inside else 0
