"""Laws in the words of plans: names, and the options that differ from their defaults."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache, wraps
from typing import ParamSpec, TypeVar

import attrs
import numpy as np

from contactlab.contracts.law import Law, law_kind
from contactlab.numeric.checks import quote
from contactlab.numeric.taken import list_assumptions
from contactlab.registry.registry import REGISTRY

P = ParamSpec("P")
T = TypeVar("T")

#: The address of an object without words of its own, which differs from run to run.
ADDRESS = re.compile(r" at 0x[0-9A-Fa-f]+")


def name_of(law: Law) -> str:
    """Return the name by which a law is made, without its kind; its class if it has no name."""
    return _name(type(law))


def keep_answers(make: Callable[P, T]) -> Callable[P, T]:
    """Return a function of laws that keeps its answers, except for laws without a hash."""
    keep = lru_cache(maxsize=256)(make)

    @wraps(make)
    def tell(*given: P.args, **named: P.kwargs) -> T:
        try:
            return keep(*given, **named)  # type: ignore[arg-type]  # laws without a hash are below
        except TypeError:
            return make(*given, **named)

    return tell


@keep_answers
def in_words(law: Law) -> str:
    """Return the name of a law with the options that differ from their defaults.

    A class that is not of attrs is told by its name alone.
    """
    told = own_options(law)
    return f"{name_of(law)} ({told})" if told else name_of(law)


def own_options(law: Law) -> str:
    """Return the options that differ from their defaults, as a user writes them: ``steps=400``."""
    words = [
        f"{option}={_show_value(value)}"
        for name, option, default in _fields(type(law))
        if (value := getattr(law, name)) is not default and _differs(value, default)
    ]
    return ", ".join(words)


def tell_assumptions(*laws: Law) -> list[str]:
    """Return a caution for each ``Taken`` default that the user left."""
    return [text for law in laws for text in _tell_taken(law)]


@keep_answers
def _tell_taken(law: Law) -> tuple[str, ...]:
    return tuple(
        f"{name_of(law)}: no {name} given, using {value:g}. Set your own: --set "
        f"{law_kind(law)}.{name}=..."
        for name, value in list_assumptions(law).items()
    )


@lru_cache(maxsize=128)
def _name(law_class: type[Law]) -> str:
    return REGISTRY.short_name(law_class)


@lru_cache(maxsize=128)
def _fields(law_class: type) -> tuple[tuple[str, str, object], ...]:
    """Return attribute, option and default of each option that is shown."""
    fields = attrs.fields(law_class) if attrs.has(law_class) else ()
    shown_fields = (field for field in fields if field.init and field.repr)
    return tuple((field.name, field.alias or "", field.default) for field in shown_fields)


def _show_value(value: object) -> str:
    """Return the value of an option in words, without an address."""
    if isinstance(value, np.ndarray) and value.size:
        return f"{np.min(value):.6g} to {np.max(value):.6g}, one an impact"
    return in_words(value) if isinstance(value, Law) else ADDRESS.sub("", quote(value))


def _differs(value: object, default: object) -> bool:
    """Return whether an option differs from its default; False if other options decide it."""
    if isinstance(default, attrs.Factory):  # type: ignore[arg-type]
        return False
    try:
        return bool(value != default)
    except ValueError:  # arrays
        return True
