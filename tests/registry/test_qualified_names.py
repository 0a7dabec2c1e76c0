"""A stranger's law beside ours of one name, and laws in files: wherever names are taken."""

import json
import pickle
import re
import sys

import pytest

import contactlab
from contactlab.cli.main import main
from contactlab.registry.registry import REGISTRY
from contactlab.runs.workers import processes
from contactlab.scene_file import LawChoice
from contactlab.study.bench_methods import methods
from contactlab.study.scores import candidates

THEIRS = "usurper:tangential.coulomb"
#: A friction law of half the coefficient, and one option.
LAW = """
from typing import ClassVar
import attrs
import numpy as np
import contactlab
from contactlab.contracts import WholeImpact, WholeImpactTangentialLaw
from contactlab.numeric.checks import quantity

@attrs.frozen(kw_only=True)
class Half(WholeImpactTangentialLaw):
    '''Slip with a share of the friction.

    Parameters
    ----------
    share : float
        Of Coulomb's friction.
    '''
    api_version: ClassVar[int] = 2
    expected_failures: ClassVar[dict] = {"sliding_impulse": "a share of the friction only"}
    share: float = quantity("1", default=0.5)

    def whole_impacts(self, scene, normal):
        mass, slip = scene.pair.tangential_mass, scene.slip_velocity
        most = self.share * scene.friction_coefficient * normal.total_load_impulse / mass
        lost = np.minimum(most, np.abs(slip))
        return (*super().whole_impacts(scene, normal), WholeImpact(
            where=True, slip_velocity_change=-np.sign(slip) * lost,
            friction_work=mass * lost * (np.abs(slip) - 0.5 * lost), reason="half"))

@contactlab.hookimpl
def contactlab_law(name):
    return Half
"""
SOFT = """
from typing import ClassVar
from contactlab.contracts import NormalContact, NormalLaw

class Soft(NormalLaw):
    api_version: ClassVar[int] = 2
    def start(self, scene):
        return scene.pair.effective_modulus * scene.pair.radius
    def respond(self, state, approach, rate):
        inside = approach * (approach > 0.0)
        return NormalContact(force=state * inside, radius=0.0 * inside, overlap=approach), state
"""
FILE = """
[nondimensional]
psi1 = 9.0
chi = 1.0

[simulation]
tangential = "NAME"
OPTIONS
"""


@pytest.fixture
def usurper(install, monkeypatch):
    for name, nothing in (("_loaded", {}), ("_meant", {})):
        monkeypatch.setattr(REGISTRY, name, nothing)
    install("usurper", "usurper_law", LAW, "tangential.coulomb")


def run(capsys, *words):
    status = main(list(words))
    ran = capsys.readouterr()
    return status, ran.out, ran.err


def psi2(capsys, *words):
    status, out, _ = run(capsys, "run", *words, "--json")
    assert status == 0
    return json.loads(out)["psi2"]


@pytest.mark.usefixtures("usurper")
def test_the_command_line_takes_both(capsys):
    scene = ("--psi1", "9", "--chi", "1")
    assert psi2(capsys, *scene, "--tangential", "coulomb") == pytest.approx(5.0)
    for name in ("usurper:coulomb", THEIRS):
        assert psi2(capsys, *scene, "--tangential", name) == pytest.approx(7.0)
    for path in ("tangential.share", f"{THEIRS}.share"):
        setting = ("--set", f"{path}=0.25")
        words = (*scene, "--tangential", "usurper:coulomb", *setting)
        assert psi2(capsys, *words) == pytest.approx(8.0)
    status, _, err = run(capsys, "run", *scene, "--set", "usurper:coulomb.share=1")
    assert status == 2
    assert "is not an option of a law" in err


@pytest.mark.usefixtures("usurper")
@pytest.mark.parametrize("name", ["usurper:coulomb", THEIRS])
@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ("", 7.0),
        ("options.tangential.share = 0.25", 8.0),
        (f'options."{THEIRS}".share = 0.25', 8.0),
        ('options."usurper:tangential".coulomb.share = 0.25', 8.0),
    ],
)
def test_a_scene_file_takes_them(tmp_path, capsys, name, options, expected):
    path = tmp_path / "scene.toml"
    path.write_text(FILE.replace("NAME", name).replace("OPTIONS", options))
    assert psi2(capsys, str(path)) == pytest.approx(expected)


def test_options_are_those_of_the_law_that_is_meant_however_it_is_written():
    """Options of ``contactlab:tangential.springs`` are those of ``springs``."""
    choice = LawChoice(tangential="springs").set({"contactlab:tangential.springs.springs": 7})
    assert choice.make("tangential").springs == 7
    choice = LawChoice(tangential="contactlab:springs").set({"tangential.springs.springs": 8})
    assert choice.make("tangential").springs == 8


