"""The normal motion of any normal law, made once: in closed form, or solved to ``TOLERANCE``."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab import batch, faults
from contactlab.checks import Real
from contactlab.closed_forms import hertz_scales
from contactlab.collocation import lobatto, rows
from contactlab.contracts.motion import NormalMotion, NormalSample
from contactlab.contracts.normal import ClosedFormNormalLaw, NormalContact, NormalLaw
from contactlab.scene import Scene
from contactlab.status import Status

Array = NDArray[np.float64]

#: Error of approach and rate in a step, over their scales: far below what integrators of the
#: tangential motion aim at by default, so that the normal motion is not what limits them.
TOLERANCE = 1e-10
#: Relative error of the load impulse that is declared: what steps of ``TOLERANCE`` add up to.
ACCURACY = 1e-7
#: Nodes in a step: polynomials of degree 7 hold the dense output of the solver exactly.
NODES = 8
#: First step over the duration of a Hertz impact; the next ones follow the error.
FIRST_STEP = 1e-4
#: Steps after which a contact is given up.
MOST_STEPS = 20_000
#: A contact in which the rate has changed its sign so often without separation is given up:
#: adhesion holds the bodies.
MOST_TURNS = 20
#: So is one deeper than this over R, or at rest: the rate over v1, and its change in a step.
DEEPEST, AT_REST = 1e6, 1e-9
#: Steps in which the impacts of a batch are to reach their greatest compression.
MOST_ALIGNING = 500
#: Halvings of the step in which a contact ends.
HALVINGS = 52
#: Steps end where a rate changes its sign, but for parts of a Hertz duration shorter than this.
LEAST_TURN = 1e-4
#: Points between nodes at which maxima are looked for.
FINE = 129
#: Columns of the tables of a solved motion.
APPROACH, RATE, FORCE, SQUARE, LOAD, IMPULSE = range(6)


def normal_motion(law: NormalLaw, scene: Scene) -> NormalMotion:
    """Return the motion of ``scene`` under ``law`` from first touch to separation.

    Impacts of a batch that do not separate have the status ``NOT_SEPARATED``.

    Raises
    ------
    LawFaultError
        If the law raises, or answers with other than finite real numbers.
    """
    if isinstance(law, ClosedFormNormalLaw):
        with faults.blaming(law):
            motion = law.motion(scene)
            if not isinstance(motion, NormalMotion):
                raise TypeError(f"motion returned {faults.shown(motion)}, which is no NormalMotion")
            return motion
    plain = (*attrs.astuple(scene.pair), scene.normal_speed)
    if scene.shape and all(isinstance(number, float) for number in plain):
        one = attrs.evolve(scene, friction_coefficient=0.0, tangential_velocity=0.0, spin=0.0)
        if not one.shape:  # the impacts of the batch differ in their tangential motion only
            common = normal_motion(law, one)
            assert isinstance(common, SolvedMotion)
            return common.of_batch(scene)
    with np.errstate(all="ignore"):
        return _Solver(law, scene).solve()


@attrs.frozen(kw_only=True, eq=False, repr=False)
class Table:
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
        Separation, in units of ``unit``; the step that holds it is cut there.
    values : array, shape (items, S, NODES, 6)
        Approach, rate, force, radius², friction load and its impulse, in SI.
    status, detail : array of object, shape (items,)
    """

    shape: tuple[int, ...]
    edges: Array
    unit: Array
    ends: Array
    values: Array
    status: Any
    detail: Any

    def at(self, times: Array) -> Array:
        """Return the six columns at scaled ``times``, shape (..., items); shape (..., items, 6)."""
        index = np.clip(self.edges.searchsorted(times) - 1, 0, len(self.edges) - 2)
        left = self.edges[index]
        width = np.minimum(self.edges[index + 1], self.ends) - left
        place = np.clip((times - left) / np.where(width > 0.0, width, 1.0), 0.0, 1.0)
        weights = rows(lobatto(NODES), place)
        found = self.values[np.arange(len(self.unit)), index]
        return np.asarray(np.einsum("...n,...nc->...c", weights, found))

    def largest(self) -> Array:
        """Return the largest value of each column, shape (items, 6)."""
        rough = self.values.max(axis=(1, 2))
        finer = rows(lobatto(NODES), np.linspace(0.0, 1.0, FINE))
        steps = np.unique(self.values.max(axis=2).argmax(axis=1))
        near = np.unique(np.clip(steps[:, None] + (-1, 0, 1), 0, self.values.shape[1] - 1))
        for step in near:
            found = np.einsum("mn,inc->imc", finer, self.values[:, step])
            np.maximum(rough, found.max(axis=1), out=rough)
        return np.asarray(rough)

    def take(self, index: NDArray[np.intp], shape: tuple[int, ...]) -> Table:
        """Return the table of some items, which have ``shape``."""
        return attrs.evolve(
            self,
            shape=shape,
            **{
                name: getattr(self, name)[index]
                for name in ("unit", "ends", "values", "status", "detail")
            },
        )


