"""Faults of laws in the middle of a run: detection, and sentences that describe them.

Integrators use this module. A step without fault calls ``is_malformed`` only, and only if an answer
is not a plain float.
"""

from __future__ import annotations

from math import prod

import numpy as np

from contactlab.contracts.law import Law
from contactlab.contracts.status import Status
from contactlab.numeric.types import Real


class LawFaultError(Exception):
    """A law failed. Integrators raise and catch this error to end a run with a status."""

    def __init__(self, status: Status, detail: str) -> None:
        super().__init__(detail)
        self.status, self.detail = status, detail


class blaming:  # noqa: N801 a context manager with a lower-case name, as in contextlib
    """Context manager that turns any error but KeyboardInterrupt into a ``LawFaultError``.

    This is a class, as a generator would cost each impact microseconds. Where half a microsecond
    counts, an ``except`` calls ``blame``.

    Parameters
    ----------
    law : Law
        The law that runs in the context; the error names it.

    Attributes
    ----------
    step : int
        Number of the present step, from 1; the error names it too.
    """

    __slots__ = ("law", "step")

    def __init__(self, law: Law) -> None:
        self.law, self.step = law, 1

    def __enter__(self) -> blaming:
        return self

    def __exit__(self, kind: object, error: BaseException | None, where: object) -> None:
        if error is not None:
            blame(self.law, error, self.step)


def blame(law: Law, error: BaseException, step: int = 1) -> None:
    """Raise a ``LawFaultError`` for an error of a law; that error and KeyboardInterrupt pass."""
    if isinstance(error, KeyboardInterrupt | LawFaultError):
        return
    # SystemExit too: a plug-in must not end the process
    raise LawFaultError(Status.LAW_RAISED, sentence(law, tell_error(error, law), step)) from error


def is_malformed(value: object, shape: tuple[int, ...]) -> bool:
    """Return True unless ``value`` is real numbers that broadcast to the batch ``shape``.

    An array of one impact does not hold for many: a plain number, or one without axes, does.
    """
    if type(value) is float:
        return False
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "fiu" or (value.size == 1 and value.ndim and prod(shape) > 1):
            return True
        return value.shape != shape and not _broadcasts(value.shape, shape)
    return isinstance(value, bool) or not isinstance(value, float | int | np.floating | np.integer)


def sentence(law: Law, what: str, step: int, time: Real | None = None) -> str:
    """Return the sentence that describes a fault: step, time, event, and the law with its module.

    Parameters
    ----------
    law : Law
        The law that failed.
    what : str
        The event: ``"force nan"``.
    step : int
        Number of the step, from 1.
    time : float or array, optional
        Time of the fault in s; of an array the latest is named.
    """
    try:
        when = f", time {float(np.max(time)):.6g} s" if time is not None else ""
    except (TypeError, ValueError):
        when = ""
    return f"At step {step}{when}: {what}, from {type(law).__name__} in {type(law).__module__}."


def tell_error(error: BaseException, law: Law | None = None) -> str:
    """Return the type, message and place of an error as a sentence.

    Where ``law`` was asked and no frame of the error is its own, its answer could not be taken
    apart, and the sentence says what it must be.
    """
    import traceback  # only failed runs need it

    where = traceback.extract_tb(error.__traceback__)[-1]
    told = f"{type(error).__name__}: {error} ({where.name}, line {where.lineno})"
    frames = (frame for frame, _ in traceback.walk_tb(error.__traceback__))
    shapeless = isinstance(error, TypeError | ValueError)
    if law is None or not shapeless or any(frame.f_locals.get("self") is law for frame in frames):
        return told
    return f"the answer must be a pair, response or contact and the next state; {told}"


def _broadcasts(answered: tuple[int, ...], shape: tuple[int, ...]) -> bool:
    """Return whether the shape ``answered`` broadcasts to ``shape``."""
    try:
        return np.broadcast_shapes(answered, shape) == shape
    except ValueError:
        return False
