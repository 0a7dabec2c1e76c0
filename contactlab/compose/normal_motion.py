"""The normal motion of any normal law, made once: in closed form, or solved to ``TOLERANCE``."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose.scaled_normal_law import ScaledNormalLaw
from contactlab.compose.solved_motion import NODES, MotionTable, SolvedMotion
from contactlab.contracts import faults
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import ClosedFormNormalLaw, NormalLaw
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import shown
from contactlab.numeric.lobatto import lobatto, rows

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: Error of approach and rate in a step, over their scales: far below what integrators of the
#: tangential motion aim at by default, so that the normal motion is not what limits them.
TOLERANCE = 1e-10
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
                raise TypeError(f"motion returned {shown(motion)}, which is no NormalMotion")
            return motion
    quantities = (*attrs.astuple(scene.pair), scene.normal_speed)
    if scene.shape and all(isinstance(quantity, float) for quantity in quantities):
        one = attrs.evolve(scene, friction_coefficient=0.0, tangential_velocity=0.0, spin=0.0)
        if not one.shape:  # the impacts of the batch differ in their tangential motion only
            watched = _Watched.of(one)
            common = normal_motion(law, watched)
            assert isinstance(common, SolvedMotion)
            if not watched.was_read:
                return SolvedMotion(law, scene, common.table)
    with np.errstate(all="ignore"):
        return _Solver(law, scene).solve()


class _Watched(Scene):
    """A single impact that keeps whether its index was read: then its motion is nobody else's."""

    __slots__ = ("was_read",)
    was_read: bool

    @classmethod
    def of(cls, scene: Scene) -> _Watched:
        """Return the scene, watched."""
        found = object.__new__(cls)
        for field in attrs.fields(Scene):
            if field.name != "index":
                object.__setattr__(found, field.name, getattr(scene, field.name))
        object.__setattr__(found, "was_read", False)
        return found

    @property
    def index(self) -> int:
        """Return 0, and keep that it was asked for."""
        object.__setattr__(self, "was_read", True)
        return 0


class _Instant(NamedTuple):
    """Time in the law's unit, and scaled approaches and rates, shape (2 items,)."""

    time: float
    scaled: Array


