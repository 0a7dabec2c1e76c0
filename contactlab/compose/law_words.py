"""Laws in the words of plans: names, and the options that differ from their defaults."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache

import attrs

from contactlab.compose.registry import REGISTRY
from contactlab.contracts.law import Law
from contactlab.numeric.checks import shown

#: The address of an object without words of its own, which differs from run to run.
ADDRESS = re.compile(r" at 0x[0-9A-Fa-f]+")


def name_of(law: Law) -> str:
    """Return the name by which a law is made, without its kind; its class if it has no name."""
    return _name(type(law))


def in_words(law: Law) -> str:
    """Return the name of a law with the options that differ from their defaults.

    They are those of an attrs class; of another class the name stands alone.
    """
    told = own_options(law)
    return f"{name_of(law)} ({told})" if told else name_of(law)


def own_options(law: Law) -> str:
    """Return the options that differ from their defaults, as a user writes them: ``steps=400``."""
    return ", ".join(_options(law))


@lru_cache(maxsize=128)
def _name(law_class: type[Law]) -> str:
    return REGISTRY.short_name(law_class)


def _options(law: Law) -> Iterator[str]:
    """Yield the options that differ from their defaults."""
    law_class: type = type(law)
    for field in attrs.fields(law_class) if attrs.has(law_class) else ():
        value = getattr(law, field.name)
        if field.init and field.repr and _differs(value, field.default):
            words = in_words(value) if isinstance(value, Law) else ADDRESS.sub("", shown(value))
            yield f"{field.alias}={words}"


def _differs(value: object, default: object) -> bool:
    """Return whether an option has another value than its default."""
    try:
        return bool(value != default)
    except ValueError:  # arrays
        return True
