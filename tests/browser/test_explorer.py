"""The explorer in a browser: what it shows as its sliders move."""

from __future__ import annotations

import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.pages.explore import CHI, PSI1, explore_page

pytestmark = pytest.mark.browser

#: Selenium's words, written out: without the extra these tests are still collected.
ID = "id"


class Keys:
    END, HOME, ARROW_LEFT, ARROW_RIGHT = "\ue010", "\ue011", "\ue012", "\ue014"


@pytest.fixture
def page(opened, tmp_path):
    path = tmp_path / "explore.html"
    path.write_text(explore_page(), encoding="utf-8")
    return opened(path)


def shown(page, name):
    return float(page.find_element(ID, name).text.replace("\u2212", "-"))


def move(page, name, keys):
    page.find_element(ID, name).send_keys(*keys)


def test_the_values_shown_are_those_of_rebound(page):
    assert shown(page, "psi2") == pytest.approx(contactlab.rebound(2.0, 1.44), abs=0.51e-4)
    for name, keys in (
        ("psi1", [Keys.ARROW_RIGHT] * 7),
        ("chi", [Keys.ARROW_LEFT] * 22),
        ("psi1", [Keys.END]),
        ("chi", [Keys.END]),
        ("psi1", [Keys.HOME, *[Keys.ARROW_RIGHT] * 5]),
    ):
        before = shown(page, "psi2")
        move(page, name, keys)
        psi1, chi = shown(page, "psi1-shown"), shown(page, "chi-shown")
        assert shown(page, "psi2") == pytest.approx(contactlab.rebound(psi1, chi), abs=0.51e-4)
        assert shown(page, "psi2") != before
    assert psi1 == pytest.approx(PSI1.start + 5 * PSI1.step)
    assert chi == pytest.approx(CHI.stops[-1])


@pytest.mark.parametrize(
    ("psi1", "chi"), [(0.3, 1.44), (1.2, 1.0), (2.0, 1.44), (3.5, 2.4), (8, 1.0)]
)
def test_force_and_map_belong_to_the_same_impact(page, psi1, chi):
    found = page.execute_script("return impact(arguments[0], arguments[1])", psi1, chi)
    assert found["psi2"] == pytest.approx(contactlab.rebound(psi1, chi), abs=2e-3)
    assert found["time"][-1] == pytest.approx(1.0)
    limits = zip(found["force"], found["limit"], strict=True)
    assert all(abs(force) <= limit + 1e-9 for force, limit in limits)


def test_the_point_and_the_curves_move_with_the_sliders(page):
    def drawn():
        return [
            page.find_element(ID, name).get_attribute("innerHTML") for name in ("rebound", "force")
        ]

    def picture():
        return page.execute_script("return document.getElementById('map').toDataURL()")

    before = [*drawn(), picture()]
    move(page, "psi1", [Keys.ARROW_RIGHT] * 10)
    assert all(new != old for new, old in zip([*drawn(), picture()], before, strict=True))


def test_the_words_tell_the_regime(page):
    move(page, "psi1", [Keys.END])
    assert "slips throughout" in page.find_element(ID, "words").text
    move(page, "psi1", [Keys.HOME])
    assert "central impact" in page.find_element(ID, "words").text


@pytest.mark.parametrize("nu", [0.3, 0.1])
def test_the_spin_is_that_of_a_ball_thrown_without(page, nu):
    """The page knows psi1, psi2 and chi; the simulation the whole ball."""
    material = Material(young_modulus=1e9, poisson_ratio=nu, density=1e3)
    ball = Scene(Sphere(0.01, material), HalfSpace(material), 0.3, 1.0, 1.0)
    result = Simulation().run(ball).check()
    spin = result.rebound_spin * 0.01 / ball.tangential_velocity
    words = page.execute_script(
        "return spin(arguments[0], arguments[1], arguments[2])", ball.psi1, result.psi2, ball.chi
    )
    assert f"{spin:.2f} <i>v</i>; rolling is -0.71 <i>v</i>" in words.replace("\u2212", "-")


def test_of_other_bodies_no_spin_is_said(page):
    assert "without spin" in page.find_element(ID, "spin").text
    move(page, "chi", [Keys.HOME])
    assert page.find_element(ID, "spin").text == ""


@pytest.mark.parametrize(("width", "height"), [(1920, 1080), (1366, 768), (1024, 768)])
def test_all_but_the_small_print_is_seen_at_once(page, width, height):
    size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
    page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        bottom = page.execute_script(
            "return document.querySelector('.panels').getBoundingClientRect().bottom"
        )
        across = page.execute_script("return document.documentElement.scrollWidth")
    finally:
        page.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert bottom <= height
    assert across <= width