class _Solver:
    """The solution of one normal motion, step by step; all impacts of a batch take the same steps.

    Attributes
    ----------
    law : ScaledNormalLaw
    begun : array of bool, shape (items,)
        Impacts that have been in contact: only those can end it.
    ends : array, shape (items,)
        Time of separation, scaled.
    load_impulse : array, shape (items,)
        So far, in N s.
    turns : array, shape (items,)
        Changes of sign of the rate so far.
    """

    def __init__(self, law: NormalLaw, scene: Scene) -> None:
        self.law = ScaledNormalLaw(law, scene)
        self.items = items = self.law.items
        self.begun = np.zeros(items, dtype=bool)
        self.ends = np.zeros(items)
        self.status = np.full(items, Status.SUCCESS, dtype=object)
        self.detail = np.full(items, "", dtype=object)
        self.load_impulse, self.turns = np.zeros(items), np.zeros(items)

    def solve(self) -> SolvedMotion:
        """Return the motion."""
        law = self.law
        touch = _Instant(0.0, np.concatenate([np.zeros(self.items), np.ones(self.items)]))
        if self.items > 1:
            self._align(touch)
        before, edges, columns = touch, [0.0], []
        solver = self._solver(before, FIRST_STEP)
        while law.active.any():
            after, dense = self._step(solver)
            if (turn := self._turn(before, after, dense)) is not None:
                # What a law remembers often changes as the rate changes its sign.
                until = before.time + turn
                after, dense = self._step(self._solver(before, turn, until=until))
                solver = self._solver(after, turn)
            columns.append(self._columns(dense, before.time, after.time))
            edges.append(after.time)
            law.remember(dense[-1])
            self._give_up(dense[-1], before.scaled[self.items :], after.time)
            before = after
        table = MotionTable.made(
            shape=law.shape,
            edges=np.array(edges),
            unit=law.unit,
            ends=self.ends,
            values=np.stack(columns, axis=1),
            status=self.status,
            detail=self.detail,
        )
        return SolvedMotion(law.law, law.scene, table)

    def _align(self, touch: _Instant) -> None:
        """Make the times to greatest compression the units, so that all items turn together."""
        law, before, solver = self.law, touch, self._solver(touch, FIRST_STEP)
        found = np.ones(self.items)
        for _ in range(MOST_ALIGNING):
            after, dense = self._step(solver)
            rate = dense[:, self.items :]
            turns = law.active & (rate[-1] <= 0.0)
            if turns.any():
                times = before.time + self._turning(rate) * (after.time - before.time)
                found[turns] = times[turns]
            # Those that turned, or never will, move on without a force: steps grow for the rest.
            law.active &= ~(turns | self._deep(dense[-1]))
            law.remember(dense[-1])
            before = after
            if not law.active.any():
                break
        law.start()
        law.set_unit(law.unit * found)

    def _solver(self, begin: _Instant, first: float, until: float = math.inf) -> Any:
        """Return a solver from ``begin`` on, with a first step of at most ``first``."""
        from scipy.integrate import DOP853  # not before a law without closed form is met

        tolerance = TOLERANCE / math.sqrt(2.0 * self.items)  # the solver's norm is a mean
        first = min(first, until - begin.time)
        return DOP853(
            self.law.slope, begin.time, begin.scaled, until, first_step=first, rtol=tolerance,
            atol=tolerance,
        )  # fmt: skip

    def _step(self, solver: Any) -> tuple[_Instant, Array]:
        """Take a step; return where it leads, and approach and rate (scaled) at its nodes."""
        law, start = self.law, float(solver.t)
        law.steps += 1
        solver.step()
        end = float(solver.t)
        law.time = end * float(law.unit.max())
        if solver.status == "failed":
            if law.finite:
                raise law.fault(Status.UNRESOLVED, "steps became too short")
            raise law.fault(Status.NON_FINITE, "a force that is not finite")
        times = start + (end - start) * lobatto(NODES).points
        return _Instant(end, np.array(solver.y)), solver.dense_output()(times).T

    def _turn(self, before: _Instant, after: _Instant, dense: Array) -> float | None:
        """Return the length of step after which the first rate changes its sign, if one does.

        None of a law without memory, and where it is too near to an end of the step.
        """
        if not self.law.remembers:
            return None
        rate = dense[:, self.items :]
        turns = (rate[0] * rate[-1] < 0.0) & self.law.active
        if not turns.any():
            return None
        length = after.time - before.time
        found = np.sort(self._turning(rate)[turns]) * length
        found = found[(found > LEAST_TURN) & (found < length - LEAST_TURN)]
        return float(found[0]) if found.size else None

    def _turning(self, rate: Array) -> Array:
        """Return the part of a step at which rates, shape (NODES, items), change their sign."""
        ends = np.zeros(self.items), np.ones(self.items)
        return _halved(ends, rate, lambda here: here * rate[0] > 0.0)[1]

    def _columns(self, dense: Array, left: float, right: float) -> Array:
        """Return the columns of the table in one step, cut where contact ends; enter the ends."""
        law, nodes = self.law, lobatto(NODES)
        contacts = np.array([law.contact(scaled) for scaled in dense])  # (NODES, 4, items)
        cut = self._cut(dense, contacts[:, 2])
        if cut is not None:
            weights = rows(nodes, nodes.points[:, None] * cut)  # (m, i, n)
            both = dense.reshape(NODES, 2, self.items)
            dense = np.einsum("min,nci->mci", weights, both).reshape(NODES, -1)
            contacts = np.array([law.contact(scaled) for scaled in dense])
            ended = cut < 1.0
            self.ends[ended] = left + cut[ended] * (right - left)
        force, radius, _, load = np.moveaxis(contacts, 1, 0)
        if not np.isfinite(contacts[:, (0, 1, 3)][..., law.active]).all():
            raise law.fault(Status.NON_FINITE, f"the answer {shown(force.max())}")
        approach, rate = law.in_si(dense)
        width = (right - left) * (1.0 if cut is None else cut) * law.unit
        gained = nodes.integral @ load * width
        same = (load == force).all(axis=0)  # no tension: the impulse is the change of momentum
        gained = np.where(same, law.mass * (rate[0] - rate), gained)
        impulse = self.load_impulse + gained
        self.load_impulse = impulse[-1]
        if cut is not None:
            law.active &= ~(cut < 1.0)
        return np.stack([approach, rate, force, radius**2, load, impulse], axis=-1).swapaxes(0, 1)

    def _cut(self, dense: Array, overlap: Array) -> Array | None:
        """Return the part of the step for which each item stays in contact; None if all do."""
        self._refuse_nan(overlap)
        begun = np.logical_or.accumulate(overlap > 0.0, axis=0) | self.begun
        out = begun & ~(overlap > 0.0) & self.law.active
        self.begun |= begun[-1]
        if not out.any():
            return None
        ended, first = out.any(axis=0), out.argmax(axis=0)
        points = lobatto(NODES).points
        high = np.where(ended, points[first], 1.0)
        low = np.where(ended, points[np.maximum(first - 1, 0)], 1.0)

        def inside(scaled: Array) -> Mask:
            overlap = self.law.contact(scaled.reshape(-1))[2]
            self._refuse_nan(overlap)
            return np.asarray(overlap > 0.0)

        low, _ = _halved((low, high), dense.reshape(NODES, 2, self.items), inside)
        return np.where(ended, np.minimum(low, np.nextafter(1.0, 0.0)), 1.0)

    def _refuse_nan(self, overlap: Array) -> None:
        """Refuse overlaps that are NaN, which would compare as out of contact."""
        if np.isnan(overlap[..., self.law.active]).any():
            raise self.law.fault(Status.NON_FINITE, "the overlap nan")

    def _deep(self, scaled: Array) -> Mask:
        """Return the items that have gone deeper than any contact is."""
        return np.asarray(self.law.in_si(scaled)[0] > DEEPEST * self.law.radius)

    def _give_up(self, scaled: Array, rate_before: Array, time: float) -> None:
        """Give up contacts that do not come to an end."""
        law, rate = self.law, scaled[self.items :]
        self.turns += rate * rate_before < 0.0
        rests = (np.abs(rate) < AT_REST) & (np.abs(rate - rate_before) < AT_REST)
        lost = (self.turns > MOST_TURNS) | rests | self._deep(scaled)
        if law.steps >= MOST_STEPS:
            lost = law.active
        lost = lost & law.active
        if not lost.any():
            return
        for item in np.flatnonzero(lost).tolist():
            self.status[item] = Status.NOT_SEPARATED
            self.detail[item] = faults.sentence(
                law.law, "the bodies do not part", law.steps, time * law.unit[item]
            )
        self.ends[lost] = time
        law.active &= ~lost


def _halved(
    ends: tuple[Array, Array], values: Array, before: Callable[[Array], Mask]
) -> tuple[Array, Array]:
    """Return the ends of a part of a step, halved until they meet where ``before`` turns false.

    ``before`` is asked of ``values``, shape (NODES, ..., items), interpolated in the step.
    """
    low, high = ends
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        found = before(np.einsum("in,n...i->...i", rows(lobatto(NODES), middle), values))
        low, high = np.where(found, middle, low), np.where(found, high, middle)
    return low, high
