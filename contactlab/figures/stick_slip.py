"""The map of stick and slip over radius and time."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch
from numpy.typing import NDArray

from contactlab.figures.style import LAW_COLOURS

#: Slip against the initial sense, stick, slip along it, and no contact.
STATES = {-1: "slip, backward", 0: "stick", 1: "slip, forward", 2: "no contact"}
COLOURS = (LAW_COLOURS[1], "#B9B9B9", LAW_COLOURS[0], "#FFFFFF")


def stick_slip_map(
    axes: Axes, time: NDArray[np.float64], radius: NDArray[np.float64], state: NDArray[np.int64]
) -> Axes:
    """Draw who sticks and who slips.

    Parameters
    ----------
    axes : Axes
    time : array, shape (K,)
        t over the duration of contact, increasing.
    radius : array, shape (n,)
        Middle of each annulus over the largest contact radius.
    state : array of int, shape (K, n)
        The keys of ``STATES``.
    """
    norm = BoundaryNorm(np.arange(-1.5, 3.0), len(COLOURS))
    axes.pcolormesh(
        time, radius, state.T, cmap=ListedColormap(COLOURS), norm=norm, shading="nearest",
        rasterized=True,
    )  # fmt: skip
    axes.set_xlabel(r"time over duration of contact $t/t_{\mathrm{c}}$")
    axes.set_ylabel(r"radius over largest contact radius $r/a$")
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    present = [key for key in STATES if np.any(state == key) and key != 2]
    patches = [Patch(color=COLOURS[key + 1], label=STATES[key]) for key in present]
    axes.legend(handles=patches, loc="upper left", bbox_to_anchor=(0.0, 1.0))
    return axes
