"""The panels of the moving picture: ball, force and contact, with numbers found by hand."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactlab.figures.animation_panels import Ball, Disc, Forces, Frame, in_contact
from contactlab.figures.style import LAW_COLOURS
from tests.figures.animated import BLUE, GREY, RED, WHITE, impact


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


def test_a_rim_marks_the_largest_contact(axes):
    Disc(axes, impact())
    (rim,) = axes.patches
    assert (rim.get_radius(), rim.center, rim.get_fill()) == (1.0, (0.0, 0.0), False)
