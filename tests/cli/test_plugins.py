"""``contactlab plugins``: what is installed, without importing it."""

from __future__ import annotations

import json
import re

import pytest

import contactlab
from contactlab.registration.manager import MANAGER
from contactlab.registry.registry import REGISTRY, PluginInfo


def test_list_as_json(run):
    entries = {entry["name"]: entry for entry in json.loads(run("plugins", "list", "--json").out)}
    coulomb = entries["tangential.coulomb"]
    assert coulomb["kind"] == "tangential"
    assert coulomb["distribution"] == "contactlab"
    assert coulomb["version"] == contactlab.__version__
    assert {"normal.hertz", "integrator.paper"} <= set(entries)


def test_list_as_table(run):
    out = run("plugins", "list").out
    assert out.splitlines()[0].split() == ["name", "kind", "distribution", "version"]
    assert "tangential.annulus" in out


def test_show(run):
    shown = json.loads(run("plugins", "show", "tangential.annulus", "--json").out)
    assert shown["module"] == "contactlab_laws.annulus.law:Annulus"
    assert "contactlab_laws.annulus.law" in run("plugins", "show", "tangential.annulus").out


def test_what_a_law_does_not_need_is_none(run):
    shown = run("plugins", "show", "tangential.coulomb").out.splitlines()
    assert "needs         none" in shown


def test_check_of_a_law_that_keeps_its_contract(run):
    ran = run("plugins", "check", "normal.hertz")
    assert ran.status == 0
    assert ran.out.splitlines()[0].split() == ["check", "outcome", "sentence"]
    assert 'never "no contact"' in ran.out
    passed = re.findall(r"^\w+ +passed ", ran.out, re.MULTILINE)
    others = "1 not claimed"
    assert ran.out.splitlines()[-1] == f"{len(passed)} passed, {others}"


def test_check_as_json_names_expected_failures_and_reasons(run):
    ran = run("plugins", "check", "tangential.walton", "--json")
    found = json.loads(ran.out)
    assert ran.status == 0
    assert found["good"]
    outcomes = {entry["check"]: entry for entry in found["checks"]}
    assert outcomes["impact_reference"]["outcome"] == "expected failure"
    assert "deform tangentially" in outcomes["impact_reference"]["sentence"]


def test_check_of_a_law_that_fails_exits_with_1(run, monkeypatch):
    law = type(contactlab.create("tangential.walton"))
    monkeypatch.setattr(law, "api_version", 99)
    ran = run("plugins", "check", "tangential.walton")
    assert ran.status == 1
    assert "api_version = 99: contactlab has 2." in ran.out
    assert run("plugins", "check", "normal.herz").status == 2


def test_blocked_law_is_marked(run, monkeypatch):
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "tangential.coulomb")
    assert "tangential.coulomb (blocked)" in run("plugins", "list").out
    assert run("run", "--psi1", "1", "--chi", "1", "--tangential", "coulomb").status == 2


@pytest.mark.parametrize(
    "command",
    [("plugins", "list", "--json"), ("run", "--psi1", "6", "--chi", "1", "--json"), ("--help",)],
)
def test_a_blocked_name_that_is_not_installed_is_warned_of(run, monkeypatch, command):
    monkeypatch.setattr(MANAGER, "_warned", set())
    monkeypatch.setattr(REGISTRY, "_loaded", {})
    monkeypatch.setenv("CONTACTLAB_BLOCK_PLUGINS", "tangential.coulom")
    ran = run(*command)
    assert ran.status == 0
    assert command == ("--help",) or json.loads(ran.out)
    assert len(ran.err.splitlines()) == 1
    assert ran.err.startswith("contactlab: warning: ")
    assert "'tangential.coulom', which is not installed" in ran.err
    assert "did you mean 'tangential.coulomb'" in ran.err


def test_a_malformed_name_is_marked(run, monkeypatch):
    odd = PluginInfo(
        name="tangential.", distribution="odd", version="1", module="odd", blocked=False
    )
    monkeypatch.setattr(REGISTRY, "installed", lambda: [odd])
    assert "tangential. (malformed)" in run("plugins", "list").out
    listed = json.loads(run("plugins", "list", "--json").out)
    assert [one["name"] for one in listed if one["malformed"]] == ["tangential."]


def test_show_says_what_a_law_does_and_takes(run):
    out = run("plugins", "show", "tangential.annulus").out
    assert "annuli = 50" in out
    assert "partial slip" in out
    assert "partial_slip" in out
    entry = json.loads(run("plugins", "show", "integrator.symplectic", "--json").out)
    assert [(option["name"], option["default"]) for option in entry["options"]] == [
        ("steps", None),
        ("refine", True),
    ]
    assert entry["runs"] == "SteppedTangentialLaw"


def test_show_tells_options_with_unit_range_meaning_and_the_paper(run):
    out = run("plugins", "show", "normal.thornton").out
    assert "yield_pressure = None (Pa)\n" in out
    assert "must be positive and finite, if given\n" in out
    assert "the contact pressure at which the material yields" in out
    assert "doi:10.1115/1.2787319" in out
    assert max(len(line) for line in out.splitlines() if line.startswith(" ")) <= 100
    assert "``" not in run("plugins", "show", "tangential.mindlin_cap").out
    assert "options: none\n" in run("plugins", "show", "tangential.coulomb").out
    entry = json.loads(run("plugins", "show", "normal.thornton", "--json").out)
    assert entry["options"][1]["unit"] == "Pa"
    assert len(entry["references"]) == 1


def test_unknown_name(run):
    ran = run("plugins", "show", "tangential.anulus")
    assert ran.status == 2
    assert "did you mean 'annulus'" in ran.err
    assert run("plugins").status == 2
    assert run("plugins", "remove").status == 2


FAILS = """
import contactlab
from contactlab.plugin import Column

def odd(result):
    return 1.0 / (float(result.psi1) - 1.2)

@contactlab.hookimpl
def contactlab_columns():
    return [Column("odd", "1", value=odd, needs={needs})]
"""


def test_a_column_that_fails_for_an_impact_is_told_once_and_the_others_stand(
    run, install, tmp_path
):
    install("lab", "lab_columns", FAILS.format(needs=()), "columns.lab")
    out = tmp_path / "swept.csv"
    ran = run("sweep", "--psi1", "0.2:2.2:3", "--chi", 1.44, "--out", out)
    assert ran.status == 0
    assert ran.err.splitlines() == [
        "contactlab: warning: column odd: NaN for 1 of 3 impacts, its function failed: "
        "ZeroDivisionError: float division by zero"
    ]
    heading, *rows = (line.split(",") for line in out.read_text("utf-8").splitlines())
    values = [float(row[heading.index("odd (1)")] or "nan") for row in rows]
    assert values == pytest.approx([-1.0, float("nan"), 1.0], nan_ok=True)


@pytest.mark.parametrize(
    ("needs", "told"),
    [((), "ZeroDivisionError"), (("sizez",), "needs 'sizez', none of sizes, motion")],
)
def test_the_check_of_a_column_tells_what_is_wrong(run, install, needs, told):
    source = FAILS.replace("1.2", "0.5").format(needs=needs)  # psi1 of an impact of the check
    install("lab", "lab_columns", source, "columns.lab")
    ran = run("plugins", "check", "columns.lab")
    assert ran.status == 1
    assert told in ran.out
