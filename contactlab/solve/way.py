"""Base of the ways to solve impacts: it divides batches that fail, and judges the motions.

Spheres, and bodies whose contact does not couple, follow a known normal motion (``decoupled.py``).
Where friction changes the approach, or slip turns, both motions are found together
(``coupled.py``). Each way tells the plan what it does differently.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np

from contactlab.contracts import faults
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import consecutive
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array, Real
from contactlab.outcome.energy import judge_books, judge_energy, passes, raise_errors
from contactlab.outcome.history import Recorder
from contactlab.outcome.motion import Motion, sound
from contactlab.outcome.plan import ENDLESS, MARCHED, UNKNOWN, Clause, PlanColumns, Reason
from contactlab.registry.composition import Laws
from contactlab.registry.law_words import in_words, name_of
from contactlab.solve.answers import Answered, Mask

#: Friction work over the energy at the start is this many times less accurate than psi2.
WORK_ACCURACY = 10.0
#: A failed batch of at most so many impacts is solved one by one; a larger batch is halved first.
ONE_BY_ONE = 8
#: Reason why impacts whose approach friction changes are not marched.
WHOLE = Reason("the law solves both motions together")


class Prepared(NamedTuple):
    """Normal motion, whole-impact answers and columns of the plan, made before the march."""

    normal: NormalMotion
    answered: list[Answered]
    columns: PlanColumns
    books_bound: Real


class Masks(NamedTuple):
    """Impacts with a normal motion, those that the motion ends, others, and those marched."""

    known: Mask
    ended: Mask
    endless: Mask
    marched: Mask

    @classmethod
    def of(cls, columns: PlanColumns) -> Masks:
        """Return the masks of a plan's columns."""
        code = columns.code
        masks = code != UNKNOWN, code > ENDLESS, code == ENDLESS, code == MARCHED
        return cls(*map(np.asarray, masks))


class Entries(NamedTuple):
    """Impacts of a way: their place in the scene, their own scene, and their laws."""

    where: Any
    scene: Scene
    laws: Laws


