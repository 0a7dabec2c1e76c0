"""A restitution that depends on the speed: by a function, and by a table."""

import json

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create
from contactlab.cli.main import main

STEEL = Material.named("steel")
SPEEDS = np.array([0.1, 0.5, 2.0])
SCENE = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.1, SPEEDS, 0.2 * SPEEDS)
TABLE = [[0.1, 0.97], [1.0, 0.9], [4.0, 0.6]]
FILE = """
[sphere]
radius = 0.01
material = "steel"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.1
normal_speed = 0.5
tangential_velocity = 0.1
[simulation]
restitution = {}
"""


@pytest.mark.parametrize(
    ("options", "e"),
    [
        ({"speed_loss": 0.06}, 1.0 - 0.06 * SPEEDS**0.2),
        ({"restitutions": TABLE}, np.array([0.97, 0.97 - 0.07 * 0.4 / 0.9, 0.8])),
        ({"speed_loss": 0.0}, np.ones(3)),
    ],
)
def test_each_impact_rebounds_with_the_e_of_its_speed(options, e):
    """Beside a restitution of its own for each impact, which a table answers."""
    result = Simulation(normal=create("normal.viscoelastic", **options)).sweep(SCENE).check()
    np.testing.assert_allclose(result.normal_restitution, e, rtol=1e-6)
    expected = contactlab.rebound(SCENE.psi1, SCENE.chi, restitution=e)
    np.testing.assert_allclose(result.psi2, expected, atol=2e-3)


@pytest.mark.parametrize(
    ("written", "words", "e"),
    [
        ('"1 - 0.06 v^(1/5)"', "1-0.06*v^0.2", 1.0 - 0.06 * 0.5**0.2),
        (str(TABLE), "0.1:0.97,1:0.9,4:0.6", 0.97 - 0.07 * 0.4 / 0.9),
        ("0.8", "0.8", 0.8),
    ],
)
def test_the_same_in_toml_and_on_the_command_line(written, words, e, tmp_path, capsys):
    path, plain = tmp_path / "scene.toml", tmp_path / "plain.toml"
    path.write_text(FILE.format(written), encoding="utf-8")
    plain.write_text(FILE.partition("[simulation]")[0], encoding="utf-8")
    for command in ([str(path)], [str(plain), "--restitution", words]):
        assert main(["run", *command, "--json", "--no-estimate-error"]) == 0
        found = json.loads(capsys.readouterr().out)
        assert found["normal_restitution"] == pytest.approx(e, rel=1e-6)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("1 - v^2", "write 0.9, 1 - 0.02 v^(1/5), or 0.5:0.95,2:0.9"),
        ("1 - 0.9 v^(1/5)", "speed_loss = 0.9: must be one number from 0 to 0.5"),
        ("0.1:0.9,0.4:0.8", "an impact has 0.5 m/s; add its e to the table"),
        ("0.4:0.9,0.1:0.8", "must have speeds that increase"),
        ("0.1:0.9", "must be two or more pairs"),
        ("0.1:0.9,1:2", "must have e from 0 to 1"),
    ],
)
def test_what_is_no_function_of_the_speed(words, told, tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(FILE.partition("[simulation]")[0], encoding="utf-8")
    assert main(["run", str(path), "--restitution", words]) == 2
    assert told in capsys.readouterr().err


def test_two_losses_are_refused():
    with pytest.raises(ValueError, match="only one of them may be given"):
        create("normal.viscoelastic", speed_loss=0.02, restitution=0.9)
