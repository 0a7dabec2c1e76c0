"""The history of impacts already solved, shown to an observer."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from contactlab.contracts import ClosedPhase, NormalContact, Observer, Sample, ScaledContact
from contactlab.numeric.lobatto import Array
from contactlab_laws.events.scaled import SolvedImpact

#: Even phases shown; the events of a single impact are shown besides.
INSTANTS = 201


def show(batch: tuple[int, ...], solved: Sequence[SolvedImpact], observer: Observer) -> None:
    """Call ``observer`` at phases common to all impacts, as far as every one of them came."""
    x = np.linspace(0.0, math.pi, INSTANTS)
    if not batch:
        x = np.union1d(x, [segment.stop for segment in solved[0].trajectory.segments])
    x = x[x <= min(one.trajectory.state.x for one in solved)]
    table = np.stack([_history(one, x) for one in solved], axis=-1)
    columns = table.reshape(len(table), len(x), *batch) if batch else table[..., 0].tolist()
    for k, row in enumerate(zip(*columns, strict=True)):
        time, approach, rate, force, radius, velocity, friction, _ = row
        impacts = list(zip(solved, table[-1, k].tolist(), strict=True))
        observer(
            Sample(
                time=time,
                approach=approach,
                normal_velocity=rate,
                contact=NormalContact(force, radius, approach, force),
                slip_velocity=velocity,
                tangential_force=friction,
                fields=partial(_fields, batch, float(x[k]), impacts),
            )
        )


def _history(solved: SolvedImpact, x: Array) -> Array:
    """Return one impact's history at ascending x: rows of what a ``Sample`` holds, in SI.

    The last row is the slip, which stays scaled, for the fields.
    """
    impact, found = solved.impact, solved.trajectory
    time, approach, rate, contact, _ = impact.motion.at(x)
    change, friction, slip = np.full_like(x, found.state.change), np.zeros_like(x), np.zeros_like(x)
    normal = impact.motion.scaled(x)
    for segment in found.segments:
        start, output = segment.start, segment.output
        inside = (x >= start.x) & (x <= segment.stop)
        if segment.stop <= start.x or not inside.any():
            continue
        if isinstance(output, ClosedPhase):
            part = ScaledContact(*(column[inside] for column in normal))
            change[inside], friction[inside] = output.states(part)
            slip[inside] = start.slip
        else:
            gained, friction[inside], slip[inside] = output.motion(x[inside])
            change[inside] = start.change + gained
    velocity = impact.slip_velocity + solved.factor * impact.velocity_unit * change
    friction *= solved.factor * impact.force_unit
    return np.array([time, approach, rate, contact.force, contact.radius, velocity, friction, slip])


def _fields(
    batch: tuple[int, ...], x: float, impacts: Sequence[tuple[SolvedImpact, float]]
) -> Mapping[str, Any]:
    """Return the law's fields at one phase ``x`` of impacts given with their scaled slip there."""
    answers = []
    for one, slip in impacts:
        segments = (s for s in one.trajectory.segments if x <= s.stop and s.stop > s.start.x)
        segment = next(segments, None)
        if segment is None:
            return {}
        motion = one.impact.motion
        at = motion.scaled_at(x)
        answers.append(one.law.phase_fields(motion, segment.phase, at, slip, one.factor))
    return {
        name: np.array([answer[name] for answer in answers]).reshape(batch + np.shape(first))
        for name, first in answers[0].items()
    }
