"""Normal motions of laws without a closed form, kept as tables, and of laws that failed."""

from __future__ import annotations

import math
from typing import Any, Self

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.motion import NormalMotion, NormalSample
from contactlab.contracts.normal import NormalContact, NormalLaw
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
#: Columns of the table; the radius is squared, which is smooth where the radius begins as a root.
APPROACH, RATE, FORCE, RADIUS_SQUARED, LOAD, LOAD_IMPULSE = range(6)


@attrs.frozen(kw_only=True, eq=False, repr=False)
class MotionTable:
    """A solved motion as polynomials between the ends of steps.

    Attributes
    ----------
    shape : tuple of int
        Of the items; () where one motion serves a whole batch.
    edges : array, shape (S + 1,)
        Ends of the steps, in units of ``unit``; common to the items.
    unit : array, shape (items,)
        Of time, in s.
    ends : array, shape (items,)
        Time of separation, in units of ``unit``; the step that holds it is cut there.
    values : array, shape (items, S, NODES, 6)
        Approach, rate, force, radius², friction load and its impulse, in SI.
    last, largest : array, shape (items, 6)
        The same at separation, and the largest value of each.
    status, detail : array of object, shape (items,)
    """

    shape: tuple[int, ...]
    edges: Array
    unit: Array
    ends: Array
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

    def at(self, times: Array) -> Array:
        """Return the six columns at scaled ``times``, shape (..., items); shape (..., items, 6)."""
        index = np.clip(self.edges.searchsorted(times) - 1, 0, len(self.edges) - 2)
        left = self.edges[index]
        width = np.minimum(self.edges[index + 1], self.ends) - left
        fraction = np.clip((times - left) / np.where(width > 0.0, width, 1.0), 0.0, 1.0)
        weights = rows(lobatto(NODES), fraction)
        found = self.values[np.arange(len(self.unit)), index]
        return np.asarray(np.einsum("...n,...nc->...c", weights, found))

    def take(self, index: NDArray[np.intp]) -> MotionTable:
        """Return the table of the items that ``index`` counts, which has the shape of ``index``."""
        columns = ("unit", "ends", "values", "last", "largest", "status", "detail")
        taken = {name: getattr(self, name)[np.ravel(index)] for name in columns}
        return attrs.evolve(self, shape=np.shape(index), **taken)

    def shaped(self, values: Array) -> Any:
        """Return values, one an item, in the shape of the items; one alone as a plain number."""
        return values.reshape(self.shape) if self.shape else values.item()


def _largest(values: Array) -> Array:
    """Return the largest value of each column, shape (items, 6), looked for between nodes too."""
    largest = values.max(axis=(1, 2))
    finer = rows(lobatto(NODES), np.linspace(0.0, 1.0, FINE))
    steps = np.unique(values.max(axis=2).argmax(axis=1))
    near = np.unique(np.clip(steps[:, None] + (-1, 0, 1), 0, values.shape[1] - 1))
    for step in near:
        found = np.einsum("mn,inc->imc", finer, values[:, step])
        np.maximum(largest, found.max(axis=1), out=largest)
    return np.asarray(largest)


class SolvedMotion(NormalMotion):
    """A normal motion by interpolation in a table; even in time along its phase."""

    accuracy = ACCURACY

    def __init__(self, law: NormalLaw, scene: Scene, table: MotionTable) -> None:
        self.law, self.scene, self.table = law, scene, table
        self.duration = table.shaped(table.ends * table.unit)
        self.final_rate = table.shaped(table.last[:, RATE])
        self.total_load_impulse = table.shaped(table.last[:, LOAD_IMPULSE])
        self.maximum_approach = table.shaped(table.largest[:, APPROACH])
        self.maximum_force = table.shaped(table.largest[:, FORCE])
        self.maximum_radius = table.shaped(_radius(table.largest[:, RADIUS_SQUARED]))
        self.status = batch.filled(table.shaped(table.status), scene.shape)
        self.detail = batch.filled(table.shaped(table.detail), scene.shape)

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

    def __init__(self, law: NormalLaw, scene: Scene, status: Status, detail: str) -> None:
        """Every number is NaN.

        Parameters
        ----------
        law : NormalLaw
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
