"""What the smaller commands print: guide, materials, laws."""

from __future__ import annotations

import json
import re

import pytest

from contactlab.cli import guide
from contactlab.compose.registry import REGISTRY
from contactlab.impact import material as materials
from tests.cli.conftest import EXAMPLES


def test_a_section_ends_where_the_next_begins():
    text = "# Title\n\nwords\n\n## 1. One\n\nfirst\n\n## 2. Two\nsecond\n### 3. no\n## Not\n"
    assert guide.sections(text) == {
        "1": "## 1. One\n\nfirst\n\n",
        "2": "## 2. Two\nsecond\n### 3. no\n## Not\n",
    }
    assert guide.sections("no sections") == {}


def test_all_topics_are_told(run):
    listed = run("guide", "zzzzzz").err.rpartition("known: ")[2].strip()
    assert listed.split(", ") == list(guide.TOPICS)


def test_a_law_is_shown_with_all_it_says(run):
    lines = run("plugins", "show", "integrator.symplectic").out.splitlines()
    head = {line[:12].strip(): line[12:].strip() for line in lines[: lines.index("")]}
    info = REGISTRY.info("integrator.symplectic")
    assert list(head) == [
        "name", "known_as", "kind", "distribution", "version", "module", "blocked", "malformed",
        "summary", "runs", "needs", "offers",
    ]  # fmt: skip
    assert (head["name"], head["kind"], head["module"]) == (
        "integrator.symplectic", "integrator", info.module
    )  # fmt: skip
    assert (head["blocked"], head["malformed"]) == ("False", "False")
    assert head["runs"] == "SteppedTangentialLaw"
    assert "options" in lines
    law = run("plugins", "show", "tangential.coulomb").out.splitlines()
    (ways,) = (line for line in law if line.startswith("is a"))
    entry = json.loads(run("plugins", "show", "tangential.coulomb", "--json").out)
    assert ways.split("  ")[-1].strip() == ", ".join(entry["is a"])
    assert entry["needs"] == sorted(entry["needs"])
    assert "runs" not in entry
    assert "is a" not in json.loads(run("plugins", "show", "normal.jkr", "--json").out)
    source = run("plugins", "show", "tangential.annulus").out
    assert "\nsource\n  " in source
    assert (
        "\nsource\n" not in run("plugins", "show", "integrator.symplectic").out or head["summary"]
    )


def test_materials_are_listed_in_gigapascals_with_their_sources(run):
    rows = {line[:20].strip(): line.split()[-3:] for line in run("materials").out.splitlines()}
    for entry in materials.entries():
        young, ratio, density = map(float, rows[entry.name])
        assert young == pytest.approx(entry.young_modulus / 1e9, rel=1e-5)
        assert (ratio, density) == pytest.approx((entry.poisson_ratio, entry.density))
        alone = run("materials", entry.name).out
        assert f"elastic constants: {entry.elastic_source}\n" in alone
        assert ("yield stress: " in alone) is (entry.yield_stress is not None)
        content = json.loads(run("materials", entry.name, "--json").out)
        assert [each["name"] for each in content["materials"]] == [entry.name]


def test_sources_of_data_come_first_then_laws_then_this_program(run):
    told = run("cite", EXAMPLES / "kharaz2001.toml", "--tangential", "annulus,stronge").out
    keys = re.findall(r"^@\w+\{(\w+),", told, re.MULTILINE)
    assert keys[0].startswith("kharaz")
    assert keys.index("maw1976") < keys.index("stronge1994") < keys.index("contactlab")
    assert keys[-1] == "contactlab"
    assert len(keys) == len(set(keys))


def test_the_page_to_throw_on_has_the_values_given(run, tmp_path):
    page = tmp_path / "b.html"
    words = ("--angle", 12, "--speed", 2.5, "--spin", -3, "--friction", 0.25)
    assert run("explore", *words, "--material", "steel", "--out", page).out == f"{page}\n"
    text = page.read_text(encoding="utf-8")
    for value in ("12", "2.5", "-3", "0.25"):
        assert re.search(rf"""value="{value}(\.0)?"|: {value}(\.0)?[,}}]""", text), value
    assert "steel" in text
