"""Tables of measured impacts: which columns they keep, and a scene file that takes them in."""

import re
from pathlib import Path

import attrs
import numpy as np
import pytest

from contactlab.scene_file import read_scene
from contactlab_fit import read_measurements, with_measurements

BODIES = (
    "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nkind = 'half-space'\n"
    "material = 'steel'\n[impact]\nfriction_coefficient = 0.1\nspeed = 2.0\nangle_deg = 30.0\n"
)
ANGLES = [10.0, 20.0, 40.0]


@pytest.fixture
def bodies(tmp_path):
    def write(more=""):
        path = tmp_path / "bodies.toml"
        path.write_text(BODIES + more, encoding="utf-8")
        return read_scene(path)

    return write


def table(**columns):
    return read_measurements({"angle_deg": ANGLES, "beta0": [0.1, 0.2, 0.3]} | columns)


def test_columns_that_others_determine_are_left_out():
    speeds = {"normal_speed (m/s)": [1.0], "tangential_velocity (m/s)": [0.5]}
    groups = {"psi1": [1.0], "chi": [1.4], "psi2": [0.2]}
    found = read_measurements(
        {"angle_deg": [26.0]} | groups | speeds | {"beta0": [0.1], "#": [0.0]}
    )
    assert list(found.given) == ["normal_speed", "tangential_velocity"]
    assert list(found.measured) == ["beta0"]
    assert found.unused == ("#", "psi1", "chi", "psi2", "angle_deg")
    found = read_measurements({"speed (m/s)": [2.0], "psi1": [1.0], "beta0": [0.1]})
    assert (list(found.given), found.unused) == (["speed"], ("psi1",))
    found = read_measurements(groups)  # without velocities they are what was varied
    assert (list(found.given), list(found.measured), found.unused) == (
        ["psi1", "chi"], ["psi2"], ()
    )  # fmt: skip


def test_an_angle_beside_the_normal_speed_is_a_tangential_velocity():
    given = {"angle_deg": [45.0, -30.0], "normal_speed (m/s)": [2.0, 3.0], "psi2": [0.1, 0.2],
             "beta0": [0.1, 0.2]}  # fmt: skip
    found = read_measurements(given).given
    assert list(found) == ["normal_speed", "tangential_velocity"]
    assert found["tangential_velocity"] == pytest.approx([2.0, -np.sqrt(3.0)])


def test_a_table_without_a_file_has_no_source():
    found = table()
    assert (found.source, found.unused, len(found)) == ("", (), 3)
    assert found.only(None) is found
    assert read_measurements(found) is found


def test_impacts_with_none_of_the_chosen_quantities_are_left_out():
    gaps = {"psi2": [np.nan, 0.2, 0.3], "beta0": [0.5, np.nan, np.nan],
            "beta0_error": [0.1, 0.2, 0.3]}  # fmt: skip
    found = read_measurements({"angle_deg": ANGLES} | gaps)
    chosen = found.only(["psi2"])
    assert chosen.given["angle_deg"].tolist() == [20.0, 40.0]
    assert (list(chosen.measured), dict(chosen.errors)) == (["psi2"], {})
    both = found.only(["beta0", "psi2"])
    assert (len(both), list(both.measured)) == (3, ["beta0", "psi2"])
    words = "quantities = 'rebound_spin': was not measured; had: psi2, beta0"
    with pytest.raises(ValueError, match=re.escape(words)):
        found.only(["rebound_spin"])


def test_an_error_may_be_missing_where_nothing_was_measured():
    found = read_measurements({"psi2": [1.0, np.nan], "psi2_error": [0.1, np.nan]})
    np.testing.assert_array_equal(found.errors["psi2"], [0.1, np.nan])


def test_impacts_may_be_one_number_each():
    assert read_measurements({"psi1": 5, "psi2": 1}).measured["psi2"].tolist() == [1.0]
    with pytest.raises(ValueError, match=r"angle_deg = array\(\[nan\]\): must be a finite"):
        read_measurements({"angle_deg": [np.nan], "psi2": [1.0]})


