"""Files of measured impacts as spreadsheets, data loggers and people write them."""

import os

import numpy as np
import pytest

from contactlab import Simulation, read_scene
from contactlab.fitting import read_measurements
from contactlab.outcome import files
from contactlab.outcome.columns import QUANTITIES
from tests.fitting.impacts import scene

PLAIN = "angle_deg,speed (m/s),rebound_angle_deg,rebound_spin (rpm)\n10,3.9,7.4,-1200\n20,3.9,12,\n"


def read(tmp_path, content):
    path = tmp_path / "impacts.csv"
    path.write_bytes(content)
    return read_measurements(path)


def same(found, expected):
    for part in ("given", "measured"):
        one, other = getattr(found, part), getattr(expected, part)
        assert list(one) == list(other)
        for name, values in other.items():
            np.testing.assert_array_equal(one[name], values)


@pytest.mark.parametrize(
    "content",
    [
        PLAIN.encode("utf-8-sig"),
        PLAIN.replace(",", ";").replace(".", ",").encode(),
        PLAIN.replace(",", ";").encode(),
        PLAIN.replace(",", "\t").replace(".", ",").encode(),
        PLAIN.replace("_deg", " [°]").replace("rpm", "1/min").encode("cp1252"),
        PLAIN.replace("\n", "\r\n").encode(),
    ],
    ids=["mark", "decimal comma", "semicolons", "tabs", "old encoding", "ends of lines"],
)
def test_what_spreadsheets_write_is_the_same_table(tmp_path, content):
    same(read(tmp_path, content), read(tmp_path, PLAIN.encode()))


def test_the_first_column_may_be_one_that_is_not_read(tmp_path):
    lines = PLAIN.splitlines()
    numbered = ["# made up", f"#Test,{lines[0]}", f"1,{lines[1]}", f"2,{lines[2]}"]
    found = read(tmp_path, "\n".join(numbered).encode())
    same(found, read(tmp_path, PLAIN.encode()))
    assert found.unused == ("#Test",)


def test_the_rebound_speed_of_what_slips_throughout():
    """Coulomb's impulse: v - 2 mu v1 along the target, and v1 back from it."""
    impacts = scene(0.1, np.array([60.0, 70.0]))
    found = QUANTITIES["rebound_speed"].of(Simulation().sweep(impacts).check())
    along = impacts.tangential_velocity - 0.2 * impacts.normal_speed
    np.testing.assert_allclose(found, np.hypot(along, impacts.normal_speed), rtol=1e-8)


@pytest.mark.skipif(os.name == "nt", reason="POSIX files")
def test_a_pipe_is_refused_as_it_is_for_a_scene(tmp_path):
    """It was waited for without end."""
    path = tmp_path / "impacts.csv"
    os.mkfifo(path)
    with pytest.raises(ValueError, match="cannot be read: is not a regular file"):
        read_measurements(path)


def test_a_giant_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "LARGEST", 12_000_000)
    told = "is too large: 15 MB, a table of impacts has at most 12"
    with pytest.raises(ValueError, match=told):
        read(tmp_path, PLAIN.encode() + 15_000_000 * b" ")


def test_series_over_different_entries_are_no_table(tmp_path):
    path = tmp_path / "two.toml"
    series = (
        "[[measured]]\nquantity = 'psi2'\nsource = 'made up'\nagainst = '{}'\n"
        "x = [{}]\nvalues = [0.5]\n"
    )
    path.write_text(
        "[nondimensional]\n[sweep]\npsi1 = [1.0, 2.0]\nchi = [1.0, 1.5]\n"
        + series.format("psi1", "2.0")
        + series.format("chi", "1.5"),
        encoding="utf-8",
    )
    with pytest.raises(ValueError, match="vary different entries"):
        read_measurements(read_scene(path))
