"""The file of the tabulated rebound: read, refused, built, and loaded only when asked."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from contactlab_laws.damped_table.table import read as read_damped
from contactlab_laws.tabulated import build, evaluate, rebound, table
from contactlab_laws.tabulated.__main__ import main
from contactlab_laws.tabulated.function import shipped
from tests.exact.test_tabulated import BOUND, mixed


def test_a_damaged_file_is_refused(tmp_path):
    path = tmp_path / "elastic.npz"
    made = shipped()
    terms = made.terms.copy()
    terms[3, 2, 1] = np.nextafter(terms[3, 2, 1], 1.0)
    with np.load(table.SHIPPED) as file:
        content = {name: file[name] for name in file.files}
    np.savez(path, **{**content, "terms": terms})
    with pytest.raises(ValueError, match="checksum"):
        table.read(path)
    shutil.copy(table.SHIPPED, path)
    assert np.array_equal(table.read(path).terms, made.terms)
    path.write_bytes(path.read_bytes()[:-1000])
    with pytest.raises(ValueError, match="no table that can be trusted"):
        table.read(path)


class Trap:
    """What makes a file if it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


@pytest.mark.parametrize("read", [table.read, read_damped])
def test_nothing_in_a_file_is_run(read, tmp_path):
    names = ("checksum", "format", "cuts", "terms", "stuck", "slip", "cells")
    trap = np.array([Trap(tmp_path / "sprung")], dtype=object)
    np.savez(tmp_path / "table.npz", **dict.fromkeys(names, trap))
    with pytest.raises(ValueError, match="no table that can be trusted"):
        read(tmp_path / "table.npz")
    assert not (tmp_path / "sprung").exists()


def test_file_is_small_and_tells_where_it_came_from():
    assert table.SHIPPED.stat().st_size <= 400_000
    made = shipped().provenance
    assert made.version
    assert made.built > "2026"
    assert 0.0 < made.tolerance <= BOUND


def test_nothing_is_loaded_before_it_is_called():
    probe = (
        "import sys, contactlab; contactlab.rebound; "
        "assert not [m for m in sys.modules if m.startswith(('contactlab_', 'scipy'))]; "
        "contactlab.rebound(1.2, 1.44); "
        "assert 'contactlab_laws.tabulated' in sys.modules; "
        "assert not [m for m in sys.modules if m.startswith(('contactlab_laws.fronts', 'scipy'))]"
    )
    subprocess.run([sys.executable, "-c", probe], check=True)


def test_a_build_goes_on_where_it_was_interrupted(tmp_path, monkeypatch):
    """With the table itself in place of exact impacts: two ways to the same coarse table.

    At once it is built by the command.
    """
    made = shipped()
    calls = []

    def solve(psi1, chi):
        calls.append(psi1.size)
        if len(calls) == interrupted:
            raise KeyboardInterrupt
        return evaluate.rebound(made, psi1, chi)

    monkeypatch.setattr(build, "exact", solve)
    monkeypatch.setattr(build, "BATCH", 4)
    monkeypatch.setattr(build.curves, "find", lambda: made.cuts)
    interrupted = 0
    asked = ["build", "--tolerance", "1e-6", "--file", str(tmp_path / "whole.npz")]
    monkeypatch.setattr(sys, "argv", ["contactlab_laws.tabulated", *asked])
    assert main() == 0
    whole, of_whole = table.read(tmp_path / "whole.npz"), len(calls)
    calls.clear()
    interrupted = of_whole // 2
    with pytest.raises(KeyboardInterrupt):
        build.build(tmp_path / "part.npz", tolerance=1e-6)
    interrupted = 0
    calls.clear()
    build.build(tmp_path / "part.npz", tolerance=1e-6)
    part = table.read(tmp_path / "part.npz")
    assert len(calls) < of_whole
    assert np.array_equal(part.cells, whole.cells)
    assert np.array_equal(part.terms, whole.terms)
    assert not list(tmp_path.glob("*.part.npz"))
    psi1, chi = mixed(3000, 28)
    error = np.abs(evaluate.rebound(part, psi1, chi) - rebound(psi1, chi)) / np.maximum(1.0, psi1)
    assert 1e-9 < error.max() < 1e-5
