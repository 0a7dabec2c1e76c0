"""Which laws fit together, and how a name becomes a law."""

from __future__ import annotations

from typing import Any

from contactlab.checks import refuse
from contactlab.contracts.law import Law
from contactlab.contracts.normal import ClosedFormNormalLaw
from contactlab.registry import REGISTRY, PluginError

#: Taken where none is named: exact where the laws allow it, else of second order.
PREFERRED_INTEGRATORS = ("events", "symplectic")
#: What only a ``ClosedFormNormalLaw`` may offer.
CLOSED_FORM = frozenset({"closed_form_motion", "elastic_hertz"})


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


def fitting_integrator(normal: Law, tangential: Law) -> str:
    """Return the name of the first of ``PREFERRED_INTEGRATORS`` that fits, or else the first."""
    for name in PREFERRED_INTEGRATORS:
        try:
            integrator = law("integrator", name)
        except ValueError:
            continue
        if _unmet(normal, tangential, integrator) is None:
            return name
    return PREFERRED_INTEGRATORS[0]


def check_fit(normal: Law, tangential: Law, integrator: Law) -> None:
    """Refuse laws whose needs the other two do not offer, naming what would fit.

    Raises
    ------
    ValueError
        Naming both parties, the missing words and the installed laws that offer them.
    """
    claimed = sorted(CLOSED_FORM & normal.offers)
    if claimed and not isinstance(normal, ClosedFormNormalLaw):
        raise ValueError(
            f"normal = {type(normal).__name__}: offers {claimed[0]!r}, and is no "
            "ClosedFormNormalLaw; derive it from that class, or do not offer the word"
        )
    parts = (normal, tangential, integrator)
    unmet = _unmet(*parts)
    if unmet is None:
        return
    part, word = unmet
    others = [other for other in parts if other is not part]
    fitting = [name for name in _offering(word) if name.partition(".")[0] != part.kind]
    would = f"these would fit: {', '.join(fitting)}" if fitting else "no installed law does"
    raise ValueError(
        f"{part.kind} = {type(part).__name__}: needs {word!r}, which neither "
        f"{type(others[0]).__name__} nor {type(others[1]).__name__} offers; {would}"
    )


def _unmet(*parts: Law) -> tuple[Law, str] | None:
    """Return the first law that needs a word which none of the others offers, and the word."""
    for part in parts:
        offered = frozenset[str]().union(*(other.offers for other in parts if other is not part))
        if missing := part.needs - offered:
            return part, min(missing)
    return None


def versions(*laws: Law) -> dict[str, str]:
    """Return each law's kind with its name and version, for the record."""
    return {law.kind: REGISTRY.describe(law) for law in laws}


def _offering(word: str) -> list[str]:
    """Names of installed laws that offer ``word``; broken plug-ins are passed over."""
    found = []
    for name in REGISTRY.names():
        try:
            law = REGISTRY.law_class(name)
        except (PluginError, ValueError):
            continue
        if word in law.offers:
            found.append(name)
    return found