@pytest.mark.usefixtures("usurper")
def test_compare_takes_both_side_by_side(capsys):
    words = ("--psi1", "8:9:2", "--chi", "1", "--tangential", "coulomb,usurper:coulomb")
    status, out, _ = run(capsys, "compare", *words, "--json", "--set", f"{THEIRS}.share=0.25")
    assert status == 0
    runs = {name: entry["values"] for name, entry in json.loads(out)["laws"].items()}
    assert list(runs) == ["coulomb", "usurper:coulomb"]
    assert runs["usurper:coulomb"]["psi2"][1] == pytest.approx(8.0)
    assert runs["coulomb"]["psi2"][1] == pytest.approx(5.0)


@pytest.mark.usefixtures("usurper")
def test_reports_over_all_laws_have_both():
    names = [method.name for method in methods()]
    assert {"coulomb", "usurper:coulomb"} <= set(names)
    assert [method.name for method in methods([THEIRS])] == ["usurper:coulomb"]
    found = candidates(LawChoice()).simulations
    assert type(found["usurper:coulomb"].tangential).__name__ == "Half"
    assert type(found["coulomb"].tangential).__name__ == "Coulomb"


@pytest.mark.usefixtures("usurper")
def test_plugins_list_warns_of_the_name_and_shows_how_to_say_which(capsys):
    status, out, err = run(capsys, "plugins", "list")
    assert status == 0
    (warning,) = err.splitlines()
    assert warning.startswith("contactlab: warning: ")
    assert "'tangential.coulomb': is offered by contactlab " in warning
    assert "means 'contactlab:tangential.coulomb'" in warning
    assert "CONTACTLAB_BLOCK_PLUGINS=usurper" in warning
    assert [line.split()[0] for line in out.splitlines() if ".coulomb " in line] == [
        "tangential.coulomb",
        THEIRS,
    ]
    entries = json.loads(run(capsys, "plugins", "list", "--json")[1])
    assert THEIRS in {entry["known_as"] for entry in entries}


@pytest.mark.usefixtures("usurper")
def test_plugins_show_and_check_take_them(capsys):
    assert "share = 0.5" in run(capsys, "plugins", "show", THEIRS)[1]
    assert "options: none" in run(capsys, "plugins", "show", "tangential.coulomb")[1]
    found = json.loads(run(capsys, "plugins", "check", THEIRS, "--json")[1])
    assert found["name"] == THEIRS
    outcomes = {entry["check"]: entry["outcome"] for entry in found["checks"]}
    assert outcomes["sliding_impulse"] == "expected failure"  # that of theirs; ours passes


@pytest.mark.usefixtures("usurper")
def test_a_misfit_advises_a_law_by_the_name_that_means_it():
    contactlab.create(THEIRS)  # at hand only once it was loaded
    with pytest.raises(ValueError, match=r"use normal = hertz, or tangential = "):
        contactlab.Simulation(normal="linear", tangential="fronts")


#: What is written of a law in the file ``half.py``, and a key word of the refusal.
REFUSED = {
    "half.py:Hlaf": "did you mean 'Half'",
    "half.py": "half.py has Half",
    "none.py:Half": "No such file",
    "half.py:np": "np is no law",
    "~nobody_here/half.py:Half": "No such file",
    "half\0.py:Half": "must not hold a null character",
    "raises.py:Half": r"ZeroDivisionError: division by zero \(raises.py, line 1\)",
    "abstract.py:Half": "does not define whole_impacts",
    "old.py:Half": "api_version",
    "contactlab_laws:Half": "has no law",
    "no_package.at_all:Half": "a file is named by its path",
    "soft.py:Soft": "is a law of kind 'normal'; pass the law as normal",
}


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    beside = LAW.replace("share * np", "share * one.ONE * np").replace("import attrs", "import one")
    for name, text in {
        "half": LAW,
        "raises": "1/0",
        "abstract": LAW.replace("def whole_impacts", "def other"),
        "old": LAW.replace("int] = 2", "int] = 1"),
        "soft": SOFT,
        "normal": LAW,
        "my half.laws": LAW,
        "one": "ONE = 1.0",
        "beside": f"import attrs\n{beside}",
    }.items():
        (tmp_path / f"{name}.py").write_text(text)
    yield tmp_path
    sys.modules.pop("one", None)  # that of the next test is another file


@pytest.mark.parametrize(("name", "word"), REFUSED.items())
@pytest.mark.usefixtures("files")
def test_a_law_in_a_file_is_refused_in_one_sentence(capsys, name, word):
    status, out, err = run(capsys, "run", "--psi1", "9", "--chi", "1", "--tangential", name)
    assert status in (1, 2)
    assert out == ""
    assert len(err.splitlines()) == 1
    assert re.search(word, err)
    with pytest.raises((ValueError, contactlab.PluginError), match=word):
        contactlab.Simulation(tangential=name)


