"""Laws beside measured impacts of a CSV, with headings of the user's own."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.cli.main import main

ANGLES = np.array([5.0, 12.0, 20.0, 33.0, 47.0, 61.0])
NOISE = np.array([0.01, -0.01, 0.01, -0.01, 0.01, -0.01])
BALL = """
[sphere]
radius = 0.01
material = "steel"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.15
speed = 3.0
angle_deg = 20.0
"""


@pytest.fixture
def files(tmp_path):
    """A scene without a sweep, and impacts of the exact law with a known disturbance."""
    steel = Material.named("steel")
    scene = Scene.at_angle(Sphere(0.01, steel), HalfSpace(steel), 0.15, speed=3.0, angle_deg=ANGLES)
    restitution = Simulation().run(scene).tangential_restitution + NOISE
    data = tmp_path / "drops.csv"
    with data.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(["impact angle [deg]", "e_t measured", "remark"])
        writer.writerows(zip(ANGLES, restitution, range(6), strict=True))
    ball = tmp_path / "ball.toml"
    ball.write_text(BALL, "utf-8")
    return ball, data


COLUMNS = (
    "--column", "impact angle [deg]=angle_deg",
    "--column", "e_t measured=tangential_restitution",
    "--column", "remark=#",
)  # fmt: skip


def test_the_distance_of_a_law_is_the_disturbance(files, capsys):
    ball, data = map(str, files)
    laws = ("--tangential", "fronts,coulomb", "--json")
    assert main(["compare", ball, "--measured", data, *COLUMNS, *laws]) == 0
    (series,) = json.loads(capsys.readouterr().out)["measured"]
    assert series["quantity"] == "tangential_restitution"
    assert series["laws"]["fronts"]["rms"] == pytest.approx(0.01, rel=1e-3)
    assert series["laws"]["coulomb"]["rms"] > 0.02


def test_a_picture_shows_laws_over_the_measured_range(files, tmp_path, capsys):
    ball, data = map(str, files)
    figure = tmp_path / "laws.png"
    command = ["compare", ball, "--measured", data, *COLUMNS, "--figure", str(figure)]
    assert main(command) == 0
    assert figure.stat().st_size > 10_000
    assert "tangential restitution" in capsys.readouterr().out.replace("_", " ")


def test_a_heading_of_ones_own_without_a_name_is_told_how_to_name_it(files, capsys):
    ball, data = map(str, files)
    assert main(["compare", ball, "--measured", data]) == 2
    assert "--column 'impact angle [deg]=angle_deg'" in capsys.readouterr().err


def test_what_is_missing_is_named(files, capsys):
    ball, data = map(str, files)
    assert main(["compare", "--measured", data]) == 2
    assert "needs a SCENE.toml" in capsys.readouterr().err
    assert main(["compare", ball, "--column", "a=b"]) == 2
    assert "--measured DATA.csv, which is missing" in capsys.readouterr().err
    assert not Path("a").exists()
