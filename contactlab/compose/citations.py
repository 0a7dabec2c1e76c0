"""Sources of laws and data: as their docstrings give them, and as BibTeX."""

from __future__ import annotations

import re
from collections.abc import Iterable
from importlib import metadata, resources
from typing import Any

from contactlab.compose.options import section

DOI = re.compile(r"10\.\d{4,9}/[^\s,;}\"'`]+[^\s,;.}\"'`]")
#: The year of a work, as sources in words have it.
YEAR = re.compile(r"\b(?:19|20)\d\d(?=\)|\.?$)")


def references(law: Any) -> list[str]:
    """Return what the section References of a law's docstring says, an entry a source.

    The law may be given as its class.
    """
    text = section(law if isinstance(law, type) else type(law), "References").strip()
    return [" ".join(entry.split()) for entry in re.split(r"\n\n+", text) if entry]


def software() -> str:
    """Return the BibTeX entry of contactlab itself, with its version."""
    version = metadata.version("contactlab")
    return (
        "@misc{contactlab,\n  author = {{The contactlab developers}},\n"
        f"  title = {{contactlab}},\n  note = {{Version {version}, software}}\n}}"
    )


def bibtex(texts: Iterable[str]) -> str:
    """Return BibTeX entries for sources in words.

    A work with a DOI or a name and a year that ``contactlab/references.bib`` knows has its entry
    from there. A source that names a work which is not there has an entry of its own besides, with
    the words as a note: no work is lost.
    """
    known = _known()
    found: dict[str, str] = {}
    for number, text in enumerate(texts, start=1):
        keys = [key for key, (entry, names) in known.items() if _names(text, entry, names)]
        for key in keys:
            found[key] = known[key][0]
        entries = "".join(known[key][0] for key in keys)
        if not keys or any(mark not in entries for mark in DOI.findall(text) + YEAR.findall(text)):
            found[f"source{number}"] = f"@misc{{source{number},\n  note = {{{text}}}\n}}"
    return "\n\n".join(found.values())


def _names(text: str, entry: str, names: tuple[str, str]) -> bool:
    """Return whether a source in words names an entry: by its DOI, or by first author and year.

    A name and a year with another DOI behind them are another work of that year.
    """
    doi = DOI.search(entry)
    if doi is not None and doi[0] in text:
        return True
    author, year = names
    named = re.search(rf"\b{re.escape(author)}\b[^;]*?\b{year}(?:\)|\.?$)(?P<rest>[^;]*)", text)
    return named is not None and (doi is None or DOI.search(named["rest"]) is None)


def _known() -> dict[str, tuple[str, tuple[str, str]]]:
    """Return the entries by key, with the first author's or editor's surname and the year."""
    text = resources.files("contactlab.compose").joinpath("references.bib").read_text("utf-8")
    found = {}
    for entry in re.split(r"\n(?=@)", text.strip()):
        key = re.match(r"@\w+\{(\w+),", entry)
        author = re.search(r"(?:author|editor) = \{(.*?)[,}]", entry)
        year = re.search(r"year = \{(\d+)\}", entry)
        assert key is not None
        assert author is not None
        assert year is not None
        found[key[1]] = (entry.strip(), (author[1], year[1]))
    return found
