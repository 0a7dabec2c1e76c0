"""Normal motions of laws without a closed form, kept as tables, and of laws that failed."""

from __future__ import annotations

import math
from typing import Any, Self

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion, NormalSample
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import Real
from contactlab.numeric.lobatto import lobatto, rows

Array = NDArray[np.float64]

#: Relative error of the load impulse that is declared: what steps of the solver's tolerance, see
#: ``contactlab.compose.normal_motion``, add up to.
ACCURACY = 1e-7
#: Nodes in a step: polynomials of degree 7 hold the dense output of the solver exactly.
NODES = 8
#: Points between nodes at which maxima are looked for.
FINE = 129
#: A cubic rises throughout if its slopes are at most this times the mean one.
STEEPEST = 3.0
#: Columns of the table; the radius is squared, which is smooth where the radius begins as a root.
APPROACH, RATE, FORCE, RADIUS_SQUARED, LOAD, LOAD_IMPULSE = range(6)


@attrs.frozen(kw_only=True, eq=False, repr=False)
class MotionTable:
    """A solved motion as polynomials between the ends of steps.

    Attributes
    ----------
    shape : tuple of int
        Of the items; () where one motion serves a whole batch.
    edges : array, shape (items, S + 1)
        Ends of the steps, in units of ``unit``. Each item has its own; the steps that it takes
        less than another have no width, and stand at separation.
    unit : array, shape (items,)
        Of time, in s.
    values : array, shape (items, S, NODES, 6)
        Approach, rate, force, radius², friction load and its impulse, in SI.
    last, largest : array, shape (items, 6)
        The same at separation, and the largest value of each.
    status, detail : array of object, shape (items,)
    """

    shape: tuple[int, ...]
    edges: Array
    unit: Array
    values: Array
    last: Array
    largest: Array
    status: Any
    detail: Any

    @classmethod
    def made(cls, **entries: Any) -> Self:
        """Return the table of all entries but ``last`` and ``largest``, which follow from them."""
        table = cls(**entries, last=np.empty(0), largest=_largest(entries["values"]))
        return attrs.evolve(table, last=table.at(table.ends))

    @property
    def ends(self) -> Array:
        """Time of separation, shape (items,), in units of ``unit``."""
        return np.asarray(self.edges[:, -1])

    def at(self, times: Array) -> Array:
        """Return the six columns at scaled ``times``, shape (..., items); shape (..., items, 6).

        The load impulse never falls: between nodes it is a cubic whose slopes are the loads, less
        where it would turn back.
        """
        item = np.arange(len(self.unit))
        index = self._step(times)
        left = self.edges[item, index]
        width = self.edges[item, index + 1] - left
        fraction = np.clip((times - left) / np.where(width > 0.0, width, 1.0), 0.0, 1.0)
        steps = self.values[item, index]
        found = np.einsum("...n,...nc->...c", rows(lobatto(NODES), fraction), steps)
        found[..., LOAD_IMPULSE] = _rising(fraction, width * self.unit, steps)
        return np.asarray(found)

    def _step(self, times: Array) -> NDArray[np.intp]:
        """Return the step that holds each of ``times``: one search over the edges of all items."""
        count = self.edges.shape[1]
        span = np.where(self.ends > 0.0, self.ends, 1.0)
        item = np.arange(len(span))
        # Shares of the duration, those of each item apart from those of the others.
        listed = (self.edges / span[:, None] + 2.0 * item[:, None]).reshape(-1)
        found = listed.searchsorted(times / span + 2.0 * item) - count * item
        return np.asarray(np.clip(found - 1, 0, count - 2))

    def take(self, index: NDArray[np.intp]) -> MotionTable:
        """Return the table of the items that ``index`` counts, which has the shape of ``index``."""
        columns = ("edges", "unit", "values", "last", "largest", "status", "detail")
        taken = {name: getattr(self, name)[np.ravel(index)] for name in columns}
        return attrs.evolve(self, shape=np.shape(index), **taken)

    def shaped(self, values: Array) -> Any:
        """Return values, one an item, in the shape of the items; one alone as a plain number."""
        return values.reshape(self.shape) if self.shape else values.item()


def _rising(fraction: Array, width: Array, steps: Array) -> Array:
    """Return the load impulse at a fraction of a step, by a cubic that never falls.

    Parameters
    ----------
    fraction : array, shape (...)
        Of the steps.
    width : array, shape (...)
        Of the steps, in s.
    steps : array, shape (..., NODES, 6)
        Values at the nodes of the steps.
    """
    points = lobatto(NODES).points
    node = np.clip(points.searchsorted(fraction) - 1, 0, NODES - 2)
    part = points[node + 1] - points[node]
    share = np.clip((fraction - points[node]) / part, 0.0, 1.0)
    begin, end = (
        np.take_along_axis(steps[..., LOAD:], which[..., None, None], axis=-2)[..., 0, :]
        for which in (node, node + 1)
    )
    start, gained = begin[..., 1], end[..., 1] - begin[..., 1]
    first, last = (
        np.clip(each[..., 0] * part * width, 0.0, STEEPEST * gained) for each in (begin, end)
    )
    rest = 1.0 - share
    rise = gained * share * share * (1.0 + 2.0 * rest)
    rise = rise + share * rest * (first * rest - last * share)
    return np.asarray(start + np.clip(rise, 0.0, gained))


