"""What data cannot determine is refused, and the measurement that is advised would determine it."""

import re

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation
from contactlab.scene_file import read_scene
from contactlab_fit import fit, read_measurements
from tests.fitting.impacts import BODIES, restitution, table
from tests.longer import longer

STEEP = np.array([0.1, 0.2, 0.3, 0.4, 0.5])
GRAZING = np.array([55.0, 60.0, 65.0, 70.0])
SCATTER = np.array([1.0, -1.0, 0.5, -0.8, 0.7, -0.4])
ADVICE = re.compile(
    r"measure (\w+) at angles of incidence \(degrees\) from [\d.]+ to [\d.]+, best about ([\d.]+), "
    r"to determine (\w+)"
)
ANGLE = re.compile(r"about ([\d.]+)")


def scattered(angles, friction=0.1, size=0.004):
    return restitution(friction, angles) + size * SCATTER[: len(angles)]


def refused(measurements, *parameters, **options):
    with pytest.raises(ValueError, match="the data do not determine") as caught:
        fit(measurements, BODIES, parameters=parameters, **options)
    return str(caught.value)


@pytest.mark.parametrize(
    ("angles", "parameters", "missing"),
    [
        (GRAZING, ["stiffness_ratio"], "stiffness_ratio"),
        *longer((GRAZING, ["friction_coefficient", "stiffness_ratio"], "stiffness_ratio")),
        *longer(
            (STEEP, ["friction_coefficient"], "friction_coefficient"),
            (STEEP, ["stiffness_ratio", "friction_coefficient"], "friction_coefficient"),
        ),
    ],
)  # fmt: skip
def test_the_measurement_that_is_advised_determines_what_was_not(angles, parameters, missing):
    """Gross slip says nothing of stiffness, and impacts that stick next to nothing of friction."""
    told = refused(table(scattered(angles), angles), *parameters)
    assert f"do not determine {missing}:" in told
    assert ADVICE.search(told).groups()[::2] == ("tangential_restitution", missing)
    for _ in range(3):  # a parameter may then have two values, or another be missing
        angles = np.append(angles, [float(ANGLE.search(told)[1])] * 2)
        values = restitution(0.1, angles) + 0.004 * np.resize(SCATTER, len(angles))
        try:
            found = fit(table(values, angles), BODIES, parameters=parameters)
        except ValueError as error:
            told = str(error)
        else:
            break
    truth = {"friction_coefficient": 0.1, "stiffness_ratio": 14 / 17}
    for name, one in found.parameters.items():
        assert one.value == pytest.approx(truth[name], abs=3.0 * one.standard_error)
        assert one.standard_error < 0.1 * truth[name]


def test_a_law_without_the_property_is_no_help():
    laws = Simulation(tangential="coulomb")
    told = refused(table(scattered(GRAZING), GRAZING), "stiffness_ratio", simulation=laws)
    assert "no rebound of these laws depends on stiffness_ratio" in told
    assert "fix it" in told


def test_a_scene_without_bodies_is_advised_by_psi1():
    """Impacts that slip throughout say nothing of a restitution of the slip."""
    psi1 = np.linspace(8.0, 10.0, 4)
    batch = Scene.nondimensional(psi1=psi1, chi=1.4412)
    laws = Simulation(tangential="walton")
    with pytest.raises(ValueError, match=r"measure psi2 at psi1 (of|from) .*beta0"):
        fit({"psi2": laws.sweep(batch).check().psi2}, batch, parameters=["beta0"],
            simulation=laws)  # fmt: skip


def test_restitution_needs_a_measurement_of_it():
    """Rolling does not depend on the normal impulse; the normal rebound always does."""
    laws = Simulation(normal="tsuji", tangential="coulomb")
    told = refused(table(scattered(STEEP), STEEP), "normal.restitution", simulation=laws)
    assert "measure normal_restitution" in told
    assert "at any angles" in told