def test_series_of_a_scene_file_stand_one_below_the_other(bodies):
    head = "[[measured]]\nsource = 'x'\nagainst = 'angle_deg'\n"
    file = bodies(
        f"{head}quantity = 'psi2'\nx = [1.0, 2.0]\nvalues = [0.1, 0.2]\n"
        f"{head}quantity = 'beta0'\nx = [3.0]\nvalues = [0.5]\n"
        f"{head}quantity = 'psi2'\nx = [4.0]\nvalues = [0.4]\n"
    )
    found = read_measurements(file)
    assert found.given["angle_deg"].tolist() == [1.0, 2.0, 3.0, 4.0]
    np.testing.assert_array_equal(found.measured["psi2"], [0.1, 0.2, np.nan, 0.4])
    np.testing.assert_array_equal(found.measured["beta0"], [np.nan, np.nan, 0.5, np.nan])
    assert (found.errors, found.source, len(found)) == ({}, str(file.path), 4)
    with pytest.raises(ValueError, match=re.escape("has no [[measured]] values; give a CSV file")):
        read_measurements(bodies())


def test_a_table_takes_the_place_of_measured_series(bodies):
    more = {"speed (m/s)": [2.0, 2.01, 2.0], "beta0_error": [0.01, 0.02, 0.03],
            "normal_restitution": [0.9, np.nan, 0.8]}  # fmt: skip
    file = with_measurements(bodies(), table(**more))
    slip, restitution = file.measured
    assert (slip.quantity, slip.against, slip.label) == (
        "beta0",
        "angle_deg",
        "measured",
    )
    assert (slip.source, slip.x.tolist(), slip.values.tolist()) == (
        "the data", ANGLES, [0.1, 0.2, 0.3]
    )  # fmt: skip
    assert slip.error.tolist() == [0.01, 0.02, 0.03]
    assert slip.x_error.tolist() == [0.0, 0.0, 0.0]
    assert (restitution.x.tolist(), restitution.values.tolist()) == ([10.0, 40.0], [0.9, 0.8])
    assert (restitution.error.tolist(), restitution.x_error.tolist()) == ([0.0] * 2, [0.0] * 2)
    assert file.varied["angle_deg"] == pytest.approx(np.arange(10.0, 40.1, 0.5))
    assert file.scene.shape == (61,)
    swept = bodies("[sweep]\nangle_deg = [1.0, 2.0]\n")
    assert with_measurements(swept, table()).varied["angle_deg"].tolist() == [1.0, 2.0]


@pytest.mark.parametrize(
    ("given", "varied"),
    [
        ({"angle_deg": [40.0, 10.0, 20.0], "speed (m/s)": [2.0, 2.5, 1.0]},
         {"angle_deg": [10.0, 20.0, 40.0], "speed": [2.5, 1.0, 2.0]}),
        ({"normal_speed (m/s)": [3.0, 4.0], "tangential_velocity (m/s)": [4.0, 3.0],
          "spin (rad/s)": [5.0, 7.0]},
         {"angle_deg": np.degrees(np.arctan([0.75, 4.0 / 3.0])), "spin": [7.0, 5.0]}),
        ({"angle_deg": [30.0, 30.0], "speed (m/s)": [2.0, 4.0], "spin (rad/s)": [5.0, 4.0]},
         {"speed": [2.0, 4.0], "spin": [5.0, 4.0]}),
        ({"angle_deg": [30.0, 30.0]}, {"angle_deg": [30.0, 30.0]}),
        ({"speed (m/s)": [-2.0, 2.0], "angle_deg": [10.0, 20.0]}, None),
    ],
)  # fmt: skip
def test_each_impact_has_the_entries_of_its_row(bodies, given, varied):
    """The abscissa is the angle, or the most spread entry; in its order the rows are a sweep."""
    count = len(next(iter(given.values())))
    made = read_measurements(given | {"beta0": np.arange(count)})
    if varied is None:
        with pytest.raises(ValueError, match=r"impact.speed = .*must be"):
            with_measurements(bodies(), made)
        return
    file = with_measurements(bodies(), made)
    for name, values in varied.items():
        assert file.varied[name] == pytest.approx(values, rel=1e-15)
    assert list(file.varied) == [*varied, *file.varied.keys() - varied]
    assert file.measured[0].against == next(iter(varied))
    again = read_measurements(file)  # each row as it was
    for name in made.given:
        expected = made.given[name]
        found = again.given.get(name)
        if found is None:
            speed, angle = again.given["speed"], np.radians(again.given["angle_deg"])
            found = speed * (np.cos(angle) if name == "normal_speed" else np.sin(angle))
        assert found == pytest.approx(expected, rel=1e-15)
    ordered = np.argsort(file.measured[0].x, kind="stable")
    at_rows = file.scene_at(**file.measured[0].entries)
    assert file.scene.normal_speed == pytest.approx(at_rows.normal_speed[ordered], rel=1e-15)
    assert file.scene.spin == pytest.approx(np.broadcast_to(at_rows.spin, count)[ordered])


