"""A normal motion divided into even steps, and the steps one by one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from contactlab.contracts import NormalContact, NormalMotion, Steps


#: A sample acts for the time in which its load has the exact impulse of the step. So tangential
#: and normal impulse are in the exact ratio wherever the contact slips all over. Near the ends
#: of contact that is not the step's own time, but not further from it than these factors.
LEAST_KICK, MOST_KICK = 0.5, 2.0


def midpoints(normal: NormalMotion, count: int) -> Steps:
    """Return ``count`` steps of the contact's duration, each sampled in its middle."""
    halves = np.array(normal.phase(np.linspace(0.0, 1.0, 2 * count + 1)))
    halves[-1] = np.pi  # exactly, as the inverse is not
    ends = normal.at(_column(halves[::2], normal))
    times = np.asarray(ends.time)
    kick = times[1:] - times[:-1]
    impulse = np.asarray(ends.load_impulse)
    return _steps(normal, halves[1::2], kick, impulse[1:] - impulse[:-1])


def endpoints(normal: NormalMotion, count: int) -> Steps:
    """Return the same steps sampled at their ends.

    The half steps after first touch and before separation have the force of their neighbours.
    """
    fractions = np.linspace(0.0, 1.0, count + 1)
    # Ends of the times in which the samples act; the last sample, at separation, has no load.
    edges = np.concatenate(([0.0], fractions[1:-1] + 0.5 / count, [1.0]))
    edges[max(count - 1, 1)] = 1.0
    phases = np.array(normal.phase(np.concatenate((fractions[1:], edges))))
    phases[[count - 1, -1]] = np.pi
    impulse = np.asarray(normal.at(_column(phases[count:], normal)).load_impulse)
    loads = impulse[1:] - impulse[:-1]
    kick = np.asarray(normal.duration) / count
    shape = (count,) + (1,) * len(normal.scene.shape)
    return _steps(normal, phases[:count], np.ones(shape) * kick, loads)


def _steps(normal: NormalMotion, phases: Any, kick: Any, load_impulse: Any) -> Steps:
    """Return steps that sample the contact at ``phases``, as read-only arrays."""
    time, approach, rate, contact, _ = normal.at(_column(phases, normal))
    drift = np.array(time)
    drift[1:] -= time[:-1]
    load = np.asarray(contact.friction_load)
    with np.errstate(all="ignore"):
        even = load_impulse / load
    even = np.where(load > 0.0, even, kick)
    kick = np.clip(even, LEAST_KICK * kick, MOST_KICK * kick)
    full = np.zeros_like(drift + kick)  # what all impacts share may lack the batch's axes
    steps = Steps(
        contact=NormalContact(*(full + entry for entry in contact)),
        drift=drift,
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
    """Iterate over the steps: floats for one impact (much faster), arrays for a batch."""
    columns = [*steps.contact, *steps[1:]]
    lists = [column.tolist() if column.ndim == 1 else column for column in columns]
    for row in zip(*lists, strict=True):
        yield Steps(NormalContact(*row[:4]), *row[4:])


def _column(phases: Any, normal: NormalMotion) -> Any:
    return phases.reshape((-1,) + (1,) * len(normal.scene.shape))
