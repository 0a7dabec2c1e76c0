"""Options of a law: what each means, its default, unit and range, from the class alone."""

from __future__ import annotations

import inspect
import re
from typing import Any

import attrs

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
        return {**attrs.asdict(self), "default": default, "needed": needed}


def options(law: type) -> list[Option]:
    """Return the options of a class of laws, in the order of its signature.

    Unit and range are known of fields made by ``contactlab.numeric.checks``.
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
    return {
        name: " ".join(text.split())
        for names, text in ENTRY.findall(section(law, "Parameters"))
        for name in names.split(", ")
    }


def section(law: type, title: str) -> str:
    """Return what a section of a class's NumPy docstring says; nothing if there is none."""
    text = (inspect.getdoc(law) or "") + "\n"
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", text, re.MULTILINE | re.DOTALL)
    return found[1] if found else ""
