"""Parts of pages as HTML, written out."""

from types import SimpleNamespace

import pytest

from contactlab.pages import explore, html


def test_text_stands_left_and_numbers_right():
    found = html.table(["a < b", 3], [["x & y", 1.23456789], ["", None], ["z", 12]], digits=3)
    assert found == (
        "<table><thead><tr><th>a &lt; b</th><th>3</th></tr></thead><tbody>"
        '<tr><td>x &amp; y</td><td class="number">1.23</td></tr>'
        '<tr><td></td><td class="number">-</td></tr>'
        '<tr><td>z</td><td class="number">12</td></tr></tbody></table>'
    )
    assert '<td class="number">1.23457</td>' in html.table(["a"], [[1.23456789]])


def test_words_are_escaped_and_pictures_are_not():
    assert html.pairs([("a&", "b<"), ("c", "d")]) == (
        "<dl><dt>a&amp;</dt><dd>b&lt;</dd><dt>c</dt><dd>d</dd></dl>"
    )
    assert html.paragraph("1 < 2") == "<p>1 &lt; 2</p>"
    assert html.titled("A & B", "<p>x</p>", "y") == (
        "<section><h2>A &amp; B</h2><p>x</p>y</section>"
    )
    assert html.figure("<svg/>", "a < b") == (
        "<figure><svg/><figcaption>a &lt; b</figcaption></figure>"
    )


def test_a_plan_is_up_to_three_lists():
    plan = SimpleNamespace(computed=("one", "t<o"), left_out=(), cautions=("take care",))
    assert html.plan(plan) == (
        "<h3>computed</h3><ul><li>one</li><li>t&lt;o</li></ul>"
        "<h3>cautions</h3><ul><li>take care</li></ul>"
    )
    none = SimpleNamespace(computed=(), left_out=("two",), cautions=())
    assert html.plan(none) == "<h3>left out</h3><ul><li>two</li></ul>"


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [("angle", 0, 85), ("speed", 0.1, 10), ("spin", -600, 600), ("friction", 0.02, 1)],
)
def test_sliders_begin_within_their_ranges(name, least, most):
    for value in (least, most):
        assert f'"{name}": {value}' in explore.explore_page(**{name: value})
    for value in (least - 0.01, most + 0.01):
        with pytest.raises(ValueError, match=rf"{name} = .* must lie in \[{least}, {most}\]"):
            explore.explore_page(**{name: value})


def test_a_page_begins_with_a_ball_of_pmma():
    text = explore.explore_page()
    assert (
        '{"angle": 35.0, "speed": 2.0, "spin": 100.0, "friction": 0.8, "radius": 0.01, '
        '"inertia": 0.4, "restitution": 1.0, "material": "pmma", "block": "", "predict": false, '
        '"guess": 0}'
    ) in text
    assert "100 springs" in text
    assert "500 steps" in text
    assert '"predict": true' in explore.explore_page(predict=True)
