"""Numbers that stand in for those that nobody gave."""

from __future__ import annotations

from typing import Any

import attrs


class Taken(float):
    """A default that nobody can know: the restitution of two bodies, their adhesion, their yield.

    An author writes one as the default of an option; results then caution of it until a number is
    given, and an equal number that somebody gave makes another law.
    """

    __slots__ = ()


def taken(law: Any) -> dict[str, float]:
    """Return the numbers that a law took as nobody gave them, by the names of its options."""
    fields = attrs.fields(type(law)) if attrs.has(type(law)) else ()
    values = ((field.name, getattr(law, field.name)) for field in fields)
    return {name: float(value) for name, value in values if isinstance(value, Taken)}


def of_taken(*laws: Any) -> list[str]:
    """Return a caution of each number that laws took as nobody gave it."""
    return [
        f"{name} = {value:g} was taken by default: give {type(law).__name__} one of your own"
        for law in laws
        for name, value in taken(law).items()
    ]
