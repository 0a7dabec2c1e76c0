"""Springs on a doubling grid: partial slip without the largest contact in advance (theory §13).

N springs stand in the middle of equal cells of [0, A], where A is a power of two times the radius
of the pair. A contact that outgrows A merges neighbours to their mean and doubles A. A contact
below A/4 splits each cell into equal halves and halves A. So between N/4 and N springs carry the
contact, however large it is. The contact radius and the friction load of each instant suffice.

Merging keeps the force and loses energy, (w1 - w2)²/4 of each pair times the stiffness of one
spring; the loss counts as friction work. Splitting changes neither.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import Increment, NormalContact, TangentialResponse
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import flat
from contactlab.numeric.types import Array, Real
from contactlab_laws.jaeger.bundle import spring_fields
from contactlab_laws.springs.turning import Some, Vectors, energy, turn_springs

#: Contacts whose radius is below this times that of the pair just touch: no friction. The cells of
#: a smaller contact could underflow.
TOUCH = 1e-30
#: Span of a grid over the largest contact, where that is known in advance.
SPARE = 1.05


class Memory(NamedTuple):
    """The springs of a batch of contacts, the batch in one axis; never changed once made.

    Attributes
    ----------
    size : array, shape (items,)
        A in m; 0 out of contact.
    radius : array, shape (items,)
        b in m, the contact radius.
    deflection, limit : array, shape (springs, items)
        w and its limit l in m; springs lead, so that a row is contiguous over the batch. w is
        complex if it is a vector of the tangent plane.
    steepness : array, shape (items,)
        l over b² - s², s the place of the spring, in 1/m.
    """

    size: Array
    radius: Array
    deflection: Vectors
    limit: Array
    steepness: Array | float = 0.0


class State(NamedTuple):
    """Shape of a batch; radius of the pair, 2 G* and mu, shape (items,); the springs.

    A grid that ``spans`` a radius known before doubles, and is never split. ``cross`` is G* along
    the second axis over that along the first, None where both are equal.
    """

    shape: tuple[int, ...]
    unit: Array
    modulus: Array
    friction_coefficient: Array
    memory: Memory
    spans: bool
    cross: Array | None = None


def start(
    scene: Scene, springs: int, *, spanned: Real | None = None, vectors: bool = False
) -> State:
    """Return contacts without traction; springs span at least the radius ``spanned`` in m."""
    shape, pair = scene.shape, scene.pair
    items = math.prod(shape)
    none, rows = np.zeros(items), np.zeros((springs, items))
    deflection: Array = rows.astype(complex) if vectors else rows
    if spanned is not None:
        none = SPARE * flat(spanned, shape)
    return State(
        shape,
        flat(pair.radius, shape),
        flat(2.0 * pair.effective_shear_modulus, shape),
        flat(scene.friction_coefficient, shape),
        Memory(none, np.zeros(items), deflection, rows),
        spanned is not None,
        crossing(scene) if vectors else None,
    )


def crossing(scene: Scene) -> Array | None:
    """Return G* along t2 over that along t1, shape (items,); None of circular contacts."""
    ratio = scene.pair.cross_stiffness_ratio
    return None if np.all(np.equal(ratio, 1.0)) else flat(ratio, scene.shape)


def advance(
    state: State, increment: Increment, after: NormalContact
) -> tuple[TangentialResponse, State]:
    """Return force, a number or (..., 2), friction work after the step, and the springs."""
    shape, displacement = state.shape, np.asarray(increment.displacement)
    vectors = state.memory.deflection.dtype.kind == "c"
    if vectors:
        components = (flat(displacement[..., axis], shape) for axis in (0, 1))
        displacement = next(components) + 1j * next(components)
    limit = state.friction_coefficient * flat(after.friction_load, shape)
    force, work, memory = move_springs(
        state.memory,
        displacement if vectors else flat(displacement, shape),
        flat(after.radius, shape),
        limit,
        unit=state.unit,
        modulus=state.modulus,
        spans=state.spans,
        cross=state.cross,
    )
    state = state._replace(memory=memory)
    if vectors:
        both = np.stack((force.real, force.imag), axis=-1).reshape(*shape, 2)
        return TangentialResponse(both, work.reshape(shape) if shape else work.item()), state
    if not shape:
        return TangentialResponse(force.item(), work.item()), state
    return TangentialResponse(force.reshape(shape), work.reshape(shape)), state


def move_springs(
    before: Memory,
    displacement: Vectors,
    radius: Array,
    limit: Array,
    *,
    unit: Array,
    modulus: Array,
    spans: bool = False,
    cross: Array | None = None,
) -> tuple[Any, Array, Memory]:
    """Return force (N), friction work (J), both of shape (items,), and the springs after a step.

    Parameters
    ----------
    before : Memory
    displacement, radius : array, shape (items,)
        Displacement in the step, complex if a vector, and contact radius at its end, in m.
    limit : array, shape (items,)
        mu times the friction load at the end of the step, in N.
    unit : array, shape (items,)
        Length in m of which A is a power of two: the radius of the pair.
    modulus : array, shape (items,)
        2 G* in Pa: stiffness of the contact over its radius.
    spans : bool
        True if the grid is kept where the contact is small or apart.
    cross : array, shape (items,), optional
        G* along the second axis over that along the first, of an elliptic contact. w is then the
        force over the stiffness along the first.
    """
    radius = radius + 0.0 * (abs(displacement) + limit)  # NaN where any of the three is not finite
    radius = radius * (1.0 - (radius <= TOUCH * unit)) + 0.0 * radius
    size, held, merged = fit_grid(
        before.size, before.deflection, radius, unit, spans=spans, cross=cross
    )
    cell, places = size / len(held), place_springs(size, len(held))
    compression = np.maximum(radius * radius - places * places, 0.0)
    move = part_of_step(places, before.radius, radius) * displacement
    stiffness = modulus * cell  # stiffness of one spring, the same for all
    total = stiffness * compression.sum(axis=0)
    steepness = limit / (total + (total == 0.0))
    most = compression * steepness
    if held.dtype.kind == "c":
        least = np.maximum(before.radius * before.radius - places * places, 0.0)
        deflection, lost = turn_springs(held, move, before.steepness * least, most, cross)
    else:
        trial = held + move
        deflection = np.minimum(np.maximum(trial, -most), most)
        # The work of a spring is the mean of w before and after times its slip.
        trial -= deflection
        trial *= held + deflection
        lost = trial.sum(axis=0)
    force = stiffness * deflection.sum(axis=0)
    work = np.maximum(0.5 * stiffness * lost, 0.0) + modulus * merged
    if (apart := radius <= 0.0).any():  # NaN spreads
        touching = ~apart
        force = np.where(touching, force, 0.0)
        size = size if spans else np.where(touching, size, 0.0)
        deflection = np.where(touching, deflection, 0.0)
    return force, work, Memory(size, radius, deflection, most, steepness)


def fit_grid(
    size: Array,
    held: Vectors,
    radius: Array,
    unit: Real,
    *,
    spans: bool = False,
    cross: Array | None = None,
) -> tuple[Array, Vectors, Real]:
    """Return A and w with A/4 < b <= A, and the energy lost in merging over 2 G*, in m³."""
    if not size.all():
        size = np.where(size > 0.0, size, _least_size(radius, unit))
    outgrown, small = radius > size, (radius > 0.0) & (radius <= 0.25 * size) & (not spans)
    if not (outgrown.any() or small.any()):
        return size, held, 0.0
    size, held, lost = size.copy(), held.copy(), np.zeros_like(size)

    def part(where: NDArray[np.bool_]) -> Array | None:
        return None if cross is None else cross[where]

    while outgrown.any():
        inner, outer = held[::2, outgrown], held[1::2, outgrown]
        cell = size[outgrown] / len(held)
        lost[outgrown] += 0.25 * cell * energy(inner - outer, part(outgrown)).sum(axis=0)
        held[:, outgrown] = np.concatenate((0.5 * (inner + outer), 0.0 * inner))
        size[outgrown] *= 2.0
        outgrown = radius > size
    while small.any():
        outside = held[len(held) // 2 :, small]  # springs that have left the contact
        lost[small] += 0.5 * size[small] / len(held) * energy(outside, part(small)).sum(axis=0)
        held[:, small] = np.repeat(held[: len(held) // 2, small], 2, axis=0)
        size[small] *= 0.5
        small = (radius > 0.0) & (radius <= 0.25 * size)
    return size, held, lost


def place_springs(size: Array, springs: int) -> Array:
    """Return the places of springs in the middle of cells, shape (springs, items)."""
    places: Array = np.multiply.outer(np.arange(springs) + 0.5, size / springs)
    return places


def part_of_step(places: Array, before: Array, after: Array) -> Array | float:
    """Return the part of the step in which each spring moves with the surfaces."""
    # A spring that the growing contact meets moves from then on only.
    growth = after - before
    grows = growth > 0.0
    if not grows.any():
        return 1.0
    part = (after - places) / np.where(grows, growth, 1.0)
    np.minimum(np.maximum(part, 0.0, out=part), 1.0, out=part)
    return part if grows.all() else np.where(grows, part, 1.0)


def fields(state: State) -> dict[str, Any]:
    """Return radius, displacement and limit (m), stuck and slipping, shape (*shape, springs).

    On an ellipse the displacement of a vector is the force over the stiffness along t1.
    """
    size, _, deflection, limit, _ = state.memory
    springs = len(deflection)
    places = place_springs(size, springs)

    def rows(each: Some) -> Some:
        return each.T.reshape(*state.shape, springs)

    return spring_fields(rows(places), rows(deflection), rows(limit))


def _least_size(radius: Array, unit: Real) -> Array:
    """Return the least power of two times ``unit`` that is at least ``radius``."""
    fraction, exponent = np.frexp(radius / unit)
    least: Array = unit * np.ldexp(1.0, exponent - (fraction == 0.5))
    return least
