"""A limit of clock time, which also stops the run that has begun."""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

#: Interval in s at which a run is stopped again, if it swallowed the first exception.
AGAIN = 1.0


class TimeLimitError(KeyboardInterrupt):
    """The time limit was reached; like Ctrl-C it passes through ``except Exception``."""


@contextmanager
def time_limited(seconds: float | None) -> Iterator[Callable[[], bool]]:
    """Stop the body after ``seconds``; yield a function that tells whether the time is over.

    Outside the main thread, and on a system without SIGALRM, nothing that has begun is stopped.

    Parameters
    ----------
    seconds : float or None
        Limit of clock time, in s; None for no limit.
    """
    until = math.inf if seconds is None else time.perf_counter() + seconds

    def over() -> bool:
        return time.perf_counter() >= until

    main = threading.current_thread() is threading.main_thread()
    if seconds is None or not (main and hasattr(signal, "SIGALRM")):
        yield over
        return
    running = True

    def stop(_: int, __: FrameType | None) -> None:
        if running:
            raise TimeLimitError

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
    try:
        try:
            yield over
        finally:
            running = False
    except TimeLimitError:
        pass
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
