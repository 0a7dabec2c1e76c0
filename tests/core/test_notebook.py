"""What a notebook shows of results, plans, scenes and laws."""

from __future__ import annotations

import html.parser

import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere


class Balanced(html.parser.HTMLParser):
    """Text and tags of a page; a tag that is closed wrongly is an error."""

    def __init__(self):
        super().__init__()
        self.open, self.words = [], []

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


def words_of(thing):
    reader = Balanced()
    reader.feed(thing._repr_html_())
    reader.close()
    assert reader.open == []
    return reader.words


@pytest.fixture
def ball():
    steel = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850)
    return Scene(Sphere(0.01, steel), HalfSpace(steel), 0.2, 1.0, [0.5, 0.7] * 6)


def test_one_impact_shows_answer_error_and_plan():
    words = words_of(Simulation().run(Scene.nondimensional(psi1=2.0, chi=49 / 34)))
    shown = float(words[words.index("psi2") + 1])
    assert shown == pytest.approx(contactlab.rebound(2.0, 49 / 34), abs=1e-8)
    assert any(word.endswith("e-09, declared") for word in words)
    assert any("tangential motion" in word for word in words)


def test_a_batch_shows_its_first_impacts(ball):
    words = words_of(Simulation(tangential="coulomb").sweep(ball))
    assert words.count("SUCCESS") == 10
    assert "10 of 12 impacts are shown." in words
    (told,) = (word for word in words if word.startswith("largest energy imbalance"))
    assert float(told.rpartition(" ")[2]) < 1e-9


def test_a_grid_of_two_axes_shows_a_line():
    scene = Scene.nondimensional(psi1=[[1.0], [2.0]], chi=[1.0, 1.4])
    (words,) = words_of(Simulation(tangential="coulomb").run(scene))
    assert "4 impacts" in words


def test_a_scene_shows_bodies_and_ranges(ball):
    words = words_of(ball)
    assert "sphere: radius" in words
    assert "0.5 to 0.7" in words


def test_a_law_shows_options_and_source():
    words = words_of(contactlab.create("tangential.annulus", annuli=33))
    assert words[words.index("annuli") + 1] == "33"
    assert any("Wear 38" in word for word in words)


def test_text_is_escaped():
    class Odd(type(contactlab.create("tangential.coulomb"))):
        """A law < that & is odd."""

    assert "A law &lt; that &amp; is odd." in Odd()._repr_html_()
