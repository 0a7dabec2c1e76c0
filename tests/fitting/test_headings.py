"""The meaning of a heading: its role, its name, and the factor to the unit of the quantity."""

import math
import re
import shlex

import numpy as np
import pytest

from contactlab_fit.csv_columns import Heading, read_columns, read_heading, read_text
from contactlab_fit.measurements import read_measurements

TURN = 2.0 * math.pi


@pytest.mark.parametrize(
    ("text", "role", "name", "factor"),
    [
        ("angle_deg", "given", "angle_deg", 1.0),
        ("angle (deg)", "given", "angle_deg", 1.0),
        ("angle (°)", "given", "angle_deg", 1.0),
        ("Incidence-Angle [degrees]", "given", "angle_deg", 1.0),
        ("incidence angle (rad)", "given", "angle_deg", 360.0 / TURN),
        ("incidence_angle_rad", "given", "angle_deg", 360.0 / TURN),
        ("speed (m/s)", "given", "speed", 1.0),
        ("speed (mm/s)", "given", "speed", 1e-3),
        ("speed_cm_s", "given", "speed", 1e-2),
        ("normal_speed_mm_s", "given", "normal_speed", 1e-3),
        ("tangential velocity [cm/s]", "given", "tangential_velocity", 1e-2),
        ("spin (rpm)", "given", "spin", TURN / 60.0),
        ("spin (1/min)", "given", "spin", TURN / 60.0),
        ("spin (rev/s)", "given", "spin", TURN),
        ("spin (deg/s)", "given", "spin", TURN / 360.0),
        ("spin_rad_s", "given", "spin", 1.0),
        ("speed (mph)", "given", "speed", 1609.344 / 3600.0),
        ("speed_mph", "given", "speed", 1609.344 / 3600.0),
        ("speed (km/h)", "given", "speed", 1.0 / 3.6),
        ("speed_km_h", "given", "speed", 1.0 / 3.6),
        ("speed (ft/s)", "given", "speed", 0.3048),
        ("speed_mps", "given", "speed", 1.0),
        ("spin_deg_s", "given", "spin", TURN / 360.0),
        ("spin [°/s]", "given", "spin", TURN / 360.0),
        ("sphere.radius (in)", "given", "sphere.radius", 0.0254),
        ("sphere.radius (inches)", "given", "sphere.radius", 0.0254),
        ("sphere.mass (oz)", "given", "sphere.mass", 0.45359237 / 16.0),
        ("sphere.radius (mm)", "given", "sphere.radius", 1e-3),
        ("sphere.radius (m)", "given", "sphere.radius", 1.0),
        ("sphere.mass (g)", "given", "sphere.mass", 1e-3),
        ("friction_coefficient", "given", "friction_coefficient", 1.0),
        ("psi1 (-)", "given", "psi1", 1.0),
        ("rebound_angle (deg)", "measured", "rebound_angle_deg", 1.0),
        ("rebound angle_deg", "measured", "rebound_angle_deg", 1.0),
        ("rebound_angle_deg (rad)", "measured", "rebound_angle_deg", 360.0 / TURN),
        ("rebound_angle (rad)", "measured", "rebound_angle", 1.0),
        ("local_rebound_angle (deg)", "measured", "local_rebound_angle_deg", 1.0),
        ("rebound_spin (rev/s)", "measured", "rebound_spin", TURN),
        ("contact_time (ms)", "measured", "contact_time", 1e-3),
        ("contact_time (µs)", "measured", "contact_time", 1e-6),
        ("contact_time_us", "measured", "contact_time", 1e-6),
        ("contact_time_s", "measured", "contact_time", 1.0),
        ("normal_restitution (1)", "measured", "normal_restitution", 1.0),
        ("rebound_spin_error (rpm)", "error", "rebound_spin", TURN / 60.0),
        ("rebound_spin_error_rpm", "error", "rebound_spin", TURN / 60.0),
        ("rebound_spin_rpm_error", "error", "rebound_spin", TURN / 60.0),
        ("rebound_angle_error (deg)", "error", "rebound_angle_deg", 1.0),
        ("beta0_error", "error", "beta0", 1.0),
        ("status", "unused", "status", 1.0),
        ("spin_error (rad/s)", "unused", "spin_error (rad/s)", 1.0),
        ("friction_work (J)", "unused", "friction_work (J)", 1.0),
        ("# remark", "unused", "# remark", 1.0),
        ("  #remark", "unused", "  #remark", 1.0),
        ("", "unused", "", 1.0),
        ("  ", "unused", "  ", 1.0),
    ],
)
def test_a_heading_is_read(text, role, name, factor):
    found = read_heading(text, {})
    assert (found.role, found.name) == (role, name)
    assert found.factor == pytest.approx(factor, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "alias", "expected"),
    [
        ("v [mm/s]", "speed", Heading("given", "speed", 1e-3)),
        ("v [mm/s]", "speed (cm/s)", Heading("given", "speed", 1e-2)),
        ("t_ms", "contact_time", Heading("measured", "contact_time", 1e-3)),
        ("w", "#", Heading("unused", "w")),
        ("w", " ", Heading("unused", "w")),
        ("n (rpm)", "-rebound_spin", Heading("measured", "rebound_spin", -TURN / 60.0)),
        ("n", "-spin (rad/s)", Heading("given", "spin", -1.0)),
        ("a (from normal)", "angle_deg", Heading("given", "angle_deg", 1.0)),
        ("a (from normal)", "incidence_angle (deg)", Heading("given", "angle_deg", 1.0)),
        ("a [rad from normal]", "angle", Heading("given", "angle_deg", 360.0 / TURN)),
        ("v (mm / s)", "speed", Heading("given", "speed", 1e-3)),
    ],
)
def test_a_heading_of_another_name_keeps_its_unit(text, alias, expected):
    """The mapping is by the heading without blanks about it."""
    assert read_heading(text, {text: alias}) == expected
    assert read_heading(f" {text} ", {text: alias}).role == expected.role


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (" spni (rpm) ", "did you mean 'spin'? before the impact: friction_coefficient, speed"),
        ("qqq", "name the column: --column 'qqq=...'"),
        ("angle_error (deg)", "did you mean 'angle_deg'?"),
        ("speed (m/s", "write a name and its unit"),
        ("speed", "has no unit; write 'speed (m/s)', or (mm/s), or (cm/s)"),
        ("contact_time (min)", "is in min, which is not known here; write 'contact_time (s)'"),
        ("psi2 (m)", "write 'psi2 (1)'"),
        ("normal_restitution (in percent)", "divide the numbers by 100 and write"),
        ("incidence_angle", "write 'incidence_angle (deg)', or (rad)"),
        ("incidence_angle (from normal)", "write 'incidence_angle (deg)', or (rad)"),
        ("rebound_angle", "write 'rebound_angle (rad)', or (deg)"),
    ],
)
def test_a_heading_without_meaning_is_refused_with_what_to_write(text, words):
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        read_heading(text, {})
    assert str(caught.value).startswith(f"heading {text!r}: ")


