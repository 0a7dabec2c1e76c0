"""A limit of time for a check: a law that hangs or crawls is told so, and nothing hangs."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

#: Seconds of computing that a check may take; the longest of ours takes a few on a slow machine.
SECONDS = 60.0
#: A law that waits is stopped after so many times that: a busy machine is no reason.
WAITING = 10.0
#: Seconds after which the clock is looked at again, and a law that swallowed the first
#: interruption is interrupted again.
AGAIN = 1.0
#: Checks that may run out of time before the others are not tried any more.
MOST_TIMEOUTS = 3


class OutOfTimeError(KeyboardInterrupt):
    """A check ran out of time; it passes through ``except Exception``, as Ctrl-C does."""


class Doing:
    """What the kit is at: words, and the steps of a path that were taken so far."""

    what: str = ""
    steps: int = 0


#: What the check that runs is at.
DOING = Doing()


def begin(what: str) -> None:
    """Note what is begun; steps are counted from here."""
    DOING.what, DOING.steps = what, 0


@contextmanager
def limited(name: str, law: Any, seconds: float = SECONDS) -> Iterator[None]:
    """Raise ``OutOfTimeError`` in the body after ``seconds`` of computing, with a sentence.

    Only the main thread of a process can be interrupted, where the system has SIGALRM; elsewhere
    there is no limit.

    Parameters
    ----------
    name : str
        Of the check.
    law : Law
    seconds : float
        Of processor time; ten times that of waiting.
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
            after = f"{passed:.2g} s, {used:.2g} s of them computing"
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


def _sentence(name: str, law: Any, after: str, frame: FrameType | None) -> str:
    """Return which check was stopped, after how long, and where the law was.

    Parameters
    ----------
    name : str
        Of the check.
    law : Law
    after : str
        How long it took.
    frame : frame or None
        What ran when the time was over.
    """
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
