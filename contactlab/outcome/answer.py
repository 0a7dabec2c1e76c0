"""Failures and cautions of every result, and a check that raises them."""

from __future__ import annotations

import itertools
from abc import abstractmethod
from collections import Counter
from collections.abc import Iterator
from typing import Self

import numpy as np

from contactlab.contracts.status import Details, Status, Statuses, succeeded
from contactlab.numeric.checks import yes_or_no
from contactlab.outcome.tabled import Plotted


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


class Checked(Plotted):
    """Base of results that tell failures and cautions, and raise them on demand."""

    __slots__ = ()

    @property
    @abstractmethod
    def cautions(self) -> list[str]:
        """Doubts about the numbers, in sentences."""

    @property
    def failures(self) -> dict[int, str]:
        """A sentence for each impact that failed, by its index in C order."""
        return dict(self._iterate_failures())

    @abstractmethod
    def _iterate_failures(self) -> Iterator[tuple[int, str]]:
        """Yield index and sentence of each impact that failed, in order."""

    @property
    @abstractmethod
    def _of_many(self) -> bool:
        """Whether this is the answer of a batch."""

    @abstractmethod
    def _status_at(self, index: int) -> Status:
        """Return the status of an impact by its index in C order."""

    def _tell_missing(self) -> str:
        """Return which impacts were not computed, and how to go on; empty if none is missing."""
        return ""

    def check(self, *, cautions: bool = False) -> Self:
        """Return this result if every impact succeeded; with ``cautions`` only if there is none.

        Parameters
        ----------
        cautions : bool
            Raise the first caution too.

        Raises
        ------
        ImpactError
            With the sentence of the first impact that failed, of those that are missing in a
            folder, or of the first caution.
        """
        told = self.cautions if yes_or_no("cautions", cautions) else ()
        for index, sentence in self._iterate_failures():
            where = f"impact {index}: " if self._of_many else ""
            raise ImpactError(where + sentence, self._status_at(index))
        if missing := self._tell_missing():
            raise ImpactError(missing, Status.INTERRUPTED)
        for sentence in told:
            raise ImpactError(f"caution: {sentence}", Status.SUCCESS)
        return self

    def _first_lines(self) -> list[str]:
        """Return the first lines of ``str``."""
        return [repr(self)]

    def __str__(self) -> str:
        """Return ``repr``, the first failure, what is missing and every caution, in lines."""
        lines, failed = self._first_lines(), self._iterate_failures()
        for index, sentence in itertools.islice(failed, 1):
            count = 1 + sum(1 for _ in failed)
            where = f" (impact {index}; {count} in all)" if self._of_many else ""
            lines.append(f"failed{where}: {sentence}")
        if missing := self._tell_missing():
            lines.append(missing)
        return "\n".join([*lines, *(f"caution: {text}" for text in self.cautions)])


class Answer(Checked):
    """Base of results in memory: of one impact or a batch, of collisions, and along paths."""

    __slots__ = ()

    @abstractmethod
    def _statuses(self) -> tuple[Statuses, Details]:
        """Return statuses and details of the impacts."""

    def _iterate_failures(self) -> Iterator[tuple[int, str]]:
        ends = self._statuses()
        if succeeded(ends[0]):  # a loop over a million takes long
            return
        statuses, details = (np.ravel(np.array(entry, dtype=object)) for entry in ends)
        for index, (status, detail) in enumerate(np.broadcast(statuses, details)):
            if status is not Status.SUCCESS:
                yield index, f"{status.value} {detail}".strip()

    @property
    def _of_many(self) -> bool:
        return not isinstance(self._statuses()[0], Status)

    def _status_at(self, index: int) -> Status:
        status: Status = np.ravel(np.array(self._statuses()[0], dtype=object))[index]
        return status


def tell_statuses(statuses: object) -> str:
    """Return the names of statuses in words, in a batch with the count of each."""
    if isinstance(statuses, Status):
        return statuses.name
    counts = Counter(status.name for status in np.ravel(np.array(statuses, dtype=object)))
    return ", ".join(f"{count} {name}" for name, count in counts.items())
