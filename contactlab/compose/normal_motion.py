"""The normal motion of any normal law, made once: in closed form, or solved to ``TOLERANCE``."""

from __future__ import annotations

import math

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
from contactlab.numeric.runge_kutta import attempt

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: Error of approach, rate and load impulse in a step, over their scales: far below what
#: integrators of the tangential motion aim at by default, so that the normal motion is not what
#: limits them.
TOLERANCE = 1e-11
#: First step over the duration of a Hertz impact; the next ones follow the error.
FIRST_STEP = 1e-4
#: Steps after which a contact is given up, those tried in vain among them.
MOST_STEPS = 20_000
#: A contact in which the rate has changed its sign so often without separation is given up:
#: adhesion holds the bodies.
MOST_TURNS = 20
#: A contact is given up too if it is deeper than this over R, or if the bodies rest: the rate over
#: v1, and what the force would change of it in the time since first touch.
DEEPEST, AT_REST = 1e6, 1e-9
#: Over the time since first touch: an event this close to an end of a step is at that end.
NEAR = 1e-11
#: Halvings of the part of a step that holds an event.
HALVINGS = 60
#: Error over the tolerance up to which a step that failed tells where an event is.
TRUSTED = 1e8
#: The next step ends before such an event: by this many times the error over the width of the step
#: that failed, as a part of the way, and by no more than that part.
DOUBT, MOST_DOUBT = 10.0, 0.1
#: A step is this much shorter than its error allows, and changes by no more than these factors.
SAFETY, SHRINKAGE, GROWTH = 0.9, 0.2, 10.0
#: Over the time since first touch: a step so short is lost in rounding.
SHORTEST = 1e-15


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


