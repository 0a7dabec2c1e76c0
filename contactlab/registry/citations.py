"""Sources of laws and data, from docstrings, and as BibTeX."""

from __future__ import annotations

import re
from collections.abc import Iterable
from importlib import metadata, resources

from contactlab.contracts.law import Law, class_of
from contactlab.registry.options import section

DOI = re.compile(r"10\.\d{4,9}/[^\s,;}\"'`]+[^\s,;.}\"'`]")
#: The year of a work in a source in words: before a bracket or at the end.
YEAR = re.compile(r"\b(?:19|20)\d\d(?=\)|\.?$)")


def references(law: Law | type[Law]) -> list[str]:
    """Return the sources in the section References of a law, or of a class of laws."""
    text = section(class_of(law), "References").strip()
    return [" ".join(entry.split()) for entry in re.split(r"\n\n+", text) if entry]


#: Year of this version.
YEAR_OF_VERSION = 2026


def software() -> str:
    """Return the BibTeX entry of contactlab itself, with its version and year."""
    version = metadata.version("contactlab")
    return (
        "@misc{contactlab,\n  author = {{The contactlab developers}},\n"
        f"  title = {{contactlab}},\n  year = {{{YEAR_OF_VERSION}}},\n"
        f"  note = {{Version {version}, software}}\n}}"
    )


def bibtex(texts: Iterable[str]) -> str:
    """Return BibTeX entries for sources in words.

    A work whose DOI, or author and year, stand in ``references.bib`` gets its entry from there. A
    source with any other work gets an entry with its words as a note, so that no work is lost.
    """
    library = _library()
    entries: dict[str, str] = {}
    for number, text in enumerate(texts, start=1):
        keys = [key for key, (entry, names) in library.items() if _names(text, entry, names)]
        entries |= {key: library[key][0] for key in keys}
        cited = "".join(library[key][0] for key in keys)
        if not keys or any(mark not in cited for mark in DOI.findall(text) + YEAR.findall(text)):
            entries[f"source{number}"] = f"@misc{{source{number},\n  note = {{{text}}}\n}}"
    return "\n\n".join(entries.values())


def _names(text: str, entry: str, names: tuple[str, str]) -> bool:
    """Return True if a source in words names an entry by its DOI, or by first author and year."""
    doi = DOI.search(entry)
    if doi is not None and doi[0] in text:
        return True
    # Author and year followed by another DOI mean another work of that year.
    author, year = names
    named = re.search(rf"\b{re.escape(author)}\b[^;]*?\b{year}(?:\)|\.?$)(?P<rest>[^;]*)", text)
    return named is not None and (doi is None or DOI.search(named["rest"]) is None)


def _library() -> dict[str, tuple[str, tuple[str, str]]]:
    """Return the entries of ``references.bib`` by key, with first author or editor, and year."""
    text = resources.files("contactlab.registry").joinpath("references.bib").read_text("utf-8")
    library = {}
    for entry in re.split(r"\n(?=@)", text.strip()):
        key = re.match(r"@\w+\{(\w+),", entry)
        author = re.search(r"(?:author|editor) = \{(.*?)[,}]", entry)
        year = re.search(r"year = \{(\d+)\}", entry)
        assert key is not None
        assert author is not None
        assert year is not None
        library[key[1]] = (entry.strip(), (author[1], year[1]))
    return library
