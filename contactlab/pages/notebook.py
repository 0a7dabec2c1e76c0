"""What results, plans, scenes and laws look like in a notebook."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import numpy as np

from contactlab.compose.citations import references
from contactlab.outcome.tables import closing, largest_imbalance, scene_section, sweep_section
from contactlab.pages import html

if TYPE_CHECKING:
    from contactlab.contracts.law import Law
    from contactlab.impact.scene import Scene
    from contactlab.outcome.plan import Plan
    from contactlab.outcome.result import ImpactResult

#: Impacts of a batch that are shown.
ROWS = 10


def result_html(result: ImpactResult) -> str:
    """Return answer, tables and plan of one impact, or the first impacts of a batch."""
    if not result.scene.shape:
        return html.one_impact(result) + html.plan(result.plan)
    if len(result.scene.shape) > 1 or not len(result):
        return html.paragraph(repr(result))
    headings, rows = sweep_section(result[:ROWS], {})
    parts = [html.paragraph(repr(result)), html.table(headings, rows)]
    if len(result) > ROWS:
        parts.append(html.paragraph(f"{ROWS} of {len(result)} impacts are shown."))
    parts.append(html.paragraph(largest_imbalance(result)))
    return "".join([*parts, html.pairs(closing(result)), html.plan(result.plan)])


def plan_html(plan: Plan) -> str:
    """Return the sentences of a plan as lists."""
    return html.plan(plan)


def scene_html(scene: Scene) -> str:
    """Return the numbers of a scene; of a batch from least to greatest."""
    count = int(np.prod(scene.shape))
    words = [html.paragraph(f"{count} impacts")] if scene.shape else []
    return "".join([*words, html.table(*scene_section(scene))])


def law_html(law: Law) -> str:
    """Return what a law is, its options and its sources."""
    summary = (inspect.getdoc(type(law)) or "").partition("\n")[0]
    parts = [html.paragraph(f"{type(law).__name__} ({law.kind}): {summary}")]
    fields: tuple[Any, ...] = getattr(type(law), "__attrs_attrs__", ())
    if fields:
        options = [[field.name, repr(getattr(law, field.name))] for field in fields]
        parts.append(html.table(["option", "value"], options))
    return "".join([*parts, *map(html.paragraph, references(law))])
