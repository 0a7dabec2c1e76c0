"""Standard output and error of a command, safe for any terminal.

Text from a scene file or a plug-in may hold control characters, which move the cursor or change
colours, and symbols that an ASCII terminal cannot show. All output goes through ``Printed``,
which replaces both by letters.
"""

from __future__ import annotations

import contextlib
import io
import re
import sys
import unicodedata
from collections.abc import Iterable, Iterator
from typing import TextIO

#: Control characters, and characters that change the direction of text; not tab and newline.
OBEYED = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]")
#: Letters for symbols that a terminal cannot show; the micro sign is not the letter mu.
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
    """Return text with control characters written as escapes, ESC as ``x1b``."""
    return OBEYED.sub(lambda match: match[0].encode("unicode_escape").decode("ascii"), text)


def fitting(text: str, encoding: str) -> str:
    """Return text with letters, at worst a question mark, for symbols not in ``encoding``."""
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        if len(text) > 1:
            return "".join(fitting(character, encoding) for character in text)
        parts = unicodedata.normalize("NFKD", LETTERS.get(text, text))
        near = "".join(LETTERS.get(part, part) for part in parts)
        return near.encode(encoding, "ignore").decode(encoding) or "?"
    return text


class Printed:
    """A text stream that writes safe text to ``stream``."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._line_shown = False

    def write(self, text: str) -> int:
        """Write the text, and return its length."""
        self.overwrite("")
        self._stream.write(self._fit(text))
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        """Write several texts."""
        self.write("".join(lines))

    def overwrite(self, text: str) -> None:
        """Replace the progress line by ``text``."""
        if text or self._line_shown:
            self._stream.write(("\r\x1b[K" if self._line_shown else "") + self._fit(text))
            self._stream.flush()
            self._line_shown = bool(text)

    def _fit(self, text: str) -> str:
        """Return the text in characters that the stream can show."""
        return fitting(safe(text), getattr(self._stream, "encoding", None) or "utf-8")

    def flush(self) -> None:
        """Pass on what the stream holds back."""
        self._stream.flush()

    def __getattr__(self, name: str) -> object:
        return getattr(self._stream, name)


@contextlib.contextmanager
def fit_terminal() -> Iterator[None]:
    """Redirect stdout and stderr through ``Printed`` inside a ``with`` block."""
    # A program without a terminal may have no streams; print would then take stdout for stderr.
    out, err = (Printed(stream or io.StringIO()) for stream in (sys.stdout, sys.stderr))
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        yield
