"""A restitution in a scene file and on the command line: one loss for pressure and shear."""

import json

import pytest

from contactlab.cli.main import main
from contactlab.contracts import shares_loss
from contactlab.scene_file import read_scene

SCENE = """
[nondimensional]
psi1 = 1.2
chi = 1.4
[simulation]
"""


def write(folder, *lines):
    path = folder / "scene.toml"
    path.write_text(SCENE + "\n".join(lines))
    return path


def test_a_restitution_is_the_viscoelastic_law(tmp_path):
    path = write(tmp_path, "restitution = 0.7")
    by_key = read_scene(path).laws.simulation()
    lines = ("normal = 'viscoelastic'", "options.normal.restitution = 0.7")
    assert by_key == read_scene(write(tmp_path, *lines)).laws.simulation()
    assert by_key.normal.restitution == 0.7
    assert shares_loss(by_key.tangential, by_key.normal)
    elastic = read_scene(write(tmp_path, "restitution = 1.0")).laws.simulation()
    assert "elastic_hertz" in elastic.normal.offers


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        (("restitution = 0.7", "normal = 'tsuji'"), "and give normal.restitution = 0.7"),
        (("restitution = 1.2",), "restitution = 1.2.*from 0 to 1"),
        (("restitution = 'high'",), "simulation.restitution"),
    ],
)
def test_bad_restitutions_are_refused(tmp_path, lines, told):
    with pytest.raises(ValueError, match=told):
        read_scene(write(tmp_path, *lines))


def test_the_command_line_replaces_the_law_of_a_file(tmp_path, capsys):
    path = str(write(tmp_path, "normal = 'tsuji'"))
    assert main(["run", path, "--restitution", "0.5", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["normal_restitution"] == pytest.approx(0.5, abs=1e-9)
    assert main(["run", path, "--restitution", "0.5", "--normal", "tsuji"]) == 2
    assert "leave out --normal tsuji" in capsys.readouterr().err
