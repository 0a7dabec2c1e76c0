"""Steps that end at the marks of a law."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    NormalMotion,
    Observer,
    SteppedTangentialLaw,
    Steps,
    TangentialMotion,
    faults,
)
from contactlab.contracts.status import Status
from contactlab_laws.march.division import sampled
from contactlab_laws.march.march import march

Array = NDArray[np.float64]

#: A part of the contact between two marks that exceeds a number of steps by less than this, over
#: one step, has this number of steps: impacts that differ by rounding have equal steps.
ROUNDING = 1e-6


def march_tied(
    normal: NormalMotion,
    law: SteppedTangentialLaw,
    count: int,
    observer: Observer | None,
    *,
    least: int | None = None,
) -> TangentialMotion | None:
    """Return the motion in steps that end at the marks of ``law``; None for a law without marks.

    Between two marks steps are even in time, and no longer than one of ``count`` even steps.

    Parameters
    ----------
    normal : NormalMotion
    law : SteppedTangentialLaw
    count : int
    observer : callable or None
    least : int, optional
        If given, ``count`` is halved as long as it is even and the half is at least ``least``,
        and the steps of each part are doubled as often: a doubled ``count`` halves every step.
    """
    with faults.blaming(law):
        marks = law.marks(normal.scene, normal)
    if marks is None:
        return None
    shape = normal.scene.shape
    ends = _ends(law, marks, shape)
    with faults.blaming(normal.law):
        times = np.asarray(normal.at(ends).time)
    fractions = np.broadcast_to(times / np.asarray(normal.duration), (len(ends), *shape))
    doubled = 1
    while least is not None and count % 2 == 0 and count // 2 >= least:
        count, doubled = count // 2, 2 * doubled
    parts = np.ceil(np.diff(fractions, axis=0) * count - ROUNDING)
    counts = doubled * np.maximum(np.nan_to_num(parts), 1.0).astype(int)
    rows, group = np.unique(counts.reshape(len(counts), -1), axis=1, return_inverse=True)
    if observer is not None or rows.shape[1] == 1:
        with faults.blaming(normal.law):
            steps = _steps(normal, ends, fractions, rows.max(axis=1).tolist())
        return march(normal, law, steps, observer)
    motions = []
    for index in range(rows.shape[1]):
        where = (group == index).reshape(shape)
        part = normal.take(where)
        own = np.broadcast_to(ends, (len(ends), *shape))[:, where]
        with faults.blaming(normal.law):
            steps = _steps(part, own, fractions[:, where], rows[:, index].tolist())
        motions.append((where, march(part, law, steps, None)))
    return TangentialMotion.merged(motions, shape)


def _ends(law: SteppedTangentialLaw, marks: Any, shape: tuple[int, ...]) -> Array:
    """Return the phases of first touch, marks and separation, shape (M + 2, ...)."""
    inner = np.asarray(marks, dtype=np.float64)
    if inner.ndim == 1:
        inner = inner.reshape(-1, *(1,) * len(shape))
    edge = np.zeros((1, *inner.shape[1:]))
    ends = np.concatenate((edge, inner, edge + np.pi))
    if not (np.diff(ends, axis=0) > 0.0).all():
        what = "marks that do not grow from 0 to pi"
        raise faults.LawFaultError(Status.MALFORMED, faults.sentence(law, what, 1))
    return ends


def _steps(normal: NormalMotion, ends: Array, fractions: Array, counts: list[int]) -> Steps:
    """Return steps sampled at their ends, ``counts`` of them from each of ``ends`` to the next."""
    shape = normal.scene.shape
    lines = []
    for first, last, count in zip(fractions[:-1], fractions[1:], counts, strict=True):
        share = (np.arange(1, count + 1) / count).reshape(-1, *(1,) * len(shape))
        lines.append(first + (last - first) * share)
    samples = np.concatenate(lines)
    # The force at a sample acts on half of the step before and half of the step after it.
    edges = np.concatenate((samples[:1] * 0.0, 0.5 * (samples[1:] + samples[:-1]), samples[-1:]))
    phases = np.array(np.broadcast_to(normal.phase(samples), samples.shape))
    phases[np.cumsum(counts) - 1] = ends[1:]
    halves = np.array(np.broadcast_to(normal.phase(edges), edges.shape))
    halves[-1] = np.pi
    impulse = np.asarray(normal.at(halves).load_impulse)
    kick = np.diff(edges, axis=0)
    kick[0] -= 0.5 * samples[0]  # there is no force at first touch
    return sampled(normal, phases, kick * normal.duration, impulse[1:] - impulse[:-1])
