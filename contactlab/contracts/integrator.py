"""The contract of an integrator: from a problem to a motion."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, ClassVar, NamedTuple, TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.bodies import Pair
from contactlab.checks import Mask, Real
from contactlab.contracts.law import Law
from contactlab.contracts.normal import NormalContact, NormalLaw
from contactlab.contracts.tangential import TangentialLaw
from contactlab.status import Status


@attrs.frozen(kw_only=True, eq=False)
class Problem:
    """What an integrator solves; numbers are floats, or arrays of the batch ``shape``.

    Attributes
    ----------
    pair : Pair
    friction_coefficient : float or array
    normal_speed : float or array
        v1 in m/s.
    slip_velocity : float or array
        v_x at first touch, in m/s, eq. (20).
    maximum_radius : float or array
        a = CR in m, eq. (8): the largest contact radius of a Hertz impact. Laws that need
        a fixed grid span it.
    duration : float or array
        t in s, eq. (7): the time scale for choosing steps.
    shape : tuple of int
        Batch shape, () for one impact.
    """

    normal: NormalLaw
    tangential: TangentialLaw
    pair: Pair
    friction_coefficient: Real
    normal_speed: Real
    slip_velocity: Real
    maximum_radius: Real
    duration: Real
    shape: tuple[int, ...]

    def impacts(self) -> Iterator[Problem]:
        """Iterate over the impacts of a batch, each a problem of shape (), in C order."""
        whole = {name: self._spread(getattr(self, name)) for name in PROBLEM_NUMBERS}
        fields = [field.name for field in attrs.fields(Pair)]
        pairs = {name: self._spread(getattr(self.pair, name)) for name in fields}
        for index in range(math.prod(self.shape)):
            pair = Pair(**{name: column[index] for name, column in pairs.items()})
            one: dict[str, Any] = {name: column[index] for name, column in whole.items()}
            yield attrs.evolve(self, pair=pair, shape=(), **one)

    def take(self, where: NDArray[np.bool_]) -> Problem:
        """Return the problem of those impacts of a batch that ``where`` says, of shape (n,).

        What all impacts share stays a plain number: laws are faster then.
        """

        def some(number: Any) -> Any:
            return np.broadcast_to(number, self.shape)[where] if np.ndim(number) else number

        pair = Pair(**{f.name: some(getattr(self.pair, f.name)) for f in attrs.fields(Pair)})
        numbers = {name: some(getattr(self, name)) for name in PROBLEM_NUMBERS}
        return attrs.evolve(self, pair=pair, shape=(int(where.sum()),), **numbers)

    def _spread(self, number: Real) -> list[float]:
        spread: list[float] = np.broadcast_to(np.asarray(number), self.shape).ravel().tolist()
        return spread


#: The numbers of a problem besides those of its pair.
PROBLEM_NUMBERS = (
    "friction_coefficient", "normal_speed", "slip_velocity", "maximum_radius", "duration",
)  # fmt: skip


class Sample(NamedTuple):
    """One instant of a motion, as handed to an observer."""

    time: Real
    approach: Real
    normal_velocity: Real
    contact: NormalContact
    slip_velocity: Real
    tangential_force: Real
    fields: Callable[[], Mapping[str, Any]]


#: Called with each instant; it must not change anything it is given.
Observer: TypeAlias = Callable[[Sample], None]


@attrs.frozen(kw_only=True, eq=False)
class Motion:
    """What an integrator returns; entries have the batch shape.

    Attributes
    ----------
    duration : float or array
        Time of contact, in s.
    normal_velocity : float or array
        Rate of approach at the end, in m/s; negative: the bodies separate.
    slip_velocity_change : float or array
        Change of v_x in m/s. Kept apart from v_x, which may be so large that the
        change would be lost in it.
    friction_work : float or array
        In J, added up by the tangential law.
    status : Status or array of Status
    detail : str or array of str
        What went wrong, where and when; empty on success. Of a batch an integrator may give
        one sentence: it goes to the impacts that failed.
    counters : mapping of str to int
        Work done: ``steps``, ``evaluations``, ``rejected``, ...
    """

    duration: Real
    normal_velocity: Real
    slip_velocity_change: Real
    friction_work: Real
    status: Any = Status.SUCCESS
    detail: Any = ""
    counters: Mapping[str, int] = attrs.field(factory=dict)

    def __attrs_post_init__(self) -> None:
        if isinstance(self.detail, str) and np.ndim(self.status):
            spread = np.where(self.status == Status.SUCCESS, "", self.detail).astype(object)
            object.__setattr__(self, "detail", spread)

    @classmethod
    def joined(cls, motions: Sequence[Motion], shape: tuple[int, ...]) -> Motion:
        """Return one motion of ``shape`` from those of its impacts, or of parts of them."""
        entries = {
            name: np.concatenate(
                [
                    np.ravel(np.asarray(getattr(motion, name), dtype=MOTION_ENTRIES[name]))
                    for motion in motions
                ]
            )
            for name in MOTION_ENTRIES
        }
        counters: Counter[str] = Counter()
        for motion in motions:
            counters.update(motion.counters)
        return cls(
            **{name: entry.reshape(shape) for name, entry in entries.items()},
            counters=dict(counters),
        )

    @classmethod
    def merged(
        cls, parts: Sequence[tuple[NDArray[np.bool_], Motion]], shape: tuple[int, ...]
    ) -> Motion:
        """Return one motion of ``shape`` from motions of those impacts that a mask says of each.

        Of an impact in several parts the last has the word.
        """
        entries: dict[str, Any] = {
            name: np.empty(shape, dtype=kind) for name, kind in MOTION_ENTRIES.items()
        }
        counters: Counter[str] = Counter()
        for where, motion in parts:
            counters.update(motion.counters)
            for name, entry in entries.items():
                entry[where] = np.ravel(np.asarray(getattr(motion, name)))
        return cls(**entries, counters=dict(counters))

    @classmethod
    def nothing(
        cls, shape: tuple[int, ...], status: Status, detail: str | Sequence[str] = ""
    ) -> Motion:
        """Return the motion of impacts of which nothing is known: NaN throughout."""
        unknown: Real = np.full(shape, math.nan) if shape else math.nan
        return cls(
            duration=unknown,
            normal_velocity=unknown,
            slip_velocity_change=unknown,
            friction_work=unknown,
            status=np.full(shape, status, dtype=object) if shape else status,
            detail=detail if isinstance(detail, str) else np.array(detail, dtype=object),
        )

    def failing(self, where: Mask, status: Status, detail: Any) -> Motion:
        """Return this motion with ``status`` and ``detail`` on those successes ``where`` says.

        ``detail`` is a sentence, or an array of one for each impact.
        """
        statuses: Any = np.array(self.status, dtype=object)
        fallen = np.asarray(where) & (statuses == Status.SUCCESS)
        if not fallen.any():
            return self
        if not statuses.shape:
            return attrs.evolve(self, status=status, detail=detail)
        statuses[fallen] = status
        return attrs.evolve(
            self, status=statuses, detail=np.where(fallen, detail, self.detail).astype(object)
        )


#: What a motion says of each impact, and of what type; the rest is of the whole batch.
MOTION_ENTRIES: dict[str, type] = {
    **dict.fromkeys(("duration", "normal_velocity", "slip_velocity_change"), float),
    "friction_work": float, "status": object, "detail": object,
}  # fmt: skip
#: Its numbers.
MOTION_NUMBERS = tuple(name for name, kind in MOTION_ENTRIES.items() if kind is float)


class Integrator(Law):
    """Advances the bodies through the impact.

    Contract
    --------
    1. ``integrate(problem, observer)`` returns a ``Motion``. It is pure; it never raises for
       a numerical failure, but returns a status with the motion so far.
    2. Every loop is bounded.
    3. ``observer`` is None or is called at increasing times; having one changes no result.
    4. ``order`` is the order of convergence in the step that the class declares for smooth
       laws; None where there are no steps.
    5. Batch shapes pass through: a batch gives what its impacts give one by one. Where one
       fails the batch may be given up: a simulation then hands over each by itself.
    """

    kind: ClassVar[str] = "integrator"
    order: ClassVar[int | None] = None
    #: Narrow contracts it makes use of where a law has them, such as ``closed_form_motion``.
    uses: ClassVar[frozenset[str]] = frozenset()
    #: False if each impact of a batch has instants of its own: no history of a batch then.
    common_instants: ClassVar[bool] = True
    #: False if the impacts of a batch are followed one after another: a sweep hands over few.
    together: ClassVar[bool] = True

    @property
    def accuracy(self) -> float | None:
        """Error of psi2 over max(1, |psi1|) that it keeps to, under laws that are ``exact``.

        None for an integrator that does not control its error.
        """
        return None

    def steps_for(self, problem: Problem) -> Any:  # noqa: ARG002
        """Return how many steps of fixed length each impact takes; None if there are none."""
        return None

    def remarks(self, problem: Problem) -> tuple[str, ...]:  # noqa: ARG002
        """Return what a plan should say of this problem: sentences, none by default."""
        return ()

    @abstractmethod
    def integrate(self, problem: Problem, observer: Observer | None = None) -> Motion:
        """Return the motion from first touch to separation."""
