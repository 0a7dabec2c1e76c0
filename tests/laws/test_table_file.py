"""The file of the tabulated rebound: read, refused, built, and loaded only when asked."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from contactlab import rebound
from contactlab_laws.tables import elastic, restituted
from contactlab_laws.tables.elastic import Table
from contactlab_laws.tables.file import read, write

pytest.importorskip("table_builders", reason="table_builders is not in the wheel")

from table_builders.__main__ import main
from table_builders.elastic import build
from tests.laws.test_tabulated import BOUND, mixed


@pytest.mark.parametrize("shipped", [elastic.SHIPPED, restituted.SHIPPED])
def test_a_damaged_file_is_refused(shipped, tmp_path):
    path = tmp_path / "table.npz"
    made = read(shipped)
    terms = made.arrays["terms"].copy()
    place = 1, 2, *[1] * (terms.ndim - 2)
    terms[place] = np.nextafter(terms[place], terms.dtype.type(1.0))
    with np.load(shipped) as file:
        content = {name: file[name] for name in file.files}
    np.savez(path, **{**content, "terms": terms})
    with pytest.raises(ValueError, match="checksum"):
        read(path)
    write(path, made)
    assert read(path).checksum() == made.checksum()
    shutil.copy(shipped, path)
    assert np.array_equal(read(path).arrays["terms"], made.arrays["terms"])
    path.write_bytes(path.read_bytes()[:-1000])
    with pytest.raises(ValueError, match=r"no table that can be trusted.*build"):
        read(path)


class Trap:
    """What makes a file if it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


def test_nothing_in_a_file_is_run(tmp_path):
    names = ("checksum", "format", "version", "built", "cuts", "terms", "stuck", "slip", "cells")
    trap = np.array([Trap(tmp_path / "sprung")], dtype=object)
    np.savez(tmp_path / "table.npz", **dict.fromkeys(names, trap))
    with pytest.raises(ValueError, match="no table that can be trusted"):
        read(tmp_path / "table.npz")
    assert not (tmp_path / "sprung").exists()


def test_file_is_small_and_tells_where_it_came_from():
    assert elastic.SHIPPED.stat().st_size <= 400_000
    assert restituted.SHIPPED.stat().st_size <= 300_000
    made = read(elastic.SHIPPED)
    assert made.version
    assert made.built > "2026"
    assert 0.0 < float(made.arrays["tolerance"]) <= BOUND


def test_nothing_is_loaded_before_it_is_called():
    probe = (
        "import sys, contactlab; contactlab.rebound; "
        "assert not [m for m in sys.modules if m.startswith(('contactlab_', 'scipy'))]; "
        "contactlab.rebound(1.2, 1.44); "
        "assert 'contactlab_laws.tables.elastic' in sys.modules; "
        "assert 'contactlab_laws.fronts.path' not in sys.modules; "
        "contactlab.rebound(1.2, 1.44, restitution=0.5); "
        "assert 'contactlab_laws.viscoelastic.batch' not in sys.modules; "
        "assert 'scipy' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", probe], check=True)


def test_a_build_goes_on_where_it_was_interrupted(tmp_path, monkeypatch):
    """With the table itself in place of exact impacts: two ways to the same coarse table.

    At once it is built by the command.
    """
    made = elastic.load_table()
    calls = []

    def solve(psi1, chi):
        calls.append(psi1.size)
        if len(calls) == interrupted:
            raise KeyboardInterrupt
        return elastic.values(made, psi1, chi)

    monkeypatch.setattr(build, "exact", solve)
    monkeypatch.setattr(build, "BATCH", 4)
    monkeypatch.setattr(build.curves, "find", lambda: made.cuts)
    interrupted = 0
    asked = ["elastic", "build", "--tolerance", "1e-6", "--file", str(tmp_path / "whole.npz")]
    monkeypatch.setattr(sys, "argv", ["table_builders", *asked])
    assert main() == 0
    whole, of_whole = read(tmp_path / "whole.npz").arrays, len(calls)
    calls.clear()
    interrupted = of_whole // 2
    with pytest.raises(KeyboardInterrupt):
        build.build(tmp_path / "part.npz", tolerance=1e-6)
    interrupted = 0
    calls.clear()
    build.build(tmp_path / "part.npz", tolerance=1e-6)
    stored = read(tmp_path / "part.npz")
    part = stored.arrays
    assert len(calls) < of_whole
    assert np.array_equal(part["cells"], whole["cells"])
    assert np.array_equal(part["terms"], whole["terms"])
    assert not list(tmp_path.glob("*.part.npz"))
    psi1, chi = mixed(3000, 28)
    error = np.abs(elastic.values(Table.of(stored), psi1, chi) - rebound(psi1, chi))
    error /= np.maximum(1.0, psi1)
    assert 1e-9 < error.max() < 1e-5
