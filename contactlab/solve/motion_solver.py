"""The normal motions of many impacts, each in steps of its own, to ``normal_steps.TOLERANCE``."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import faults, judges
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import quote
from contactlab.numeric.lobatto import lobatto, rows
from contactlab.numeric.runge_kutta import attempt
from contactlab.numeric.types import Array
from contactlab.solve import normal_steps as rule
from contactlab.solve.scaled_normal_law import ScaledNormalLaw
from contactlab.solve.solved_motion import NODES, MotionTable, SolvedMotion

Mask = NDArray[np.bool_]


class Solver:
    """The solver of the normal motions of a batch; each impact has its own steps.

    Steps end at events: the rate changes sign, the friction load vanishes or appears, or contact
    ends. A law often has a kink at an event, and no polynomial of the table spans a kink.

    Attributes
    ----------
    law : ScaledNormalLaw
    place : array, shape (3, items)
        Present scaled approach, rate and load impulse.
    time : array, shape (items,)
        Scaled time since first touch.
    width : array, shape (items,)
        Width of the next step that the error allows.
    event : array, shape (items,)
        Scaled time until the next event; infinite if no event is located.
    begun : array of bool, shape (items,)
        True for impacts that have had contact: before, contact cannot end.
    turns : array, shape (items,)
        Sign changes of the rate so far.
    tried : int
        Steps so far, rejected steps included.
    """

    def __init__(self, law: NormalLaw, scene: Scene) -> None:
        self.law = ScaledNormalLaw(law, scene)
        self.items = items = self.law.items
        self.place = np.zeros((3, items))
        self.place[1] = 1.0
        self.time, self.turns = np.zeros(items), np.zeros(items)
        self.width, self.event = np.full(items, rule.FIRST_STEP), np.full(items, math.inf)
        self.begun, self.tried = np.zeros(items, dtype=bool), 0
        self.status = np.full(items, Status.SUCCESS, dtype=object)
        self.detail = np.full(items, "", dtype=object)

    def solve(self) -> SolvedMotion:
        """Return the solved motion of all impacts."""
        law, steps = self.law, [self._step()]
        while law.active.any():
            step = self._step()
            if step[0].any():
                steps.append(step)
        widths, values = (np.stack(column, axis=1) for column in zip(*steps, strict=True))
        # Accepted steps of each item come first; rejected steps are dropped.
        rejected = widths == 0.0
        most = max(int((~rejected).sum(axis=1).max()), 1)
        order = np.argsort(rejected, axis=1, kind="stable")[:, :most]
        widths = np.take_along_axis(widths, order, axis=1)
        table = MotionTable.make(
            shape=law.shape,
            edges=np.concatenate((np.zeros((self.items, 1)), np.cumsum(widths, axis=1)), axis=1),
            unit=law.unit,
            values=np.take_along_axis(values, order[..., None, None], axis=1),
            status=self.status,
            detail=self.detail,
        )
        return SolvedMotion(law.law, law.scene, table)

    def _step(self) -> tuple[Array, Array]:
        """Try a step; return widths, 0 if rejected, and the table's columns (items, NODES, 6)."""
        law, points = self.law, lobatto(NODES).points
        self.tried += 1
        law.time = float((self.time * law.unit).max())
        width = np.where(law.active, np.minimum(self.width, self.event), 0.0)
        tried = attempt(law.slope, self.place, width, tolerance=rule.TOLERANCE, points=points)
        good = law.active & (tried.error <= 1.0)
        course, contacts = tried.course, self._contacts(tried.course)
        self._refuse_nan(contacts[:, 2], good)
        doubt = rule.doubt(tried.error, width)
        until, ended = self._until(course, contacts, width, doubt)
        close = rule.NEAR * (self.time + width)
        # A step is rejected if it misses the tolerance or spans an event.
        taken = good & (width * (1.0 - until) <= close)
        ended &= taken | (width * until <= close)  # contact ends in this step, or at its beginning
        taken |= ended
        self._plan(tried.error, width, rule.sure_part(until, doubt), taken)
        widths = np.where(taken, width, 0.0)
        if ended.any():
            widths = np.where(ended, until * width, widths)
            weights = rows(lobatto(NODES), points[:, None] * np.where(ended, until, 1.0))
            course = np.einsum("min,nci->mci", weights, course)
            contacts = self._contacts(course)
        if not np.isfinite(contacts[:, (0, 1, 3)][..., taken]).all():
            raise law.fault(Status.NON_FINITE, f"the answer {quote(contacts[:, 0].max())}")
        if not np.isfinite(contacts[0, [0, 3]][:, law.active]).all():
            raise law.fault(Status.NON_FINITE, f"the answer {quote(contacts[0, 3].max())}")
        largest = law.radius[taken], 1.0 / law.response[taken]
        if words := judges.below_zero(contacts[:, 1, taken], contacts[:, 3, taken], largest):
            raise law.fault(Status.MALFORMED, words)
        columns = self._columns(course, contacts)
        self.time = self.time + widths
        self.begun |= taken & (contacts[:, 2] > 0.0).any(axis=0)
        law.active &= ~ended
        rate, self.place = self.place[1], np.where(taken, course[-1], self.place)
        if taken.any():
            law.steps += 1
            law.remember(self.place)
        self._abandon(rate, contacts[-1, 0], taken)
        return widths, np.where(taken[:, None, None], columns, columns[:, :1])

    def _contacts(self, course: Array) -> Array:
        """Return force, radius, overlap and load along a step, shape (NODES, 4, items)."""
        return np.array([self.law.contact(place) for place in course])

    def _until(
        self, course: Array, contacts: Array, width: Array, doubt: Array
    ) -> tuple[Array, Mask]:
        """Return the fraction of a step before its first event, and True if contact ends there."""
        law, points = self.law, lobatto(NODES).points
        trusted = law.active & (doubt < 1.0)
        close = rule.NEAR * (self.time + width)
        # The search begins just after the step does, so that the last step's event is not repeated.
        start = np.minimum(close / np.where(width > 0.0, width, close), 1.0)
        place = _between(course, start)
        _, _, overlap, load = law.contact(place)
        self._refuse_nan(overlap, trusted)
        left = trusted & self.begun & ~(overlap > 0.0)
        begun, rate, loaded = self.begun | (overlap > 0.0), place[1], load > 0.0

        def quiet(rates: Array, overlaps: Array, loads: Array) -> Mask:
            unchanged = ~(rates * rate < 0.0) & ((loads > 0.0) == loaded)
            return np.asarray(unchanged & ((overlaps > 0.0) | ~begun))

        calm = quiet(course[:, 1], contacts[:, 2], contacts[:, 3])
        calm |= (points[:, None] <= start) | ~trusted
        first = (~calm).argmax(axis=0)
        eventful = ~calm.all(axis=0) & ~left
        high = np.where(eventful, points[first], 1.0)
        low = np.where(eventful, np.maximum(points[np.maximum(first - 1, 0)], start), 1.0)
        out = begun & ~(contacts[first, 2, np.arange(self.items)] > 0.0)
        for _ in range(rule.HALVINGS):
            # The number of halvings of an item does not depend on the other items.
            wide = (high - low) * width > 0.1 * np.maximum(close, doubt * low * width)
            if not wide.any():
                break
            middle = np.where(wide, 0.5 * (low + high), low)
            place = _between(course, middle)
            _, _, overlap, load = law.contact(place)
            self._refuse_nan(overlap, wide)
            before = quiet(place[1], overlap, load)
            low = np.where(before & wide, middle, low)
            high = np.where(~before & wide, middle, high)
            out = np.where(~before & wide, begun & ~(overlap > 0.0), out)
        return np.where(left, 0.0, low), left | (eventful & out)

    def _plan(self, error: Array, width: Array, sure: Array, taken: Mask) -> None:
        """Set ``width`` and ``event`` of the next step from the error and width of this one."""
        # ``error`` is over the tolerance, NaN if a force is not finite; ``sure`` is the fraction
        # of the step that is surely before an event.
        # The eighth root by square roots: the last bit of a power depends on the array around it.
        root = np.sqrt(np.sqrt(np.sqrt(np.where(np.isnan(error), math.inf, error))))
        new = rule.next_width(width, rule.SAFETY / np.maximum(root, rule.LEAST_ROOT))
        active, missed = self.law.active, ~(error <= 1.0)
        self.width = np.where(
            active & rule.sets_width(missed, sure, width, self.width), new, self.width
        )
        self.event = rule.next_event(width, sure, ~taken)
        if (active & ~taken & (self.width <= rule.SHORTEST * self.time)).any():
            raise rule.too_short(self.law)

    def _columns(self, course: Array, contacts: Array) -> Array:
        """Return the table's columns for one step, and write load impulses into ``course``."""
        law = self.law
        force, radius, _, load = np.moveaxis(contacts, 1, 0)
        # Without tension the load impulse is the change of momentum.
        pressed = (load == force).all(axis=0)
        impulse = np.where(pressed, course[0, 2] + (course[0, 1] - course[:, 1]), course[:, 2])
        course[:, 2] = np.maximum.accumulate(impulse, axis=0)
        approach, rate = law.in_si(course)
        impulse = course[:, 2] * law.momentum
        return np.stack([approach, rate, force, radius**2, load, impulse], axis=-1).swapaxes(0, 1)

    def _refuse_nan(self, overlap: Array, where: Mask) -> None:
        """Refuse overlaps that are NaN: a comparison would take them for the end of contact."""
        if np.isnan(overlap[..., where]).any():
            raise self.law.fault(Status.NON_FINITE, "the overlap nan")

    def _abandon(self, rate_before: Array, force: Array, taken: Mask) -> None:
        """Abandon contacts that do not end, from rates before the last step and forces after it."""
        law, rate = self.law, self.place[1]
        self.turns += rate * rate_before < 0.0
        change, approach = force * law.response * self.time, law.in_si(self.place)[0]
        abandoned = taken & rule.is_endless(self.turns, rate, change, approach, law.radius)
        if self.tried >= rule.MOST_STEPS:
            abandoned = law.active
        abandoned = abandoned & law.active
        for item in np.flatnonzero(abandoned).tolist():
            self.status[item] = Status.NOT_SEPARATED
            self.detail[item] = faults.sentence(
                law.law, "the bodies do not separate", law.steps, self.time[item] * law.unit[item]
            )
        law.active &= ~abandoned


def _between(course: Array, fraction: Array) -> Array:
    """Return the values, shape (3, items), at a fraction of each item's step."""
    return np.asarray((rows(lobatto(NODES), fraction).T[:, None] * course).sum(axis=0))
