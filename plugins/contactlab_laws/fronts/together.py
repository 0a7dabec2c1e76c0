"""Impacts of the slip front in which friction changes the approach: scaling in, motion out."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from contactlab.contracts import (
    Ends,
    NormalContact,
    NormalMotion,
    Observer,
    Sample,
    Scene,
    TangentialMotion,
)
from contactlab.contracts.status import Status
from contactlab.impact.hertz import DURATION_CONSTANT, hertz_scales
from contactlab.numeric.types import Array
from contactlab_laws.fronts import compiled
from contactlab_laws.fronts.path import Impact
from contactlab_laws.fronts.phases import Phase
from contactlab_laws.fronts.series import Rows, value
from contactlab_laws.fronts.steps import Watch, error_of_step
from contactlab_laws.fronts.steps import alone as followed
from contactlab_laws.hertz.motion import scaled_motion, velocity_factor

#: The accuracy if none is asked for.
USUAL = 1e-9
#: V, psi's change, work, T, u and compressions of an impact without friction (theory §1).
SMOOTH = (-1.0, 0.0, 0.0, DURATION_CONSTANT, 1.0, 1.0)


def motion(
    scene: Scene,
    normal: NormalMotion,
    accuracy: float | None,
    observer: Observer | None,
) -> TangentialMotion:
    """Return the motion of planar impacts."""
    shape, tolerance = scene.shape, error_of_step(accuracy or USUAL)
    scales = hertz_scales(normal.scene)
    W: Any = scene.inverse_mass
    mu, speed = np.asarray(scene.friction_coefficient), np.asarray(scene.normal_speed)
    kappa = np.asarray(scene.pair.stiffness_ratio)
    columns = (scene.psi1, scene.chi, scene.lam, scene.eta)
    # without friction nothing slips: psi is infinite, and V and the slip are closed forms
    smooth = np.broadcast_to(mu == 0.0, shape)
    numbers = np.array([np.broadcast_to(column, shape) for column in columns], dtype=float)
    moving = np.flatnonzero(~smooth)
    watch = None if observer is None else partial(_watch, scene, scales, observer)
    found, lost = solved(numbers.reshape(4, -1)[:, moving], tolerance, watch)
    rows = np.repeat(np.array(SMOOTH)[:, None], smooth.size, axis=1)
    rows[:, moving] = found[:6]
    statuses = np.full(smooth.size, Status.SUCCESS, dtype=object)
    details = np.full(smooth.size, "", dtype=object)
    for place in np.flatnonzero(lost).tolist():
        rows[:, moving[place]] = math.nan
        statuses[moving[place]] = Status.UNRESOLVED
        details[moving[place]] = f"{lost[place]}, from Fronts."
    rate, psi, work, time, radius, times = rows.reshape(6, *shape)
    unit = mu * speed / kappa
    dragged = -2.0 * speed * W[..., 0, 1] / W[..., 0, 0]
    change = np.where(smooth, dragged, psi * np.where(smooth, 0.0, unit))
    # over v1²/(2 W_nn): 2.5 rho work (theory §14)
    energy = 1.25 * mu * mu / kappa * speed * speed / W[..., 0, 0]
    approach = radius * radius
    number: Any = np.asarray if shape else float
    compressions = np.nan_to_num(times)
    ends = (
        time * scales.approach / speed, rate * speed, radius * scales.radius,
        approach * scales.approach, radius * approach * scales.force, 0.0 * work, compressions,
    )  # fmt: skip
    return TangentialMotion(
        slip_velocity_change=number(change),
        friction_work=number(energy * work),
        normal=Ends(*map(number, ends)),
        status=statuses.reshape(shape) if shape else statuses[0],
        detail=details.reshape(shape) if shape else details[0],
        counters={"steps": int(np.sum(found[6]))},
    )


def solved(
    numbers: Array, tolerance: float, watch: Callable[[Impact], Watch] | None = None
) -> tuple[Array, Any]:
    """Return what impacts leave, as ``compiled.follow`` does, and why some are lost, as objects.

    Parameters
    ----------
    numbers : array, shape (4, impacts)
        psi1, chi, lam and eta.
    tolerance : float
        Error of a step.
    watch : callable, optional
        Returns what shows the steps of an impact; Python's solver alone shows them.
    """
    count = numbers.shape[1]
    out, lost = np.empty((7, count)), np.full(count, "", dtype=object)
    alone = np.arange(count)
    if watch is None and compiled.library() is not None:
        out, status = compiled.follow(numbers, tolerance, compiled.MOST_STEPS)
        for place in np.flatnonzero(status).tolist():
            if status[place] != compiled.MEMORY:
                lost[place] = compiled.LOST[status[place]].format(compiled.MOST_STEPS)
        alone = np.flatnonzero(status == compiled.MEMORY)
    for place in alone.tolist():
        impact = Impact(*numbers[:, place].tolist(), stepped=watch is not None)
        shown = None if watch is None else watch(impact)
        lost[place] = followed(impact, tolerance, compiled.MOST_STEPS, shown)
        ends = impact.rate, impact.change, impact.work, _time(impact), impact.deepest
        out[:, place] = *ends, impact.compressions, impact.steps
    return out, lost


def _time(impact: Impact) -> float:
    """Return T at separation, with Hertz's in gross slip, where V² + ``press`` u⁵ is ``left``."""
    time = impact.time
    for press, left, *ends in impact.slides:
        top, speed = (left / press) ** 0.2, math.sqrt(left)
        radius, rate = np.array(ends[::2]) / top, np.array(ends[1::2]) / speed
        phases = np.arctan2(radius, rate / velocity_factor(radius))
        begin, end = scaled_motion(phases)[2]
        time += top * top / speed * (end - begin)
    return float(time)


def _watch(scene: Scene, scales: Any, observer: Observer, impact: Impact) -> Watch:
    """Return what shows instants of an impact to an observer in SI."""
    speed, mu = scene.normal_speed, scene.friction_coefficient
    unit = mu * speed / scene.pair.stiffness_ratio

    def watch(_phase: Phase, rows: Rows, length: float, _last: tuple[float, ...]) -> None:
        for part in (0.25, 0.5, 0.75, 1.0):
            u, rate, margin, lack = (value(row, part * length) for row in rows[:4])
            time = value(rows[-1], part * length)
            psi, force = impact.sign * (rate - margin), impact.sign * (u**3 - 1.5 * lack)
            contact = NormalContact(u**3 * scales.force, u * scales.radius, u * u * scales.approach)
            observer(
                Sample(
                    time * scales.approach / speed,
                    u * u * scales.approach,
                    rate * speed,
                    contact.complete,
                    psi * unit,
                    force * mu * scales.force,
                )
            )

    return watch
