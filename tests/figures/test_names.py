"""Names beside curves: distances, boxes and places found by hand; one dot is one point."""

import itertools

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab.figures import names
from contactlab.figures.names import _boxes, _crowd, _distances, _dots, _off, _places, _Room

FRAME = np.array([[0.0, 0.0], [400.0, 300.0]])
SIZE = np.array([40.0, 10.0])
FLAT = np.column_stack([np.linspace(0.0, 400.0, 101), np.full(101, 150.0)])


def lifted(height, points=FLAT):
    return points + np.array([0.0, height])


def room(own=FLAT, others=(), taken=(), curves=None, size=SIZE, unit=1.0):
    curves = [own, *others] if curves is None else curves
    return _Room(own, others, curves, [np.array(box) for box in taken], FRAME, size, unit)


def test_the_distance_of_a_box_is_that_of_its_nearest_point():
    points = np.array([[0.0, 0.0], [10.0, 0.0]])
    boxes = np.array([
        [[-1.0, -1.0], [1.0, 1.0]], [[3.0, 4.0], [5.0, 6.0]], [[12.0, -1.0], [14.0, 1.0]],
        [[4.0, -9.0], [6.0, -8.0]], [[-7.0, -9.0], [-3.0, -4.0]],
    ])  # fmt: skip
    expected = [0.0, 5.0, 2.0, 80.0**0.5, 5.0]
    assert _off(boxes, points) == pytest.approx(expected)
    many = np.concatenate([boxes] * 20)  # more than are compared at once
    assert _off(many, points) == pytest.approx(expected * 20)
    assert np.isinf(_off(boxes, np.empty((0, 2)))).all()


def test_boxes_lie_around_their_centres():
    found = _boxes(np.array([[5.0, 7.0], [0.0, 0.0]]), np.array([4.0, 2.0]))
    assert found.tolist() == [[[3.0, 6.0], [7.0, 8.0]], [[-2.0, -1.0], [2.0, 1.0]]]


def test_distances_are_from_the_nearest_point():
    points = np.array([[0.0, 0.0], [3.0, 4.0]])
    assert _distances(np.array([[3.0, 0.0], [3.0, 9.0]]), points) == pytest.approx([3.0, 5.0])


def curve(axes, x, y):
    return axes.plot(x, y)[0]


@pytest.fixture
def axes():
    """Axes of 400 by 300 dots, one dot a unit, 72 dots an inch."""
    figure = Figure(figsize=(400 / 72, 300 / 72), dpi=72)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(0.0, 400.0)
    axes.set_ylim(0.0, 300.0)
    return axes


@pytest.mark.parametrize(
    ("length", "unit", "count"),
    # A point a dot; 48 at least and 1500 at most.
    [(300.0, 1.0, 300), (300.0, 2.0, 150), (30.0, 1.0, 48), (399.0, 0.1, 1500)],
)
def test_points_stand_evenly_along_a_curve(axes, length, unit, count):
    points = _dots(curve(axes, [0.0, length / 2.0, length], [5.0, 5.0, 5.0]), unit)
    assert len(points) == count
    assert points[:, 0] == pytest.approx(np.linspace(0.0, length, count))
    assert points[:, 1] == pytest.approx(np.full(count, 5.0))


def test_points_follow_the_corners_and_pass_over_gaps(axes):
    corner = _dots(curve(axes, [0.0, 100.0, np.nan, 100.0], [0.0, 0.0, 0.0, 100.0]), 1.0)
    assert len(corner) == 200
    assert corner[0] == pytest.approx([0.0, 0.0])
    assert corner[-1] == pytest.approx([100.0, 100.0])
    assert np.max(np.minimum(corner[:, 1], 100.0 - corner[:, 0])) == pytest.approx(0.0, abs=1e-9)
    assert _dots(curve(axes, [3.0], [4.0]), 1.0) == pytest.approx(np.array([[3.0, 4.0]]))


def test_a_name_has_some_fifty_places():
    for count, step in ((48, 1), (95, 1), (96, 2), (480, 10), (3, 1)):
        points = np.arange(2.0 * count).reshape(-1, 2)
        np.testing.assert_array_equal(_places(points), points[::step])


