"""``contactlab fit``: its tables, its files and the laws that it fits, of fits made by hand."""

from __future__ import annotations

import argparse
import csv
import json

import attrs
import numpy as np
import pytest

from contactlab import ImpactError, Simulation, Status
from contactlab.cli import fit as command
from contactlab.cli.fit_report import describe, ranking, write_residuals
from contactlab.fitting import Ranked
from contactlab.scene_file import LawChoice
from tests.cli.conftest import EXAMPLES
from tests.fitting.made_fit import made

KHARAZ = EXAMPLES / "kharaz2001.toml"


def estimated(**more):
    """Return the fit that is made by hand with another estimate of mu."""
    one = made()
    return attrs.evolve(one, parameters={"mu": attrs.evolve(one.parameters["mu"], **more)})


RESIDUALS = """\
measured      unit   numbers  rms residual  largest
------------  -----  -------  ------------  -------
psi2          1            2         0.354      0.4
rebound_spin  rad/s        3          1.83        3"""


def test_a_fit_as_tables():
    assert (
        describe(made())
        == f"""\
3 impacts of the data; laws: some laws

parameter    value  standard error  95 % from   to
---------  -------  --------------  ---------  ---
mu         0.12346          0.0123        0.1  0.2

{RESIDUALS}"""
    )


def test_a_fit_with_all_there_is_as_tables():
    whole = estimated(bootstrap=(0.09, 0.21), robust=0.125, unit="m/s", standard_error=np.nan)
    table = attrs.evolve(whole.measurements, unused=("a", "b c"), source="t.csv")
    whole = attrs.evolve(
        whole, measurements=table, reduced_chi_square=1.23456, notes=("one", "two")
    )
    text = describe(whole)
    lines = text.splitlines()
    assert lines[0] == "3 impacts of t.csv; laws: some laws"
    assert lines[2].split() == ["parameter", "value", "standard", "error", "95", "%", "from", "to",
                                "bootstrap", "from", "to", "robust"]  # fmt: skip
    row = [word for word in lines[4].split() if word not in ("mu", "(m/s)")]
    assert row == ["0.12346", "-", "0.1", "0.2", "0.09", "0.21", "0.125"]
    assert text.endswith(
        f"{RESIDUALS}\n\ncolumns not used: a, b c\n\nreduced chi square: 1.23\n\nnote: one\n\n"
        "note: two"
    )
    assert "(m/s)" in lines[4]
    robust = describe(estimated(robust=0.125)).splitlines()
    assert robust[2].split()[-2:] == ["to", "robust"]
    assert robust[4].split()[-2:] == ["0.2", "0.125"]


def test_the_ranking_is_from_the_least_criterion():
    worse = attrs.evolve(made(), aic=-10.25)
    laws = [Ranked(name="a", fit=made()), Ranked(name="b", fit=worse), Ranked(name="c", fit=None)]
    text = ranking(laws)
    assert (
        text
        == """\
laws by fit (a difference of 10 is beyond doubt)
law  AIC - best      mu  rms psi2  rms rebound_spin
---  ----------  ------  --------  ----------------
a             0  0.1235    0.3536             1.826
b          2.25  0.1235    0.3536             1.826
c             -       -         -                 -"""
    )


def test_residuals_have_a_row_for_each_law_and_measured_number(tmp_path):
    other = attrs.evolve(made(), predicted={name: 0.0 * made().predicted[name]
                                            for name in made().predicted})  # fmt: skip
    path = tmp_path / "r.csv"
    write_residuals(path, [Ranked(name="a", fit=made()), Ranked(name="b", fit=other)])
    rows = list(csv.reader(path.read_text(encoding="utf-8").splitlines()))
    assert rows[0] == ["law", "quantity", "unit", "impact", "psi1 (1)", "measured", "predicted",
                       "residual"]  # fmt: skip
    assert [row[:3] + [int(row[3])] + [float(cell) for cell in row[4:]] for row in rows[1:6]] == [
        ["a", "psi2", "1", 1, 1.0, 0.5, 0.1, 0.4],
        ["a", "psi2", "1", 3, 3.0, -1.0, -0.7, pytest.approx(-0.3)],
        ["a", "rebound_spin", "rad/s", 1, 1.0, 1.0, 1.0, 0.0],
        ["a", "rebound_spin", "rad/s", 2, 2.0, 2.0, 1.0, 1.0],
        ["a", "rebound_spin", "rad/s", 3, 3.0, 6.0, 3.0, 3.0],
    ]
    assert [row[0] for row in rows[6:]] == ["b"] * 5


