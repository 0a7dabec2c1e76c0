"""Options of a law: meaning, default, unit and range of each, read from its class."""

from __future__ import annotations

import inspect
import re
from typing import Any

import attrs

#: One or several names in the section Parameters, with the indented lines below.
ENTRY = re.compile(r"^(\w+(?:, \w+)*)(?: : [^\n]*)?\n((?:(?: +[^\n]*)?\n)*)", re.MULTILINE)


@attrs.frozen(kw_only=True)
class Option:
    """One option of a law.

    Parameters
    ----------
    name : str
    default : object
        ``inspect.Parameter.empty`` if there is no default.
    unit : str
        SI unit; ``"1"`` for a number without a unit, empty if unknown or not a number.
    rule : str
        Condition on values, in the words of a refusal; empty if unknown.
    meaning : str
        Text of the class's docstring; empty if there is none.
    """

    name: str
    default: object
    unit: str
    rule: str
    meaning: str

    def __str__(self) -> str:
        """Return the name with the default, or with a note that there is none."""
        needed = self.default is inspect.Parameter.empty
        return f"{self.name}, to be given" if needed else f"{self.name} = {self.default!r}"

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON; any other default becomes its ``repr``."""
        needed = self.default is inspect.Parameter.empty
        default = None if needed else self.default
        if not isinstance(default, bool | int | float | str | None):
            default = repr(default)
        return {**attrs.asdict(self), "default": default, "needed": needed}


def options(law: type) -> list[Option]:
    """Return the options of a class of laws, in the order of its signature."""
    # Fields made by ``contactlab.numeric.checks`` carry unit and range.
    fields = attrs.fields_dict(law) if attrs.has(law) else {}
    by_name = meanings(law)
    listed = []
    for name, parameter in inspect.signature(law).parameters.items():
        metadata = fields[name].metadata if name in fields else {}
        rule, read = str(metadata.get("range", "")), str(metadata.get("read", ""))
        read = read and f"It is {read}."
        listed.append(
            Option(
                name=name,
                default=parameter.default,
                unit=str(metadata.get("unit", "")),
                rule=rule + ", if given" if rule and parameter.default is None else rule,
                meaning=" ".join(filter(None, (by_name.get(name, ""), read))),
            )
        )
    return listed


def meanings(law: type) -> dict[str, str]:
    """Return the text of the section Parameters of a class by name, each as one line."""
    return {
        name: " ".join(text.split())
        for names, text in ENTRY.findall(section(law, "Parameters"))
        for name in names.split(", ")
    }


def section(law: type, title: str) -> str:
    """Return the text of a section of a class's NumPy docstring; empty if there is none."""
    text = (inspect.getdoc(law) or "") + "\n"
    match = re.search(rf"^{title}\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", text, re.MULTILINE | re.DOTALL)
    return match[1] if match else ""