def test_crowded_curves_are_those_whose_best_place_is_near_another(axes):
    low, middle, high = (curve(axes, [0.0, 200.0, 400.0], [y] * 3) for y in (50.0, 60.0, 200.0))
    dots = {line: _dots(line, 1.0) for line in (low, middle, high)}
    crowd = [_crowd(dots, line) for line in (low, middle, high)]
    assert crowd == pytest.approx([-10.0, -10.0, -140.0], abs=0.1)
    bent = curve(axes, [0.0, 200.0, 400.0], [60.0, 60.0, 160.0])
    dots = {low: dots[low], bent: _dots(bent, 1.0)}
    assert _crowd(dots, bent) == pytest.approx(-108.0, abs=3.0)
    assert _crowd({low: dots[low]}, low) == 0.0


def test_a_name_stands_beside_its_curve_where_there_is_room():
    """The least gap, 2.5 points, is the best where no other curve is near."""
    place, start = room().beside()
    assert start is None
    assert abs(place[1] - 150.0) == pytest.approx(2.5 + 5.0)
    assert 20.0 < place[0] < 380.0
    double, _ = room(unit=2.0).beside()
    assert abs(double[1] - 150.0) == pytest.approx(5.0 + 5.0)


def test_a_name_stands_on_the_side_that_is_farther_from_others():
    for shift, side in ((20.0, -1.0), (-20.0, 1.0)):
        place, _ = room(others=[lifted(shift)]).beside()
        assert np.sign(place[1] - 150.0) == side


@pytest.mark.parametrize(
    ("gap", "found"),
    # Between two curves: a height of 10, a gap of 2.5, and 1.35 times as much to the other.
    [(10.0 + 2.5 + 1.35 * 2.5 + 0.1, True), (10.0 + 2.5 + 1.35 * 2.5 - 0.1, False)],
)
def test_a_name_is_nearest_to_its_own_curve(gap, found):
    low, high = lifted(-11.0), lifted(gap)
    place = room(others=[low, high]).beside()
    assert (place is not None) is found


@pytest.mark.parametrize(
    ("box", "free"),
    [
        (((0.0, 0.0), (40.0, 10.0)), False),  # at the edge of the axes
        (((1.0, 1.0), (41.0, 11.0)), True), (((0.9, 1.0), (40.9, 11.0)), False),
        (((1.0, 0.9), (41.0, 10.9)), False), (((359.0, 289.0), (399.0, 299.0)), True),
        (((359.1, 289.0), (399.1, 299.0)), False), (((359.0, 289.1), (399.0, 299.1)), False),
        # 1.5 points from a curve at 150.
        (((100.0, 138.5), (140.0, 148.5)), True), (((100.0, 138.6), (140.0, 148.6)), False),
        (((100.0, 145.0), (140.0, 155.0)), False),
        # 2.5 points from other text, from 200 to 240 and from 50 to 60.
        (((200.0, 62.5), (240.0, 72.5)), True), (((200.0, 62.4), (240.0, 72.4)), False),
        (((242.5, 50.0), (282.5, 60.0)), True), (((242.4, 50.0), (282.4, 60.0)), False),
        (((157.5, 50.0), (197.5, 60.0)), True), (((157.6, 50.0), (197.6, 60.0)), False),
        (((200.0, 37.5), (240.0, 47.5)), True), (((200.0, 37.6), (240.0, 47.6)), False),
    ],
)  # fmt: skip
def test_a_box_is_free_within_the_axes_away_from_curves_and_text(box, free):
    found = room(taken=[((200.0, 50.0), (240.0, 60.0))])._free(np.array([box]))
    assert found.tolist() == [free]


def test_several_boxes_are_judged_each_by_itself():
    boxes = np.array([[[10.0, 20.0], [50.0, 30.0]], [[10.0, 145.0], [50.0, 155.0]]])
    assert room(curves=[FLAT, lifted(50.0)])._free(boxes).tolist() == [True, False]
    assert room(curves=[FLAT, lifted(-125.0)])._free(boxes).tolist() == [False, False]


