"""Options of laws that follow from the materials, or that have one number for each impact."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import attrs

from contactlab.contracts.law import Law
from contactlab.contracts.parameters import Combined
from contactlab.numeric.checks import Rule


class Read(NamedTuple):
    """An option that follows from the materials, or has one number for each impact.

    Attributes
    ----------
    name, unit : str
    rule : Rule
    per_impact : bool
        Whether each impact may have its own number.
    material : Combined or None
        How it follows from two materials; None if it does not.
    required : bool
        Whether the option or the materials must give it.
    """

    name: str
    unit: str
    rule: Rule
    per_impact: bool
    material: Combined | None
    required: bool


@lru_cache(maxsize=128)
def options_read(law_class: type[Law]) -> tuple[Read, ...]:
    """Return the options of a law that follow from materials, or have one number an impact."""
    fields = attrs.fields(law_class) if attrs.has(law_class) else ()
    return tuple(
        Read(
            field.name,
            field.metadata["unit"],
            field.metadata["rule"],
            field.metadata.get("per_impact", False),
            field.metadata.get("material"),
            field.metadata.get("required", False),
        )
        for field in fields
        if "per_impact" in field.metadata or "material" in field.metadata
    )
