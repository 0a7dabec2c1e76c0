"""Figure of a result: forces over the contact, or one quantity over another."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from matplotlib.axes import Axes

from contactlab.impact.scene import entry_unit
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array, Places, Real
from contactlab.outcome.columns import find_quantity, unit_in
from contactlab.outcome.functions_of_results import WithScene
from contactlab.outcome.history import WithHistory, scale_forces
from contactlab.outcome.history_figure import on_axes
from contactlab.outcome.numerical_error import error_of
from contactlab.outcome.plan import Plan
from contactlab.outcome.sheet_figure import refuse_itself
from contactlab.outcome.style import (
    Width,
    curve_colour,
    error_band,
    force_axes,
    friction_limit,
    label,
    zero_line,
)


class Drawn(WithHistory, Protocol):
    """The part of a result that is drawn."""

    def __getitem__(self, index: int, /) -> WithScene: ...

    @property
    def plan(self) -> Plan:
        """Its plan, with the declared error of psi2."""

    @property
    def psi1(self) -> Real:
        """The local angle of incidence."""

    @property
    def rebound_slip_velocity(self) -> Real:
        """The slip velocity at separation, in m/s."""

    @property
    def normal_velocity(self) -> Real:
        """The rate of approach at separation, in m/s."""

    @property
    def psi2_error_estimate(self) -> Real | None:
        """The estimated error of psi2."""


def draw_result(
    axes: Axes | None,
    result: Drawn,
    x: str | None,
    y: str | None,
    *,
    width: Width | None = None,
) -> Axes:
    """Draw ``y`` over ``x`` for a batch, or the course of a single impact.

    The course is that of the forces. Where friction changes the approach it is the path of slip:
    over the velocity of approach in the plane, as a vector in space.

    Parameters
    ----------
    axes : Axes or None
        None makes a new figure of ``matplotlib.pyplot``.
    result : ImpactResult
    x, y : str or None
        Columns of exports, angles also in degrees (``rebound_angle_deg``); psi1 and psi2 by
        default. ``x`` may be an entry that varies too. Only for a batch.
    width : {"one", "two"}, optional
        Columns of a page that a new figure fills.

    Raises
    ------
    ValueError
        For an unknown quantity, or a quantity undefined for the scene; or if a single impact has
        no history.
    """
    if not result.scene.shape:
        if x is not None or y is not None:
            raise refuse(
                "x, y", (x, y), "are for the result of many impacts", "leave them out for forces"
            )
        if not result.history or not result.history.time.size:
            raise refuse(
                "result", result, "has no history to draw", "ask for one: run(scene, history=True)"
            )
        with on_axes(axes, width) as drawn:
            draw = _forces if result.scene.inverse_mass is None else _path
            return draw(drawn, result)
    x, y = x or _abscissa(result), y or "psi2"
    refuse_itself(x, y)
    with on_axes(axes, width) as drawn:
        return _quantities(drawn, result, x, y)


def _abscissa(result: Drawn) -> str:
    """Return psi1, or the first varying entry where psi1 is the same in all impacts."""
    psi1 = result.psi1
    if np.shape(psi1) == result.scene.shape and np.ptp(psi1) > 0.0:
        return "psi1"
    return next(iter(result.scene.varied), "psi1")


def _forces(axes: Axes, result: Drawn) -> Axes:
    """Draw the tangential force of a single impact with the friction limit."""
    time, tangential, normal = scale_forces(result)
    zero_line(axes)
    friction_limit(axes, time, normal)
    axes.plot(time, tangential, color=curve_colour(0))
    force_axes(axes)
    return axes


def _path(axes: Axes, result: Drawn) -> Axes:
    """Draw slip over approach in the plane, and the slip vector in space."""
    scene, history = result.scene, result.history
    outer = scene.slip_velocity, result.rebound_slip_velocity
    before, after = (np.asarray(each)[None] for each in outer)
    slip = np.concatenate((before, history.slip_velocity, after))
    unit = unit_in("m/s", scene)
    zero_line(axes)
    if slip.ndim == 1:
        first, last = float(scene.normal_speed), float(result.normal_velocity)
        across, up = np.concatenate(([first], history.normal_velocity, [last])), slip
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


def _quantities(axes: Axes, result: Drawn, x: str, y: str) -> Axes:
    """Draw one quantity of a batch over another: a curve, or points if abscissas repeat."""
    scene = result.scene
    up = find_quantity(y, where="y")
    ordinate = up.of(result).ravel()
    if x in scene.varied:
        abscissa, unit = np.ravel(scene.varied[x]), entry_unit(x)
    else:
        across = find_quantity(x, where="x")
        abscissa, unit = across.of(result).ravel(), unit_in(across.unit, scene)
    for where, name, values in (("x", x, abscissa), ("y", y, ordinate)):
        if np.isnan(values).all():
            raise refuse(where, name, "is defined for none of these impacts", "give another")
    order = np.argsort(abscissa, kind="stable")
    curve = np.unique(abscissa).size == abscissa.size
    look: dict[str, Any] = {"marker": "" if curve else ".", "linestyle": "-" if curve else "none"}
    axes.plot(abscissa[order], ordinate[order], color=curve_colour(0), **look)
    if curve and y == "psi2":
        _band(axes, result, abscissa, ordinate, order)
    axes.set_xlabel(label(x, unit))
    axes.set_ylabel(label(y, unit_in(up.unit, scene)))
    return axes


def _band(axes: Axes, result: Drawn, x: Array, y: Array, order: Places) -> None:
    """Draw the visible numerical error of psi2, estimated or else declared."""
    error = error_of(result).ravel()
    look = {"color": curve_colour(0), "label": "numerical error"}
    error_band(axes, x[order], y[order], error[order], look)
    if axes.collections:
        axes.legend()
