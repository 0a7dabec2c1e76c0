"""The march that every scheme of even steps shares: drift, ask the law, kick."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab import faults
from contactlab.batch import filled, locked, spread
from contactlab.checks import Real
from contactlab.contracts import (
    AllStepsResponse,
    AllStepsTangentialLaw,
    Increment,
    Law,
    NormalContact,
    NormalMotion,
    Observer,
    Sample,
    SteppedTangentialLaw,
    Steps,
    TangentialMotion,
)
from contactlab.scene import Scene
from contactlab.status import Status
from contactlab_march.division import one_by_one


def march(
    normal: NormalMotion,
    law: SteppedTangentialLaw,
    scene: Scene,
    steps: Steps,
    observer: Observer | None,
) -> TangentialMotion:
    """Return the tangential motion along ``steps``: all at once if the law can, else one by one.

    Parameters
    ----------
    normal : NormalMotion
    law : SteppedTangentialLaw
    scene : Scene
    steps : Steps
    observer : callable or None
    """
    if (complaint := _unsound(normal, steps)) is not None:
        return _ended(scene, law, math.nan, math.nan, Status.NON_FINITE, complaint, 0)
    if observer is None and isinstance(law, AllStepsTangentialLaw):
        motion = _all_at_once(normal, law, scene, steps)
        if motion is not None:
            return motion
    return _one_by_one(normal, law, scene, steps, observer)


def _all_at_once(
    normal: NormalMotion, law: AllStepsTangentialLaw, scene: Scene, steps: Steps
) -> TangentialMotion | None:
    """Return the tangential motion from a law that takes all steps in one call, if it does.

    Parameters
    ----------
    normal : NormalMotion
    law : AllStepsTangentialLaw
    scene : Scene
    steps : Steps
    """
    try:
        with faults.blaming(law):
            response = law.advance_all(scene, normal, steps)
            if response is None:
                return None
            if (complaint := _malformed(response, scene, len(steps.kick))) is not None:
                raise faults.LawFaultError(Status.MALFORMED, faults.sentence(law, complaint, 1))
            force, count = response.force, len(response.force)
            kick = steps.kick[:count] / scene.pair.tangential_mass
            change = -np.einsum("k...,k...->...", force, kick)  # makes no table of products
    except faults.LawFaultError as fault:
        return _ended(scene, law, math.nan, math.nan, fault.status, fault.detail, 0)
    status, detail = Status.SUCCESS, ""
    if response.settled is not True and not np.all(response.settled):
        status, detail = Status.UNSETTLED, faults.sentence(law, "no division found", count + 1)
    elif not np.isfinite(change).all():
        step = int((~np.isfinite(force)).reshape(count, -1).any(axis=1).argmax())
        detail = faults.sentence(law, f"force {faults.shown(force[step])}", step + 1)
        status = Status.NON_FINITE
    return _ended(scene, law, change, response.friction_work, status, detail, count)


def _malformed(response: AllStepsResponse, scene: Scene, steps: int) -> str | None:
    """Return what is wrong with an answer to all steps: its kind, or its shape."""
    force, work, settled = response
    if not isinstance(force, np.ndarray) or not force.ndim or faults.malformed(force, force.shape):
        return f"the forces {faults.shown(force)}"
    count = len(force)
    missing = count > steps or (count < steps and np.all(settled))
    if missing or force.shape[1:] != scene.shape:
        given = f"for {steps} steps of a scene of shape {scene.shape}"
        return f"forces of shape {force.shape} {given}"
    return f"friction work {faults.shown(work)}" if faults.malformed(work, scene.shape) else None


def _one_by_one(
    normal: NormalMotion,
    law: SteppedTangentialLaw,
    scene: Scene,
    steps: Steps,
    observer: Observer | None,
) -> TangentialMotion:
    """Return the tangential motion, the law asked in every step.

    The change of velocity is summed apart from the velocity, which may be so large
    that it would swallow the change (theory §8).

    Parameters
    ----------
    normal : NormalMotion
    law : SteppedTangentialLaw
    scene : Scene
    steps : Steps
    observer : callable or None
    """
    single, initial, mass = not scene.shape, scene.slip_velocity, scene.pair.tangential_mass
    shape = scene.shape
    change: Real = 0.0 if single else np.zeros(scene.shape)
    work: Real = 0.0 if single else np.zeros(scene.shape)
    nothing = 0.0 * change
    before = NormalContact(nothing, nothing, nothing, nothing)
    status, what, count = Status.SUCCESS, "", 0
    velocity: Real = locked(initial)
    time: Real = 0.0
    try:
        state = law.start(scene, normal)
        for step in one_by_one(steps):
            time, contact = step.time, step.contact
            count += 1
            displacement = velocity * step.drift
            if not single:
                locked(velocity), locked(displacement)
            increment = Increment(displacement, velocity, step.friction_load, step.kick)
            response, state = law.advance(state, increment, before, contact)
            force, lost = response.force, response.friction_work
            if not (single and isinstance(force, float) and isinstance(lost, float)):
                status, what = _checked(shape, force, lost)
                if status is not Status.SUCCESS:
                    break
            slowed = force * (step.kick / mass)
            change = change - slowed
            work = work + lost
            before = contact
            if observer is not None:
                observer(_sample(step, velocity - 0.5 * slowed, force, law, state))
            velocity = initial + change
            if response.settled is not True and not np.all(response.settled):
                status, what = Status.UNSETTLED, "no division found"
            elif not (math.isfinite(force) if single else np.isfinite(force).all()):
                status, what = Status.NON_FINITE, f"force {faults.shown(force)}"
            if status is not Status.SUCCESS:
                break
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a plug-in may not end the process
        status, what = Status.LAW_RAISED, faults.raised(error)
    if status is Status.SUCCESS:
        return _ended(scene, law, change, work, status, "", count)
    return _ended(scene, law, change, work, status, faults.sentence(law, what, count, time), count)


def _checked(shape: tuple[int, ...], *answers: Real) -> tuple[Status, str]:
    """Return what is wrong with a law's answers if they are not real numbers of the right shape."""
    for answer in answers:
        if faults.malformed(answer, shape):
            return Status.MALFORMED, f"the answer {faults.shown(answer)}"
    return Status.SUCCESS, ""