def test_a_quantity_that_no_parameter_moves_costs_the_others_nothing():
    """Restitution of 0.9 under an elastic law: friction is found as if it had not been measured."""
    data = table(scattered(GRAZING), GRAZING)
    more = {"normal_restitution": np.full(4, 0.9), "normal_restitution_error": np.full(4, 0.01)}
    alone, both = fit(data, BODIES), fit(data | more, BODIES)
    assert both.parameters == alone.parameters
    assert "normal_restitution: not met" in both.notes[0]
    laws = Simulation(normal="tsuji", tangential="coulomb")
    names = ["restitution", "friction_coefficient"]
    assert fit(data | more, BODIES, parameters=names, simulation=laws).notes == ()


def test_effects_that_are_alike_are_not_told_apart():
    """In gross slip only mu (1 + e) counts."""
    laws = Simulation(normal="tsuji", tangential="coulomb")
    names = ("friction_coefficient", "normal.restitution")
    told = refused(table(scattered(GRAZING), GRAZING), *names, simulation=laws)
    assert "a change of friction_coefficient and normal.restitution together" in told
    assert "measure normal_restitution" in told
    data = table(scattered(GRAZING), GRAZING) | {"normal_restitution": 0.9 + 0.01 * SCATTER[:4]}
    found = fit(data, BODIES, parameters=names, simulation=laws)
    assert found["normal.restitution"] == pytest.approx(0.9, abs=0.02)
    assert found["friction_coefficient"] == pytest.approx(0.1 * 2.0 / 1.9, rel=0.05)


@pytest.mark.slow
def test_a_single_number_of_a_quantity_needs_its_error():
    """It would be met to the last digit, whatever the others say."""
    one, three = np.array([np.nan, -120.0, np.nan]), GRAZING[:3]
    data = table(scattered(three), three) | {"rebound_spin (rad/s)": one}
    with pytest.raises(ValueError, match="rebound_spin: 1 numbers are too few"):
        fit(data, BODIES)
    known = {"rebound_spin_error (rad/s)": np.full(3, 100.0)}
    known["tangential_restitution_error"] = np.full(3, 0.004)
    assert fit(data | known, BODIES)["friction_coefficient"] == pytest.approx(0.1, abs=0.01)


def test_fewer_numbers_than_parameters():
    with pytest.raises(ValueError, match="1 measured numbers cannot determine 2 parameters"):
        fit(table([0.7], [20.0]), BODIES, parameters=["friction_coefficient", "stiffness_ratio"])


def test_as_many_numbers_as_parameters_have_no_interval_and_it_is_said():
    found = fit(table(restitution(0.1, np.array([60.0])), [60.0]), BODIES)
    one = found.parameters["friction_coefficient"]
    assert one.value == pytest.approx(0.1, abs=1e-6)
    assert np.isnan([one.standard_error, *one.interval]).all()
    assert "the scatter cannot be estimated" in str(found)


def test_two_values_that_meet_the_data_alike():
    """One impact at 25 degrees has the same e_t at two frictions; a second one tells them apart."""
    angles = np.array([25.0])
    told = refused(table(restitution(0.1, angles), angles), "friction_coefficient")
    first, second = map(
        float, re.findall(r"friction_coefficient ([\d.]+)", told.partition("as well with")[2])
    )
    assert sorted([first, second])[0] == pytest.approx(0.1, abs=1e-4)
    alike = [restitution(friction, angles)[0] for friction in (first, second)]
    assert alike[0] == pytest.approx(alike[1], abs=1e-3)
    assert abs(first - second) > 0.05
    advised = re.search(r"of about ([\d.]+): ([\d.]+) of the first, ([\d.]+) of the second", told)
    more = np.array([25.0, float(advised[1])])
    values = restitution(0.1, more)
    assert min(abs(values[1] - float(advised[k])) for k in (2, 3)) < 0.01
    assert fit(table(values, more), BODIES)["friction_coefficient"] == pytest.approx(0.1, abs=1e-5)


