"""``contactlab fit``: its tables and files, of fits made by hand."""

from __future__ import annotations

import csv

import attrs
import numpy as np
import pytest

from contactlab.cli.fit_report import describe, ranking, write_residuals
from contactlab.fitting import Ranked
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
        whole,
        measurements=table,
        reduced_chi_square=1.23456,
        notes=("one", "two"),
        cautions=("three",),
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
        "note: two\n\ncaution: three"
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