def _ended(
    scene: Scene, law: Law, change: Real, work: Real, status: Status, detail: str, count: int
) -> TangentialMotion:
    """Return the motion as it ended; friction work that is not finite is a failure too.

    Parameters
    ----------
    scene : Scene
    law : Law
        Whose failure it is.
    change, work : float or array
        Change of slip velocity (m/s) and friction work (J).
    status, detail : Status, str
    count : int
        Steps taken.
    """
    if status is Status.SUCCESS and not np.all(np.isfinite(work)):
        status = Status.NON_FINITE
        detail = faults.sentence(law, f"friction work {faults.shown(work)}", count)
    return TangentialMotion(
        slip_velocity_change=spread(change, scene.shape),
        friction_work=spread(work, scene.shape),
        status=filled(status, scene.shape),
        detail=detail,
        counters={"steps": count},
    )


def _unsound(normal: NormalMotion, steps: Steps) -> str | None:
    """Return what is wrong with a normal motion that is not finite: then no march is begun.

    Not left to the tangential law: where the load is infinite Coulomb's cap is no cap, and
    the answer would look right.
    """
    for column in (*steps.contact, *steps[1:4]):
        if not np.isfinite(column).all():
            bad = ~np.isfinite(column).reshape(len(column), -1).all(axis=1)
            count: int = int(bad.argmax())
            what: Any = faults.shown(column[count])
            return faults.sentence(normal.law, what, count + 1, steps.time[count])
    return None


def _sample(
    step: Steps, velocity: Real, force: Real, law: SteppedTangentialLaw, state: object
) -> Sample:
    """Return what an observer sees of a step.

    Parameters
    ----------
    step : Steps
        One of them.
    velocity, force : float or array
        Slip velocity (m/s) and tangential force (N) at the sample.
    law : SteppedTangentialLaw
    state : object
        The law's, at the end of the step.
    """
    return Sample(
        time=step.time,
        approach=step.approach,
        normal_velocity=step.rate,
        contact=step.contact,
        slip_velocity=velocity,
        tangential_force=force,
        fields=lambda: law.fields(state),
    )
