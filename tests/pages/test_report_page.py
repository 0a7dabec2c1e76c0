"""``contactlab report`` and ``contactlab cite``."""

from __future__ import annotations

import html.parser
import re

import numpy as np
import pytest

from contactlab import create
from contactlab.registry.citations import DOI, YEAR, bibtex, references
from contactlab.registry.registry import REGISTRY
from tests.cli.conftest import EXAMPLES
from tests.longer import longer
from tests.present import extra


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


@pytest.fixture
def reported(run, tmp_path):
    def call(*arguments):
        page = tmp_path / "report.html"
        ran = run("report", *arguments, "--out", page)
        assert (ran.status, ran.out) == (0, f"{page}\n")
        text = page.read_text("utf-8")
        assert not re.search(r"src=|@import|<link|url\((?!#)|\bNone\b", text)
        return text

    return call


@pytest.fixture
def damped(tmp_path):
    path = tmp_path / "damped.toml"
    path.write_text(
        "[nondimensional]\npsi1 = 1.0\nchi = 1.0\n[simulation]\nnormal = 'tsuji'\n"
        "tangential = 'springs'\n[simulation.options]\nnormal.restitution = 0.9\n",
        encoding="utf-8",
    )
    return path


def test_one_impact_in_one_file(reported, ball):
    text = reported(ball)
    for heading in ("scene", "answer", "laws compared", "plan", "Sources", "How this was made"):
        assert re.search(f"<h2>[^<]*{heading}</h2>", text)
    assert text.count("<svg") == 2  # the drawing and the forces
    assert re.search("<h3>left out</h3><ul><li>[^<]+</li>", text)
    assert not re.search("<ul></ul>", text)
    assert "2 m/s" in text
    assert "Wear 38" in text
    assert "estimated" in text


def scene_rows(text):
    """Return the rows of the table of the scene by name, each with value and unit."""
    (table,) = re.findall("<h2>The scene</h2>.*?(<table.*?</table>)", text, flags=re.DOTALL)
    rows = [re.findall("<td[^>]*>([^<]*)</td>", row) for row in re.findall("<tr>.*?</tr>", table)]
    return {name: (value, unit) for name, value, unit in filter(None, rows)}


def test_a_scene_has_its_bodies_and_units(reported, ball):
    rows = scene_rows(reported(ball))
    assert rows["sphere: radius"] == ("0.00635", "m")
    assert rows["normal speed"][1] == rows["tangential velocity"][1] == "m/s"
    assert rows["spin"][1] == "rad/s"
    assert rows["friction coefficient"] == ("0.15", "1")


def test_a_scene_without_bodies_has_no_units_and_a_sweep_its_range(reported, measured):
    rows = scene_rows(reported(measured))
    assert rows["psi1"] == ("1 to 6", "1")
    assert rows["chi"] == ("1", "1")
    assert {unit for _, unit in rows.values()} == {"1"}


@pytest.mark.slow
def test_arrows_of_the_drawing_point_along_the_motion_of_the_sphere(reported, ball):
    """It comes down on the surface, to the right, and leaves upwards; 1.9 radii of 60 at most."""
    pattern = (
        r"<line x1='(\S+)' y1='(\S+)' x2='(\S+)' y2='(\S+)' [^>]*'2.5'/>"
        r"<polygon points='(\S+),(\S+) (\S+),(\S+) (\S+),(\S+)'"
    )
    lines = re.findall(pattern, reported(ball))
    arriving, leaving = np.array(lines, dtype=float).reshape(2, 5, 2)
    for (begin, stem, tip, *barbs), downwards in ((arriving, 1.0), (leaving, -1.0)):
        way = tip - begin
        assert way[0] > 0.0
        assert way[1] * downwards > 0.0
        assert np.hypot(*way) < 1.9 * 60.0 + 0.1
        for end in (stem, *barbs):  # the tip is the foremost
            assert 0.0 < (tip - end) @ way < way @ way
        assert np.mean(barbs, axis=0) == pytest.approx(stem, abs=0.1)
        assert (stem - begin) / np.hypot(*(stem - begin)) == pytest.approx(
            way / np.hypot(*way), abs=2e-3
        )
    words = re.findall(r"<polygon[^>]*/><text x='(\S+)'[^>]*text-anchor='(\w+)'", reported(ball))
    assert [anchor for _, anchor in words] == ["end", "start"]
    assert float(words[0][0]) < arriving[0][0]
    assert float(words[1][0]) > leaving[2][0]
    before = np.arctan2(*(arriving[2] - arriving[0]))
    assert np.degrees(before) == pytest.approx(15.0, abs=0.2)  # as the file says


