"""Names of laws: ``kind.name``, with ``distribution:`` before it to tell two of one name apart."""

from __future__ import annotations

import re

KINDS = ("normal", "tangential", "integrator")


def parted(name: str) -> tuple[str, str]:
    """Return distribution and plain name: ``("my-laws", "normal.hertz")``; "" for none."""
    distribution, _, plain = name.rpartition(":")
    return distribution, plain


def kind_of(name: str) -> str:
    """Return the part of a name before its dot, without the distribution: ``"normal"``."""
    return parted(name)[1].partition(".")[0]


def full_name(kind: str, name: str) -> str:
    """Return a name with its kind: ``"my-laws:normal.hertz"`` of ``"my-laws:hertz"``.

    Parameters
    ----------
    kind : str
        One of ``KINDS``.
    name : str
        With or without kind and distribution.
    """
    distribution, plain = parted(name)
    plain = plain if plain.startswith(f"{kind}.") else f"{kind}.{plain}"
    return f"{distribution}:{plain}" if distribution else plain


def short_name(name: str) -> str:
    """Return a name without its kind: ``"my-laws:hertz"`` of ``"my-laws:normal.hertz"``."""
    distribution, plain = parted(name)
    kind, _, short = plain.partition(".")
    plain = short if kind in KINDS and short else plain
    return f"{distribution}:{plain}" if distribution else plain


def same_distribution(one: str, other: str) -> bool:
    """Return whether two names are of one distribution: ``My_Laws`` is ``my-laws``."""
    first, second = (re.sub(r"[-_.]+", "-", name).lower() for name in (one, other))
    return first == second
