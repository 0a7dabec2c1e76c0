"""Checks of every law: contract, parameters, copies."""

from __future__ import annotations

import copy
import difflib
import inspect
import pickle
from collections.abc import Iterator
from typing import Any

from contactlab.contracts import (
    API_VERSION,
    CausalTangentialLaw,
    ClosedFormNormalLaw,
    Integrator,
    Law,
    NormalLaw,
    TangentialLaw,
    claims,
)
from contactlab.contracts.law import law_kind
from contactlab.registry.composition import WAYS
from contactlab.registry.law_classes import unfit
from contactlab.testing.check import CHECKS, check, hold
from contactlab.testing.compare import same
from contactlab.testing.units import with_parameters

#: Similarity of two names, from 0 to 1, above which one counts as the other misspelt.
ALIKE = 0.85
#: Values that a numerical parameter must refuse.
BAD_NUMBERS = (float("nan"), float("inf"), float("-inf"), "seven", 1j)
#: Values that a parameter must refuse if it is a word, or True or False.
BAD_WORDS, BAD_FLAGS = ("no such word", 3.5), (float("nan"), "yes", 2)

#: The base of each kind of law.
BASES: dict[str, type[Law]] = {
    "normal": NormalLaw,
    "tangential": TangentialLaw,
    "integrator": Integrator,
}
#: Words that laws may offer without a check, by contract.
UNTESTED = {
    "similar": NormalLaw,
    "plastic": NormalLaw,
    "shares_loss": TangentialLaw,
    "several_contacts": Integrator,
}

#: Words with the method that each promises.
PROMISED: tuple[tuple[str, Any, str], ...] = (
    ("vectors", CausalTangentialLaw, "begin"),
    ("normal_spin", TangentialLaw, "whole_impacts"),
)


def list_words(contract: type[Law]) -> frozenset[str]:
    """Return the words that laws of ``contract`` may offer: the claims that checks test."""
    checked = [each for each in CHECKS if any(issubclass(one, contract) for one in each.contracts)]
    own = {word for word, base in UNTESTED.items() if base is contract}
    own |= {each.claim for each in checked if each.claim}
    own |= set() if contract is Integrator else {"elliptic"}
    return frozenset(own | {each.word[0] for each in checked if each.word})


@check(Law)
def contract(law: Law) -> None:
    """Needs, offers, what parameters waive, and resolution are valid (contract of Law, 3 to 5)."""
    base = BASES[law_kind(law)]
    hold((complaint := unfit(type(law))) is None, f"{complaint}.")
    hold(not law.needs or base is not NormalLaw, "A normal law needs nothing.")
    words = frozenset(each for each in law.needs if isinstance(each, str))
    for name, contract, own in (("needs", NormalLaw, words), ("offers", base, law.offers)):
        known = list_words(contract)
        for word in sorted(own - known):
            listed = ", ".join(sorted(known)) or "none"
            hold(False, f"{name}: {word!r} is a word that no check knows; there are: {listed}.")
    waived = law.waives()
    hold(isinstance(waived, frozenset), f"waives() gave {waived!r}: must be a frozenset of words.")
    for word in sorted(waived - law.offers - words):
        hold(False, f"waives() names {word!r}, which is neither in offers nor in needs.")
    if isinstance(law, TangentialLaw):
        ways = ", ".join(way.__name__ for way in WAYS)
        hold(
            isinstance(law, WAYS),
            f"The law must be derived from one of {ways}, or nobody can run the law.",
        )
    if isinstance(law, Integrator):
        hold(
            any(isinstance(each, type) and issubclass(each, TangentialLaw) for each in law.needs),
            f"needs = {law.needs!r}: must have a class derived from TangentialLaw.",
        )
    for word, promising, method in PROMISED:
        if isinstance(law, promising) and word in claims(law):
            defined = getattr(type(law), method) is not getattr(promising, method)
            hold(defined, f"The law has the word {word!r}, and does not define {method}.")
    if "elastic_hertz" in claims(law):
        hold(
            isinstance(law, ClosedFormNormalLaw),
            "The law offers 'elastic_hertz', and is no ClosedFormNormalLaw.",
        )
    parameter_names = inspect.signature(type(law)).parameters
    hold(
        law.resolution is None or law.resolution in parameter_names,
        f"resolution = {law.resolution!r}: must name a parameter.",
    )