class FailedMotion(NormalMotion):
    """The normal motion of impacts whose law failed: nothing is known."""

    accuracy = math.nan

    def __init__(self, law: NormalLaw, scene: Scene, status: Status, detail: str) -> None:
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


class SolvedMotion(NormalMotion):
    """A normal motion by interpolation in a table; even in time along its phase."""

    accuracy = ACCURACY

    def __init__(self, law: NormalLaw, scene: Scene, table: Table) -> None:
        self.law, self.scene, self.table = law, scene, table
        last, largest = table.at(table.ends), table.largest()

        def shaped(values: Array) -> Any:
            return values.reshape(table.shape) if table.shape else float(values[0])

        self.duration = shaped(table.ends * table.unit)
        self.final_rate = shaped(last[:, RATE])
        self.total_load_impulse = shaped(last[:, IMPULSE])
        self.maximum_approach = shaped(largest[:, APPROACH])
        self.maximum_force = shaped(largest[:, FORCE])
        self.maximum_radius = shaped(np.sqrt(np.maximum(largest[:, SQUARE], 0.0)))
        status = table.status.reshape(table.shape) if table.shape else table.status[0]
        detail = table.detail.reshape(table.shape) if table.shape else table.detail[0]
        self.status = batch.filled(status, scene.shape)
        self.detail = batch.filled(detail, scene.shape)

    def at(self, phase: Real) -> NormalSample:
        """Return the motion at ``phase`` in [0, pi], by interpolation."""
        shape = self.table.shape
        fraction = np.asarray(phase, dtype=np.float64) / math.pi
        outer = np.broadcast_shapes(fraction.shape, shape)
        items = len(self.table.unit)
        share = np.broadcast_to(fraction, outer).reshape(*outer[: len(outer) - len(shape)], items)
        found = np.moveaxis(self.table.at(share * self.table.ends), -1, 0).reshape(6, *outer)
        approach, rate, force, square, load, impulse = found
        radius = np.sqrt(np.maximum(square, 0.0))
        contact = NormalContact(force, radius, approach, np.maximum(load, 0.0))
        return NormalSample(fraction * self.duration, approach, rate, contact, impulse)

    def phase(self, fraction: Real) -> Real:
        """Return pi times the fraction."""
        return math.pi * np.asarray(fraction)

    def take(self, part: Any) -> SolvedMotion:
        """Return the motion of some impacts."""
        scene, shape = self.scene.take(part), self.table.shape
        if not shape:
            return self.of_batch(scene)
        found = np.arange(math.prod(shape)).reshape(shape)[part]
        return SolvedMotion(self.law, scene, self.table.take(np.ravel(found), np.shape(found)))

    def of_batch(self, scene: Scene) -> SolvedMotion:
        """Return the same motion for all impacts of ``scene``."""
        return SolvedMotion(self.law, scene, self.table)