@pytest.mark.parametrize("file", ["half", "./half", "normal", "my half.laws", "beside"])
def test_a_law_in_a_file_is_named_by_path_and_class(files, capsys, file):
    scene = ("--psi1", "9", "--chi", "1")
    for name in (f"{file}.py:Half", f"{files}/{file}.py:Half"):
        assert psi2(capsys, *scene, "--tangential", name) == pytest.approx(7.0)
        options = ("--set", "tangential.share=.25")
        assert psi2(capsys, *scene, "--tangential", name, *options) == pytest.approx(8.0)
        assert contactlab.create(name, share=0.25).share == 0.25
    (named,) = methods([f"{file}.py:Half"])
    assert named.tangential == f"{file}.py:Half"
    normal = contactlab.Simulation(normal="soft.py:Soft", tangential="coulomb")
    assert type(normal.normal).__name__ == "Soft"


@pytest.mark.slow
def test_every_command_takes_a_law_in_a_file(files, capsys):
    name = "half.py:Half"
    words = ("--psi1", "8:9:2", "--chi", "1", "--tangential", f"coulomb,{name}", "--json")
    compared = json.loads(run(capsys, "compare", *words)[1])["laws"]
    assert compared[name]["values"]["psi2"][1] == pytest.approx(7.0)
    listed = json.loads(run(capsys, "bench", "--quick", "--json", "--tangential", name)[1])
    assert {row["method"] for row in listed["rows"]} == {name}
    listed = json.loads(run(capsys, "stability", "--quick", "--json", "--tangential", name)[1])
    assert {each["method"] for each in listed["outcomes"]} == {name}
    shown = json.loads(run(capsys, "plugins", "show", name, "--json")[1])
    assert shown["known_as"] == f"{files / 'half.py'}:Half"
    checked = json.loads(run(capsys, "plugins", "check", name, "--json")[1])
    assert {"sliding_impulse": "expected failure"}.items() <= {
        each["check"]: each["outcome"] for each in checked["checks"]
    }.items()
    pytest.importorskip("contactlab_fit")
    table = "psi1,chi,psi2\n9,1,8\n8,1,7\n8.5,1,7.5\n"
    (files / "data.csv").write_text(table)
    (files / "scene.toml").write_text("[nondimensional]\npsi1 = 9\nchi = 1\n")
    fitted = run(
        capsys, "fit", "data.csv", "scene.toml", "--tangential", name, "--fit", "tangential.share",
        "--bootstrap", "0", "--json",
    )  # fmt: skip
    assert json.loads(fitted[1])["parameters"]["tangential.share"]["value"] == pytest.approx(0.25)


def test_a_scene_file_names_a_law_relative_to_itself(files, capsys, monkeypatch):
    (files / "elsewhere").mkdir()
    content = FILE.replace("NAME", "half.py:Half").replace("OPTIONS", "options.tangential.share=1")
    (files / "scene.toml").write_text(content)
    monkeypatch.chdir(files / "elsewhere")
    assert psi2(capsys, "../scene.toml", "--allow-code") == pytest.approx(5.0)


@pytest.mark.usefixtures("files")
def test_the_processes_of_a_sweep_load_a_law_in_a_file():
    scene = contactlab.Scene.nondimensional(psi1=[8.0, 9.0], chi=1.0)
    law = contactlab.create("beside.py:Half", share=0.25)
    assert pickle.loads(pickle.dumps(law)) == law
    with processes(1) as executor:
        swept = contactlab.Simulation(tangential=law).sweep(scene, executor=executor)
    assert swept.psi2 == pytest.approx([7.0, 8.0])


def test_a_file_that_has_changed_is_loaded_again_and_told_apart(files):
    def law():
        return contactlab.Simulation(tangential="half.py:Half").tangential

    first, again = law(), law()
    assert first is again
    told = REGISTRY.describe(first)
    assert told.startswith("half.py:Half (file ")
    (files / "half.py").write_text(LAW.replace("default=0.5", "default=0.25"))
    assert law().share == 0.25
    assert REGISTRY.describe(law()) != told


@pytest.mark.usefixtures("files")
def test_a_law_is_named_by_module_and_class(capsys):
    name = "contactlab_laws.coulomb:Coulomb"
    assert psi2(capsys, "--psi1", "9", "--chi", "1", "--tangential", name) == pytest.approx(5.0)
    assert REGISTRY.describe(REGISTRY.law_class(name)).startswith("coulomb (contactlab")
