"""The progress line of long work."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable
from typing import Self, TypeAlias

from contactlab.numeric.checks import refuse

#: A function that is called after each item, as ``count(done, total)``.
Count: TypeAlias = Callable[[int, int], object]
#: How a bar that is no function, as tqdm's, is moved by one.
OF_A_BAR = "give True, or: bar = tqdm(); progress=lambda done, total: bar.update(done - bar.n)"
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
        self._share = self._shown = ""

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
            overwrite = getattr(sys.stderr, "overwrite", None)  # of the command line's own stream
            if overwrite is not None:
                overwrite(text)
            elif text or self._shown:
                print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)
            self._shown = text
        else:
            print(text, file=sys.stderr, flush=True)


def follow(
    wanted: bool | Count | None, what: str
) -> contextlib.AbstractContextManager[Count | None]:
    """Return a context with the function to call after each item, the progress line, or None.

    Raises
    ------
    ValueError
        If ``wanted`` is neither True, False, None nor a function.
    """
    if wanted is True:
        return Progress(what, terminal=sys.stderr.isatty())
    if wanted is None or wanted is False:
        return contextlib.nullcontext()
    if isinstance(wanted, type) or not callable(wanted):
        raise refuse("progress", wanted, "must be True or a function of done and total", OF_A_BAR)
    return contextlib.nullcontext(wanted)


def progress(wanted: bool | None, what: str) -> contextlib.AbstractContextManager[Count | None]:
    """Return the progress line, or a context of None; by default only a terminal has the line."""
    return follow(sys.stderr.isatty() if wanted is None else wanted, what)


def in_words(seconds: float) -> str:
    """Return a time as text in whole seconds or minutes, or in hours."""
    for unit, size in (("s", 1.0), ("min", 60.0)):
        if seconds < 90.0 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 3600.0:.1f} h"
