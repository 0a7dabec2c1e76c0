"""Rules of a class of laws beside its methods, checked once before the class is used."""

from __future__ import annotations

import inspect
from functools import lru_cache
from typing import TypeGuard

from contactlab.contracts.law import API_VERSION, Law, law_kind

#: Methods of integrators that are called with impact, normal motion and law, and their first
#: arguments. A method with another order would get its arguments exchanged.
ORDERED = ("integrate", "integrate_coupled", "errors", "cautions")
ARGUMENTS = ("scene", "normal", "tangential")


@lru_cache(maxsize=256)
def unfit(law: type[Law]) -> str | None:
    """Return why a class cannot be used as a law, with a remedy; None if it can."""
    version = getattr(law, "api_version", None)
    if version != API_VERSION:
        return (
            f"{law.__name__}.api_version is {version!r}, contactlab has {API_VERSION}; if the law "
            f"keeps this contract, write api_version: ClassVar[int] = {API_VERSION} in the class"
        )
    for name, words, entries in (
        ("offers", law.offers, "words"),
        ("needs", law.needs, "words, or classes of laws"),
    ):
        if not isinstance(words, frozenset):
            return (
                f"{law.__name__}.{name} must be a frozenset, a constant of the class; for words "
                "that depend on options define waives()"
            )
        classes = name == "needs"
        if not all(isinstance(each, str) or (classes and is_law_class(each)) for each in words):
            return f"{law.__name__}.{name} = {words!r}: must be {entries}"
    if "controls_error" in law.offers and law.resolution != "tolerance":
        return f"{law.__name__} offers 'controls_error': its resolution must be 'tolerance'"
    return _find_exchange(law) if law_kind(law) == "integrator" else None


def is_law_class(value: object) -> TypeGuard[type[Law]]:
    """Return True for the class of a law of one of the three kinds."""
    return isinstance(value, type) and issubclass(value, Law) and value._kind != ""


def _find_exchange(law: type[Law]) -> str | None:
    """Return which method of an integrator has other arguments than the contract states."""
    if hasattr(law, "resolution_for"):
        return (
            f"{law.__name__}.resolution_for is not asked; return the resolution of each impact as "
            "the third of errors: Errors(psi2, restitution, resolution)"
        )
    for name in ORDERED:
        if name == "integrate_coupled" and "marcher" not in law._ways:
            continue
        names = [*inspect.signature(getattr(law, name)).parameters][1:]  # without self
        if tuple(names[: len(ARGUMENTS)]) != ARGUMENTS:
            return (
                f"{law.__name__}.{name} has the arguments ({', '.join(names)}); they must be "
                f"({', '.join(ARGUMENTS)}), in this order"
            )
    return None
