"""The report of ``contactlab validate`` as it is printed, of findings that are made by hand."""

from __future__ import annotations

import json

import attrs
import numpy as np
import pytest

import contactlab
from contactlab.cli import validate
from contactlab.study.comparison import compare
from contactlab.study.validation import Finding


def finding(what, against, difference, bound):
    return Finding(what=what, against=against, difference=difference, bound=bound)


def test_findings_and_their_bounds():
    found = [finding("a", "b", 1.234e-3, 1e-2), finding("c", "d", 0.5, 0.25)]
    assert validate._checks(found) == (
        "what  against  worst difference  bound\n----  -------  ----------------  -----  -----\n"
        "a     b                  0.0012   0.01  ok\nc     d                     0.5   0.25  FAILS"
    )


@attrs.frozen
class Source:
    name: str = "made"
    kind: str = "experiment"


@attrs.frozen
class Evidence:
    """A source and the laws beside it, as ``contactlab.study.validation`` gathers them."""

    file: object
    comparison: object
    scatters: tuple
    source: Source = Source()
    laws: tuple = ("coulomb", "frictionless")
    left_out: dict = attrs.field(factory=lambda: {"odd": "does not fit"})

    def scatter(self, agreement):
        return self.scatters[list(self.comparison.agreements).index(agreement)]


def evidence(measured, *scatters):
    laws = {name: contactlab.Simulation(tangential=name) for name in ("coulomb", "frictionless")}
    text = measured.read_text(encoding="utf-8").replace("2.9", "2.8")
    text += (
        "[[measured]]\nquantity = 'slip_restitution'\nagainst = 'psi1'\nsource = 'x'\nx = [8.0]\n"
    )
    measured.write_text(text + "values = [0.25]\n", encoding="utf-8")
    file = contactlab.read_scene(measured)
    file = attrs.evolve(file, title="A title", citation=" word" * 30, notes="  Notes.\n")
    return Evidence(file, compare(file, laws), scatters)


def test_the_distance_of_laws_from_a_source(measured):
    """Rigid: psi1 - 4 at 6, 7 and 8, so 2, 3 and 4; measured 2.1, 2.8 and a quarter of 8."""
    lines = validate._agreement(evidence(measured, 0.012345, np.nan)).splitlines()
    assert lines[0] == "A title (experiment)"
    assert " ".join(lines[1:3]) == " ".join(["word"] * 30)
    assert max(map(len, lines[1:3])) <= 100
    assert lines[3] == "Notes."
    words = [line.split() for line in lines[4:]]
    head = next(place for place, line in enumerate(words) if set("".join(line)) == {"-"})
    headings = " ".join(word for line in words[:head] for word in line)
    for word in ("law", "psi2", "rms", "largest", "at", "slip_restitution"):
        assert word in headings.replace("_ ", "_")
    assert words[head + 1 :] == [
        ["coulomb", "0.158", "0.2", "7", "0.25", "0.25", "8"],
        ["frictionless", "4.05", "4.2", "7", "0.75", "0.75", "8"],
        ["(scatter", "of", "readings)", "0.0123", "-", "-", "-", "-", "-"],
    ]
    assert "scatter" not in validate._agreement(evidence(measured, np.nan, np.nan, np.nan))


def test_a_source_as_plain_numbers(measured):
    content = validate._plain(evidence(measured, 0.5, np.nan))
    series = content.pop("series")
    assert content == {"name": "made", "kind": "experiment", "title": "A title",
                       "citation": " ".join(["word"] * 30), "notes": "Notes.",
                       "left_out": {"odd": "does not fit"}}  # fmt: skip
    first, _ = series
    told = [(one["quantity"], one["numbers"], one["scatter"]) for one in series]
    assert told == [("psi2", 2, 0.5), ("slip_restitution", 1, None)]
    assert list(first["laws"]) == ["coulomb", "frictionless"]
    assert first["laws"]["coulomb"]["rms"] == pytest.approx(np.sqrt(0.025))
    assert first["laws"]["coulomb"]["largest"] == pytest.approx(0.2)


@pytest.fixture
def validated(monkeypatch):
    """Let the command find these findings and sources."""

    def call(findings, sources=(), *, stop=""):
        asked = []

        def checked(_):
            yield from findings
            if stop == "checks":
                raise KeyboardInterrupt

        def gather(*, curves, progress):
            asked.append(curves)
            yield from sources
            if stop == "sources":
                raise KeyboardInterrupt

        monkeypatch.setattr(validate, "validate", checked)
        monkeypatch.setattr(validate, "gather", gather)
        monkeypatch.setattr(validate, "judged", lambda _: [finding("e", "f", 0.1, 0.2)])
        monkeypatch.setattr(validate, "_agreement", lambda one: f"source {one}")
        monkeypatch.setattr(validate, "_plain", lambda one: {"source": one})
        return asked

    return call


GOOD, BAD = finding("a", "b", 0.1, 0.2), finding("c", "d", np.nan, 0.2)


@pytest.mark.parametrize(
    ("findings", "stop", "status"),
    [([GOOD], "", 0), ([GOOD, BAD], "", 1), ([GOOD], "checks", 130), ([GOOD, BAD], "sources", 130)],
)
def test_what_validation_ends_with(run, validated, findings, stop, status):
    asked = validated(findings, [7], stop=stop)
    ran = run("validate")
    assert ran.status == status
    sources = [] if stop == "checks" else [7]
    assert ("source 7" in ran.out) == bool(sources)
    assert ran.out.endswith("\n\nnot complete: interrupted\n") == bool(stop)
    assert asked == ([] if stop == "checks" else [False])
    content = json.loads(run("validate", "--json").out)
    assert content["complete"] == (not stop)
    assert content["sources"] == [{"source": each} for each in sources]
    told = [(row["what"], row["ok"]) for row in content["checks"]]
    judged = [("e", True)] * len(sources)
    assert told == [(each.what, each.ok) for each in findings] + judged
    assert content["checks"][-1]["bound"] == 0.2


def test_validation_that_is_interrupted_before_anything_has_no_report(run, validated):
    validated([], stop="checks")
    assert run("validate")[:2] == (130, "")


def test_pictures_of_the_sources(run, validated, monkeypatch, tmp_path):
    named = [attrs.evolve(Evidence(None, None, ()), source=Source(name)) for name in "ab"]
    asked = validated([GOOD], named)
    drawn = []
    monkeypatch.setattr(validate, "_draw", lambda path, one: drawn.append((path, one)))
    folder = tmp_path / "new"
    assert run("validate", "--figures", folder).status == 0
    assert run("validate", "--figures", folder).status == 0  # it is there already
    assert drawn[:2] == [(folder / "a.png", named[0]), (folder / "b.png", named[1])]
    assert asked == [True, True]

    def full(*_):
        raise OSError("no space")

    monkeypatch.setattr(validate, "_draw", full)
    assert run("validate", "--figures", folder).status == 1
