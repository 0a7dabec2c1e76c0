"""A report in one file: a scene, its plan and results, laws compared, figures and sources."""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping, Sequence
from html import escape
from importlib import metadata, resources
from string import Template

import numpy as np
from matplotlib.axes import Axes

import contactlab
from contactlab.figures.files import Panels, as_svg
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.tables import (
    closing,
    heading,
    largest_imbalance,
    scene_section,
    sweep_section,
    time,
)
from contactlab.registry.citations import references
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import SceneFile
from contactlab.study.agreement import Agreement
from contactlab.study.comparison import Comparison
from contactlab.study.comparison_figure import differences, forces_over_contact, laws_over_sweep
from contactlab_pages import html
from contactlab_pages.drawing import scene_drawing

#: Rows of a sweep on the page; ``contactlab sweep --out`` writes all of them.
ROWS = 25
#: Quantities drawn over the angle of incidence.
OVER_ANGLE = ("tangential_restitution", "rebound_angle_deg")


def report_page(
    file: SceneFile,
    simulations: Mapping[str, Simulation],
    comparison: Comparison,
) -> str:
    """Return the report of a scene file as HTML.

    The first simulation is reported, the others are compared with it. ``comparison`` holds all of
    them on the scene of the file, with the history of a single impact.
    """
    result = comparison.runs[0].result
    first = next(iter(simulations.values()))
    if not result.scene.shape:
        result = first.run(result.scene, history=True, estimate_error=True)
    title = file.title or file.path.name
    parts = [
        html.paragraph(" ".join(file.notes.split())) if file.notes else "",
        html.title_section("The scene", scene_drawing(result), *_scene(file, result.scene)),
        html.title_section("The answer", *_answer(result, file.varied, comparison.agreements)),
        html.title_section("The laws compared", *_comparison(comparison)),
        html.title_section("The plan", html.plan(result.plan)),
        html.title_section("Sources", *map(html.paragraph, _sources(file, simulations))),
        html.title_section("How this was made", html.pairs(_provenance(file, result))),
    ]
    page = resources.files("contactlab_pages").joinpath("report.html").read_text("utf-8")
    return Template(page).substitute(title=escape(title), body="\n".join(parts))


def _scene(file: SceneFile, scene: Scene) -> list[str]:
    """Return a table of the scene, and the entries that a sweep varies."""
    parts = [html.table(*scene_section(scene))]
    if file.varied:
        count = np.size(next(iter(file.varied.values())))
        parts.append(html.paragraph(f"A sweep of {count} impacts over {', '.join(file.varied)}."))
    return parts


def _answer(
    result: ImpactResult, varied: Mapping[str, Real], agreements: Sequence[Agreement]
) -> list[str]:
    """Return one impact in full, or the table of a sweep, at the measured points if there are."""
    if not result.scene.shape:
        return [html.one_impact(result)]
    if agreements:
        return [*_at_measured_points(agreements, varied), html.pairs(closing(result))]
    headings, rows = sweep_section(result, varied, most=ROWS)
    parts = [f"<div class='wide'>{html.table(headings, rows)}</div>"]
    if len(rows) < len(result):
        parts.append(html.paragraph(f"{len(rows)} of {len(result)} impacts are shown."))
    parts.append(html.paragraph(largest_imbalance(result)))
    return [*parts, html.pairs(closing(result))]


def _at_measured_points(agreements: Sequence[Agreement], varied: Mapping[str, Real]) -> list[str]:
    """Return the table of the first law at the points of the longest series, measured beside."""
    longest = max(agreements, key=lambda each: len(each.measured.x))
    x, against = longest.measured.x, longest.measured.against
    result = next(iter(longest.results.values()))
    shown = longest.measured.varied
    headings, rows = sweep_section(result, shown)
    for each in agreements:
        if np.array_equal(each.measured.x, x):
            headings = [*headings, f"{heading(each.measured.quantity, each.unit)}, measured"]
            rows = [
                [*row, float(value)] for row, value in zip(rows, each.measured.values, strict=True)
            ]
    rows = [rows[place] for place in np.argsort(x, kind="stable")]
    joined = np.array_equal(np.sort(x), varied.get(against, ()))
    curves = f"join these impacts over {against}" if joined else "are a sweep"
    words = f"At the measured values of {', '.join(shown)}, by the first law; the curves below"
    words += f" {curves}."
    return [f"<div class='wide'>{html.table(headings, rows)}</div>", html.paragraph(words)]


