"""The steps of the normal motion, one by one or all in a table, and whose fault a bad one is."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from contactlab import faults
from contactlab.checks import Real
from contactlab.contracts import NormalContact, Problem
from contactlab.status import Status


class Step(NamedTuple):
    """One step of the normal motion, as the tangential march needs it.

    The schemes differ only in where they sample the contact and how long they drift and kick.

    Attributes
    ----------
    contact : NormalContact
        At the sample.
    drift : float or array
        Time from the last sample to this one, in s: slip velocity acts on displacement.
    kick : float or array
        Time in s for which the force found at the sample acts on velocity.
    normal_force : float or array
        Mean of P over the kick, in N.
    time, approach, rate : float or array
        At the sample, for the observer.
    """

    contact: NormalContact
    drift: Real
    kick: Real
    normal_force: Real
    time: Real
    approach: Real
    rate: Real


class Table:
    """All steps at once, as columns of K rows; iterates over them as steps.

    A column has shape (K,) for one impact, and (K, B), or (K, 1), for a batch.
    """

    def __init__(self, columns: Step) -> None:
        self.columns: Any = columns

    @classmethod
    def of(cls, problem: Problem, steps: Iterable[Step]) -> Table:
        """Gather the steps of one impact; name the normal law if it fails.

        Raises
        ------
        LawFaultError
            If the law raises, or answers with other than real numbers: then the rows make no
            array of floats, which takes no time to see where all is well.
        """
        rows: list[tuple[Any, ...]] = []
        try:
            for step in steps:
                rows.append((*step.contact, *step[1:]))  # noqa: PERF401
            table = np.array(rows)
        except Exception as error:
            raise _blamed(problem, rows, faults.raised(error)) from error
        if table.dtype != np.float64 or table.shape != (len(rows), 9):
            raise _blamed(problem, rows, "no table of numbers")
        columns = table.T
        return cls(Step(NormalContact(*columns[:3]), *columns[3:]))

    def __iter__(self) -> Iterator[Step]:
        """Iterate over the steps: floats for one impact (much faster), arrays for a batch."""
        columns = [np.asarray(column) for column in (*self.columns.contact, *self.columns[1:])]
        lists = [column.tolist() if column.ndim == 1 else column for column in columns]
        for row in zip(*lists, strict=True):
            yield Step(NormalContact(*row[:3]), *row[3:])


class NormalEnd:
    """How the normal motion ended; filled in by the scheme that produces the steps."""

    duration: Real = math.nan
    rate: Real = math.nan
    separated: bool = True


def watched(problem: Problem, steps: Iterable[Step]) -> Iterator[Step]:
    """Iterate over steps for which the normal law is asked; name it if it fails.

    Raises
    ------
    LawFaultError
        If the normal law raises, or answers with other than real numbers.
    """
    law, shape, count, time = problem.normal, problem.shape, 0, None
    try:
        for count, step in enumerate(steps, start=1):
            force, radius, overlap = step.contact
            time = step.time
            # One comparison a step where all is well: this runs in every step.
            if not (type(force) is type(radius) is type(overlap) is float):
                for part in step.contact:
                    if faults.malformed(part, shape):
                        detail = faults.told(law, f"the answer {faults.shown(part)}", count, time)
                        raise faults.LawFaultError(Status.MALFORMED, detail)
            yield step
    except faults.LawFaultError:
        raise
    except Exception as error:
        detail = faults.told(law, faults.raised(error), count + 1, time)
        raise faults.LawFaultError(Status.LAW_RAISED, detail) from error


def _blamed(problem: Problem, rows: list[tuple[Any, ...]], otherwise: str) -> faults.LawFaultError:
    """Return the fault of the normal law: its first answer that is not real numbers, if any is."""
    law, time = problem.normal, None
    for count, row in enumerate(rows, start=1):
        time = row[6]
        for part in row[:3]:
            if faults.malformed(part, problem.shape):
                detail = faults.told(law, f"the answer {faults.shown(part)}", count, time)
                return faults.LawFaultError(Status.MALFORMED, detail)
    detail = faults.told(law, otherwise, len(rows) + 1, time)
    return faults.LawFaultError(Status.LAW_RAISED, detail)
