"""A table of a TOML file that refuses unknown keys and wrong types, by dotted path."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

import numpy as np

from contactlab.numeric.checks import of_kind, real, refuse
from contactlab.numeric.names import nearest
from contactlab.numeric.types import Array, Real

Made = TypeVar("Made")

#: Numbers of a material in a scene file.
MATERIAL_KEYS = ("shear_modulus", "young_modulus", "poisson_ratio", "density", "yield_stress")
#: Table of further numbers of a material, which laws of plug-ins read.
PROPERTIES = "properties"

#: Remedies for missing numbers without a unit.
ABSENT = {
    "friction_coefficient": "a number such as 0.2; `contactlab fit` finds it from measured rebounds"
}

#: Remedy for a missing table of the struck surface.
PLANE = 'write [target] with kind = "half-space"'
#: Remedies for keys that users write in the wrong table.
ELSEWHERE = {
    "restitution": "write it under [simulation]",
    "mu": "write friction_coefficient under [impact]",
    "gravity": "leave gravity out: contact forces are far larger",
    **dict.fromkeys(("halfspace", "half-space", "half_space", "plane", "wall", "floor"), PLANE),
}


class Table:
    """A table, its dotted ``path`` for messages, and the keys it may have.

    Unknown keys are refused at once, so that no misspelt key is reported as missing. The path of
    the whole file is empty.
    """

    def __init__(self, content: object, path: str, *, known: Iterable[str]) -> None:
        self.path = path
        self.known = tuple(known)
        rule, remedy = "must be a table", f"write it under [{path}]"
        table = of_kind(path, content, Mapping, rule=rule, remedy=remedy)
        self.content: Mapping[str, Any] = table
        for key in table:
            if key not in self.known:
                raise self._refuse_key(key)

    def at(self, key: str) -> str:
        """Return the dotted path of ``key``."""
        return f"{self.path}.{key}" if self.path else key

    def has(self, *keys: str) -> bool:
        """Return whether the table has any of the keys."""
        return any(key in self.content for key in keys)

    def require(self, key: str, remedy: str) -> object:
        """Return the raw value of ``key``, or refuse a table without this key."""
        if key not in self.content:
            raise ValueError(f"{self.at(key)}: is missing; {remedy}")
        return self.content[key]

    def table(self, key: str, *, known: Iterable[str]) -> Table:
        """Return the required table ``key`` inside this table."""
        remedy = f"add a table [{self.at(key)}] with {', '.join(known)}"
        return Table(self.require(key, remedy), self.at(key), known=known)

    def number(self, key: str, *, remedy: str) -> Real:
        """Return a number, or the array of a sweep in its place.

        A list in the file is refused: entries that vary belong in ``[sweep]``.
        """
        value = self.require(key, f"write {key} = ...: {ABSENT.get(key, remedy)}")
        if isinstance(value, list):
            raise refuse(self.at(key), value, "must be one number", "put lists in [sweep]")
        return real(self.at(key), value, remedy=remedy)

    def friction(self) -> Real | dict[float, float]:
        """Return the friction coefficient: a number, an array, or a table {slip speed: mu}."""
        key = "friction_coefficient"
        pairs = self.content.get(key)
        if not isinstance(pairs, list):
            return self.number(key, remedy="it has no unit")
        if not (pairs and all(isinstance(pair, list) and len(pair) == 2 for pair in pairs)):
            rule = "must be one number, or pairs of slip speed and mu"
            remedy = "write [[0.1, 0.3], [2, 0.2]], speeds in m/s, or put lists in [sweep]"
            raise refuse(self.at(key), pairs, rule, remedy)
        speeds = np.asarray(real(self.at(key), pairs, remedy="give pairs of slip speed and mu"))
        if len(set(speeds[:, 0].tolist())) < len(speeds):
            raise refuse(self.at(key), pairs, "has a slip speed twice", "leave out one")
        return dict(speeds.tolist())

    def text(self, key: str, *, default: str | None = None, remedy: str = "") -> str:
        """Return the text at ``key``."""
        if key not in self.content and default is not None:
            return default
        value = self.require(key, remedy)
        place, remedy = self.at(key), "put it in quotes"
        return str(of_kind(place, value, str, rule="must be text", remedy=remedy))

    def numbers(self, key: str, *, default: object = None, remedy: str) -> Array:
        """Return the list of numbers at ``key`` as an array, shape (n,)."""
        missing = key not in self.content and default is not None
        value = default if missing else self.require(key, remedy)
        return number_list(self.at(key), value, remedy=remedy)

    def make(self, maker: Callable[..., Made], **arguments: object) -> Made:
        """Return ``maker(**arguments)``, with this table's path before its error messages."""
        try:
            return maker(**arguments)
        except ValueError as error:
            raise ValueError(self.at(str(error))) from error
        except ArithmeticError as error:
            rule = f"the numbers are too large or too small to compute with ({error})"
            raise ValueError(f"{self.path}: {rule}; check the units") from error

    def _refuse_key(self, key: str) -> ValueError:
        """Return the error of an unknown key."""
        remedy = nearest_of(key, self.known)
        if key in ELSEWHERE and key not in self.known:
            remedy = ELSEWHERE[key]
        if PROPERTIES in self.known and not nearest(key, self.known):
            remedy += f"; a number that a law reads goes under [{self.at(PROPERTIES)}]"
        if "material" in self.known and key in MATERIAL_KEYS:
            remedy = f"a number of the material: write it under [{self.at('material')}]"
        what = "table" if isinstance(self.content.get(key), Mapping) else "key"
        return ValueError(f"{self.at(key)}: unknown {what}; {remedy}")


def nearest_of(name: str, known: Iterable[str]) -> str:
    """Return a hint: the nearest known name, and all of them."""
    names = list(known)
    return f"{nearest(name, names)}known: {', '.join(names)}"


def number_list(path: str, value: object, *, remedy: str) -> Array:
    """Return ``value`` as an array of shape (n,), or refuse it."""
    listed = isinstance(value, list) or (isinstance(value, np.ndarray) and value.ndim > 0)
    if not listed or any(isinstance(item, bool) for item in value):  # type: ignore[attr-defined]
        raise refuse(path, value, "must be a list of numbers", remedy)
    array = np.asarray(real(path, value, remedy=remedy))
    if array.ndim != 1:
        raise refuse(path, value, "must be a plain list of numbers", "not a list of lists")
    return array


def flatten(
    content: Mapping[str, object],
    prefix: str = "",
    *,
    leaf: Callable[[Mapping[str, object]], bool] = lambda _: False,
) -> dict[str, Any]:
    """Return all values by dotted name, such as ``sphere.radius``, however they are nested.

    ``leaf`` returns True for a table that is a value itself.
    """
    values: dict[str, Any] = {}
    for key, value in content.items():
        if isinstance(value, Mapping) and not leaf(value):
            values |= flatten(value, f"{prefix}{key}.", leaf=leaf)
        else:
            values[prefix + key] = value
    return values
