"""All steps of viscous springs at once, of impacts whose contacts differ in scale only (§15)."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np

from contactlab.contracts import AllStepsResponse, NormalMotion, Steps
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real
from contactlab_laws.jaeger.step import ROUNDING
from contactlab_laws.springs import compiled, kelvin_voigt, viscous
from contactlab_laws.springs.directions import Line, relax_limit
from contactlab_laws.springs.slip_velocity import Slip, share_of_edge, solve_slip
from contactlab_laws.springs.turning import TINY, Vectors

#: Rounding errors up to which impacts of a batch count as alike: their contacts come of a table.
ALIKE = 1e3
#: Most springs times steps, or impacts times steps, of a run; longer ones go step by step.
LARGEST_RUN = 4_000_000


class _Grid(NamedTuple):
    """The springs of every step, arrays (K, springs) unless said otherwise.

    Attributes
    ----------
    touching : list of int
        Innermost springs that touch at the end of a step, or did at its begin.
    entered : list of int
        The first of them that entered in the step.
    gone, span : array
        Share of w that relaxes, and limit of its change.
    most : array
        Limit at the end of the step.
    part : array
        Part of the step for which a spring moves.
    per_total : array, shape (K,)
        One over the sum of the limits, 0 without springs.
    excess : array, shape (K,)
    """

    touching: list[int]
    entered: list[int]
    gone: Array
    span: Array
    most: Array
    part: Array
    per_total: Array
    excess: Array


def advance_all(
    state: viscous.State, scene: Scene, normal: NormalMotion, steps: Steps
) -> AllStepsResponse | None:
    """Return the forces of all steps; None where impacts differ, or there are too many."""
    shape, count, springs = scene.shape, len(steps.kick), len(state.memory.deflection)
    items = math.prod(shape)
    if count * max(items, springs) > LARGEST_RUN:
        return None
    if items > 1 and not normal.alike:
        return None
    wide = (count, items)

    def rows(column: Real) -> Array:
        table: Array = np.asarray(column)
        if table.size == count:
            return table.reshape(count, 1)
        return np.broadcast_to(table, (count, *shape)).reshape(wide)

    contact = viscous.read_contact(state, steps.contact, (steps.approach, steps.rate), rows)
    drift, kick, acting = (rows(each) for each in (steps.drift, steps.kick, steps.friction_load))
    time = contact.time
    earlier = np.concatenate((0.0 * time[:1], time[:-1]))
    decay = drift / np.maximum(kelvin_voigt.average_times(earlier, time), TINY)
    columns = contact.edge, contact.excess, decay
    if not all(map(_alike, columns)):
        return None
    told = columns[0][:, 0], columns[1][:, 0], time[:, 0]
    if (found := compiled.advance_all(springs, scene, state.scales, steps, told)) is not None:
        return found
    grid = _grid(springs, *(each[:, 0] for each in columns))
    if grid is None:
        return None
    return _march(state, scene, grid, steps, (drift, kick, acting, time, rows), items)


def _alike(rows: Array) -> bool:
    """Return whether all impacts agree, to rounding, in each row."""
    first = rows[:, :1]
    near = np.abs(rows - first) <= ALIKE * ROUNDING * np.abs(rows).max()
    return rows.shape[1] == 1 or bool(near.all())


def _grid(springs: int, edge: Array, excess: Array, decay: Array) -> _Grid | None:
    """Return the springs of every step; None if springs leave and come again."""
    squares = np.square((np.arange(springs) + kelvin_voigt.MIDDLE) / springs)
    edges, excesses = edge[:, None], excess[:, None]
    most = kelvin_voigt.limit_springs(squares, edges, excesses)
    least = np.concatenate((np.zeros((1, springs)), most[:-1]))
    touching = (most > 0.0).sum(axis=1)
    top = int(touching.argmax())
    if (np.diff(touching[: top + 1]) < 0).any() or (np.diff(touching[top:]) > 0).any():
        return None
    born = np.concatenate(([[0.0]], edges[:-1])), np.concatenate(([[0.0]], excesses[:-1]))
    part, first = kelvin_voigt.enter_springs(squares, least, born, edges, excesses)
    gone, span = relax_limit(first, most, part * decay[:, None])
    total = most.sum(axis=1)
    earlier = np.concatenate(([0], touching[:-1]))
    return _Grid(
        np.maximum(touching, earlier).tolist(),
        np.where(touching > earlier, earlier, np.maximum(touching, earlier)).tolist(),
        gone,
        span,
        most,
        part,
        np.divide(1.0, total, out=np.zeros_like(total), where=total > 0.0),
        excess,
    )


#: Drift, kick, friction load and relaxation time of all steps, and what makes such rows.
Columns: TypeAlias = tuple[Array, Array, Array, Array, Callable[[Real], Array]]


def _march(
    state: viscous.State,
    scene: Scene,
    grid: _Grid,
    steps: Steps,
    columns: Columns,
    items: int,
) -> AllStepsResponse:
    """Return the forces of all steps, a few passes over the springs for each."""
    drift, kick, acting, time, rows = columns
    scales, shape = state.scales, scene.shape
    friction = np.reshape(scales.force / scales.normal_force, (1, -1))
    scale = np.reshape(scales.displacement, (1, -1))
    mass = np.reshape(np.asarray(scene.pair.tangential_mass, dtype=float), (1, -1))
    velocity = np.broadcast_to(np.asarray(scene.slip_velocity, dtype=float), shape).reshape(-1)
    acting, limit = friction * acting, friction * rows(steps.contact.friction_load)
    acted = viscous.divide_drift(kick, drift)
    mobility, drift, lead = 0.5 * kick / mass, drift * scale, time * scale
    springs = len(state.memory.deflection)
    w, moved, traction, before = np.zeros((4, springs, items))
    last_share: Vectors
    force, earlier, last_share = np.zeros((3, items))
    change, gained, work = np.zeros((3, items))
    weight, ones, last = np.zeros(1), np.ones(springs), 0
    forces = np.empty((len(kick), items))
    for k, (now, entered) in enumerate(zip(grid.touching, grid.entered, strict=True)):
        held, step, f = w[:now], moved[:now], traction[:now]
        slip = velocity + change
        move = slip * drift[k]
        relaxed = np.multiply(held, grid.gone[k, :now, None], out=f)
        np.add(relaxed, move, out=step)
        if entered < now:
            np.multiply(grid.part[k, entered:now, None], move, out=step[entered:])
        span = grid.span[k, :now, None]
        np.minimum(step, span, out=step)
        np.maximum(step, -span, out=step)
        step -= relaxed
        held += step
        if entered < now:  # as if they had moved all the time: the force is the mean of the step
            step[entered:] /= grid.part[k, entered:now, None]
        both = min(last, now)  # the others had no traction
        energy = np.einsum("ij,ij->j", before[:both], step[:both])
        energy *= (1.0 - acted[k]) * weight
        slip = slip - mobility[k] * force
        most, found = grid.most[k, :now, None], Slip(slip, force, mobility[k], acting[k])
        share, _, _ = solve_slip(held, most, lead[k], found, grid.per_total[k], Line(), out=f)
        if grid.per_total[k] == 0.0:
            share = share_of_edge(lead[k] * slip, grid.excess[k], last_share)
        last_share = share
        weight = limit[k] * grid.per_total[k]
        total = np.einsum("ij,ij->j", f, step)
        energy += acted[k] * weight * total
        passed = (1.0 - acted[k]) * earlier
        earlier = weight * ones[:now].dot(f)
        gained += energy
        work += np.maximum((passed + acted[k] * earlier) * move - energy, 0.0)
        force = acting[k] * share
        forces[k] = force
        change = change - 2.0 * mobility[k] * force
        traction, before, last = before, traction, now
    metres = np.reshape(scales.metres, -1)
    work, gained = work * metres, gained * metres
    if not shape:
        return AllStepsResponse(forces[:, 0], work.item(), True, gained.item())
    spread = (len(kick), *shape)
    return AllStepsResponse(
        forces.reshape(spread), work.reshape(shape), True, gained.reshape(shape)
    )