def test_all_bad_headings_are_told_at_once():
    words = r"'speed \(m': .*'spin': has no unit.*left out, .*: zzz"
    with pytest.raises(ValueError, match=words):
        read_measurements({"speed (m": [1.0], "spin": [2.0], "zzz": [3.0], "e": [0.5]})


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("psi2\tangle_deg\n0,5\t10\n", {"psi2": [0.5], "angle_deg": [10.0]}),
        ("psi2;angle_deg\n0,5;1.5\n", {"psi2": [0.5], "angle_deg": [1.5]}),
        ("psi2;angle_deg\n;1e1\n", {"psi2": [np.nan], "angle_deg": [10.0]}),
        ('psi2,angle_deg\n"0.5", 10 \n', {"psi2": [0.5], "angle_deg": [10.0]}),
        ("#no,psi2\nA1,0.5\n", None),
        ("#no,psi2\n1,0.5\n\n2,0.7\n# end\n", {"#no": [np.nan] * 2, "psi2": [0.5, 0.7]}),
        ("# made up\n#no;psi2\n1,5;0,5\n", {"#no": [np.nan], "psi2": [0.5]}),
        ("  # made up\npsi2\n0.5\n", {"psi2": [0.5]}),
        ("psi2\n0.5", {"psi2": [0.5]}),
        ("angle (deg)  psi2\n 10   0.5\n", {"angle (deg)": [10.0], "psi2": [0.5]}),
        ("angle_deg psi2\n10,5 0,5\n", {"angle_deg": [10.5], "psi2": [0.5]}),
        ("# angle_deg, by hand\nangle_deg psi2\n10 nan\n", {"angle_deg": [10.0], "psi2": [np.nan]}),
        ("psi2,angle_deg\nNaN,1\nN/A,2\n", {"psi2": [np.nan] * 2, "angle_deg": [1.0, 2.0]}),
    ],
)
def test_cells_and_comments(text, expected):
    """Headings may begin with # only if the line below them is one of numbers."""
    if expected is None:
        with pytest.raises(ValueError, match="needs a line of headings"):
            read_columns(text, {})
        return
    found, _, left_out = read_columns(text, {})
    assert list(found) == list(expected)
    assert not left_out
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name], values)


