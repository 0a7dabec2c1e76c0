"""Elastic materials, and a collection of about thirty materials by name.

The numbers and their sources are in ``materials.toml`` beside this file.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, Generic, overload

import attrs
import numpy as np

from contactlab.numeric.checks import POISSON, POSITIVE, derive, of_kind, quantity, real, refuse
from contactlab.numeric.named import NOTHING, numbers_by_name, split_heading
from contactlab.numeric.names import nearest, tell_arguments
from contactlab.numeric.types import Array, Each, Number, Numbers
from contactlab.registration.bring import by_name, own_first
from contactlab.registration.hooks import hookimpl

#: Remedy for an object that is no material.
A_MATERIAL = "make one, Material(...), or by its name: Material.named('steel')"
#: Arguments of a material, which are no properties.
OWN_NUMBERS = ("shear_modulus", "young_modulus", "poisson_ratio", "density", "yield_stress")
OWN = "or give your own: Material(young_modulus=..., poisson_ratio=..., density=...)"
#: Names in common use, with the name in the collection.
OTHER_NAMES = {
    "aluminum": "aluminium alloy", "aluminium": "aluminium alloy", "aluminum oxide": "alumina",
    "aluminium oxide": "alumina", "acrylic": "pmma", "perspex": "pmma", "plexiglas": "pmma",
    "plexiglass": "pmma", "pyrex": "borosilicate glass",
    "phenolic": "phenolic resin", "billiard ball": "phenolic resin", "quartz glass": "fused silica",
}  # fmt: skip


class _MaterialArguments:
    """Arguments of a material, without overloads, as types for ``attrs.evolve``."""

    __slots__ = ()

    def __init__(
        self,
        *,
        shear_modulus: Numbers | None = None,
        young_modulus: Numbers | None = None,
        poisson_ratio: Numbers,
        density: Numbers | None = None,
        yield_stress: Numbers | None = None,
        properties: Mapping[str, Numbers] | None = None,
    ) -> None:
        if (shear_modulus is None) == (young_modulus is None):
            raise refuse(
                "shear_modulus, young_modulus",
                (shear_modulus, young_modulus),
                "exactly one of the two must be given",
                "leave one out; the other follows from E = 2 G (1 + nu)",
            )
        ratio = real("poisson_ratio", poisson_ratio, rule=POISSON, remedy="it has no unit")
        if shear_modulus is None:
            young = real("young_modulus", young_modulus, rule=POSITIVE, remedy="give it in Pa")
            if np.any(np.asarray(ratio) == -1.0):
                raise refuse(
                    "young_modulus",
                    young_modulus,
                    "does not determine the shear modulus at poisson_ratio = -1",
                    "give shear_modulus instead",
                )
            follows = young / (2.0 * (1.0 + ratio))
            remedy = "give it in Pa"
            shear_modulus = derive("shear modulus", follows, remedy, young_modulus=young_modulus)
        shear = real("shear_modulus", shear_modulus, rule=POSITIVE, remedy="give it in Pa")
        self.__attrs_init__(  # type: ignore[attr-defined]
            shear_modulus=shear,
            poisson_ratio=ratio,
            density=density,
            yield_stress=yield_stress,
            properties=numbers_by_name("properties", properties, taken=OWN_NUMBERS),
        )


@tell_arguments
@attrs.frozen(init=False, kw_only=True, repr=False)
class Material(_MaterialArguments, Generic[Each]):
    """A linear elastic, isotropic material.

    Parameters
    ----------
    shear_modulus, young_modulus : float
        G and E in Pa; exactly one of the two is given, as E = 2 G (1 + nu).
    poisson_ratio : float
        nu, from -1 to 0.5.
    density : float, optional
        Density in kg/m³; needed only by a sphere without given mass. NaN in an array: not known.
    yield_stress : float, optional
        Y in Pa, from a tension test. Plans have a caution where the contact pressure exceeds
        1.6 Y; no law uses this number. NaN in an array: not known.
    properties : mapping of str to float, optional
        Further numbers by name in SI units, ``{"relaxation_time": 1e-6}``, for laws whose options
        say that they are read from the material: ``contactlab plugins show`` tells which. A name
        may have its unit behind, ``"relaxation_time (s)"``, which is compared with the law's.

    Raises
    ------
    ValueError
        If a value is out of range, or both moduli or neither are given.
    """

    shear_modulus: Each | float = quantity("Pa", rule=POSITIVE)
    poisson_ratio: Each | float = quantity("1", rule=POISSON)
    density: Each | float | None = quantity("kg/m³", rule=POSITIVE, default=None, unknown=True)
    yield_stress: Each | float | None = quantity("Pa", rule=POSITIVE, default=None, unknown=True)
    properties: Mapping[str, Each | float] = attrs.field(default=NOTHING)

    if TYPE_CHECKING:

        @overload
        def __new__(  # type: ignore[overload-overlap]  # a number is the first of both
            cls,
            *,
            shear_modulus: Number | None = ...,
            young_modulus: Number | None = ...,
            poisson_ratio: Number,
            density: Number | None = ...,
            yield_stress: Number | None = ...,
            properties: Mapping[str, Number] | None = ...,
        ) -> Material[float]: ...
        @overload
        def __new__(
            cls,
            *,
            shear_modulus: Numbers | None = ...,
            young_modulus: Numbers | None = ...,
            poisson_ratio: Numbers,
            density: Numbers | None = ...,
            yield_stress: Numbers | None = ...,
            properties: Mapping[str, Numbers] | None = ...,
        ) -> Material[Array]: ...
        def __new__(cls, *_: object, **__: object) -> Material: ...  # noqa: D102

    def __repr__(self) -> str:
        told = [each for each in NAMES if each != "properties" or self.properties]
        return f"Material({', '.join(f'{each}={getattr(self, each)!r}' for each in told)})"

    def find_property(self, name: str) -> tuple[Each | float, str] | None:
        """Return a property with its unit, empty if none was given; None without the property.

        Parameters
        ----------
        name : str
            The name without its unit.
        """
        for heading, number in self.properties.items():
            own, unit = split_heading(heading)
            if own == name:
                return number, unit
        return None

    @classmethod
    def named(cls, name: str) -> Material[float]:
        """Return a material of the collection by name.

        Parameters
        ----------
        name : str
            A name such as ``"steel"``; the command ``contactlab materials`` lists all names.

        Raises
        ------
        ValueError
            If there is no such material; the message suggests the nearest name.
        """
        return entry(name).material()

    @property
    def young_modulus(self) -> Each | float:
        """E = 2 G (1 + nu), in Pa."""
        return 2.0 * self.shear_modulus * (1.0 + self.poisson_ratio)  # type: ignore[return-value]


NAMES = tuple(field.name for field in attrs.fields(Material))


@attrs.frozen(kw_only=True)
class Entry:
    """A material of the collection.

    Attributes
    ----------
    name : str
        Name of the material.
    young_modulus : float
        E in Pa.
    poisson_ratio : float
        nu.
    density : float
        Density in kg/m³.
    elastic_source, density_source : str
        Source of the numbers: a work and a place in it.
    yield_stress : float, optional
        Y in Pa, if the entry is one alloy in one condition, or its range is narrow.
    yield_source : str
        Source of the yield stress; empty without yield stress.
    note : str
        Remarks on the numbers, such as a range or an assumed value; may be empty.
    works : mapping
        The works that the sources name, in full, by key.
    properties : mapping of str to float
        Further numbers by name, in SI units, as those of a ``Material``.
    properties_source : str
        Source of the properties.
    """

    name: str
    young_modulus: float = attrs.field(metadata={"unit": "Pa"})
    poisson_ratio: float = attrs.field(metadata={"unit": "1"})
    density: float = attrs.field(metadata={"unit": "kg/m³"})
    elastic_source: str
    density_source: str
    yield_stress: float | None = attrs.field(default=None, metadata={"unit": "Pa"})
    yield_source: str = ""
    note: str = ""
    works: Mapping[str, str] = attrs.field(factory=dict, metadata={"json": False})
    properties: Mapping[str, float] = attrs.field(factory=dict)
    properties_source: str = ""

    def material(self) -> Material[float]:
        """Return the entry as a ``Material``."""
        return Material(**self.numbers())

    def numbers(self) -> dict[str, Any]:
        """Return the entries of a material in a scene file, as {key: value}."""
        keys = ("young_modulus", "poisson_ratio", "density", "yield_stress", "properties")
        return {key: getattr(self, key) for key in keys if getattr(self, key) not in (None, {})}


def names() -> tuple[str, ...]:
    """Return the names of the materials: metals, ceramics and glasses, plastics."""
    return tuple(each.name for each in entries())


def entry(name: str, *, remedy: str = OWN) -> Entry:
    """Return the numbers of a material and their sources.

    Capital letters, hyphens and underscores make no difference. A refusal ends with ``remedy``,
    how to write other numbers.

    Raises
    ------
    ValueError
        If there is no such material; the message suggests the nearest names.
    """
    of_kind("name", name, str, rule="must be the name of a material", remedy="such as 'steel'")
    if own_first("materials") and (own := _own_by_key().get(_key(name))) is not None:
        return own  # contactlab's own names need no plug-in
    collection = _collection()
    distribution, _, plain = name.rpartition(":")
    key = f"{distribution}:{_key(plain)}" if distribution else _key(plain)
    if key in collection:
        return collection[key]
    if key in OTHER_NAMES:
        other = OTHER_NAMES[key]
        raise refuse("name", name, f"is listed as {other!r}", "write that name")
    listing = {each: found.name for each, found in collection.items()}
    similar = [listed for long_key, listed in listing.items() if key and key in long_key]
    words = set(key.split())
    similar = similar or [listed for each, listed in listing.items() if words & {*each.split()}]
    hint = f"did you mean {' or '.join(map(repr, similar))}? " if similar else ""
    hint = hint or nearest(name, listing.values(), alike=0.75)
    known = ", ".join(listing.values())
    raise refuse("name", name, "no such material", f"{hint}known: {known}; {remedy}")


def entries() -> tuple[Entry, ...]:
    """Return all materials of the collection."""
    return tuple(_collection().values())


def references() -> dict[str, str]:
    """Return the works that the sources name, as {key: citation}."""
    return {key: text for each in entries() for key, text in each.works.items()}


def works(name: str) -> dict[str, str]:
    """Return the works from which the numbers of a material are taken, in full, by key."""
    one = entry(name)
    sources = one.elastic_source, one.density_source, one.yield_source, one.properties_source
    said = " ".join((*sources, one.note))
    keys = re.findall(r"\w+", said)
    return {key: text for key, text in one.works.items() if key in keys}


def _key(name: str) -> str:
    """Return ``name`` in small letters, with single spaces for hyphens and underscores."""
    return " ".join(name.lower().replace("-", " ").replace("_", " ").split())


@hookimpl
def contactlab_materials() -> list[Entry]:
    """Return contactlab's own collection, ``materials.toml``."""
    return _own()


@cache
def _own() -> list[Entry]:
    import tomllib
    from importlib import resources

    text = resources.files("contactlab.impact").joinpath("materials.toml").read_text("utf-8")
    content = tomllib.loads(text)
    works = content.pop("references")
    return [Entry(name=name, works=works, **numbers) for name, numbers in content.items()]


@cache
def _own_by_key() -> dict[str, Entry]:
    return {_key(entry.name): entry for entry in _own()}


def _collection() -> Mapping[str, Entry]:
    """Return the materials of all plug-ins by name."""
    return by_name("materials", Entry, lambda entry: _key(entry.name), fault=_fault)


def _fault(entry: Entry) -> str:
    """Return what is wrong with the numbers of an entry; empty if nothing is."""
    try:
        entry.material()
    except (TypeError, ValueError) as error:
        return f"whose {error}"
    return ""
