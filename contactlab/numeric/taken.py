"""Numbers that stand in for those that nobody gave."""

from __future__ import annotations

from functools import lru_cache

import attrs


class Taken(float):
    """A default that nobody can know: the restitution of two bodies, their adhesion, their yield.

    An author writes one as the default of an option; results then caution of it until a number is
    given, and an equal number that somebody gave makes another law.
    """

    __slots__ = ()


def list_assumptions(law: object) -> dict[str, float]:
    """Return the numbers that a law took as nobody gave them, by the names of its options."""
    law_class: type = type(law)
    names = _options(law_class)
    return {
        name: float(getattr(law, name)) for name in names if isinstance(getattr(law, name), Taken)
    }


@lru_cache(maxsize=128)
def _options(law_class: type) -> tuple[str, ...]:
    """Return the names of the options of a law."""
    fields = attrs.fields(law_class) if attrs.has(law_class) else ()
    return tuple(field.name for field in fields)
