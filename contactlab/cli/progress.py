"""The progress line of long work."""

from __future__ import annotations

import contextlib
import sys
import threading
import time
from collections.abc import Callable
from typing import Self

#: Work shorter than this shows no progress, in s.
QUIET = 2.0
#: Time between updates of the line on a terminal, and between lines elsewhere, in s.
OFTEN, SELDOM = 0.5, 10.0


class Progress:
    """Percentage and time left on stderr, updated by a thread inside a ``with`` block.

    On a terminal one line is overwritten; elsewhere each update is a new line.
    """

    def __init__(self, what: str, *, terminal: bool) -> None:
        self._what, self._terminal = what, terminal
        self._started = time.perf_counter()
        self._count = 0, 0, self._started
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._show, daemon=True)

    def __enter__(self) -> Self:
        """Start the thread."""
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Stop the thread, which clears the line or prints the total time."""
        self._ended.set()
        self._thread.join()

    def __call__(self, done: int, total: int) -> None:
        """Set the count to ``done`` of ``total``."""
        self._count = done, total, time.perf_counter()

    def _show(self) -> None:
        """Update the line until the block ends."""
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
        """Print one state of the line."""
        if self._terminal:
            getattr(sys.stderr, "overwrite", lambda _: None)(text)
        else:
            print(text, file=sys.stderr, flush=True)

    def line(self) -> str:
        """Return the count and the time left, or the time so far before anything is done."""
        (done, total, counted), now = self._count, time.perf_counter()
        elapsed = in_words(now - self._started)
        if not done:
            return f"{self._what}: {elapsed} so far"
        time_each = (counted - self._started) / done
        remainder = max(time_each - (now - counted), 0.0)  # time left for the item at work
        left = remainder + time_each * (total - done - 1) if done < total else 0.0
        head = f"{self._what}: {100 * done // total} % ({done}/{total})"
        return f"{head}, {in_words(left)} left" if left else f"{head}, {elapsed} so far"


def progress(
    wanted: bool | None, what: str
) -> contextlib.AbstractContextManager[Callable[[int, int], object] | None]:
    """Return the progress line, or a context of None; by default only a terminal has the line."""
    terminal = sys.stderr.isatty()
    if not (terminal if wanted is None else wanted):
        return contextlib.nullcontext()
    return Progress(what, terminal=terminal)


def in_words(seconds: float) -> str:
    """Return a time as text in whole seconds or minutes, or in hours."""
    for unit, size in (("s", 1.0), ("min", 60.0)):
        if seconds < 90.0 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 3600.0:.1f} h"