def test_a_report_is_json_or_tables(capsys):
    laws = [Ranked(name="a", fit=made()), Ranked(name="b", fit=None, refusal="no")]
    command._report(made(), laws, complete=False, as_json=True)
    content = json.loads(capsys.readouterr().out)
    assert content["ranking"] == [
        {"law": "a", "refusal": "", "fit": made().to_dict()},
        {"law": "b", "refusal": "no", "fit": None},
    ]
    assert content["complete"] is False
    assert content["laws"] == "some laws"
    command._report(made(), [], complete=True, as_json=False)
    assert capsys.readouterr().out == f"{describe(made())}\n"
    command._report(made(), laws, complete=False, as_json=False)
    assert capsys.readouterr().out == (
        f"{describe(made())}\n\n{ranking(laws)}\n\nnot complete: interrupted\n"
    )


@pytest.mark.parametrize(
    ("names", "tables"),
    [([KHARAZ], 0), (["a.csv", KHARAZ], 1), ([KHARAZ, "a.csv"], 1), (["A.CSV", KHARAZ], 1)],
)
def test_one_scene_and_at_most_one_table(names, tables):
    data, path = command._files([str(name) for name in names])
    assert path == KHARAZ
    if tables:
        assert str(data).lower() == "a.csv"
    else:
        assert data.path == KHARAZ


def test_other_files_are_refused():
    for names in (["a.csv"], ["a.toml", "B.TOML"], ["a.csv", "b.csv", "c.toml"]):
        told = (
            f"^FILE = {' '.join(names)}: give the measured impacts as DATA.csv and the bodies as "
            "SCENE.toml; or a SCENE.toml that holds measured values$"
        )
        with pytest.raises(ValueError, match=told.replace(".", r"\.")):
            command._files(names)


@attrs.frozen
class File:
    laws: LawChoice


@pytest.mark.parametrize(
    ("options", "own", "expected"),
    [
        ({}, {}, None),
        ({"normal": "hertz"}, {}, None),
        ({}, {"normal": "hertz"}, None),
        ({"normal": "tsuji"}, {}, {"normal": "tsuji"}),
        ({}, {"normal": "tsuji"}, {"normal": "tsuji"}),
        ({"settings": [("integrator.tolerance", 1e-9)]}, {},
         {"set": {"integrator.tolerance": 1e-9}}),
        ({"laws": "coulomb"}, {}, {"tangential": "coulomb"}),
        ({"laws": "springs", "integrator": "paper"}, {"tangential": "annulus"},
         {"tangential": "springs", "integrator": "paper"}),
        ({}, {"normal": "tsuji", "options": {"normal": {"restitution": 0.5},
                                             "tangential": {"annuli": 3}}},
         {"normal": "tsuji", "set": {"normal.restitution": 0.5}}),
        ({"normal": "hunt_crossley"},
         {"normal": "tsuji", "options": {"normal": {"restitution": 0.5}}},
         {"normal": "hunt_crossley"}),
    ],
)  # fmt: skip
def test_the_laws_to_fit(options, own, expected):
    """The exact law is the table unless a normal law or an option is asked for."""
    plain = {"normal": None, "integrator": None, "settings": [], "laws": "exact"} | options
    name = plain.pop("laws")
    found = command._simulations(argparse.Namespace(laws=[name], **plain), File(LawChoice(**own)))
    if expected is None:
        assert found == {name: None}
        return
    settings = expected.pop("set", {})
    assert found == {name: LawChoice(**expected).set(settings).simulation()}


@pytest.fixture
def fitted(monkeypatch):
    """Record the fits that the command asks for; each gives the one that is made by hand."""
    asked = []

    def fit(impacts, path, *, simulation, progress=None, bootstrap=0, **selection):
        asked.append((simulation and simulation.tangential, bootstrap, selection))
        return attrs.evolve(made(), samples=bootstrap)

    def rank(impacts, path, simulations, **selection):
        ((name, simulation),) = simulations.items()
        asked.append((simulation and simulation.tangential, "rank", selection))
        failed = name == "mindlin_cap"
        return [Ranked(name=name, fit=None if failed else made(), refusal="no" * failed)]

    monkeypatch.setattr(command, "fit", fit)
    monkeypatch.setattr(command, "rank", rank)
    return asked


def test_the_first_law_is_fitted_the_others_ranked(run, fitted):
    coulomb = Simulation(tangential="coulomb").tangential
    ran = run("fit", KHARAZ, "--laws", "exact,coulomb", "--fit", "a,b", "--quantity",
              "tangential_restitution")  # fmt: skip
    selection = {"parameters": ["a", "b"], "quantities": ["tangential_restitution"]}
    assert fitted == [(None, 0, selection), (coulomb, "rank", selection), (None, 200, selection)]
    assert ran.status == 0
    fitted.clear()
    plain = {"parameters": ["friction_coefficient"], "quantities": None}
    assert run("fit", KHARAZ, "--bootstrap", 0, "--json").status == 0
    assert fitted == [(None, 0, plain)]