def _largest(values: Array) -> Array:
    """Return the largest value of each column, shape (items, 6), looked for between nodes too."""
    finer = rows(lobatto(NODES), np.linspace(0.0, 1.0, FINE))
    steps = values.max(axis=2).argmax(axis=1)  # of each item and column
    near = np.clip(steps + np.array([-1, 0, 1])[:, None, None], 0, values.shape[1] - 1)
    item, column = np.arange(len(values))[:, None], np.arange(values.shape[-1])
    found = finer @ np.moveaxis(values[item, near, :, column], -1, 2)
    at = np.clip(found.argmax(axis=2), 1, FINE - 2)[:, :, None]
    before, here, after = (np.take_along_axis(found, at + k, axis=2) for k in (-1, 0, 1))
    bend = 2.0 * here - before - after
    peaked = (here >= before) & (here >= after) & (bend > 0.0)
    # The vertex of the parabola through the greatest and its neighbours.
    here = here + np.where(peaked, (after - before) ** 2 / (8.0 * bend), 0.0)
    return np.asarray(np.maximum(values.max(axis=(1, 2)), here.max(axis=(0, 2))))


class SolvedMotion(NormalMotion):
    """A normal motion by interpolation in a table; even in time along its phase."""

    accuracy = ACCURACY

    def __init__(self, law: Law, scene: Scene, table: MotionTable) -> None:
        self.law, self.scene, self.table = law, scene, table
        self.duration = table.shaped(table.ends * table.unit)
        self.final_rate = table.shaped(table.last[:, RATE])
        self.total_load_impulse = table.shaped(table.last[:, LOAD_IMPULSE])
        self.maximum_approach = table.shaped(table.largest[:, APPROACH])
        self.maximum_force = table.shaped(table.largest[:, FORCE])
        self.maximum_radius = table.shaped(_radius(table.largest[:, RADIUS_SQUARED]))
        self.status = batch.filled(table.shaped(table.status), scene.shape)
        self.detail = batch.filled(table.shaped(table.detail), scene.shape)

    @np.errstate(under="ignore")  # interpolation on a node leaves the others a share of 1e-290
    def at(self, phase: Real) -> NormalSample:
        """Return the motion at ``phase`` in [0, pi], by interpolation."""
        shape = self.table.shape
        fraction = np.asarray(phase, dtype=np.float64) / math.pi
        outer = np.broadcast_shapes(fraction.shape, shape)
        items = len(self.table.unit)
        share = np.broadcast_to(fraction, outer).reshape(*outer[: len(outer) - len(shape)], items)
        found = np.moveaxis(self.table.at(share * self.table.ends), -1, 0).reshape(6, *outer)
        approach, rate, force, radius_squared, load, load_impulse = found
        contact = NormalContact(force, _radius(radius_squared), approach, np.maximum(load, 0.0))
        return NormalSample(fraction * self.duration, approach, rate, contact, load_impulse)

    def phase(self, fraction: Real) -> Real:
        """Return pi times the fraction."""
        return math.pi * np.asarray(fraction)

    def take(self, part: Any) -> SolvedMotion:
        """Return the motion of some impacts."""
        scene, table = self.scene.take(part), self.table
        if table.shape:
            table = table.take(np.arange(math.prod(table.shape)).reshape(table.shape)[part])
        return SolvedMotion(self.law, scene, table)


def _radius(squared: Array) -> Array:
    """Return the contact radius; interpolation may leave its square below zero."""
    return np.sqrt(np.maximum(squared, 0.0))


class FailedMotion(NormalMotion):
    """The normal motion of impacts whose normal law failed: every number is NaN."""

    accuracy = math.nan

    def __init__(self, law: Law, scene: Scene, status: Status, detail: str) -> None:
        """Every number is NaN.

        Parameters
        ----------
        law : Law
            The one that failed.
        scene : Scene
        status, detail : Status, str
            How, for every impact.
        """
        shape = scene.shape
        self.law, self.scene = law, scene
        unknown = batch.spread(math.nan, shape)
        self.duration = self.maximum_radius = self.maximum_approach = unknown
        self.maximum_force = self.final_rate = self.total_load_impulse = unknown
        self.status, self.detail = batch.filled(status, shape), batch.filled(detail, shape)

    def at(self, phase: Real) -> NormalSample:
        """Return NaN throughout."""
        nothing = math.nan * (np.asarray(phase) + self.duration)
        contact = NormalContact(nothing, nothing, nothing, nothing)
        return NormalSample(nothing, nothing, nothing, contact, nothing)

    def phase(self, fraction: Real) -> Real:
        """Return pi times the fraction."""
        return math.pi * np.asarray(fraction)

    def take(self, part: Any) -> FailedMotion:
        """Return the same of some impacts."""
        status, detail = (
            np.ravel(np.asarray(e, dtype=object))[0] for e in (self.status, self.detail)
        )
        return FailedMotion(self.law, self.scene.take(part), status, detail)