def test_a_law_that_is_not_that_of_the_data_ends_at_the_end_of_a_range():
    data = {"angle_deg": np.zeros(3), "speed (m/s)": np.ones(3)}
    data["normal_restitution"] = np.array([1.1, 1.2, 1.15])
    laws = Simulation(normal="tsuji", tangential="coulomb")
    found = fit(data, BODIES, parameters=["restitution"], simulation=laws)
    assert found["normal.restitution"] == pytest.approx(1.0, abs=1e-3)
    assert "end of its range, 0.01 to 1" in str(found)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"parameters": ["mu"]}, "did you mean 'friction_coefficient'"),
        ({"parameters": "friction_coefficient"}, "must be a list of names"),
        ({"parameters": []}, "must be a list of names"),
        ({"parameters": ["friction_coefficient"] * 2}, "twice"),
        ({"simulation": "coulomb"}, "simulation = 'coulomb': must be a Simulation"),
        ({"quantities": ["rebound_spin"]}, "was not measured"),
        ({"quantities": "e_t"}, "must be a list of names; write ['e_t']"),
        ({"bootstrap": -1}, "bootstrap"),
        (
            {"parameters": ["restitution"], "simulation": Simulation(tangential="coulomb")},
            "normal.viscoelastic has this option (equal damping), and so have ",
        ),
        ({"parameters": ["shear_loss"]}, "fit restitution too"),
        (
            {"parameters": ["shear_loss"], "simulation": Simulation(tangential="springs")},
            "under normal = 'viscoelastic'",
        ),
    ],
)
def test_bad_arguments(arguments, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        fit(table(scattered(GRAZING), GRAZING), BODIES, **arguments)


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"spin out": [1.0]}, "--column 'spin out=rebound_spin (rad/s)'"),
        ({"tangential_restituton": [0.5]}, "tangential_restituton=tangential_restitution"),
        ({"rebound_spin": [1.0]}, "has no unit; write 'rebound_spin (rad/s)'"),
        ({"speed (knots)": [1.0]}, "is in knots, which is not known here"),
        ({"tangential_restitution (%)": [50.0]}, "is in %"),
        ({"speed (m/s": [1.0]}, "write a name and its unit"),
        ({"angle_deg": [5.0]}, "nothing was measured"),
        ({"speed (m/s)": [2.0], "psi2": [0.3]}, "psi2 depends on friction"),
        ({"angle_deg": [5.0, 6.0], "beta0": [0.1]}, "equal length"),
        (
            {"angle_deg": [5.0], "beta0": [0.1], "beta0_error": [0.1, 0.2]},
            "beta0_error 2",
        ),
        ({"angle": [0.5], "psi2": [0.1]}, "has no unit; write 'angle (deg)', or (rad)"),
        ({"spin_rpm (rad/s)": [0.5], "psi2": [0.1]}, "spin_rpm (rad/s)=spin (rad/s)"),
        ({"beta0": [np.nan]}, "holds no number"),
        ({"beta0": [np.inf, np.nan]}, "must be finite"),
        ({"beta0": ["a"]}, "must be a list of numbers"),
        ({"beta0": [1.0], "beta0_error": [0.0]}, "must be positive"),
        ({"beta0": [1.0], "psi2_error": [0.1]}, "there is no column psi2"),
        ({"rebound_angle (deg)": [1.0], "rebound_angle_deg": [1.0]}, "there twice"),
        ({"psi2": [[0.1]]}, "must be a list of numbers"),
        ({"psi2": []}, "must be a list of numbers"),
        ({"psi2": [1.0, 2.0], "psi2_error": [0.1, np.nan]}, "must be positive"),
    ],
)
def test_bad_columns(columns, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        read_measurements(columns)


@pytest.mark.parametrize(
    ("names", "words"),
    [
        ({"anlge": "angle_deg"}, "columns = 'anlge': is not a heading; had: alpha, psi2"),
        ({"alpha": "incidence_angle"}, "heading 'alpha': has no unit"),
        ({"alpha": "rebound_spin (deg)"}, "heading 'alpha'"),
    ],
)
def test_bad_names_of_columns(names, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        read_measurements({"alpha": [1.0], "psi2": [0.5]}, columns=names)
    with pytest.raises(ValueError, match="need a CSV file"):
        read_measurements(read_measurements({"psi2": [0.5]}), columns=names)


def test_a_quotient_by_zero_is_no_measurement():
    angles = np.array([10.0, 0.0, 20.0, 30.0])
    data = table(restitution(0.12, np.maximum(angles, 1.0)), angles)
    with pytest.raises(ValueError, match=r"tangential_restitution: .* impact 2, .*leave this cell"):
        fit(data, BODIES)
    data["tangential_restitution"][1] = np.nan
    assert fit(data, BODIES)["friction_coefficient"] == pytest.approx(0.12, abs=1e-6)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "needs a line of headings"),
        ("psi2\n", "needs a line of headings"),
        (
            "psi2;angle_deg\n1;1.002,5\n",
            "line 2, 'angle_deg': '1.002,5': write numbers without marks",
        ),
        ("# made up, by hand\n1,2\n", "nothing was measured: no column describes"),
        ("# angle_deg,psi2\n1,2\n", "line 1: begins with #, which would skip"),
        ("# made up\npsi2,angle_deg\n1,2\n1\n", "line 4: has 1 columns, the headings are 2"),
        ("psi2,angle_deg\n1,2\n\n1,x\n", "line 4, 'angle_deg': 'x' is not a number"),
        ("psi2,angle_deg\n1,\n", "no impact is left; line 2 is left out: it has no number of"),
        ("psi2,angle_deg\n1_0,1\n", "line 2, 'psi2': '1_0' is not a number"),
        ("psi2,angle_deg\n1,inf\n", "line 2, 'angle_deg': 'inf' is not a number"),
        ("psi2,psi2\n1,2\n", "the same heading"),
        ("psi2,angle_deg\n0.5,1,2\n", "line 2: has 3 columns, the headings are 2"),
        ('psi2,angle_deg\n"1,002",2\n', "line 2, 'psi2': '1,002' is not a number"),
    ],
)
def test_bad_files(tmp_path, text, words):
    path = tmp_path / "bad.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=re.escape(words)) as caught:
        read_measurements(path)
    assert str(path) in str(caught.value)