class Way(Entries, ABC):
    """Impacts that are solved in the same way."""

    __slots__ = ()

    #: True if normal and tangential motion are found together.
    both: ClassVar[bool]
    #: True if whole-impact answers have the accuracy of the integrator.
    as_integrator: ClassVar[bool]
    #: Imbalance of the energy books, over the energy at the start, that is no failure in any law.
    cancels: ClassVar[float]
    #: Most impacts that are solved at a time.
    at_a_time: ClassVar[float]

    @abstractmethod
    def prepare(self, history: bool | str) -> Prepared:
        """Return normal motion, answers and plan before the march, or raise LawFaultError."""

    @abstractmethod
    def solve(self, prepared: Prepared, recorder: Recorder | None) -> Motion:
        """Return the motion, or raise LawFaultError."""

    @abstractmethod
    def line(self, scene: Scene) -> Array:
        """Return the unit vectors of slip along one line in the tangent plane of a scene."""

    @property
    @abstractmethod
    def scene_of_cautions(self) -> Scene:
        """The impacts of spheres about which cautions are asked."""

    @abstractmethod
    def how(self) -> str:
        """Return words on how the normal motion is found."""

    def most_at_a_time(self) -> float:
        """Return how many impacts are solved at a time."""
        return self.at_a_time

    def one_by_one(self, masks: Masks) -> Mask:
        """Return the impacts that a law takes one by one, if it does."""
        return masks.marched

    def remarks(self, masks: Masks) -> list[Clause]:
        """Return further clauses on what is computed."""
        return []

    def errors(self, columns: PlanColumns) -> Mapping[str, Real]:
        """Return the numerical errors that the plan tells, by the name of their quantity."""
        return {"psi2": columns.psi2_error}

    def motion_of_cautions(self, motion: Motion | None) -> Motion | None:
        """Return the normal motion of a run, if cautions refer to that motion."""
        return motion

    def cautions_of_laws(self, scene: Scene, normal: NormalMotion, known: Mask) -> list[str]:
        """Return the cautions of the laws on impacts that have a normal motion."""
        laws = self.laws.normal, self.laws.tangential
        return [text for law in laws for text in ask(law, law.cautions, scene, normal)]

    def cautions_of_contact(self, scene: Scene, normal: NormalMotion) -> list[str]:
        """Return the cautions that do not depend on the laws."""
        return []

    def own_cautions(self, of_laws: bool) -> list[str]:
        """Return cautions of this way; ``of_laws`` is True if the laws said something."""
        return []

    def outcome(self, history: bool | str, recorder: Recorder | None) -> tuple[PlanColumns, Motion]:
        """Return columns of the plan, and motion; a law that raises costs its impacts only."""
        scene, laws, divisible = self.scene, self.laws, False
        if scene.shape and recorder is None:
            batch = kinetics.batch_of(scene)  # a gathering is never divided
            divisible = math.prod(batch) > 1
        if divisible and scene.shape[0] > (most := self.most_at_a_time()):
            return self.solve_parts(blocks(scene.shape[0], int(most)))
        try:
            prepared = self.prepare(history)
            if divisible and prepared.normal._known == "nothing":
                return self.solve_parts(halves(*batch, most=1))
            motion = self.solve(prepared, recorder)
        except faults.LawFaultError as fault:
            if divisible:
                return self.solve_parts(halves(*batch, most=1))
            nothing = Motion.nothing(
                scene.shape, fault.status, fault.detail, axes=kinetics.slip_axes(scene)
            )
            return PlanColumns.nothing(scene.shape), nothing
        # Bound of the imbalance of the energy books: the law's own, and the integrator's share.
        normal, _, columns, own = prepared
        bound = own + WORK_ACCURACY * (laws.capability.accuracy or 0.0)
        bare = self.both or normal._known == "ends"
        error = columns.restitution_error
        if not scene.shape and passes(
            motion, normal, bound, error, scene=scene, coupled=self.both, bare=bare
        ):
            return columns, motion
        motion = judge_energy(sound(motion, coupled=bare), normal)
        motion, off = judge_books(
            motion, scene, bound, self.cancels, coupled=self.both, restitution_error=error
        )
        return raise_errors(columns, scene, off, bound, self.cancels), motion

    def solve_parts(self, places: list[slice]) -> tuple[PlanColumns, Motion]:
        """Return columns and motion of a batch that is solved in consecutive parts."""
        parts = [self.taking(place).outcome(False, None) for place in places]
        columns, motions = zip(*parts, strict=True)
        shape = self.scene.shape
        return PlanColumns.join(columns, shape), Motion.join(motions, shape)

    def taking(self, place: Any) -> Way:
        """Return the way of some of the impacts."""
        return self._replace(scene=self.scene.take(place))

    def in_axes(self, motion: Motion, scene: Scene) -> Motion:
        """Return a motion of this way with its slip in the axes of the scene."""
        if scene is self.scene or kinetics.slip_axes(scene) == kinetics.slip_axes(self.scene):
            return motion
        return motion.turn(self.line(scene))

    def refuse_history(self, history: bool | str) -> None:
        """Refuse the history of a batch whose impacts have instants of their own."""
        if self.scene.shape:
            law = in_words(self.laws.tangential)
            rule = f"impacts of a batch have instants of their own under {law}"
            raise refuse("history", history, rule, "run them one by one")


def ask(law: Law, question: Callable[..., tuple[str, ...]], *about: object) -> list[str]:
    """Return the answer of a law, or the error that it raised."""
    try:
        return list(question(*about))
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # the numbers do not need this answer; a plug-in ends no process
        return [f"cautions of {name_of(law)}: not known, {faults.tell_error(error)}"]


def blocks(size: int, block: int) -> list[slice]:
    """Return the places of blocks of a batch."""
    return [slice(first, min(first + block, size)) for first in range(0, size, block)]


def halves(size: int, *, most: int) -> list[slice]:
    """Return the two halves of a batch, or its impacts if there are at most ``most``."""
    return consecutive([1] * size if size <= most else [size // 2, size - size // 2])
