"""run, sweep, compare and animate of bodies for which friction changes the approach."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import contactlab
from contactlab import Scene, Simulation, read_scene
from tests.longer import longer
from tests.present import of_commands
from tests.short_animations import shorten

EXAMPLES = Path(__file__).parents[2] / "examples"
FOOT = EXAMPLES / "foot.toml"
PLANE = "[nondimensional]\npsi1 = {psi1}\nchi = 0.764706\nlam = 0.222692\neta = 2.037707\n"
SPACE = (
    "[nondimensional]\npsi1 = [0.823529, 1.647059]\nchi = [[0.624398, 0], [0, 0.828930]]\n"
    "lam = [-0.212817, 0]\nrho = 0.109286\n"
)
#: psi1, V2 and psi2 of theory §14.
ROWS = ((0.0, -0.914173623, -2.052451847), (1.372549, -0.826117112, -2.441775292))


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "scene.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.mark.parametrize(("psi1", "rate", "psi2"), ROWS)
def test_run_answers_the_rods_of_the_theory(run, file, tmp_path, psi1, rate, psi2):
    out = tmp_path / "out.json"
    ran = run("run", file(PLANE.format(psi1=psi1)), "--json", "--out", out)
    assert ran.status == 0
    for told in (json.loads(ran.out), json.loads(out.read_text())):
        assert told["normal_velocity"] == pytest.approx(rate, abs=1e-6)
        assert told["psi2"] == pytest.approx(psi2, abs=2e-6)
    assert f"{rate:.4f}"[:-1] in run("run", file(PLANE.format(psi1=psi1))).out


def test_a_sweep_is_written_and_read_back(run, file, tmp_path):
    path = file(PLANE.format(psi1=0.0) + "[sweep]\npsi1 = [0.0, 1.372549]\n")
    table, arrays = tmp_path / "s.csv", tmp_path / "s.npz"
    assert run("sweep", path, "--out", table, "--figure", tmp_path / "s.png").status == 0
    assert run("run", path, "--out", arrays).status == 0
    rows = [*csv.DictReader(table.read_text(encoding="utf-8").splitlines())]
    with np.load(arrays) as kept:
        for place, (psi1, rate, psi2) in enumerate(ROWS):
            row = rows[place]
            assert float(row["psi1 (1)"]) == pytest.approx(psi1)
            assert float(row["normal_velocity (1)"]) == pytest.approx(rate, abs=1e-6)
            assert kept["psi2"][place] == pytest.approx(psi2, abs=2e-6)
            assert row["status"] == "SUCCESS"


@pytest.mark.slow
@pytest.mark.parametrize("sweep", ["", "[sweep]\npsi1 = [0.5, 1.0]\n"])
@pytest.mark.parametrize("scene", ["central", "plane", "space"])
def test_comparisons_are_drawn(run, file, tmp_path, scene, sweep):
    """Forces of single impacts, of a length in space; curves of a sweep."""
    text = {"central": "[nondimensional]\npsi1 = 1.0\nchi = 0.8\n", "space": SPACE}
    if scene == "space":
        sweep = sweep.replace("psi1 = [0.5, 1.0]", "rho = [0.1, 0.2]")
    path, figure = file(text.get(scene, PLANE.format(psi1=1.0)) + sweep), tmp_path / "c.png"
    ran = run("compare", path, "--figure", figure)
    assert ran.status == 0, ran.err
    with Image.open(figure) as image:
        assert np.asarray(image).std() > 0.0


def test_run_tells_both_bodies_as_collide_does(run, tmp_path):
    after = contactlab.collide(read_scene(FOOT).encounter)
    history = tmp_path / "h.csv"
    ran = run("run", FOOT, "--json", "--history", history, "--figure", tmp_path / "f.png")
    told = json.loads(ran.out)["collision"]
    for name in ("velocity", "spin", "impulse"):
        assert told[name] == pytest.approx(getattr(after, name), abs=1e-12)
    rows = [*csv.DictReader(history.read_text(encoding="utf-8").splitlines())]
    assert float(rows[-1]["normal_velocity (m/s)"]) == pytest.approx(-1.0336, abs=1e-3)
    assert max(float(row["normal_force (N)"]) for row in rows) == pytest.approx(
        float(after.result.motion.maximum_force), rel=0.01
    )


def test_compare_has_a_row_for_each_law_and_says_why_not_the_others(run, file, tmp_path):
    picture = tmp_path / "foot.png"
    ran = run(
        "compare", FOOT, "--tangential", "fronts,springs,annulus,coulomb", "--json",
        "--figure", picture,
    )  # fmt: skip
    laws = json.loads(ran.out)["laws"]
    assert [*laws] == ["fronts", "springs", "coulomb"]
    rigid = Simulation(tangential="coulomb").run(read_scene(FOOT).scene)
    told = laws["coulomb"]["values"]["normal_restitution"]
    assert told == pytest.approx(rigid.normal_restitution)
    springs, fronts = (laws[name]["values"]["psi2"] for name in ("springs", "fronts"))
    assert springs == pytest.approx(fronts, abs=1e-3)
    assert "left out: has no answer" in ran.err
    assert picture.stat().st_size > 1000
    shown = run("compare", file(SPACE), "--tangential", "springs,coulomb").out.splitlines()
    assert [line.split()[0] for line in shown[-2:]] == ["springs", "coulomb"]
    assert "0.9535" in next(line for line in shown if line.startswith("normal_restitution"))
    swept = file(PLANE.format(psi1=0.0) + "[sweep]\npsi1 = [0.0, 1.372549]\n")
    assert run("compare", swept).out.splitlines()[-1].split()[0] == "coulomb"


@pytest.mark.slow
def test_a_law_that_has_no_answer_is_refused_with_one_that_has(run, file):
    ran = run("run", file(SPACE), "--tangential", "fronts")
    assert ran.status == 2
    assert "springs" in ran.err
    damped = run("run", file(PLANE.format(psi1=0.0)), "--normal", "tsuji", "--json")
    expected = Simulation(normal="tsuji", tangential="springs", integrator="symplectic").run(
        Scene.nondimensional(psi1=0.0, chi=0.764706, lam=0.222692, eta=2.037707)
    )
    assert json.loads(damped.out)["psi2"] == pytest.approx(expected.psi2)


@pytest.mark.parametrize("integrator", ["symplectic", "events"])
def test_an_integrator_alone_has_the_friction_law_that_it_marches(run, file, integrator):
    psi1, _, psi2 = ROWS[1]
    ran = run("run", file(PLANE.format(psi1=psi1)), "--integrator", integrator, "--json")
    assert json.loads(ran.out)["psi2"] == pytest.approx(psi2, abs=1e-3)


@pytest.mark.parametrize(
    ("command", "word"),
    of_commands(
        (("run", FOOT, "--stick-slip", "m.png"), "springs for any body"),
        (("fit", FOOT, "drops.csv"), "along = [x, y, z]"),
        (("animate", EXAMPLES / "sweep.toml", "--out", "m.gif"), "single impact"),
    ),
)
def test_what_is_for_spheres_says_so(run, tmp_path, monkeypatch, command, word):
    monkeypatch.chdir(tmp_path)
    Path("drops.csv").write_text(
        "speed (m/s),angle_deg (deg),rebound_angle_deg (deg)\n1,10,5\n1,20,12\n1,30,20\n"
    )
    ran = run(*command)
    assert ran.status == 2
    assert word in ran.err
    assert ran.err.count("\n") == 1


@pytest.mark.parametrize(("frames", "least"), [(8, 5_000), *longer((108, 50_000))])
def test_animate_draws_the_body_and_the_ghost(frames, least, run, tmp_path, monkeypatch):
    if frames == 8:
        shorten(monkeypatch)
    out = tmp_path / "foot.gif"
    ran = run("animate", FOOT, "--ghost", "coulomb", "--out", out)
    assert ran.status == 0
    assert out.read_bytes()[:6] == b"GIF89a"
    assert out.stat().st_size > least
    with Image.open(out) as picture:  # first touch and separation each are two frames alike
        assert max(frames // 2, 6) <= picture.n_frames <= frames - 2


@pytest.mark.slow
def test_animate_draws_an_impact_of_numbers(run, tmp_path, monkeypatch):
    shorten(monkeypatch)
    scene, out = tmp_path / "scene.toml", tmp_path / "m.gif"
    scene.write_text("[nondimensional]\npsi1 = 1.0\nchi = 1.5\nlam = 0.4\neta = 0.4\n")
    assert run("animate", scene, "--out", out).status == 0
    assert out.read_bytes()[:6] == b"GIF89a"


def test_velocities_stand_before_the_numbers_of_the_theory(run, file):
    """And the size of the contact has one value, in the table and in the caution."""
    rod = (
        '[body]\nshape = "rod"\nlength = 0.1\nradius = 0.01\ntilt_deg = 30\n'
        'material = "steel"\n[target]\nkind = "half-space"\nmaterial = "steel"\n[impact]\n'
        "friction_coefficient = 0.3\nvelocity = [5.0, 0.0, -40.0]\nnormal = [0, 0, -1]\n"
    )
    told = run("run", file(rod)).out
    lines = told.splitlines()
    places = [
        next(place for place, line in enumerate(lines) if line.split()[:1] == [word])
        for word in ("velocity", "spin", "chi", "lam", "psi2", "computed:")
    ]
    assert places == sorted(places)
    (size,) = (line.split()[-2] for line in lines if "over R, C (9)" in line)
    (caution,) = (line for line in lines if "a/R = " in line)
    assert float(size) == pytest.approx(float(caution.partition("a/R = ")[2][:5]), rel=5e-3)
    assert "caution:  " not in told