@pytest.mark.parametrize(("spin", "turn"), [(-20.0, " ↻"), *longer((20.0, " ↺"), (0.0, ""))])
def test_the_drawing_tells_the_sense_of_a_spin(reported, ball, tmp_path, spin, turn):
    turning = tmp_path / "turning.toml"
    text = ball.read_text("utf-8").replace("spin = 20.0", f"spin = {spin}")
    turning.write_text(text, encoding="utf-8")
    (told,) = re.findall(r"text-anchor='end'>([^<]*rad/s[^<]*)<", reported(turning))
    assert told == f"{spin:g} rad/s{turn}"


def test_the_surface_of_the_drawing_is_as_wide_as_the_drawing(reported, ball):
    (drawing,) = re.findall(r"<svg viewBox='(\S+) \S+ (\S+) \S+' role='img'", reported(ball))
    (surface,) = re.findall(r"<rect x='(\S+)' y='0' width='(\S+)'", reported(ball))
    assert surface == drawing
    assert float(drawing[0]) == -0.5 * float(drawing[1])


def test_a_measured_sweep_has_its_residuals(reported, measured):
    text = reported(measured, "--tangential", "coulomb,frictionless")
    assert "rms difference" in text
    assert '<td class="number">0.1</td>' in text  # measured 0.1 beside the rigid law
    assert "made up" in text
    assert "legend_1" in text  # the laws over the sweep, above their differences


def test_rows_of_a_long_sweep_are_spread_over_all_of_it(reported, tmp_path):
    path = tmp_path / "long.toml"
    path.write_text(
        "[nondimensional]\nchi = 1.0\n[sweep]\npsi1 = { start = 0.0, stop = 96.0, count = 97 }\n"
        "[simulation]\ntangential = 'coulomb'\n",
        encoding="utf-8",
    )
    text = reported(path, "--tangential", "frictionless")
    assert "25 of 97 impacts are shown" in text
    few = path.read_text(encoding="utf-8").replace("97", "25").replace("coulomb", "frictionless")
    path.write_text(few, encoding="utf-8")
    other = reported(path, "--tangential", "coulomb")
    assert "impacts are shown" not in other
    assert re.search(r'<td>coulomb</td><td class="number">4</td>', other)  # 4 chi less at most
    assert "A sweep of 97 impacts over psi1." in text
    assert all(f'<td class="number">{psi1}</td>' in text for psi1 in (0, 48, 96))


def test_a_default_law_that_does_not_fit_the_normal_law_is_left_out(reported, damped):
    text = reported(damped)
    assert "coulomb" in text
    assert "fronts" not in text


needs_fits = extra("contactlab_fit")  # which reads tables of impacts

DROPS = (
    "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nkind = 'half-space'\n"
    "material = 'steel'\n[impact]\nspeed = 2.0\nfriction_coefficient = 0.1\n"
    "[simulation]\ntangential = 'coulomb'\n"
)
SWEPT = "[sweep]\nangle_deg = [50.0, 60.0, 70.0]\n"
HEAD = "angle_deg,speed (m/s),tangential_restitution\n"


@pytest.mark.slow
def test_a_report_of_slip_that_turns_leaves_out_laws_without_an_answer(reported, tmp_path):
    scene = tmp_path / "aside.toml"
    text = (EXAMPLES / "foot.toml").read_text("utf-8")
    assert "velocity = [0.5, 0, -1.0]" in text
    scene.write_text(text.replace("[0.5, 0, -1.0]", "[0.5, 0.2, -1.0]"), encoding="utf-8")
    page = reported(scene)
    assert "springs" in page
    assert "fronts (" not in page


