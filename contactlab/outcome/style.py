"""Style of all figures: legible in print, in grey, and to the colour-blind."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypedDict

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.typing import ColorType, LineStyleType

from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array

if TYPE_CHECKING:
    from matplotlib.typing import RcKeyType  # since 3.11


#: Settings of matplotlib by name.
RcParams: TypeAlias = "dict[RcKeyType, str | float | bool]"
Look = Literal["print", "slides"]
Width = Literal["one", "two"]

#: Okabe and Ito's palette for unordered curves, with contrast between neighbours.
LAW_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
LAW_DASHES: tuple[LineStyleType, ...] = (
    "-",
    (0, (6, 2)),
    (0, (4, 1.5, 1, 1.5)),
    (0, (1.5, 1.5)),
    "-",
    "-",
)


class Aside(TypedDict):
    """Look of annotations."""

    color: str
    fontsize: str


class Place(TypedDict):
    """Place of a legend."""

    loc: Literal["upper center"]
    bbox_to_anchor: tuple[float, float]
    borderaxespad: float


ASIDE: Aside = {"color": "#555555", "fontsize": "small"}
MEASURED_COLOUR = "#000000"
QUIET = "#8C8C8C"
#: Colour map of even lightness for ordered curves, and its end: yellow is too pale for lines.
ORDERED_MAP, ORDERED_END = "viridis", 0.86

#: Default width and height in inches: a column and a half of a journal.
WIDTH, HEIGHT = 5.6, 3.9
#: Widths of one and of two columns in inches, for nearly all journals.
WIDTHS: dict[Width, float] = {"one": 3.4, "two": 7.0}
RESOLUTION = 200
#: Width in inches below which a long legend stands below the axes, not beside.
NARROW = 4.5
BELOW: Place = {"loc": "upper center", "bbox_to_anchor": (0.45, -0.45), "borderaxespad": 0.0}
#: Least half-width of an error band over the height of the axes: half the width of a line, below
#: which the curve hides the band.
VISIBLE = 0.004

SETTINGS: RcParams = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 11.0,
    "axes.labelsize": 12.0,
    "legend.fontsize": 10.0,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "lines.linewidth": 1.7,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "figure.constrained_layout.use": True,
    "savefig.dpi": RESOLUTION,
}

TIME_LABEL = r"time over duration of contact $t/t_{\mathrm{c}}$"
#: Quantities in the words and symbols of the paper, without units.
SYMBOLS = {
    "psi1": r"local angle of incidence $\psi_1$",
    "psi2": r"local angle of reflexion $\psi_2$",
    "chi": r"inertia ratio $\chi$",
    "tangential_restitution": r"tangential restitution $e_t$",
    "normal_restitution": r"normal restitution $e$",
    "beta0": r"slip restitution $\beta_0 = -\psi_2/\psi_1$",
    "angle_deg": "angle of incidence from the normal",
    "incidence_angle_deg": "angle of incidence from the normal",
    "rebound_angle_deg": "rebound angle from the normal",
    "local_rebound_angle_deg": "local rebound angle from the normal",
    "rebound_spin": r"rebound spin $\omega_2$",
    "friction_coefficient": r"friction coefficient $\mu$",
}

#: Differences for a screen seen from the last row: sans serif, larger, bolder.
SLIDES: RcParams = {
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavusans",
    "font.size": 16.0,
    "axes.labelsize": 17.0,
    "legend.fontsize": 14.0,
    "axes.linewidth": 1.2,
    "lines.linewidth": 2.8,
}
#: Size of a slide in inches, and its width in dots: 1920 by 1080.
SLIDE, SLIDE_DOTS = (9.6, 5.4), 1920
#: The ground of a slide, and the share of white that its colours get.
GROUND, LIGHTER = 0.08, 0.3
#: Parts of artists that have colours, and most colours of a map that is a list of kinds.
TEXT_AND_LINES = ("color", "markerfacecolor", "markeredgecolor")
PATCHES = ("facecolor", "edgecolor")
FEW_COLOURS = 8
#: Greatest difference between red, green and blue of a grey.
GREY = 0.08
#: Text and lines at the size of print: no letter below 7 points.
PRINTED: dict[Width, RcParams] = {
    "one": {
        "font.size": 8.0,
        "axes.labelsize": 8.5,
        "legend.fontsize": 7.5,
        "legend.title_fontsize": 8.0,
        "axes.linewidth": 0.6,
        "lines.linewidth": 1.2,
    },
    "two": {
        "font.size": 9.5,
        "axes.labelsize": 10.0,
        "legend.fontsize": 9.0,
        "legend.title_fontsize": 9.5,
    },
}
LOOKS: dict[Look, Any] = {"print": SETTINGS, "slides": SETTINGS | SLIDES}


def figure_size(width: Width | None) -> tuple[float, float]:
    """Return width and height, in inches, of a figure with one Axes.

    Raises
    ------
    ValueError
        If the width is not in ``WIDTHS``.
    """
    if width is not None and width not in WIDTHS:
        raise refuse("width", width, f"must be one of {', '.join(map(repr, WIDTHS))}")
    inches = WIDTH if width is None else WIDTHS[width]
    # Full height across two columns would fill the page.
    return inches, inches * HEIGHT / WIDTH * (0.8 if width == "two" else 1.0)


def figure_width(axes: Axes) -> float:
    """Return the width of the figure of the axes, in inches."""
    figure = axes.figure.figure  # of a subfigure too, in matplotlib of any age
    return float(figure.get_figwidth())


@contextmanager
def styled(look: Look = "print", width: Width | None = None) -> Iterator[None]:
    """Apply a look inside a ``with`` block; the user's settings return afterwards.

    Parameters
    ----------
    look : {"print", "slides"}
        Look of a page, or of a slide seen from the last row: ``save_figure`` then makes the ground
        dark.
    width : {"one", "two"}, optional
        Columns of a page that the figure fills, with text at the size of print.
    """
    sizes = {} if width is None else PRINTED[width]
    with mpl.rc_context(LOOKS[look] | sizes):
        yield


def darken(figure: Figure) -> None:
    """Put a figure on the dark ground of slides: greys are turned round, colours lightened."""
    kept = {*map(mpl.colors.to_rgb, own_colours())}
    # read all colours first: some follow others
    changes: list[tuple[Any, Any]] = []
    for artist in figure.findobj(lambda each: not isinstance(each, Figure | Axes)):
        if getattr(artist, "get_array", lambda: None)() is not None:  # coloured by a map
            kinds = artist.get_cmap()  # type: ignore[attr-defined]
            if isinstance(kinds, ListedColormap) and kinds.N <= FEW_COLOURS:
                listed = [_on_dark(each, kept) for each in mpl.colors.to_rgba_array(kinds.colors)]
                changes.append((artist.set_cmap, ListedColormap(listed)))  # type: ignore[attr-defined]
            continue
        parts = TEXT_AND_LINES if hasattr(artist, "get_color") else PATCHES
        for part in parts:
            given = getattr(artist, f"get_{part}", lambda: None)()
            if given is not None:
                colours = [_on_dark(each, kept) for each in mpl.colors.to_rgba_array(given)]
                many = np.ndim(given) > 1
                changes.append(
                    (getattr(artist, f"set_{part}"), colours if many else (*colours, "none")[0])
                )
    for put, colour in changes:
        put(colour)


def _on_dark(colour: Array, kept: Set[tuple[float, float, float]]) -> tuple[float, ...]:
    """Return a colour for the dark ground; some colours, and transparency, are kept."""
    red, green, blue, alpha = map(float, colour)
    if (red, green, blue) in kept:
        return red, green, blue, alpha
    if max(red, green, blue) - min(red, green, blue) <= GREY:
        return (*[GROUND + (1.0 - GROUND) * (1.0 - red)] * 3, alpha)
    return (*(part + LIGHTER * (1.0 - part) for part in (red, green, blue)), alpha)


def error_band(axes: Axes, x: Array, middle: Array, half: Array, look: Mapping[str, Any]) -> Axes:
    """Shade the numerical error around a curve if any of it is wide enough to be visible.

    Parameters
    ----------
    axes : Axes
        Axes with the curves drawn; their height sets the visible width.
    x, middle : array, shape (points,)
        The curve, in the units of the axes.
    half : array, shape (points,)
        Numerical error in the unit of ``middle``; NaN if not declared.
    look : mapping
        Look of the curve, with ``label`` to name the band.
    """
    half = np.nan_to_num(half)
    lower, upper = axes.get_ylim()
    if np.max(half, initial=0.0) >= VISIBLE * abs(upper - lower):
        shade = {key: look[key] for key in ("color", "label") if key in look}
        axes.fill_between(x, middle - half, middle + half, alpha=0.22, linewidth=0.0, **shade)
    return axes


def label(name: str, unit: str = "1") -> str:
    """Return an axis label: the quantity in the words of the paper, with its unit."""
    words = SYMBOLS.get(name, name.replace("_", " ").replace(".", " "))
    shown = {"1": "", "deg": " (°)"}.get(unit, f" ({unit})")
    return words + shown


def verbatim(text: str) -> str:
    """Return text with dollars escaped, so that matplotlib reads no formula."""
    return text.replace("$", r"\$")


def ordered_colours(count: int) -> list[Any]:
    """Return ``count`` ordered colours."""
    colours = mpl.colormaps[ORDERED_MAP]
    return [colours(place) for place in np.linspace(0.0, ORDERED_END, count)]


def own_colours() -> list[ColorType]:
    """Return the colours of matplotlib's ``axes.prop_cycle`` where it was changed."""
    cycle = mpl.rcParams["axes.prop_cycle"]
    changed = cycle != mpl.rcParamsDefault["axes.prop_cycle"]
    return list(cycle.by_key().get("color", ())) if changed else []


