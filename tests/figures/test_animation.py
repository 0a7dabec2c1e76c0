"""The moving picture: its frames, its clock, its colours and its file."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from contactlab.figures import animation
from contactlab.figures.animation_panels import Ball, Disc, Forces
from tests.figures.animated import FIELDS, impact


@pytest.mark.parametrize(
    ("duration", "words"),
    [
        (12345.0, "2469 of 12345 s"), (2.5, "0.50 of 2.50 s"), (1.0, "0.20 of 1.00 s"),
        (0.99, "198 of 990 ms"), (0.025, "5.0 of 25.0 ms"), (250e-6, "50 of 250 µs"),
        (2e-9, "0.40 of 2.00 ns"), (2e-10, "4e-11 of 2e-10 s"),
    ],
)  # fmt: skip
def test_the_clock_has_a_readable_unit(duration, words):
    assert animation._clock(0.2, duration, impact()) == words
    assert animation._clock(0.2, 2.94327, impact(sphere=False)) == "0.59 of T = 2.943"


@pytest.mark.parametrize(
    ("spin", "words"), [(-0.0, "0 rad/s"), (-12.345, "\N{MINUS SIGN}12.3 rad/s"), (7, "7 rad/s")]
)
def test_a_spin_has_three_digits_and_a_minus(spin, words):
    assert animation._spin(spin) == words


def test_frames_come_touch_and_leave():
    """14 frames of flight, 72 in contact, 22 of flight; the rows are the first at their time."""
    found = animation._sequence(impact())
    before, touching, after = found[:14], found[14:86], found[86:]
    assert len(after) == 22
    assert {frame.words for frame in before} == {"arrives, spin \N{MINUS SIGN}1 rad/s"}
    assert [frame.flight for frame in before] == pytest.approx(np.linspace(-2.2, 0.0, 14))
    assert {frame.instant for frame in before} == {0}
    assert {frame.words for frame in after} == {"leaves, spin 1 rad/s"}
    assert [frame.flight for frame in after] == pytest.approx(np.linspace(0.0, 2.2, 22))
    assert {frame.instant for frame in after} == {3}
    assert {frame.flight for frame in touching} == {0.0}
    times = np.linspace(0.0, 4.0, 72)
    rows = [0 if t == 0.0 else 1 if t <= 1.0 else 2 if t <= 2.0 else 3 for t in times]
    assert [frame.instant for frame in touching] == rows
    assert touching[0].words == "in contact: 0.00 of 4.00 s"
    assert touching[-1].words == "in contact: 4.00 of 4.00 s"
    late = animation._sequence(impact(duration=4.5))  # beyond the last row
    assert late[85].instant == 3
    assert len(animation._sequence(impact(sphere=False))) == 72


@pytest.mark.parametrize(
    ("sphere", "fields", "panels"),
    [
        (True, FIELDS, [Forces, Disc, Ball]),
        (True, {}, [Forces, Ball]),
        (False, FIELDS, [Forces, Disc]),
        (False, {"radius": 1, "stuck": 1}, [Forces]),
    ],
)
def test_there_are_panels_for_what_is_known(sphere, fields, panels):
    figure = Figure()
    found = animation._panels(figure, impact(sphere=sphere, fields=fields))
    assert [type(panel) for panel in found] == panels
    boxes = [axes.get_subplotspec().get_position(figure) for axes in figure.axes]
    forces = boxes[0]
    if sphere:
        assert boxes[-1].x1 < forces.x0
        assert boxes[-1].width == pytest.approx(1.15 * forces.width)
    if Disc in panels:
        assert boxes[1].y1 < forces.y0
        assert boxes[1].x0 == forces.x0
        assert boxes[1].height == pytest.approx(1.15 * forces.height)


@pytest.fixture
def small(monkeypatch):
    for name, value in (
        ("SIZE", (2.0, 1.0)), ("DOTS", 20), ("ARRIVING", 2), ("IN_CONTACT", 3), ("LEAVING", 2),
    ):  # fmt: skip
        monkeypatch.setattr(animation, name, value)


def test_a_picture_moves_at_its_pace_for_ever(tmp_path, small, recwarn):
    seen = []
    path = tmp_path / "a.gif"
    animation.animate(path, impact(), ghosts={"g": impact()}, progress=lambda *n: seen.append(n))
    assert seen == [(done, 7) for done in range(1, 8)]
    with Image.open(path) as picture:
        assert (picture.format, picture.size) == ("GIF", (40, 20))
        assert picture.info["loop"] == 0
        assert picture.info["duration"] % 60 == 0
        assert picture.n_frames <= 7


def test_only_the_frames_asked_for_are_drawn(small, recwarn):
    frames = list(animation._frames(impact(), None, only={1, 4}))
    assert [frame.shape for frame in frames] == [(20, 40, 3)] * 2
    every = list(animation._frames(impact(), None))
    assert len(every) == 7
    np.testing.assert_array_equal(frames[0], every[1])
    np.testing.assert_array_equal(frames[1], every[4])


@pytest.mark.parametrize("after", [0, 3])
def test_interrupted_frames_are_written_if_there_are_any(after, tmp_path, monkeypatch):
    palette = Image.new("P", (1, 1))
    palette.putpalette([0, 0, 0, 255, 255, 255])
    monkeypatch.setattr(animation, "_palette", lambda *_: palette)

    def frames(*_):
        for number in range(after):
            yield np.full((4, 4, 3), 10 * number, dtype=np.uint8)
        raise KeyboardInterrupt

    monkeypatch.setattr(animation, "_frames", frames)
    path = tmp_path / "a.gif"
    with pytest.raises(KeyboardInterrupt):
        animation.animate(path, impact())
    assert path.exists() == bool(after)


def test_flat_colours_are_kept_exactly(monkeypatch):
    """White, a light blue and a red stay what they are; the frames are taken over the sequence."""
    asked = []
    frame = np.full((64, 64, 3), 255, dtype=np.uint8)
    frame[:16], frame[16:24] = (207, 227, 241), (213, 94, 1)
    frame[60:, :, :] = np.linspace(0, 250, 64)[None, :, None]

    def frames(result, progress, ghosts, *, only):
        asked.append(only)
        yield frame

    monkeypatch.setattr(animation, "_frames", frames)
    monkeypatch.setattr(animation, "_sequence", lambda _: [None] * 101)
    palette = animation._palette(impact(), {})
    assert asked == [{0, 20, 45, 70, 90, 100}]
    colours = np.reshape(palette.getpalette(), (-1, 3))
    assert {(255, 255, 255), (207, 227, 241), (213, 94, 1)} <= set(map(tuple, colours[:8].tolist()))
    others = colours[8:]
    assert len(others) <= 40
    near = np.abs(others[:, None] - colours[:8]).max(axis=2).min(axis=1)
    assert near.min() > 10


@pytest.mark.parametrize("fault", ["history", "shape", "empty"])
def test_what_is_no_single_impact_with_history_is_refused(fault, tmp_path):
    result = impact()
    if fault == "history":
        result.history = None
    elif fault == "shape":
        result.scene.shape = (3,)
    else:
        result.history.time = np.array([])
    with pytest.raises(ValueError, match="must have the history of a single impact"):
        animation.animate(tmp_path / "a.gif", result)


def test_ghosts_are_in_the_palette_and_in_the_frames(tmp_path, monkeypatch):
    seen = []
    palette = Image.new("P", (1, 1))
    palette.putpalette([0, 0, 0, 255, 255, 255])
    monkeypatch.setattr(animation, "_palette", lambda _, ghosts: seen.append(ghosts) or palette)

    def frames(result, progress, ghosts):
        seen.append(ghosts)
        yield np.zeros((4, 4, 3), dtype=np.uint8)

    monkeypatch.setattr(animation, "_frames", frames)
    ghosts = {"one": impact()}
    animation.animate(tmp_path / "a.gif", impact(), ghosts=ghosts)
    animation.animate(tmp_path / "b.gif", impact())
    assert seen == [ghosts, ghosts, {}, {}]
