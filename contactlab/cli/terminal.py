"""The two streams of a command, made fit to be seen on any terminal.

Text from a scene file or of a plug-in may hold control characters, which would move the cursor
or change colours, and symbols that an ASCII terminal has not. Whatever is printed, by anyone,
goes through ``Printed``, which writes both in letters.
"""

from __future__ import annotations

import contextlib
import io
import re
import sys
import threading
import unicodedata
from collections.abc import Iterable, Iterator
from typing import Any, TextIO

#: Characters that a terminal obeys, or that change the direction of writing; not tab and newline.
OBEYED = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")
#: Symbols in letters, for terminals without them; the micro sign is not the letter mu.
LETTERS = {
    "\N{MICRO SIGN}": "u", "\N{GREEK SMALL LETTER MU}": "mu", "\N{GREEK SMALL LETTER NU}": "nu",
    "\N{GREEK SMALL LETTER RHO}": "rho", "ψ": "psi", "χ": "chi", "ω": "omega", "κ": "kappa",
    "ζ": "zeta", "τ": "tau", "π": "pi", "Δ": "Delta", "°": "deg", "±": "+-", "≤": "<=", "≥": ">=",
    "≈": "~", "\N{MULTIPLICATION SIGN}": "x", "·": ".", "√": "sqrt", "∞": "inf", "→": "->",
    "\N{MINUS SIGN}": "-", "\N{EN DASH}": "-", "—": "-", "\N{LEFT SINGLE QUOTATION MARK}": "'",
    "\N{RIGHT SINGLE QUOTATION MARK}": "'", "“": '"', "”": '"', "\N{FRACTION SLASH}": "/",
    "ß": "ss", "ø": "o", "§": "section ", "∫": "int",
}  # fmt: skip


def safe(text: str) -> str:
    """Return text with the characters that a terminal obeys written out, ESC as ``x1b``."""
    return OBEYED.sub(lambda found: found[0].encode("unicode_escape").decode("ascii"), text)


def fitting(text: str, encoding: str) -> str:
    """Return text with what ``encoding`` has not put in letters."""
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        return "".join(_letters(character, encoding) for character in text)
    return text


def _letters(character: str, encoding: str) -> str:
    """Return the nearest to a character that ``encoding`` has, at worst a question mark."""
    with contextlib.suppress(UnicodeEncodeError):
        character.encode(encoding)
        return character
    parts = unicodedata.normalize("NFKD", LETTERS.get(character, character))
    near = "".join(LETTERS.get(part, part) for part in parts)
    return near.encode(encoding, "ignore").decode(encoding) or "?"


class Screen:
    """What the two streams of a command share.

    Attributes
    ----------
    lock : lock
        Held while one of them writes: the line of progress is written by a thread.
    progress : text stream or None
        The stream with an unfinished line of progress, if there is one.
    within_line : bool
        Whether what was printed last is to go on in the same line.
    """

    def __init__(self) -> None:
        self.lock = threading.RLock()
        self.progress: TextIO | None = None
        self.within_line = False


class Printed:
    """A text stream that passes on only what the stream below can show.

    Parameters
    ----------
    stream : text stream
        Where the text goes; of everything but ``write`` it decides.
    screen : Screen
        Shared by the two streams of a command, so that whatever is printed first wipes the line
        of progress out.
    """

    def __init__(self, stream: TextIO, screen: Screen) -> None:
        self._stream, self._screen = stream, screen

    def write(self, text: str) -> int:
        """Write text, after the line of progress has been wiped out."""
        with self._screen.lock:
            self.overwrite("")
            self._stream.write(self._fit(text))
            if text:
                self._screen.within_line = not text.endswith("\n")
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        """Write several texts."""
        for line in lines:
            self.write(line)

    def overwrite(self, text: str) -> None:
        """Put ``text`` in place of the last line of progress; an empty one leaves none.

        In the middle of a line that is being printed nothing is put.
        """
        screen = self._screen
        with screen.lock:
            if screen.progress is not None:
                screen.progress.write("\r\x1b[K")
                screen.progress.flush()
                screen.progress = None
            if text and not screen.within_line:
                screen.progress = self._stream
                self._stream.write(self._fit(text))
                self._stream.flush()

    def _fit(self, text: str) -> str:
        return fitting(safe(text), getattr(self._stream, "encoding", None) or "utf-8")

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextlib.contextmanager
def fitted() -> Iterator[None]:
    """Put ``Printed`` over stdout and stderr inside a ``with`` block."""
    screen = Screen()
    # A program without a terminal may have no streams; print would then take stdout for stderr.
    out, err = (Printed(stream or io.StringIO(), screen) for stream in (sys.stdout, sys.stderr))
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        yield
