"""Which laws fit together, and how a name becomes a law."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from contactlab.checks import refuse
from contactlab.contracts.integrator import Integrator
from contactlab.contracts.law import Law
from contactlab.contracts.normal import ClosedFormNormalLaw, NormalLaw
from contactlab.contracts.phases import PhasedTangentialLaw
from contactlab.contracts.tangential import (
    SteppedTangentialLaw,
    TangentialLaw,
    WholeImpactTangentialLaw,
)
from contactlab.registry import REGISTRY, PluginError

#: Taken where none is named, the first that is installed and fits: exact, then of second order,
#: then for any normal law. A default has to be a name; that is all the privilege there is.
DEFAULT_NORMAL = "hertz"
PREFERRED = {
    "tangential": ("fronts", "springs", "coulomb"),
    "integrator": ("events", "symplectic"),
}
#: The ways in which a tangential law can be run: one of them it must be.
WAYS = (SteppedTangentialLaw, PhasedTangentialLaw, WholeImpactTangentialLaw)


def law(kind: str, value: object) -> Any:
    """Return the law of ``kind`` that ``value`` names or already is."""
    if isinstance(value, str):
        return REGISTRY.create(value if value.startswith(f"{kind}.") else f"{kind}.{value}")
    if isinstance(value, Law) and value.kind == kind:
        return value
    remedy = f"installed: {', '.join(REGISTRY.names(kind))}"
    if isinstance(value, type) and issubclass(value, Law):
        remedy = f"this is the class; make one: {value.__name__}()"
    raise refuse(kind, value, f"must be a name or a {kind} law", remedy)


def compose(
    normal: object, tangential: object, integrator: object
) -> tuple[NormalLaw, TangentialLaw, Integrator]:
    """Return three laws that fit, from names, laws, or None for the best that fits.

    Raises
    ------
    ValueError
        If a name is not installed, or the laws do not fit together (naming what would).
    """
    pressing = law("normal", DEFAULT_NORMAL if normal is None else normal)
    rubbing = _chosen("tangential", tangential, pressing)
    following = _chosen("integrator", integrator, pressing, rubbing)
    if (complaint := misfit(pressing, rubbing, following)) is not None:
        raise ValueError(complaint + _would_fit(pressing, rubbing, following))
    return pressing, rubbing, following


def _chosen(kind: str, value: object, *others: Law) -> Any:
    """Return the law given, or the first of those preferred that fits the others."""
    if value is not None:
        return law(kind, value)
    first: Any = None
    for name in PREFERRED[kind]:
        try:
            found = law(kind, name)
        except ValueError:  # blocked, or not installed
            continue
        first = found if first is None else first
        if misfit(*others, found) is None:
            return found
    if first is None:
        raise refuse(kind, None, "must be given: none of the defaults is installed",
                     f"installed: {', '.join(REGISTRY.names(kind))}")  # fmt: skip
    return first


def misfit(normal: Any, tangential: Any, integrator: Any = None) -> str | None:
    """Return why laws do not fit, naming both parties; None if they do."""
    if "elastic_hertz" in normal.offers and not isinstance(normal, ClosedFormNormalLaw):
        return (
            f"normal = {_name(normal)}: offers 'elastic_hertz', and is no ClosedFormNormalLaw; "
            "derive it from that class, or do not offer the word"
        )
    if not isinstance(tangential, WAYS):
        ways = ", ".join(way.__name__ for way in WAYS)
        return f"tangential = {_name(tangential)}: must be derived from one of {ways}"
    for word in sorted(tangential.needs - normal.offers):
        return (
            f"tangential = {_name(tangential)}: needs {word!r} of the normal law, which "
            f"{_name(normal)} does not offer"
        )
    if integrator is None or isinstance(tangential, WholeImpactTangentialLaw):
        return None
    if not isinstance(tangential, integrator.tangential_contract):
        return (
            f"integrator = {_name(integrator)}: runs a {integrator.tangential_contract.__name__}, "
            f"and tangential = {_name(tangential)} is none"
        )
    if not isinstance(normal, integrator.normal_contract):
        return (
            f"integrator = {_name(integrator)}: needs a {integrator.normal_contract.__name__}, "
            f"and normal = {_name(normal)} is none"
        )
    return None


def _would_fit(normal: Law, tangential: Law, integrator: Law) -> str:
    """Return which laws would fit in the place of one, of those that need no new import."""
    parts = {"normal": normal, "tangential": tangential, "integrator": integrator}
    found = []
    for kind in parts:
        fits = []
        for name, other in _candidates(kind):
            if misfit(*{**parts, kind: other}.values()) is None:
                fits.append(name)
        if fits:
            found.append(f"{kind} {' or '.join(fits)}")
    return f"; these would fit instead: {'; '.join(found)}" if found else "; no law at hand fits"


def _candidates(kind: str) -> Iterator[tuple[str, Law]]:
    """Iterate over laws made with their defaults: those of this distribution, or loaded before.

    Other people's plug-ins are not imported for the sake of a message.
    """
    for info in REGISTRY.installed():
        if info.kind != kind or info.blocked or not REGISTRY.at_hand(info):
            continue
        try:
            yield info.name, REGISTRY.create(info.name)
        except (PluginError, ValueError):
            continue


def _name(law: Law) -> str:
    return type(law).__name__


def versions(*laws: Law) -> dict[str, str]:
    """Return each law's kind with its name and version, for the record."""
    return {law.kind: REGISTRY.describe(law) for law in laws}
