"""What every result of a run says: failures, cautions, and a check that raises them."""

from __future__ import annotations

from abc import abstractmethod
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Self

import attrs
import numpy as np

from contactlab.contracts.status import Status
from contactlab.numeric.arrays import filled, taken
from contactlab.numeric.checks import Real
from contactlab.outcome.columns import json_value
from contactlab.outcome.numerical_error import error_cautions, error_words
from contactlab.outcome.plan import Plan


class ImpactError(RuntimeError):
    """Raised by ``check()`` of a result if an impact failed.

    ``status`` is the status of the impact in the message.
    """

    def __init__(self, sentence: str, status: Status) -> None:
        super().__init__(sentence, status)
        self.status = status

    def __str__(self) -> str:
        """Return the sentence without the status."""
        return str(self.args[0])


class Answer:
    """Base of results: of one impact or a batch, of collisions, and along paths."""

    __slots__ = ()

    @property
    @abstractmethod
    def cautions(self) -> list[str]:
        """Doubts about the numbers, in sentences."""

    @abstractmethod
    def _ends(self) -> tuple[Any, Any]:
        """Return statuses and details of what was run."""

    @property
    def failures(self) -> dict[int, str]:
        """A sentence for each impact that failed, by its index in C order."""
        statuses, details = (np.ravel(np.array(entry, dtype=object)) for entry in self._ends())
        return {
            index: f"{status.value} {detail}".strip()
            for index, (status, detail) in enumerate(np.broadcast(statuses, details))
            if status is not Status.SUCCESS
        }

    def check(self, *, cautions: bool = False) -> Self:
        """Return this result if every impact succeeded; with ``cautions`` only if there is none.

        Parameters
        ----------
        cautions : bool
            Raise the first caution too.

        Raises
        ------
        ImpactError
            With the sentence of the first impact that failed, or of the first caution.
        """
        statuses = np.array(self._ends()[0], dtype=object)
        for index, sentence in self.failures.items():
            where = f"impact {index}: " if statuses.ndim else ""
            raise ImpactError(where + sentence, np.ravel(statuses)[index])
        for sentence in self.cautions if cautions else ():
            raise ImpactError(f"caution: {sentence}", Status.SUCCESS)
        return self

    def _first_lines(self) -> list[str]:
        """Return what ``str`` begins with."""
        return [repr(self)]

    def __str__(self) -> str:
        """Return ``repr``, the first failure and every caution, in lines."""
        lines, failures = self._first_lines(), self.failures
        for index in [*failures][:1]:
            batch = np.ndim(self._ends()[0])
            where = f" (impact {index}; {len(failures)} in all)" if batch else ""
            lines.append(f"failed{where}: {failures[index]}")
        return "\n".join([*lines, *(f"caution: {text}" for text in self.cautions)])


def statuses_told(statuses: Any) -> str:
    """Return the names of statuses in words, in a batch with the count of each."""
    if isinstance(statuses, Status):
        return statuses.name
    counts = Counter(status.name for status in np.ravel(np.array(statuses, dtype=object)))
    return ", ".join(f"{count} {name}" for name, count in counts.items())


