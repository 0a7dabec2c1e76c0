"""The panels of a moving picture: the sphere in flight, the forces, the contact from above."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Ellipse, Patch
from numpy.typing import NDArray

from contactlab.figures.stick_slip import NO_CONTACT, STATES, number_states
from contactlab.impact.hertz import semi_axes
from contactlab.outcome.history import scale_forces
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.style import (
    LAW_DASHES,
    QUIET,
    TIME_LABEL,
    curve_colour,
    friction_limit,
    zero_line,
)

#: Length of the flight before and after contact, in radii of the sphere.
FLIGHT = 2.2
#: Dots along the side of the picture of the contact.
DISC = 160
#: Spokes by which the turning of the sphere is seen.
SPOKES = 4


class Frame(NamedTuple):
    """The content of one frame.

    Attributes
    ----------
    words : str
    flight : float
        Time from first touch (negative) or from separation (positive), in radii over the
        greater speed of the two; 0 in contact.
    instant : int
        Row of the history.
    """

    words: str
    flight: float
    instant: int


class Ball:
    """The sphere: its path before, during and after contact, and its spin.

    Lengths are in radii. Motion in contact is to the same scale as flight, so that only a soft
    ball visibly moves and turns while it touches.
    """

    def __init__(self, axes: Axes, result: ImpactResult) -> None:
        self.axes = axes
        scene = result.scene
        assert scene.sphere is not None
        after = result.rebound_tangential_velocity, result.rebound_normal_velocity
        assert after[0] is not None
        assert result.rebound_spin is not None
        before = np.array([float(scene.tangential_velocity), -float(scene.normal_speed)])
        leaving = np.array([float(after[0]), -float(after[1])])
        fastest = max(float(np.hypot(*before)), float(np.hypot(*leaving)))
        self.result, self.fastest = result, fastest
        self.ghosts: list[tuple[Circle, Any, NDArray[np.float64], NDArray[np.float64]]] = []
        self.velocity = before / fastest, leaving / fastest
        size = float(scene.sphere.radius) / fastest
        self.spin = float(scene.spin) * size, float(result.rebound_spin) * size
        self.place, self.turned = in_contact(result)
        reach = FLIGHT * float(np.max(np.abs([before[0], leaving[0]]))) / fastest + 1.4
        axes.set_aspect("equal")
        axes.set_xlim(-reach, reach)
        axes.set_ylim(-0.5, FLIGHT + 2.6)
        axes.set_axis_off()
        axes.axhspan(-0.5, 0.0, color="#E4E4E4", linewidth=0.0, zorder=3)
        axes.axhline(0.0, color="black", linewidth=1.0, zorder=3)
        for start, (x, y) in ((0, -self.velocity[0]), (-1, self.velocity[1])):
            left = self.place[start, 0]
            path = [left, left + FLIGHT * x], [1.0, 1.0 + FLIGHT * y]
            axes.plot(*path, color=QUIET, linestyle=":")
        self.circle = Circle((0.0, 1.0), 1.0, facecolor="#CFE3F1", edgecolor="black")
        axes.add_patch(self.circle)
        self.marks = [axes.plot([], [], color="black", linewidth=1.0)[0] for _ in range(SPOKES)]
        self.words = axes.text(0.02, 0.98, "", transform=axes.transAxes, va="top")

    def add_ghosts(self, ghosts: Mapping[str, ImpactResult]) -> None:
        """Add the same sphere under other laws: outlines that part after the contact."""
        scene, start = self.result.scene, self.place[-1]
        fastest = self.fastest
        for number, (name, result) in enumerate(ghosts.items(), start=1):
            look = {"edgecolor": curve_colour(number), "linestyle": LAW_DASHES[1], "linewidth": 1.8}
            outline = Circle((0.0, 1.0), 1.0, facecolor="none", visible=False, zorder=2, **look)
            self.axes.add_patch(outline)
            velocity = np.array(
                [float(result.rebound_tangential_velocity), -float(result.rebound_normal_velocity)]
            )
            # The mean of the velocities before and after, over the time of contact.
            along = (
                0.5
                * (float(scene.tangential_velocity) + velocity[0])
                * float(result.motion.duration)
            )
            place = np.array([along / float(scene.sphere.radius), start[1]])  # type: ignore[union-attr]
            word = self.axes.text(
                0.02, 0.90 - 0.08 * number, f"ghost: {name}", transform=self.axes.transAxes,
                va="top", color=curve_colour(number), visible=False,
            )  # fmt: skip
            self.ghosts.append((outline, word, place, velocity / fastest))

    def show(self, frame: Frame) -> None:
        """Show one frame."""
        leaving = int(frame.flight > 0.0)
        for outline, word, place, velocity in self.ghosts:
            outline.set_visible(bool(leaving))
            word.set_visible(bool(leaving))
            there = place + velocity * frame.flight
            outline.center = (float(there[0]), 1.0 + float(there[1]))
        x, y = self.place[frame.instant] + self.velocity[leaving] * frame.flight
        # Positive spin adds to the tangential velocity at the contact, below the centre. With the
        # tangential velocity to the right, the sphere turns anticlockwise.
        angle = self.turned[frame.instant] + self.spin[leaving] * frame.flight
        self.circle.center = (float(x), 1.0 + float(y))
        for number, mark in enumerate(self.marks):
            spoke = angle + 2.0 * math.pi * number / SPOKES
            reach = np.array([0.25, 0.95 if number == 0 else 0.6])
            mark.set_data(x + reach * math.cos(spoke), 1.0 + y + reach * math.sin(spoke))
            mark.set_linewidth(2.2 if number == 0 else 1.0)
        self.words.set_text(frame.words)


def in_contact(
    result: ImpactResult,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the place of the centre, in radii, and the angle of the sphere during contact, in rad.

    The impulse of friction changes velocity and spin in proportion to the slip velocity.

    Returns
    -------
    place : array, shape (K, 2)
        Displacement since first touch, in radii: along the surface, and away from the surface.
    turned : array, shape (K,)
        Angle since first touch, in rad, with the sign of the spin.
    """
    history, scene = result.history, result.scene
    assert history
    assert scene.sphere is not None
    assert result.rebound_tangential_velocity is not None
    assert result.rebound_spin is not None
    change = history.slip_velocity - history.slip_velocity[0]
    share = change / change[-1] if change[-1] else change
    before = np.array([float(scene.tangential_velocity), float(scene.spin)])
    after = np.array([float(result.rebound_tangential_velocity), float(result.rebound_spin)])
    rates = before + share[:, np.newaxis] * (after - before)
    steps = 0.5 * (rates[1:] + rates[:-1]) * np.diff(history.time)[:, np.newaxis]
    along, turned = np.vstack([np.zeros(2), np.cumsum(steps, axis=0)]).T
    return np.column_stack([along, -history.approach]) / float(scene.sphere.radius), turned


