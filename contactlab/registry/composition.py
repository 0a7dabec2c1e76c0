"""Composition of laws that fit together, and of a law from its name."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, Literal, overload

import attrs

from contactlab.contracts.integrator import Integrator
from contactlab.contracts.law import Law, claims, law_kind, requirements
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.path import PathTangentialLaw
from contactlab.contracts.tangential import (
    SteppedTangentialLaw,
    TangentialLaw,
    WholeImpactTangentialLaw,
)
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Real
from contactlab.registration.bring import state
from contactlab.registration.names import KINDS, full_name, is_place, short_name
from contactlab.registry.capability import Capability
from contactlab.registry.law_classes import is_law_class, unfit
from contactlab.registry.registry import REGISTRY, PluginError

#: Defaults are plug-in names; the first of a list that is installed and fits wins. Coulomb's law at
#: every point comes first, for any normal law with a radius, then laws that need less.
DEFAULT_NORMAL = "hertz"
PREFERRED = {
    "tangential": ("annulus", "springs", "coulomb"),
    "elastic": ("fronts", "springs", "coulomb"),  # under elastic Hertz contact: fronts is exact
    "viscous": ("springs", "annulus", "coulomb"),  # springs share the loss of the normal law
    "integrator": ("events", "symplectic"),
    "steps": ("symplectic", "events"),  # integrators of laws that are stepped and nothing else
}
#: Laws that the core and the studies request by purpose: exact answers between elastic spheres,
#: fixed steps, prescribed paths, and a restitution.
EXACT = {"tangential": "fronts", "integrator": "events"}
#: Option of the exact law by which it follows every impact and reads no table.
FOLLOWED = {"table": False}
FIXED_STEPS = "symplectic"
#: Integrators of fixed steps under which laws are mapped, the usual one first.
STEPPED = (FIXED_STEPS, "paper")
ON_A_PATH = "springs"
#: Rigid bodies, which stiff contacts tend to.
RIGID = {"tangential": "coulomb"}
#: Laws of impacts in which friction changes the approach: exact in the plane under elastic Hertz
#: contact, springs otherwise.
FOR_COUPLED = (EXACT, {"tangential": ON_A_PATH, "integrator": FIXED_STEPS})
RESTITUTION = {"normal": "viscoelastic", "tangential": "springs"}
#: Contracts of tangential laws that can be run; every law must be derived from one of them.
WAYS = (SteppedTangentialLaw, PathTangentialLaw, WholeImpactTangentialLaw)
#: The words of ``WAYS``.
RUN = frozenset({"stepped", "path", "whole"})
STEPS = {"stepped"}


@attrs.frozen
class Laws:
    """Three laws that fit together, the kinds of those that the user ``named``, what they can do.

    Resolutions of the kinds ``by_scene`` were chosen for impacts, for a ``reason``, as nobody named
    them; ``asked`` are the laws without.

    Iterating yields the laws in the order of their kinds.
    """

    normal: NormalLaw
    tangential: TangentialLaw
    integrator: Integrator
    named: frozenset[str] = frozenset(KINDS)
    by_scene: frozenset[str] = frozenset()
    reason: str = ""
    asked: Laws | None = None
    capability: Capability = attrs.field(init=False, eq=False, repr=False)
    #: Laws that stand in for these, by the arguments of the question; composing laws takes longer.
    stand_ins: dict[Any, Laws] = attrs.field(init=False, eq=False, repr=False, factory=dict)

    @capability.default
    def _capability(self) -> Capability:
        return Capability.of(self.normal, self.tangential, self.integrator)

    def __iter__(self) -> Iterator[Law]:
        return iter((self.normal, self.tangential, self.integrator))

    def by_kind(self) -> dict[str, Any]:
        """Return the laws by kind."""
        return dict(zip(KINDS, self, strict=True))

    def taking(self, names: Mapping[str, str]) -> Laws:
        """Return the laws with others of some kinds, by name."""
        return self.change(**{kind: law(kind, name) for kind, name in names.items()})

    def change(self, **laws: Any) -> Laws:
        """Return the laws with others of some kinds."""
        return attrs.evolve(self, **laws)


#: Sentences for the words that a law needs of a normal law, or an integrator of its laws.
NEEDS = {
    "elastic_hertz": "elastic Hertz contact",
    "radius": "a contact radius",
    "hertzian_pressure": "Hertz's pressure profile",
}
RUNS = {
    "PathTangentialLaw": "laws of events",
    "SteppedTangentialLaw": "laws of steps",
    "ClosedFormNormalLaw": "normal laws in closed form",
}


@overload
def law(kind: Literal["normal"], value: object, **options: object) -> NormalLaw: ...
@overload
def law(kind: Literal["tangential"], value: object, **options: object) -> TangentialLaw: ...
@overload
def law(kind: Literal["integrator"], value: object, **options: object) -> Integrator: ...
@overload
def law(kind: str, value: object, **options: object) -> Law: ...
def law(kind: str, value: object, **options: object) -> Law:
    """Return the law of ``kind`` that ``value`` names, made with ``options``; or a law as it is."""
    if isinstance(value, str):
        name = full_name(kind, value)
        law_class = REGISTRY.law_class(name)
        if (own := law_kind(law_class)) != kind:
            raise refuse(kind, value, f"is a law of kind {own!r}", f"pass the law as {own}")
        return REGISTRY.create(name, **options) if options else _with_defaults(name, law_class)
    if isinstance(value, Law) and law_kind(value) == kind:
        if (complaint := unfit(type(value))) is not None:
            raise ValueError(f"{kind} = {complaint}")
        return value
    remedy = "names: contactlab plugins list"
    if is_law_class(value) and not value.__abstractmethods__:
        remedy = f"this is the class; make one: {value.__name__}()"
    raise refuse(kind, value, f"must be a name or a {kind} law", remedy)


@lru_cache(maxsize=128)
def _with_defaults(name: str, _: type[Law]) -> Law:
    """Return the law of a name with its defaults; one immutable law serves all simulations."""
    # The class is part of the key: another plug-in may take the name over.
    return REGISTRY.create(name)


def exact(tolerance: float) -> dict[str, Any]:
    """Return laws for ``Simulation`` that follow elastic spheres exactly, psi2 to ``tolerance``."""
    return {
        "tangential": law("tangential", EXACT["tangential"], **FOLLOWED),
        "integrator": law("integrator", EXACT["integrator"], tolerance=tolerance),
    }


def viscous(restitution: Real) -> NormalLaw:
    """Return the normal law of a coefficient of restitution: one loss for pressure and shear."""
    return law("normal", RESTITUTION["normal"], restitution=restitution)


def fixed_steps(steps: int) -> Integrator:
    """Return an integrator with fixed steps."""
    return law("integrator", FIXED_STEPS, steps=steps)


def compose(normal: object, tangential: object, integrator: object) -> Laws:
    """Return three laws that fit, from names or laws; None stands for the preferred law."""
    for each in (normal, tangential, integrator):
        if each is not None and (type(each) is not str or is_place(each)):  # files may change
            return _compose(normal, tangential, integrator)
    return _by_names(normal, tangential, integrator, state())


def _compose(normal: object, tangential: object, integrator: object, _: object = None) -> Laws:
    given = {"normal": normal, "tangential": tangential, "integrator": integrator}
    named = {kind: law(kind, value) for kind, value in given.items() if value is not None}
    laws = _complete(named)
    check(laws)
    return laws


#: Laws of three names; the plug-ins at hand are part of the key.
_by_names = lru_cache(maxsize=256)(_compose)


def _complete(given: Mapping[str, Law]) -> Laws:
    """Return laws with the preferred ones of the kinds that are not named."""
    named: dict[str, Any] = {**given}
    first = named.get("normal") or law("normal", DEFAULT_NORMAL)
    third = named.get("integrator")
    second = named.get("tangential")
    if second is None:
        _, second = _prefer("tangential", first, after=() if third is None else (third,))
    if third is None:
        _, third = _prefer("integrator", first, second)
    return Laws(first, second, third, frozenset(named))


def check(laws: Laws) -> None:
    """Refuse three laws that do not fit, naming what would fit beside those that are named."""
    if (complaint := misfit(*laws)) is not None:
        raise ValueError(complaint + _would_fit(laws))


def prefer_law(kind: str, *before: Law, after: tuple[Law, ...] = ()) -> str:
    """Return the name of the first law in ``PREFERRED`` that fits, or of the first installed."""
    # ``before`` are the laws in front of this kind, ``after`` is a named integrator.
    return _prefer(kind, *before, after=after)[0]


def _prefer(kind: str, *before: Law, after: tuple[Law, ...] = ()) -> tuple[str, Any]:
    """Return the preferred law with its name; arguments as in ``prefer_law``."""
    installed: list[tuple[str, Any]] = []
    which = kind
    if kind == "tangential" and "elastic_hertz" in claims(before[0]):
        which = "elastic"
    elif kind == "tangential" and "viscous" in claims(before[0]):
        which = "viscous"
    elif kind == "integrator" and before[-1]._ways & RUN == STEPS:
        which = "steps"  # no other integrator is imported
    for name in PREFERRED[which]:
        try:
            candidate = law(kind, name)
        except ValueError:  # blocked, or not installed
            continue
        if _fits(*before, candidate, *after):
            if installed and after and "rigid" in claims(candidate):
                _refuse_rigid(name, installed, before[0], after[0])
            return name, candidate
        installed.append((name, candidate))
    if not installed:
        why = "must be given: none of the defaults is installed"
        raise refuse(kind, None, why, "names: contactlab plugins list")
    return installed[0]


def _refuse_rigid(
    rigid: str, elastic: Sequence[tuple[str, TangentialLaw]], normal: Law, integrator: Law
) -> None:
    """Refuse an integrator that runs no friction law but that of rigid bodies."""
    for name, tangential in elastic:
        if _fits(normal, tangential):
            runs, _ = _prefer("integrator", normal, tangential)
            rule = f"with {_short_name(normal)} this integrator runs only rigid friction"
            remedy = f"use integrator={runs!r} (with {name}), or name tangential={rigid!r}"
            raise refuse("integrator", _short_name(integrator), rule, remedy)


def _short_name(law: Law) -> str:
    """Return the name of a law as a user writes it."""
    return REGISTRY.short_name(law)


def _fits(*parts: Law) -> bool:
    return misfit(*parts) is None


def misfit(normal: Law, tangential: Law, integrator: Law | None = None) -> str | None:
    """Return why laws do not fit, with the names of both; None if they fit."""
    if "elastic_hertz" in claims(normal) and "closed" not in normal._ways:
        return (
            f"normal = {_name(normal)}: offers 'elastic_hertz', but is no ClosedFormNormalLaw; "
            "derive the law from that class, or do not offer the word"
        )
    if not tangential._ways & RUN:
        ways = ", ".join(way.__name__ for way in WAYS)
        return f"tangential = {_name(tangential)}: must be derived from one of {ways}"
    if (complaint := _lacking(tangential, normal)) is not None or integrator is None:
        return complaint
    if "whole" in tangential._ways:
        return None
    return _lacking(integrator, tangential) or _lacking(integrator, normal)


def _lacking(law: Law, other: Law) -> str | None:
    """Return what one law needs and another lacks, with the names of both; or None."""
    others = law_kind(other)
    lacking = [need for need in requirements(law) if not _has(other, others, need)]
    if not lacking:
        return None
    kind, need = law_kind(law), min(lacking, key=str)
    if isinstance(need, str):
        what = NEEDS.get(need, f"{need!r} of the normal law")
        return (
            f"{kind} = {_short_name(law)}: needs {what}, which {_short_name(other)} does not offer"
        )
    what = RUNS.get(need.__name__, f"a {need.__name__}")
    return f"{kind} = {_short_name(law)}: runs {what}, and {_short_name(other)} is not one"


def _has(law: Law, kind: str, need: str | type) -> bool:
    """Return whether a law has what is needed; needs of other kinds of law do not count."""
    if isinstance(need, str):
        return kind != "normal" or need in claims(law)
    return law_kind(need) != kind or isinstance(law, need)


def _would_fit(laws: Laws) -> str:
    """Return a phrase that names, for each kind that is named, the law that would fit best.

    Laws that the user did not name are chosen anew beside each; preferred laws come first.
    """
    names = []
    for kind in (kind for kind in KINDS if kind in (laws.named or KINDS)):
        others = {each: law for each, law in laws.by_kind().items() if each in laws.named - {kind}}
        found = [name for name, law in _candidates(kind) if _completes({**others, kind: law})]
        with contextlib.suppress(ValueError):  # nothing that is preferred is installed
            usual = REGISTRY.info(full_name(kind, _usual(kind, others))).known_as
            found.sort(key=usual.__ne__)
        names += [f"{kind} = {short_name(name)}" for name in found[:1]]
    return f"; use {', or '.join(names)}" if names else "; no law at hand fits"


def _completes(named: Mapping[str, Law]) -> bool:
    """Return whether laws fit once preferred laws complete them."""
    try:
        return _fits(*_complete(named))
    except ValueError:
        return False


def _usual(kind: str, others: Mapping[str, Law]) -> str:
    """Return the name of the preferred law of a kind beside others."""
    if kind == "normal":
        return DEFAULT_NORMAL
    made = _complete(others)
    after = (others["integrator"],) if "integrator" in others and kind == "tangential" else ()
    before = (made.normal,) if kind == "tangential" else (made.normal, made.tangential)
    return _prefer(kind, *before, after=after)[0]


def _candidates(kind: str) -> Iterator[tuple[str, Any]]:
    """Yield names and laws with their defaults, without an import of a foreign plug-in."""
    for info in REGISTRY.installed():
        if info.kind != kind or info.blocked or not REGISTRY.at_hand(info):
            continue
        try:
            yield info.known_as, REGISTRY.create(info.known_as)
        except (PluginError, ValueError):
            continue


def _name(law: Law) -> str:
    return type(law).__name__


def versions(*laws: Law) -> dict[str, str]:
    """Return each law's name and version, by kind."""
    return _versions(*map(type, laws)).copy()


@lru_cache(maxsize=128)
def _versions(*classes: type[Law]) -> dict[str, str]:
    return {law_kind(law_class): REGISTRY.describe(law_class) for law_class in classes}