@pytest.mark.parametrize("end", ["", "# end\n"])
def test_a_last_line_does_not_tell_the_mark_of_a_table_without_headings(end):
    with pytest.raises(
        ValueError, match=r"^line 1: holds numbers where headings should be; .*--columns"
    ):
        read_columns(f"1;2\n3;4\n{end}", {})


def test_a_first_column_that_no_fit_needs_may_begin_with_a_mark():
    """Of the quantities of a result, not of a measurement: it would be left out anyway."""
    found, *_ = read_columns("# status,psi2\n1,0.5\n", {})
    assert list(found) == ["# status", "psi2"]


def test_a_file_that_is_no_text_is_refused(tmp_path):
    """Bytes that neither encoding has, and the null characters of UTF-16."""
    for coded in (b"psi2\n\x81\n", "psi2\n0.5\n".encode("utf-16")):
        path = tmp_path / "bad.csv"
        path.write_bytes(coded)
        with pytest.raises(ValueError, match="cannot be read as text; save it as CSV in UTF-8"):
            read_text(path)
    path.write_text("psi2\n0.5\n", encoding="utf-8")
    assert read_measurements(path).measured["psi2"].tolist() == [0.5]


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("slip_restitution_error", "'x': slip_restitution_error .* mean 'beta0_error'[?]"),
        ("-slip_restitution_error (1)", "slip_restitution_error .* mean 'beta0_error'[?]"),
        ("slip_restitution", "mean 'beta0', which is -slip_restitution"),
        ("et_error", "mean 'tangential_restitution_error' or 'beta0_error'[?]"),
        ("beta0_std", "mean 'beta0_error'[?]"),
        ("rebound_speed_error", "write 'rebound_speed_error [(]m/s[)]'"),
    ],
)
def test_a_wrong_name_of_a_column_is_told_with_the_right_one(name, told):
    """The name of an error is that of an error, and the name that was written is told."""
    table = {"angle_deg": [10.0, 20.0], "x": [0.1, 0.1], "psi2": [0.5, 0.4]}
    with pytest.raises(ValueError, match=told):
        read_measurements(table, columns={"x": name})


def test_columns_are_named_in_their_order_with_headings_or_without(tmp_path):
    path = tmp_path / "plain.txt"
    expected = {"angle_deg": [10.0, 20.0], "speed": [1.0, 1.5], "rebound_spin": [-3.0, -4.0]}
    names = ["angle", "speed (cm/s)", "-rebound_spin (rad/s)", "#"]
    for above in ("", "angle[deg] v w note\n"):
        path.write_text(f"{above}10 100 3 7\n20 150 4 8\n", encoding="utf-8")
        if not above:
            names[0] = "angle (deg)"
            with pytest.raises(ValueError, match=r"line 1: holds numbers where .*--columns"):
                read_measurements(path)
        found = read_measurements(path, columns=names)
        for name, values in expected.items():
            assert (found.given | found.measured)[name].tolist() == pytest.approx(values)
    with pytest.raises(ValueError, match="2 names for 4 columns"):
        read_measurements(path, columns=["angle_deg", "psi2"])
    with pytest.raises(ValueError, match="as a list are for a CSV file"):
        read_measurements({"psi2": [1.0]}, columns=["psi2"])


def test_a_row_without_a_number_before_the_impact_is_left_out_and_told(tmp_path):
    path = tmp_path / "gaps.csv"
    path.write_text(
        "angle_deg,spin (rad/s),psi2\n1,0,.1\n2,,.2\n3,nan,.3\n4,5,\n", encoding="utf-8"
    )
    found = read_measurements(path)
    assert found.given["angle_deg"].tolist() == [1.0, 4.0]
    assert found.notes == (
        "line 3 is left out: it has no number of spin (rad/s)",
        "line 4 is left out: it has no number of spin (rad/s)",
    )