class _Solver:
    """The solution of the normal motions of a batch; each impact takes steps of its own.

    A step ends where the rate changes its sign, where the friction load vanishes or appears, and
    where contact ends: a law often has a kink there, and no polynomial of the table runs over it.

    Attributes
    ----------
    law : ScaledNormalLaw
    place : array, shape (3, items)
        Scaled approach, rate and load impulse where each impact is.
    time : array, shape (items,)
        Since first touch, scaled.
    width : array, shape (items,)
        Of the next step, as its error allows.
    event : array, shape (items,)
        How far the next event is; infinite if none is known.
    begun : array of bool, shape (items,)
        Impacts that have been in contact: only those can end it.
    turns : array, shape (items,)
        Changes of sign of the rate so far.
    tried : int
        Steps so far, those tried in vain among them.
    """

    def __init__(self, law: NormalLaw, scene: Scene) -> None:
        self.law = ScaledNormalLaw(law, scene)
        self.items = items = self.law.items
        self.place = np.zeros((3, items))
        self.place[1] = 1.0
        self.time, self.turns = np.zeros(items), np.zeros(items)
        self.width, self.event = np.full(items, FIRST_STEP), np.full(items, math.inf)
        self.begun, self.tried = np.zeros(items, dtype=bool), 0
        self.status = np.full(items, Status.SUCCESS, dtype=object)
        self.detail = np.full(items, "", dtype=object)

    def solve(self) -> SolvedMotion:
        """Return the motion."""
        law, steps = self.law, [self._step()]
        while law.active.any():
            step = self._step()
            if step[0].any():
                steps.append(step)
        widths, values = (np.stack(column, axis=1) for column in zip(*steps, strict=True))
        # The steps that an item took come first, those that it tried in vain are dropped.
        vain = widths == 0.0
        most = max(int((~vain).sum(axis=1).max()), 1)
        order = np.argsort(vain, axis=1, kind="stable")[:, :most]
        widths = np.take_along_axis(widths, order, axis=1)
        table = MotionTable.made(
            shape=law.shape,
            edges=np.concatenate((np.zeros((self.items, 1)), np.cumsum(widths, axis=1)), axis=1),
            unit=law.unit,
            values=np.take_along_axis(values, order[..., None, None], axis=1),
            status=self.status,
            detail=self.detail,
        )
        return SolvedMotion(law.law, law.scene, table)

    def _step(self) -> tuple[Array, Array]:
        """Try a step of every item in contact.

        Returns
        -------
        widths : array, shape (items,)
            Of the steps taken; 0 where one missed the tolerance, or ran over an event.
        columns : array, shape (items, NODES, 6)
            Of the table.
        """
        law, points = self.law, lobatto(NODES).points
        self.tried += 1
        law.time = float((self.time * law.unit).max())
        width = np.where(law.active, np.minimum(self.width, self.event), 0.0)
        tried = attempt(law.slope, self.place, width, tolerance=TOLERANCE, points=points)
        good = law.active & (tried.error <= 1.0)
        course, contacts = tried.course, self._contacts(tried.course)
        self._refuse_nan(contacts[:, 2], good)
        doubt = _doubt(tried.error, width)
        until, ended = self._until(course, contacts, width, doubt)
        close = NEAR * (self.time + width)
        taken = good & (width * (1.0 - until) <= close)
        ended &= taken | (width * until <= close)  # contact ends in this step, or as it begins
        taken |= ended
        sure = np.where(until < 1.0, until * (1.0 - doubt), 1.0)
        self._plan(tried.error, width, sure, taken)
        widths = np.where(taken, width, 0.0)
        if ended.any():
            widths = np.where(ended, until * width, widths)
            weights = rows(lobatto(NODES), points[:, None] * np.where(ended, until, 1.0))
            course = np.einsum("min,nci->mci", weights, course)
            contacts = self._contacts(course)
        if not np.isfinite(contacts[:, (0, 1, 3)][..., taken]).all():
            raise law.fault(Status.NON_FINITE, f"the answer {shown(contacts[:, 0].max())}")
        columns = self._columns(course, contacts)
        self.time = self.time + widths
        self.begun |= taken & (contacts[:, 2] > 0.0).any(axis=0)
        law.active &= ~ended
        rate, self.place = self.place[1], np.where(taken, course[-1], self.place)
        if taken.any():
            law.steps += 1
            law.remember(self.place)
        self._give_up(rate, contacts[-1, 0], taken)
        return widths, np.where(taken[:, None, None], columns, columns[:, :1])

    def _contacts(self, course: Array) -> Array:
        """Return force, radius, overlap and load along a step, shape (NODES, 4, items)."""
        return np.array([self.law.contact(here) for here in course])

    def _until(
        self, course: Array, contacts: Array, width: Array, doubt: Array
    ) -> tuple[Array, Mask]:
        """Return the part of a step before its first event, and whether that is the end of contact.

        Parameters
        ----------
        course : array, shape (NODES, 3, items)
        contacts : array, shape (NODES, 4, items)
        width : array, shape (items,)
        doubt : array, shape (items,)
            Of the way to the event, as a part of it; 1 where the step tells of no event.
        """
        law, points = self.law, lobatto(NODES).points
        trusted = law.active & (doubt < 1.0)
        close = NEAR * (self.time + width)
        # What was an event of the step before is none of this one: it is judged from here on.
        start = np.minimum(close / np.where(width > 0.0, width, close), 1.0)
        here = _between(course, start)
        _, _, overlap, load = law.contact(here)
        self._refuse_nan(overlap, trusted)
        left = trusted & self.begun & ~(overlap > 0.0)
        begun, rate, loaded = self.begun | (overlap > 0.0), here[1], load > 0.0

        def quiet(rates: Array, overlaps: Array, loads: Array) -> Mask:
            same = ~(rates * rate < 0.0) & ((loads > 0.0) == loaded)
            return np.asarray(same & ((overlaps > 0.0) | ~begun))

        calm = quiet(course[:, 1], contacts[:, 2], contacts[:, 3])
        calm |= (points[:, None] <= start) | ~trusted
        first = (~calm).argmax(axis=0)
        found = ~calm.all(axis=0) & ~left
        high = np.where(found, points[first], 1.0)
        low = np.where(found, np.maximum(points[np.maximum(first - 1, 0)], start), 1.0)
        out = begun & ~(contacts[first, 2, np.arange(self.items)] > 0.0)
        for _ in range(HALVINGS):
            # Each item is halved as often as it would be alone.
            wide = (high - low) * width > 0.1 * np.maximum(close, doubt * low * width)
            if not wide.any():
                break
            middle = np.where(wide, 0.5 * (low + high), low)
            here = _between(course, middle)
            _, _, overlap, load = law.contact(here)
            self._refuse_nan(overlap, wide)
            before = quiet(here[1], overlap, load)
            low = np.where(before & wide, middle, low)
            high = np.where(~before & wide, middle, high)
            out = np.where(~before & wide, begun & ~(overlap > 0.0), out)
        return np.where(left, 0.0, low), left | (found & out)

    def _plan(self, error: Array, width: Array, until: Array, taken: Mask) -> None:
        """Set the width of the next step of each item, and how far its next event is.

        Parameters
        ----------
        error : array, shape (items,)
            Of the step tried, over the tolerance; NaN of a force that is not finite.
        width, until : array, shape (items,)
            Of the step tried, and the part of it that is surely before an event; 1 without one.
        taken : array of bool, shape (items,)
        """
        active, missed, before = self.law.active, ~(error <= 1.0), until < 1.0
        # The eighth root by square roots: a power may depend on what stands beside it in an array.
        root = np.sqrt(np.sqrt(np.sqrt(np.where(np.isnan(error), math.inf, error))))
        factor = SAFETY / np.maximum(root, SAFETY / GROWTH)
        # A step cut short by an event, or one that failed over it, tells nothing of others.
        changes = active & np.where(missed, ~before, width == self.width)
        self.width = np.where(changes, width * np.clip(factor, SHRINKAGE, GROWTH), self.width)
        self.event = np.where(before & ~taken, until * width, math.inf)
        if (active & ~taken & (self.width <= SHORTEST * self.time)).any():
            if self.law.finite:
                raise self.law.fault(Status.UNRESOLVED, "steps became too short")
            raise self.law.fault(Status.NON_FINITE, "a force that is not finite")

    def _columns(self, course: Array, contacts: Array) -> Array:
        """Return the columns of the table in one step; enter the impulses in ``course``."""
        law = self.law
        force, radius, _, load = np.moveaxis(contacts, 1, 0)
        same = (load == force).all(axis=0)  # no tension: the impulse is the change of momentum
        impulse = np.where(same, course[0, 2] + (course[0, 1] - course[:, 1]), course[:, 2])
        course[:, 2] = np.maximum.accumulate(impulse, axis=0)
        approach, rate = law.in_si(course)
        impulse = course[:, 2] * law.momentum
        return np.stack([approach, rate, force, radius**2, load, impulse], axis=-1).swapaxes(0, 1)

    def _refuse_nan(self, overlap: Array, where: Mask) -> None:
        """Refuse overlaps that are NaN, which would compare as out of contact."""
        if np.isnan(overlap[..., where]).any():
            raise self.law.fault(Status.NON_FINITE, "the overlap nan")

    def _give_up(self, rate_before: Array, force: Array, taken: Mask) -> None:
        """Give up contacts that do not come to an end.

        Parameters
        ----------
        rate_before : array, shape (items,)
            Before the last step.
        force : array, shape (items,)
            After it, in N.
        taken : array of bool, shape (items,)
            Items that took it.
        """
        law, rate = self.law, self.place[1]
        self.turns += rate * rate_before < 0.0
        gained = force * law.response * self.time
        rests = (np.abs(rate) < AT_REST) & (np.abs(gained) < AT_REST)
        deep = law.in_si(self.place)[0] > DEEPEST * law.radius
        lost = taken & ((self.turns > MOST_TURNS) | rests | deep)
        if self.tried >= MOST_STEPS:
            lost = law.active
        lost = lost & law.active
        for item in np.flatnonzero(lost).tolist():
            self.status[item] = Status.NOT_SEPARATED
            self.detail[item] = faults.sentence(
                law.law, "the bodies do not part", law.steps, self.time[item] * law.unit[item]
            )
        law.active &= ~lost


def _between(course: Array, fraction: Array) -> Array:
    """Return the values, shape (3, items), at a fraction of each item's step."""
    return np.asarray((rows(lobatto(NODES), fraction).T[:, None] * course).sum(axis=0))


def _doubt(error: Array, width: Array) -> Array:
    """Return how far off an event may be, over the way to it; 1 where nothing can be told."""
    blur = DOUBT * TOLERANCE * error / np.where(width > 0.0, width, 1.0)
    return np.where(error <= 1.0, 0.0, np.where(error < TRUSTED, np.minimum(blur, MOST_DOUBT), 1.0))