class Place(NamedTuple):
    """Scaled time, and scaled approaches and rates, shape (2 items,)."""

    time: float
    scaled: Array


class _Solver:
    """One normal motion under way; of a batch all impacts take the same steps, scaled."""

    def __init__(self, law: NormalLaw, scene: Scene) -> None:
        self.law, self.scene, self.shape = law, scene, scene.shape
        self.items = math.prod(self.shape)
        self.unit = self._flat(hertz_scales(scene).duration)
        self.speed = self._flat(scene.normal_speed)
        self.mass = self._flat(scene.pair.normal_mass)
        self.radius = self._flat(scene.pair.radius)
        self.length = self.speed * self.unit
        self.scale = float(self.length[0]), float(self.speed[0])
        self.softness = float(self.unit[0] / (self.mass[0] * self.speed[0]))
        self.active = np.ones(self.items, dtype=bool)
        self.begun = np.zeros(self.items, dtype=bool)
        self.ends = np.zeros(self.items)
        self.status = np.full(self.items, Status.SUCCESS, dtype=object)
        self.detail = np.full(self.items, "", dtype=object)
        self.impulse, self.turns = np.zeros(self.items), np.zeros(self.items)
        self.steps, self.time, self.finite, self.remembers = 0, 0.0, True, False

    def solve(self) -> SolvedMotion:
        """Return the motion."""
        with np.errstate(all="ignore"), faults.blaming(self.law):
            self.state = self.law.start(self.scene)
        touch = Place(0.0, np.concatenate([np.zeros(self.items), np.ones(self.items)]))
        if self.items > 1:
            self._align(touch)
        place, edges, tables = touch, [0.0], []
        solver = self._solver(place, FIRST_STEP)
        while self.active.any():
            after, dense = self._step(solver)
            if (turn := self._turn(place, after, dense)) is not None:
                # What a law remembers often changes as the rate changes its sign.
                until = place.time + turn
                after, dense = self._step(self._solver(place, turn, until=until))
                solver = self._solver(after, turn)
            tables.append(self._table(dense, place.time, after.time))
            edges.append(after.time)
            self._remember(dense[-1])
            self._give_up(dense[-1], place.scaled[self.items :], after.time)
            place = after
        return SolvedMotion(
            self.law,
            self.scene,
            Table(
                shape=self.shape,
                edges=np.array(edges),
                unit=self.unit,
                ends=self.ends,
                values=np.stack(tables, axis=1),
                status=self.status,
                detail=self.detail,
            ),
        )

    def _align(self, touch: Place) -> None:
        """Make the times to greatest compression the units, so that all items turn together."""
        place, solver = touch, self._solver(touch, FIRST_STEP)
        found, first = np.zeros(self.items), self.state
        for _ in range(MOST_ALIGNING):
            after, dense = self._step(solver)
            turns = (found == 0.0) & (after.scaled[self.items :] <= 0.0)
            part = self._turning(dense[:, self.items :])
            time = place.time + part * (after.time - place.time)
            found = np.where(turns, time, found)
            self._remember(dense[-1])
            place = after
            if (found > 0.0).all():
                break
        self.state, self.steps, self.remembers = first, 0, False
        self.unit = self.unit * np.where(found > 0.0, found, 1.0)
        self.length = self.speed * self.unit

    def _solver(self, place: Place, first: float, until: float = math.inf) -> Any:
        """Return a solver that begins at ``place`` with a step of at most ``first``."""
        from scipy.integrate import DOP853  # not before a law without closed form is met

        tolerance = TOLERANCE / math.sqrt(2.0 * self.items)  # the solver's norm is a mean
        first = min(first, until - place.time)
        return DOP853(
            self._slope, place.time, place.scaled, until, first_step=first, rtol=tolerance,
            atol=tolerance,
        )  # fmt: skip

    def _step(self, solver: Any) -> tuple[Place, Array]:
        """Take a step; return where it leads, and approach and rate (scaled) at its nodes."""
        start = float(solver.t)
        solver.step()
        self.steps, self.time = self.steps + 1, float(solver.t) * float(self.unit.max())
        if solver.status == "failed":
            why = "steps became too short" if self.finite else "a force that is not finite"
            raise self._fault(Status.UNRESOLVED if self.finite else Status.NON_FINITE, why)
        end = float(solver.t)
        points = start + (end - start) * lobatto(NODES).points
        return Place(end, np.array(solver.y)), solver.dense_output()(points).T

    def _turn(self, place: Place, after: Place, dense: Array) -> float | None:
        """Return the length of step after which the first rate changes its sign, if one does.

        None of a law without memory, and where it is too near to an end of the step.
        """
        if not self.remembers:
            return None
        rate = dense[:, self.items :]
        turns = (rate[0] * rate[-1] < 0.0) & self.active
        if not turns.any():
            return None
        length = after.time - place.time
        found = np.sort(self._turning(rate)[turns]) * length
        found = found[(found > LEAST_TURN) & (found < length - LEAST_TURN)]
        return float(found[0]) if found.size else None

    def _turning(self, rate: Array) -> Array:
        """Return the part of a step at which rates, shape (NODES, items), change their sign."""
        low, high = np.zeros(self.items), np.ones(self.items)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            here = np.einsum("in,ni->i", rows(lobatto(NODES), middle), rate)
            before = here * rate[0] > 0.0
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return high

    def _slope(self, _: float, scaled: Array) -> Array:
        """Return the derivatives of scaled approach and rate."""
        if not self.shape:
            length, speed = self.scale
            one = float(self._ask(scaled[:1] * length, scaled[1:] * speed)[0].force)
            self.finite = math.isfinite(one)
            return np.array([scaled[1], -one * self.softness])
        force = self._respond(scaled)[0]
        self.finite = bool(np.isfinite(force).all())
        change = -force * (self.unit / (self.mass * self.speed)) * self.active
        return np.concatenate([scaled[self.items :], change])

    def _respond(self, scaled: Array) -> tuple[Array, Array, Array, Array]:
        """Return force, radius, overlap and friction load, shape (items,)."""
        approach, rate = scaled[: self.items] * self.length, scaled[self.items :] * self.speed
        contact = self._ask(approach, rate)[0].complete
        return tuple(self._flat(entry) for entry in contact)

    def _ask(self, approach: Array, rate: Array) -> tuple[NormalContact, Any]:
        """Ask the law; name it if it fails."""
        try:
            with np.errstate(all="ignore"):  # and whatever a law makes of it ends here
                if self.shape:
                    arrays = (batch.locked(each.reshape(self.shape)) for each in (approach, rate))
                    contact, state = self.law.respond(self.state, *arrays)
                else:
                    given = (approach.item(), rate.item())
                    contact, state = self.law.respond(self.state, *given)
            if not isinstance(contact, NormalContact):
                raise TypeError(f"respond gave {faults.shown(contact)}, not a NormalContact")
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # a plug-in may not end the process
            raise self._fault(Status.LAW_RAISED, faults.raised(error)) from error
        for entry in contact:
            plain = type(entry) is float or entry is None
            if not plain and faults.malformed(entry, self.shape):
                what = f"the answer {faults.shown(entry)}"
                raise self._fault(Status.MALFORMED, what)
        return contact, state

    def _flat(self, entry: Any) -> Any:
        if not self.shape:
            return np.array([entry], dtype=np.float64)
        return np.array(np.broadcast_to(entry, self.shape), dtype=np.float64).reshape(-1)

    def _table(self, dense: Array, left: float, right: float) -> Array:
        """Return the columns at the nodes of a step, cut where contact ends; enter the ends."""
        answers = np.array([self._respond(row) for row in dense])  # (NODES, 4, items)
        cut = self._cut(dense, answers[:, 2])
        if cut is not None:
            weights = rows(lobatto(NODES), lobatto(NODES).points[:, None] * cut)  # (m, i, n)
            both = dense.reshape(NODES, 2, self.items)
            dense = np.einsum("min,nci->mci", weights, both).reshape(NODES, -1)
            answers = np.array([self._respond(row) for row in dense])
            ended = cut < 1.0
            self.ends[ended] = left + cut[ended] * (right - left)
        force, radius, _, load = np.moveaxis(answers, 1, 0)
        if not np.isfinite(answers[:, (0, 1, 3)][..., self.active]).all():
            raise self._fault(Status.NON_FINITE, f"the answer {faults.shown(force.max())}")
        approach, rate = dense[:, : self.items] * self.length, dense[:, self.items :] * self.speed
        width = (right - left) * (1.0 if cut is None else cut) * self.unit
        gathered = lobatto(NODES).integral @ load * width
        same = (load == force).all(axis=0)  # no tension: the impulse is the change of momentum
        gathered = np.where(same, self.mass * (rate[0] - rate), gathered)
        impulse = self.impulse + gathered
        self.impulse = impulse[-1]
        if cut is not None:
            self.active &= ~(cut < 1.0)
        return np.stack([approach, rate, force, radius**2, load, impulse], axis=-1).swapaxes(0, 1)

    def _cut(self, dense: Array, overlap: Array) -> Array | None:
        """Return the part of the step for which each item stays in contact; None if all do."""
        self._known(overlap)
        begun = np.logical_or.accumulate(overlap > 0.0, axis=0) | self.begun
        out = begun & ~(overlap > 0.0) & self.active
        self.begun |= begun[-1]
        if not out.any():
            return None
        ended, place = out.any(axis=0), out.argmax(axis=0)
        points = lobatto(NODES).points
        high = np.where(ended, points[place], 1.0)
        low = np.where(ended, points[np.maximum(place - 1, 0)], 1.0)
        both = dense.reshape(NODES, 2, self.items)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            weights = rows(lobatto(NODES), middle)
            here = np.einsum("in,nci->ci", weights, both).reshape(-1)
            found = self._respond(here)[2]
            self._known(found)
            inside = found > 0.0
            low, high = np.where(inside, middle, low), np.where(inside, high, middle)
        return np.where(ended, np.minimum(low, np.nextafter(1.0, 0.0)), 1.0)

    def _known(self, overlap: Array) -> None:
        """Refuse NaN, which compares as out of contact."""
        if np.isnan(overlap[..., self.active]).any():
            raise self._fault(Status.NON_FINITE, "the overlap nan")

    def _remember(self, scaled: Array) -> None:
        """Enter the memory that the law has at the end of the step."""
        approach, rate = scaled[: self.items] * self.length, scaled[self.items :] * self.speed
        state = self._ask(approach, rate)[1]
        self.remembers = self.remembers or state is not self.state
        self.state = state

    def _give_up(self, scaled: Array, before: Array, time: float) -> None:
        """Give up contacts that do not come to an end."""
        approach, rate = scaled[: self.items] * self.length, scaled[self.items :]
        self.turns += rate * before < 0.0
        rests = (np.abs(rate) < AT_REST) & (np.abs(rate - before) < AT_REST)
        lost = (self.turns > MOST_TURNS) | rests | (approach > DEEPEST * self.radius)
        if self.steps >= MOST_STEPS:
            lost = self.active
        lost = lost & self.active
        if not lost.any():
            return
        for item in np.flatnonzero(lost).tolist():
            self.status[item] = Status.NOT_SEPARATED
            self.detail[item] = faults.told(
                self.law, "the bodies do not part", self.steps, time * self.unit[item]
            )
        self.ends[lost] = time
        self.active &= ~lost

    def _fault(self, status: Status, what: str) -> faults.LawFaultError:
        detail = faults.told(self.law, what, self.steps + 1, self.time)
        return faults.LawFaultError(status, detail)
