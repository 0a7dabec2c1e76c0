"""A limit of clock time, which also stops a run that has begun."""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Callable
from types import FrameType
from typing import TypeVar

T = TypeVar("T")

#: Interval in s at which a run is stopped again, if it swallowed the first exception.
AGAIN = 1.0


class TimeLimitError(KeyboardInterrupt):
    """The time limit was reached; like Ctrl-C it passes through ``except Exception``."""


def end_of(seconds: float | None) -> float:
    """Return the time of the clock at which a limit of ``seconds`` from now is reached, in s."""
    return math.inf if seconds is None else time.perf_counter() + seconds


def in_time(run: Callable[[], T], until: float) -> T:
    """Return what ``run`` returns, or raise ``TimeLimitError`` at the time ``until``.

    Outside the main thread, and on a system without SIGALRM, a run that has begun is not stopped.

    Parameters
    ----------
    run : callable
    until : float
        Time of ``time.perf_counter``, in s; infinite for no limit.
    """
    left, running = until - time.perf_counter(), True
    if left <= 0.0:
        raise TimeLimitError
    main = threading.current_thread() is threading.main_thread()
    if left == math.inf or not (main and hasattr(signal, "SIGALRM")):
        return run()

    def stop(_: int, __: FrameType | None) -> None:
        if running:
            raise TimeLimitError

    before = signal.signal(signal.SIGALRM, stop)
    try:
        try:
            signal.setitimer(signal.ITIMER_REAL, left, AGAIN)
            answer = run()
        finally:
            running = False
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    if time.perf_counter() >= until:  # the run may have swallowed the exception
        raise TimeLimitError
    return answer