class Forces:
    """The tangential force over time, up to the instant of the frame, with the friction limit."""

    def __init__(self, axes: Axes, result: ImpactResult) -> None:
        self.time, self.tangential, normal = scale_forces(result)
        zero_line(axes)
        friction_limit(axes, self.time, normal)
        (self.line,) = axes.plot([], [], color=curve_colour(0))
        (self.point,) = axes.plot([], [], "o", color=curve_colour(0), markersize=6)
        axes.set_xlim(0.0, 1.0)
        axes.set_ylim(-1.08, 1.08)
        axes.set_xlabel(TIME_LABEL)
        axes.set_ylabel(r"$F/(\mu P_{\max})$")

    def show(self, frame: Frame) -> None:
        """Show one frame."""
        until = 0 if frame.flight < 0.0 else frame.instant + 2
        self.line.set_data(self.time[:until], self.tangential[:until])
        last = slice(max(until - 1, 0), until)
        self.point.set_data(self.time[last], self.tangential[last])


class Disc:
    """The contact seen from above, t1 to the right: stick, and slip forward or backward."""

    def __init__(self, axes: Axes, result: ImpactResult) -> None:
        history = result.history
        assert history
        fields = history.fields
        self.state = number_states(fields["stuck"], fields["slipping"])
        self.radius = np.asarray(fields["radius"])
        self.edge = np.asarray(history.contact_radius)
        self.largest = float(result.motion.maximum_radius)
        one, other = (float(axis) for axis in semi_axes(result.scene.pair))
        reach = 1.1 * max(one, other)
        side = reach * ((np.arange(DISC) + 0.5) / DISC * 2.0 - 1.0)
        self.distance = self.largest * np.hypot(side / one, side[:, np.newaxis] / other)
        names = [*STATES.values(), NO_CONTACT]
        self.colours = np.array(
            [[int(name[k : k + 2], 16) for k in (1, 3, 5)] for name in names], dtype=np.uint8
        )
        empty = np.full((DISC, DISC, 3), 255, dtype=np.uint8)
        self.image = axes.imshow(
            empty, extent=(-reach, reach, -reach, reach), interpolation="nearest"
        )
        rim = Ellipse(
            (0.0, 0.0), 2.0 * one, 2.0 * other, fill=False, edgecolor=QUIET, linestyle=":"
        )
        axes.add_patch(rim)
        axes.set_axis_off()
        patches = [Patch(color=colour, label=name) for name, colour in STATES.items()]
        axes.legend(handles=patches, loc="center left", bbox_to_anchor=(1.02, 0.5))

    def show(self, frame: Frame) -> None:
        """Show one frame."""
        row = frame.instant
        middles = self.radius[row]
        ring = np.searchsorted(0.5 * (middles[1:] + middles[:-1]), self.distance)
        state = np.where(self.distance < self.edge[row], self.state[row][ring], 3)
        if frame.flight != 0.0:
            state = np.full_like(state, 3)
        self.image.set_data(self.colours[state])
