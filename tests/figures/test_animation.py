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


@pytest.mark.parametrize("after", [0, 3])
def test_interrupted_frames_are_written_if_there_are_any(after, tmp_path):
    def frames(only):
        for number in range(len(only) or after):
            yield np.full((4, 4, 3), 10 * number, dtype=np.uint8)
        if not only:
            raise KeyboardInterrupt

    path = tmp_path / "a.gif"
    with pytest.raises(KeyboardInterrupt):
        animation.write_gif(path, frames, 7)
    assert path.exists() == bool(after)


def test_flat_colours_are_kept_exactly(tmp_path):
    """White, a light blue and a red, beside a run of greys, in the file."""
    frame = np.full((64, 64, 3), 255, dtype=np.uint8)
    frame[:16], frame[16:24] = (207, 227, 241), (213, 94, 1)
    frame[60:, :, :] = np.linspace(0, 190, 64)[None, :, None]
    animation.write_gif(tmp_path / "a.gif", lambda only: iter([frame] * (len(only) or 2)), 2)
    with Image.open(tmp_path / "a.gif") as picture:
        found = np.asarray(picture.convert("RGB"))
    np.testing.assert_array_equal(found[:60], frame[:60])
    assert np.abs(found[60:].astype(int) - frame[60:]).max() < 16


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
