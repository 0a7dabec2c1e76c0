"""Which laws, histories and files the commands ask for, recorded in their place."""

from __future__ import annotations

import argparse

import pytest

from contactlab import PluginError
from contactlab.cli import compare as command
from contactlab.scene_file import LawChoice


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
    with pytest.raises(ValueError, match=r"^--set tangential\.springs\.springs: no chosen law"):
        asked_for(tangential=["annulus"], settings=settings[1:])
    with pytest.raises(ValueError, match=r"this option; known: none$"):
        asked_for(tangential=["annulus"], settings=[("normal.annuli", 3)])
    with pytest.raises(ValueError, match=r"known: tangential\.annuli, .*springs") as caught:
        asked_for(tangential=["springs", "annulus"], settings=[("tangential.qq", 3)])
    listed = str(caught.value).rpartition("known: ")[2].split(", ")
    assert listed == sorted(listed)
    with pytest.raises(ValueError, match="is not an option of a law"):
        asked_for(tangential=["coulomb"], settings=[("odd.thing", 3)])


def test_a_failure_in_a_sweep_is_counted(run, tmp_path):
    path = tmp_path / "stiff.toml"
    path.write_text("[nondimensional]\npsi1 = 1.0\n[sweep]\nchi = [1000.0, 0.0001, 2000.0]\n")
    few = ("--tangential", "annulus", "--integrator", "paper", "--set", "integrator.steps=5",
           "--set", "integrator.refine=false", "--set", "tangential.annuli=3")  # fmt: skip
    ran = run("run", path, *few)
    assert ran.status == 1
    assert ran.err.startswith("contactlab: failed: 2 of 3 impacts: The steps are too few")
    assert ran.out.count("TOO_FEW_STEPS") == 2
