"""Figures as files, drawn without a window."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import attrs
import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab.checks import refuse
from contactlab.figures.style import HEIGHT, RESOLUTION, WIDTH, Look, styled
from contactlab.files import written

#: Form of picture by the end of the file's name.
FORMATS = {".png": "png", ".pdf": "pdf", ".svg": "svg"}
#: Nothing that differs from run to run goes into a file.
METADATA: dict[str, dict[str, Any]] = {
    "png": {},
    "pdf": {"CreationDate": None},
    "svg": {"Date": None},
}
#: The same names in an SVG every time; TrueType in a PDF, as journals refuse matplotlib's Type 3.
WRITING: Any = {"svg.hashsalt": "contactlab", "pdf.fonttype": 42}


@attrs.frozen
class Picture:
    """A picture in a file, which a notebook shows where it is the value of a cell.

    Attributes
    ----------
    path : Path
    """

    path: Path

    def _repr_png_(self) -> bytes | None:
        return self.path.read_bytes() if self.path.suffix.lower() == ".png" else None

    def _repr_svg_(self) -> str | None:
        return self.path.read_text("utf-8") if self.path.suffix.lower() == ".svg" else None


def save(
    path: Path,
    draw: Callable[[Any], object],
    *,
    rows: int = 1,
    columns: int = 1,
    heights: tuple[float, ...] = (1.0,),
    wide: bool = False,
    look: Look = "print",
) -> Picture:
    """Draw on one Axes, or on an array of them, write a picture and return it.

    The canvas is made here, without pyplot: no backend is chosen for the process, nothing
    stays open, and a display is not needed.

    Parameters
    ----------
    path : Path
        Its end says the form: see ``FORMATS``.
    draw : callable
        Given the Axes, or an array of them of shape (rows, columns).
    rows, columns : int
    heights : tuple of float
        Heights of the rows, relative to each other.
    wide : bool
        Whether there is a long legend.
    look : {"print", "slides"}
        Of a page or of a screen: see ``contactlab.figures.style``.
    """
    with styled(look):
        figure = _drawn(draw, rows=rows, columns=columns, heights=heights, wide=wide)
        save_figure(figure, path)
    return Picture(Path(path))


def as_svg(
    draw: Callable[[Any], object], *, rows: int = 1, heights: tuple[float, ...] = (1.0,)
) -> str:
    """Return a picture as SVG that can stand within a page; arguments are those of ``save``."""
    text = io.StringIO()
    with styled(), mpl.rc_context({"svg.hashsalt": "contactlab"}):
        figure = _drawn(draw, rows=rows, columns=1, heights=heights, wide=False)
        figure.savefig(text, format="svg", metadata=METADATA["svg"])
    content = text.getvalue()
    return content[content.index("<svg") :]


def _drawn(
    draw: Callable[[Any], object],
    *,
    rows: int,
    columns: int,
    heights: tuple[float, ...],
    wide: bool,
) -> Figure:
    """Return a figure that is drawn; arguments are those of ``save``.

    Parameters
    ----------
    draw : callable
        Takes the axes: one, or an array of them, shape (rows, columns).
    rows, columns : int
    heights : tuple of float
        Relative heights of the rows.
    wide : bool
        Whether one pair of axes takes the width of a page.
    """
    scale = sum(heights) / max(heights)
    width = WIDTH * (0.85 * columns if columns > 1 else 1.6 if wide else 1.0)
    figure = Figure(figsize=(width, HEIGHT * scale * (1.25 if wide else 1.0)))
    FigureCanvasAgg(figure)
    axes = figure.subplots(
        rows, columns, sharex="col", gridspec_kw={"height_ratios": heights}, squeeze=False
    )
    draw(axes[0, 0] if rows == columns == 1 else axes)
    return figure


def save_figure(figure: Figure, path: str | Path, **options: Any) -> None:
    """Write a figure, whole or not at all; options are those of ``savefig``.

    Raises
    ------
    ValueError
        If the name does not end in one of ``FORMATS``.
    """
    form = FORMATS.get(Path(path).suffix.lower())
    if form is None:
        raise refuse("path", str(path), f"must end in {', '.join(FORMATS)}")
    with written(path, binary=True) as stream, mpl.rc_context(WRITING):
        figure.savefig(stream, format=form, dpi=RESOLUTION, metadata=METADATA[form], **options)