def curve_colour(number: int) -> ColorType:
    """Return the colour of the curve at place ``number``, the user's or that of the palette."""
    colours = own_colours() or LAW_COLOURS
    return colours[number % len(colours)]


def law_style(number: int) -> dict[str, Any]:
    """Return colour and dashes of the law at place ``number``."""
    return {"color": curve_colour(number), "linestyle": LAW_DASHES[number % len(LAW_DASHES)]}


def zero_line(axes: Axes) -> Axes:
    """Draw y = 0 in grey, behind everything."""
    axes.axhline(0.0, color=QUIET, linewidth=0.8, zorder=0)
    return axes


def force_axes(axes: Axes) -> Axes:
    """Label the axes of a tangential force, from first touch to separation."""
    axes.set_xlabel(TIME_LABEL)
    axes.set_ylabel(r"tangential force $F/(\mu P_{\max})$")
    axes.set_xlim(0.0, 1.0)
    return axes


def friction_limit(axes: Axes, time: Array, normal_force: Array) -> Axes:
    """Draw the friction limit, plus and minus P/P_max, with its name."""
    for limit in (normal_force, -normal_force):
        axes.plot(time, limit, color="black", linestyle=(0, (4, 3)), linewidth=0.9, zorder=4)
    axes.annotate(
        r"limit $\pm\mu P$", (0.5, -0.9), xycoords=("axes fraction", "data"), ha="center",
        va="bottom", **ASIDE,
    )  # fmt: skip
    return axes