@check(Law)
def spelling(law: Law) -> None:
    """No public name is a misspelling of an optional member of the contracts."""
    own: set[str] = set()
    optional: set[str] = set()
    for owner in type(law).__mro__:
        in_contracts = owner.__module__.startswith("contactlab.contracts")
        (optional if in_contracts else own).update(name for name in vars(owner) if name[0] != "_")
    for name in sorted(own - optional):
        meant = difflib.get_close_matches(name, optional - own, n=1, cutoff=ALIKE)
        hold(not meant, f"{name} is no member of its contracts: {''.join(meant)} misspelt?")


@check(Law)
def api_version(law: Law) -> None:
    """The class states the version of the contracts that it was written for (Law, 2)."""
    version = next(
        (
            owner.__dict__["api_version"]
            for owner in type(law).__mro__
            if "api_version" in vars(owner)
        ),
        None,
    )
    hold(
        type(version) is int and version == API_VERSION,
        f"api_version = {version!r}: contactlab has {API_VERSION}.",
    )


@check(Law)
def expected_failures(law: Law) -> None:
    """Expected failures name checks of such a law, with reasons, and no check of a claim."""
    by_name = {entry.name: entry for entry in CHECKS}
    for name, reason in dict(law.expected_failures).items():
        hold(name in by_name, f"expected_failures names {name!r}, which is not a check.")
        hold(isinstance(reason, str) and len(reason.split()) > 2, f"{name!r} needs a reason.")
        claim = by_name[name].claim
        hold(claim not in claims(law), f"The law offers {claim!r} and expects to fail {name!r}.")
        hold(by_name[name].applies_to(law), f"{name!r} is not a check of such a law.")


@check(Law)
def parameters(law: Law) -> None:
    """Each parameter refuses non-finite values and other types, with its name (Law, 1)."""
    for name, value in _parameters(law):
        for wrong in _wrong(value):
            try:
                with_parameters(law, {name: wrong})
            except ValueError as error:
                hold(name in str(error), f"{name} = {wrong!r}: refused without its name: {error}")
            else:
                hold(False, f"{name} = {wrong!r}: accepted without a ValueError.")


@check(Law)
def immutable(law: Law) -> None:
    """No attribute can be set or added (Law, 1)."""
    for name in (*(name for name, _ in _parameters(law)), "something_new"):
        before = getattr(law, name, None)
        try:
            setattr(law, name, 1.0)
        except (AttributeError, TypeError):
            continue
        object.__setattr__(law, name, before)
        hold(False, f"{name} can be set: freeze the class, attrs.frozen(kw_only=True).")


@check(Law)
def copies(law: Law) -> None:
    """Copies and unpickled copies equal the law (Law, 1)."""
    for made in (copy.copy(law), copy.deepcopy(law), pickle.loads(pickle.dumps(law))):
        hold(same(made, law), f"A copy differs: {made!r}.")
        hold(made == law, "A copy is not equal to the law: attrs.frozen defines equality.")


def _parameters(law: Law) -> Iterator[tuple[str, Any]]:
    """Iterate over the names and values of parameters that are numbers, words or flags."""
    for name in inspect.signature(type(law)).parameters:
        value = getattr(law, name, None)
        if isinstance(value, int | float | str):
            yield name, value


def _wrong(value: float | str) -> tuple[object, ...]:
    """Return values that a parameter must refuse, by the type of its present ``value``."""
    if isinstance(value, bool):
        return BAD_FLAGS
    return BAD_WORDS if isinstance(value, str) else BAD_NUMBERS
