"""The course of impacts already followed, shown to an observer."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    ClosedPhase,
    NormalContact,
    Observer,
    PhasedTangentialLaw,
    Sample,
    ScaledContact,
)
from contactlab_events.scaled import Run

Array = NDArray[np.float64]

#: Even phases shown; the events of a single impact are shown besides.
INSTANTS = 201


def show(
    batch: tuple[int, ...], law: PhasedTangentialLaw, runs: Sequence[Run], observer: Observer
) -> None:
    """Call ``observer`` at phases common to all impacts, as far as every one of them came."""
    reached = min(run.followed.state.x for run in runs)
    x = np.linspace(0.0, math.pi, INSTANTS)
    if not batch:
        x = np.union1d(x, [piece.stop for piece in runs[0].followed.pieces])
    x = x[x <= reached]
    tables = [_course(run, x) for run in runs]
    shape = (len(x), *batch)

    def column(name: str) -> list[Any]:
        values = np.array([table[name] for table in tables]).T
        return list(values.reshape(shape)) if batch else values[:, 0].tolist()

    names = ("time", "approach", "rate", "force", "radius", "velocity", "friction")
    for k, row in enumerate(zip(*(column(name) for name in names), strict=True)):
        time, approach, rate, force, radius, velocity, friction = row
        observer(
            Sample(
                time=time,
                approach=approach,
                normal_velocity=rate,
                contact=NormalContact(force, radius, approach, force),
                slip_velocity=velocity,
                tangential_force=friction,
                fields=_asking(batch, law, runs, tables, float(x[k]), k),
            )
        )


def _course(run: Run, x: Array) -> dict[str, Array]:
    """Return one impact's course at ascending x, in SI; slip stays scaled, for the fields."""
    impact, followed = run.impact, run.followed
    time, approach, rate, contact, _ = impact.motion.at(x)
    change, friction, slip = np.empty_like(x), np.zeros_like(x), np.zeros_like(x)
    change[:] = followed.state.change
    normal = impact.motion.scaled(x)
    for piece in followed.pieces:
        inside = (x >= piece.start.x) & (x <= piece.stop)
        if piece.stop <= piece.start.x or not inside.any():
            continue
        if isinstance(piece.path, ClosedPhase):
            part = ScaledContact(*(column[inside] for column in normal))
            change[inside], friction[inside] = piece.path.states(part)
            slip[inside] = piece.start.slip
        else:
            gained, friction[inside], slip[inside] = piece.path.motion(x[inside])
            change[inside] = piece.start.change + gained
    gained = run.factor * impact.velocity_unit * change
    return {
        "time": np.asarray(time),
        "approach": np.asarray(approach),
        "rate": np.asarray(rate),
        "force": np.asarray(contact.force),
        "radius": np.asarray(contact.radius),
        "velocity": impact.slip_velocity + gained,
        "friction": run.factor * impact.force_unit * friction,
        "slip": slip,
    }


def _asking(
    batch: tuple[int, ...],
    law: PhasedTangentialLaw,
    runs: Sequence[Run],
    tables: Sequence[Mapping[str, Array]],
    x: float,
    k: int,
) -> Callable[[], Mapping[str, Any]]:
    """Return a function that asks the law for its fields at the k-th instant."""

    def ask() -> Mapping[str, Any]:
        answers = []
        for run, table in zip(runs, tables, strict=True):
            pieces = run.followed.pieces
            piece = next((p for p in pieces if x <= p.stop and p.stop > p.start.x), None)
            if piece is None:
                return {}
            contact = run.impact.motion.scaled_at(x)
            slip = float(table["slip"][k])
            answers.append(
                law.phase_fields(run.impact.motion, piece.phase, contact, slip, run.factor)
            )
        if not batch:
            return answers[0]
        return {
            name: np.array([answer[name] for answer in answers]).reshape(
                *batch, *np.shape(answers[0][name])
            )
            for name in answers[0]
        }

    return ask
