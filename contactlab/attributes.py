"""Refusals of attributes that an object does not have: the name that was meant."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TypeVar

from contactlab.numeric.checks import SYMBOLS

Class = TypeVar("Class", bound=type)

#: Classes with these refusals, by name: what their attributes hold is looked through too.
CLASSES: dict[str, type] = {}
#: How deep: a result's ``scene.sphere.material.density``.
DEPTH = 3
#: Most names in one hint.
MOST = 3
#: How alike a name has to be, of 1.
ALIKE = 0.6


def named_attributes(decorated: Class) -> Class:
    """Return a class that refuses an unknown attribute with the nearest of its own.

    ``result.spin`` is told of ``rebound_spin`` and of ``scene.spin``. It remains an
    ``AttributeError``. What begins with an underscore is looked up as ever, for that is what
    ``copy``, ``pickle`` and notebooks try; and nothing is done for an attribute that is there.
    """
    made: Any = decorated
    usual = getattr(made, "__getattr__", object.__getattribute__)

    def missing(self: Any, name: str) -> Any:
        try:
            return usual(self, name)
        except AttributeError:
            # One that the class has has failed itself, or is not set yet.
            if name.startswith("_") or hasattr(type(self), name):
                raise
            raise unknown(type(self), name) from None

    made.__getattr__ = missing
    CLASSES[decorated.__name__] = decorated
    return decorated


def unknown(owner: type, name: str) -> AttributeError:
    """Return the error for an attribute that a class does not have."""
    own = public_names(owner)
    within: dict[str, str] = {}
    for path in sorted(_paths(owner, DEPTH), key=lambda path: path.count(".")):
        within.setdefault(path.rpartition(".")[2], path)
    words = [*SYMBOLS.get(name, ()), name]
    meant = [word for word in words if word in own]
    meant += [within[word] for word in words if word in within and word not in own]
    if not meant:
        import difflib  # only for those who misspell

        alike = difflib.get_close_matches(name, [*own, *within], n=1, cutoff=ALIKE)
        meant = [word if word in own else within[word] for word in alike]
    hint = f"did you mean {' or '.join(map(repr, meant[:MOST]))}?"
    if not meant:
        hint = f"it has {', '.join(own)}"
    # With the name Python's own hint, which would follow, is not made.
    return AttributeError(f"{owner.__name__}: {name} is not an attribute; {hint}", name=name)


def public_names(owner: type) -> list[str]:
    """Return the attributes and methods of a class that are meant to be used."""
    return [name for name in dir(owner) if not name.startswith("_")]


def _paths(owner: type, depth: int) -> Iterator[str]:
    """Iterate over the names within what a class's attributes hold, such as ``scene.spin``."""
    for name, held in _held(owner):
        yield from (f"{name}.{inner}" for inner in public_names(held))
        if depth > 1:
            yield from (f"{name}.{path}" for path in _paths(held, depth - 1))


def _held(owner: type) -> Iterator[tuple[str, type]]:
    """Iterate over the attributes that hold one of the ``CLASSES``, fields before properties.

    Of a field and a property with the same class the property is taken, which is always there.
    """
    by_class: dict[str, str] = {}
    fields = _annotations(owner)
    for name, annotation in (fields | _returned(owner)).items():
        for word in str(annotation).split(" | "):
            if name not in fields or word not in by_class:
                by_class[word] = name
    for word, name in by_class.items():
        if word in CLASSES and CLASSES[word] is not owner:
            yield name, CLASSES[word]


def _returned(owner: type) -> dict[str, Any]:
    """Return what the properties of a class are said to return."""
    members = {name: getattr(owner, name, None) for name in public_names(owner)}
    functions = {
        name: getattr(member, "fget", None) or getattr(member, "func", None)
        for name, member in members.items()
    }
    return {
        name: function.__annotations__.get("return")
        for name, function in functions.items()
        if function
    }


def _annotations(owner: type) -> dict[str, Any]:
    """Return what the public fields of a class are said to be."""
    found: dict[str, Any] = {}
    for base in reversed(owner.__mro__):
        found |= vars(base).get("__annotations__", {})
    return {name: said for name, said in found.items() if not name.startswith("_")}
