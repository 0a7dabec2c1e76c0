"""``contactlab explore`` and ``animate``: what the files hold, without a browser."""

from __future__ import annotations

import json
import re
from importlib import resources

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image
from scipy.integrate import trapezoid

import contactlab
from contactlab.figures import animation
from contactlab.figures.animation_panels import in_contact
from contactlab.figures.stick_slip import STATES
from contactlab_pages.explore import explore_page
from tests.longer import longer


def first_values(page):
    return json.loads(re.search(r"FIRST = (.*), RANGES", page.read_text("utf-8"))[1])


def test_the_page_knows_the_materials_of_the_collection(run, tmp_path):
    page = tmp_path / "explore.html"
    ran = run("explore", "--out", page)
    assert (ran.status, ran.out) == (0, f"{page}\n")
    table = json.loads(re.search(r"MATERIALS = (.*), FIRST", page.read_text("utf-8"))[1])
    for name in ("steel", "rubber"):
        material = contactlab.Material.named(name)
        assert table[name]["young_modulus"] == pytest.approx(material.young_modulus)
        assert table[name]["poisson_ratio"] == material.poisson_ratio


def test_the_sliders_stand_where_they_are_asked_to(run, tmp_path):
    page = tmp_path / "explore.html"
    words = ("--angle", 50, "--spin", -80, "--material", "Rubber", "--predict",
             "--block", "Granite", "--radius", 0.025, "--restitution", 0.8)  # fmt: skip
    assert run("explore", *words, "--out", page).status == 0
    first = first_values(page)
    assert (first["angle"], first["spin"], first["material"]) == (50.0, -80.0, "rubber")
    assert first["predict"] is True
    assert (first["block"], first["radius"], first["restitution"]) == ("granite", 0.025, 0.8)
    refused = run("explore", "--speed", 30, "--out", page)
    assert refused.status == 2
    assert "speed = 30" in refused.err
    assert "[0.1, 10]" in refused.err
    for name in ("--material", "--block"):
        assert run("explore", name, "cheese", "--out", page).status == 2


def test_the_page_fetches_nothing(run, tmp_path):
    page = tmp_path / "explore.html"
    run("explore", "--out", page)
    text = page.read_text("utf-8")
    assert not re.search(r"https?://|src=|@import|<link", text)
    assert "/*" not in re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def test_the_parts_of_the_page_have_names_of_their_own():
    script = explore_page().partition("<script>")[2]
    names = re.findall(r"^(?:function|class) (\w+)", script, re.MULTILINE)
    for words in re.findall(r"^(?:const|let) (.*?);", script, re.MULTILINE | re.DOTALL):
        names += re.findall(r"(?:^|, )(\w+)(?= =|,|$)", words.partition("=>")[0])
    assert len(names) > 40
    assert sorted(names) == sorted(set(names))
    assert "export " not in script


def test_the_kernel_of_the_page_is_the_one_for_games():
    kernel = resources.files("contactlab").joinpath("kernels", "contactlab_bounce.mjs")
    assert kernel.read_text("utf-8").strip().replace("\nexport ", "\n") in explore_page()


@pytest.fixture
def few_frames(monkeypatch):
    monkeypatch.setattr(animation, "ARRIVING", 2)
    monkeypatch.setattr(animation, "IN_CONTACT", 4)
    monkeypatch.setattr(animation, "LEAVING", 2)
    monkeypatch.setattr(animation, "SAMPLES", (0.0, 1.0))


@pytest.mark.slow
def test_the_animation_shows_the_sphere_where_it_is(run, ball, tmp_path, few_frames):
    out = tmp_path / "impact.gif"
    assert run("animate", ball, "--out", out).status == 0
    with Image.open(out) as picture:
        assert picture.n_frames == 8
        frames = []
        for number in range(picture.n_frames):
            picture.seek(number)
            frames.append(np.asarray(picture.convert("RGB")).astype(int))
    blue = [np.argwhere((np.abs(frame - (207, 227, 241)) < 12).all(axis=2)) for frame in frames]
    heights = [spot[:, 0].mean() for spot in blue]
    assert heights[0] < heights[1]  # down
    assert heights[1] == pytest.approx(heights[4], abs=1.0)  # in contact
    assert heights[-1] < heights[-2] - 20  # up again
    assert blue[0][:, 1].mean() < blue[-1][:, 1].mean()  # from the left to the right


@pytest.fixture
def superball():
    rubber, stone = (contactlab.Material.named(name) for name in ("rubber", "granite"))
    bodies = contactlab.Sphere(0.025, rubber), contactlab.HalfSpace(stone)
    scene = contactlab.Scene(*bodies, 0.9, 2.6, tangential_velocity=1.5, spin=100.0)
    return contactlab.Simulation().run(scene, history="fields").check()


def test_a_soft_ball_moves_and_turns_while_it_touches(superball):
    place, turned = in_contact(superball)
    radius, time = 0.025, superball.history.time
    assert place[:, 1].min() == pytest.approx(-superball.motion.maximum_approach / radius, rel=1e-3)
    # the contact point moves by the integral of the slip velocity, counted from velocity and spin
    slipped = trapezoid(superball.history.slip_velocity, time)
    assert (place[-1, 0] + turned[-1]) * radius == pytest.approx(slipped, rel=1e-12)
    # the spin is reversed within the contact
    slope = np.diff(turned) / np.diff(time)
    assert slope[0] == pytest.approx(100.0, rel=0.01)
    assert slope[-1] == pytest.approx(superball.rebound_spin, rel=0.01)
    assert superball.rebound_spin < 0.0