@needs_fits
def test_impacts_of_a_table_stand_beside_the_laws(reported, tmp_path):
    """Gross slip at 45 degrees has e_t = 1 - 2 mu = 0.8: 0.75 is 0.05 off, and 1.0 is 0.2."""
    (tmp_path / "drops.toml").write_text(DROPS + SWEPT, encoding="utf-8")
    table = tmp_path / "drops.csv"
    table.write_text(f"{HEAD}45,2.0,0.75\n45,2.05,1.0\n60,1.95,\n70,2,0.9\n", encoding="utf-8")
    text = reported(tmp_path / "drops.toml", "--measured", table)
    assert f"tangential_restitution, measured: {table}" in text
    assert re.search(r"<td>coulomb</td>\s*<td class=\"number\">[\d.]+</td>\s*<td[^>]*>0.2<", text)


@needs_fits
@pytest.mark.parametrize(
    ("scene", "rows", "words"),
    [
        (DROPS + SWEPT, "45,2,0.8\n60,3,0.9\n", "angle_deg, speed vary"),
        (DROPS + SWEPT, "45,3,0.8\n60,3,0.9\n", "speed is 3 m/s, and 2 m/s in"),
    ],
)
def test_impacts_that_are_not_those_of_the_scene_are_refused(run, tmp_path, scene, rows, words):
    (tmp_path / "drops.toml").write_text(scene, encoding="utf-8")
    (tmp_path / "drops.csv").write_text(HEAD + rows, encoding="utf-8")
    files = tmp_path / "drops.toml", "--measured", tmp_path / "drops.csv"
    ran = run("report", *files, "--out", tmp_path / "report.html")
    assert (ran.status, len(ran.err.splitlines())) == (2, 1)
    assert words in ran.err


@needs_fits
@pytest.mark.slow
@pytest.mark.parametrize("rows", ["45,2,0.8\n", "45,2,0.8\n45,2,0.9\n"])
def test_one_impact_and_equal_impacts_are_reported(reported, tmp_path, rows):
    (tmp_path / "drops.toml").write_text(DROPS.replace("2.0", "2.0\nangle_deg = 10.0"), "utf-8")
    (tmp_path / "drops.csv").write_text(HEAD + rows, encoding="utf-8")
    text = reported(tmp_path / "drops.toml", "--measured", tmp_path / "drops.csv")
    assert "At the measured values of angle_deg, by the first law; the curves below join" in text
    assert len(re.findall(r'<td class="number">45</td>', text)) == rows.count("45")


def test_text_of_a_file_is_escaped(reported, tmp_path):
    path = tmp_path / "odd.toml"
    path.write_text(
        "[about]\ntitle = 'a < b & $c'\n[nondimensional]\npsi1 = 1.0\nchi = 1.0\n", encoding="utf-8"
    )
    text = reported(path, "--tangential", "coulomb")
    assert "<h1>a &lt; b &amp; $c</h1>" in text


def test_every_tag_is_closed(reported, short_sweep):
    text = reported(short_sweep, "--tangential", "coulomb")
    reader = Balanced()
    reader.feed(re.sub(r"<svg.*?</svg>|<meta[^>]*>|<!doctype html>", "", text, flags=re.DOTALL))
    assert reader.open == []


def test_cite_prints_data_and_laws(run):
    ran = run("cite", EXAMPLES / "kharaz2001.toml", "--tangential", "springs")
    assert ran.status == 0
    assert re.findall(r"^@\w+\{(\w+),", ran.out, re.MULTILINE) == [
        "kharaz2001",
        "maw1976",
        "jaeger1995",
        "popov2015",
        "contactlab",
    ]


