"""Scene files of several contacts at once: what they mean, what is refused, what commands write."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest

from contactlab import Simulation, collide, read_scene
from contactlab.cli.main import main

CUSHION = Path(__file__).parents[2] / "examples" / "cushion.toml"
QUICK = ["--set", "tangential.springs=12", "--set", "integrator.steps=50"]
ROW = """
[bodies.first]
radius = 0.01
material = "steel"
velocity = [1, 0, 0]

[bodies.second]
radius = 0.01
material = "steel"

[[touches]]
first = "first"
second = "second"
friction_coefficient = 0.1
normal = [1, 0, 0]
"""


@pytest.fixture
def scene(tmp_path):
    """Return a function that writes a scene file."""

    def write(text):
        path = tmp_path / "scene.toml"
        path.write_text(text)
        return path

    return write


def run(capsys, *arguments):
    """Return status, output and errors of a command."""
    status = main([*map(str, arguments)])
    told = capsys.readouterr()
    return status, told.out, told.err


def test_a_file_means_what_the_words_mean(scene):
    from tests.collisions.gathered import laws

    file = read_scene(scene(ROW))
    hit = collide(file.gathering, laws(12, 50))
    assert file.gathering.names == ("first", "second")
    assert file.materials == ("steel",)
    assert hit["second"].velocity[0] == pytest.approx(1.0, abs=1e-6)
    with pytest.raises(ValueError, match="gathering"):
        Simulation().run(file.scene)


def test_the_cushion_of_the_examples_carries_the_weight():
    given = read_scene(CUSHION).gathering
    assert [each.loaded for each in given.touches] == [False, True]
    assert [each.restitution for each in given.touches] == [0.98, 0.5]


def test_a_run_prints_a_row_for_each_body_and_contact(scene, capsys, tmp_path):
    out, history, figure = (tmp_path / name for name in ("out.csv", "history.csv", "force.png"))
    options = ["--out", out, "--history", history, "--figure", figure]
    status, told, errors = run(
        capsys, "run", scene(ROW), "--tangential", "springs", *QUICK, *options
    )
    assert (status, errors) == (0, "")
    assert all(word in told for word in ("first", "second", "touches[0]", "computed: contacts"))
    rows = list(csv.DictReader(out.read_text().splitlines()))
    assert [row["body"] for row in rows] == ["first", "second", ""]
    assert [row["contact"] for row in rows] == ["", "", "touches[0]"]
    assert float(rows[1]["velocity_x (m/s)"]) == pytest.approx(1.0, abs=1e-6)
    assert float(rows[2]["impulse_x (N s)"]) < 0.0
    course = list(csv.DictReader(history.read_text().splitlines()))
    forces = [float(row["normal_force (N)"]) for row in course]
    assert max(forces) == pytest.approx(float(rows[2]["maximum_force (N)"]))
    assert figure.stat().st_size > 1000


def test_json_has_bodies_contacts_energy_and_plan(scene, capsys):
    status, told, _ = run(capsys, "run", scene(ROW), "--json", "--tangential", "springs", *QUICK)
    content = json.loads(told)
    assert status == 0
    assert [row["body"] for row in content["bodies"]] == ["first", "second"]
    assert content["contacts"][0]["touches"] == 1.0
    assert content["energy"]["start"] > content["energy"]["end"] > 0.0
    assert content["plan"]["computed"]


def test_a_sweep_varies_speeds_and_gaps(scene, capsys, tmp_path):
    out = tmp_path / "out.json"
    swept = "\n[sweep]\nbodies.first.speed = [0.5, 1.0, 2.0]\ntouches.0.gap = [0, 1e-6, 0]\n"
    path = scene(ROW + swept)
    status, told, _ = run(capsys, "sweep", path, "--out", out, "--tangential", "springs", *QUICK)
    assert status == 0
    assert "gathering" in told
    rows = json.loads(out.read_text())["bodies"]
    speeds = [row["velocity_x"] for row in rows if row["body"] == "second"]
    np.testing.assert_allclose(speeds, [0.5, 1.0, 2.0], rtol=1e-4)


FLAT = """
[bodies.box]
shape = "flat_box"
sides = [0.1, 0.1, 0.04]
corner_radius = 0.003
reach = 1e-4
tilt_deg = 0.005
normal = [0, 0, -1]
material = "steel"
velocity = [0, 0, -1]

[bodies.floor]
kind = "half-space"
material = "steel"

