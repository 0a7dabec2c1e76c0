"""Which laws, histories and files the commands ask for, recorded in their place."""

from __future__ import annotations

import argparse
import json
import re

import attrs
import pytest

from contactlab import PluginError, Simulation
from contactlab.cli import compare as command
from contactlab.cli import report
from contactlab.scene_file import LawChoice
from contactlab.study.comparison import compare
from tests.cli.conftest import EXAMPLES

KHARAZ = EXAMPLES / "kharaz2001.toml"


@attrs.frozen
class Compared:
    interrupted: bool = False


@pytest.fixture
def reported(monkeypatch, tmp_path):
    """Record the laws of a report page; the page is a word."""
    asked = []

    def compared(file, simulations, *, history, progress):
        asked.append((simulations, history))
        return Compared(bool(asked[1:]))

    monkeypatch.setattr(report, "compare", compared)
    monkeypatch.setattr("contactlab.pages.report.report_page", lambda *_: "a page")
    return asked


SCENE = "[nondimensional]\npsi1 = 1.0\nchi = 1.4\n[simulation]\n"


@pytest.mark.parametrize(
    ("own", "words", "names"),
    [
        ("", [], ["fronts", "coulomb"]),
        ("tangential = 'springs'", [], ["springs", "fronts", "coulomb"]),
        ("tangential = 'coulomb'", [], ["coulomb", "fronts"]),
        ("normal = 'hunt_crossley'\ntangential = 'coulomb'", [], ["coulomb"]),
        ("", ["--tangential", "tangential.springs,coulomb"], ["fronts", "springs", "coulomb"]),
        ("tangential = 'springs'", ["--tangential", "springs"], ["springs"]),
        ("tangential = 'springs'", ["--integrator", "symplectic"], ["springs", "coulomb"]),
    ],
)
def test_the_laws_of_a_report(run, reported, tmp_path, own, words, names):
    """Those of the file, then the defaults that fit; fronts is not run by steps."""
    scene, page = tmp_path / "s.toml", tmp_path / "p.html"
    scene.write_text(f"{SCENE}{own}\n", encoding="utf-8")
    ran = run("report", scene, "--out", page, *words)
    assert (ran.status, ran.out, ran.err) == (0, f"{page}\n", "")
    assert page.read_text(encoding="utf-8") == "a page"
    ((simulations, history),) = reported
    assert list(simulations) == names
    assert history is True
    normal = "HuntCrossley" if "hunt" in own else "Hertz"
    assert {type(each.normal).__name__ for each in simulations.values()} == {normal}
    assert run("report", scene, "--out", page, *words).status == 130


def test_a_law_that_does_not_fit_a_report_is_refused_if_it_was_asked_for(run, reported, tmp_path):
    scene = tmp_path / "s.toml"
    scene.write_text(f"{SCENE}normal = 'hunt_crossley'\ntangential = 'coulomb'\n", encoding="utf-8")
    ran = run("report", scene, "--tangential", "fronts", "--out", tmp_path / "p.html")
    assert (ran.status, ran.out) == (2, "")
    assert not reported


def asked_for(laws=None, **options):
    plain = {"normal": None, "tangential": None, "integrator": None, "settings": []} | options
    return command.simulations(argparse.Namespace(**plain), laws or LawChoice())


def test_combinations_are_named_by_the_kinds_that_differ():
    assert list(asked_for(tangential=["coulomb"])) == ["coulomb"]
    assert list(asked_for(tangential=["tangential.coulomb", "springs"])) == ["coulomb", "springs"]
    both = asked_for(tangential=["springs"], integrator=["paper", "symplectic"])
    assert list(both) == ["paper", "symplectic"]
    assert [type(each.integrator).__name__ for each in both.values()] == [
        "PaperSteps",
        "Symplectic",
    ]
    many = asked_for(normal=["hertz", "tsuji"], tangential=["springs", "coulomb"])
    names = "hertz + springs, hertz + coulomb, tsuji + springs, tsuji + coulomb"
    assert ", ".join(many) == names
    assert type(many["tsuji + coulomb"].normal).__name__ == "Tsuji"


def test_an_integrator_of_the_file_that_does_not_run_a_law_is_replaced():
    laws = LawChoice(tangential="springs", integrator="symplectic")
    found = asked_for(laws, tangential=["springs", "fronts"])
    assert type(found["springs"].integrator).__name__ == "Symplectic"
    assert type(found["fronts"].integrator).__name__ != "Symplectic"
    with pytest.raises((ValueError, PluginError)):
        asked_for(laws, tangential=["fronts"], integrator=["symplectic"])