def test_cite_takes_all_laws_that_were_compared(run):
    ran = run("cite", "--tangential", "fronts,coulomb,mindlin_cap")
    assert ran.status == 0
    keys = re.findall(r"^@\w+\{(\w+),", ran.out, re.MULTILINE)
    assert keys == [
        "maw1976", "ciavarella1998", "jaeger1998", "keller1986", "wang1992",
        "mindlin1949", "thornton2011", "direnzo2005", "contactlab",
    ]  # fmt: skip
    assert "did you mean" in run("cite", "--tangential", "coulomb,columb").err


@pytest.mark.parametrize("name", REGISTRY.names())
def test_every_work_that_a_law_names_has_an_entry(name):
    """Neither lost beside another of the same source, nor left in words."""
    texts = references(REGISTRY.law_class(name))
    entries = bibtex(texts)
    for mark in [mark for text in texts for mark in DOI.findall(text) + YEAR.findall(text)]:
        assert mark in entries
    assert "@misc" not in entries


def test_a_work_beside_a_known_one_is_kept_in_words():
    known = "Maw, Barber & Fawcett, Wear 38 (1976) 101-114"
    assert "@misc" not in bibtex([known])
    both = bibtex([f"{known}; Somebody, J. Odd Res. 1 (1900)"])
    assert "maw1976" in both
    assert "Odd Res" in both
    assert "@misc{source1," in both
    other = bibtex(["Thornton, J. Odd Res. 1 (1991), doi:10.9999/odd, ch. 1"])
    assert "thornton1991" not in other


def test_a_source_that_is_not_known_is_kept_in_words():
    assert "note = {Somebody, J. Odd Res. 1 (1900)}" in bibtex(["Somebody, J. Odd Res. 1 (1900)"])


def test_a_law_without_references_has_none():
    assert references(create("tangential.frictionless")) == []
    assert len(references(create("normal.hertz"))) == 1


def test_a_law_that_is_asked_for_and_does_not_fit_is_refused(run, damped, tmp_path):
    ran = run("report", damped, "--tangential", "fronts", "--out", tmp_path / "report.html")
    assert (ran.status, ran.out) == (2, "")
    assert "fronts: needs elastic Hertz contact" in ran.err
    assert not (tmp_path / "report.html").exists()


MEASURED = """angle_deg,rebound_spin (rad/s),tangential_restitution
6,135,0.65
10,239,0.60
20,536,0.60
50,461,0.845
"""
ALUMINA = """[sphere]
radius = 2.5e-3
material = "alumina"
[target]
kind = "half-space"
material = "soda-lime glass"
[impact]
speed = 3.9
angle_deg = 10.0
friction_coefficient = 0.09
"""


@pytest.mark.slow
def test_the_table_has_the_measured_angles_and_a_wrong_sign_is_told_once(run, reported, tmp_path):
    data, scene = tmp_path / "drops.csv", tmp_path / "drops.toml"
    data.write_text(MEASURED, encoding="utf-8")
    scene.write_text(ALUMINA, encoding="utf-8")
    text = reported(scene, "--measured", data)
    answer = " ".join(re.sub(r"<[^>]+>", " ", text.partition("The answer")[2]).split())
    rows = answer.partition("The laws compared")[0]
    for line in MEASURED.splitlines()[1:]:
        angle, spin, e_t = line.split(",")
        found = re.search(rf" {angle} [^A-Z]*SUCCESS {spin} {float(e_t):g} ", rows)
        assert found, line
    assert text.count("looks as if of the opposite sign") == 1
    assert "rebound_angle_deg over angle_deg." in text
    told = "note: rebound_spin looks as if of the opposite sign"
    assert run("compare", scene, "--measured", data).out.count(told) == 1
    turned = ("--column", "rebound_spin (rad/s)=-rebound_spin")
    assert "opposite sign" not in run("compare", scene, "--measured", data, *turned).out


def test_the_sources_of_named_materials_are_cited(run, tmp_path):
    scene = tmp_path / "drops.toml"
    scene.write_text(ALUMINA, encoding="utf-8")
    ran = run("cite", scene)
    for key in ("direnzo2004", "dowling2013", "maw1976", "contactlab"):
        assert ran.out.count(f"{{{key},") == 1
    assert "year = {2026}" in ran.out.partition("{contactlab,")[2]
