"""Even steps in which normal and friction law march together (theory §14).

Half a drift, a kick by the forces in the middle, half a drift. The slip is marched as components,
so that single impacts are plain numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    CausalTangentialLaw,
    Ends,
    Increment,
    NormalContact,
    NormalLaw,
    NormalMotion,
    Observer,
    Sample,
    Sampled,
    Scene,
    TangentialMotion,
    TangentialResponse,
    faults,
    judges,
    shares_loss,
)
from contactlab.contracts.status import Details, Status, Statuses
from contactlab.impact import kinetics
from contactlab.numeric.arrays import choose, lock_arrays, some, spread_object
from contactlab.numeric.types import Mask, Real
from contactlab_laws.march import coupled_steps
from contactlab_laws.march.contacts import TouchingContacts, join, whole
from contactlab_laws.march.coupled_steps import DEEPEST, TOO_DEEP, Division, divide, tell_too_long

#: Turns from parting to approach, made by tension, after which a contact is given up: adhesion
#: holds the bodies together. An approach alone is given up after as many. None of 400 random rods
#: that parted under JKR and DMT had been pulled back once.
MOST_PULLS = 10
#: Turns in which a step solves for rates at which its forces act, where forces depend on rates.
TURNS = 3


def march_coupled(
    scene: Scene,
    normal: NormalMotion,
    law: CausalTangentialLaw,
    count: Real,
    observer: Observer | None,
    refused: tuple[Status, str | NDArray[np.object_]] = (Status.TOO_FEW_STEPS, ""),
    usual: float = math.inf,
) -> TangentialMotion:
    """Return the motion in ``count`` steps an approach without friction, one for each impact.

    An impact whose count is infinite is not followed; ``refused`` is its status, with detail. One
    whose approach without friction has no end is followed as long as in ``usual`` steps at most.
    """
    possible = np.isfinite(count)
    if not some(possible):
        return TangentialMotion.nothing(scene.shape, *refused, axes=kinetics.slip_axes(scene))
    divided = divide(scene, normal, count, usual)
    if observer is None:
        from contactlab_laws.springs import compiled  # for springs alone

        motion = compiled.march(scene, normal, law, divided, refused)
        if motion is not None:
            return motion
    march = _March(scene, normal, law, divided)
    if not np.all(possible):
        left_out = ~np.broadcast_to(possible, scene.shape)
        march.fail(refused[0], np.broadcast_to(refused[1], scene.shape)[left_out], left_out)
        march.alive &= ~left_out
    return march.run(observer)


def _nearer(tried: list[tuple[Real, Real]], answer: Real) -> Real:
    """Return the rate of approach to try next, and note it; ``answer`` belongs to the last one.

    The rate that reproduces itself is sought by secants: a dashpot answers a rate by so much less
    of it that the plain iteration may run away.
    """
    rate = answer
    if len(tried) > 1:
        (before, _), (last, first) = tried[-2:]
        change = last - before
        # a rate that no longer changes is the solution: no division by zero
        slope = np.minimum((answer - first) / (change + (change == 0.0)), 0.0)
        rate = last + (answer - last) / (1.0 - slope)
    tried.append((rate, answer))
    return rate


class _March:
    """The impacts of a batch in progress."""

    def __init__(
        self,
        scene: Scene,
        normal: NormalMotion,
        law: CausalTangentialLaw,
        divided: Division,
    ) -> None:
        self.scene, self.normal, self.law, self.shape = scene, normal, law, scene.shape
        self.axes = 1 if scene.planar else 2
        plain = not scene.shape

        def entry(value: Real) -> Real:
            return float(value) if plain else np.array(np.broadcast_to(value, scene.shape))

        self.step, self.leading, self.longest, self.most = map(entry, divided)
        self.links, self.contacts = scene.links, None
        if self.links is not None:
            self.contacts = TouchingContacts(scene, self.links)
        W = scene.inverse_mass
        assert W is not None
        size = 1 + self.axes
        self.W = [[entry(W[..., i, j]) for j in range(size)] for i in range(size)]
        slip = np.asarray(scene.slip_velocity)
        sides = [slip] if scene.planar else [slip[..., 0], slip[..., 1]]
        speed: Real = scene.normal_speed if self.links is None else self.links.velocity[..., 0]
        self.before = [entry(each) for each in (speed, *sides)]
        self.change: list[Any] = [0.0 * each for each in self.before]
        zero = self.change[0]
        self.elastic = "elastic_hertz" in normal.claims
        self.shares = shares_loss(law, normal.law)
        self.work, self.loss, self.duration, self.shear = zero, zero, zero, zero
        self.greatest: list[Any] = [zero, zero, zero]
        self.pulls: Any = zero
        self.compressions: Any = 1 if plain else np.ones(scene.shape, dtype=int)
        self.alive: Any = True if plain else np.ones(scene.shape, dtype=bool)
        self.steps = 0
        self.status: Statuses = spread_object(Status.SUCCESS, scene.shape)
        self.detail: Details = spread_object("", scene.shape)

    def run(self, observer: Observer | None) -> TangentialMotion:
        """Return the motion to the end of contact of all impacts."""
        try:
            self._follow(observer)
            jammed = self.greatest[1] > DEEPEST**0.4 * np.asarray(self.normal.maximum_approach)
            if np.any(jammed):
                self.fail(Status.UNRESOLVED, TOO_DEEP, jammed)
        except KeyboardInterrupt:
            raise
        except faults.LawFaultError as fault:
            self.fail(fault.status, fault.detail, self.alive)
        except BaseException as error:  # a plug-in may not end the process
            sentence = faults.sentence(self.law, faults.tell_error(error, self.law), self.steps)
            self.fail(Status.LAW_RAISED, sentence, self.alive)
        return self._motion()

    def _follow(self, observer: Observer | None) -> None:
        law = self.law
        alone: NormalLaw = self.normal.law  # type: ignore[assignment]
        central = self.normal.scene
        with faults.blaming(alone):
            memory = alone.start(central)
        state = law.begin(central, self.normal, vectors=self.axes == 2)
        velocity = self.before
        zero = self.change[0]
        contact = NormalContact(zero, zero, zero, zero)
        time, approach = zero, zero
        if self.contacts is not None:
            approach = -self.contacts.links.gap
            if np.any(self.contacts.links.loaded):
                approach, contact, state = self.contacts.lay(
                    (alone, law), self.normal, (memory, state), self.step, shares=self.shares
                )
        pressure, force = contact.force, [zero] * self.axes
        step = zero  # of the step before
        many = bool(self.shape)  # a law may not change an array of many impacts
        while True:
            half, step = 0.5 * step, self._width()
            drift = half + 0.5 * step
            self.steps += 1
            time = time + drift
            approach = approach + velocity[0] * drift
            before = contact
            drifting = velocity[0]
            moved = self._join([each * drift for each in velocity[1:]])
            start = self._join(velocity[1:])
            if self.axes == 2 or many:
                lock_arrays(moved), lock_arrays(start)
            # forces that depend on rates act on those in the middle of their kick
            tried: list[tuple[Any, Any]] = []
            for _ in range(1 if self.elastic else TURNS):
                at = velocity
                if not self.elastic:
                    kick = self._kick(pressure, force, step)
                    at = [v - 0.5 * k for v, k in zip(velocity, kick, strict=True)]
                    at[0] = _nearer(tried, at[0])
                if many:
                    lock_arrays(approach), lock_arrays(at[0])
                with faults.blaming(alone) as blamed:
                    blamed.step = self.steps
                    contact, new = alone.respond(memory, approach, at[0])
                    contact = judges.judge_contact(alone, contact, self.shape, self.steps)
                    for entry in contact if many else ():
                        lock_arrays(entry)
                load, sampled = contact.friction_load, None
                if self.shares:
                    sampled = self._sample(approach, at, force, step)
                increment = Increment(moved, start, load, step, drift, sampled)
                response, after = law.advance(state, increment, before, contact)
                pressure, force = contact.force, self._components(response)
            state, memory = after, new
            least = np.minimum(contact.radius, load) if many else min(contact.radius, load)
            if np.any((least < 0.0) & self.alive) if many else least < 0.0:
                self._refuse_below_zero(contact)
            if response.settled is not True and not np.all(response.settled):
                force = self._leave_unanswered_out(response.settled, force)
                if not np.any(self.alive):
                    return None
            touching = contact.overlap > 0.0
            going = touching & self.alive if self.shape else touching
            kick = self._kick(pressure * touching, [each * touching for each in force], step)
            if self.shape:
                kick = [each * self.alive for each in kick]
            middle = [v - 0.5 * k for v, k in zip(velocity, kick, strict=True)]
            if not self.elastic:
                self.loss = self.loss + contact.force * middle[0] * step * going
            self.work = self.work + response.friction_work * self.alive
            self.shear = self.shear + response.shear_loss * self.alive
            if observer is not None:
                seen = self._join(middle[1:]), self._join(force)
                fields = partial(law.fields, state)
                observer(Sample(time, approach, middle[0], contact, *seen, fields))
            self.change = [c - k for c, k in zip(self.change, kick, strict=True)]
            velocity = [v + c for v, c in zip(self.before, self.change, strict=True)]
            reached = (contact.radius, approach, contact.force)
            self.greatest = [
                np.maximum(most, now * going)
                for most, now in zip(self.greatest, reached, strict=True)
            ]
            again = going & (velocity[0] > 0.0) & (velocity[0] + kick[0] <= 0.0)
            self.compressions = self.compressions + again
            self.duration = self.duration + step * going
            if self.contacts is not None:
                acting = (pressure * touching, *(each * touching for each in force))
                flown = self.contacts.after(
                    step, acting, (going, self.alive), (time, approach, velocity[0])
                )
                going, flight = flown
                time, approach = time + flight, approach + velocity[0] * flight
            elif self.elastic and (self.shape or not touching):
                self._note_parting(self.alive & np.logical_not(touching), time, approach, drifting)
            self.alive = going
            if not self.elastic and np.any(again):
                self._count_turns(again & (contact.force < 0.0))
            if not (self.alive.any() if self.shape else self.alive):
                return None
            if not np.isfinite(sum(velocity)).all():
                sentence = faults.sentence(law, "velocity is not finite", self.steps)
                return self.fail(Status.NON_FINITE, sentence, self.alive)
            late = (self.steps >= self.most) & self.alive
            if self.contacts is not None:
                late = late | (self.contacts.too_often & self.alive)
            if np.any(late):
                self._give_up(late)
                if not np.any(self.alive):
                    return None

    def _note_parting(self, parted: Mask, time: Real, approach: Real, rate: Real) -> None:
        """Note when surfaces of an elastic contact parted: between two steps, at a known rate."""
        if np.any(parted):
            crossed = time - approach / choose(parted, rate, 1.0)
            self.duration = choose(parted, crossed, self.duration)

    def _count_turns(self, back: Mask) -> None:
        """Count turns that tension made, and give up impacts that had too many."""
        self.pulls = self.pulls + back
        held = self._whole(self.pulls >= MOST_PULLS)
        if np.any(held):
            sentence = f"Adhesion holds the bodies: it pulled them back {MOST_PULLS} times."
            self.fail(Status.NOT_SEPARATED, sentence, held & self.alive)
            self.alive = np.logical_and(self.alive, np.logical_not(held))

    def _give_up(self, late: Mask) -> None:
        """Give up impacts that last too long."""
        if self.contacts is not None:
            self.fail(Status.NOT_SEPARATED, self.contacts.tell(late), late)
            self.alive = np.logical_and(self.alive, np.logical_not(late))
            return
        count = int(np.max(self.compressions, where=late, initial=1))
        longest = float(np.max(self.longest, where=late, initial=coupled_steps.LONGEST))
        self.fail(Status.NOT_SEPARATED, tell_too_long(longest, count), late)
        self.alive = np.logical_and(self.alive, np.logical_not(late))

    def _refuse_below_zero(self, contact: NormalContact) -> None:
        """Refuse a radius or a friction load below zero, beyond rounding, of a contact alive."""
        radius, load = (
            np.where(self.alive, each, 0.0) for each in (contact.radius, contact.friction_load)
        )
        largest = self.normal.maximum_radius, self.normal.maximum_force
        if words := judges.below_zero(radius, load, largest):
            sentence = faults.sentence(self.normal.law, words, self.steps)
            raise faults.LawFaultError(Status.MALFORMED, sentence)

    def _leave_unanswered_out(self, settled: Mask, force: list[Real]) -> list[Real]:
        """Mark impacts to which the law has no answer, and return the forces of the others."""
        lost = self._whole(self.alive & ~np.broadcast_to(settled, self.shape))
        sentence = faults.sentence(self.law, "no division into stick and slip found", self.steps)
        if np.any(lost):
            self.fail(Status.UNSETTLED, sentence, lost)
        self.alive = self.alive & ~lost
        return [np.where(lost, 0.0, each) for each in force]

    def _join(self, components: list[Real]) -> Real:
        """Return a displacement or velocity as the law takes it."""
        return components[0] if self.axes == 1 else np.stack(components, axis=-1)

    def _width(self) -> Real:
        """Return the width of the next step in s."""
        if self.elastic:
            return self.step
        return self.step * np.minimum((self.steps + 0.5) / self.leading, 1.0)

    def _sample(self, approach: Real, at: list[Real], force: list[Real], step: Real) -> Sampled:
        """Return the motion where the forces act, as far as it is known."""
        inertia = self.W[1][1]
        if self.axes == 2:
            inertia = 0.5 * (inertia + self.W[2][2])
        slip, acting = self._join(at[1:]), self._join(force)
        return Sampled(approach, at[0], slip, acting, 0.5 * step * inertia)

    def _components(self, response: TangentialResponse) -> list[Real]:
        """Return the components of a force, or refuse a malformed answer."""
        force = response.force
        axes = (2,) if self.axes == 2 else ()
        if words := judges.wrong_response(response, self.shape, axes):
            sentence = faults.sentence(self.law, words, self.steps)
            raise faults.LawFaultError(Status.MALFORMED, sentence)
        if self.axes == 1:
            return [force]
        both = np.broadcast_to(force, (*self.shape, 2))
        return [both[..., 0], both[..., 1]] if self.shape else both.tolist()

    def _kick(
        self, pressure: Real | NDArray[np.floating], force: list[Real], step: Real
    ) -> list[Real]:
        """Return W (P, F) dt, the velocities that a step takes."""
        each: list[Any] = [pressure, *force]
        if self.links is not None:
            moved = self.links.kick(join(each, self.shape))
            return [step * moved[..., k] for k in range(3)]
        return [step * sum(w * f for w, f in zip(row, each, strict=True)) for row in self.W]

    def _whole(self, where: Mask) -> Mask:
        """Return a mask; of gatherings with all contacts where one is marked."""
        return where if self.contacts is None else whole(where)

    def fail(self, status: Status, detail: str | NDArray[np.object_], where: Mask) -> None:
        """Mark impacts as failed."""
        if isinstance(self.status, np.ndarray) and isinstance(self.detail, np.ndarray):
            where = self._whole(where)
            self.status[where], self.detail[where] = status, detail
        else:
            self.status, self.detail = status, detail

    def _motion(self) -> TangentialMotion:
        lost = np.where(self.status != Status.SUCCESS, math.nan, 0.0)
        change = self._join([each + lost for each in self.change[1:]])
        number: Callable[[Real], Real] = (
            (lambda v: v + lost) if self.shape else (lambda v: float(v + lost))
        )
        rate = self.before[0] + self.change[0]
        ends = (self.duration, rate, *self.greatest, self.loss, self.compressions)
        return TangentialMotion(
            slip_velocity_change=change if self.axes == 2 else number(self.change[1]),
            friction_work=number(self.work),
            shear_loss=number(self.shear),
            normal=Ends._make(map(number, ends)),
            status=self.status,
            detail=self.detail,
            counters={"steps": self.steps},
            contacts=None if self.contacts is None else self.contacts.tell_contacts(self.loss),
        )
