"""The contacts of gatherings in a march: their records, and the end of a gathering.

Contacts may open and close any number of times. Only the kick, the first approach and the end of
the march know of them (theory §18).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    CausalTangentialLaw,
    Increment,
    NormalContact,
    NormalLaw,
    NormalMotion,
    Sampled,
    Scene,
    faults,
)
from contactlab.contracts.contacts import Contacts
from contactlab.impact.links import Links
from contactlab.numeric.types import Array, Mask, Real
from contactlab.numeric.vectors import over

#: A mask of the contacts of a batch.
Where: TypeAlias = NDArray[np.bool_]
#: Rate of approach over the largest at the start below which surfaces do not near each other, and
#: force over the greatest of a gathering from which a contact goes on. Smaller ones wait for
#: rounding: a chain of 100 took 495,000 steps for 2,445.
CLOSING, HOLDS = 1e-6, 1e-7
#: Touches of a contact, and times of the longest contact for each contact, after which a gathering
#: is given up: closing wedges never end.
MOST_TOUCHES, LONGEST = 50, 20
#: Steps before the next touch at which a free flight ends; of a whole number rounding would decide
#: which step touches.
BEFORE = 1.5
#: Halvings that find how deep a loaded contact lies; slip over the largest rate of approach from
#: which it slides.
HALVINGS, SLIDES = 60, 1e-6


class TouchingContacts:
    """The contacts of a batch of gatherings in progress.

    Attributes
    ----------
    too_often : array of bool
        True of all contacts of a gathering one of whose contacts closed too often.
    """

    def __init__(self, scene: Scene, links: Links) -> None:
        self.scene, self.links = scene, links
        none = np.zeros(scene.shape)
        self._impulse, self._moment = np.zeros((2, *scene.shape, 3))
        self._pushed, self._greatest = none, none
        self._touching = links.loaded
        self.too_often = np.zeros(scene.shape, dtype=bool)
        self._touches = links.loaded.astype(float)
        self._first = np.where(links.loaded, 0.0, math.nan)
        self._least = CLOSING * np.asarray(scene.normal_speed)
        self._holding = ~np.asarray(links.loaded)
        self._last = self._first
        # a gathering that forces push does not fly freely
        pulled = np.asarray(links.pull.any(axis=(-1, -2), keepdims=True))
        self._free, self._pulls = np.logical_not(pulled[..., 0]), bool(pulled.any())

    def after(
        self, step: Real, acting: Sequence[Real], which: Sequence[Mask], motion: Sequence[Real]
    ) -> tuple[Where, Array]:
        """Return which gatherings are not over, for each contact, and a flight in s to the next.

        ``acting`` are the forces along n, t1 and t2 of a step; ``which`` are the contacts that are
        closed and those alive; ``motion`` is time, approach and its rate at the end of the step.
        """
        closed, alive = (np.asarray(each) for each in which)
        time, approach, rate = (np.asarray(each) for each in motion)
        self._note(np.asarray(step) * alive, acting, closed, time)
        return self._end(closed, alive, approach, rate, np.asarray(step))

    def _note(self, step: Array, acting: Sequence[Real], closed: Where, time: Array) -> None:
        """Note the forces of a step."""
        impulse = step[..., None] * join(acting, self.scene.shape)
        self._impulse += impulse
        if self._pulls:
            self._moment += (self._pushed + 0.5 * step)[..., None] * impulse
            self._pushed = self._pushed + step
        met = closed & ~self._touching
        if met.any():
            self._touches = self._touches + met
            self.too_often = whole(self._touches > MOST_TOUCHES)
            self._first = np.where(met & np.isnan(self._first), time, self._first)
        self._last = np.where(closed, time, self._last)
        self._touching = closed
        self._force = np.asarray(acting[0])
        self._greatest = np.maximum(self._greatest, self._force)

    def _end(
        self, closed: Where, alive: Where, approach: Array, rate: Array, step: Array
    ) -> tuple[Where, Array]:
        """Return which gatherings are not over, and their flights.

        A gathering is over when nothing closes and no force is left; a loaded contact does not
        count.
        """
        closes = alive & (rate > self._least)
        nears = closes & ~closed
        holds = self._force > HOLDS * self._greatest.max(axis=-1, keepdims=True)
        lasts = (closed & (holds | closes) & self._holding) | nears
        on = lasts.any(axis=-1, keepdims=True) & alive
        flight = np.zeros(self.scene.shape)
        touching = closed.any(axis=-1, keepdims=True)
        if not touching.all() and (flies := on & ~touching & self._free).any():
            reach = np.where(nears, -approach / np.where(nears, rate, 1.0), math.inf)
            until = reach.min(axis=-1, keepdims=True) - BEFORE * step
            flight = np.where(flies, np.maximum(until, 0.0), 0.0)
        return on, flight

    def tell(self, late: Mask) -> str:
        """Return why a gathering was given up, with the touches of each contact."""
        first = int(np.flatnonzero(late)[0]) // self.scene.shape[-1]
        times = self._touches.reshape(-1, self.scene.shape[-1])[first]
        held = self._touching.reshape(-1, self.scene.shape[-1])[first]
        return tell_still_closing(times, held, not self._free.all())

    def tell_contacts(self, dissipation: Real) -> Contacts:
        """Return the record of the contacts."""
        return Contacts(
            impulse=self._impulse,
            moment=self._moment,
            pushed=self._pushed,
            touches=self._touches,
            first=self._first,
            last=self._last,
            dissipation=np.broadcast_to(dissipation, self.scene.shape) + 0.0,
        )

    def lay(
        self,
        laws: tuple[NormalLaw, CausalTangentialLaw],
        normal: NormalMotion,
        states: tuple[object, object],
        step: Real,
        *,
        shares: bool,
    ) -> tuple[Array, NormalContact, Any]:
        """Return approach, contact and springs where loaded contacts carry the constant forces.

        The springs of a contact that rolls are without tension, those of one that slides at their
        limit along its slip: both by two steps of the tangential law itself.
        """
        (law, tangential), (memory, state) = laws, states
        links, scene = self.links, self.scene
        zero = np.zeros(scene.shape)
        load = np.maximum(links.pull[..., 0], 0.0) * scene.pair.normal_mass * links.loaded
        low, high = zero, zero + 2.0 * np.asarray(normal.maximum_approach)
        with faults.blaming(law):
            while np.any(pressing(law, memory, high) < load):
                high = 2.0 * high
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                more = pressing(law, memory, middle) > load
                low, high = np.where(more, low, middle), np.where(more, middle, high)
            approach = np.where(links.loaded, high, -links.gap)
            lies, _ = law.respond(memory, approach, zero)
        lies = lies.complete
        slip = links.velocity[..., 1:]
        speed = np.hypot(slip[..., 0], slip[..., 1])[..., None]
        slides = speed > SLIDES * np.asarray(scene.normal_speed)[..., None]
        along = np.where(slides, slip / np.where(slides, speed, 1.0), 0.0)
        reach = along * (scene.friction_coefficient * lies.radius * links.loaded)[..., None]
        before = NormalContact(zero, zero, zero, zero)
        for moved in (0.0 * reach, reach):
            still = 0.0 * reach
            sampled = Sampled(approach, zero, still, still, zero) if shares else None
            increment = Increment(moved, still, lies.friction_load, step, step, sampled)
            _, state = tangential.advance(state, increment, before, lies)
            before = lies
        return approach, lies, state


def most_steps(scene: Scene, duration: Real, step: Real) -> Real:
    """Return the steps after which a gathering is given up, without flights."""
    longest = np.max(over(np.asarray(duration), scene.shape), axis=-1, keepdims=True)
    most: Real = LONGEST * scene.shape[-1] * np.ceil(longest / step)
    return most


def tell_still_closing(touches: Array, held: Where, pulled: bool) -> str:
    """Return the sentence on a gathering that is given up, by its contacts; some may be held."""
    times, closed = touches.astype(int).tolist(), np.flatnonzero(held).tolist()
    sentence = f"The contacts still close after {LONGEST} contact times each; touches: {times}."
    if closed and pulled:
        still = ", ".join(f"touches[{k}]" for k in closed)
        sentence += f" A force may keep {still} shut: loaded=True says so."
    return sentence


def pressing(law: NormalLaw, memory: object, approach: Array) -> Real:
    """Return the force in N of contacts at rest."""
    return law.respond(memory, approach, np.zeros(approach.shape))[0].force


def join(components: Sequence[Real], shape: tuple[int, ...]) -> Array:
    """Return vectors along n, t1 and t2 by their components; ``np.stack`` takes longer."""
    vectors = np.empty((*shape, 3))
    for k, each in enumerate(components):
        vectors[..., k] = each
    return vectors


def whole(where: Mask) -> Where:
    """Return the gatherings with a contact that is marked, for each of their contacts."""
    return np.broadcast_to(np.any(where, axis=-1, keepdims=True), np.shape(where))
