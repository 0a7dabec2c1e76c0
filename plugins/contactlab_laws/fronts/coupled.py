"""Impacts of the slip front in which friction changes the approach, between SI and scaled units."""

from __future__ import annotations

import math

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
from contactlab.impact.hertz import DURATION_CONSTANT
from contactlab.numeric.arrays import choose, fill, some, spread_object
from contactlab.numeric.types import Array, Mask, Real
from contactlab.numeric.vectors import entry, join_components
from contactlab_laws.fronts import compiled
from contactlab_laws.fronts.compiled import MEMORY, MOST_STEPS
from contactlab_laws.fronts.path import Impact
from contactlab_laws.fronts.steps import Steps, error_of_step, follow_one

#: Parts of a step at which an instant is shown.
INSTANTS = np.array([0.25, 0.5, 0.75, 1.0])
#: Statuses of impacts and sentences on them, by the statuses of the solver.
ENDED = np.array([Status.SUCCESS, *[Status.UNRESOLVED] * (len(compiled.LOST) - 1)], dtype=object)
DETAILS = np.array(
    [words and f"{words.format(MOST_STEPS)}, from Fronts." for words in compiled.LOST], dtype=object
)
#: V, psi's change, work, T, u, compressions and steps of an impact without friction (theory §1).
SMOOTH = (-1.0, 0.0, 0.0, DURATION_CONSTANT, 1.0, 1.0, 0.0)


def motion(
    scene: Scene,
    normal: NormalMotion,
    accuracy: float,
    observer: Observer | None,
) -> TangentialMotion:
    """Return the motion of planar impacts."""
    shape, tolerance = scene.shape, error_of_step(accuracy)
    W = scene.inverse_mass
    assert W is not None
    mu: Real = scene.friction_coefficient
    speed: Real = scene.normal_speed
    kappa = scene.pair.stiffness_ratio
    smooth: Mask = mu == 0.0
    numbers = join_components((scene.psi1, scene.chi, scene.lam, scene.eta), shape).reshape(-1, 4).T
    if observer is None or some(smooth) or numbers.shape[1] != 1:
        found, lost = _follow_sides(numbers, smooth, tolerance)
    else:
        left, status, steps = follow_one(numbers[:, 0].tolist(), tolerance, MOST_STEPS)
        found, lost = np.array(left)[:, None], np.array([status])
        _show(scene, normal, steps, observer)
    ended, detail = spread_object(Status.SUCCESS, shape), spread_object("", shape)
    if np.count_nonzero(lost):  # takes less than any
        found[:6, lost != 0] = math.nan
        ended, detail = (each[lost].reshape(shape)[()] for each in (ENDED, DETAILS))
    rows = found.reshape(7, *shape) if shape else found[:, 0].tolist()
    rate, psi, work, time, radius, times, counted = rows
    pressed = entry(W, 0, 0)
    unit = mu * speed / kappa
    change = psi * unit
    if some(smooth):
        change = choose(smooth, -2.0 * speed * entry(W, 0, 1) / pressed, change)
    # over v1²/(2 W_nn): 2.5 rho work (theory §14)
    energy = 1.25 * mu * mu / kappa * speed * speed / pressed
    approach = radius * radius
    ends = (
        time * normal.maximum_approach / speed, rate * speed, radius * normal.maximum_radius,
        approach * normal.maximum_approach, radius * approach * normal.maximum_force, 0.0 * work,
        choose(times == times, times, 0.0),
    )  # fmt: skip
    entries = {
        "status": ended,
        "detail": detail,
        "counters": {"steps": int(counted.sum() if shape else counted)},
        "slip_velocity_change": change,
        "friction_work": energy * work,
        "shear_loss": 0.0,
        "normal_spin_change": 0.0,
        "normal": Ends(*ends),
        "contacts": None,
    }
    return fill(TangentialMotion, entries)


def _follow_sides(numbers: Array, smooth: Mask, tolerance: float) -> tuple[Array, NDArray[np.intc]]:
    """Return ends and statuses of impacts; ``smooth`` marks impacts without friction."""
    if not some(smooth):
        return solve_impacts(numbers, tolerance)
    # nothing slips: psi is infinite, and V and the slip are closed forms
    moving = np.flatnonzero(np.broadcast_to(~np.ravel(smooth), numbers.shape[1]))
    found = np.repeat(np.array(SMOOTH)[:, None], numbers.shape[1], axis=1)
    lost = np.zeros(numbers.shape[1], dtype=np.intc)
    found[:, moving], lost[moving] = solve_impacts(numbers[:, moving], tolerance)
    return found, lost


def solve_impacts(numbers: Array, tolerance: float) -> tuple[Array, NDArray[np.intc]]:
    """Return ends and statuses of impacts, as ``compiled.follow`` does."""
    out, status = compiled.follow(numbers, tolerance)
    if not np.count_nonzero(status):
        return out, status
    for place in np.flatnonzero(status == MEMORY).tolist():
        impact = Impact(*numbers[:, place].tolist(), tolerance=tolerance, most=MOST_STEPS)
        status[place] = impact.follow()
        out[:, place] = impact.ends()
    return out, status


def _show(scene: Scene, normal: NormalMotion, steps: Steps, observer: Observer) -> None:
    """Show four instants of each step to an observer in SI."""
    speed, mu = scene.normal_speed, scene.friction_coefficient
    unit: Real = mu * speed / scene.pair.stiffness_ratio
    u, rate, margin, lack, _, time = steps.at(np.multiply.outer(steps.length, INSTANTS))
    sign = steps.sign[:, None]
    columns = (
        time * normal.maximum_approach / speed, u * u * normal.maximum_approach, rate * speed,
        u**3 * normal.maximum_force, u * normal.maximum_radius, sign * (rate - margin) * unit,
        sign * (u**3 - 1.5 * lack) * mu * normal.maximum_force,
    )  # fmt: skip
    for time, approach, rate, force, radius, velocity, friction in zip(
        *(column.ravel().tolist() for column in columns), strict=True
    ):
        contact = NormalContact(force, radius, approach)
        observer(Sample(time, approach, rate, contact.complete, velocity, friction))
