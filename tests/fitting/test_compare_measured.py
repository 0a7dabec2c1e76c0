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


@pytest.fixture
def laboratory(tmp_path):
    """A made-up laboratory: each impact at its own speed, its spin off by a known disturbance."""
    steel, speeds = Material.named("steel"), np.array([1.0, 2.5, 1.5, 3.0, 0.8, 2.0])
    noise = 100.0 * NOISE
    rows = [
        (v * np.cos(a), v * np.sin(a), Simulation().run(Scene.at_angle(
            Sphere(0.01, steel), HalfSpace(steel), 0.15, speed=v, angle_deg=np.degrees(a)
        )).rebound_spin + off)
        for v, a, off in zip(speeds, np.radians(ANGLES), noise, strict=True)
    ]  # fmt: skip
    ball, data = tmp_path / "ball.toml", tmp_path / "drops.csv"
    ball.write_text(BALL, "utf-8")
    lines = [f"{n!r},{t!r},{spin!r}" for n, t, spin in np.array(rows).tolist()]
    heads = "normal_speed (m/s),tangential_velocity (m/s),rebound_spin (rad/s)"
    data.write_text("\n".join([heads, *lines]) + "\n", "utf-8")
    return speeds, [str(ball), "--measured", str(data), "--tangential", "fronts"]


def test_speeds_and_angles_that_vary_together(laboratory, capsys):
    speeds, arguments = laboratory
    command = ["compare", *arguments]
    assert main([*command, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    (series,) = found["measured"]
    assert series["laws"]["fronts"]["rms"] == pytest.approx(1.0, rel=1e-6)
    assert (series["against"], series["x"]) == ("angle_deg", pytest.approx(ANGLES))
    assert series["beside"]["speed"] == pytest.approx(speeds)
    assert list(found["varied"]) == ["angle_deg", "speed"]
    assert main([*command, "--csv"]) == 0
    table = csv.DictReader(capsys.readouterr().out.splitlines())
    told = [float(row["speed (m/s)"]) for row in table if row["table"] == "measured"]
    assert told == pytest.approx(speeds)


@pytest.mark.parametrize(
    "impact", ["normal_speed = 1.0", "tangential_velocity = 0.1\nnormal_speed = 1.0", ""]
)
def test_a_scene_needs_no_velocity_beside_measured_ones(laboratory, capsys, impact):
    speeds, arguments = laboratory
    ball = Path(arguments[0])
    ball.write_text(BALL.replace("speed = 3.0\nangle_deg = 20.0", impact), "utf-8")
    assert main(["compare", *arguments, "--json"]) == 0
    (series,) = json.loads(capsys.readouterr().out)["measured"]
    assert series["laws"]["fronts"]["rms"] == pytest.approx(1.0, rel=1e-6)
    assert series["beside"]["speed"] == pytest.approx(speeds)


@pytest.mark.slow
def test_a_report_of_speeds_and_angles_that_vary_together(laboratory, tmp_path):
    page = tmp_path / "page.html"
    assert main(["report", *laboratory[1], "--out", str(page)]) == 0
    words = "At the measured values of angle_deg, speed, by the first law; the curves below join"
    assert words in page.read_text("utf-8")


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


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--measured", "a.csv"],
         "--measured: needs a SCENE.toml with the bodies of the experiment"),
        (["SWEEP", "--column", "a=b"],
         "--column: names headings of --measured DATA.csv, which is missing"),
        (["SWEEP", "--columns", "a,b"],
         "--columns: names headings of --measured DATA.csv, which is missing"),
        (["SWEEP", "--measured", "a.csv", "--column", "a=b", "--column", "a=c"],
         "--column: 'a' is named twice; leave out one"),
    ],
)  # fmt: skip
def test_a_refusal_is_one_line(run, short_sweep, words, told):
    ran = run("compare", *(short_sweep if word == "SWEEP" else word for word in words))
    assert (ran.status, ran.out) == (2, "")
    assert ran.err == f"contactlab compare: error: {told}\n"
