"""Signs and angles of a table that nobody can tell from its headings."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.cli.main import main
from contactlab_fit import fit, read_measurements

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


@pytest.mark.parametrize(
    "door",
    [
        lambda: Simulation(tangential="walton").run(GROUPS).slip_restitution,
        lambda: contactlab.create("tangential.walton", slip_restitution=0.4),
        lambda: read_table("x", columns={"x": OLD}),
        lambda: fit({"psi2": np.zeros(6)}, GROUPS, simulation=Simulation(tangential="walton"),
                    parameters=[f"tangential.{OLD}"]),
        lambda: fit({"beta0": np.zeros(6)}, GROUPS, quantities=[OLD]),
    ],
)  # fmt: skip
def test_the_old_name_is_refused_with_the_new_one_and_its_sign(door):
    words = "did you mean '(tangential.)?beta0', which is -slip_restitution in results, and the "
    with pytest.raises((AttributeError, ValueError), match=words):
        door()


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
