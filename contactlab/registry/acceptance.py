"""Refusals of scenes: by a law itself, and of scenes without units for options with units."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import attrs

from contactlab.contracts import faults
from contactlab.contracts.law import Law, law_kind
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.registry.registry import REGISTRY

#: Units of options that hold in any system: words and flags have "".
IN_ANY_SYSTEM = ("", "1", "rad", "deg")


class Option(NamedTuple):
    """Name and unit of an option of a law."""

    name: str
    unit: str


@lru_cache(maxsize=128)
def with_units(law_class: type[Law]) -> tuple[Option, ...]:
    """Return the options of a law that have a unit."""
    if not attrs.has(law_class):  # a plug-in need not use attrs
        return ()
    units = {field.name: field.metadata.get("unit", "") for field in attrs.fields(law_class)}
    return tuple(Option(*each) for each in units.items() if each[1] not in IN_ANY_SYSTEM)


def in_units(law: Law) -> tuple[Option, ...]:
    """Return the options with a unit whose value, from the user or by default, is not None."""
    return tuple(each for each in with_units(type(law)) if getattr(law, each.name) is not None)


def may_refuse(law: Law) -> bool:
    """Return whether ``accept`` can refuse a scene for a law."""
    return type(law).accept is not Law.accept or bool(in_units(law))


def accept(law: Law, scene: Scene) -> None:
    """Refuse a scene without units to options that have one; let the law refuse it.

    Any error that the law raises counts as a refusal.
    """
    if not scene.has_units and (options := in_units(law)):
        name, unit = options[0]
        raise refuse(
            f"{law_kind(law)}: {name}",
            getattr(law, name),
            f"is in {unit}, and {REGISTRY.short_name(law)} needs a scene with units",
            "give bodies and speeds in SI in place of psi1 and chi",
        )
    try:
        law.accept(scene)
    except ValueError:
        raise
    except Exception as error:
        told = (
            f"{law_kind(law)} = {type(law).__name__}: its accept raised {faults.tell_error(error)}"
        )
        raise ValueError(told) from error
