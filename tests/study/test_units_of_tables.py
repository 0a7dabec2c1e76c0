"""No table, file or figure names a unit of length or time for a scene that has none."""

import re
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from contactlab import Scene, Simulation
from contactlab.cli.main import main
from contactlab.outcome.columns import unit_in
from contactlab.scene_file import read_scene
from contactlab.study.comparison import compare
from contactlab.study.comparison_figure import differences, laws_over_sweep

#: Quantities with the units m/s and rad/s of bodies, and an angle.
QUANTITIES = "rebound_slip_velocity,rebound_spin,local_rebound_angle_deg"
UNITS = re.compile(r"m/s|rad/s|\bkg\b|\(m\)|\(s\)|\(J\)|\(N\)")
BALL = Path(__file__).parents[2] / "examples" / "steel_ball.toml"
LAWS = ("--tangential", "coulomb,fronts")
MEASURED = """
[nondimensional]
chi = 1.0
[sweep]
psi1 = [1.0, 6.0]
[[measured]]
quantity = "rebound_slip_velocity"
against = "psi1"
source = "made up"
x = [6.0, 7.0]
values = [2.1, 2.9]
"""


@pytest.fixture
def without_units(tmp_path):
    path = tmp_path / "measured.toml"
    path.write_text(MEASURED, encoding="utf-8")
    return path


def test_only_angles_have_a_unit_without_bodies():
    ball = read_scene(BALL).scene
    bare = Scene.nondimensional(psi1=1.0, chi=1.0)
    units = ("m/s", "rad/s", "deg", "rad", "1", "J")
    assert [unit_in(unit, bare) for unit in units] == ["1", "1", "deg", "rad", "1", "1"]
    assert [unit_in(unit, ball) for unit in units] == list(units)


@pytest.mark.parametrize(
    "command",
    [
        ("run", "--psi1", "1.2", "--chi", "1.44"),
        ("compare", "--psi1", "1.2", "--chi", "1.44", *LAWS, "--quantity", QUANTITIES),
        ("compare", "--psi1", "1:3:3", "--chi", "1.44", *LAWS, "--quantity", QUANTITIES),
        ("compare", "--psi1", "1:3:3", "--chi", "1.44", *LAWS, "--quantity", QUANTITIES, "--csv"),
    ],
    ids=lambda command: " ".join(command[:3:2]) + command[-1][:6],
)
def test_a_command_names_no_unit_without_bodies(command, capsys):
    assert main([*command]) == 0
    out = capsys.readouterr().out
    assert not UNITS.search(out)
    if "compare" in command:
        assert "rebound_slip_velocity" in out


@pytest.mark.parametrize("form", [(), ("--csv",), ("--json",)])
def test_measured_values_have_no_unit_without_bodies(form, without_units, capsys):
    assert main(["compare", str(without_units), *LAWS, *form]) == 0
    out = capsys.readouterr().out
    assert "made up" in out or form == ("--csv",)
    assert not UNITS.search(out)


def test_axes_name_no_unit_without_bodies(without_units):
    compared = compare(read_scene(without_units), {"coulomb": Simulation(tangential="coulomb")})
    for draw in (laws_over_sweep, differences):
        for agreement in (None, *compared.agreements):
            axes = draw(Figure().subplots(), compared, "rebound_slip_velocity", agreement)
            assert not UNITS.search(axes.get_xlabel() + axes.get_ylabel())
    axes = Figure().subplots()
    compared.runs[0].result.plot("psi1", "rebound_slip_velocity", axes=axes)
    assert not UNITS.search(axes.get_xlabel() + axes.get_ylabel())


def test_the_same_tables_name_the_units_of_a_ball(capsys):
    command = ["compare", str(BALL), *LAWS, "--quantity", QUANTITIES]
    assert main(command) == 0
    out = capsys.readouterr().out
    assert "m/s" in out
    assert "rad/s" in out
