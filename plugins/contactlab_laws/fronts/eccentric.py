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
from contactlab.impact.hertz import hertz_scales
from contactlab_laws.fronts.planar import Impact, LostError, Watch

#: Error of a step over the accuracy asked for; and the accuracy if none is asked for.
STEP_PART, USUAL = 1e-2, 1e-9


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
    numbers = np.array([np.broadcast_to(column, shape) for column in columns]).reshape(4, -1)
    rows, statuses, details = [], [], []
    steps = 0
    for place, still in zip(numbers.T.tolist(), smooth.reshape(-1).tolist(), strict=True):
        watch = None if observer is None else _watch(scene, scales, observer)
        status, detail, answer = Status.SUCCESS, "", (math.nan,) * 6
        if still:
            answer = (-1.0, 0.0, 0.0, 2.9432751843, 1.0, 1)
        else:
            psi1, chi, lam, eta = place
            impact = Impact(psi1, chi, lam, eta, tolerance, watch)
            try:
                impact.follow()
                answer = (
                    impact.rate,
                    impact.change,
                    impact.work,
                    impact.time,
                    impact.deepest,
                    impact.compressions,
                )
            except (LostError, OverflowError, ZeroDivisionError) as error:
                status, detail = Status.UNRESOLVED, f"{error}, from Fronts."
            steps += impact.steps
        rows.append(answer)
        statuses.append(status)
        details.append(detail)
    rate, psi, work, time, radius, times = np.array(rows, dtype=float).T.reshape(6, *shape)
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
        status=np.array(statuses, dtype=object).reshape(shape) if shape else statuses[0],
        detail=np.array(details, dtype=object).reshape(shape) if shape else details[0],
        counters={"steps": steps},
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
