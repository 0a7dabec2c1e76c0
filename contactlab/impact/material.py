"""Elastic materials, and a collection of some thirty by name.

The numbers stand in ``materials.toml`` beside this file, each with its source.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import attrs
import numpy as np

from contactlab.numeric.checks import POISSON, POSITIVE, Real, nearest, quantity, real, refuse


@attrs.frozen(init=False, kw_only=True)
class Material:
    """A linear elastic, isotropic material.

    Parameters
    ----------
    shear_modulus, young_modulus : float
        Exactly one of the two, in Pa. They are related by E = 2 G (1 + nu).
    poisson_ratio : float
        In [-1, 0.5].
    density : float, optional
        In kg/m³; needed only by a sphere whose mass is not given.
    yield_stress : float, optional
        Y in Pa, of a tension test: plans caution where the contact pressure exceeds 1.6 Y. No law
        computes with it.

    Raises
    ------
    ValueError
        If a value is out of range, or both moduli or neither are given.
    """

    shear_modulus: Real = quantity("Pa", rule=POSITIVE)
    poisson_ratio: Real = quantity("1", rule=POISSON)
    density: Real | None = quantity("kg/m³", rule=POSITIVE, default=None)
    yield_stress: Real | None = quantity("Pa", rule=POSITIVE, default=None)

    def __init__(
        self,
        *,
        shear_modulus: object = None,
        young_modulus: object = None,
        poisson_ratio: object,
        density: Any = None,
        yield_stress: Any = None,
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
            shear_modulus = young / (2.0 * (1.0 + ratio))
        shear = real("shear_modulus", shear_modulus, rule=POSITIVE, remedy="give it in Pa")
        self.__attrs_init__(
            shear_modulus=shear, poisson_ratio=ratio, density=density, yield_stress=yield_stress
        )

    @classmethod
    def named(cls, name: str) -> Material:
        """Return a material of the collection by name: see ``contactlab.impact.material``.

        Parameters
        ----------
        name : str
            Such as ``"steel"``; ``contactlab materials`` lists them.

        Raises
        ------
        ValueError
            If there is no such material, with the nearest name.
        """
        return entry(name).material()

    @property
    def young_modulus(self) -> Real:
        """E = 2 G (1 + nu), in Pa."""
        return 2.0 * self.shear_modulus * (1.0 + self.poisson_ratio)


@attrs.frozen(kw_only=True)
class Entry:
    """A material of the collection.

    Attributes
    ----------
    name : str
    young_modulus : float
        In Pa.
    poisson_ratio : float
    density : float
        In kg/m³.
    elastic_source, density_source : str
        Where the numbers come from: a work and a place in it.
    yield_stress : float, optional
        In Pa, where the entry is one alloy in one condition.
    yield_source : str
        Where the yield stress comes from; empty without one.
    note : str
        What to know of them: a range, a value that is assumed; empty where there is nothing.
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

    def material(self) -> Material:
        """Return the material."""
        return Material(**self.numbers())

    def numbers(self) -> dict[str, float]:
        """Return what a scene file says of a material, key to value."""
        keys = ("young_modulus", "poisson_ratio", "density", "yield_stress")
        return {key: getattr(self, key) for key in keys if getattr(self, key) is not None}


def names() -> tuple[str, ...]:
    """Return the names of the materials: metals, ceramics and glasses, plastics."""
    return tuple(_collection()[0])


def entry(name: str) -> Entry:
    """Return the numbers of a material and their sources.

    Capital letters, hyphens and underscores make no difference.

    Raises
    ------
    ValueError
        If there is no such material, with the nearest names.
    """
    found = _collection()[0]
    if not isinstance(name, str):
        raise refuse("name", name, "must be the name of a material", "such as 'steel'")
    plain = {_plain(known): known for known in found}
    if _plain(name) in plain:
        return found[plain[_plain(name)]]
    alike = [known for key, known in plain.items() if _plain(name) and _plain(name) in key]
    hint = f"did you mean {' or '.join(map(repr, alike))}? " if alike else nearest(name, found)
    raise refuse("name", name, "no such material", f"{hint}known: {', '.join(found)}")


def entries() -> tuple[Entry, ...]:
    """Return all materials."""
    return tuple(_collection()[0].values())


def references() -> dict[str, str]:
    """Return the works that the sources name, key to citation."""
    return dict(_collection()[1])


def _plain(name: str) -> str:
    return " ".join(name.lower().replace("-", " ").replace("_", " ").split())


@cache
def _collection() -> tuple[dict[str, Entry], dict[str, str]]:
    """Return the materials and the references of the file."""
    import tomllib
    from importlib import resources

    text = resources.files("contactlab.impact").joinpath("materials.toml").read_text("utf-8")
    content = tomllib.loads(text)
    works = content.pop("references")
    return {name: Entry(name=name, **numbers) for name, numbers in content.items()}, works
