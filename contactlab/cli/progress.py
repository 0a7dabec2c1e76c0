"""The progress line of long work."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable
from typing import Self

#: Work shorter than this shows no progress, in s.
QUIET = 2.0
#: Least time between updates of the line on a terminal, and between lines elsewhere, in s.
OFTEN, SELDOM = 0.5, 10.0


class Progress:
    """Percentage and time left on stderr, updated when an item is done.

    On a terminal one line is overwritten, and cleared at the end; elsewhere each update is a new
    line, and the last one is the total time.
    """

    def __init__(self, what: str, *, terminal: bool) -> None:
        self._what, self._terminal = what, terminal
        self._started = time.perf_counter()
        self._next = self._started + QUIET
        self._share = ""

    def __enter__(self) -> Self:
        """Return the progress line."""
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        """Clear the line, or print the total time of finished work."""
        elapsed = time.perf_counter() - self._started
        if self._terminal:
            self._put("")
        elif kind is None and self._share and elapsed >= QUIET:
            self._put(f"{self._share}, took {in_words(elapsed)}")

    def __call__(self, done: int, total: int) -> None:
        """Show that ``done`` of ``total`` items are done, and the time left at this pace."""
        now = time.perf_counter()
        self._share = f"{self._what}: {100 * done // total} % ({done}/{total})"
        if now >= self._next and 0 < done < total:
            self._next = now + (OFTEN if self._terminal else SELDOM)
            left = (now - self._started) / done * (total - done)
            self._put(f"{self._share}, {in_words(left)} left")

    def _put(self, text: str) -> None:
        """Print one state of the line."""
        if self._terminal:
            getattr(sys.stderr, "overwrite", lambda _: None)(text)
        else:
            print(text, file=sys.stderr, flush=True)


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
