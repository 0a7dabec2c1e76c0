"""Mistakes that many make on the command line, each told what to write."""

import shlex

import pytest

from contactlab.cli.main import main

SCENE = """
[sphere]
radius = 0.01
young_modulus = 208e9
poisson_ratio = 0.3
[target]
material = "steel"
[impact]
friction_coefficient = 0.2
normal_speed = 1.0
"""


def told(capsys, *arguments):
    """Return what a refused command prints."""
    try:
        status = main([*map(str, arguments)])
    except SystemExit as left:
        status = left.code
    assert status == 2
    return capsys.readouterr().err


def test_a_number_of_the_material_written_under_the_sphere(tmp_path, capsys):
    path = tmp_path / "ball.toml"
    path.write_text(SCENE, "utf-8")
    words = told(capsys, "run", path)
    assert "sphere.young_modulus" in words
    assert "a number of the material: write it under [sphere.material]" in words


@pytest.mark.parametrize("command", ["run", "sweep", "compare"])
@pytest.mark.parametrize("written", ["0-7", "0..7", "0 to 7", "0:7", "0,7"])
def test_a_range_written_otherwise(command, written, capsys):
    words = told(capsys, command, "--psi1", written, "--chi", "1.44")
    assert "a range is START:STOP:COUNT, 0:7:71" in words


def test_words_are_no_range(capsys):
    assert (
        "START" not in told(capsys, "sweep", "--psi1", "steep", "--chi", "1.44").split("usage")[0]
    )


def test_headings_in_other_words_are_told_with_a_command_that_runs(tmp_path, capsys):
    table, bodies = tmp_path / "mine.csv", tmp_path / "bodies.toml"
    rows = "10,3.9,6.7,a\n20,3.9,12.2,b\n30,3.9,21.8,c\n39,3.9,32.6,d\n50,3.9,45,e\n"
    table.write_text(f"angle (deg),v_in,angle_out,note\n{rows}", encoding="utf-8")
    bodies.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nmaterial = 'steel'\n"
        "kind = 'half-space'\n", encoding="utf-8"
    )  # fmt: skip
    told_so = told(capsys, "fit", table, bodies, "--bootstrap", 0)
    assert told_so.count("\n") == 1
    command = shlex.split(told_so.partition("paste: contactlab ")[2])
    assert command[:5] == ["fit", str(table), str(bodies), "--bootstrap", "0"]
    assert command[5:] == [
        "--column",
        "v_in=speed (m/s)",
        "--column",
        "angle_out=rebound_angle_deg",
    ]
    assert main(command) == 0
    assert "note: left out, for nothing here has such names: note" in capsys.readouterr().out


def test_a_missing_friction_is_told_where_to_find(tmp_path, capsys):
    bodies = tmp_path / "bodies.toml"
    bodies.write_text(
        '[sphere]\nradius = 0.01\nmaterial = "steel"\n[target]\nkind = "half-space"\n'
        'material = "steel"\n[impact]\nspeed = 2.0\nangle_deg = 30.0\n',
        encoding="utf-8",
    )
    assert main(["run", str(bodies)]) == 2
    told = capsys.readouterr().err
    assert "write friction_coefficient = ...: a number such as 0.2" in told
    assert "contactlab fit" in told


def test_the_page_to_play_with_has_a_name_of_its_own(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["explore"]) == 0
    assert capsys.readouterr().out == "explore.html\n"
    assert (tmp_path / "explore.html").exists()
