"""`contactlab sweep`."""

import json

import numpy as np
import pytest

from contactlab.closed_forms import rigid_body_rebound

LAWS = ("--tangential", "coulomb", "--integrator", "symplectic")


def test_ranges_make_every_combination_psi1_fastest(run):
    ran = run("sweep", "--psi1", "0:8:5", "--chi", "1:2:2", *LAWS, "--csv")
    rows = [line.split(",") for line in ran.out.splitlines()[1:]]
    assert ran.status == 0
    assert [(float(row[0]), float(row[1])) for row in rows] == [
        (psi1, chi) for chi in (1.0, 2.0) for psi1 in (0.0, 2.0, 4.0, 6.0, 8.0)
    ]
    psi1, chi, psi2 = np.array([row[:3] for row in rows], dtype=float).T
    assert psi2 == pytest.approx(rigid_body_rebound(psi1, chi), abs=1e-12)


def test_json_and_file(run, tmp_path):
    ran = run(
        "sweep", "--psi1", "-3:3:4", "--chi", "1.44", *LAWS, "--json", "--out", tmp_path / "a.npz"
    )
    assert len(json.loads(ran.out)["psi2"]) == 4
    with np.load(tmp_path / "a.npz") as content:
        assert content["psi1"].tolist() == [-3.0, -1.0, 1.0, 3.0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--psi1", "0:1:3"), "--chi"),
        (("--psi1", "0:1", "--chi", "1"), "START:STOP:COUNT"),
        (("--psi1", "0:1:x", "--chi", "1"), "whole number"),
        (("--psi1", "0:1:0", "--chi", "1"), "COUNT"),
        (("--psi1", "0:nan:3", "--chi", "1"), "finite"),
        (("--psi1", "0:1:1000000", "--chi", "1:2:1000000"), "at most 1000000"),
        (("--psi1", "0:1:3", "--chi", "-1"), "chi"),
        (("nowhere.toml",), "no such file"),
    ],
)
def test_bad_ranges_are_one_line_and_status_2(run, arguments, words):
    ran = run("sweep", *arguments)
    assert ran.status == 2
    assert len(ran.err.splitlines()) == 1
    assert words in ran.err
