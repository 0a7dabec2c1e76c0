"""Names of laws: ``kind.name``, or ``distribution:kind.name`` if two distributions offer it."""

from __future__ import annotations

import re

KINDS = ("normal", "tangential", "integrator")


def parted(name: str) -> tuple[str, str]:
    """Return distribution and plain name: ``("my-laws", "normal.hertz")``; "" if there is none."""
    distribution, _, plain = name.rpartition(":")
    return distribution, plain


def kind_of(name: str) -> str:
    """Return the part of a name before its dot, without the distribution: ``"normal"``."""
    return parted(name)[1].partition(".")[0]


def full_name(kind: str, name: str) -> str:
    """Return a name with its kind: ``"my-laws:normal.hertz"`` for ``"my-laws:hertz"``."""
    distribution, plain = parted(name)
    plain = plain if plain.startswith(f"{kind}.") else f"{kind}.{plain}"
    return f"{distribution}:{plain}" if distribution else plain


def short_name(name: str) -> str:
    """Return a name without its kind: ``"my-laws:hertz"`` for ``"my-laws:normal.hertz"``."""
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
