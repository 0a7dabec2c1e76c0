"""An impact as a moving picture: the sphere, the forces, and the contact seen from above."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactlab.figures.animation_panels import FLIGHT, Ball, Disc, Forces, Frame
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Real
from contactlab.outcome.files import replace_file
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.style import styled

if TYPE_CHECKING:
    from PIL import Image

#: Frames before, during and after contact, and the duration of a frame, in ms.
ARRIVING, IN_CONTACT, LEAVING = 14, 72, 22
FRAME_TIME = 60
#: Size in inches, and dots per inch: 960 by 480 dots.
SIZE, DOTS = (9.6, 4.8), 100
#: Layout passes after which a legend beside axes of a fixed shape lies within the picture.
LAYOUT_PASSES = 3
#: Colours of a frame: enough for smooth edges of letters, few enough for a small file.
COLOURS, PLAIN = 48, 8
#: Difference up to which a mixed colour would be taken for a flat one.
NEAR = 10
#: Frames that the palette is taken from, as shares of the sequence.
SAMPLES = (0.0, 0.2, 0.45, 0.7, 0.9, 1.0)


def animate(
    path: str | Path,
    result: ImpactResult,
    *,
    ghosts: Mapping[str, ImpactResult] | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> None:
    """Write an animated GIF of one impact.

    Parameters
    ----------
    path : str or Path
    result : ImpactResult
        Result of one impact, ``run(scene, history="fields")``. The sphere is drawn if the scene
        has a sphere; the contact from above if the history has the fields ``radius``, ``stuck``
        and ``slipping``.
    ghosts : mapping of str to ImpactResult, optional
        The same impact under other laws, by their names: outlines that part after the contact.
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
    if not history or result.scene.shape or not history.time.size:
        raise refuse(
            "result",
            result,
            "must have the history of a single impact",
            "run(scene, history='fields')",
        )

    def frames(only: Collection[int]) -> Iterator[NDArray[np.uint8]]:
        return _frames(result, None if only else progress, ghosts or {}, only)

    write_gif(path, frames, len(_sequence(result)))


def write_gif(
    path: str | Path, frames: Callable[[Collection[int]], Iterator[NDArray[np.uint8]]], count: int
) -> None:
    """Write ``count`` frames as an animated GIF.

    Parameters
    ----------
    path : str or Path
    frames : callable
        Returns the frames whose places it is given, or all for none.
    count : int

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C, after the finished frames have been written.
    """
    from PIL import Image  # a requirement of matplotlib

    pictures: list[Image.Image] = []
    palette = _palette(frames, count)
    interrupt: KeyboardInterrupt | None = None
    try:
        for frame in frames(()):
            picture = Image.fromarray(frame)
            pictures.append(picture.quantize(palette=palette, dither=Image.Dither.NONE))
    except KeyboardInterrupt as error:
        if not pictures:
            raise
        interrupt = error
    with replace_file(path, binary=True) as stream:
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


def _palette(
    frames: Callable[[Collection[int]], Iterator[NDArray[np.uint8]]], count: int
) -> Image.Image:
    """Return one palette for all frames, from a few of them: colours do not flicker."""
    from PIL import Image

    rows = np.concatenate(list(frames({round(share * (count - 1)) for share in SAMPLES})))
    numbers = rows.reshape(-1, 3) @ np.array([65536, 256, 1])  # a colour as one number
    distinct, counts = np.unique(numbers, return_counts=True)
    flat = distinct[np.argsort(counts)[-PLAIN:]]  # white and the other flat colours, exactly
    plain = np.column_stack([flat >> 16, flat >> 8 & 255, flat & 255])
    mixed = Image.fromarray(rows).quantize(colors=COLOURS - PLAIN).getpalette() or []
    others = np.reshape(mixed[: 3 * (COLOURS - PLAIN)], (-1, 3))
    off = np.abs(others[:, np.newaxis] - plain).max(axis=2).min(axis=1)
    palette = Image.new("P", (1, 1))
    palette.putpalette([*plain.ravel().tolist(), *others[off > NEAR].ravel().tolist()])
    return palette


def _frames(
    result: ImpactResult,
    progress: Callable[[int, int], object] | None,
    ghosts: Mapping[str, ImpactResult],
    only: Collection[int],
) -> Iterator[NDArray[np.uint8]]:
    """Iterate over frames as arrays of red, green, blue, shape (height, width, 3).

    With ``only``, the frames at these places alone.
    """
    assert result.history
    with styled():
        figure = Figure(figsize=SIZE, dpi=DOTS)
        canvas: Any = FigureCanvasAgg(figure)  # untyped in matplotlib
        panels = _panels(figure, result)
        for panel in panels:
            if isinstance(panel, Ball):
                panel.add_ghosts(ghosts)
        for _ in range(LAYOUT_PASSES):
            canvas.draw()
        figure.set_layout_engine("none")  # no layout in later frames
        sequence = _sequence(result)
        for done, frame in enumerate(sequence, start=1):
            if only and done - 1 not in only:
                continue
            for panel in panels:
                panel.show(frame)
            canvas.draw()
            yield np.asarray(canvas.buffer_rgba())[..., :3].copy()
            if progress is not None:
                progress(done, len(sequence))


def _sequence(result: ImpactResult) -> list[Frame]:
    """Return the frames in their order."""
    assert result.history
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
    duration = float(result.motion.duration)
    clocks = [f"in contact: {_clock(share, duration, result)}" for share in fractions.tolist()]
    touching = [
        Frame(clock, 0.0, min(int(row), last)) for clock, row in zip(clocks, rows, strict=True)
    ]
    return [*before, *touching, *after]


def _spin(spin: Real) -> str:
    """Return a spin in words, in rad/s."""
    # + 0.0: a spin of -0 has no sign
    return f"{float(spin) + 0.0:.3g} rad/s".replace("-", "\N{MINUS SIGN}")


def _clock(share: float, duration: float, result: ImpactResult) -> str:
    """Return the time since first touch and the duration, in a readable unit; scaled, no bodies."""
    if result.scene.sphere is None:
        return f"{share * duration:.2f} of T = {duration:.4g}"
    for factor, unit in ((1.0, "s"), (1e3, "ms"), (1e6, "µs"), (1e9, "ns")):
        if duration * factor >= 1.0:
            digits = max(2 - int(np.log10(duration * factor)), 0)
            return (
                f"{share * duration * factor:.{digits}f} of {duration * factor:.{digits}f} {unit}"
            )
    return f"{share * duration:.2g} of {duration:.2g} s"


def _panels(figure: Figure, result: ImpactResult) -> list[Any]:
    """Return the panels for which scene and history have data."""
    assert result.history
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
