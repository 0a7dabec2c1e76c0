"""Springs whose displacement is a vector of the tangent plane, held as a complex number.

A spring that slips is dragged: the angle phi between it and the displacement falls as
d phi/dL = -sin(phi)/l along the displacement L, so tan(phi/2) falls as exp(-L/l) (theory §14).
Cutting the spring to the length of its limit instead is of first order in the step.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts import Increment, NormalContact, TangentialResponse
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import flat
from contactlab_laws.springs import doubling

#: Added to lengths that divide, so that none is zero.
TINY = 1e-300


class State(NamedTuple):
    """The springs in one direction, w complex; the limit over compression, shape (items,)."""

    springs: doubling.State
    steepness: Any


def start(scene: Scene, springs: int, *, spanned: Any) -> State:
    """Return contacts without traction."""
    state = doubling.start(scene, springs, spanned=spanned)
    memory = state.memory._replace(deflection=state.memory.deflection.astype(complex))
    return State(state._replace(memory=memory), 0.0 * state.unit)


def advance(
    state: State, increment: Increment, after: NormalContact
) -> tuple[TangentialResponse, State]:
    """Return force, shape (..., 2), and friction work after the step, and the springs."""
    own = state.springs
    shape, memory, mu = own.shape, own.memory, own.friction_coefficient
    vector = np.asarray(increment.displacement)
    moved = flat(vector[..., 0], shape) + 1j * flat(vector[..., 1], shape)
    radius, limit = flat(after.radius, shape), mu * flat(after.friction_load, shape)
    radius = radius + 0.0 * (np.abs(moved) + limit)  # NaN where any of the three is not finite
    radius = radius * (1.0 - (radius <= doubling.TOUCH * own.unit)) + 0.0 * radius
    size, held, merged = doubling.fitted(memory, radius, own.unit, spans=True)
    cell = size / len(held)
    places = np.multiply.outer(np.arange(len(held)) + 0.5, cell)
    squares = places * places
    compression = np.maximum(radius * radius - squares, 0.0)
    stiffness = own.modulus * cell
    total = stiffness * compression.sum(axis=0)
    steepness = limit / (total + (total == 0.0))
    most = steepness * compression
    least = state.steepness * np.maximum(memory.radius * memory.radius - squares, 0.0)
    move = doubling.part_of_step(places, memory.radius, radius) * moved
    trial = held + move
    deflection = np.where(np.abs(trial) <= most, trial, 0.0)
    slips = np.abs(trial) > most
    work = np.zeros_like(size)
    if slips.any():
        deflection, work = _dragged(held, move, least, most, slips, deflection)
        work = stiffness * work
    apart = radius <= 0.0
    if apart.any():
        deflection = np.where(apart, 0.0, deflection)
    force = stiffness * deflection.sum(axis=0)
    work = np.maximum(work, 0.0) + own.modulus * merged
    springs = own._replace(memory=doubling.Memory(size, radius, deflection, most))
    both = np.stack((force.real, force.imag), axis=-1).reshape(*shape, 2)
    lost = work.reshape(shape) if shape else work.item()
    return TangentialResponse(both, lost), State(springs, np.where(apart, 0.0, steepness))


def _dragged(
    held: Any, move: Any, least: Any, most: Any, slips: Any, deflection: Any
) -> tuple[Any, Any]:
    """Return w after the step, and the friction work of each contact over one spring's stiffness.

    The limit grows evenly from ``least`` to ``most``. A spring sticks until it is at its limit,
    and is then dragged along the rest of the step at the mean of the limit.
    """
    move = np.broadcast_to(move, held.shape)
    w, d, l0, l1 = held[slips], move[slips], least[slips], most[slips]
    # the share of the step at which abs(w + t d) = l0 + t (l1 - l0)
    growth = l1 - l0
    a = np.abs(d) ** 2 - growth * growth
    half = (w.conj() * d).real - l0 * growth
    c = np.minimum(np.abs(w) ** 2 - l0 * l0, 0.0)
    root = np.sqrt(np.maximum(half * half - a * c, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(half > 0.0, -c / (half + root), (root - half) / a)
    share = np.clip(np.nan_to_num(share, nan=0.0, posinf=0.0, neginf=0.0), 0.0, 1.0)
    first = w + share * d
    limit = l0 + share * growth
    ahead = d / (np.abs(d) + TINY)
    angle = first * ahead.conj()
    angle = angle / (np.abs(angle) + TINY)
    rest = (1.0 - share) * np.abs(d)
    fall = np.exp(-rest / (0.5 * (limit + l1) + TINY))
    aside = angle.imag  # beside a spring that is pushed back 1 + cos is lost in rounding
    half = np.where(
        angle.real < 0.0, aside * aside / np.maximum(1.0 - angle.real, 1.0), 1.0 + angle.real
    )
    turned = half + 1j * (aside * fall)
    turned = turned * turned
    size = np.abs(turned)
    turned = np.where(size > 0.0, turned / (size + TINY), np.where(np.abs(w) > 0.0, -1.0, 1.0))
    standing = np.abs(d) == 0.0  # only the limit shrinks: the spring keeps its direction
    new = l1 * np.where(standing, first / (np.abs(first) + TINY), ahead * turned)
    slip = w + d - new
    lost = np.zeros(held.shape)
    lost[slips] = 0.5 * (slip.conj() * (w + new)).real
    deflection[slips] = new
    return deflection, lost.sum(axis=0)