def test_an_option_goes_to_the_laws_that_have_it():
    settings = [("tangential.annuli", 7), ("tangential.springs.springs", 9)]
    found = asked_for(tangential=["annulus", "springs", "coulomb"], settings=settings)
    assert found["annulus"].tangential.annuli == 7
    assert found["springs"].tangential.springs == 9
    with pytest.raises(ValueError, match=r"^--set tangential\.springs\.springs: none of the laws"):
        asked_for(tangential=["annulus"], settings=settings[1:])
    with pytest.raises(ValueError, match=r"this option; known: none$"):
        asked_for(tangential=["annulus"], settings=[("normal.annuli", 3)])
    with pytest.raises(ValueError, match=r"known: tangential\.annuli, .*springs") as caught:
        asked_for(tangential=["springs", "annulus"], settings=[("tangential.qq", 3)])
    listed = str(caught.value).rpartition("known: ")[2].split(", ")
    assert listed == sorted(listed)
    with pytest.raises(ValueError, match="is not an option of a law"):
        asked_for(tangential=["coulomb"], settings=[("odd.thing", 3)])


def test_an_interrupted_comparison_names_the_laws_left(run, monkeypatch, short_sweep):
    def part(file, simulations, **_):
        first = dict(list(simulations.items())[:1])
        return attrs.evolve(compare(file, first), interrupted=True)

    monkeypatch.setattr(command, "compare", part)
    laws = ("--tangential", "coulomb,frictionless,springs")
    ran = run("compare", short_sweep, *laws, "--json")
    told = "contactlab compare: interrupted: not compared: frictionless, springs\n"
    assert (ran.status, ran.err) == (130, told)
    assert json.loads(ran.out)["complete"] is False


def test_laws_that_do_not_fit_are_told(run, monkeypatch, short_sweep, ball, tmp_path):
    @attrs.frozen
    class Found:
        simulations: dict
        left_out: dict

    coulomb = {"coulomb": Simulation(tangential="coulomb")}
    monkeypatch.setattr(command, "candidates", lambda _: Found(coulomb, {"odd": "no steps"}))
    ran = run("compare", short_sweep, "--all")
    assert (ran.status, ran.err) == (0, "contactlab compare: odd is left out: no steps\n")
    monkeypatch.setattr("contactlab.cli.drawing.draw_load_paths", lambda *_, **__: None)
    ran = run("compare", ball, "--tangential", "coulomb", "--loops", tmp_path / "l.png")
    assert re.match(r"contactlab compare: --loops: coulomb is left out: \w", ran.err)


def test_impacts_that_were_done_before_are_told(run, monkeypatch, tmp_path):
    monkeypatch.setattr("contactlab.cli.sweep._done", lambda _: 5)
    words = ("--psi1", "6:7:2", "--chi", 1, "--tangential", "coulomb", "--resume")
    ran = run("sweep", *words, "--out", tmp_path / "a.csv")
    assert (ran.status, ran.err) == (0, "contactlab sweep: 5 impacts were done before\n")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv"]  # and cleared
    monkeypatch.setattr("contactlab.cli.sweep._done", lambda _: 0)
    assert run("sweep", *words, "--out", tmp_path / "a.csv").err == ""


def test_a_failure_in_a_sweep_is_counted(run, tmp_path):
    path = tmp_path / "stiff.toml"
    path.write_text("[nondimensional]\npsi1 = 1.0\n[sweep]\nchi = [1000.0, 0.0001, 2000.0]\n")
    few = ("--tangential", "annulus", "--integrator", "paper", "--set", "integrator.steps=5",
           "--set", "integrator.refine=false", "--set", "tangential.annuli=3")  # fmt: skip
    ran = run("run", path, *few)
    assert ran.status == 1
    assert ran.err.startswith("contactlab: failed: 2 of 3 impacts: The steps are too few")
    assert ran.out.count("TOO_FEW_STEPS") == 2


def test_a_caution_on_an_answer_is_told_beside_json(run, monkeypatch):
    monkeypatch.setattr("contactlab.cli.run.error_cautions", lambda _: ["look"])
    words = ("run", "--psi1", 6, "--chi", 1, "--tangential", "coulomb")
    assert run(*words, "--json").err == "contactlab: caution: look\n"
    assert run(*words).err == ""


RIGID = """\
psi2                     2
numerical error of psi2  about 6e-12, estimated; at most 6e-12, declared
run time                 3 s

                           before  after  unit
-------------------------  ------  -----  ----
local angle psi                 6      2  1
local tangential velocity       6      2  1
normal velocity                 1     -1  1

contact                 value  unit
--------------------  -------  ----
chi                         1  1
normal restitution e        1  1
contact time          2.94328  1
"""


def test_an_impact_as_it_is_printed(run, monkeypatch):
    """Rigid slip at psi1 = 6, chi = 1 takes 4 away; the time is Hertz's, 2.9432."""
    monkeypatch.setattr("contactlab.outcome.tables.time", lambda _: "3 s")
    out = run("run", "--psi1", 6, "--chi", 1, "--tangential", "coulomb").out
    assert re.sub(r"\d\.?\d*e-1\d", "6e-12", out).startswith(RIGID)
    ends = {line.partition(":")[0]: line for line in out.splitlines()[-3:]}
    assert ends["laws"].startswith("laws:     hertz (")
    assert ends["counters"] == "counters: none"
    assert ends["status"].startswith("status:   The impact was followed")
    caution = next(line for line in out.splitlines() if line.startswith("caution"))
    assert caution.startswith("caution:  rigid bodies")
