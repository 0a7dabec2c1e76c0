"""A restitution of 0, and any below 0.01: answered at every door, or refused with the nearest."""

import json

import numpy as np
import pytest

import contactlab
from contactlab import Encounter, RigidBody, Scene, Simulation, collide, load_path, rebound
from contactlab.cli.main import main
from contactlab.scene_file import read_scene
from tests.collisions.test_collision import BALL
from tests.solve.test_eccentric import FLOOR, STEEL, rod

SCENE = "[nondimensional]\npsi1 = {psi1}\nchi = {chi}\n[simulation]\n{law}\n"
PSI1, CHI = 1.7, 1.3


def clay(e=0, **options):
    return Simulation(normal=contactlab.create("normal.viscoelastic", restitution=e), **options)


def by_law(folder, psi1, chi, e):
    return clay(e).run(Scene.nondimensional(psi1=psi1, chi=chi))


def by_sweep(folder, psi1, chi, e):
    return clay(e).sweep([Scene.nondimensional(psi1=psi1, chi=chi)])


def by_file(law):
    def run(folder, psi1, chi, e):
        path = folder / "scene.toml"
        path.write_text(SCENE.format(psi1=psi1, chi=chi, law=law.format(e=e)))
        case = read_scene(path)
        return case.laws.simulation().run(case.scene)

    return run


def by_sphere(folder, psi1, chi, e):
    """Of a sphere of that chi, by kappa and K."""
    return collide(_met(folder, psi1, chi), restitution=e).result


def by_body(folder, psi1, chi, e):
    met = _met(folder, psi1, chi)
    ball = met.body
    inertia = ball.gyration_ratio**2 * ball.mass * ball.radius**2 * np.eye(3)
    body = RigidBody(mass=ball.mass, inertia=inertia, material=STEEL, curvature_radius=ball.radius)
    about = {"normal": met.normal, "velocity": met.velocity, "contact": (0, 0, -ball.radius)}
    return collide(Encounter(body, FLOOR, 0.2, **about), restitution=e).result


def _met(_, psi1, chi):
    kappa = 2.0 * (1.0 - STEEL.poisson_ratio) / (2.0 - STEEL.poisson_ratio)
    gyration = (2.0 * chi / kappa - 1.0) ** -0.5
    ball = contactlab.Sphere(0.01, STEEL, gyration_ratio=gyration)
    velocity = (psi1 * 0.2 / kappa, 0.0, -1.0)
    return Encounter(ball, FLOOR, 0.2, normal=(0, 0, -1), velocity=velocity)


DOORS = {
    "law": by_law,
    "sweep": by_sweep,
    "file": by_file("restitution = {e}"),
    "option": by_file("normal = 'viscoelastic'\noptions.normal.restitution = {e}"),
    "sphere": by_sphere,
    "body": by_body,
}


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("e", [0, 0.0, 0.004])
def test_every_door_answers_as_rebound_does(door, e, tmp_path):
    result = DOORS[door](tmp_path, PSI1, CHI, e).check()
    assert np.squeeze(result.psi2) == pytest.approx(rebound(PSI1, CHI, restitution=e), abs=1e-12)
    assert np.squeeze(result.normal_restitution) == e
    assert abs(np.squeeze(result.energy.imbalance)) < 1e-12
    assert "0.01" not in str(result.plan).replace("below 0.01", "")


def test_a_table_or_a_function_of_the_speed_reaches_zero(tmp_path):
    """e = 0.8 - 0.4 v: impacts below 0.01 are apart from those above, which are as alone."""
    speed = np.array([0.5, 1.0, 1.98, 2.0])
    scene = Scene(BALL, FLOOR, 0.2, speed, 0.3)
    table = [[0.0, 0.8], [2.0, 0.0]]
    laws = Simulation(normal=contactlab.create("normal.viscoelastic", restitutions=table))
    e = 0.8 - 0.4 * speed
    for result in (laws.run(scene), laws.sweep(scene)):
        assert result.normal_restitution == pytest.approx(e, abs=1e-7)
        expected = rebound(scene.psi1[2:], scene.chi, restitution=e[2:])
        assert result.psi2[2:] == pytest.approx(expected, abs=1e-9)
        for k in range(4):
            assert laws.run(scene.take(k)).psi2 == pytest.approx(result.psi2[k], abs=1e-7)
    fifth = contactlab.create("normal.viscoelastic", speed_loss=0.5)
    assert Simulation(normal=fifth).run(Scene(BALL, FLOOR, 0.2, 32.0, 9.0)).normal_restitution == 0


@pytest.mark.parametrize("words", [["--restitution", "0"], ["--restitution", "0.5:0.9,1:0"]])
def test_the_command_line_takes_zero(words, tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nkind = 'half-space'\n"
        "material = 'steel'\n[impact]\nfriction_coefficient = 0.2\nnormal_speed = 1.0\n"
        "tangential_velocity = 0.3\n[simulation]\n"
    )
    assert main(["run", str(path), *words, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    expected = rebound(told["psi1"], told["chi"], restitution=0)
    assert told["psi2"] == pytest.approx(expected, abs=1e-12)
    assert told["normal_restitution"] == 0


def test_laws_that_answer_whole_impacts_take_clay():
    """The impulse of gross slip is mu M v1, rigid or not."""
    for name in ("springs", "coulomb", "walton", "stronge"):
        result = clay(0, tangential=name).run(Scene(BALL, FLOOR, 0.05, 1.0, 5.0))
        assert result.psi2 == pytest.approx(result.psi1 - 2.0 * result.scene.chi, rel=1e-12)


SPHERE = Scene(BALL, FLOOR, 0.2, 1.0, 0.1)
PATH = SPHERE, np.full(9, 1e-6), np.linspace(0.0, 1e-6, 9)
REFUSED = [
    ("a march", lambda e: clay(e, tangential="annulus").run(SPHERE), "under annulus"),
    ("a history", lambda e: clay(e).run(SPHERE, history=True), "with a history"),
    ("a path", lambda e: load_path(*PATH, normal=clay(e).normal), "along a path"),
    ("bodies", lambda e: collide(rod(-35.0, slip=0.3), restitution=e), "followed in steps"),
    ("laws of bodies", lambda e: collide(rod(-35.0, slip=0.3), clay(e)), "followed in steps"),
    ("tsuji", lambda e: contactlab.create("normal.tsuji", restitution=e), "from 0.01 to 1"),
    ("linear", lambda e: contactlab.create("normal.linear", restitution=e), "from 0.01 to 1"),
]


@pytest.mark.parametrize(("ask", "why"), [row[1:] for row in REFUSED], ids=[r[0] for r in REFUSED])
def test_what_a_march_alone_could_answer_is_refused_with_the_nearest(ask, why):
    for e in (0, 0.004):
        with pytest.raises(ValueError, match=rf"restitution = {e}.*0.01.*{why}|{why}"):
            ask(e)
    ask(0.01)
