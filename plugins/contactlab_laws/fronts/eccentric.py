"""Eccentric impacts of the slip front in SI: scaling in, motion out."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.contracts import (
    EccentricMotion,
    EccentricObserver,
    EccentricSample,
    EccentricScene,
    NormalContact,
    NormalMotion,
)
from contactlab.contracts.status import Status
from contactlab.impact.hertz import DURATION_CONSTANT, hertz_scales
from contactlab_laws.fronts.planar import Impact, Watch, follow

#: Error of a step over the accuracy asked for; and the accuracy if none is asked for.
STEP_PART, USUAL = 1e-2, 1e-9
#: V, psi's change, work, T, u and compressions of an impact without friction (theory §1).
SMOOTH = (-1.0, 0.0, 0.0, DURATION_CONSTANT, 1.0, 1.0)


def motion(
    scene: EccentricScene,
    normal: NormalMotion,
    accuracy: float | None,
    observer: EccentricObserver | None,
) -> EccentricMotion:
    """Return the motion of planar impacts."""
    shape, tolerance = scene.shape, STEP_PART * (accuracy or USUAL)
    scales = hertz_scales(normal.scene)
    W, mu = scene.inverse_mass, np.asarray(scene.friction_coefficient)
    speed, kappa = np.asarray(scene.normal_speed), np.asarray(scene.kappa)
    columns = (scene.psi1, scene.chi, scene.lam, scene.eta)
    # without friction nothing slips: psi is infinite, and V and the slip are closed forms
    smooth = np.broadcast_to(mu == 0.0, shape)
    numbers = np.array([np.broadcast_to(column, shape) for column in columns], dtype=float)
    watch = None if observer is None else _watch(scene, scales, observer)
    moving = np.flatnonzero(~smooth)
    places = numbers.reshape(4, -1).T[moving].tolist()
    impacts = [Impact(psi1, chi, lam, eta, watch) for psi1, chi, lam, eta in places]
    lost = follow(impacts, tolerance)
    rows = np.full((smooth.size, 6), SMOOTH)
    statuses = np.full(len(rows), Status.SUCCESS, dtype=object)
    details = np.full(len(rows), "", dtype=object)
    for place, impact, reason in zip(moving.tolist(), impacts, lost, strict=True):
        if reason:
            rows[place], statuses[place] = math.nan, Status.UNRESOLVED
            details[place] = f"{reason}, from Fronts."
        else:
            rows[place] = impact.outcome
    rate, psi, work, time, radius, times = rows.T.reshape(6, *shape)
    unit = mu * speed / kappa
    dragged = -2.0 * speed * W[..., 0, 1] / W[..., 0, 0]
    change = np.zeros((*shape, 3))
    change[..., 0] = (rate - 1.0) * speed
    change[..., 1] = np.where(smooth, dragged, psi * np.where(smooth, 0.0, unit))
    # over v1²/(2 W_nn): 2.5 rho work (theory §14)
    energy = 1.25 * mu * mu / kappa * speed * speed / W[..., 0, 0]
    approach = radius * radius
    number: Any = np.asarray if shape else float
    return EccentricMotion(
        velocity_change=change,
        friction_work=number(energy * work),
        normal_loss=number(0.0 * work),
        duration=number(time * scales.approach / speed),
        maximum_radius=number(radius * scales.radius),
        maximum_approach=number(approach * scales.approach),
        maximum_force=number(radius * approach * scales.force),
        compressions=np.nan_to_num(times).astype(int) if shape else int(np.nan_to_num(times)),
        status=statuses.reshape(shape) if shape else statuses[0],
        detail=details.reshape(shape) if shape else details[0],
        counters={"steps": sum(impact.steps for impact in impacts)},
    )


def _watch(scene: EccentricScene, scales: Any, observer: EccentricObserver) -> Watch:
    """Return what shows scaled instants to an observer in SI."""
    speed, mu = scene.normal_speed, scene.friction_coefficient
    unit = mu * speed / scene.kappa

    def watch(time: float, u: float, rate: float, psi: float, force: float) -> None:
        contact = NormalContact(u**3 * scales.force, u * scales.radius, u * u * scales.approach)
        observer(
            EccentricSample(
                time * scales.approach / speed,
                u * u * scales.approach,
                rate * speed,
                contact.complete,
                np.array([psi * unit, scene.slip_velocity[1]]),
                np.array([force * mu * scales.force, 0.0]),
            )
        )

    return watch
