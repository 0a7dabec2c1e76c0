"""Benchmark, stability and report pages of a stranger's normal law and integrator."""

import ast
import json
import math
import re
from pathlib import Path

import pytest

import contactlab
from contactlab.cli.main import main
from contactlab.registry.registry import REGISTRY
from contactlab.study import work_precision
from contactlab.study.bench_methods import Method, methods
from contactlab.study.stability_cases import cases

ROOT = Path(contactlab.__file__).parent
NORMAL = """
from typing import ClassVar
import attrs
import contactlab
from contactlab.contracts import NormalContact, NormalLaw, quantity

@attrs.frozen(kw_only=True)
class Softer(NormalLaw):
    '''Hertz's law with a share of the stiffness.

    Parameters
    ----------
    share : float
        Of the stiffness.
    '''
    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius"})
    share: float = quantity("1", default=0.5)

    def start(self, scene):
        pair = scene.pair
        return self.share * 4 / 3 * pair.effective_modulus * pair.radius**0.5, pair.radius

    def respond(self, state, approach, rate):
        inside = approach * (approach > 0.0)
        contact = NormalContact(state[0] * inside**1.5, (state[1] * inside) ** 0.5, approach)
        return contact, state

@contactlab.hookimpl
def contactlab_law():
    return Softer
"""
INTEGRATOR = """
from typing import ClassVar
import attrs
import contactlab

@attrs.frozen(kw_only=True)
class March(contactlab.registry.registry.REGISTRY.law_class("integrator.symplectic")):
    api_version: ClassVar[int] = 2

@contactlab.hookimpl
def contactlab_law():
    return March
"""


@pytest.fixture
def theirs(install, monkeypatch):
    for name, nothing in (("_loaded", {}), ("_meant", {})):
        monkeypatch.setattr(REGISTRY, name, nothing)
    install("theirs", "their_normal", NORMAL, "normal.softer")
    install("steps", "their_steps", INTEGRATOR, "integrator.march")


@pytest.mark.usefixtures("theirs")
def test_methods_of_any_kind_of_law():
    assert methods(["springs", "integrator.march"]) == [
        Method(tangential="springs", integrator="march")
    ]
    found = methods(["normal.softer", "springs", "integrator.symplectic"])
    assert [method.name for method in found] == ["springs / symplectic, softer"]
    every = methods(["integrator.march"])
    assert {"springs", "annulus", "mindlin_cap"} <= {method.tangential for method in every}
    assert {method.integrator for method in every} == {"march"}
    assert not {"coulomb", "frictionless"} & {method.tangential for method in every}
    under = methods(["normal.softer"])
    assert {method.normal for method in under} == {"softer"}
    assert {"springs", "coulomb"} <= {method.tangential for method in under}
    assert "fronts" not in {method.tangential for method in under}


@pytest.mark.usefixtures("theirs")
@pytest.mark.parametrize(
    ("laws", "words"),
    [
        (["normal.softest"], "did you mean 'softer'"),
        (
            ["fronts", "normal.softer"],
            "fronts: fits no installed .* under normal.softer",
        ),
        (
            ["fronts", "integrator.march"],
            "fronts: does not fit march under normal.hertz",
        ),
    ],
)
def test_laws_that_do_not_fit_are_refused(laws, words):
    with pytest.raises(ValueError, match=words):
        methods(laws)


@pytest.mark.slow
@pytest.mark.usefixtures("theirs")
def test_bench_of_them(capsys, monkeypatch):
    """The law scaled in stiffness is Hertz's at another speed: springs converge under it too."""
    monkeypatch.setattr(work_precision, "SLOW_QUICK", math.inf)  # no resolution is left out
    words = ["bench", "--quick", "--json", "--tangential", "springs", "--normal", "softer"]
    assert main([*words, "--integrator", "march"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert {row["method"] for row in rows} == {"springs / march, softer"}
    assert [row["status"] for row in rows] == ["SUCCESS"] * len(rows)
    assert rows[-1]["error_rms"] < 5e-3
    assert rows[-1]["error_rms"] < rows[0]["error_rms"]


@pytest.mark.usefixtures("theirs")
def test_stability_of_them(capsys):
    words = ["stability", "--quick", "--json", "--tangential", "coulomb", "--normal", "softer"]
    assert main(words) == 0
    outcomes = json.loads(capsys.readouterr().out)["outcomes"]
    assert {item["method"] for item in outcomes} == {"coulomb, softer"}
    assert "silently wrong" not in {item["outcome"] for item in outcomes}
    assert sum(item["error"] is not None for item in outcomes) >= 3
    listed = cases(Method(tangential="springs", integrator="march"), quick=True)
    assert "softer" in {case.normal for case in listed}


@pytest.mark.usefixtures("theirs")
def test_a_report_page_of_them(tmp_path, capsys):
    pytest.importorskip("contactlab_pages")
    scene = tmp_path / "scene.toml"
    scene.write_text("[nondimensional]\npsi1 = 1.2\nchi = 1.44\n")
    out = tmp_path / "page.html"
    words = ["report", str(scene), "--normal", "softer", "--integrator", "march"]
    assert main([*words, "--out", str(out)]) == 0
    page = out.read_text(encoding="utf-8")
    assert "softer (theirs 1.5)" in page
    assert "march (steps 1.5)" in page
    capsys.readouterr()


@pytest.mark.usefixtures("theirs")
def test_an_integrator_alone_gets_a_law_that_it_runs(capsys):
    assert main(["run", "--psi1", "1.2", "--chi", "1.44", "--integrator", "march", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["psi2"] == pytest.approx(-0.18048, abs=3e-3)


#: Files of the core and the studies that may name laws of ours: the table of defaults, the names
#: that type checkers know, what validation expects of which law, and which laws a benchmark asks.
TABLES = {
    "registry/composition.py",
    "registry/named_laws.py",
    "study/questions.py",
    "study/validation.py",
    "study/evidence.py",
}


def test_no_law_of_ours_is_named_in_the_core_or_the_studies():
    names = {name.partition(".")[2] for name in REGISTRY.names()}
    found = []
    for room in (
        "numeric",
        "impact",
        "contracts",
        "outcome",
        "registry",
        "solve",
        "runs",
        "collisions",
        "paths",
        "study",
    ):
        for path in (ROOT / room).glob("*.py"):
            file = path.relative_to(ROOT).as_posix()
            source = path.read_text(encoding="utf-8")
            if not re.search(rf"""['".]({"|".join(names)})['"]""", source):
                continue  # no text of it ends with a name: nothing to parse
            for node in ast.walk(ast.parse(source)):
                if not (isinstance(node, ast.Constant) and isinstance(node.value, str)):
                    continue
                text = node.value.rpartition(".")[2]
                if text in names and file not in TABLES:
                    found.append(f"{file}:{node.lineno}: {node.value!r}")
    assert found == []
