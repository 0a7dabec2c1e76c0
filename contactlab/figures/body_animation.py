"""An eccentric impact as a moving picture: the body, and its approach and slip over time."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from contactlab.collisions.collision import Collision
from contactlab.figures.animation import ARRIVING, DOTS, IN_CONTACT, LEAVING, SIZE, write_gif
from contactlab.impact.rigid_body import RigidBody
from contactlab.numeric.types import Array
from contactlab.outcome.columns import unit_in
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.style import LAW_DASHES, QUIET, curve_colour, styled, zero_line

#: Flight before and after contact: the body moves as far as this times its largest half-axis.
FLIGHT = 1.6
#: Corners of an outline, and frames of the contact over those of a sphere's.
CORNERS = 120


class Body(NamedTuple):
    """A body in the frame (n, t1, t2) of the contact, its origin.

    Attributes
    ----------
    centre : array, shape (3,)
        Centre of mass at first touch, in m.
    square : array, shape (3, 3)
        Square of the matrix that makes the body of a unit ball, in m².
    before, after : (velocity, spin)
        In m/s and rad/s.
    """

    centre: Array
    square: Array
    before: tuple[Array, Array]
    after: tuple[Array, Array]

    def outline(self, time: float) -> Array:
        """Return corners of the outline in the plane of t1 and -n, shape (CORNERS, 2)."""
        velocity, spin = self.before if time < 0.0 else self.after
        turn = _rotation(spin * time)
        centre, square = self.centre + velocity * time, turn @ self.square @ turn.T
        around = np.linspace(0.0, 2.0 * np.pi, CORNERS)
        normals = np.stack((np.sin(around), np.cos(around)))  # along n and t1
        flat = square[:2, :2] @ normals
        corners = flat / np.sqrt(np.sum(normals * flat, axis=0)) + centre[:2, None]
        return np.stack((corners[1], -corners[0]), axis=-1)

    def arm(self, time: float) -> Array:
        """Return the centre of mass and the point that touches, as in ``outline``: shape (2, 2)."""
        velocity, spin = self.before if time < 0.0 else self.after
        centre = self.centre + velocity * time
        path = np.stack((centre, centre - _rotation(spin * time) @ self.centre))
        return np.stack((path[:, 1], -path[:, 0]), axis=-1)


def body_of(collision: Collision, axes: Array) -> Body:
    """Return the first body of a collision; ``axes`` has n, t1 and t2 as rows.

    The body is drawn as the ellipsoid of the same inertia, at the scale at which it touches:
    an ellipsoid as it is, a rod as a slender one; and with the arm from its centre of mass to the
    point that touches.
    """
    encounter = collision.encounter
    body, contact = encounter.body, axes @ encounter.contact
    assert isinstance(body, RigidBody)  # spheres have a picture of their own
    inertia = axes @ body.inertia @ axes.T / body.mass
    square = 2.5 * np.trace(inertia) * np.eye(3) - 5.0 * inertia
    square *= contact[0] ** 2 / square[0, 0]
    moved = [(axes @ each.velocity, axes @ each.spin) for each in (encounter, collision)]
    return Body(-contact, square, moved[0], moved[1])


def animate_bodies(
    path: str | Path,
    collision: Collision,
    axes: Array,
    *,
    ghosts: Mapping[str, Collision],
    progress: Callable[[int, int], object] | None = None,
) -> None:
    """Write an animated GIF of a body that hits and leaves.

    Parameters
    ----------
    path : str or Path
    collision : Collision
        The collision of one encounter, whose result has a history.
    axes : array, shape (3, 3)
        n, t1 and t2 as rows, in the frame of the encounter.
    ghosts : mapping of str to Collision
        The same encounter under other laws, by their names.
    progress : callable, optional
        Called as ``progress(done, total)`` after each frame.
    """
    body = body_of(collision, axes)
    others = {name: body_of(each, axes) for name, each in ghosts.items()}
    reach = float(np.sqrt(np.linalg.eigvalsh(body.square).max()))
    fastest = max(
        float(np.linalg.norm(velocity) + reach * np.linalg.norm(spin))
        for each in (body, *others.values())
        for velocity, spin in (each.before, each.after)
    )
    flight = FLIGHT * reach / fastest
    times = np.concatenate((np.linspace(-flight, 0.0, ARRIVING), np.linspace(0.0, flight, LEAVING)))
    shares = np.linspace(0.0, 1.0, IN_CONTACT)
    course = [
        *((time, 0.0) for time in times[:ARRIVING].tolist()),
        *((0.0, share) for share in shares.tolist()),
        *((time, 1.0) for time in times[ARRIVING:].tolist()),
    ]

    def frames(only: Collection[int]) -> Iterator[NDArray[np.uint8]]:
        with styled():
            figure = Figure(figsize=SIZE, dpi=DOTS, layout="constrained")
            canvas: Any = FigureCanvasAgg(figure)  # untyped in matplotlib
            left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
            show = _scene(left, body, others, times)
            cursor = _course(right, collision.result)
            canvas.draw()
            figure.set_layout_engine("none")  # no layout in later frames
            for place, (time, share) in enumerate(course):
                if only and place not in only:
                    continue
                show(time, share)
                cursor(share)
                canvas.draw()
                yield np.asarray(canvas.buffer_rgba())[..., :3].copy()
                if progress is not None and not only:
                    progress(place + 1, len(course))

    write_gif(path, frames, len(course))


def _scene(axes: Axes, body: Body, others: Mapping[str, Body], times: Array) -> Callable[..., None]:
    """Draw the ground, and return what moves the body and its ghosts."""
    all_corners = np.concatenate([
        each.outline(time) for each in (body, *others.values()) for time in times.tolist()
    ])  # fmt: skip
    low, high = all_corners.min(axis=0), all_corners.max(axis=0)
    margin = 0.06 * float(np.max(high - low))
    axes.set_aspect("equal")
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(-3.0 * margin, high[1] + 3.0 * margin)
    axes.set_axis_off()
    axes.axhspan(-9.0 * margin, 0.0, color="#E4E4E4", linewidth=0.0)
    axes.axhline(0.0, color="black", linewidth=1.0)
    look: dict[str, Any] = {"closed": True, "linewidth": 1.6}
    drawn = [(Polygon(body.outline(0.0), facecolor="#CFE3F1", edgecolor="black", **look), body)]
    for number, (name, other) in enumerate(others.items(), start=1):
        colour = curve_colour(number)
        outline = Polygon(
            other.outline(0.0), facecolor="none", edgecolor=colour, linestyle=LAW_DASHES[1], **look
        )
        drawn.append((outline, other))
        height = 0.97 - 0.07 * number
        axes.text(0.02, height, f"ghost: {name}", transform=axes.transAxes, color=colour)
    for patch, _ in drawn:
        axes.add_patch(patch)
    (arm,) = axes.plot(*body.arm(0.0).T, "o-", color="black", linewidth=1.0, markersize=4.0)
    words = axes.text(0.02, 0.97, "", transform=axes.transAxes)

    def show(time: float, share: float) -> None:
        for place, (patch, each) in enumerate(drawn):
            patch.set_xy(each.outline(time))
            patch.set_visible(place == 0 or time > 0.0)
        arm.set_data(*body.arm(time).T)
        touching = f"in contact: {100.0 * share:.0f} % of the time"
        words.set_text("arrives" if time < 0.0 else "leaves" if time > 0.0 else touching)

    return show


def _course(axes: Axes, result: ImpactResult) -> Callable[[float], None]:
    """Draw approach and slip over the time of contact, and return what moves a cursor."""
    history, duration = result.history, float(result.motion.duration)
    time = np.concatenate(([0.0], history.time / duration, [1.0]))
    speed = float(np.asarray(result.scene.normal_speed))
    unit = unit_in("m/s", result.scene)
    outer = result.scene.slip_velocity, result.rebound_slip_velocity
    slip = np.vstack([np.atleast_1d(each) for each in (outer[0], *history.slip_velocity, outer[1])])
    last = float(result.normal_velocity)
    approach = np.concatenate(([speed], history.normal_velocity, [last]))
    names = ["slip"] if slip.shape[1] == 1 else ["slip along t1", "slip along t2"]
    curves = [("approach", approach), *zip(names, slip.T, strict=True)]
    zero_line(axes)
    for number, (name, values) in enumerate(curves):
        axes.plot(time, values, color=curve_colour(number), label=name)
    axes.set_xlabel("time over duration of contact")
    axes.set_ylabel(f"velocity of the contact point ({unit})")
    axes.legend(loc="upper right")  # not moved by the cursor
    line = axes.axvline(0.0, color=QUIET, linewidth=1.0)

    def cursor(share: float) -> None:
        line.set_xdata([share, share])

    return cursor


def _rotation(angles: Array) -> Array:
    """Return the rotation by a vector of angles, by the formula of Rodrigues."""
    size = float(np.linalg.norm(angles))
    if size == 0.0:
        return np.eye(3)
    x, y, z = angles / size
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(size) * skew + (1.0 - np.cos(size)) * skew @ skew)
