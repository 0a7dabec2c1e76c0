"""Where an argument that a simulation lacks belongs: to a law, or to the scene."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from inspect import signature

import attrs

from contactlab.contracts.law import Law, law_kind
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.restitution import RESTITUTIONS
from contactlab.impact.bodies import Sphere
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import quote, real, refuse
from contactlab.numeric.names import REMARKS, SYMBOLS, nearest
from contactlab.numeric.taken import Taken
from contactlab.registration.names import full_name, kind_of
from contactlab.registry import composition
from contactlab.registry.composition import EXACT, PREFERRED, RESTITUTION
from contactlab.registry.registry import REGISTRY, PluginError

#: Laws that are asked first for an option: those of a restitution, and the defaults.
FIRST = tuple(
    full_name(kind, name)
    for kind, names in (
        ("normal", (RESTITUTION["normal"],)),
        ("tangential", (EXACT["tangential"], RESTITUTION["tangential"], *PREFERRED["tangential"])),
        ("integrator", (*PREFERRED["steps"], *PREFERRED["integrator"])),
    )
    for name in names
)

#: What makes a scene and its bodies.
OF_SCENES: dict[str, Callable[..., object]] = {
    "Scene": Scene,
    "Scene.at_angle": Scene.at_angle,
    "Scene.nondimensional": Scene.nondimensional,
    "Sphere": Sphere,
    "Material": Material,
}


def options(*, at_hand: bool) -> dict[str, list[str]]:
    """Return the names of laws by each option that they have, the defaults first.

    With ``at_hand`` no plug-in of others is imported.
    """
    rank = {name: place for place, name in enumerate(reversed(FIRST), start=1)}
    infos = sorted(REGISTRY.installed(), key=lambda info: -rank.get(info.known_as, 0))
    found: dict[str, list[str]] = {}
    for info in infos:
        if at_hand and not REGISTRY.at_hand(info):
            continue
        with contextlib.suppress(PluginError, ValueError):
            for option in signature(REGISTRY.law_class(info.known_as)).parameters:
                found.setdefault(option, []).append(info.known_as)
    return found


def remedy_of(name: str, value: object) -> str:
    """Return where an argument of a simulation belongs, as a user writes it; empty if unknown."""
    known = options(at_hand=True)
    if name in known:
        law = known[name][0]
        made = f"create({law!r}, {name}={quote(value)})"
        return f"{name} belongs to {law}: write {kind_of(law)}={made}; "
    if not isinstance(value, str):  # text may name a law
        for entry in (name, *SYMBOLS.get(name, ())):
            for made, call in OF_SCENES.items():
                if entry in signature(call).parameters:
                    given = "..." if name in REMARKS else quote(value)
                    return f"{name} belongs to the scene: write {made}(..., {entry}={given}); "
    near = nearest(name, known, alike=0.75)
    return f"{near}It is an option of a law; " if near else ""


def with_restitution(law: Law, restitution: object) -> str:
    """Return how a user makes a law with a restitution: ``law``, or that which takes its place."""
    name = FIRST[0]
    if takes_restitution(type(law)):
        name = full_name(law_kind(law), REGISTRY.short_name(law))
        try:
            known = REGISTRY.law_class(name) is type(law)
        except ValueError:  # a class that nobody installed
            known = False
        if not known:
            return f"{type(law).__name__}(restitution={restitution!r})"
    return f"create({name!r}, restitution={restitution!r})"


def normal_of_restitution(normal: object, restitution: object) -> NormalLaw | None:
    """Return the normal law of a restitution, or a named one with it; None for elastic bodies.

    Raises
    ------
    ValueError
        If the restitution is out of range, or the named law does not take it.
    """
    e = real("restitution", restitution, rule=RESTITUTIONS)
    if normal is None:
        elastic = isinstance(e, float) and e == 1.0
        return None if elastic else composition.viscous(e)
    found = composition.law("normal", normal)
    if takes_restitution(type(found)):
        if isinstance(normal, str):
            return composition.law("normal", normal, restitution=e)
        if attrs.has(type(found)) and isinstance(
            found.restitution,  # type: ignore[attr-defined]  # which the law takes
            Taken | None,
        ):
            return attrs.evolve(found, restitution=e)  # type: ignore[misc]
    rule = f"stands beside normal = {REGISTRY.short_name(found)}, which "
    rule += "has one" if takes_restitution(type(found)) else "does not take it"
    remedy = f"leave out one of them; {RESTITUTION['normal']} takes it"
    raise refuse("restitution", restitution, rule, remedy)


def takes_restitution(law: type[Law]) -> bool:
    """Return whether a law has the option ``restitution``."""
    return "restitution" in signature(law).parameters
