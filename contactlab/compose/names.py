"""Names of laws: ``kind.name``, or ``distribution:kind.name`` if two distributions offer it.

A law that is not installed is named by its place: ``my_law.py:Stribeck``, a class in a file, or
``package.module:Stribeck``. Such a name has neither distribution nor kind.
"""

from __future__ import annotations

import re
from pathlib import Path

KINDS = ("normal", "tangential", "integrator")
#: The place of a law: a Python file, or a module and a class, which begins with a capital.
PLACE = re.compile(r"\.py(:|$)|:[A-Z]\w*$")


def is_place(name: str) -> bool:
    """Return True if a name is the place of a law: ``my_law.py:Stribeck``."""
    return PLACE.search(name) is not None


def seen_from(folder: Path, name: str) -> str:
    """Return a name in a file of ``folder``: the path of a law in a file begins there."""
    return str(folder / name) if re.search(r"\.py(:|$)", name) else name


def parted(name: str) -> tuple[str, str]:
    """Return distribution and plain name: ``("my-laws", "normal.hertz")``; "" if there is none."""
    if is_place(name):
        return "", name
    distribution, _, plain = name.rpartition(":")
    return distribution, plain


def kind_of(name: str) -> str:
    """Return the part of a name before its dot, without the distribution: ``"normal"``."""
    return parted(name)[1].partition(".")[0]


def full_name(kind: str, name: str) -> str:
    """Return a name with its kind: ``"my-laws:normal.hertz"`` for ``"my-laws:hertz"``."""
    if is_place(name):
        return name
    distribution, plain = parted(name)
    plain = plain if plain.startswith(f"{kind}.") else f"{kind}.{plain}"
    return f"{distribution}:{plain}" if distribution else plain


def short_name(name: str) -> str:
    """Return a name without its kind: ``"my-laws:hertz"`` for ``"my-laws:normal.hertz"``."""
    if is_place(name):
        return name
    distribution, plain = parted(name)
    kind, _, short = plain.partition(".")
    plain = short if kind in KINDS and short else plain
    return f"{distribution}:{plain}" if distribution else plain


def same_distribution(first: str, second: str) -> bool:
    """Return True if two names mean the same distribution, as ``My_Laws`` and ``my-laws`` do."""
    return normal_form(first) == normal_form(second)


def normal_form(distribution: str) -> str:
    """Return the name of a distribution in small letters, with hyphens: ``my-laws``."""
    return re.sub(r"[-_.]+", "-", distribution).lower()
