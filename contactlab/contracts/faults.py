"""Faults of laws in the middle of a run: how they are found, and what is said of them.

For integrators: nothing here is called in a step that goes well, but for ``malformed``, and
that only where an answer is not a plain float.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.contracts.law import Law
from contactlab.contracts.status import Status


class LawFaultError(Exception):
    """A law failed; raised and caught within an integrator, to end the run with a status."""

    def __init__(self, status: Status, detail: str) -> None:
        super().__init__(detail)
        self.status, self.detail = status, detail


class blaming:  # noqa: N801 a context manager, named as those of contextlib are
    """Turns whatever is raised within, but Ctrl-C, into a ``LawFaultError`` of a law.

    Written out, for a generator costs each impact microseconds.
    """

    __slots__ = ("law",)

    def __init__(self, law: Law) -> None:
        self.law = law

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, error: BaseException | None, where: object) -> None:
        if error is None or isinstance(error, KeyboardInterrupt | LawFaultError):
            return
        # whatever else: a plug-in may not end the process
        raise LawFaultError(Status.LAW_RAISED, sentence(self.law, raised(error), 1)) from error


def malformed(value: Any, shape: tuple[int, ...]) -> bool:
    """Return whether ``value`` is other than real numbers that broadcast to the batch ``shape``."""
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "fiu":
            return True
        return value.shape != shape and not _broadcasts(value.shape, shape)
    return isinstance(value, bool) or not isinstance(value, float | int | np.floating | np.integer)


def sentence(law: Law, what: str, step: int, time: Any = None) -> str:
    """Return the sentence of a fault: step, time, what happened, and whose law it was.

    Parameters
    ----------
    law : Law
        The one that failed.
    what : str
        What it did: ``"force nan"``.
    step : int
        From 1.
    time : float or array, optional
        In s; the latest of several.
    """
    try:
        when = f", time {float(np.max(time)):.6g} s" if time is not None else ""
    except (TypeError, ValueError):
        when = ""
    return f"At step {step}{when}: {what}, from {type(law).__name__}."


def raised(error: BaseException) -> str:
    """Return what was raised, and where, as a sentence."""
    import traceback  # only where there is something to tell

    where = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({where.name}, line {where.lineno})"


def _broadcasts(given: tuple[int, ...], shape: tuple[int, ...]) -> bool:
    try:
        return np.broadcast_shapes(given, shape) == shape
    except ValueError:
        return False
