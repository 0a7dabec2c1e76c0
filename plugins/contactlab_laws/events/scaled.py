"""One impact in the scaled units of theory §1, its path, and its motion in SI."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    LostPathError,
    NormalContact,
    Observer,
    PathTangentialLaw,
    Sample,
    ScaledContact,
    Stretch,
    TangentialMotion,
    faults,
)
from contactlab.contracts.path import LINEAR_BELOW
from contactlab.contracts.status import Status
from contactlab.numeric.types import Array, Real

#: Below this friction may stop no slip at all, however slow, and nothing is scaled.
LEAST_INERTIA = 1e-99
#: Friction work and loss of energy may differ by this part of the tangential energy, taken at
#: LEAST_AUDITED if psi1 is less: an event missed shows at 1e-2 and above.
BOOKS, LEAST_AUDITED = 1e-3, 0.1
#: Even phases shown; the events of a single impact are shown besides.
INSTANTS = 201
#: Stretches of no length in a row, and stretches of an impact.
STILL_CAP, STRETCH_CAP = 100, 20_000


class Solved(NamedTuple):
    """One impact solved; ``factor`` and its units lead from the scaled path to SI."""

    law: PathTangentialLaw
    normal: ClosedFormMotion
    stretches: Sequence[Stretch]
    reached: float
    factor: float
    velocity_unit: float
    force_unit: float
    motion: TangentialMotion


class _Followed(NamedTuple):
    """The followed part of a path; ``failure`` is empty on success."""

    stretches: Sequence[Stretch]
    reached: float = math.pi
    change: float = 0.0
    work: float = 0.0
    solves: int = 0
    failure: str = ""
    status: Status = Status.SUCCESS


def solve(law: PathTangentialLaw, normal: ClosedFormMotion, tolerance: float) -> Solved:
    """Return one impact solved; its motion is NaN where that failed.

    A law is odd, and may be linear for small velocities.
    """
    with faults.blaming(normal.law):
        scene: Any = normal.scene
        speed, kappa, friction = (
            scene.normal_speed,
            scene.pair.stiffness_ratio,
            scene.friction_coefficient,
        )
        force: Real = normal.maximum_force
        approach: Real = normal.maximum_approach
        unit, limit = friction * speed / kappa, friction * force
        velocity = abs(scene.slip_velocity) / unit if unit else 0.0
        inertia = kappa * (force / speed) * (approach / speed) / scene.pair.tangential_mass
    factor = math.copysign(1.0, scene.slip_velocity)
    if 0.0 < velocity < LINEAR_BELOW and inertia > LEAST_INERTIA:
        factor, velocity = factor * velocity / LINEAR_BELOW, LINEAR_BELOW
    if not (math.isfinite(velocity) and math.isfinite(inertia) and inertia > 0.0):
        failure = "psi1 or chi is not finite and positive."
        path = _Followed((), 0.0, math.nan, failure=failure, status=Status.NON_FINITE)
    elif velocity == 0.0 or limit == 0.0:  # nothing moves, or nothing resists
        path = _Followed(())
    else:
        path = _follow(law, normal, velocity, inertia, tolerance)
    # A tiny factor stands for a huge friction coefficient: each unit takes its own.
    units = factor * unit, factor * limit
    usable = math.nan if path.failure else 1.0
    with np.errstate(all="ignore"):
        done = units[0] * (approach / speed) * units[1] * path.work if path.work else 0.0
    motion = TangentialMotion(
        slip_velocity_change=usable * units[0] * path.change,
        friction_work=usable * done,
        status=path.status,
        detail=path.failure,
        counters={"panels": len(path.stretches), "solves": path.solves},
    )
    return Solved(law, normal, path.stretches, path.reached, factor, *units, motion)


def _follow(
    law: PathTangentialLaw,
    normal: ClosedFormMotion,
    velocity: float,
    inertia: float,
    tolerance: float,
) -> _Followed:
    """Return the path of a law, with a failure if its energy books do not balance."""
    stretches: list[Stretch] = []
    x = change = work = 0.0
    still, status, failure = 0, Status.UNRESOLVED, ""
    try:
        with np.errstate(all="ignore"):
            for stretch in law.path(velocity, inertia, normal, tolerance):
                if not math.isfinite(stretch.change + stretch.work + stretch.stop):
                    status, failure = Status.NON_FINITE, "velocity, work or x is not finite"
                    break
                still = 0 if stretch.stop > x else still + 1
                if still > STILL_CAP or len(stretches) >= STRETCH_CAP:
                    failure = "events follow one another without end"
                    break
                stretches.append(stretch)
                x, change, work = stretch.stop, stretch.change, stretch.work
    except LostPathError as error:
        failure = str(error)
    except Exception as error:
        status, failure = Status.LAW_RAISED, faults.tell_error(error)
    if not failure and x < math.pi:
        failure = "the path ends before contact does"
    missing = books_miss(velocity, inertia, change, work)
    if not failure and not missing <= BOOKS:
        failure = f"the energy books miss {missing:.1e} of the tangential energy"
    if failure:
        failure = faults.sentence(law, f"{failure}, at x = {x:.6g}", len(stretches) + 1)
    solves = stretches[-1].solves if stretches else 0
    return _Followed(
        stretches, x, change, work, solves, failure, status if failure else Status.SUCCESS
    )


def books_miss(velocity: float, inertia: float, change: float, work: float) -> float:
    """Return friction work less loss of energy, as a part of the tangential energy."""
    # Over the velocity, as its square may be too large for a number.
    scale = max(velocity, LEAST_AUDITED)
    lost = change * ((velocity + 0.5 * change) / scale)
    return abs(lost + inertia * (work / scale)) / (0.5 * scale)


def show(batch: tuple[int, ...], solved: Sequence[Solved], observer: Observer) -> None:
    """Call ``observer`` at phases common to all impacts, up to the first end among them."""
    x = np.linspace(0.0, math.pi, INSTANTS)
    if not batch:
        x = np.union1d(x, [stretch.stop for stretch in solved[0].stretches])
    x = x[x <= min(one.reached for one in solved)]
    table = np.stack([_history(one, x) for one in solved], axis=-1)
    columns = table.reshape(len(table), len(x), *batch) if batch else table[..., 0].tolist()
    for k, row in enumerate(zip(*columns, strict=True)):
        time, approach, rate, force, radius, velocity, friction = row
        observer(
            Sample(
                time=time,
                approach=approach,
                normal_velocity=rate,
                contact=NormalContact(force, radius, approach, force),
                slip_velocity=velocity,
                tangential_force=friction,
                fields=partial(_fields, batch, float(x[k]), solved),
            )
        )


def _history(one: Solved, x: Array) -> Array:
    """Return one impact's history at ascending x: rows of what a ``Sample`` holds, in SI."""
    time, approach, rate, contact, _ = one.normal.at(x)
    change, friction = np.zeros_like(x), np.zeros_like(x)
    normal = one.normal.scaled(x)
    with faults.blaming(one.law):
        for stretch in one.stretches:
            inside = (x >= stretch.start) & (x <= stretch.stop)
            if inside.any():
                part = ScaledContact(*(column[inside] for column in normal))
                change[inside], friction[inside] = stretch.states(part)
    velocity = one.normal.scene.slip_velocity + one.velocity_unit * change
    friction *= one.force_unit
    return np.array([time, approach, rate, contact.force, contact.radius, velocity, friction])


def _fields(batch: tuple[int, ...], x: float, solved: Sequence[Solved]) -> Mapping[str, Any]:
    """Return the law's fields at one phase ``x``."""
    answers = []
    for one in solved:
        stretch = next((each for each in one.stretches if x <= each.stop), None)
        if stretch is None:
            return {}
        at = one.normal.scaled_at(x)
        answers.append(stretch.fields(one.normal, at, one.factor))
    return {
        name: np.array([answer[name] for answer in answers]).reshape(batch + np.shape(first))
        for name, first in answers[0].items()
    }
