"""What the smaller commands print: guide, materials, laws."""

from __future__ import annotations

import json

import attrs
import pytest

from contactlab.cli import guide, plugins
from contactlab.cli import main as module
from contactlab.compose.options import Option
from contactlab.compose.registry import REGISTRY, PluginInfo
from contactlab.impact.material import Entry


def test_the_list_of_topics_is_aligned(run, monkeypatch):
    monkeypatch.setattr(guide, "TOPICS", ("a", "long-one"))
    monkeypatch.setattr(guide, "summary", lambda topic: f"About {topic}.")
    assert run("guide").out == (
        "a         About a.\nlong-one  About long-one.\n\ncontactlab guide TOPIC prints a topic.\n"
    )


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


def test_materials_are_listed_in_gigapascals(run, monkeypatch):
    entries = (
        Entry(name="stuff", young_modulus=1.5e9, poisson_ratio=0.25, density=1234.5,
              elastic_source="a book, p. 1", density_source="dowling, table 9",
              yield_stress=2.5e8, yield_source="di_renzo", note="soft"),
        Entry(name="other", young_modulus=2e11, poisson_ratio=0.3, density=7000.0,
              elastic_source="dowling", density_source="dowling", yield_stress=None,
              yield_source="", note=""),
    )  # fmt: skip
    texts = {"dowling": "Dowling, a book", "di_renzo": "Di Renzo, a paper", "renzo": "another"}
    materials = module.importlib.import_module("contactlab.cli.materials").materials
    monkeypatch.setattr(materials, "entries", lambda: entries)
    monkeypatch.setattr(
        materials, "entry", lambda name: {entry.name: entry for entry in entries}[name]
    )
    monkeypatch.setattr(materials, "references", lambda: texts)
    table = "material  E (GPa)    nu  density (kg/m³)\n--------  -------  ----  ---------------\n"
    stuff, other = (
        "stuff         1.5  0.25           1234.5\n",
        "other         200   0.3             7000\n",
    )
    assert run("materials").out == (
        f"{table}{stuff}{other}\ncontactlab materials NAME prints a material with its sources.\n"
        'In a scene file: material = "steel"; in Python: Material.named("steel").\n'
    )
    assert run("materials", "stuff").out == (
        f"{table}{stuff}\nelastic constants: a book, p. 1\ndensity: dowling, table 9\n"
        "yield stress: 250 MPa, di_renzo\nnote: soft\n\ndowling: Dowling, a book\n"
        "di_renzo: Di Renzo, a paper\n"
    )
    alone = run("materials", "other").out
    assert alone.endswith(
        "elastic constants: dowling\ndensity: dowling\n\ndowling: Dowling, a book\n"
    )
    content = json.loads(run("materials", "--json").out)
    assert [entry["name"] for entry in content["materials"]] == ["stuff", "other"]
    assert content["references"] == texts
    content = json.loads(run("materials", "other", "--json").out)
    assert [entry["yield_stress"] for entry in content["materials"]] == [None]


@pytest.mark.parametrize(
    ("default", "unit", "text"),
    [(3.0, "Pa", "x = 3.0 (Pa)"), (3.0, "1", "x = 3.0"), ("a", "", "x = 'a'")],
)
def test_an_option_with_its_unit(default, unit, text):
    option = Option(name="x", default=default, unit=unit, rule="", meaning="")
    assert plugins._with_unit(option) == text


def test_words_are_wrapped_and_never_broken():
    long = "x" * 120
    told = plugins._indented(f"``a`` b-c {long} {'word ' * 25}", "  ")
    lines = told.splitlines()
    assert lines[:2] == ["  a b-c", f"  {long}"]
    assert told.endswith("\n")
    assert all(line.startswith("  ") and len(line) <= 100 for line in lines[2:])
    assert plugins._indented("", "  ") == ""
    hyphens = plugins._indented("a" * 60 + " " + "b" * 30 + "-" + "c" * 30, "")
    assert hyphens == "a" * 60 + "\n" + "b" * 30 + "-" + "c" * 30 + "\n"


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


def test_clashing_and_marked_names_of_laws(run, monkeypatch):
    one = PluginInfo(name="normal.a", distribution="d", version="2", module="m", blocked=True)
    two = attrs.evolve(one, name="bad.", blocked=False)
    monkeypatch.setattr(REGISTRY, "installed", lambda: [one, two])
    monkeypatch.setattr(REGISTRY, "clashes", lambda: ["a and b clash"])
    ran = run("plugins", "list")
    assert ran.err == "contactlab: warning: a and b clash\n"
    rows = [line.split("  ") for line in ran.out.splitlines()[2:]]
    marked = [row[0].strip() for row in rows]
    assert marked == [f"{one.known_as} (blocked)", f"{two.known_as} (malformed)"]
    assert ran.out.splitlines()[2].split()[2:] == [one.kind, "d", "2"]
    entry = json.loads(run("plugins", "list", "--json").out)[0]
    assert entry == {"name": "normal.a", "known_as": one.known_as, "kind": one.kind,
                     "distribution": "d", "version": "2", "module": "m", "blocked": True,
                     "malformed": one.malformed}  # fmt: skip
