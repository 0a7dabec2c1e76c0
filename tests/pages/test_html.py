"""Parts of pages as HTML, written out."""

from types import SimpleNamespace

import numpy as np
import pytest

from contactlab import Simulation
from contactlab.pages import explore, html, report
from contactlab.scene_file import read_scene
from contactlab.study.comparison import compare
from tests.study.made_up import LAWS, SERIES, SWEEP


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


@pytest.fixture
def page(tmp_path):
    def call(text, history=False):
        path = tmp_path / "scene.toml"
        path.write_text(text, encoding="utf-8")
        file = read_scene(path)
        return file, compare(file, LAWS, history=history)

    return call


def cells(text):
    """The numbers of a table's rows."""
    rows = text.partition("<tbody>")[2].split("</tr>")[:-1]
    return [[cell.partition(">")[2] for cell in row.split("</td>")[:-1]] for row in rows]


def test_laws_over_a_sweep_have_a_picture_and_their_largest_difference(page):
    _, compared = page(SWEEP)
    picture, table = report._comparison(compared)
    assert picture.startswith("<figure><svg")
    assert picture.endswith("<figcaption>psi2 over the sweep.</figcaption></figure>")
    assert "<th>largest difference of psi2 from rigid</th><th>run time an impact</th>" in table
    assert [row[1].removeprefix('<td class="number">') for row in cells(table)] == ["0", "4"]
    cut = compared.__class__(
        scene=compared.scene, varied=compared.varied, runs=compared.runs, agreements=(),
        interrupted=True,
    )  # fmt: skip
    assert report._comparison(cut)[-1] == "<p>Interrupted before all laws were compared.</p>"


def test_measured_values_have_a_picture_and_the_distances(page):
    """The rigid law is off by -0.1 and 0.5, without friction psi2 is by 0.9 and 4.5."""
    _, compared = page(SWEEP + SERIES)
    first, table = report._comparison(compared)
    assert "<figcaption>psi2, measured: made up</figcaption>" in first
    assert "<th>law</th><th>rms difference (1)</th><th>largest</th>" in first
    rows = [[cell.removeprefix('<td class="number">') for cell in row] for row in cells(first)]
    assert rows[0][1:] == ["0.361", "0.5"]
    assert rows[1][1:] == ["3.24", "4.5"]
    assert "psi2 over the sweep" not in first + table


def test_a_single_impact_shows_forces_if_a_law_has_a_history(page):
    text = "[nondimensional]\npsi1 = 1.0\nchi = 1.0\n"
    _, compared = page(text)
    (table,) = report._comparison(compared)
    assert table.startswith("<table>")
    path = read_scene(page(text)[0].path)
    followed = compare(path, {"springs": Simulation(tangential="springs")}, history=True)
    picture, _ = report._comparison(followed)
    words = "<figcaption>Tangential force over the contact, inside friction&#x27;s limit."
    assert words in picture


def test_a_report_tells_how_it_was_made(page):
    import contactlab

    file, compared = page(SWEEP)
    result = compared.runs[0].result
    told = dict(report._provenance(file, result))
    assert list(told) == ["scene file", "laws", "contactlab", "with"]
    assert told["scene file"] == "scene.toml"
    assert told["contactlab"] == contactlab.__version__
    assert told["laws"] == ", ".join(result.laws.values())
    assert told["with"].startswith("Python 3.")
    assert f"numpy {np.__version__}" in told["with"]
    assert report._scene(file, file.scene)[1] == "<p>A sweep of 3 impacts over psi1.</p>"
    single, _ = page("[nondimensional]\npsi1 = 1.0\nchi = 1.0\n")
    assert len(report._scene(single, single.scene)) == 1


def test_each_source_is_named_once(page):
    file, _ = page('[about]\ncitation = """Somebody,\n  somewhere (1900)"""\n' + SWEEP)
    laws = {"a": Simulation(tangential="springs"), "b": Simulation(tangential="springs")}
    found = report._sources(file, laws)
    assert len(found) == len(set(found)) > 1
    assert found[0] == "Somebody, somewhere (1900)"
    plain, _ = page(SWEEP)
    assert report._sources(plain, laws) == [text for text in found if "Somebody" not in text]


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
