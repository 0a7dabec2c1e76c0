"""Steps of laws along a prescribed path, which their forces do not change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import faults, judges
from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.sampled_motion import SampledMotion
from contactlab.contracts.status import Status, Statuses
from contactlab.contracts.tangential import Increment, Sampled, SteppedTangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import lock_arrays, plain
from contactlab.numeric.types import Array, Mask, Real


class Points(NamedTuple):
    """Points of a path in SI, arrays of shape (K, ...): times since first touch, and the path."""

    time: Array
    approach: Array
    displacement: Array

    def change(self, column: Array, first: Real) -> tuple[Array, Array]:
        """Return the change of a column over each step from ``first`` on, and its rate."""
        moved, drift = (
            np.diff(column, axis=0, prepend=first),
            np.diff(self.time, axis=0, prepend=0.0),
        )
        return moved, np.divide(moved, drift, out=np.zeros_like(moved), where=drift > 0.0)


class Followed(NamedTuple):
    """Columns of a path by name, arrays of shape (K, ...), and the states of the tangential law."""

    columns: dict[str, Array]
    states: tuple[object, ...]
    status: Statuses
    detail: str


def advance_steps(
    law: SteppedTangentialLaw,
    state: object,
    before: NormalContact,
    steps: Iterable[tuple[Increment, NormalContact]],
) -> tuple[list[tuple[Real, Real, Mask]], tuple[object, ...]]:
    """Return force (N), friction work (J) and settled of each step, and the state after it.

    ``state`` and ``before`` are those at the beginning; a step has the contact at its end.
    """
    answers, states = [], []
    for step, (increment, after) in enumerate(steps, 1):
        response, state = law.advance(state, increment, before, after)
        if words := judges.wrong_response(response, np.shape(after.force)):
            raise faults.LawFaultError(Status.MALFORMED, faults.sentence(law, words, step))
        answers.append((response.force, response.friction_work, response.settled))
        states.append(state)
        before = after
    return answers, tuple(states)


def follow_path(
    normal: NormalLaw, tangential: SteppedTangentialLaw, scene: Scene, points: Points
) -> Followed:
    """Return the answers of the laws at the points of a path.

    Raises
    ------
    LawFaultError
        If a law raises, or its answer is malformed.
    """
    rate = points.change(points.approach, 0.0)[1]
    contacts = _press(normal, scene, points, rate)
    sampled = NormalContact(*(_column(rows, scene.shape) for rows in zip(*contacts, strict=True)))
    radius, load = sampled.radius, sampled.friction_load
    with np.errstate(invalid="ignore"):
        largest = np.max(np.abs(radius), axis=0), np.max(np.abs(load), axis=0)
    if words := judges.below_zero(radius, load, largest):
        raise faults.LawFaultError(Status.MALFORMED, faults.sentence(normal, words, 1))
    motion = SampledMotion(
        normal, scene, time=points.time, approach=points.approach, rate=rate, contact=sampled
    )
    with faults.blaming(tangential) as blamed:
        nothing = NormalContact(*(lock_arrays(0.0 * entry) for entry in contacts[0]))
        state = tangential.start(scene, motion)
        answers, states = advance_steps(
            tangential, state, nothing, _steps(points, rate, contacts, blamed)
        )
    force, work, settled = (_column(rows, scene.shape) for rows in zip(*answers, strict=True))
    columns = {
        "normal_force": sampled.force,
        "friction_load": sampled.friction_load,
        "contact_radius": sampled.radius,
        "friction_force": force,
        "friction_work": np.cumsum(work, axis=0),
    }
    status, detail = _judge((normal, tangential), columns, settled == 0.0)
    return Followed(columns, states, status, detail)


def _press(normal: NormalLaw, scene: Scene, points: Points, rates: Array) -> list[NormalContact]:
    """Return the normal contact at each point."""
    contacts = []
    with faults.blaming(normal) as blamed:
        state = normal.start(scene)
        rows = zip(_rows(points.approach), _rows(rates), strict=True)
        for blamed.step, (approach, rate) in enumerate(rows, 1):
            contact, state = normal.respond(state, lock_arrays(approach), lock_arrays(rate))
            complete = judges.judge_contact(normal, contact, scene.shape, blamed.step)
            contacts.append(NormalContact(*(lock_arrays(plain(entry)) for entry in complete)))
    return contacts


def _steps(
    points: Points, rates: Array, contacts: list[NormalContact], blamed: faults.blaming
) -> Iterable[tuple[Increment, NormalContact]]:
    """Iterate over the steps, and count them; the first one presses only."""
    drift = np.diff(points.time, axis=0, prepend=0.0)
    moved, velocity = points.change(points.displacement, points.displacement[:1])
    places = zip(_rows(points.approach), _rows(rates), strict=True)
    rows = zip(*(_rows(each) for each in (moved, velocity, drift)), places, contacts, strict=True)
    for blamed.step, (by, speed, time, place, after) in enumerate(rows, 1):
        # The path is prescribed, so the force acts on no body; without times, rates mean nothing.
        sampled = (
            Sampled(place[0], place[1], speed, 0.0 * speed, 0.0 * speed) if np.any(time) else None
        )
        moved_by = lock_arrays(by), lock_arrays(speed)
        yield Increment(*moved_by, after.friction_load, 0.0 * time, time, sampled), after


def _judge(
    laws: tuple[Law, Law], columns: dict[str, Array], unsettled: NDArray[np.bool_]
) -> tuple[Statuses, str]:
    """Return statuses and the sentence of the first failure; numbers after a failure are NaN."""
    normal, tangential = laws
    shape = unsettled.shape[1:]
    status = np.full(shape, Status.SUCCESS, dtype=object)
    detail = ""
    pressed = columns["normal_force"] + columns["contact_radius"] + columns["friction_load"]
    bad_contact = ~np.isfinite(pressed)
    bad_force = ~np.isfinite(columns["friction_force"] + columns["friction_work"])
    for law, bad, kind, what in (
        (normal, bad_contact, Status.NON_FINITE, "a contact that is not finite"),
        (tangential, unsettled, Status.UNSETTLED, "no division into stick and slip found"),
        (tangential, bad_force, Status.NON_FINITE, "a force that is not finite"),
    ):
        failing = bad.any(axis=0) & (status == Status.SUCCESS)
        if failing.any():
            status[failing] = kind
            step = int(bad.reshape(len(bad), -1).any(axis=1).argmax())
            detail = detail or faults.sentence(law, what, step + 1)
            lost = np.maximum.accumulate(bad, axis=0) & failing
            for rows in columns.values():
                rows[lost] = np.nan
    return (status if shape else status.item()), detail


def _column(rows: Iterable[Real], shape: tuple[int, ...]) -> Array:
    """Return rows that broadcast to ``shape`` as an array of shape (K, ...)."""
    return np.array([np.broadcast_to(row, shape) for row in rows], dtype=np.float64)


def _rows(column: Array) -> Sequence[Real] | Array:
    """Return the rows of a column: floats of one path, arrays of a batch."""
    return column.tolist() if column.ndim == 1 else np.array(column)
