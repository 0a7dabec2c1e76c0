"""The command line run in this process, with its streams caught."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest

from contactlab.cli.main import main
from tests.timed_once import timed_once  # noqa: F401

EXAMPLES = Path(__file__).parents[2] / "examples"


class Ran(NamedTuple):
    status: int
    out: str
    err: str


def partial(path):
    """Return where an interrupted command writes what is done."""
    return path.with_name(f"{path.stem}.partial{path.suffix}")


def interrupting(function, after):
    """Return ``function`` as interrupted in its call number ``after`` + 1."""
    calls = []

    def interrupted(*arguments, **keywords):
        calls.append(None)
        if len(calls) > after:
            raise KeyboardInterrupt
        return function(*arguments, **keywords)

    return interrupted


@pytest.fixture
def run(capsys):
    def call(*arguments):
        status = main([str(argument) for argument in arguments])
        caught = capsys.readouterr()
        return Ran(status, caught.out, caught.err)

    return call


@pytest.fixture
def ball():
    return EXAMPLES / "steel_ball.toml"


@pytest.fixture
def short_sweep(tmp_path):
    path = tmp_path / "short.toml"
    path.write_text(
        "[nondimensional]\nchi = 1.0\n[sweep]\npsi1 = [0.0, 2.0, 6.0]\n"
        "[simulation]\ntangential = 'coulomb'\nintegrator = 'symplectic'\n",
        encoding="utf-8",
    )
    return path


@pytest.fixture
def measured(tmp_path):
    """Rigid-body rebounds of psi1 = 6, 7 at chi = 1 are 2 and 3; measured 0.1 beside them."""
    path = tmp_path / "measured.toml"
    path.write_text(
        "[nondimensional]\nchi = 1.0\n[sweep]\npsi1 = [1.0, 6.0]\n"
        "[simulation]\ntangential = 'coulomb'\nintegrator = 'symplectic'\n"
        "[[measured]]\nquantity = 'psi2'\nagainst = 'psi1'\nsource = 'made up'\n"
        "x = [6.0, 7.0]\nvalues = [2.1, 2.9]\nerror = [0.05, 0.05]\n",
        encoding="utf-8",
    )
    return path


@pytest.fixture
def impacts(tmp_path):
    """Gross slip of steel on steel, mu = 0.1: e_t = 1 - 0.2/tan(angle), read to 0.002."""
    path = tmp_path / "impacts.csv"
    path.write_text(
        "# made up\nangle (deg),speed (m/s),tangential restitution,# remark\n"
        "45,2,0.802,first\n55,2,0.858,\n65,2,0.909,\n70,2,0.925,\n",
        encoding="utf-8",
    )
    return path