def test_no_file_and_no_scene(tmp_path):
    with pytest.raises(ValueError, match="no such file"):
        read_measurements(tmp_path / "none.csv")
    with pytest.raises(ValueError, match=r"scene = None: must be given"):
        fit(table(scattered(GRAZING), GRAZING))
    with pytest.raises(ValueError, match="must be a CSV file"):
        read_measurements(7)


def test_columns_of_an_export_are_read_and_those_without_use_named(tmp_path):
    from contactlab.outcome.export import write_csv
    from tests.fitting.impacts import scene

    path = tmp_path / "export.csv"
    write_csv(Simulation().sweep(scene(0.12)), path)
    found = read_measurements(path)
    assert {"normal_speed", "tangential_velocity", "spin"} <= set(found.given)
    assert {"rebound_spin", "tangential_restitution"} <= set(found.measured)
    assert {"energy_imbalance (J)", "psi1", "psi2", "chi", "angle_deg"} <= set(found.unused)
    mu = fit(found, BODIES, quantities=["rebound_spin"])["friction_coefficient"]
    assert mu == pytest.approx(0.12, abs=1e-6)


def test_a_scene_file_needs_no_friction_and_no_velocity(tmp_path):
    path = tmp_path / "bodies.toml"
    path.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nkind = 'half-space'\n"
        "material = 'steel'\n[impact]\nnormal_speed = 7.0\n",
        encoding="utf-8",
    )
    with pytest.raises(ValueError, match="friction_coefficient: is missing"):
        read_scene(path)
    found = fit(table(restitution(0.12)), path)
    assert found["friction_coefficient"] == pytest.approx(0.12, abs=1e-6)
    assert fit(table(restitution(0.12)), str(path))["friction_coefficient"] == pytest.approx(0.12)


def test_one_angle_alone_is_advised_as_one():
    """At a friction of 0.01 the ball sticks at the smallest candidate angle alone."""
    scene = attrs.evolve(BODIES, friction_coefficient=0.01)
    with pytest.raises(ValueError, match=r"incidence \(degrees\) of about 1 to determine"):
        fit(table(restitution(0.01, GRAZING), GRAZING), scene, parameters=["stiffness_ratio"])
