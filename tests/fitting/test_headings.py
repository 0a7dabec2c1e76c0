"""The meaning of a heading: its role, its name, and the factor to the unit of the quantity."""

import math
import re

import numpy as np
import pytest

from contactlab.fitting.csv_columns import Heading, read_columns, read_heading, read_text
from contactlab.fitting.measurements import read_measurements

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
        ("slip_restitution_error", "error", "slip_restitution", 1.0),
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
        ("qqq", "name the column by --column 'qqq=...'"),
        ("angle_error (deg)", "did you mean 'angle_deg'?"),
        ("speed (m/s", "write a name and its unit"),
        ("speed", "has no unit; write 'speed (m/s)', or (mm/s), or (cm/s)"),
        ("contact_time (min)", "is in min, which is not known here; write 'contact_time (s)'"),
        ("psi2 (m)", "write 'psi2 (1)'"),
        ("normal_restitution (in percent)", "is in percent, which is not known here"),
        ("incidence_angle", "write 'incidence_angle (deg)', or (rad)"),
        ("incidence_angle (from normal)", "write 'incidence_angle (deg)', or (rad)"),
        ("rebound_angle", "write 'rebound_angle (rad)', or (deg)"),
    ],
)
def test_a_heading_without_meaning_is_refused_with_what_to_write(text, words):
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        read_heading(text, {})
    assert str(caught.value).startswith(f"heading {text!r}: ")


def test_all_bad_headings_are_told_at_once_and_the_known_names_once():
    words = r"'qqq': .* And heading 'speed': .* And heading 'zzz'"
    with pytest.raises(ValueError, match=words) as caught:
        read_columns("qqq,speed,zzz\n1,2,3\n", {})
    assert str(caught.value).count("before the impact: ") == 1


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
    ],
)
def test_cells_and_comments(text, expected):
    """Headings may begin with # only if the line below them is one of numbers."""
    if expected is None:
        with pytest.raises(ValueError, match="needs a line of headings"):
            read_columns(text, {})
        return
    found = read_columns(text, {})
    assert list(found) == list(expected)
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name], values)


@pytest.mark.parametrize("end", ["", "# end\n"])
def test_a_last_line_does_not_tell_the_mark_of_a_table_without_headings(end):
    with pytest.raises(ValueError, match=r"^heading '1': is neither"):
        read_columns(f"1;2\n3;4\n{end}", {})


def test_a_first_column_that_no_fit_needs_may_begin_with_a_mark():
    """Of the quantities of a result, not of a measurement: it would be left out anyway."""
    found = read_columns("# status,psi2\n1,0.5\n", {})
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
