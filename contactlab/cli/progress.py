"""The line of progress of long work."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

#: Nothing is shown of work shorter than this, in s.
QUIET = 2.0
#: Least time between two states of the line, and between two lines where it is no terminal, in s.
OFTEN, SELDOM = 0.1, 10.0


class Progress:
    """Percentage and time left, on one line that is written over; elsewhere a line now and then.

    Parameters
    ----------
    what : str
        What is counted.
    terminal : bool
        Whether stderr can write over a line.
    """

    def __init__(self, what: str, *, terminal: bool) -> None:
        self.what, self.terminal = what, terminal
        self._started = time.perf_counter()
        self._next = self._started + QUIET
        self._shown = False

    def __call__(self, done: int, total: int) -> None:
        """Show that ``done`` of ``total`` are done, if it is time for it."""
        now = time.perf_counter()
        elapsed = now - self._started
        ended = done >= total
        if self.terminal:
            if ended or now >= self._next:
                self._overwrite("" if ended else self._line(done, total, elapsed))
                self._next = max(self._next, now + OFTEN)
        elif now >= self._next or (ended and self._shown):
            print(self._line(done, total, elapsed), file=sys.stderr, flush=True)
            self._next, self._shown = now + SELDOM, True

    def _line(self, done: int, total: int, elapsed: float) -> str:
        head = f"{self.what}: {100 * done // max(total, 1)} % ({done}/{total})"
        if done >= total:
            return f"{head}, took {in_words(elapsed)}"
        return f"{head}, {in_words(elapsed * (total - done) / done)} left" if done else head

    def _overwrite(self, text: str) -> None:
        overwrite = getattr(sys.stderr, "overwrite", None)
        if overwrite is not None:
            overwrite(text)


def progress(wanted: bool | None, what: str) -> Callable[[int, int], object] | None:
    """Return what shows progress on stderr, or None: by default only on a terminal."""
    terminal = sys.stderr.isatty()
    if not (terminal if wanted is None else wanted):
        return None
    return Progress(what, terminal=terminal)


def in_words(seconds: float) -> str:
    """Return a time to wait for, in whole seconds, minutes or hours."""
    for unit, size in (("s", 1.0), ("min", 60.0)):
        if seconds < 90.0 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 3600.0:.1f} h"
