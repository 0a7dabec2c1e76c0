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
#: Least time between two states of the line, and between two lines where it is no terminal, in s.
OFTEN, SELDOM = 0.1, 10.0
#: Time between two states of the line while nothing is counted, in s: the time left goes on.
ALIVE = 0.5


class Progress:
    """Percentage and time left, on one line that is written over; elsewhere a line now and then.

    Used by ``with``: the line ends with the block, however that ends. On a terminal a thread keeps
    it up to date while one of the things that are counted takes long.

    Parameters
    ----------
    what : str
        What is counted.
    terminal : bool
        Whether stderr can write over a line.
    """

    def __init__(self, what: str, *, terminal: bool) -> None:
        self.what, self.terminal = what, terminal
        self._started = self._counted = time.perf_counter()
        self._next = self._started + QUIET
        self._done = self._total = 0
        self._shown = False
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._keep_alive, daemon=True)

    def __enter__(self) -> Self:
        """Begin the line."""
        if self.terminal:
            self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Wipe the line out, or end it with the time that all took."""
        if self.terminal:
            self._ended.set()
            self._thread.join()
            self._overwrite("")
        elif self._total and self._done == self._total:
            now = time.perf_counter()
            if self._shown or now >= self._next:
                print(self._line(now), file=sys.stderr, flush=True)

    def __call__(self, done: int, total: int) -> None:
        """Count ``done`` of ``total``, and show it if it is time for it."""
        self._done, self._total, self._counted = done, total, time.perf_counter()
        if self.terminal or done < total:
            self._show(self._counted)

    def _show(self, now: float) -> None:
        if now < self._next:
            return
        if self.terminal:
            self._overwrite(self._line(now))
        else:
            print(self._line(now), file=sys.stderr, flush=True)
        self._next, self._shown = now + (OFTEN if self.terminal else SELDOM), True

    def _keep_alive(self) -> None:
        while not self._ended.wait(ALIVE):
            self._show(time.perf_counter())

    def _line(self, now: float) -> str:
        elapsed = in_words(now - self._started)
        done, total = self._done, self._total
        if not done:
            return f"{self.what}: {elapsed} so far"
        head = f"{self.what}: {100 * done // total} % ({done}/{total})"
        if done >= total:
            return f"{head}, {elapsed} so far" if self.terminal else f"{head}, took {elapsed}"
        each = (self._counted - self._started) / done
        present = max(each - (now - self._counted), 0.0)  # of the one that is being done
        left = present + each * (total - done - 1)
        return f"{head}, {in_words(left)} left" if left else f"{head}, {elapsed} so far"

    def _overwrite(self, text: str) -> None:
        overwrite = getattr(sys.stderr, "overwrite", None)
        if overwrite is not None:
            overwrite(text)


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
