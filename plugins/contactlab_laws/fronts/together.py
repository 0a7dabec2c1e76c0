"""Impacts of the slip front in which friction changes the approach: scaling in, motion out."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
from contactlab_laws.fronts.compiled import MEMORY, MOST_STEPS
from contactlab_laws.fronts.path import Impact
from contactlab_laws.fronts.steps import Steps, error_of_step, kept

#: The accuracy if none is asked for.
USUAL = 1e-9
#: Parts of a step at which an instant is shown.
INSTANTS = np.array([0.25, 0.5, 0.75, 1.0])
#: Sentences on impacts without an answer, by status.
LOST = tuple(words.format(MOST_STEPS) for words in compiled.LOST)
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
    sought = numbers.reshape(4, -1)[:, moving]
    if observer is None or moving.size != 1:
        found, lost = solved(sought, tolerance)
    else:
        left, status, steps = kept(sought[:, 0].tolist(), tolerance, MOST_STEPS)
        found, lost = np.array(left)[:, None], np.array([status])
        _show(scene, scales, steps, observer)
    rows = np.repeat(np.array(SMOOTH)[:, None], smooth.size, axis=1)
    rows[:, moving] = found[:6]
    statuses = np.full(smooth.size, Status.SUCCESS, dtype=object)
    details = np.full(smooth.size, "", dtype=object)
    for place in np.flatnonzero(lost).tolist():
        rows[:, moving[place]] = math.nan
        statuses[moving[place]] = Status.UNRESOLVED
        details[moving[place]] = f"{LOST[lost[place]]}, from Fronts."
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


def solved(numbers: Array, tolerance: float) -> tuple[Array, NDArray[np.intc]]:
    """Return what impacts leave and their statuses, as ``compiled.follow`` does."""
    count = numbers.shape[1]
    out, status = np.empty((7, count)), np.full(count, MEMORY, dtype=np.intc)
    if compiled.library() is not None:
        out, status = compiled.follow(numbers, tolerance)
    for place in np.flatnonzero(status == MEMORY).tolist():
        impact = Impact(*numbers[:, place].tolist(), tolerance=tolerance, most=MOST_STEPS)
        status[place] = impact.follow()
        out[:, place] = impact.ends()
    return out, status


def _show(scene: Scene, scales: Any, steps: Steps, observer: Observer) -> None:
    """Show four instants of each step to an observer in SI."""
    speed, mu = scene.normal_speed, scene.friction_coefficient
    unit: Any = mu * speed / scene.pair.stiffness_ratio
    powers = np.multiply.outer(steps.length, INSTANTS)[..., None] ** np.arange(
        steps.series.shape[-1]
    )
    values = np.einsum("smn,sin->ism", powers, steps.series)
    u, rate, margin, lack, _, time = values
    sign = steps.sign[:, None]
    columns = (
        time * scales.approach / speed, u * u * scales.approach, rate * speed, u**3 * scales.force,
        u * scales.radius, sign * (rate - margin) * unit,
        sign * (u**3 - 1.5 * lack) * mu * scales.force,
    )  # fmt: skip
    for time, approach, rate, force, radius, velocity, friction in zip(
        *(column.ravel().tolist() for column in columns), strict=True
    ):
        contact = NormalContact(force, radius, approach)
        observer(Sample(time, approach, rate, contact.complete, velocity, friction))
