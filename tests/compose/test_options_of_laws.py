"""Sections of docstrings, versions of contracts, and modules that another version had."""

import inspect
from typing import ClassVar

import pytest

from contactlab.compose.citations import bibtex, references, software
from contactlab.compose.loading import PluginError, _checked, outdated
from contactlab.compose.older import REMEDY, other_version
from contactlab.compose.options import Option, meanings, section
from contactlab.compose.registry import REGISTRY
from tests.laws.normal_laws import LinearSpring


class Documented:
    """A law.

    Parameters
    ----------
    one : float
        The first,
        in two lines.
    two, three
        Both.

    References
    ----------
    A. Author, J. Works 1 (2001) 2-3,
    with 4 figures.

    B. Writer, a book (1999).
    """


def test_sections_of_a_docstring():
    assert meanings(Documented) == {"one": "The first, in two lines.", "two": "Both.",
                                    "three": "Both."}  # fmt: skip
    works = ["A. Author, J. Works 1 (2001) 2-3, with 4 figures.", "B. Writer, a book (1999)."]
    assert references(Documented) == references(Documented()) == works
    assert section(Documented, "Notes") == ""
    assert references(inspect) == []
    assert meanings(type("Bare", (), {})) == {}


def test_options_as_plain_values():
    option = Option(name="a", default=2.0, unit="m", rule="r", meaning="w")
    plain = {"name": "a", "default": 2.0, "unit": "m", "rule": "r", "meaning": "w", "needed": False}
    assert option.to_dict() == plain
    assert str(option) == "a = 2.0"
    needed = Option(name="a", default=inspect.Parameter.empty, unit="m", rule="r", meaning="w")
    assert needed.to_dict() == plain | {"default": None, "needed": True}
    assert str(needed) == "a, to be given"
    other = Option(name="a", default=(1, 2), unit="", rule="", meaning="")
    assert other.to_dict()["default"] == "(1, 2)"


def test_works_that_are_not_in_the_library_become_notes():
    unknown = "doi" + ":10.1234" + "/abc"  # in parts: every DOI that stands in a file is known
    text = f"A. Author, J. Works 1 (2001) 2-3, {unknown}."
    assert bibtex(["Nobody"]) == "@misc{source1,\n  note = {Nobody}\n}"
    assert bibtex(["Nobody", text]).split("\n\n")[1] == f"@misc{{source2,\n  note = {{{text}}}\n}}"
    known = "Mindlin, J. Appl. Mech. 16 (1949) 259-268"
    entries = bibtex([known, known])
    assert entries.startswith("@article{mindlin1949,")
    assert "@misc" not in entries
    assert entries.count("@article") == 1
    both = bibtex([f"{known}; {unknown}"])
    assert "@article{mindlin1949," in both
    assert f"@misc{{source1,\n  note = {{{known}; {unknown}}}\n}}" in both
    assert software().startswith("@misc{contactlab,\n  author = {{The contactlab developers}},\n")
    assert software().endswith(", software}\n}")


class Old(LinearSpring):
    """Written for version 1."""

    api_version: ClassVar[int] = 1


class New(LinearSpring):
    """Written for version 3."""

    api_version: ClassVar[int] = 3


class Odd(LinearSpring):
    """Without a number."""

    api_version: ClassVar[str] = "2"


WRITE = "write api_version: ClassVar[int] = 2 in its class"


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (LinearSpring, None),
        (Old, f"Old was written for version 1 of the contracts, contactlab has 2; {REMEDY}; then "
         f"{WRITE}"),
        (New, "New.api_version is 3, contactlab has 2; if the law keeps to these contracts, "
         f"{WRITE}"),
        (Odd, "Odd.api_version is '2', contactlab has 2; if the law keeps to these contracts, "
         f"{WRITE}"),
    ],
)  # fmt: skip
def test_the_version_of_a_law(law, words):
    assert outdated(law) == words


def test_what_a_plugin_returns_is_a_law_of_its_kind():
    info = REGISTRY.info("normal.hertz")
    assert _checked(LinearSpring, info, "it") is LinearSpring
    other = REGISTRY.info("tangential.coulomb")
    for law, place, words in (
        (3, info, "it returned 3, which is not the class of a law"),
        (int, info, "it returned <class 'int'>, which is not the class of a law"),
        (LinearSpring, other, "it returned LinearSpring, a normal law; each entry point needs a "
         "module of its own with a function contactlab_law"),
        (Old, info, f"it: {outdated(Old)}"),
        (type("Half", (LinearSpring.__bases__[0],), {"api_version": 2}), info,
         "it: Half does not define respond, start"),
    ):  # fmt: skip
        with pytest.raises(PluginError) as caught:
            _checked(law, place, "it")
        assert str(caught.value) == words


WAS = "was written for another version of contactlab: it uses {}, which is not there; " + REMEDY


@pytest.mark.parametrize(
    ("error", "wanted"),
    [
        (ImportError("cannot import name 'a' from 'contactlab.b' (x.py)"), "a of contactlab.b"),
        (ModuleNotFoundError("No module named 'contactlab.b'"), "contactlab.b"),
        (AttributeError("module 'contactlab' has no attribute 'c'"), "c of contactlab"),
        (ModuleNotFoundError("No module named 'numpy.b'"), None),
        (AttributeError("module 'numpy' has no attribute 'c'"), None),
        (ValueError("No module named 'contactlab.b'"), None),
    ],
)
def test_what_another_version_had(error, wanted):
    assert other_version(error) == (None if wanted is None else WAS.format(wanted))