def test_a_line_leads_to_a_name_where_there_is_room_only_farther_off():
    """Twelve points, straight up or down; it begins on the curve."""
    place, start = room().led()
    assert start[1] == 150.0
    assert place[0] == pytest.approx(start[0])
    assert abs(place[1] - 150.0) == pytest.approx(12.0 + 5.0)
    blocked = room(taken=[((0.0, 100.0), (400.0, 140.0)), ((0.0, 160.0), (400.0, 185.0))])
    place, start = blocked.led()
    # Above: the text ends at 185, and 2.5 more; gaps are 38 and no less.
    assert (place[1], place[0]) == (pytest.approx(150.0 + 38.0 + 5.0), pytest.approx(start[0]))
    nowhere = room(taken=[((0.0, 0.0), (400.0, 300.0))])
    assert nowhere.led() is None
    assert nowhere.beside() is None


def test_a_line_begins_away_from_other_curves_and_crosses_few():
    near = lifted(2.0, FLAT[:75])  # within 2.5 points but for the last quarter
    _, start = room(others=[near], curves=[FLAT]).led()
    assert start[0] > 296.0
    above = lifted(8.0)
    place, _ = room(others=[above], curves=[FLAT]).led()
    assert place[1] < 150.0  # upwards it would cross
    none = room(others=[lifted(1.0)], curves=[FLAT])
    assert none.led() is None


def words(axes):
    return {text.get_text(): text for text in axes.texts}


def test_names_have_the_colours_of_their_curves_and_touch_nothing(axes):
    x = np.linspace(0.0, 400.0, 50)
    lines = [curve(axes, x, np.full(50, y)) for y in (60.0, 150.0, 240.0)]
    assert names.name_curves(axes, lines, ["low", "middle", "high"])
    found = words(axes)
    for line, name, y in zip(lines, ("low", "middle", "high"), (60.0, 150.0, 240.0), strict=True):
        text = found[name]
        assert text.get_color() == line.get_color()
        box = text.get_window_extent()
        assert min(abs(box.y0 - y), abs(box.y1 - y)) == pytest.approx(2.5, abs=0.6)
        assert (text.get_ha(), text.get_va()) == ("center", "center")
    for one, other in itertools.combinations(found.values(), 2):
        assert not one.get_window_extent().overlaps(other.get_window_extent())
    assert len(axes.lines) == 3


def test_names_keep_clear_of_rules_and_of_the_legend(axes):
    x = np.linspace(0.0, 400.0, 50)
    line = curve(axes, x, np.full(50, 150.0))
    axes.plot([0.0, 400.0], [159.0, 159.0])  # two points: a rule
    axes.plot([0.0, 400.0], [141.0, 141.0])
    line.set_label("a name")
    legend = axes.legend(loc="upper left")
    assert names.name_curves(axes, [line], ["a name"])
    (text,) = axes.texts
    box = text.get_window_extent()
    assert not box.overlaps(legend.get_window_extent())
    assert box.y0 > 159.0 + 1.0 or box.y1 < 141.0 - 1.0
    leader = axes.lines[-1]
    assert (leader.get_linewidth(), leader.get_color()) == (0.6, line.get_color())
    (x0, x1), (y0, y1) = leader.get_data()
    assert y0 == pytest.approx(150.0, abs=0.1)
    assert min(abs(y1 - box.y0), abs(y1 - box.y1)) < 1.0
    assert box.x0 < x1 < box.x1
    assert abs(x1 - x0) < 60.0
    assert axes.get_xlim() == (0.0, 400.0)


def test_where_one_name_has_no_room_none_is_written(axes, monkeypatch):
    monkeypatch.setattr(names, "LED", (12.0, 54.0))
    monkeypatch.setattr(names, "SHIFTS", (0.0,))
    x = np.linspace(0.0, 400.0, 50)
    crowd = [curve(axes, x, np.full(50, y)) for y in np.arange(4.0, 300.0, 9.0)]
    before = len(axes.lines)
    assert not names.name_curves(axes, crowd[:2], ["one", "other"])
    assert not axes.texts
    assert len(axes.lines) == before
    free = Figure(figsize=(4.0, 3.0)).subplots()
    assert names.name_curves(free, [], [])


def test_curves_of_one_group_may_be_alike(axes):
    x = np.linspace(0.0, 400.0, 50)
    pair = [curve(axes, x, np.full(50, y)) for y in (150.0, 153.0)]
    others = [curve(axes, x, np.full(50, y)) for y in (40.0, 260.0)]
    assert names.name_curves(axes, [pair[0], *others], ["both", "a", "b"], alike=[pair])
    text = words(axes)["both"].get_window_extent()
    assert min(abs(text.y1 - 150.0), abs(text.y0 - 153.0)) < 6.0
