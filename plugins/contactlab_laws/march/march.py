"""The march that every scheme of even steps shares: drift, ask the law, kick."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from contactlab.contracts import (
    AllStepsResponse,
    AllStepsTangentialLaw,
    Increment,
    Law,
    NormalContact,
    NormalMotion,
    Observer,
    Sample,
    Sampled,
    SteppedTangentialLaw,
    Steps,
    TangentialMotion,
    faults,
    judges,
    shares_loss,
)
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import (
    finite,
    keep_freed_memory,
    lock_arrays,
    plain,
    spread,
    spread_object,
)
from contactlab.numeric.checks import quote
from contactlab.numeric.types import Array, Real
from contactlab_laws.march.division import one_by_one


def march(
    normal: NormalMotion, law: SteppedTangentialLaw, steps: Steps, observer: Observer | None
) -> TangentialMotion:
    """Return the tangential motion along ``steps``: all at once if the law can, else one by one."""
    if (complaint := _unsound(normal, steps)) is not None:
        return TangentialMotion.nothing(normal.scene.shape, *complaint)
    if normal.scene.shape:
        keep_freed_memory()
    stepwise = observer is not None and getattr(observer, "stepwise", True)
    if not stepwise and isinstance(law, AllStepsTangentialLaw):
        motion = _all_at_once(normal, law, steps, observer)
        if motion is not None:
            return motion
    return _one_by_one(normal, law, steps, observer)


def _all_at_once(
    normal: NormalMotion, law: AllStepsTangentialLaw, steps: Steps, observer: Observer | None
) -> TangentialMotion | None:
    """Return the tangential motion of a law that takes all steps in one call, or None."""
    scene = normal.scene
    try:
        with faults.blaming(law):
            response = law.advance_all(scene, normal, steps)
            if response is None:
                return None
            if (complaint := _complain_of_shape(response, scene, len(steps.kick))) is not None:
                raise faults.LawFaultError(Status.MALFORMED, faults.sentence(law, complaint, 1))
            force, count = response.force, len(response.force)
            kick = steps.kick[:count] / scene.pair.tangential_mass
            change = -np.einsum("k...,k...->...", force, kick)  # makes no table of products
    except faults.LawFaultError as raised:
        return TangentialMotion.nothing(scene.shape, raised.status, raised.detail)
    fault = None
    if response.settled is not True and not np.all(response.settled):
        detail = faults.sentence(law, "no division into stick and slip found", count + 1)
        fault = faults.LawFaultError(Status.UNSETTLED, detail)
    elif not finite(change):
        step = int((~np.isfinite(force)).reshape(count, -1).any(axis=1).argmax())
        detail = faults.sentence(law, f"force {_number(force[step])}", step + 1)
        fault = faults.LawFaultError(Status.NON_FINITE, detail)
    if observer is not None:
        if fault is not None:
            return None  # step by step the observer sees all instants up to the fault
        _show(normal, steps, force, observer)
    return _end(normal, law, change, response.friction_work, count, fault, response.shear_loss)


def _show(normal: NormalMotion, steps: Steps, force: Array, observer: Observer) -> None:
    """Show an observer the instants of a march from its forces."""
    scene = normal.scene
    slowed = force * (steps.kick / scene.pair.tangential_mass)
    middle = scene.slip_velocity - (np.cumsum(slowed, axis=0) - 0.5 * slowed)
    for step, velocity, acting in zip(
        one_by_one(steps),
        middle if scene.shape else middle.tolist(),
        force if scene.shape else force.tolist(),
        strict=True,
    ):
        moment = step.time, step.approach, step.rate
        observer(Sample(*moment, step.contact, velocity, acting, dict))


def _complain_of_shape(response: AllStepsResponse, scene: Scene, steps: int) -> str | None:
    """Return a sentence on an answer of wrong kind or shape, or None."""
    force, work, settled, shear = response
    if (
        not isinstance(force, np.ndarray)
        or not force.ndim
        or faults.is_malformed(force, force.shape)
    ):
        return f"the forces {quote(force)}"
    count = len(force)
    missing = count > steps or (count < steps and np.all(settled))
    if missing or force.shape[1:] != scene.shape:
        wanted = f"for {steps} steps of a scene of shape {scene.shape}"
        return f"forces of shape {force.shape} {wanted}"
    for name, energy in (("friction work", work), ("loss in shear", shear)):
        if faults.is_malformed(energy, scene.shape):
            return f"{name} {quote(energy)}"
    return None


def _one_by_one(
    normal: NormalMotion, law: SteppedTangentialLaw, steps: Steps, observer: Observer | None
) -> TangentialMotion:
    """Return the tangential motion, the law asked in every step."""
    # The change of velocity is summed apart from the velocity, which may be so large that it would
    # swallow the change (theory §8).
    scene = normal.scene
    shape, initial, mass = scene.shape, scene.slip_velocity, scene.pair.tangential_mass
    single = not shape
    change: Real = 0.0 if single else np.zeros(shape)
    work: Real = 0.0 if single else np.zeros(shape)
    zero = 0.0 * change
    shear: Real = zero
    slowed = zero
    force: Real = zero
    shares = shares_loss(law, normal.law)
    sampled: Sampled | None = None
    before = NormalContact(zero, zero, zero, zero)
    fault, count = None, 0
    velocity: Real = lock_arrays(initial)
    time: Real = 0.0
    try:
        state = law.start(scene, normal)
        for step in one_by_one(steps):
            time, contact = step.time, step.contact
            count += 1
            displacement = velocity * step.drift
            if not single:
                lock_arrays(velocity), lock_arrays(displacement)
            if shares:
                mobility = 0.5 * step.kick / mass
                slip = velocity - mobility * force
                sampled = Sampled(step.approach, step.rate, slip, force, mobility)
            increment = Increment(
                displacement, velocity, step.friction_load, step.kick, step.drift, sampled
            )
            response, state = law.advance(state, increment, before, contact)
            force, lost, settled, loss = response
            if not (
                single and settled is True and isinstance(force, float)
                and isinstance(lost, float) and isinstance(loss, float)
            ) and (words := judges.wrong_response(response, shape)):  # fmt: skip
                raise faults.LawFaultError(Status.MALFORMED, words)
            slowed = force * (step.kick / mass)
            change = change - slowed
            work = work + lost
            shear = shear + loss
            before = contact
            if observer is not None:
                middle, fields = velocity - 0.5 * slowed, partial(law.fields, state)
                moment = step.time, step.approach, step.rate, contact
                observer(Sample(*moment, middle, force, fields))
            velocity = initial + change
            if settled is not True and not np.all(settled):
                raise faults.LawFaultError(Status.UNSETTLED, "no division found")
            if not (math.isfinite(force) if single else np.isfinite(force).all()):
                raise faults.LawFaultError(Status.NON_FINITE, f"force {_number(force)}")
    except KeyboardInterrupt:
        raise
    except faults.LawFaultError as raised:
        sentence = faults.sentence(law, raised.detail, count, time)
        fault = faults.LawFaultError(raised.status, sentence)
    except BaseException as error:  # a plug-in may not end the process
        sentence = faults.sentence(law, faults.tell_error(error, law), count, time)
        fault = faults.LawFaultError(Status.LAW_RAISED, sentence)
    return _end(normal, law, change, work, count, fault, shear)


def _end(
    normal: NormalMotion,
    law: Law,
    change: Real,
    work: Real,
    count: int,
    fault: faults.LawFaultError | None,
    shear_loss: Real = 0.0,
) -> TangentialMotion:
    """Return the motion up to ``fault``; friction work that is not finite is a failure too."""
    if fault is None and not finite(work):
        detail = faults.sentence(law, f"friction work {_number(work)}", count)
        fault = faults.LawFaultError(Status.NON_FINITE, detail)
    shape = normal.scene.shape
    return TangentialMotion(
        slip_velocity_change=spread(change, shape),
        friction_work=spread(work, shape),
        shear_loss=spread(shear_loss, shape),
        status=spread_object(Status.SUCCESS if fault is None else fault.status, shape),
        detail="" if fault is None else fault.detail,
        counters={"steps": count},
    )


def _number(value: Real) -> str:
    """Return a number, or the numbers of a batch, for a sentence."""
    return quote(plain(value))


def _unsound(normal: NormalMotion, steps: Steps) -> tuple[Status, str] | None:
    """Return status and sentence of a normal motion that is not finite, or of a wrong sign."""
    # The tangential law cannot tell: where the load is infinite Coulomb's cap is no cap, and the
    # answer would look right.
    columns = (*steps.contact, *steps[1:4])
    contact = steps.contact
    with np.errstate(all="ignore"):
        if np.isfinite(sum(columns)).all():  # a sum is finite only if all its terms are
            if min(contact.radius.min(), contact.friction_load.min()) >= 0.0:
                return None
            largest = normal.maximum_radius, normal.maximum_force
            words = judges.below_zero(contact.radius, contact.friction_load, largest)
            return (Status.MALFORMED, faults.sentence(normal.law, words, 1)) if words else None
    for column in columns:
        if not np.isfinite(column).all():
            bad = ~np.isfinite(column).reshape(len(column), -1).all(axis=1)
            count: int = int(bad.argmax())
            told = faults.sentence(normal.law, _number(column[count]), count + 1, steps.time[count])
            return Status.NON_FINITE, told
    return None
