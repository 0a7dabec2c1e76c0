"""Laws and scene of a run: options that follow from materials, and those of each impact."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Protocol

import attrs
import numpy as np

from contactlab.contracts.law import Law, law_kind
from contactlab.impact.cautions import name_bodies
from contactlab.impact.material import Material
from contactlab.impact.of_speed import spread_over
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import real, real_or_nan, refuse, unit_remedy
from contactlab.numeric.named import Named, OfImpacts, mark_of, split_heading
from contactlab.numeric.names import nearest
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Array, Real
from contactlab.registry.composition import Laws
from contactlab.registry.read_options import Read, options_read
from contactlab.registry.registry import REGISTRY


class Body(Protocol):
    """A body of any shape, by its material."""

    @property
    def material(self) -> Material:
        """The material."""


def bind(laws: Laws, scene: Scene) -> tuple[Laws, Scene]:
    """Return laws with the options that materials give, and the scene with those of each impact.

    Raises
    ------
    ValueError
        If an option is given twice or not at all, in another unit, or for other impacts.
    """
    if not laws.capability.reads:
        return laws, scene
    used, scene = bind_laws(laws, scene)
    pairs = zip(laws.by_kind().items(), used, strict=True)
    changed = {kind: own for (kind, law), own in pairs if own is not law}
    return laws.change(**changed) if changed else laws, scene


def bind_laws(laws: Iterable[Law], scene: Scene) -> tuple[list[Any], Scene]:
    """Return some laws and the scene as ``bind`` does."""
    used: list[Any] = []
    numbers = dict(scene._options)
    for law in laws:
        one, own = bind_law(law, scene)
        used.append(one)
        numbers |= own
    if numbers:
        scene = scene._with(_options=Named(numbers))
    return used, scene


def bind_law(law: Law, scene: Scene) -> tuple[Law, dict[str, Any]]:
    """Return a law with the options that materials give, and its numbers of each impact."""
    numbers: dict[str, Any] = {}
    for option in options_read(type(law)):
        if option.material is not None:
            law = _from_materials(law, option, scene)
        value = getattr(law, option.name)
        if isinstance(value, np.ndarray):
            name = f"{law_kind(law)}.{option.name}"
            numbers[f"{name} ({option.unit})"] = _per_impact(name, option.unit, value, scene)
    return law, numbers


def _per_impact(name: str, unit: str, value: Array, scene: Scene) -> OfImpacts:
    """Return the numbers of the impacts of a scene; part of a batch already holds its own."""
    before: OfImpacts | None = scene._options.get(f"{name} ({unit})")
    if before is not None and before.whole == mark_of(value):
        return before
    return OfImpacts.of(value, spread_over(name, value, scene.shape))


def _from_materials(law: Law, option: Read, scene: Scene) -> Law:
    """Return a law with an option that two materials give.

    The law stays as it is if they have none, or if another option stands in its place.
    """
    name, unit = option.name, option.unit
    place = f"{law_kind(law)}: {name}"
    bodies: Mapping[str, Body] = name_bodies(scene)
    given = getattr(law, name)
    found: dict[str, Any] = {}
    for body, each in bodies.items():
        if (own := each.material.find_property(name)) is not None:
            number, stated = own
            if stated and stated != unit:
                rule = f"has the unit {stated}, and {REGISTRY.short_name(law)} reads it in {unit}"
                raise refuse(f"{body}.material: {name}", number, rule, unit_remedy(unit))
            found[body] = real_or_nan(
                f"{body}.material: {name}", number, rule=option.rule, remedy=unit_remedy(unit)
            )
    told = f"Material(properties={{{name!r}: ...}}) in {unit}"
    if not found:
        _refuse_misspelt(law, name, bodies)
        if option.required and given is None:
            rule = "is missing: neither the law nor the materials have it"
            raise refuse(place, None, rule, f"give the option, or {told} of both bodies")
        return law
    changed: Any = law  # every law with such an option is of attrs
    try:
        attrs.evolve(changed, **{name: float(np.nanmax(next(iter(found.values()))))})
    except ValueError:
        # The user gave another option for the same quantity, such as a restitution.
        return law
    if lacking := [body for body in bodies if body not in found]:
        _refuse_misspelt(law, name, {body: bodies[body] for body in lacking})
        rule = f"is missing, and the {' and '.join(found)} has it"
        remedy = f"give {told}; 0 for a body that has nothing of it"
        raise refuse(f"{lacking[0]}.material: {name}", None, rule, remedy)
    one, other = (body.material for body in bodies.values())
    assert option.material is not None
    first, second = found.values()
    value = option.material.of(first, second, (one, other))
    where = f"{name} of {' and '.join(found)}"
    value = real(where, value, rule=option.rule, remedy=unit_remedy(unit))
    if isinstance(value, np.ndarray):
        if np.ptp(value) == 0.0:
            value = float(value.flat[0])
        elif not option.per_impact:
            rule = "must be one number: this option of a law holds for every impact"
            raise refuse(where, value, rule, "run each material alone")
    if given is not None and not isinstance(given, Taken) and not _equals_material(given, value):
        rule = f"is given to the law, and {' and '.join(found)} have it as a property too"
        raise refuse(place, given, rule, "leave out the option, or the property")
    bound: Law = attrs.evolve(changed, **{name: value})
    return bound


def _equals_material(given: Real, value: Real) -> bool:
    """Return whether an option equals the value that the materials give, as after a run."""
    return np.shape(given) == np.shape(value) and bool(np.all(given == value))


def _refuse_misspelt(law: Law, name: str, bodies: Mapping[str, Body]) -> None:
    """Refuse a property whose name is a misspelling of a name that a law reads."""
    known = {option.name for option in options_read(type(law))}
    for body, each in bodies.items():
        for heading in each.material.properties:
            own = split_heading(heading)[0]
            if own not in known and nearest(own, [name], alike=0.75):
                rule = f"is no property that {REGISTRY.short_name(law)} reads"
                raise refuse(f"{body}.material: properties", own, rule, f"did you mean {name!r}?")
