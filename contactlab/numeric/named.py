"""Numbers by names that plug-ins choose: properties of materials, options with a number an impact.

A unit may follow the name, as in headings of files: ``"relaxation_time (s)"``.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping
from typing import Any

import attrs
import numpy as np

from contactlab.numeric.checks import key, of_kind, real_or_nan, refuse
from contactlab.numeric.types import Array

#: A name, and its unit in brackets where one is given.
HEADING = re.compile(r"([A-Za-z_][\w.]*)(?: \((\S[^()]*(?:\([^()]*\))?[^()]*)\))?")


class Named(Mapping[str, Any]):
    """Numbers or arrays by name, read-only."""

    __slots__ = ("_numbers",)

    def __init__(self, numbers: Mapping[str, object] | None = None) -> None:
        self._numbers: dict[str, Any] = dict(numbers or {})

    def __getitem__(self, name: str) -> Any:
        return self._numbers[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._numbers)

    def __len__(self) -> int:
        return len(self._numbers)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Named) and self._keys() == other._keys()

    def __hash__(self) -> int:
        return hash(self._keys())

    def __repr__(self) -> str:
        return repr(self._numbers)

    def _keys(self) -> frozenset[tuple[str, object]]:
        return frozenset(
            (name, key(each.numbers if type(each) is OfImpacts else each))
            for name, each in self._numbers.items()
        )


NOTHING = Named()


@attrs.frozen(eq=False)
class OfImpacts:
    """One number for each impact of a scene, and a hash of the array they come from.

    Attributes
    ----------
    numbers : float or array
        Numbers in the shape of the scene.
    whole : str
        A hash of the whole array, by which its own parts are known.
    """

    numbers: Array
    whole: str

    @classmethod
    def of(cls, whole: Array, numbers: Array) -> OfImpacts:
        """Return numbers of the impacts, read-only, with the mark of the array."""
        own = np.array(numbers, dtype=np.float64)
        own.setflags(write=False)
        return cls(own, mark_of(whole))


def mark_of(whole: Array) -> str:
    """Return a hash of an array, the same in every process."""
    return hashlib.sha256(f"{whole.shape}".encode() + whole.tobytes()).hexdigest()[:16]


def split_heading(heading: str) -> tuple[str, str]:
    """Return name and unit of a heading; the unit is empty if none is given."""
    found = HEADING.fullmatch(heading)
    return (found[1], found[2] or "") if found else (heading, "")


def numbers_by_name(argument: str, given: object, *, taken: tuple[str, ...] = ()) -> Named:
    """Return checked numbers by name; a name in ``taken`` is an argument of its own.

    An array may hold NaN, of an impact for which the number is not known.
    """
    if type(given) is Named:
        return given
    if given is None:
        return NOTHING
    remedy = f"write {argument}={{'relaxation_time': 1e-6}}, in SI units"
    table = of_kind(argument, given, Mapping, rule="must be numbers by name", remedy=remedy)
    numbers: dict[str, object] = {}
    names: set[str] = set()
    for heading, value in table.items():
        name = split_heading(heading)[0] if isinstance(heading, str) else ""
        if not (name and HEADING.fullmatch(heading)) or "." in name:
            rule = "must be a name without blanks, and maybe its unit in brackets"
            raise refuse(f"{argument}: name", heading, rule, "such as 'relaxation_time (s)'")
        if name in taken:
            raise refuse(f"{argument}: name", heading, f"is the argument {name}", "give it there")
        if name in names:
            raise refuse(f"{argument}: name", heading, "is given twice", "leave out one of them")
        names.add(name)
        numbers[heading] = real_or_nan(f"{argument}[{heading!r}]", value, remedy="give it in SI")
    return Named(numbers)