@pytest.mark.parametrize(
    ("heading", "number", "name"),
    [
        ("vx_in", 1.0, "tangential_velocity (m/s)"),
        ("vx_in_mps", 1.0, "tangential_velocity (m/s)"),
        ("vy_out_mps", 2.0, "-rebound_normal_velocity (m/s)"),
        ("vy_out_mps", -2.0, "rebound_normal_velocity (m/s)"),
        ("Vz1 (mm/s)", -5.0, "-normal_speed (mm/s)"),
        ("v_out", 1.0, "rebound_speed (m/s)"),
        ("v_in", 1.0, "speed (m/s)"),
        ("Impact speed [km/h]", 9.0, "speed (km/h)"),
        ("rpm", 9.0, "spin (rpm)"),
        ("omega_after", 9.0, "rebound_spin (rad/s)"),
        ("Spin rate (rpm)", 9.0, "-rebound_spin (rpm)"),
        ("Backspin", 9.0, "-rebound_spin (rad/s)"),
        ("angle_out", 9.0, "rebound_angle_deg"),
        ("angle out from normal", 9.0, "rebound_angle_deg"),
        ("grazing angle in (rad)", 0.9, "angle_from_surface_deg"),
        ("Descent Angle (deg)", -40.0, "-angle_from_surface_deg"),
        ("theta1", 40.0, "angle_deg"),
        ("slip_out", -1.0, "rebound_slip_velocity (m/s)"),
        ("vt_out (mm/s)", 1.0, "rebound_tangential_velocity (mm/s)"),
        ("e_t", 0.4, "beta0"),
        ("Tangential coefficient of restitution", 0.4, "beta0"),
        ("Coefficient of restitution", 0.4, "normal_restitution"),
        ("Club Speed (mph)", 9.0, "speed (mph)"),
        ("COR", 0.9, "normal_restitution"),
        ("tangential_restituion", 0.9, "tangential_restitution"),
        ("spni (rpm)", 0.9, "spin (rpm)"),
    ],
)
def test_a_heading_in_other_words_is_told_with_what_to_paste(heading, number, name):
    """The option that is told reads the column, and turns it to the sign that holds here."""
    with pytest.raises(ValueError, match="look like other words") as caught:
        read_measurements({heading: [number], "contact_time (s)": [0.1]})
    told, *_ = [*getattr(caught.value, "__notes__", ()), str(caught.value)]
    assert shlex.split(told)[-2:] == ["--column", f"{heading}={name}"]
    found = read_measurements(
        {heading: [number], "contact_time (s)": [0.1]}, columns={heading: name}
    )
    assert len({*found.given, *found.measured} - {"contact_time"}) == 1


LAUNCH_MONITOR = (
    "Date;Player;Club;Club Speed (mph);Attack Angle (deg);Club Path (deg);Dyn. Loft (deg);"
    "Face Angle (deg);Spin Loft (deg);Face To Path (deg);Swing Plane (deg);Swing Direction (deg);"
    "Low Point (in);Impact Offset (mm);Impact Height (mm);Ball Speed (mph);Smash Factor;"
    "Launch Angle (deg);Launch Direction (deg);Backspin (rpm);Sidespin (rpm);Spin Axis (deg);"
    "Carry (yds);Total (yds);Side (ft);Height (ft);Hang Time (s);Landing Angle (deg);"
    "Last Data;Tags;Quality"
)
#: Of another make: the spin by its parts and by its axis.
ANOTHER_MONITOR = LAUNCH_MONITOR.replace(
    "Backspin (rpm);Sidespin (rpm)", "Spin Rate (rpm);Side Spin (rpm)"
)


@pytest.mark.parametrize(
    ("monitor", "spin"),
    [(LAUNCH_MONITOR, "Backspin (rpm)"), (ANOTHER_MONITOR, "Spin Rate (rpm)")],
)
def test_the_headings_of_a_launch_monitor(monitor, spin, tmp_path):
    """Spin loft is the angle between the path of the club and the normal of its face."""
    path = tmp_path / "shots.csv"
    headings = monitor.split(";")
    rows = [";".join("1" if "(" in heading else "x" for heading in headings)] * 2
    path.write_text("\n".join([monitor, *rows]), encoding="utf-8")
    with pytest.raises(ValueError, match="look like other words") as caught:
        read_measurements(path)
    told = str(caught.value)
    assert len(headings) == 31
    assert len(told) < 1200
    names = dict(word.rsplit("=", 1) for word in shlex.split(told.partition("add ")[2])[1::2])
    assert names == {"Club Speed (mph)": "speed (mph)", "Spin Loft (deg)": "angle_deg",
                     spin: "-rebound_spin (rpm)"}  # fmt: skip
    found = read_measurements(path, columns=names)
    assert found.given["speed"].tolist() == pytest.approx([0.44704, 0.44704])
    assert found.measured["rebound_spin"] == pytest.approx(-TURN / 60.0)
    (note,) = found.notes
    ground, _, unknown = note.partition("; ")
    assert ground.startswith("left out, for they are of the ground, where the club's speed is rel")
    expected = {"Attack Angle", "Ball Speed", "Launch Angle"}
    assert expected == set(re.findall(r"(\w+ \w+) \(", ground))
    assert unknown.startswith("left out, for nothing here has such names: Date, Player, Club, ")
