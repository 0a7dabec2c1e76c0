"""Figures as files, drawn without a window."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab.figures.style import HEIGHT, RESOLUTION, WIDTH, styled
from contactlab.files import written


def save(
    path: Path,
    draw: Callable[[Any], object],
    *,
    rows: int = 1,
    columns: int = 1,
    heights: tuple[float, ...] = (1.0,),
    wide: bool = False,
) -> None:
    """Draw on one Axes, or on an array of them, and write a PNG; ``wide`` for a long legend.

    The canvas is made here, without pyplot: no backend is chosen for the process, nothing
    stays open, and a display is not needed.
    """
    with styled():
        scale = sum(heights) / max(heights)
        width = WIDTH * (0.85 * columns if columns > 1 else 1.6 if wide else 1.0)
        figure = Figure(figsize=(width, HEIGHT * scale * (1.25 if wide else 1.0)))
        FigureCanvasAgg(figure)
        axes = figure.subplots(
            rows, columns, sharex="col", gridspec_kw={"height_ratios": heights}, squeeze=False
        )
        draw(axes[0, 0] if rows == columns == 1 else axes)
        save_png(figure, path)


def save_png(figure: Figure, path: str | Path, **options: Any) -> None:
    """Write a figure as PNG, whole or not at all; options are those of ``savefig``."""
    with written(path, binary=True) as stream:
        figure.savefig(stream, format="png", dpi=RESOLUTION, **options)
