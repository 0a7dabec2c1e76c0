"""Materials by name: elastic constants and densities of some thirty, each with its source.

The numbers stand in ``materials.toml`` beside this file, where the sources are written out.
"""

from __future__ import annotations

from functools import cache

import attrs

from contactlab.impact.bodies import Material
from contactlab.numeric.checks import nearest, refuse


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
