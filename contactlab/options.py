"""Options of a law: what each means, its default, unit and range, from the class alone."""

from __future__ import annotations

import inspect
import re
from typing import Any

import attrs

#: The section of a NumPy docstring, to the next heading or the end.
SECTION = re.compile(r"^Parameters\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", re.MULTILINE | re.DOTALL)
#: One name or several of the section, with what stands below.
ENTRY = re.compile(r"^(\w+(?:, \w+)*)(?: : [^\n]*)?\n((?:(?: +[^\n]*)?\n)*)", re.MULTILINE)


@attrs.frozen(kw_only=True)
class Option:
    """One option of a law, in words.

    Parameters
    ----------
    name : str
    default : object
        ``inspect.Parameter.empty`` if it must be given.
    unit : str
        In SI; ``"1"`` for a number without one, empty if unknown or no number.
    rule : str
        What a value must satisfy, as a refusal says it; empty if unknown.
    meaning : str
        What the docstring of the class says; empty if it says nothing.
    """

    name: str
    default: Any
    unit: str
    rule: str
    meaning: str

    def __str__(self) -> str:
        """Return the name, with the default if there is one."""
        needed = self.default is inspect.Parameter.empty
        return f"{self.name}, to be given" if needed else f"{self.name} = {self.default!r}"

    def to_dict(self) -> dict[str, Any]:
        """Return what JSON takes; a default that is no plain value stands as its text."""
        needed = self.default is inspect.Parameter.empty
        default = None if needed else self.default
        if not isinstance(default, bool | int | float | str | None):
            default = repr(default)
        return {
            "name": self.name,
            "default": default,
            "needed": needed,
            "unit": self.unit,
            "rule": self.rule,
            "meaning": self.meaning,
        }


def options(law: type) -> list[Option]:
    """Return the options of a class of laws, in the order of its signature.

    Unit and range are known of fields made by ``contactlab.checks``.
    """
    fields: Any = attrs.fields_dict(law) if attrs.has(law) else {}
    meant = meanings(law)
    found = []
    for name, parameter in inspect.signature(law).parameters.items():
        known = fields[name].metadata if name in fields else {}
        rule = str(known.get("range", ""))
        found.append(
            Option(
                name=name,
                default=parameter.default,
                unit=str(known.get("unit", "")),
                rule=rule + ", if given" if rule and parameter.default is None else rule,
                meaning=meant.get(name, ""),
            )
        )
    return found


def meanings(law: type) -> dict[str, str]:
    """Return what the section Parameters of a class says of each name, as one line."""
    section = SECTION.search((inspect.getdoc(law) or "") + "\n")
    if section is None:
        return {}
    return {
        name: " ".join(text.split())
        for names, text in ENTRY.findall(section[1])
        for name in names.split(", ")
    }