[[touches]]
first = "box"
second = "floor"
friction_coefficient = 0.3
restitution = 0.8
"""


def test_a_shape_that_lands_flat_has_its_contacts(scene):
    given = read_scene(scene(FLAT)).gathering
    assert len(given.touches) == 4
    gaps = [each.gap for each in given.touches]
    lever = 0.094 * np.sin(np.radians(0.005))
    np.testing.assert_allclose(gaps, [0.0, 0.0, lever, lever], atol=1e-12)
    assert {each.restitution for each in given.touches} == {0.8}
    np.testing.assert_allclose([each.contact[2] for each in given.touches], -0.02, atol=1e-5)
    rod = FLAT.replace("flat_box", "flat_rod").replace("sides = [0.1, 0.1, 0.04]", "length = 0.2")
    rod = rod.replace("corner_radius = 0.003", "radius = 0.01\naxis = [1, 0, 0]")
    assert len(read_scene(scene(rod)).gathering.touches) == 2
    tipped = FLAT.replace('"flat_box"', '"box"').replace("reach = 1e-4\n", "")
    tipped = tipped.replace("tilt_deg = 0.005", "tilt_deg = 20\ncrown_radius = 1.0")
    assert len(read_scene(scene(tipped)).gathering.touches) == 1


@pytest.mark.parametrize(
    ("before", "after", "word"),
    [
        ("normal = [0, 0, -1]\n", "", "bodies.box.normal: is missing"),
        ("reach = 1e-4\n", "", "bodies.box.reach: is missing"),
        ('"flat_box"', '"cube"', "flat_box, flat_rod"),
        ("friction", "gap = 1e-6\nfriction", "touches.0.gap: follows from the shape"),
    ],
)
def test_a_shape_refuses_what_it_cannot_be(scene, before, after, word):
    with pytest.raises(ValueError, match=re.escape(word)):
        read_scene(scene(FLAT.replace(before, after, 1)))


#: What is written in place of what, and a word of the refusal.
REFUSED = {
    "an unknown key": ("normal =", "normall =", "touches.0.normall"),
    "an unknown body": ('second = "second"', 'second = "secnd"', "'secnd'"),
    "an unknown kind": ("radius = 0.01", 'kind = "cube"\nradius = 0.01', "bodies.first.kind"),
    "no normal": ("normal = [1, 0, 0]", "", "touches.0.normal"),
    "a list of radii": ("radius = 0.01", "radius = [0.01, 0.02]", "[sweep]"),
    "beside a sphere": ("[bodies.first]", "[sphere]\nradius = 1\n[bodies.first]", "sphere"),
    "nothing approaches": ("velocity = [1,", "velocity = [-1,", "nothing approaches"),
    "no such entry": ("[[touches]]", "[sweep]\nradius = [1, 2]\n[[touches]]", "sweep.radius"),
    "no such touch": ("[[touches]]", "[sweep]\ntouches.3.gap = [1, 2]\n[[touches]]", "touches.3"),
    "no such body": ("[[touches]]", "[sweep]\nbodies.x.speed = [1, 2]\n[[touches]]", "bodies.x"),
    "a body at rest": (
        "[[touches]]", "[sweep]\nbodies.second.speed = [1, 2]\n[[touches]]", "direction",
    ),
    "an unknown material": ('"steel"', '"steal"', "steel"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_refusal_names_file_and_key(scene, capsys, case):
    before, after, word = REFUSED[case]
    status, _, errors = run(capsys, "run", scene(ROW.replace(before, after, 1)))
    assert status == 2
    assert word in errors
    assert "scene.toml" in errors


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["run", "--stick-slip", "map.png"], "--stick-slip"),
        (["run", "--restitution", "0.5"], "--restitution"),
        (["run", "--out", "out.npz"], ".csv"),
        (["sweep"], "contactlab run"),
        (["compare"], "gathering"),
    ],
)
def test_commands_of_one_contact_say_so(scene, capsys, arguments, word, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    status, _, errors = run(capsys, arguments[0], scene(ROW), *arguments[1:])
    assert status == 2
    assert word in errors


@pytest.mark.slow
def test_a_failure_is_the_status_and_a_sentence(scene, capsys):
    """A ball between two walls that close never comes free."""
    wedge = ROW + '\n[bodies.wall]\nkind = "half-space"\nmaterial = "steel"\n'
    for target in (-1, 1):
        wedge += (
            '\n[[touches]]\nfirst = "second"\nsecond = "wall"\nfriction_coefficient = 0.0\n'
            f"normal = [{target}, 1e-3, 0]\ntarget_velocity = [{-target}, 0, 0]\n"
        )
    status, _, errors = run(capsys, "run", scene(wedge), "--tangential", "springs", *QUICK)
    assert status == 1
    assert "The contacts still close" in errors
