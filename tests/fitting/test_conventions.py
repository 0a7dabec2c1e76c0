"""Signs and angles of a table that nobody can tell from its headings."""

import re
import shlex
import tomllib
from pathlib import Path

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.cli.main import main
from contactlab_fit import fit, read_measurements
from tests.fitting.impacts import BODIES, scene
from tests.longer import longer

GROUPS = Scene.nondimensional(psi1=np.linspace(0.5, 5.0, 6), chi=1.4)
BALL = """[sphere]
radius = 0.01
material = "steel"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.2
speed = 1.0
angle_deg = 20.0
"""
OLD = "slip_restitution"
WALTON = "[simulation]\ntangential = 'walton'\n"
SERIES = f"""[[measured]]
quantity = "{OLD}"
against = "angle_deg"
source = "x"
x = [10.0]
values = [0.1]
"""


def read_table(heading, **columns):
    return read_measurements({"angle_deg": [20.0], heading: [-0.4]}, **columns)


#: A quantity of another meaning whose name is like the old one.
RESTITUTED = read_measurements({"angle_deg": [20.0], "normal_restitution": [0.9]})


@pytest.mark.parametrize(
    "door",
    [
        lambda: Simulation(tangential="walton").run(GROUPS).slip_restitution,
        lambda: contactlab.create("tangential.walton", slip_restitution=0.4),
        lambda: read_table("x", columns={"x": OLD}),
        lambda: fit({"psi2": np.zeros(6)}, GROUPS, simulation=Simulation(tangential="walton"),
                    parameters=[f"tangential.{OLD}"]),
        lambda: fit({"psi2": np.zeros(6)}, GROUPS, simulation=Simulation(tangential="walton"),
                    parameters=[OLD]),
        lambda: fit({"beta0": np.zeros(6)}, GROUPS, quantities=[OLD]),
        lambda: fit({"psi2": np.zeros(6)}, GROUPS, quantities=[OLD]),
        lambda: RESTITUTED.only([OLD]),
    ],
)  # fmt: skip
def test_the_old_name_is_refused_with_the_new_one_and_its_sign(door):
    words = "did you mean '(tangential.)?beta0', which is -slip_restitution in results, and the "
    with pytest.raises((AttributeError, ValueError), match=words):
        door()


@pytest.mark.parametrize(
    ("heading", "words"),
    [("beta0", ""), (OLD, "--column slip_restitution=-beta0 ")],
)
def test_errors_of_the_old_name_keep_their_size(heading, words):
    table = {"angle_deg": [20.0], heading: [-0.4], f"{OLD}_error": [0.1]}
    added = f"{words}--column {OLD}_error=beta0_error$"
    with pytest.raises(ValueError, match=added):
        read_measurements(table)
    names = dict(re.findall(r"--column (\S+?)=([\w-]+)", added))
    np.testing.assert_array_equal(read_measurements(table, columns=names).errors["beta0"], [0.1])


@pytest.mark.parametrize(
    ("text", "options"),
    [
        (SERIES, ()),
        (WALTON, ("--set", f"tangential.{OLD}=0.2")),
        (f"{WALTON}[simulation.options.tangential]\n{OLD} = 0.2\n", ()),
        ("", ("--quantity", OLD)),
    ],
)
def test_the_old_name_is_refused_by_files_and_commands(tmp_path, capsys, text, options):
    file = tmp_path / "ball.toml"
    file.write_text(BALL + text, "utf-8")
    command = "compare" if "--quantity" in options else "run"
    assert main([command, str(file), *options]) == 2
    assert "'beta0', which is -slip_restitution in results" in capsys.readouterr().err


def test_a_column_of_the_old_name_is_turned():
    with pytest.raises(ValueError, match=r"--column slip_restitution=-beta0$"):
        read_table(OLD)
    turned = read_table(OLD, columns={OLD: "-beta0"}).measured
    np.testing.assert_array_equal(turned["beta0"], [0.4])


TABLES = Path(__file__).parent / "tables"
GLASS = "[sphere]\nradius = 8e-3\nmaterial = 'soda-lime glass'\n"
NYLON = "[sphere]\nradius = 0.02\nmaterial = 'nylon'\n"
GOLF = "[sphere]\nradius = 0.02134\nmaterial = 'nylon'\n"
FLOOR = "[target]\nkind = 'half-space'\nmaterial = 'steel'\n"
CLUB = f"{FLOOR}[impact]\nangle_deg = 37.0\n"
#: A command that is printed, and the option for it that a note names.
COMMAND = re.compile(r"(?:paste: |^ +)contactlab (fit .*)$", re.MULTILINE)
OPTION = re.compile(r"\((--fit [a-z_,.]+)\)")


