"""Files of measured impacts as spreadsheets, data loggers and people write them."""

import os

import numpy as np
import pytest

from contactlab import Simulation, read_scene
from contactlab.outcome import files
from contactlab.outcome.columns import QUANTITIES
from contactlab_fit import read_measurements
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
        b"sep=,\r\n" + PLAIN.encode(),
        b'"SEP=;"\n' + PLAIN.replace(",", ";").encode(),
        b"sep=\t\n" + PLAIN.replace(",", "\t").encode(),
        PLAIN.replace(",", "\t").replace(".", ",").encode(),
        PLAIN.replace("_deg", " [°]").replace("rpm", "1/min").encode("cp1252"),
        PLAIN.replace("\n", "\r\n").encode(),
    ],
    ids=[
        "mark",
        "decimal comma",
        "semicolons",
        "told comma",
        "told semicolon",
        "told tab",
        "tabs",
        "old encoding",
        "ends of lines",
    ],
)
def test_what_spreadsheets_write_is_the_same_table(tmp_path, content):
    same(read(tmp_path, content), read(tmp_path, PLAIN.encode()))


def test_the_first_column_may_be_one_that_is_not_read(tmp_path):
    lines = PLAIN.splitlines()
    numbered = ["# made up", f"#Test,{lines[0]}", f"1,{lines[1]}", f"2,{lines[2]}"]
    found = read(tmp_path, "\n".join(numbered).encode())
    same(found, read(tmp_path, PLAIN.encode()))
    assert found.unused == ("#Test",)


@pytest.mark.parametrize(
    ("headings", "names"),
    [
        ("incidence_angle_deg,speed_m_s,rebound_angle_deg,rebound_spin_rpm", {}),
        ("Angle (deg),speed [m/s],rebound angle (deg),rebound spin_1_min", {}),
        (
            "impact angle [deg],v_m_s,out_deg,w",
            {
                "impact angle [deg]": "incidence_angle",
                "v_m_s": "speed",
                "out_deg": "rebound_angle",
                "w": "rebound_spin (rpm)",
            },
        ),
    ],
    ids=["units in names", "units in brackets", "mapped"],
)
def test_columns_are_named_by_the_list_of_columns(tmp_path, headings, names):
    content = "\n".join([headings, *PLAIN.splitlines()[1:]])
    path = tmp_path / "named.csv"
    path.write_text(content, encoding="utf-8")
    same(read_measurements(path, columns=names), read(tmp_path, PLAIN.encode()))


def test_a_name_in_degrees_does_not_overrule_a_heading_in_radians():
    columns = {"in [rad]": [0.5], "e": [0.9], "e_s": [0.1]}
    names = {"in [rad]": "angle_deg", "e": "beta0", "e_s": "beta0_error (1)"}
    found = read_measurements(columns, columns=names)
    np.testing.assert_allclose(found.given["angle_deg"], np.degrees(0.5), rtol=1e-15)
    assert found.errors["beta0"] == 0.1


def test_chosen_quantities_keep_their_errors_and_no_others():
    columns = {"angle_deg": [10.0, 20.0], "beta0": [0.1, 0.2]}
    columns |= {"beta0_error": [0.01, 0.02], "normal_restitution": [0.9, 0.9]}
    columns |= {"normal_restitution_error": [0.03, 0.03]}
    chosen = read_measurements(columns).only(["beta0"])
    assert list(chosen.measured) == list(chosen.errors) == ["beta0"]
    assert chosen.errors["beta0"].tolist() == [0.01, 0.02]


def test_a_published_table_is_read_by_a_mapping(tmp_path):
    """The headings of a file of Kharaz and others' spins (2001): words, degrees, rad/s."""
    path = tmp_path / "spin.csv"
    path.write_text(
        "# digitised\ndigitised_by,incidence_deg,spin_rad_s\nmfix,6.0,-135.5\nlethe,20.0,-540.0\n",
        encoding="utf-8",
    )
    names = {
        "digitised_by": "#",
        "incidence_deg": "incidence_angle",
        "spin_rad_s": "rebound_spin",
    }
    found = read_measurements(path, columns=names)
    np.testing.assert_array_equal(found.given["angle_deg"], [6.0, 20.0])
    np.testing.assert_array_equal(found.measured["rebound_spin"], [-135.5, -540.0])
    assert found.unused == ("digitised_by",)


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
