"""What the kit says of each broken law, in full: the file beside this one, and how to compare."""

from __future__ import annotations

import math
import re
from pathlib import Path

FILE = Path(__file__).with_name("sentences.txt")
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
#: Numbers below this are rounding: two of them are alike.
ROUNDING = 1e-12


def written() -> dict[tuple[str, str], str]:
    """Return the sentences of the file, by law and check."""
    lines = FILE.read_text(encoding="utf-8").splitlines()
    parts = [line.split(" | ", 2) for line in lines]
    assert len({(law, check) for law, check, _ in parts}) == len(parts)
    return {(law, check): sentence for law, check, sentence in parts}


def plain(sentence: str) -> str:
    """Return a sentence without a law's nature, and what Python, NumPy and lines make of it."""
    sentence = sentence.partition(" If that is the law's nature")[0]
    return re.sub(r"np\.\w+\((\S+?)\)", r"\1", re.sub(r", line \d+\)", ")", sentence))


def alike(sentence: str, expected: str) -> bool:
    """Return whether two sentences are equal, but for one unit in the last place of a number.

    An expected sentence that ends with … is the beginning of one.
    """
    sentence, expected = plain(sentence), plain(expected)
    if expected.endswith("…"):
        return sentence.startswith(expected[:-1])
    if NUMBER.sub("#", sentence) != NUMBER.sub("#", expected):
        return False
    pairs = zip(NUMBER.findall(sentence), NUMBER.findall(expected), strict=True)
    return all(_close(told, number) for told, number in pairs)


def _close(told: str, expected: str) -> bool:
    """Return whether a number is the one expected, to a unit in its last place or to 1e-7."""
    if told == expected:
        return True
    digits, _, exponent = expected.partition("e")
    if "." not in digits and not exponent:
        return False  # a count
    unit = 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))
    left, right = float(told), float(expected)
    if max(abs(left), abs(right)) < ROUNDING:
        return True
    return abs(left - right) <= 1.01 * unit or math.isclose(left, right, rel_tol=1e-7)