def printed(run, *words):
    """Return what the commands print that are printed, and so on, each run to its end.

    Every command has to run: the first of those that are printed is followed up.
    """
    ran = run(*words)
    if not ran.status:
        return ran.out
    commands = [shlex.split(text.replace("RATE", "120")) for text in COMMAND.findall(ran.err)]
    commands += [[*map(str, words), *shlex.split(text)] for text in OPTION.findall(ran.err)]
    assert commands, ran.err
    outputs = [printed(run, *command) for command in commands]
    return outputs[0]


@pytest.mark.parametrize(
    ("table", "bodies", "told"),
    [
        ("heights", NYLON + FLOOR, "0.781 at 4.43 m/s, 0.791 .* 0.796 .* 0.798 .* 0.809 at"),
        ("times", NYLON + FLOOR, "0.856 at 2.76 m/s, 0.861 .* 0.855 .* 0.859 at"),
        *longer(("marble_px", GLASS + FLOOR, r"0.45\d at 3.1 m/s, 0.42\d at 1.41")),
        *longer(("monitor", GOLF + CLUB, r"friction_coefficient +0\.\d+")),
        ("invented_friction", NYLON + FLOOR, r"and friction_coefficient 0\.3\b"),
    ],
)
def test_a_table_leads_to_its_number_by_the_commands_that_are_printed(
    run, tmp_path, table, bodies, told
):
    """Restitutions are sqrt(h2/h1), t2/t1 and of parabolas; the invented friction is 0.3."""
    scene = tmp_path / "bodies.toml"
    scene.write_text(bodies, "utf-8")
    out = printed(run, "fit", TABLES / f"{table}.csv", scene, "--bootstrap", "0")
    assert re.search(told, out), out


def test_a_monitor_tells_neither_the_density_of_a_club_nor_its_incidence(run, tmp_path):
    scene = tmp_path / "bodies.toml"
    scene.write_text(GOLF + FLOOR, "utf-8")
    told = run("fit", TABLES / "monitor.csv", scene, "--bootstrap", "0").err
    assert "density" not in told
    assert "angle_deg=" not in told
    assert "write angle_deg under [impact] of the scene" in told
    assert not COMMAND.search(told)  # none would run


def test_of_velocities_that_are_told_twice_one_pair_is_advised():
    columns = {"vx_in": [1.0], "vz_in": [2.0], "v_in": [2.236], "theta_in": [26.6], "COR": [0.9]}
    with pytest.raises(ValueError, match="for others tell the same velocities: v_in, theta_in"):
        read_measurements(columns)


SPHERES = "radius = 1.59e-3\nmaterial = 'soda-lime glass'\n"
TWO = f"[sphere]\n{SPHERES}[target]\nkind = 'sphere'\n{SPHERES}"


@pytest.mark.parametrize(
    "heading", ["beta0", *longer("e_t", "tangential coefficient of restitution")]
)
def test_glass_has_the_friction_of_its_authors_by_the_first_command(run, tmp_path, heading):
    """Foerster et al. 1994 tell 0.092 ± 0.006; with the sign turned it would be 0.51."""
    table, scene = tmp_path / "glass.csv", tmp_path / "glass.toml"
    scene.write_text(TWO, "utf-8")
    rows = [*zip(*glass(), strict=True)]
    lines = [f"{vn},{vt},{-out / vt:.6f}" for vn, vt, out in rows]
    head = f"normal_speed (m/s),tangential_velocity (m/s),{heading}"
    table.write_text("\n".join([head, *lines]), "utf-8")
    out = printed(run, "fit", table, scene, "--bootstrap", "0")
    value = float(re.search(r"friction_coefficient +(\S+)", out)[1])
    assert value == pytest.approx(0.092, abs=0.02)


def glass():
    """Return normal speed, slip before and slip after of the 24 collisions of glass."""
    path = Path(contactlab.__file__).parent / "study" / "measured" / "glass-3mm.toml"
    told = tomllib.loads(path.read_text("utf-8"))["collisions"]
    return told["normal_speed"], told["slip_velocity"], told["rebound_slip_velocity"]


SLIDING = np.linspace(40.0, 60.0, 10)


