"""One look for every figure: legible in print, in grey, and to the colour-blind."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes

#: Okabe and Ito's palette, in an order that keeps neighbours apart; for things without order.
LAW_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
LAW_DASHES: tuple[Any, ...] = ("-", (0, (6, 2)), (0, (4, 1.5, 1, 1.5)), (0, (1.5, 1.5)), "-", "-")
MEASURED_COLOUR = "#000000"
QUIET = "#8C8C8C"
#: A map whose lightness grows evenly, for things in order; its yellow end is too pale for lines.
ORDERED_MAP, ORDERED_END = "viridis", 0.86

#: Column of one and a half of a journal, in inches.
WIDTH, HEIGHT = 5.6, 3.9
RESOLUTION = 200

SETTINGS: Any = {  # matplotlib types the keys of this one by one
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
#: Quantities as the paper writes them; units are added from their own metadata.
SYMBOLS = {
    "psi1": r"local angle of incidence $\psi_1$",
    "psi2": r"local angle of reflexion $\psi_2$",
    "chi": r"inertia ratio $\chi$",
    "tangential_restitution": r"tangential restitution $e_t$",
    "normal_restitution": r"normal restitution $e$",
    "slip_restitution": r"local restitution $\psi_2/\psi_1$",
    "angle_deg": "angle of incidence from the normal",
    "incidence_angle_deg": "angle of incidence from the normal",
    "rebound_angle_deg": "rebound angle from the normal",
    "local_rebound_angle_deg": "local rebound angle from the normal",
    "rebound_spin": r"rebound spin $\omega_2$",
    "friction_coefficient": r"friction coefficient $\mu$",
}


#: What is other on a screen, seen from the last row: sans serif, larger, bolder.
SLIDES: Any = {
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavusans",
    "font.size": 13.0,
    "axes.labelsize": 14.0,
    "legend.fontsize": 12.0,
    "axes.linewidth": 1.2,
    "lines.linewidth": 2.6,
}
Look = Literal["print", "slides"]
LOOKS: dict[Look, Any] = {"print": SETTINGS, "slides": SETTINGS | SLIDES}


@contextmanager
def styled(look: Look = "print") -> Iterator[None]:
    """Apply the look inside a ``with`` block and leave the user's settings as they were."""
    with mpl.rc_context(LOOKS[look]):
        yield


def label(name: str, unit: str = "1") -> str:
    """Return an axis label: the quantity as the paper writes it, with its unit."""
    words = SYMBOLS.get(name, name.replace("_", " ").replace(".", " "))
    shown = {"1": "", "deg": " (°)"}.get(unit, f" ({unit})")
    return words + shown


def verbatim(text: str) -> str:
    """Return text of a file, or a name, as it is to be drawn: a dollar begins no formula."""
    return text.replace("$", r"\$")


def ordered_colours(count: int) -> list[Any]:
    """Return colours for ``count`` things in order."""
    colours = mpl.colormaps[ORDERED_MAP]
    return [colours(place) for place in np.linspace(0.0, ORDERED_END, count)]


def law_style(number: int) -> dict[str, Any]:
    """Return colour and dashes of the law that is listed at place ``number``."""
    place = number % len(LAW_COLOURS)
    return {"color": LAW_COLOURS[place], "linestyle": LAW_DASHES[place]}


def zero_line(axes: Axes) -> None:
    """Draw y = 0 quietly, behind everything."""
    axes.axhline(0.0, color=QUIET, linewidth=0.8, zorder=0)


def force_axes(axes: Axes) -> None:
    """Label the axes of a tangential force over the contact, from first touch to separation."""
    axes.set_xlabel(TIME_LABEL)
    axes.set_ylabel(r"tangential force $F/(\mu P_{\max})$")
    axes.set_xlim(0.0, 1.0)


def friction_limit(axes: Axes, time: Any, normal_force: Any) -> None:
    """Draw P/P_max and its mirror image, with a word: inside them |F| <= mu P."""
    look: Any = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 0.9, "zorder": 4}
    axes.plot(time, normal_force, **look)
    axes.plot(time, -normal_force, **look)
    axes.annotate(
        r"limit $\pm\mu P$", (0.5, -0.9), xycoords=("axes fraction", "data"), ha="center",
        va="bottom", color="#555555", fontsize=9.5,
    )  # fmt: skip
