"""Normal motions kept as tables."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Self

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion, NormalSample, Units
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.arrays import shape_as
from contactlab.numeric.lobatto import lobatto, rows
from contactlab.numeric.types import Array, Index, Real

#: Declared relative error of the load impulse: the sum of the errors of all steps, each within
#: the ``TOLERANCE`` of ``contactlab.solve.normal_steps``.
ACCURACY = 1e-7
#: Nodes in a step: polynomials of degree 7 hold the dense output of the solver exactly.
NODES = 8
#: Points in a step among which a maximum is searched.
FINE = 129
#: A cubic is monotonic if its end slopes are at most this times the mean slope.
STEEPEST = 3.0
#: Columns of the table; the radius is squared, which is smooth where the radius begins as a root.
APPROACH, RATE, FORCE, RADIUS_SQUARED, LOAD, LOAD_IMPULSE = range(6)


@attrs.frozen(kw_only=True, eq=False, repr=False)
class MotionTable:
    """A solved motion: a polynomial for each column of each step.

    Attributes
    ----------
    shape : tuple of int
        Shape of the batch; () if one motion serves the whole batch.
    shared : dict
        What motions of this table share: their ends, and by the number of axes of their batches.
    edges : array, shape (items, S + 1)
        Ends of the steps, in units of ``unit``. An item with fewer steps than another has steps
        of zero width at separation.
    unit : array, shape (items,)
        Unit of time in s.
    values : array, shape (items, S, NODES, 6)
        Approach, rate, force, radius², friction load and load impulse at the nodes, in SI.
    last, largest : array, shape (items, 6)
        Values of the columns at separation, and their largest values.
    status, detail : array of object, shape (items,)
    """

    shape: tuple[int, ...]
    edges: Array
    unit: Array
    values: Array
    last: Array
    largest: Array
    status: NDArray[np.object_]
    detail: NDArray[np.object_]
    shared: dict[Any, Any] = attrs.field(factory=dict, init=False)

    @classmethod
    def make(cls, **entries: Any) -> Self:
        """Return the table; ``last`` and ``largest`` follow from the other entries."""
        table = cls(**entries, last=np.empty(0), largest=_largest(entries["values"]))
        return attrs.evolve(table, last=table.at(table.ends))

    @classmethod
    def join(cls, tables: Sequence[MotionTable]) -> Self:
        """Return the tables of single motions as the items of one, ended by steps of no width."""
        most = max(table.values.shape[1] for table in tables)
        edges, values = [], []
        for table in tables:
            more = 0, most - table.values.shape[1]
            edges.append(np.pad(table.edges, ((0, 0), more), mode="edge"))
            values.append(np.pad(table.values, ((0, 0), more, (0, 0), (0, 0)), mode="edge"))
        names = "unit", "last", "largest", "status", "detail"
        others = {name: np.concatenate([getattr(one, name) for one in tables]) for name in names}
        shape = (len(tables),)
        return cls(
            shape=shape, edges=np.concatenate(edges), values=np.concatenate(values), **others
        )

    @property
    def ends(self) -> Array:
        """Times of separation in units of ``unit``, shape (items,)."""
        return np.asarray(self.edges[:, -1])

    def at(self, times: Array) -> Array:
        """Return the columns, shape (..., items, 6), at scaled times of shape (..., items)."""
        item = np.arange(len(self.unit))
        index = self._step(times)
        left = self.edges[item, index]
        width = self.edges[item, index + 1] - left
        fraction = np.clip((times - left) / np.where(width > 0.0, width, 1.0), 0.0, 1.0)
        steps = self.values[item, index]
        columns = np.einsum("...n,...nc->...c", rows(lobatto(NODES), fraction), steps)
        columns[..., LOAD_IMPULSE] = _rising(fraction, width * self.unit, steps)
        return np.asarray(columns)

    def _step(self, times: Array) -> NDArray[np.intp]:
        """Return the index of the step that contains each of ``times``."""
        count = self.edges.shape[1]
        span = np.where(self.ends > 0.0, self.ends, 1.0)
        item = np.arange(len(span))
        # One search for all items: shares of the duration from 0 to 1, plus 2 for each item.
        shares = (self.edges / span[:, None] + 2.0 * item[:, None]).reshape(-1)
        after = shares.searchsorted(times / span + 2.0 * item) - count * item
        return np.asarray(np.clip(after - 1, 0, count - 2))

    def take(self, index: NDArray[np.intp]) -> MotionTable:
        """Return the table of some items, in the shape of ``index``, an array of their numbers."""
        columns = ("edges", "unit", "values", "last", "largest", "status", "detail")
        taken = {name: getattr(self, name)[np.ravel(index)] for name in columns}
        return attrs.evolve(self, shape=np.shape(index), **taken)

    def restore_shape(self, values: Array) -> Real:
        """Return values of shape (items,) in the shape of the batch, or as a plain number."""
        return shape_as(values, self.shape)


def _rising(fraction: Array, width: Array, steps: Array) -> Array:
    """Return the load impulse in N s at a fraction of steps of a width in s; it never falls."""
    # Between nodes it is a cubic whose end slopes are the loads, reduced where it would fall.
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
    """Return the largest value of each column, at nodes or between them, shape (items, 6)."""
    finer = rows(lobatto(NODES), np.linspace(0.0, 1.0, FINE))
    steps = values.max(axis=2).argmax(axis=1)  # shape (items, 6)
    near = np.clip(steps + np.array([-1, 0, 1])[:, None, None], 0, values.shape[1] - 1)
    item, column = np.arange(len(values))[:, None], np.arange(values.shape[-1])
    samples = finer @ np.moveaxis(values[item, near, :, column], -1, 2)
    at = np.clip(samples.argmax(axis=2), 1, FINE - 2)[:, :, None]
    before, peak, after = (np.take_along_axis(samples, at + k, axis=2) for k in (-1, 0, 1))
    bend = 2.0 * peak - before - after
    curved = (peak >= before) & (peak >= after) & (bend > 0.0)
    # The vertex of the parabola through the largest sample and its neighbours.
    peak = peak + np.where(curved, (after - before) ** 2 / (8.0 * bend), 0.0)
    return np.asarray(np.maximum(values.max(axis=(1, 2)), peak.max(axis=(0, 2))))


def units_over(first: Scene, scene: Scene) -> Units:
    """Return Hertz's units of a batch over those of one impact."""
    ours, theirs = hertz_scales(scene), hertz_scales(first)
    return Units(
        time=ours.duration / theirs.duration,
        approach=ours.approach / theirs.approach,
        rate=scene.normal_speed / first.normal_speed,
        force=ours.force / theirs.force,
        radius=ours.radius / theirs.radius,
    )


