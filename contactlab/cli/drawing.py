"""Figures of the command line; importing this module loads matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Unpack

from matplotlib.axes import Axes

from contactlab.cli.arguments import Drawing
from contactlab.figures.comparison import all_laws
from contactlab.figures.files import Panels, save
from contactlab.figures.load_paths import draw_loops
from contactlab.study.comparison import Comparison
from contactlab.study.comparison_figure import (
    differences,
    forces_over_contact,
    laws_over_sweep,
)
from contactlab.study.loops import Loops


def draw_comparison(
    path: Path, comparison: Comparison, quantities: Sequence[str], **look: Unpack[Drawing]
) -> None:
    """Draw laws and differences over a sweep, or forces over one contact."""
    if not comparison.scene.shape:
        save(path, lambda axes: forces_over_contact(axes, comparison), **look)
        return
    panels: list[tuple[str, Any]] = []
    for name in quantities:
        agreements = [item for item in comparison.agreements if item.measured.quantity == name]
        panels += [(name, item) for item in agreements] or [(name, None)]

    def draw(axes: Panels) -> None:
        for column, (name, agreement) in enumerate(panels):
            upper, lower = axes[0, column], axes[1, column]
            laws_over_sweep(upper, comparison, name, agreement)
            differences(lower, comparison, name, agreement)
            upper.set_xlabel("")
            if column and _labels(upper) == _labels(axes[0, 0]):
                upper.get_legend().remove()  # the same laws in the same colours
        axes[0, 0].figure.align_ylabels()

    save(path, draw, rows=2, columns=len(panels), heights=(2.4, 1.0), **look)


def draw_all(path: Path, comparison: Comparison, quantity: str, **look: Unpack[Drawing]) -> None:
    """Draw every law over the sweep, and below its difference from the first law."""

    def draw(axes: Panels) -> None:
        all_laws(axes[0, 0], axes[1, 0], comparison, quantity)

    save(path, draw, rows=2, heights=(2.4, 1.2), **look)


def draw_load_paths(path: Path, paths: Loops, **look: Unpack[Drawing]) -> None:
    """Draw loops at constant and at oscillating load, one panel each."""

    def draw(axes: Panels) -> None:
        draw_loops(axes[0, 0], paths.constant, title="constant load")
        draw_loops(axes[0, 1], paths.oscillating, title="oscillating load")
        axes[0, 1].set_ylabel("")
        axes[0, 0].legend()

    save(path, draw, columns=2, **look)


def _labels(axes: Axes) -> list[str]:
    labels: list[str] = axes.get_legend_handles_labels()[1]
    return labels
