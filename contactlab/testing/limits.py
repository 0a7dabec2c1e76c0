"""Time limit of a check, which stops a law that hangs or is very slow."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

#: Processor time of a check, in s; contactlab's own laws take a few seconds on a slow machine.
SECONDS = 60.0
#: Wall-clock limit over the limit of processor time, for a law that waits: the factor allows for a
#: busy machine.
WAITING = 10.0
#: Interval in s at which the limits are tested again, for a law that swallows the first exception.
AGAIN = 1.0
#: Number of checks out of time after which the remaining checks are not tried.
MOST_TIMEOUTS = 3


class OutOfTimeError(KeyboardInterrupt):
    """A check ran out of time; like Ctrl-C it passes through ``except Exception``."""


class Doing:
    """The present activity of the kit in words, and the number of steps taken."""

    what: str = ""
    steps: int = 0


#: Activity of the running check.
DOING = Doing()


def begin(what: str) -> None:
    """Set the activity, and reset the number of steps to 0."""
    DOING.what, DOING.steps = what, 0


@contextmanager
def limit_time(name: str, law: object, seconds: float = SECONDS) -> Iterator[None]:
    """Raise ``OutOfTimeError`` in the body after ``seconds`` of processor time.

    Only the main thread of a system with SIGALRM can be interrupted; elsewhere there is no limit.

    Parameters
    ----------
    name : str
        Name of the check, for the message.
    law : Law
    seconds : float
        Limit of processor time, in s; the limit of wall-clock time is ``WAITING`` times as long.
    """
    possible = hasattr(signal, "SIGALRM") and (
        threading.current_thread() is threading.main_thread()
    )
    begin("")
    if not possible:
        yield
        return

    running = True
    begun, computed = time.monotonic(), time.process_time()

    def stop(_: int, frame: FrameType | None) -> None:
        used, passed = time.process_time() - computed, time.monotonic() - begun
        if running and used >= seconds:
            after = f"{seconds:g} s of computing, its limit"
        elif running and passed >= WAITING * seconds:
            after = f"{passed:.4g} s, {used:.2g} s of them computing"
        else:
            return
        raise OutOfTimeError(_sentence(name, law, after, frame))

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
    try:
        try:
            yield
        finally:
            running = False
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def _sentence(name: str, law: object, after: str, frame: FrameType | None) -> str:
    """Return a sentence on the check stopped, its time, and the line that the law was at."""
    what = f", in {DOING.what}" if DOING.what else ""
    steps = f" at step {DOING.steps}" if DOING.steps else ""
    where = ""
    while frame is not None and not where:
        owner = frame.f_locals.get("self")
        if owner is law or type(owner) is type(law):
            where = f", in {type(law).__name__}.{frame.f_code.co_name}, line {frame.f_lineno}"
        frame = frame.f_back
    return (
        f"The check {name} was stopped after {after}{what}{steps}{where}: the law hangs, or crawls."
    )