def test_the_ball_flies_along_its_dotted_paths(superball):
    axes = Figure().subplots()
    ball = animation.Ball(axes, superball)
    arriving, leaving = (line.get_xydata() for line in axes.lines if line.get_linestyle() == ":")
    for flight, path, instant in ((-1.0, arriving, 0), (1.0, leaving, -1)):
        ball.show(animation.Frame("", flight * animation.FLIGHT, instant))
        assert ball.circle.center == pytest.approx(tuple(path[1]))


def test_what_sticks_and_what_slips_either_way_has_its_colour(superball):
    disc, fields = animation.Disc(Figure().subplots(), superball), superball.history.fields
    signs = np.where(
        fields["stuck"], 0, np.where(fields["slipping"] == 0, np.nan, fields["slipping"])
    )
    ever = set()
    for row in range(0, len(signs), 10):
        disc.show(animation.Frame("", 0.0, row))
        dots = disc.image.get_array().reshape(-1, 3)
        shown = {
            sign
            for sign, colour in zip((-1, 0, 1), STATES.values(), strict=True)
            if (dots == np.round(255.0 * np.array(to_rgb(colour)))).all(axis=1).any()
        }
        assert shown <= set(signs[row])
        ever |= shown
    assert ever == {-1, 0, 1}


@pytest.mark.slow
def test_without_bodies_forces_and_contact_are_drawn(run, tmp_path, few_frames, monkeypatch):
    monkeypatch.setattr(animation, "DOTS", 30)
    out = tmp_path / "contact.gif"
    assert run("animate", "--psi1", 1.2, "--chi", 1.4, "--out", out).status == 0
    with Image.open(out) as picture:
        assert picture.n_frames == 4  # those in contact


def test_a_sweep_cannot_be_animated(run, short_sweep, tmp_path):
    ran = run("animate", short_sweep, "--out", tmp_path / "a.gif")
    assert ran.status == 2
    assert "single impact" in ran.err


def test_a_result_without_history_cannot_be_animated(tmp_path):
    result = contactlab.Simulation().run(contactlab.Scene.nondimensional(psi1=1.0, chi=1.0))
    with pytest.raises(ValueError, match="history='fields'"):
        animation.animate(tmp_path / "a.gif", result)


@pytest.mark.parametrize(
    ("end", "begins"),
    [("svg", b"<?xml"), *longer(("png", b"\x89PNG"), ("pdf", b"%PDF"))],
)
def test_pictures_of_any_form_are_the_same_twice(run, ball, tmp_path, end, begins):
    one, other = (tmp_path / f"{name}.{end}" for name in ("one", "other"))
    for path in (one, other):
        assert run("run", ball, "--no-estimate-error", "--figure", path).status == 0
    assert one.read_bytes().startswith(begins)
    assert one.read_bytes() == other.read_bytes()


@pytest.mark.slow
def test_a_sweep_is_drawn_for_slides(run, tmp_path):
    one, other = tmp_path / "page.png", tmp_path / "slide.png"
    sweep = ("sweep", "--psi1", "0:5:5", "--chi", 1, "--tangential", "coulomb")
    assert run(*sweep, "--figure", one).status == 0
    assert run(*sweep, "--figure", other, "--style", "slides").status == 0
    assert one.read_bytes() != other.read_bytes()


def test_where_the_contact_sticks_is_drawn(run, short_sweep, tmp_path):
    out = tmp_path / "map.png"
    one = ("run", "--psi1", 1.2, "--chi", 1.4, "--no-estimate-error")
    assert run(*one, "--stick-slip", out).status == 0
    with Image.open(out) as picture:
        colours = {tuple(colour) for _, colour in picture.convert("RGB").getcolors(1 << 16)}
    assert {(0, 114, 178), (196, 196, 196), (213, 94, 0)} <= colours
    refused = run("run", short_sweep, "--stick-slip", out)
    assert refused.status == 2
    assert "--stick-slip: needs a single impact" in refused.err


def test_a_picture_of_unknown_form_is_refused(run, ball, tmp_path):
    ran = run("run", ball, "--figure", tmp_path / "a.bmp")
    assert ran.status == 2
    assert ".svg" in ran.err


def test_a_ghost_parts_along_its_own_rebound(superball):
    rigid = contactlab.Simulation(tangential="coulomb").run(superball.scene)
    ball = animation.Ball(Figure().subplots(), superball)
    ball.add_ghosts({"rigid": rigid})
    ((outline, word, _, _),) = ball.ghosts
    ball.show(animation.Frame("", 0.0, 0))
    assert not outline.get_visible()
    places = []
    for flight in (0.5, 1.5):
        ball.show(animation.Frame("", flight, -1))
        places.append(outline.center)
    assert outline.get_visible()
    assert word.get_text() == "ghost: rigid"
    (x1, y1), (x2, y2) = places
    assert np.arctan2(x2 - x1, y2 - y1) == pytest.approx(rigid.rebound_angle, rel=1e-12)
