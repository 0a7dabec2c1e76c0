"""Picture files, drawn without a window."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Literal, TypeAlias, TypedDict, Unpack

import attrs
import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox
from matplotlib.typing import ColorType
from numpy.typing import NDArray

from contactlab.numeric.checks import refuse
from contactlab.outcome.files import replace_file
from contactlab.outcome.style import (
    NARROW,
    RESOLUTION,
    SLIDE,
    SLIDE_DOTS,
    Look,
    RcParams,
    Width,
    darken,
    figure_size,
    styled,
)

#: Format of a picture by the suffix of its file.
FORMATS = {".png": "png", ".pdf": "pdf", ".svg": "svg"}
#: Metadata without dates, so that equal figures make equal files.
METADATA: dict[str, dict[str, Any]] = {
    "png": {},
    "pdf": {"CreationDate": None},
    "svg": {"Date": None},
}
#: Constant identifiers in an SVG; TrueType in a PDF, as journals refuse matplotlib's Type 3.
WRITING: RcParams = {"svg.hashsalt": "contactlab", "pdf.fonttype": 42}


@attrs.frozen
class Picture:
    """A picture file; a notebook shows the picture as the value of a cell.

    Attributes
    ----------
    path : Path
    """

    path: Path

    def _repr_png_(self) -> bytes | None:
        return self.path.read_bytes() if self.path.suffix.lower() == ".png" else None

    def _repr_svg_(self) -> str | None:
        return self.path.read_text("utf-8") if self.path.suffix.lower() == ".svg" else None


#: An array of Axes, and what draws on one Axes or on such an array.
Panels: TypeAlias = NDArray[np.object_]
Draw: TypeAlias = Callable[[Axes], object] | Callable[[Panels], object]

#: Factors on the height of a figure with one panel and a short legend.
NARROWER, LEGEND_BESIDE, LEGEND_BELOW = 0.8, 1.25, 1.9


def save(
    path: Path,
    draw: Draw,
    *,
    rows: int = 1,
    columns: int = 1,
    heights: tuple[float, ...] = (1.0,),
    wide: bool = False,
    low: float = 1.0,
    look: Look = "print",
    width: Width | None = None,
) -> Picture:
    """Draw on one Axes or an array of Axes, write the picture, and return it.

    The canvas is made without pyplot: the process keeps its backend, no figure stays open, and no
    display is needed.

    Parameters
    ----------
    path : Path
        The suffix selects the format: see ``FORMATS``.
    draw : callable
        Function of the Axes, or of an array of Axes of shape (rows, columns).
    rows, columns : int
    heights : tuple of float
        Heights of the rows, relative to each other.
    wide : bool
        True for a long legend.
    low : float
        Factor on the height, of print.
    look : {"print", "slides"}
        Look of a page, or of a screen: see ``contactlab.outcome.style``.
    width : {"one", "two"}, optional
        Columns of a page that the picture fills, at the size of print.
    """
    across, up = _size(columns=columns, heights=heights, wide=wide, width=width)
    size = across, low * up
    if look == "slides" and width is None:
        room = max(1.0, 0.55 * columns)  # type shrinks where panels stand side by side
        size = (room * SLIDE[0], room * SLIDE[1])
    with styled(look, width):
        figure = _draw(draw, rows=rows, columns=columns, heights=heights, size=size)
        save_figure(figure, path, look=look)
    return Picture(Path(path))


def as_svg(draw: Draw, *, rows: int = 1, heights: tuple[float, ...] = (1.0,)) -> str:
    """Return a picture as an SVG element for a page; arguments are those of ``save``."""
    text = io.StringIO()
    with styled(), mpl.rc_context({"svg.hashsalt": "contactlab"}):
        size = _size(columns=1, heights=heights, wide=False, width=None)
        figure = _draw(draw, rows=rows, columns=1, heights=heights, size=size)
        figure.savefig(text, format="svg", metadata=METADATA["svg"])
    content = text.getvalue()
    return content[content.index("<svg") :]


def _size(
    *, columns: int, heights: tuple[float, ...], wide: bool, width: Width | None
) -> tuple[float, float]:
    """Return width and height of a figure in inches; arguments are those of ``save``."""
    across, up = figure_size(width)
    up *= sum(heights) / max(heights)
    if width is None:
        across *= 1.2 + 0.25 * columns if columns > 1 else 1.6 if wide else 1.0
    elif columns > 1:
        up *= columns if across < NARROW else NARROWER
    if wide:
        up *= LEGEND_BELOW if across < NARROW else LEGEND_BESIDE
    return across, up


def _draw(
    draw: Draw,
    *,
    rows: int,
    columns: int,
    heights: tuple[float, ...],
    size: tuple[float, float],
) -> Figure:
    """Return a drawn figure; ``size`` is in inches, other arguments are those of ``save``."""
    figure = Figure(figsize=size, dpi=RESOLUTION)  # as it is written: text is measured once
    FigureCanvasAgg(figure)
    if columns > 1 and size[0] < NARROW:
        axes = _stack(figure, rows=rows, columns=columns, heights=heights)
    else:
        axes = figure.subplots(
            rows, columns, sharex="col", gridspec_kw={"height_ratios": heights}, squeeze=False
        )
    given: Any = axes[0, 0] if rows == columns == 1 else axes
    draw(given)
    return figure


def _stack(figure: Figure, *, rows: int, columns: int, heights: tuple[float, ...]) -> Panels:
    """Return axes, shape (rows, columns), with each column below the column before."""
    ratios = {"height_ratios": heights * columns}
    stack = figure.subplots(rows * columns, 1, gridspec_kw=ratios, squeeze=False)
    axes = stack.reshape(columns, rows).T
    for column in axes.T:
        for lower in column[1:]:
            lower.sharex(column[0])
        for upper in column[:-1]:
            upper.tick_params(labelbottom=False)
    return axes


class Saving(TypedDict, total=False):
    """Options of ``savefig`` beside format, resolution and metadata."""

    transparent: bool
    facecolor: ColorType
    edgecolor: ColorType
    bbox_inches: str | Bbox | None
    pad_inches: float | Literal["layout"]
    bbox_extra_artists: Sequence[Artist]


def save_figure(
    figure: Figure, path: str | Path, *, look: Look = "print", **options: Unpack[Saving]
) -> None:
    """Write a figure to a temporary file, then rename; options are those of ``savefig``.

    Parameters
    ----------
    figure : Figure
    path : str or Path
    look : {"print", "slides"}
        For slides the ground is dark and the picture 1920 dots wide; draw inside
        ``styled("slides")`` for large type, in 9.6 by 5.4 inches for 1080 dots of height.

    Raises
    ------
    ValueError
        If the suffix is not in ``FORMATS``.
    """
    form = FORMATS.get(Path(path).suffix.lower())
    if form is None:
        raise refuse("path", str(path), f"must end in {', '.join(FORMATS)}")
    dots: float = RESOLUTION
    if look == "slides":
        darken(figure)
        dots = SLIDE_DOTS / figure.get_figwidth()
    with replace_file(path, binary=True) as stream, mpl.rc_context(WRITING):
        figure.savefig(stream, format=form, dpi=dots, metadata=METADATA[form], **options)
