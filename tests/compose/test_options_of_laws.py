"""Sections of docstrings, options as plain values, works as BibTeX."""

import inspect

from contactlab.compose.citations import bibtex, references, software
from contactlab.compose.options import Option, meanings, section


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
