"""Every public name says what it is, and every public parameter what it means."""

import inspect
import re
from functools import cached_property

import attrs

import contactlab
from contactlab import contracts, shapes

#: By name, without those that are no class or function: a module, a type alias, a number.
PUBLIC = {
    name: value
    for space in (contactlab, contracts, shapes)
    for name in space.__all__
    if inspect.isclass(value := getattr(space, name)) or inspect.isfunction(value)
}
#: A line of a section of parameters: one name or several, and maybe their type.
ENTRY = re.compile(r"^ *(\*{0,2}\w+(?:, \*{0,2}\w+)*)(?: :.*)?$", re.MULTILINE)
#: The text of such sections.
SECTIONS = re.compile(r"(?:Parameters|Attributes)\n-+\n(.*?)(?=\n\n\w[\w ]*\n---|\Z)", re.DOTALL)


def members(owner):
    """Yield the public methods and properties that a class has of its own or of the package."""
    for base in owner.__mro__:
        if not base.__module__.startswith("contactlab"):
            continue
        for name, value in vars(base).items():
            found = value.__func__ if isinstance(value, staticmethod | classmethod) else value
            if not name.startswith("_") and isinstance(
                found, type(members) | property | cached_property
            ):
                yield f"{base.__name__}.{name}", (found, base)


def entries():
    """Yield every public name, members included, with its object and the class of a member."""
    found = {name: (value, None) for name, value in PUBLIC.items()}
    for value in PUBLIC.values():
        if inspect.isclass(value):
            found.update(members(value))
    return [(name, *both) for name, both in found.items()]


def parameters(value):
    """Return the names that a caller may give."""
    if inspect.isclass(value):
        fields = attrs.fields(value) if attrs.has(value) else ()
        named = [field.name for field in fields if field.init and not field.name.startswith("_")]
        return named or list(getattr(value, "_fields", ()))
    if inspect.isfunction(value):
        return [name for name in inspect.signature(value).parameters if name not in ("self", "cls")]
    return []


def undocumented(value, owner=None):
    """Return the parameters of which no section says anything, of the object or its classes."""
    # A contract tells the parameters of its methods once, at the class.
    classes = (inspect.getdoc(each) or "" for each in getattr(owner, "__mro__", ()))
    told = [text.partition("Parameters of methods\n")[2] for text in classes]
    sections = "\n".join((*SECTIONS.findall(inspect.getdoc(value) or ""), *told))
    told = {name.strip(" *") for line in ENTRY.findall(sections) for name in line.split(",")}
    return [name for name in parameters(value) if name not in told]


def test_every_public_name_is_documented():
    for name, value, owner in entries():
        text = value.func.__doc__ if isinstance(value, cached_property) else value.__doc__
        assert text, f"{name} has no docstring"
        assert text.strip().partition("\n\n")[0].endswith((".", ":")), name
        assert undocumented(value, owner) == [], name


def test_all_of_the_public_names_are_looked_at():
    assert len(PUBLIC) > 40
    assert len(entries()) > 150
    others = {name for name in contactlab.__all__ if name not in PUBLIC}
    assert others <= {"materials", "shapes", "REGISTRY", "hookimpl"}


def test_a_missing_entry_is_found():
    def example(first, second, *, third, **others):
        """Do.

        Parameters
        ----------
        first, third : float
            In m.
        **others
            Whatever.

        Raises
        ------
        second
        """

    assert undocumented(example) == ["second"]