def test_a_law_that_cannot_be_fitted_has_status_1(run, fitted):
    ran = run("fit", KHARAZ, "--laws", "exact,mindlin_cap,coulomb", "--bootstrap", 0)
    assert ran.status == 1
    assert ran.err == "contactlab fit: mindlin_cap: no\n"
    assert [row.split()[0] for row in ran.out.splitlines()[-3:]] == [
        "coulomb",
        "exact",
        "mindlin_cap",
    ]


@pytest.mark.parametrize(("samples", "status"), [(199, 130), (200, 0), (0, 0)])
def test_fewer_samples_than_asked_for_are_an_interruption(run, monkeypatch, samples, status):
    monkeypatch.setattr(command, "fit", lambda *_, **__: attrs.evolve(made(), samples=samples))
    ran = run("fit", KHARAZ)
    assert ran.status == status
    assert ran.out.endswith("not complete: interrupted\n") == (status == 130)


@pytest.mark.parametrize("call", [1, 2, 3])
def test_what_is_done_before_an_interruption_is_reported(run, monkeypatch, fitted, call):
    fit, calls = command.fit, []

    def interrupted(*arguments, **options):
        calls.append(1)
        if len(calls) == call:
            raise KeyboardInterrupt
        return fit(*arguments, **options)

    monkeypatch.setattr(command, "fit", interrupted)
    monkeypatch.setattr(command, "rank", interrupted) if call == 2 else None
    ran = run("fit", KHARAZ, "--laws", "exact,coulomb")
    if call == 1:
        assert (ran.status, ran.out) == (130, "")
    elif call == 2:
        assert ran.status == 130
        assert "laws by fit" not in ran.out
        assert ran.out.endswith("not complete: interrupted\n")
    else:
        assert ran.status == 0


def test_progress_counts_the_laws_after_the_first(run, monkeypatch, fitted):
    counted = []
    monkeypatch.setattr(
        "contactlab.cli.progress.Progress.__call__", lambda _, *count: counted.append(count)
    )
    run("fit", KHARAZ, "--laws", "exact,coulomb,frictionless", "--bootstrap", 0, "--progress")
    assert counted == [(1, 3), (2, 3)]


def test_files_are_those_of_the_laws_with_a_fit(run, monkeypatch, fitted, tmp_path):
    drawn = []
    monkeypatch.setattr(
        "contactlab.figures.fitting.draw_fits",
        lambda path, fits, **look: drawn.append((path, list(fits), look)),
    )
    files = tmp_path / "f.png", tmp_path / "r.csv"
    run("fit", KHARAZ, "--laws", "exact,mindlin_cap,coulomb", "--figure", files[0], "--csv",
        files[1], "--style", "slides", "--width", "one", "--bootstrap", 0)  # fmt: skip
    assert drawn == [(files[0], ["coulomb", "exact"], {"look": "slides", "width": "one"})]
    laws = [line.partition(",")[0] for line in files[1].read_text("utf-8").splitlines()[1:]]
    assert laws == ["coulomb"] * 5 + ["exact"] * 5


def test_an_impact_that_a_law_does_not_follow_is_one_line(run, monkeypatch):
    def failing(*_, **__):
        raise ImpactError("too few steps", Status.TOO_FEW_STEPS)

    monkeypatch.setattr(command, "fit", failing)
    assert run("fit", KHARAZ) == (1, "", "contactlab fit: error: too few steps\n")
    told = "--bootstrap = 100001: must be a whole number from 0 to 100000"
    assert run("fit", KHARAZ, "--bootstrap", 100001).err == f"contactlab fit: error: {told}\n"


def test_every_part_of_the_work_has_its_progress(run, monkeypatch):
    """Searches of the first law, the further laws, and the samples."""
    counted = []

    def fit(*_, progress, bootstrap=0, **__):
        progress(1, 2 + bootstrap)
        return attrs.evolve(made(), samples=bootstrap)

    monkeypatch.setattr(
        "contactlab.cli.progress.Progress.__call__",
        lambda me, *count: counted.append((me._what, *count)),
    )
    monkeypatch.setattr(command, "fit", fit)
    monkeypatch.setattr(command, "rank", lambda *_, **__: [])
    run("fit", KHARAZ, "--laws", "exact,coulomb", "--bootstrap", 7, "--progress")
    assert counted == [("searches", 1, 2), ("laws", 1, 2), ("bootstrap", 1, 9)]