def _over_angle(comparison: Comparison) -> list[str]:
    """Return pictures of e_t and of the rebound angle over the angle, if they are not measured."""
    shown = {agreement.measured.quantity for agreement in comparison.agreements}
    names = [name for name in OVER_ANGLE if name not in shown]
    if next(iter(comparison.varied), "") != "angle_deg" or len(comparison.scene.axes) > 1:
        return []

    def drawing(name: str) -> Callable[[Axes], Axes]:
        return lambda axes: laws_over_sweep(axes, comparison, name)

    return [html.figure(as_svg(drawing(name)), f"{name} over angle_deg.") for name in names]


def _comparison(comparison: Comparison) -> list[str]:
    """Return pictures and tables of the laws, and their distance from measured values."""
    parts = []
    if not comparison.scene.shape:
        if any(run.result.history for run in comparison.runs):
            picture = as_svg(lambda axes: forces_over_contact(axes, comparison))
            words = "Tangential force over the contact, inside friction's limit."
            parts.append(html.figure(picture, words))
    elif comparison.agreements:
        parts += [_show_series(comparison, agreement) for agreement in comparison.agreements]
        opposite = dict.fromkeys(agreement.opposite for agreement in comparison.agreements)
        parts += [html.paragraph(f"Note: {sentence}.") for sentence in opposite if sentence]
        parts += _over_angle(comparison)
    else:
        picture = as_svg(lambda axes: laws_over_sweep(axes, comparison, "psi2"))
        parts.append(html.figure(picture, "psi2 over the sweep."))
        parts += _over_angle(comparison)
    first = comparison.names[0]
    rows = []
    for run in comparison.runs:
        difference = np.abs(comparison.difference("psi2", run.name))
        rows.append([run.name, float(np.max(difference)), time(run.run_time_per_impact)])
    headings = ["law", f"largest difference of psi2 from {first}", "run time an impact"]
    parts.append(html.table(headings, rows, digits=3))
    parts += [html.paragraph(f"failed: {sentence}") for sentence in comparison.failures()]
    if comparison.interrupted:
        parts.append(html.paragraph("Interrupted before all laws were compared."))
    return parts


def _show_series(comparison: Comparison, agreement: Agreement) -> str:
    """Return picture and table of the laws beside one series of measured values."""
    name = agreement.measured.quantity

    def draw(axes: Panels) -> None:
        laws_over_sweep(axes[0, 0], comparison, name, agreement)
        differences(axes[1, 0], comparison, name, agreement)
        axes[0, 0].set_xlabel("")

    picture = as_svg(draw, rows=2, heights=(2.4, 1.0))
    unit = agreement.unit
    rows = [[law, agreement.rms(law), agreement.largest(law)] for law in agreement.predicted]
    table = html.table(["law", f"rms difference ({unit})", "largest"], rows, digits=3)
    return html.figure(picture, f"{name}, measured: {agreement.measured.source}") + table


def _sources(file: SceneFile, simulations: Mapping[str, Simulation]) -> list[str]:
    """Return the citations of the file and of the laws, each once."""
    laws = [law for simulation in simulations.values() for law in simulation.laws]
    data = [" ".join(file.citation.split())] if file.citation else []
    return list(dict.fromkeys([*data, *(text for law in laws for text in references(law))]))


def _provenance(file: SceneFile, result: ImpactResult) -> list[tuple[str, str]]:
    """Return scene file, laws and versions, as (name, words)."""
    versions = [f"{name} {metadata.version(name)}" for name in ("numpy", "scipy")]
    return [
        ("scene file", file.path.name),
        ("laws", ", ".join(result.laws.values())),
        ("contactlab", contactlab.__version__),
        ("with", ", ".join([f"Python {platform.python_version()}", *versions])),
    ]
