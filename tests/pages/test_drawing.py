"""The drawing of a scene, with lengths found by hand: 60 units a radius, y downwards.

An arrow of 1.9 radii is the greater speed; arrows begin 1.15 radii from the centre of the sphere.
"""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from contactlab.impact.bodies import Sphere
from contactlab.pages.drawing import scene_drawing

BLUE, ORANGE = "#0072B2", "#D55E00"
FLAT = (
    "<rect x='-252' y='0' width='504' height='54' fill='#e4e4e4'/>"
    "<line x1='-252' y1='0' x2='252' y2='0' stroke='black'/>"
)


def result(before=(3.0, 4.0), after=(1.2, -1.6), spin=0.0, spin_after=0.0, target=None):
    scene = SimpleNamespace(
        sphere=object(), shape=(), target=target, tangential_velocity=before[0],
        normal_speed=before[1], spin=spin,
    )  # fmt: skip
    return SimpleNamespace(
        scene=scene, rebound_tangential_velocity=after[0], rebound_normal_velocity=after[1],
        rebound_spin=spin_after,
    )  # fmt: skip


def arrows(svg):
    """Ends of line, corners of the tip, place, side and words of each arrow, by its colour."""
    number = r"'(-?[\d.]+)'"
    pattern = (
        rf"<line x1={number} y1={number} x2={number} y2={number} stroke='(#\w+)' "
        r"stroke-width='2.5'/><polygon points='([^']*)' fill='(#\w+)'/>"
        rf"<text x={number} y={number} fill='(#\w+)' text-anchor='(\w+)'>([^<]*)</text>"
    )
    found = {}
    for each in re.findall(pattern, svg):
        assert each[4] == each[6] == each[9]
        tip = [tuple(map(float, corner.split(","))) for corner in each[5].split()]
        found[each[4]] = (
            [float(one) for one in each[:4]], tip, (float(each[7]), float(each[8])), *each[10:]
        )  # fmt: skip
    return found


def test_arrows_have_the_length_and_the_way_of_the_velocities():
    """Arriving, 114 units along (0.6, 0.8) up to 69 before the centre at -60; leaving, 45.6."""
    found = arrows(scene_drawing(result()))
    (x1, y1, x2, y2), tip, place, side, words = found[BLUE]
    begin = np.array([0.0, -60.0]) - (114.0 + 69.0) * np.array([0.6, 0.8])
    end = np.array([0.0, -60.0]) - 69.0 * np.array([0.6, 0.8])
    assert [x1, y1] == pytest.approx(begin, abs=0.06)
    assert tip[0] == pytest.approx(tuple(end), abs=0.06)
    stem = end - 12.0 * np.array([0.6, 0.8])
    assert [x2, y2] == pytest.approx(stem, abs=0.06)
    assert tip[1] == pytest.approx(tuple(stem + 5.0 * np.array([-0.8, 0.6])), abs=0.06)
    assert tip[2] == pytest.approx(tuple(stem - 5.0 * np.array([-0.8, 0.6])), abs=0.06)
    assert place == pytest.approx((begin[0] - 10.0, begin[1]), abs=0.06)
    assert (side, words) == ("end", "5 m/s")
    (x1, y1, *_), tip, place, side, words = found[ORANGE]
    begin = np.array([0.0, -60.0]) + 69.0 * np.array([0.6, -0.8])
    end = begin + 114.0 * 0.4 * np.array([0.6, -0.8])
    assert [x1, y1] == pytest.approx(begin, abs=0.06)
    assert tip[0] == pytest.approx(tuple(end), abs=0.06)
    assert place == pytest.approx((end[0] + 10.0, end[1]), abs=0.06)
    assert (side, words) == ("start", "2 m/s")


def test_the_greater_speed_has_the_longer_arrow():
    found = arrows(scene_drawing(result(before=(0.0, 1.0), after=(0.0, -4.0))))
    for colour, length in ((BLUE, 28.5), (ORANGE, 114.0)):
        (x1, y1, *_), tip, *_ = found[colour]
        assert np.hypot(tip[0][0] - x1, tip[0][1] - y1) == pytest.approx(length, abs=0.1)


def test_a_sphere_that_stays_has_no_arrow():
    found = arrows(scene_drawing(result(after=(0.0, 0.0))))
    assert set(found) == {BLUE}


def test_the_frame_holds_surface_and_arrows():
    svg = scene_drawing(result())
    assert svg.startswith("<svg viewBox='-252 -264 504 318' role='img' aria-label='the impact' ")
    assert svg.endswith("</svg>")
    assert "<circle cx='0' cy='-60' r='60' fill='#cfe3f1' stroke='black'/>" in svg
    assert FLAT in svg


def test_a_target_that_is_a_sphere_is_curved():
    from contactlab import Material

    svg = scene_drawing(result(target=Sphere(0.02, Material.named("steel"))))
    assert "<circle cx='0' cy='150' r='150' fill='#e4e4e4' stroke='black'/>" in svg
    assert "<rect" not in svg


@pytest.mark.parametrize("what", ["sphere", "shape"])
def test_batches_and_scenes_without_bodies_are_not_drawn(what):
    of = result()
    setattr(of.scene, what, None if what == "sphere" else (3,))
    assert scene_drawing(of) == ""
