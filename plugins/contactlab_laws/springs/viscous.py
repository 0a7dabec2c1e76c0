"""Springs that share the loss of a viscous normal law: one relaxation time for both (theory §15).

Radius, force, approach and rate of any viscous contact tell b, j and A, of which ``kelvin_voigt``
makes a step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts import Increment, NormalContact, TangentialResponse
from contactlab.contracts.normal import NormalLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import flat, shape_as
from contactlab.numeric.types import Array, Real
from contactlab_laws.jaeger.bundle import spring_fields
from contactlab_laws.jaeger.partial_slip import Scales
from contactlab_laws.springs.directions import Direction, Line, Plane
from contactlab_laws.springs.doubling import crossing, place_springs
from contactlab_laws.springs.kelvin_voigt import (
    Contact,
    Memory,
    Motion,
    limit_springs,
    move_springs,
)
from contactlab_laws.springs.slip_velocity import Slip
from contactlab_laws.springs.turning import TINY, Some

#: Rates below this times that at first touch say nothing of A: the law is asked at this one.
SLOWEST = 1e-3
#: 1.5 in P = b³ + 1.5 j b, the force of springs of limit b² - r² + j (theory §15).
OF_EXCESS = 1.5
#: Part of the time for which a force acts that lies in the drift before it, and part of a drift
#: under the force of its end where no body is moved by the force.
HALF = 0.5


class State(NamedTuple):
    """The springs of a batch of contacts, with their numbers of scene and laws.

    Attributes
    ----------
    shape : tuple of int
        Shape of the batch.
    scales : Scales
        Units: floats, or arrays of shape (items,).
    radius : float or array
        Radius of the pair in m, as the scales.
    speed : float or array
        Rate at first touch in m/s.
    law, parts : NormalLaw, object
        The normal law and its state.
    shear_loss : float
    grows, splits : bool
        True for a grid that doubles where the contact outgrows it, and halves where it is small.
    memory : Memory
    direction : Direction
        One line, or the tangent plane.
    """

    shape: tuple[int, ...]
    scales: Scales
    radius: Real
    speed: Real
    law: NormalLaw
    parts: object
    shear_loss: float
    grows: bool
    splits: bool
    memory: Memory
    direction: Direction


def start(
    scene: Scene,
    law: NormalLaw,
    springs: int,
    radius: Real,
    *,
    shear_loss: float,
    spanned: float | None,
    grows: bool,
    vectors: bool,
) -> State:
    """Return contacts without traction, lengths in units of ``radius`` in m.

    ``spanned`` is the span of the springs in this unit; None for a grid that follows the contact.
    """
    shape = scene.shape
    items = math.prod(shape)
    none, one = np.zeros(items), np.zeros(1)
    rows = np.zeros((springs, items), dtype=complex if vectors else float)
    size = np.full(items if grows else 1, spanned or 0.0)
    memory = Memory(size, one, one, none, rows[0], rows[0], none, rows)
    scales = Scales.at(scene, radius)
    if shape:
        scales = Scales._make(flat(each, shape) for each in scales)
    return State(
        shape,
        scales,
        flat(scene.pair.radius, shape) if shape else scene.pair.radius,
        scene.normal_speed,
        law,
        law.start(scene),
        shear_loss,
        grows,
        spanned is None,
        memory,
        Plane(crossing(scene)) if vectors else Line(),
    )


def advance(
    state: State, increment: Increment, after: NormalContact
) -> tuple[TangentialResponse, State]:
    """Return force, friction work and loss in shear of the step, and the springs after it."""
    shape, scales, direction = state.shape, state.scales, state.direction
    sampled = increment.sampled

    def row(value: Real) -> Array:
        return flat(value, shape) if shape else np.atleast_1d(np.asarray(value, dtype=float))

    contact = read_contact(state, after, None if sampled is None else sampled[:2], row)
    friction = scales.force / scales.normal_force
    limit, acting = (
        friction * row(each) for each in (after.friction_load, increment.friction_load)
    )
    still = np.zeros(state.memory.share.shape)
    slip = Slip(still, still, still, acting)
    if sampled is not None:
        velocity, force = (direction.rows(each, row) for each in (sampled.slip, sampled.force))
        slip = Slip(velocity, force, row(sampled.mobility), acting)
    drift = row(increment.drift)
    motion = Motion(
        direction.rows(increment.displacement, row) * scales.displacement,
        drift,
        divide_drift(row(increment.duration), drift),
        limit,
        scales.displacement,
        slip,
    )
    acts, work, loss, memory = move_springs(
        state.memory, contact, motion, direction, grows=state.grows, splits=state.splits
    )
    worked, lost = (shape_as(each * scales.metres, shape) for each in (work, loss))
    response = TangentialResponse(direction.restore_shape(acts, shape), worked, True, lost)
    return response, state._replace(memory=memory)


def read_contact(
    state: State,
    contact: NormalContact,
    motion: tuple[Real, Real] | None,
    spread: Callable[[Real], Array],
) -> Contact:
    """Return the numbers of contacts for the springs, in the arrangement of ``spread``.

    ``motion`` is approach in m and its rate in m/s; None of a path that is slow.
    """
    scales = state.scales
    b, excess = measure_excess(
        spread(contact.radius) / scales.radius, spread(contact.friction_load) / scales.normal_force
    )
    if motion is None:
        return Contact(b * b, 0.0 * excess, 0.0 * excess)
    # the viscous force over the rate, asked while the surfaces approach: no tension cuts it there
    approach, rate = motion
    rate = np.maximum(np.abs(rate), SLOWEST * state.speed)
    asked, _ = state.law.respond(state.parts, approach, rate)
    _, push = measure_excess(
        spread(asked.radius) / scales.radius, spread(asked.force) / scales.normal_force
    )
    time = push * np.square(scales.radius) / (state.radius * spread(rate))
    return Contact(b * b, excess, state.shear_loss * time)


def measure_excess(b: Array, load: Array) -> tuple[Array, Array]:
    """Return b and j of a contact of radius b under a load, of which Hertz's is b³."""
    with np.errstate(invalid="ignore"):
        excess = np.where(b > 0.0, (load - b**3) / (OF_EXCESS * (b + TINY)), 0.0)
    # in unloading the surfaces have parted outside of the radius that carries the load
    return np.where(excess < 0.0, np.cbrt(load), b), np.maximum(excess, 0.0)


