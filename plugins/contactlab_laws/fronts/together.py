"""Impacts of the slip front in which friction changes the approach: scaling in, motion out."""

from __future__ import annotations

import math
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
from contactlab_laws.fronts.batch import follow
from contactlab_laws.fronts.path import Impact
from contactlab_laws.fronts.phases import Phase
from contactlab_laws.fronts.series import Rows, value
from contactlab_laws.fronts.steps import Watch, alone, error_of_step
from contactlab_laws.hertz.motion import scaled_motion, velocity_factor

#: The accuracy if none is asked for.
USUAL = 1e-9
#: Steps of an impact before it is given up; a hard one takes 30, one of kappa = 1e6 some 10,000.
MOST_STEPS = 20_000
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
    places = numbers.reshape(4, -1).T[moving].tolist()
    impacts = [Impact(*place, stepped=observer is not None) for place in places]
    if observer is None or not impacts:
        lost = follow(impacts, tolerance, MOST_STEPS)
    else:
        watch = _watch(scene, scales, observer, impacts[0])
        lost = [alone(impacts[0], tolerance, MOST_STEPS, watch)]
    times = _times(impacts)
    rows = np.full((smooth.size, 6), SMOOTH)
    statuses = np.full(len(rows), Status.SUCCESS, dtype=object)
    details = np.full(len(rows), "", dtype=object)
    for place, impact, time, reason in zip(moving.tolist(), impacts, times, lost, strict=True):
        if reason:
            rows[place], statuses[place] = math.nan, Status.UNRESOLVED
            details[place] = f"{reason}, from Fronts."
        else:
            moved = impact.rate, impact.change, impact.work
            rows[place] = *moved, time, impact.deepest, impact.compressions
    rate, psi, work, time, radius, times = rows.T.reshape(6, *shape)
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
        counters={"steps": sum(int(impact.steps) for impact in impacts)},
    )


def _times(impacts: list[Impact]) -> list[float]:
    """Return T at separation, with Hertz's in gross slip, where V² + ``press`` u⁵ is ``left``."""
    times = np.array([impact.time for impact in impacts])
    counts = [len(impact.slides) for impact in impacts]
    slides = np.array([slide for impact in impacts for slide in impact.slides])
    if slides.size:
        press, left, *ends = slides.T
        top, speed = (left / press) ** 0.2, np.sqrt(left)
        radius, rate = np.array(ends[::2]) / top, np.array(ends[1::2]) / speed
        phases = np.arctan2(radius, rate / velocity_factor(radius))
        begin, end = scaled_motion(phases)[2]
        owner = np.repeat(np.arange(len(impacts)), counts)
        np.add.at(times, owner, top * top / speed * (end - begin))
    known: list[float] = times.tolist()
    return known


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
