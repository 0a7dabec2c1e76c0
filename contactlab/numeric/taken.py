"""Defaults that only a measurement could replace."""

from __future__ import annotations

from functools import lru_cache

import attrs


class Taken(float):
    """A default for what only a measurement can tell: restitution, adhesion, yield.

    An author writes it as the default of an option. Results then caution until the user gives a
    number; an equal number from the user makes another law.
    """

    __slots__ = ()


def list_assumptions(law: object) -> dict[str, float]:
    """Return the ``Taken`` defaults of a law that the user left, by the names of its options."""
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