class SolvedMotion(NormalMotion):
    """A normal motion interpolated in a table; its phase is proportional to time.

    The table may belong to other impacts, in Hertz's units of a ``first``.
    """

    accuracy = ACCURACY

    def __init__(
        self,
        law: Law,
        scene: Scene,
        table: MotionTable,
        first: Scene | None = None,
        units: Units | None = None,
    ) -> None:
        self.law, self.scene, self.table, self.first = law, scene, table, first
        self.alike = not table.shape
        if units is None:
            units = Units() if first is None else units_over(first, scene)
        self.units = units
        ends = table.shared.get("ends")
        if ends is None:
            ends = table.shared["ends"] = _ends_of(table)
        duration, final_rate, load_impulse, approach, force, radius, status, detail = ends
        self.duration = duration * units.time
        self.final_rate = final_rate * units.rate
        self.total_load_impulse = load_impulse * (units.force * units.time)
        self.maximum_approach = approach * units.approach
        self.maximum_force = force * units.force
        self.maximum_radius = radius * units.radius
        self.status = batch.spread_object(status, scene.shape)
        self.detail = batch.spread_object(detail, scene.shape)

    @property
    def shared(self) -> dict[Any, Any] | None:
        """Values that batches of one table and of equal dimension share."""
        if not self.alike or self.first is not None:
            return None
        kept: dict[Any, Any] = self.table.shared.setdefault(len(self.scene.shape), {})
        return kept

    @property
    def pattern(self) -> tuple[NormalMotion, Units] | None:
        """The motion of the table."""
        if not self.alike or self.first is None:
            return None
        return SolvedMotion(self.law, self.first, self.table), self.units

    @np.errstate(under="ignore")  # on a node the weights of the other nodes are about 1e-290
    def at(self, phase: Real) -> NormalSample:
        """Return the motion at ``phase`` in [0, pi], by interpolation."""
        shape = self.table.shape
        fraction = np.asarray(phase, dtype=np.float64) / math.pi
        outer = np.broadcast_shapes(fraction.shape, shape)
        items = len(self.table.unit)
        share = np.broadcast_to(fraction, outer).reshape(*outer[: len(outer) - len(shape)], items)
        columns = np.moveaxis(self.table.at(share * self.table.ends), -1, 0).reshape(6, *outer)
        approach, rate, force, radius_squared, load, load_impulse = columns
        radius, load = _radius(radius_squared), np.maximum(load, 0.0)
        if self.first is not None:
            unit = self.units
            approach, rate, force = approach * unit.approach, rate * unit.rate, force * unit.force
            radius, load = radius * unit.radius, load * unit.force
            load_impulse = load_impulse * (unit.force * unit.time)
        contact = NormalContact(force, radius, approach, load)
        return NormalSample(fraction * self.duration, approach, rate, contact, load_impulse)

    def phase(self, fraction: Real) -> Real:
        """Return pi times the fraction."""
        return math.pi * np.asarray(fraction)

    def take(self, part: Index) -> SolvedMotion:
        """Return the motion of some impacts."""
        scene, table = self.scene.take(part), self.table
        if table.shape:
            table = table.take(np.arange(math.prod(table.shape)).reshape(table.shape)[part])
        units = Units._make(batch.take(each, self.scene.shape, part) for each in self.units)
        return SolvedMotion(self.law, scene, table, self.first, units)


def _ends_of(table: MotionTable) -> tuple[Any, ...]:
    """Return the ends of a table: numbers, status and detail, in the shape of its batch."""
    columns = (
        table.ends * table.unit,
        table.last[:, RATE],
        table.last[:, LOAD_IMPULSE],
        table.largest[:, APPROACH],
        table.largest[:, FORCE],
        _radius(table.largest[:, RADIUS_SQUARED]),
        table.status,
        table.detail,
    )
    return tuple(shape_as(each, table.shape) for each in columns)


def _radius(squared: Array) -> Array:
    """Return the contact radius; interpolation may make its square negative."""
    return np.sqrt(np.maximum(squared, 0.0))