class RunResult(Answer):
    """Base of the results of runs: scene, plan, motion, history, laws; a batch can be indexed."""

    __slots__ = ()

    scene: Any
    plan: Plan
    motion: Any
    run_time: float
    laws: Mapping[str, str]
    history: Any
    psi2_error_estimate: Real | None

    @abstractmethod
    def _told(self) -> str:
        """Return what ``repr`` says of the answer."""

    def __repr__(self) -> str:
        """Return the answer, statuses and laws on one line."""
        laws = ", ".join(name.partition(" ")[0] for name in self.laws.values())
        return f"{type(self).__name__}({self._told()}; {statuses_told(self.status)}; {laws})"

    def _first_lines(self) -> list[str]:
        return [repr(self), f"numerical error of psi2: {error_words(self)}"]

    def _ends(self) -> tuple[Any, Any]:
        return self.motion.status, self.motion.detail

    @property
    def status(self) -> Any:
        """Status of the impact, or an array of statuses of the scene's shape."""
        return self.motion.status

    @property
    def counters(self) -> Mapping[str, int]:
        """Counts of steps, evaluations, solves and rejected steps, by name."""
        counters: Mapping[str, int] = self.motion.counters
        return counters

    @property
    def cautions(self) -> list[str]:
        """Cautions that ``str`` shows: about the numerical error, then those of the plan."""
        return [*error_cautions(self), *map(str, self.plan.cautions)]

    def to_dataframe(self) -> Any:
        """Return a ``pandas.DataFrame``, one row for each impact, units in ``.attrs["units"]``.

        The index is the axes of a ``Scene.grid`` or of a file's product, else ``impact``.
        """
        from contactlab.outcome.frames import to_dataframe

        return to_dataframe(self)

    def to_xarray(self) -> Any:
        """Return an ``xarray.Dataset`` with units, its dimensions the axes of a ``Scene.grid``."""
        from contactlab.outcome.frames import to_xarray

        return to_xarray(self)

    def __len__(self) -> int:
        """Return the number of impacts of a batch."""
        if not self.scene.shape:
            raise TypeError("the result of a single impact has no length")
        return int(self.scene.shape[0])

    def __getitem__(self, index: int | slice) -> Self:
        """Return the result of one impact of a batch, or of a slice."""
        shape = self.scene.shape
        if not shape:
            raise TypeError("the result of a single impact cannot be indexed")
        if isinstance(index, bool) or not isinstance(index, int | np.integer | slice):
            raise TypeError(f"a result is indexed by a number or a slice, not {index!r}")
        places = index if isinstance(index, slice) else slice(index, index + 1 or None)
        if not np.size(np.arange(shape[0])[places]):
            raise IndexError(f"{index}: is out of range for a batch of {shape[0]} impacts")
        history = self.history
        if history:
            columns = {name: column[:, index] for name, column in history.columns().items()}
            fields = {name: field[:, index] for name, field in history.fields.items()}
            history = type(history)(**columns, fields=fields)
        part: Any = self
        return attrs.evolve(  # type: ignore[no-any-return]
            part,
            scene=self.scene.take(index),
            plan=self.plan[index],
            motion=taken(self.motion, shape, index),
            history=history,
        )

    def __iter__(self) -> Iterator[Self]:
        """Iterate over the impacts of a batch."""
        return (self[index] for index in range(len(self)))


class TwoBodies(Answer):
    """Base of collisions: both bodies after an encounter, with the impacts of those that met."""

    __slots__ = ()

    encounter: Any
    velocity: Any
    spin: Any
    collided: Any

    @property
    @abstractmethod
    def plan(self) -> Plan:
        """The plan of the collision."""

    @abstractmethod
    def _impacts(self) -> Any:
        """Return the result of the impacts; None if none were run."""

    @abstractmethod
    def _vectors(self) -> Iterable[str]:
        """Return the names of the vectors after the collision."""

    def __repr__(self) -> str:
        """Return velocity and spin of a single collision, or the count in a batch, and statuses."""
        name, statuses = type(self).__name__, np.ravel(np.array(self.status, dtype=object))
        outcome = ", ".join(sorted({status.name for status in statuses}))
        if self.encounter.shape:
            count = f"{int(np.sum(self.collided))} of {np.size(self.collided)}"
            return f"{name}({count} encounters collided; {outcome})"
        outcome = outcome if self.collided else "separate, passed through"
        return f"{name}(velocity={self.velocity}, spin={self.spin}; {outcome})"

    def _ends(self) -> tuple[Any, Any]:
        impacts = self._impacts()
        return (Status.SUCCESS, "") if impacts is None else impacts._ends()

    @property
    def status(self) -> Any:
        """A ``Status``, or an array of statuses; ``SUCCESS`` if the bodies passed through."""
        impacts = self._impacts()
        if impacts is not None and np.all(self.collided):
            return impacts.status
        status = filled(Status.SUCCESS, self.encounter.shape)
        if impacts is not None:
            status[self.collided] = impacts.status
        return status

    @property
    def cautions(self) -> list[str]:
        """Cautions of the plan."""
        return [*map(str, self.plan.cautions)]

    def to_dict(self) -> dict[str, Any]:
        """Return the vectors of both bodies after the collision as plain lists."""
        return {name: json_value(np.asarray(getattr(self, name))) for name in self._vectors()}
