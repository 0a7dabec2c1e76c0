"""A stranger's law beside ours of one name: everywhere that names are taken."""

import json

import pytest

import contactlab
from contactlab.cli.main import main
from contactlab.compose.registry import REGISTRY
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
    assert choice.made("tangential").springs == 7
    choice = LawChoice(tangential="contactlab:springs").set({"tangential.springs.springs": 8})
    assert choice.made("tangential").springs == 8


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
    assert warning.startswith("contactlab: warning: 'tangential.coulomb' is offered by contactlab ")
    assert "it means 'contactlab:tangential.coulomb'" in warning
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
    with pytest.raises(ValueError, match=r"these would fit: .*usurper:tangential\.coulomb"):
        contactlab.Simulation(normal="linear", tangential="fronts")