def divide_drift(duration: Array, drift: Array) -> Array:
    """Return the share of a drift under the force of its end, the rest being that of its begin.

    A drift goes from the middle of the time for which one force acts to the middle of the next.
    """
    half = HALF + 0.0 * (duration + drift)
    share: Array = np.divide(HALF * duration, drift, out=half, where=duration * drift > 0.0)
    return np.minimum(share, 1.0)


def fields(state: State) -> dict[str, Any]:
    """Return radius, displacement and limit (m), stuck and slipping, shape (*shape, springs).

    The displacement is that of an elastic spring under the same force; ``relax`` is w in m.
    """
    memory, scales, shape = state.memory, state.scales, state.shape
    springs, items = memory.deflection.shape
    places = place_springs(memory.size, springs)
    limit = limit_springs(places * places, memory.edge, memory.excess)
    force = state.direction.cut(memory.deflection + memory.lead, limit)

    def rows(each: Some) -> Some:
        return np.broadcast_to(each, (springs, items)).T.reshape(*shape, springs)

    radius, most = rows(places * scales.radius), rows(limit)
    deflection, traction = rows(memory.deflection), rows(force)
    metres = np.asarray(scales.metres).reshape(*shape, 1)
    acting = spring_fields(radius, traction, most, metres=metres)
    relaxed = spring_fields(radius, deflection, most, metres=metres)["displacement"]
    return {**acting, "relaxed": relaxed}
