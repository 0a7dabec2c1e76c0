"""Refusals in the source: every call gives the name, then the value of an argument."""

import ast
from functools import cache
from pathlib import Path

import contactlab

ROOT = Path(contactlab.__file__).parents[1]


@cache
def refusals(text):
    """Return the arguments of every call of ``refuse`` in a file."""
    if "refuse(" not in text:
        return []
    calls = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)]
    names = [getattr(call.func, "attr", getattr(call.func, "id", "")) for call in calls]
    return [call.args for call, name in zip(calls, names, strict=True) if name == "refuse"]


def wrong(text):
    """Return calls whose value is a text of the source, which can only be a name or a rule."""
    return [
        ast.unparse(name)
        for name, value, *_ in refusals(text)
        if isinstance(value, ast.JoinedStr) or isinstance(getattr(value, "value", None), str)
    ]


def test_name_and_value_are_never_exchanged():
    paths = [path for room in ("contactlab", "plugins") for path in (ROOT / room).rglob("*.py")]
    texts = [path.read_text(encoding="utf-8") for path in paths]
    assert sum(len(refusals(text)) for text in texts) > 100
    assert [found for text in texts for found in wrong(text)] == []


def test_an_exchange_is_found():
    assert wrong('raise refuse(value, "name", "must be positive")') == ["value"]
    assert wrong('raise refuse("name", f"must be at least {least}", value)') == ["'name'"]
    assert wrong('raise checks.refuse("name", value, "must be positive")') == []
    assert wrong('raise refuse("name", None, "must be given")') == []