def test_a_sweep_of_one_entry_beside_impacts_that_vary_in_two_is_refused(bodies):
    swept, made = bodies("[sweep]\nangle_deg = [1.0, 2.0]\n"), table(**{"speed (m/s)": [2, 2, 3]})
    words = r"angle_deg, speed vary, .*varies angle_deg; leave out .sweep."
    with pytest.raises(ValueError, match=words):
        with_measurements(swept, made)
    with pytest.raises(ValueError, match=r"no column describes the impact.*such as angle_deg"):
        with_measurements(bodies(), read_measurements({"beta0": [0.1, 0.2]}))


@pytest.mark.parametrize(("speed", "varies"), [(1.1, False), (1.11, True)])
def test_a_column_varies_by_more_than_a_tenth_of_its_mean(bodies, speed, varies):
    """From 1 to 1.1 over a mean of 1.0333: 9.7 %; to 1.11: 10.6 %."""
    file = bodies("[sweep]\nspeed = [1.0, 2.0]\n")
    made = table(**{"speed (m/s)": [1.0, 1.0, speed]})
    if varies:
        with pytest.raises(ValueError, match="angle_deg, speed"):
            with_measurements(file, made)
    else:
        assert with_measurements(file, made).measured[0].against == "angle_deg"


@pytest.mark.parametrize(("speed", "off"), [(2.2, False), (2.23, True), (1.83, False), (1.8, True)])
def test_a_scene_at_another_speed_is_refused(bodies, speed, off):
    """Beside a sweep the scene's 2 m/s is within a tenth of the measured speed, or not."""
    file = bodies("[sweep]\nangle_deg = [1.0, 2.0]\n")
    made = attrs.evolve(table(**{"speed (m/s)": [speed] * 3}), source="t.csv")
    if not off:
        assert with_measurements(file, made).measured[0].source == "t.csv"
        return
    words = f"t.csv: speed is {speed:g} m/s, and 2 m/s in {file.path}; write the measured one in"
    with pytest.raises(ValueError, match=re.escape(words)):
        with_measurements(file, made)
    alone = with_measurements(bodies(), made).scene
    assert np.hypot(alone.normal_speed, alone.tangential_velocity) == pytest.approx(speed)


def test_the_normal_speed_of_the_scene_is_its_own(bodies):
    """2 m/s at 30 degrees: 1.732 m/s towards the target."""
    columns = {"normal_speed (m/s)": [1.0, 1.0, 1.0], "tangential_velocity (m/s)": [1.0, 2.0, 3.0]}
    made = read_measurements(columns | {"beta0": [0.1, 0.2, 0.3]})
    words = "normal_speed is 1 m/s, and 1.732 m/s in"
    with pytest.raises(ValueError, match=re.escape(words)):
        with_measurements(bodies("[sweep]\nspin = [1.0, 2.0]\n"), made)


def test_only_a_file_or_a_mapping_has_headings_to_name():
    with pytest.raises(ValueError, match=re.escape("columns = {'a': 'b'}: need a CSV file, or a")):
        read_measurements(table(), columns={"a": "b"})
    words = r"measurements = 7: must be a CSV file, or a mapping of columns; of a DataFrame"
    with pytest.raises(ValueError, match=re.escape(words)):
        read_measurements(7)
    with pytest.raises(ValueError, match=re.escape(f"{Path('none.csv')}: no such file")):
        read_measurements("none.csv")
