"""Mistakes that many make on the command line, each told what to write."""

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
