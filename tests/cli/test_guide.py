"""``contactlab guide``: topics, one topic, one section."""

from __future__ import annotations

import math
import re
import unicodedata

import pytest

import contactlab
from contactlab.cli.guide import pages as guide_pages
from contactlab.cli.guide import text
from contactlab.cli.guide import topics as guide_topics


def test_the_list_has_a_line_a_topic(run):
    ran = run("guide")
    assert ran.status == 0
    listed = [line for line in ran.out.splitlines() if line.startswith("  ")]
    assert [line.split()[0] for line in listed] == list(guide_topics())
    assert all(len(line) < 107 and line.endswith(".") for line in listed)


@pytest.mark.parametrize("topic", guide_pages())
def test_a_topic_is_printed(run, topic):
    ran = run("guide", topic)
    assert ran.status == 0
    assert ran.err == ""
    assert ran.out.startswith("# ")
    assert run("guide", f"{topic}.md").out == ran.out
    page = text(topic)
    for code in re.findall("^```.*?^```$", page, flags=re.DOTALL | re.MULTILINE):
        assert code in ran.out


def test_a_section_is_printed_alone(run):
    ran = run("guide", "theory", "5")
    assert ran.status == 0
    assert ran.out.startswith("## 5. ")
    assert "## 6. " not in ran.out
    assert run("guide", "theory", "§5").out == ran.out


@pytest.mark.parametrize("columns", [60, 80, 1000])
def test_formulas_are_printed_in_letters_and_prose_fits_the_terminal(run, columns, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(columns))
    for topic in guide_pages():
        prose = re.sub(r"```.*?```|`[^`]*`", "", run("guide", topic).out, flags=re.DOTALL)
        assert re.findall(r"\\\\|\$|\\[a-z]+|[_^]\{|&=", prose) == [], topic
        lines = prose.splitlines()
        filled = [line for line in lines if not line.startswith(("|", "!", "#", "    "))]
        assert max(map(len, filled)) <= min(columns, 100), topic


def value(printed, **known):
    """Compute a formula as it is printed, products and powers written for Python."""
    text = printed.translate(str.maketrans("₀₁₂", "012")).replace("²", "**2").replace("³", "**3")
    text = re.sub(r"(?<=[\w)\]]) (?=[\w(\[])", "*", text.replace("^", "**"))
    return eval(text.replace("[", "(").replace("]", ")"), {"sqrt": math.sqrt, **known})


def test_printed_formulas_have_the_values_that_the_code_has(run):
    """What stands in the letters of a terminal is computed, and compared with the package."""
    scaling, regimes = (run("guide", "theory", number).out for number in ("1", "2"))
    found = re.search(r"T_c = (.*) = ([\d.]+)", scaling)
    assert value(found[1], Γ=math.gamma, π=math.pi) == pytest.approx(float(found[2]), abs=1e-10)
    found = re.search(r"κ = 2(\(.*?\)/\(.*?\)) ", scaling)
    steel = contactlab.Material.named("steel")
    bodies = contactlab.Sphere(0.01, steel), contactlab.HalfSpace(steel)
    pair = contactlab.Scene.at_angle(*bodies, 0.2, speed=1.0, angle_deg=5.0).pair
    assert 2 * value(found[1], ν=steel.poisson_ratio) == pytest.approx(pair.stiffness_ratio)
    found = re.search(r"ψ₂ = (ψ₁ - 4 χ) sign", regimes)
    assert value(found[1], χ=1.2, ψ1=6.0) == pytest.approx(float(contactlab.rebound(6.0, 1.2)))


def test_columns_of_printed_formulas_stand_in_line(run):
    """A hat stands on the letter before it."""
    out = run("guide", "theory", "5").out
    lines = "".join(one for one in out if not unicodedata.combining(one)).splitlines()
    rows = [row for line in lines if (row := re.match(r" {4}(\w) = \S.*? {4,}(\S)", line))]
    assert [row[1] for row in rows] == ["k", "J", "m"]
    assert len({row.start(2) for row in rows}) == 1


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("slip", "slip (`slipping`): the surfaces move over each other"),
        ("Slip velocity", "slip velocity (v_x, m/s,"),
        ("microslip", "partial slip, microslip (`partial_slip`):"),
        ("chi", "inertia ratio (χ, 1,"),
        ("kappa", "stiffness ratio ("),
        ("e_t", "tangential rest"),
        ("traction", "traction (q, Pa,"),
        ("psi_1", "angle of incidence, dimensionless ("),
        ("tangential_stiffness", "tangential stiffness (k, N/m,"),
    ],
)
def test_an_entry_of_the_glossary_is_printed_alone(run, word, told):
    """By its term, or by its name in code."""
    ran = run("guide", "glossary", word)
    assert ran.status == 0
    assert ran.out.startswith(told)
    assert len(ran.out.splitlines()) < 4


def test_the_last_numbered_section_ends_with_its_page(run):
    assert "References" not in run("guide", "theory", "17").out


def test_an_unknown_topic_is_refused_with_the_nearest(run):
    ran = run("guide", "teory")
    assert (ran.status, ran.out) == (2, "")
    assert "did you mean 'theory'?" in ran.err
    assert len(ran.err.splitlines()) == 1


@pytest.mark.parametrize(
    ("word", "pages"),
    [
        ("restitution", ("choosing",)), ("plugin", ("extending-kit",)),
        ("trust", ("how-far-to-trust",)), ("Hysteresis", ("load-paths",)), ("zzzzzz", ()),
        ("psi1", ("theory-impact",)), ("v_x", ("theory-impact", "units-and-signs")),
    ],
)  # fmt: skip
def test_a_word_is_refused_with_the_pages_that_have_it(run, word, pages):
    ran = run("guide", word)
    assert ran.status == 2
    assert "did you mean" not in ran.err
    told = ran.err.partition("known:")[0]
    assert all(f"'{page}'" in told for page in pages)
    for page in re.findall(r"'([a-z-]+)'", told.partition(" in ")[2]):
        printed = run("guide", page).out.lower()
        assert word.lower() in printed or word.replace("psi1", "ψ₁") in printed


@pytest.mark.parametrize(
    "words", [("theory", "99"), ("theory", "five"), ("choosing", "1"), ("glossary", "slipper")]
)
def test_an_unknown_section_is_refused(run, words):
    ran = run("guide", *words)
    assert (ran.status, ran.out) == (2, "")
    assert f"section = {words[1]!r}" in ran.err
