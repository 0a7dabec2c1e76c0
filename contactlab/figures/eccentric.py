"""Figure of an eccentric impact: the path of slip, or rebound and slip of many impacts."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from contactlab.figures.results import on_axes
from contactlab.figures.style import curve_colour, label, zero_line
from contactlab.numeric.checks import refuse
from contactlab.outcome.columns import unit_in


def draw_eccentric(axes: Axes | None, result: Any, x: tuple[str, Any] | None) -> Axes:
    """Draw the path of slip of one impact, or V2 and psi2 of a batch over psi1.

    Parameters
    ----------
    axes : Axes or None
        None makes a new figure of ``matplotlib.pyplot``.
    result : EccentricResult
    x : tuple of str and array, optional
        Label and values in place of psi1, for a batch.

    Raises
    ------
    ValueError
        If a single impact has no history.
    """
    if not result.scene.shape and not result.history:
        remedy = "ask for one: run(scene, history=True)"
        raise refuse("result", result, "has no history to draw", remedy)
    with on_axes(axes, None) as drawn:
        return _many(drawn, result, x) if result.scene.shape else _path(drawn, result)


def _path(axes: Axes, result: Any) -> Axes:
    """Draw slip over approach in the plane, and the slip vector in space."""
    scene, history = result.scene, result.history
    first, last = scene.slip_velocity, result.slip_velocity
    slip = np.vstack((first, history.slip_velocity, last))
    unit = unit_in("m/s", scene)
    zero_line(axes)
    if scene.planar:
        speed = float(np.asarray(scene.normal_speed))
        ends = [[speed], [speed * result.normal_velocity]]
        across, up = np.concatenate((ends[0], history.normal_velocity, ends[1])), slip[:, 0]
        axes.set_xlabel(label("velocity of approach", unit))
        axes.set_ylabel(label("slip velocity", unit))
        axes.invert_xaxis()  # time runs to the right
    else:
        across, up = slip.T
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel(label("slip velocity along t1", unit))
        axes.set_ylabel(label("slip velocity along t2", unit))
    axes.axvline(0.0, color="0.8", linewidth=0.8, zorder=0)
    axes.plot(across, up, color=curve_colour(0))
    axes.plot(across[0], up[0], "o", color=curve_colour(0), label="first touch")
    axes.plot(across[-1], up[-1], "s", color=curve_colour(1), label="separation")
    axes.legend()
    return axes


def _many(axes: Axes, result: Any, x: tuple[str, Any] | None) -> Axes:
    """Draw rebound and slip of many impacts over the slip before."""
    shape = result.scene.shape

    def size(values: Any) -> Any:
        values = np.asarray(values)
        return (values if result.scene.planar else np.linalg.norm(values, axis=-1)).reshape(-1)

    name, values = (label("psi1"), size(result.psi1)) if x is None else x
    before = np.broadcast_to(np.ravel(values), (int(np.prod(shape)),))
    order = np.argsort(before, kind="stable")
    zero_line(axes)
    curves = (("rebound over approach, -V2", -result.normal_velocity), ("psi2", size(result.psi2)))
    for number, (word, after) in enumerate(curves):
        look: dict[str, Any] = {"color": curve_colour(number), "label": word}
        axes.plot(before[order], np.ravel(after)[order], ".-", **look)
    axes.set_xlabel(name)
    axes.legend()
    return axes
