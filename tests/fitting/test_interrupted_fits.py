"""Ctrl-C in the middle of a fit keeps the laws and the samples that are done."""

import csv
import json

import pytest

from contactlab_fit import command as fit_command
from contactlab_fit import estimation
from tests.cli.conftest import EXAMPLES, interrupting
from tests.longer import longer

KHARAZ = EXAMPLES / "kharaz2001.toml"
E_T = ("--quantity", "tangential_restitution", "--tangential", "exact,coulomb,stronge")


def test_a_fit_keeps_the_laws_that_are_done(run, monkeypatch, tmp_path):
    monkeypatch.setattr(fit_command, "rank", interrupting(fit_command.rank, 1))
    ran = run("fit", KHARAZ, *E_T, "--json", "--residuals", tmp_path / "r.csv")
    assert ran.status == 130
    assert {one["law"] for one in json.loads(ran.out)["ranking"]} == {"exact", "coulomb"}
    rows = csv.DictReader((tmp_path / "r.partial.csv").read_text(encoding="utf-8").splitlines())
    assert {row["law"] for row in rows} == {"exact", "coulomb"}


@pytest.mark.parametrize(("after", "kept"), longer((10, True), (9, False)))
def test_a_bootstrap_keeps_its_samples_if_they_are_enough(run, monkeypatch, after, kept):
    monkeypatch.setattr(estimation, "FEWEST", 10)
    again = interrupting(estimation._solve_again, after)
    monkeypatch.setattr(estimation, "_solve_again", again)
    words = ("fit", KHARAZ, *E_T[:2], "--bootstrap", 150)
    ran = run(*words, "--json")
    assert ran.status == 130
    content = json.loads(ran.out)
    assert not content["complete"]
    assert content["samples"] == after * kept
    interval = content["parameters"]["friction_coefficient"]["bootstrap_95"]
    assert (interval is not None) == kept
    assert any("10 samples of 150" in note for note in content["notes"]) == kept