@pytest.mark.parametrize(
    ("seed", "angles"), [(2, SLIDING), *longer(*((n, SLIDING) for n in range(6)))]
)
def test_sliding_impacts_alone_whose_sign_is_turned_get_a_note(seed, angles):
    """In gross slip psi2/psi1 is 1 - mu (1 + e) (1 + 1/K²)/tan(angle): mu 0.1, scatter 0.03."""
    scatter = np.random.default_rng(seed).normal(0.0, 0.03, len(angles))
    ratio = 1.0 - 0.7 / np.tan(np.radians(angles)) + scatter
    columns = {"angle_deg": angles, "speed (m/s)": np.full(len(angles), 2.0)}
    turned = fit(columns | {"beta0": ratio}, BODIES)
    (note,) = (note for note in turned.notes if "of the opposite sign" in note)
    assert "(--column beta0=-beta0 reads it so)" in note
    assert fit(columns | {"beta0": -ratio}, BODIES)["friction_coefficient"] == pytest.approx(
        0.1, abs=0.01
    )


def test_angles_from_the_surface_are_declared():
    angles, out = np.array([10.0, 40.0]), np.array([5.0, 30.0])
    given = {"Descent (deg)": 90.0 - angles, "out": 90.0 - out, "rebound_angle_deg_error": [1, 2]}
    names = {"Descent (deg)": "angle_from_surface_deg", "out": "rebound_angle_from_surface_deg"}
    found = read_measurements(given, columns=names)
    assert found.given["angle_deg"] == pytest.approx(angles)
    assert found.measured["rebound_angle_deg"] == pytest.approx(out)
    names["out"] = "-rebound_angle_from_surface_deg"
    turned = read_measurements(given | {"out": out - 90.0}, columns=names)
    assert turned.measured["rebound_angle_deg"] == pytest.approx(out)
    radians = {"angle_from_surface (rad)": np.radians(90.0 - angles), "psi2": [1.0, 2.0]}
    assert read_measurements(radians).given["angle_deg"] == pytest.approx(angles)


def test_sizes_without_a_sign_are_fitted_as_sizes():
    """At friction 0.3 some of these slips come back, and some go on."""
    angles = np.linspace(5.0, 70.0, 12)
    columns = {"angle_deg": angles, "speed (m/s)": np.full(12, 2.0)}
    made = Simulation(tangential="fronts").sweep(scene(0.3, angles))
    assert np.ptp(np.sign(made.rebound_slip_velocity)) == 2.0
    sizes = np.abs(made.rebound_slip_velocity)
    found = fit(columns | {"|rebound_slip_velocity| (m/s)": sizes}, BODIES)
    assert found["friction_coefficient"] == pytest.approx(0.3, rel=1e-3)


@pytest.mark.parametrize(
    ("slope", "told"),
    [
        (0.003, "climbs with the angle of incidence, .* at 70 degrees; no law has more than 1"),
        (-0.002, r"falls with the angle of incidence, .*; --restitution \S+, a table"),
        (0.0, "climbs|falls"),
    ],
)
def test_a_trend_of_the_restitution_is_told_with_what_takes_it(slope, told):
    angles = np.linspace(10.0, 70.0, 13)
    e = 0.88 + slope * angles + 0.004 * np.cos(7.0 * angles)
    columns = {"angle_deg": angles, "speed (m/s)": np.full(13, 2.0), "normal_restitution": e}
    notes = " ".join(fit(columns, BODIES, parameters=["restitution"]).notes)
    assert (re.search(f"the restitution ({told})", notes) is not None) == (slope != 0.0)


@pytest.mark.slow
def test_the_trend_with_the_speed_is_taken_by_the_option_that_is_told(run, tmp_path):
    """The law has the table's e at each normal speed, and nothing of the trend is left."""
    bodies, table = tmp_path / "bodies.toml", tmp_path / "table.csv"
    bodies.write_text(NYLON + FLOOR, "utf-8")
    speeds, e = np.array([4.43, 3.96, 3.43, 2.8, 1.98]), [0.781, 0.791, 0.796, 0.798, 0.809]
    shots = speeds / np.cos(np.radians(20.0))
    rows = [f"20,{v:.4f},{one},{0.64 + one / 10}" for v, one in zip(shots, e, strict=True)]
    head = "angle_deg,speed (m/s),normal_restitution,tangential_restitution"
    table.write_text("\n".join([head, *rows]), "utf-8")
    command = ("fit", table, bodies, "--bootstrap", "0", "--fit")
    told = run(*command, "friction_coefficient,restitution").out
    option = re.search(r"falls with the normal speed.*; (--restitution \S+), a table", told)[1]
    ran = run(*command, "friction_coefficient", *option.split())
    assert "friction_coefficient" in ran.out
    assert "falls with the" not in ran.out
