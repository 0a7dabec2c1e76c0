"""The builder of the table of elastic coupling: what it solves, and the file that it writes."""

import numpy as np

from contactlab.impact.coupling import FILE
from table_builders.coupling import build

HEAD = """\
# psi2 with one-way coupling of unlike bodies less psi2 without: tangential.halfspace, 32 rings, \
8 angles, known to about 0.002.
# Written by: python -m table_builders coupling build
psi1,chi,poisson_ratio,Lambda=0.25,Lambda=0.5,Lambda=1,Lambda=2,Lambda=4
"""


def test_the_file_is_written_row_by_row(monkeypatch, tmp_path, capsys):
    def shift(psi1, chi, poisson_ratio, numbers):
        return np.array([number * psi1 - chi + poisson_ratio for number in numbers])

    monkeypatch.setattr(build, "shift", shift)
    monkeypatch.setattr(build, "PSI1", (0.25, 12.0))
    monkeypatch.setattr(build, "CHI", (0.83, 1.0))
    build.build(tmp_path / "coupling.csv")
    assert (tmp_path / "coupling.csv").read_text(encoding="utf-8") == HEAD + (
        "0.25,0.83,0,-0.7675,-0.7050,-0.5800,-0.3300,0.1700\n"
        "12,0.83,0,2.1700,5.1700,11.1700,23.1700,47.1700\n"
        "0.25,0.83,0.5,-0.2675,-0.2050,-0.0800,0.1700,0.6700\n"
        "12,0.83,0.5,2.6700,5.6700,11.6700,23.6700,47.6700\n"
        "0.25,1,0,-0.9375,-0.8750,-0.7500,-0.5000,0.0000\n"
        "12,1,0,2.0000,5.0000,11.0000,23.0000,47.0000\n"
        "0.25,1,0.5,-0.4375,-0.3750,-0.2500,0.0000,0.5000\n"
        "12,1,0.5,2.5000,5.5000,11.5000,23.5000,47.5000\n"
    )
    assert capsys.readouterr().out == (
        "chi = 0.83, nu = 0\nchi = 0.83, nu = 0.5\nchi = 1, nu = 0\nchi = 1, nu = 0.5\n"
    )


def test_the_shipped_file_has_the_head_and_the_rows_of_the_builder():
    lines = FILE.read_text(encoding="utf-8").splitlines()
    assert lines[:3] == HEAD.splitlines()
    nodes = [line.split(",")[:3] for line in lines[3:]]
    assert nodes == [
        [f"{psi1:g}", f"{chi:g}", f"{nu:g}"]
        for chi in build.CHI
        for nu in (0.0, 0.5)
        for psi1 in build.PSI1
    ]
