"""The moving picture, frame by frame, of an impact whose numbers are written out.

The sphere of radius 2 comes at (3, 4) m/s with a spin of -1 rad/s and leaves at (1, 2) m/s with
1 rad/s; the contact lasts 4 s. The greater speed is 5 m/s.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from contactlab.figures import animation
from contactlab.figures.animation_panels import Ball, Disc, Forces, Frame, in_contact
from contactlab.figures.style import LAW_COLOURS

FIELDS = {
    # Two rings of radius 0.5 and 1.5; the boundary is at 1.
    "radius": np.tile([0.5, 1.5], (4, 1)),
    "stuck": np.array([[True, True], [True, False], [False, False], [False, False]]),
    "slipping": np.array([[0, 0], [0, 1], [-1, 1], [0, -1]]),
}
BLUE, GREY, RED, WHITE = (0, 114, 178), (196, 196, 196), (213, 94, 0), (255, 255, 255)


def impact(*, slip=(2.0, 1.0, 0.0, -2.0), fields=FIELDS, sphere=True, after=(1.0, -2.0), **motion):
    history = SimpleNamespace(
        time=np.array([0.0, 1.0, 2.0, 4.0]), slip_velocity=np.array(slip),
        approach=np.array([0.0, 0.5, 1.0, 0.0]), normal_force=np.array([0.0, 5.0, 10.0, 0.0]),
        tangential_force=np.array([0.0, 1.0, 2.0, -0.5]), fields=fields,
        contact_radius=np.array([0.9, 1.8, 2.0, 1.2]),
    )  # fmt: skip
    scene = SimpleNamespace(
        sphere=SimpleNamespace(radius=2.0) if sphere else None, tangential_velocity=3.0,
        normal_speed=4.0, spin=-1.0, shape=(), friction_coefficient=0.2,
    )  # fmt: skip
    numbers = {"duration": 4.0, "maximum_force": 10.0, "maximum_radius": 2.0} | motion
    return SimpleNamespace(
        history=history, scene=scene, motion=SimpleNamespace(**numbers), rebound_spin=1.0,
        rebound_tangential_velocity=after[0], rebound_normal_velocity=after[1],
    )  # fmt: skip


@pytest.fixture
def axes():
    return Figure().subplots()


def test_velocity_and_spin_change_with_the_slip():
    """After 0, 1/4, 1/2 and all of the change; trapezia of 3, 2.5, 2 and 1 m/s."""
    place, turned = in_contact(impact())
    assert list(place[:, 0]) == pytest.approx([0.0, 1.375, 2.5, 4.0])
    assert list(place[:, 1]) == pytest.approx([0.0, -0.25, -0.5, 0.0])
    assert list(turned) == pytest.approx([0.0, -0.75, -1.0, 0.0])
    place, turned = in_contact(impact(slip=(2.0, 2.0, 2.0, 2.0)))
    assert list(place[:, 0]) == pytest.approx([0.0, 1.5, 3.0, 6.0])
    assert list(turned) == pytest.approx([0.0, -1.0, -2.0, -4.0])


def test_the_field_of_view_holds_the_flight(axes):
    """2.2 radii at the greater speed, of which 3/5 along the surface; a ball and its margin."""
    Ball(axes, impact())
    assert axes.get_xlim() == pytest.approx((-2.72, 2.72))
    assert axes.get_ylim() == pytest.approx((-0.5, 4.8))
    assert axes.get_aspect() == 1.0
    coming, leaving = (line for line in axes.lines if line.get_linestyle() == ":")
    assert np.array(coming.get_data()) == pytest.approx(np.array([[0.0, -1.32], [1.0, 2.76]]))
    assert np.array(leaving.get_data()) == pytest.approx(np.array([[4.0, 4.44], [1.0, 1.88]]))
    other = Ball(Figure().subplots(), impact(after=(-6.0, -8.0)))
    assert other.velocity[1] == pytest.approx([-0.6, 0.8])
    assert other.axes.get_xlim() == pytest.approx((-2.72, 2.72))


@pytest.mark.parametrize(
    ("frame", "centre", "angle"),
    [
        (Frame("coming", -1.5, 0), (-0.9, 2.2), 0.6), (Frame("touching", 0.0, 2), (2.5, 0.5), -1.0),
        (Frame("leaving", 2.0, 3), (4.4, 1.8), 0.8),
    ],
)  # fmt: skip
def test_the_ball_is_where_it_is_and_its_spokes_turn_with_it(axes, frame, centre, angle):
    ball = Ball(axes, impact())
    ball.show(frame)
    assert ball.circle.center == pytest.approx(centre)
    assert ball.words.get_text() == frame.words
    assert len(ball.marks) == 4
    for number, mark in enumerate(ball.marks):
        turned = angle + 0.5 * np.pi * number
        reach = np.array([0.25, 0.95 if number == 0 else 0.6])
        ends = centre + np.outer(reach, [np.cos(turned), np.sin(turned)])
        assert np.transpose(mark.get_data()) == pytest.approx(ends)
        assert mark.get_linewidth() == (2.2 if number == 0 else 1.0)


def test_ghosts_part_after_the_contact_each_in_its_colour(axes):
    """The mean of 3 and 2 m/s for 4 s is 10 m, 5 radii; then (2, 1) over 5."""
    ball = Ball(axes, impact())
    ball.add_ghosts({"one": impact(after=(2.0, -1.0)), "other": impact()})
    for flight, seen in ((-1.0, False), (0.0, False), (2.0, True)):
        ball.show(Frame("", flight, 3))
        for outline, word, _, _ in ball.ghosts:
            assert (outline.get_visible(), word.get_visible()) == (seen, seen)
    first, second = ball.ghosts
    assert first[0].center == pytest.approx((5.8, 1.4))
    assert second[0].center == pytest.approx((4.4, 1.8))
    for number, (outline, word, _, _) in enumerate(ball.ghosts, start=1):
        assert word.get_color() == LAW_COLOURS[number]
        assert word.get_position() == pytest.approx((0.02, 0.90 - 0.08 * number))
        assert not outline.get_fill() or outline.get_facecolor()[3] == 0.0
        assert outline.get_radius() == 1.0
    assert [word.get_text() for _, word, _, _ in ball.ghosts] == ["ghost: one", "ghost: other"]


def test_the_force_is_drawn_up_to_the_frame(axes):
    """From first touch, over the duration and over mu P_max = 2."""
    forces = Forces(axes, impact())
    time, force = [0.0, 0.0, 0.25, 0.5, 1.0], [0.0, 0.0, 0.5, 1.0, -0.25]
    for frame, count in (
        (Frame("", -1.0, 0), 0), (Frame("", 0.0, 0), 2), (Frame("", 0.0, 2), 4),
        (Frame("", 1.0, 3), 5),
    ):  # fmt: skip
        forces.show(frame)
        assert list(forces.line.get_xdata()) == time[:count]
        assert list(forces.line.get_ydata()) == pytest.approx(force[:count])
        assert list(forces.point.get_xdata()) == time[:count][-1:]
        assert list(forces.point.get_ydata()) == pytest.approx(force[:count][-1:])
    assert (axes.get_xlim(), axes.get_ylim()) == ((0.0, 1.0), (-1.08, 1.08))
    assert max(axes.lines[1].get_ydata()) == 1.0


@pytest.mark.parametrize(
    ("frame", "inner", "outer", "edge"),
    [
        # An annulus that neither sticks nor slips has no contact.
        (Frame("", 0.0, 0), GREY, GREY, 0.9), (Frame("", 0.0, 1), GREY, BLUE, 1.8),
        (Frame("", 0.0, 2), RED, BLUE, 2.0), (Frame("", 0.0, 3), WHITE, RED, 1.2),
        (Frame("", -1.0, 0), WHITE, WHITE, 2.0), (Frame("", 1.0, 2), WHITE, WHITE, 2.0),
    ],
)  # fmt: skip
def test_the_contact_from_above_has_the_states_of_its_rings(axes, frame, inner, outer, edge):
    """The picture reaches to 1.1 of the largest radius of 2 on each side."""
    disc = Disc(axes, impact())
    disc.show(frame)
    shown = np.asarray(disc.image.get_array())
    assert shown.shape == (160, 160, 3)
    middles = np.linspace(-2.2, 2.2, 161)[:-1] + 2.2 / 160
    for row in (0, 25, 79, 80, 103):
        for column in range(160):
            distance = np.hypot(middles[row], middles[column])
            expected = WHITE if distance >= edge else inner if distance < 1.0 else outer
            assert tuple(shown[row, column]) == expected, (row, column)
    assert disc.image.get_extent() == [-1.1, 1.1, -1.1, 1.1]
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == ["slip, backward", "stick", "slip, forward"]


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


def test_a_rim_marks_the_largest_contact(axes):
    Disc(axes, impact())
    (rim,) = axes.patches
    assert (rim.get_radius(), rim.center, rim.get_fill()) == (1.0, (0.0, 0.0), False)
