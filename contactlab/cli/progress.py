"""The line of progress of long work."""

from __future__ import annotations

import contextlib
import sys
import threading
import time
from collections.abc import Callable
from typing import Self

#: Nothing is shown of work shorter than this, in s.
QUIET = 2.0
#: Time between two states of the line, and between two lines where it is no terminal, in s.
OFTEN, SELDOM = 0.5, 10.0


class Progress:
    """Percentage and time left on stderr, kept up to date by a thread inside a ``with`` block.

    Parameters
    ----------
    what : str
        What is counted.
    terminal : bool
        Whether one line is written over; else there are lines now and then.
    """

    def __init__(self, what: str, *, terminal: bool) -> None:
        self._what, self._terminal = what, terminal
        self._started = time.perf_counter()
        self._count = 0, 0, self._started
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._show, daemon=True)

    def __enter__(self) -> Self:
        """Begin the line."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Wipe the line out, or end it with the time that all took."""
        self._ended.set()
        self._thread.join()

    def __call__(self, done: int, total: int) -> None:
        """Count ``done`` of ``total``."""
        self._count = done, total, time.perf_counter()

    def _show(self) -> None:
        pause = QUIET
        while not self._ended.wait(pause):
            pause = OFTEN if self._terminal else SELDOM
            self._put(self.line())
        done, total, _ = self._count
        elapsed = time.perf_counter() - self._started
        if self._terminal:
            self._put("")
        elif done == total > 0 and elapsed >= QUIET:
            self._put(f"{self._what}: 100 % ({done}/{total}), took {in_words(elapsed)}")

    def _put(self, text: str) -> None:
        if self._terminal:
            getattr(sys.stderr, "overwrite", lambda _: None)(text)
        else:
            print(text, file=sys.stderr, flush=True)

    def line(self) -> str:
        """Return what is done, and the time left; the time so far where nothing is known of it."""
        (done, total, counted), now = self._count, time.perf_counter()
        elapsed = in_words(now - self._started)
        if not done:
            return f"{self._what}: {elapsed} so far"
        each = (counted - self._started) / done
        present = max(each - (now - counted), 0.0)  # of the one that is being done
        left = present + each * (total - done - 1) if done < total else 0.0
        head = f"{self._what}: {100 * done // total} % ({done}/{total})"
        return f"{head}, {in_words(left)} left" if left else f"{head}, {elapsed} so far"


def progress(
    wanted: bool | None, what: str
) -> contextlib.AbstractContextManager[Callable[[int, int], object] | None]:
    """Return the line of progress on stderr, or of None: by default only on a terminal."""
    terminal = sys.stderr.isatty()
    if not (terminal if wanted is None else wanted):
        return contextlib.nullcontext()
    return Progress(what, terminal=terminal)


def in_words(seconds: float) -> str:
    """Return a time to wait for, in whole seconds, minutes or hours."""
    for unit, size in (("s", 1.0), ("min", 60.0)):
        if seconds < 90.0 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 3600.0:.1f} h"
