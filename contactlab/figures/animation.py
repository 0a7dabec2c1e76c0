"""An impact as a moving picture: the sphere, the forces, and the contact seen from above."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch
from numpy.typing import NDArray

from contactlab.figures.stick_slip import NO_CONTACT, STATES
from contactlab.figures.style import (
    LAW_COLOURS,
    QUIET,
    TIME_LABEL,
    friction_limit,
    styled,
    zero_line,
)
from contactlab.numeric.checks import refuse
from contactlab.outcome.columns import scaled_forces
from contactlab.outcome.files import written
from contactlab.outcome.result import ImpactResult

#: Frames before, during and after contact, and the duration of a frame, in ms.
ARRIVING, IN_CONTACT, LEAVING = 14, 72, 22
FRAME_TIME = 60
#: Length of the flight before and after contact, in radii of the sphere.
FLIGHT = 2.2
#: Size in inches, and dots per inch: 960 by 480 dots.
SIZE, DOTS = (9.6, 4.8), 100
#: Layout passes after which a legend beside axes of a fixed shape lies within the picture.
LAYOUT_PASSES = 3
#: Dots along the side of the picture of the contact.
DISC = 160
SPOKES = 4
#: Colours of a frame: enough for smooth edges of letters, few enough for a small file.
COLOURS = 32


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


def animate(
    path: str | Path, result: ImpactResult, *, progress: Callable[[int, int], object] | None = None
) -> None:
    """Write an animated GIF of one impact.

    Parameters
    ----------
    path : str or Path
    result : ImpactResult
        Result of one impact, ``run(scene, history="fields")``. The sphere is drawn if the scene
        has a sphere; the contact from above if the history has the fields ``radius``, ``stuck``
        and ``slipping``.
    progress : callable, optional
        Called as ``progress(done, total)`` after each frame.

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C, after the finished frames have been written.
    ValueError
        If the result has no history of a single impact.
    """
    history = result.history
    if history is None or result.scene.shape or not history.time.size:
        raise refuse(
            "result",
            result,
            "must have the history of a single impact",
            "run(scene, history='fields')",
        )
    from PIL import Image  # a requirement of matplotlib

    adaptive = Image.Palette.ADAPTIVE
    pictures: list[Image.Image] = []
    interrupt: KeyboardInterrupt | None = None
    try:
        for frame in _frames(result, progress):
            picture = Image.fromarray(frame)
            pictures.append(picture.convert("P", palette=adaptive, colors=COLOURS))
    except KeyboardInterrupt as error:
        if not pictures:
            raise
        interrupt = error
    with written(path, binary=True) as stream:
        pictures[0].save(
            stream,
            format="GIF",
            save_all=True,
            append_images=pictures[1:],
            duration=FRAME_TIME,
            loop=0,
        )
    if interrupt is not None:
        raise interrupt


def _frames(
    result: ImpactResult, progress: Callable[[int, int], object] | None
) -> Iterator[NDArray[np.uint8]]:
    """Iterate over the frames as arrays of red, green, blue, shape (height, width, 3)."""
    assert result.history is not None
    with styled():
        figure = Figure(figsize=SIZE, dpi=DOTS)
        canvas: Any = FigureCanvasAgg(figure)  # untyped in matplotlib
        panels = _panels(figure, result)
        for _ in range(LAYOUT_PASSES):
            canvas.draw()
        figure.set_layout_engine("none")  # no layout in later frames
        sequence = _sequence(result)
        for done, frame in enumerate(sequence, start=1):
            for panel in panels:
                panel.show(frame)
            canvas.draw()
            yield np.asarray(canvas.buffer_rgba())[..., :3].copy()
            if progress is not None:
                progress(done, len(sequence))


def _sequence(result: ImpactResult) -> list[Frame]:
    """Return the frames in their order."""
    assert result.history is not None
    last = len(result.history.time) - 1
    if result.scene.sphere is None:
        before: list[Frame] = []
        after: list[Frame] = []
    else:
        arrives = f"arrives, spin {_spin(result.scene.spin)}"
        leaves = f"leaves, spin {_spin(result.rebound_spin)}"
        before = [Frame(arrives, -t, 0) for t in np.linspace(FLIGHT, 0.0, ARRIVING).tolist()]
        after = [Frame(leaves, t, last) for t in np.linspace(0.0, FLIGHT, LEAVING).tolist()]
    fractions = np.linspace(0.0, 1.0, IN_CONTACT)
    rows = np.searchsorted(result.history.time, fractions * float(result.motion.duration))
    slowed = f"in contact, {_seconds(float(result.motion.duration), result)}"
    return [*before, *(Frame(slowed, 0.0, min(int(k), last)) for k in rows), *after]


def _spin(spin: Any) -> str:
    """Return a spin in words, in rad/s."""
    return f"{float(spin) + 0.0:.3g} rad/s".replace("-", "\N{MINUS SIGN}")


def _seconds(duration: float, result: ImpactResult) -> str:
    """Return a duration in words, in a readable unit; scaled without bodies."""
    if result.scene.sphere is None:
        return f"T = {duration:.4g}"
    for factor, unit in ((1.0, "s"), (1e3, "ms"), (1e6, "µs"), (1e9, "ns")):
        if duration * factor >= 1.0:
            return f"{duration * factor:.3g} {unit}"
    return f"{duration:.2g} s"


def _panels(figure: Figure, result: ImpactResult) -> list[Any]:
    """Return the panels for which scene and history have data."""
    assert result.history is not None
    has_sphere = result.scene.sphere is not None
    has_disc = {"radius", "stuck", "slipping"} <= set(result.history.fields)
    columns = figure.add_gridspec(1, 1 + has_sphere, width_ratios=[1.15, 1.0][: 1 + has_sphere])
    ratios = [1.0, 1.15][: 1 + has_disc]
    right = columns[0, has_sphere].subgridspec(1 + has_disc, 1, height_ratios=ratios)
    panels: list[Any] = [Forces(figure.add_subplot(right[0]), result)]
    if has_disc:
        panels.append(Disc(figure.add_subplot(right[1]), result))
    if has_sphere:
        panels.append(Ball(figure.add_subplot(columns[0, 0]), result))
    return panels


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

    def show(self, frame: Frame) -> None:
        """Show one frame."""
        leaving = int(frame.flight > 0.0)
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
    assert history is not None
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
        self.time, self.tangential, normal = scaled_forces(result)
        zero_line(axes)
        friction_limit(axes, self.time, normal)
        (self.line,) = axes.plot([], [], color=LAW_COLOURS[0])
        (self.point,) = axes.plot([], [], "o", color=LAW_COLOURS[0], markersize=6)
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
    """The contact seen from above: stick, and slip forward or backward."""

    def __init__(self, axes: Axes, result: ImpactResult) -> None:
        history = result.history
        assert history is not None
        fields = history.fields
        self.state = np.where(
            fields["stuck"], 1, np.where(fields["slipping"] == 0, 3, fields["slipping"] + 1)
        )
        self.radius = np.asarray(fields["radius"])
        self.edge = np.asarray(history.contact_radius)
        self.largest = float(result.motion.maximum_radius)
        side = (np.arange(DISC) + 0.5) / DISC * 2.2 - 1.1
        self.distance = self.largest * np.hypot(side, side[:, np.newaxis])
        names = [*STATES.values(), NO_CONTACT]
        self.colours = np.array(
            [[int(name[k : k + 2], 16) for k in (1, 3, 5)] for name in names], dtype=np.uint8
        )
        empty = np.full((DISC, DISC, 3), 255, dtype=np.uint8)
        self.image = axes.imshow(empty, extent=(-1.1, 1.1, -1.1, 1.1), interpolation="nearest")
        rim = Circle((0.0, 0.0), 1.0, fill=False, edgecolor=QUIET, linestyle=":")
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
