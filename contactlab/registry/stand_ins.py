"""Laws that stand in where friction changes the approach and the composed laws have no answer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from contactlab.contracts.law import Law
from contactlab.impact.scene import Scene
from contactlab.registration.bring import state
from contactlab.registration.names import KINDS
from contactlab.registry.composition import FOR_COUPLED, RIGID, Laws, misfit
from contactlab.registry.registry import REGISTRY

#: The word of integrators that march the contacts of a gathering.
SEVERAL = "several_contacts"


def stand_in(laws: Laws, part: Scene) -> Laws:
    """Return the laws of impacts in which friction changes the approach.

    Where a law that nobody named has no answer, another stands in for it.

    Raises
    ------
    ValueError
        If a law that the user named has no answer; the message names laws that have one.
    """
    if "rigid" not in laws.capability.tangential_claims and _no_answer(laws, part) is None:
        return laws
    key = part.planar, part.links is None, state()
    if (found := laws.stand_ins.get(key)) is None:
        found = laws.stand_ins[key] = _find_stand_in(laws, part)
    return found


def _find_stand_in(laws: Laws, part: Scene) -> Laws:
    """Return the result of ``stand_in``, which keeps it."""
    lacking = _no_answer(laws, part)
    if lacking is None and not _rigid_in_silence(laws):
        return laws
    for _, other in _fitting(laws, [kind for kind in KINDS if kind not in laws.named]):
        if _no_answer(other, part) is None:
            return other
    remedy = _remedy(laws, part)
    if lacking is None:
        name = RIGID["tangential"]
        refused = f"{_name(laws.tangential)}: rigid theory must be named"
        remedy += f"; for rigid bodies write tangential={name!r}"
    else:
        law, reason = lacking
        where = "friction affects the approach" if part.planar else "the slip turns"
        if part.links is not None:
            where = "several contacts act at once"
        refused = f"{_name(law)}: has no answer, as {where} and {reason}"
    raise ValueError(f"{refused}; {remedy}")


def _no_answer(laws: Laws, part: Scene) -> tuple[Law, str] | None:
    """Return which law has no answer where friction changes the approach, and why; else None."""
    able, turns = laws.capability, not part.planar
    law: Law = laws.tangential
    reason = None
    if turns and "vectors" not in able.tangential_claims:
        reason = "the law follows slip along one line"
    elif able.coupled is not None and part.links is None:
        return None
    elif able.causal is None:
        reason = "the law needs the normal motion first"
    elif able.marcher is None:
        law, reason = laws.integrator, "the integrator needs the normal motion first"
    elif part.links is not None and SEVERAL not in laws.integrator.offers:
        law, reason = laws.integrator, "the integrator marches each contact by itself"
    return None if reason is None else (law, reason)


def _fitting(laws: Laws, kinds: Iterable[str]) -> Iterator[tuple[dict[str, str], Laws]]:
    """Yield what ``FOR_COUPLED`` names of ``kinds``, and the laws with it, where they fit."""
    free = set(kinds)
    for names in FOR_COUPLED:
        taken = {kind: name for kind, name in names.items() if kind in free}
        try:
            other = laws.taking(taken)
        except ValueError:  # blocked, or not installed
            continue
        if misfit(*other) is None:
            yield taken, other


def _rigid_in_silence(laws: Laws) -> bool:
    """Return whether nobody named rigid theory, and an elastic law runs beside the normal law."""
    if "tangential" in laws.named or "rigid" not in laws.capability.tangential_claims:
        return False
    return next(_fitting(laws, KINDS), None) is not None


def _remedy(laws: Laws, part: Scene) -> str:
    """Return which laws to take in place of those that have no answer."""
    for names, other in _fitting(laws, KINDS):
        if _no_answer(other, part) is None:
            words = ", ".join(f"{kind}={name!r}" for kind, name in names.items())
            return f"use {words}, or leave both out"
    return (
        f"no law at hand has an answer with normal = {_name(laws.normal)}; use another normal law"
    )


def _name(law: Law) -> str:
    return REGISTRY.short_name(law)
