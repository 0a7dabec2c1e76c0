"""Parts of a page as HTML: headings, tables, lists. Only this module escapes text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from contactlab.outcome.plan import Plan
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.tables import answer, closing, has_bodies, number, sections


def table(headings: Sequence[str], rows: Iterable[Sequence[object]], *, digits: int = 6) -> str:
    """Return a table with text aligned left and numbers aligned right."""
    head = "".join(f"<th>{escape(str(name))}</th>" for name in headings)
    body = "".join(f"<tr>{''.join(_cell(item, digits) for item in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def pairs(entries: Iterable[tuple[str, str]]) -> str:
    """Return a list of names and their words."""
    lines = "".join(f"<dt>{escape(name)}</dt><dd>{escape(words)}</dd>" for name, words in entries)
    return f"<dl>{lines}</dl>"


def paragraph(text: str) -> str:
    """Return a paragraph."""
    return f"<p>{escape(text)}</p>"


def title_section(title: str, *parts: str) -> str:
    """Return a section of a page with its heading."""
    return f"<section><h2>{escape(title)}</h2>{''.join(parts)}</section>"


def figure(svg: str, caption: str) -> str:
    """Return an SVG picture with a caption."""
    return f"<figure>{svg}<figcaption>{escape(caption)}</figcaption></figure>"


def plan(of: Plan) -> str:
    """Return a plan as three lists: computed, left out, cautions."""
    kinds = (("computed", of.computed), ("left out", of.left_out), ("cautions", of.cautions))
    lists = []
    for name, sentences in kinds:
        if sentences:
            items = "".join(f"<li>{escape(str(sentence))}</li>" for sentence in sentences)
            lists.append(f"<h3>{name}</h3><ul>{items}</ul>")
    return "".join(lists)


def one_impact(result: ImpactResult) -> str:
    """Return answer, tables and status of one impact."""
    parts = [table(*section) for section in sections(result)]
    parts.insert(len(parts) if has_bodies(result.scene) else 0, pairs(answer(result)))
    return "".join([*parts, pairs(closing(result))])


def _cell(item: object, digits: int) -> str:
    if isinstance(item, str):
        return f"<td>{escape(item)}</td>"
    return f'<td class="number">{escape(number(item, digits=digits))}</td>'
