"""A hundred wrong uses as people type them: the sentence says why, and what it says to do works.

A row has what is typed, a pattern of the sentence, and the same after its remedy.
"""

import re

import pytest

from contactlab.cli.main import main
from contactlab.scene_file import read_scene
from tests.present import of_commands

SETUP = """
import numpy as np
import contactlab
from contactlab import *

steel = Material.named("steel")
ball, plate = Sphere(0.01, steel), HalfSpace(steel)


def scene(**more):
    given = {"friction_coefficient": 0.2, "normal_speed": 1.0, "tangential_velocity": 0.5}
    return Scene(ball, plate, **{**given, **more})


def met(body=ball, **more):
    about = {"normal": [0, 0, -1], "velocity": [0.5, 0, -1]}
    if body is not ball:
        about["contact"] = [0.003, 0, -0.01]
    return Encounter(body, plate, 0.2, **{**about, **more})


def body(**more):
    given = {"mass": 1.0, "principal": [1e-4, 2e-4, 2e-4], "curvature_radius": 0.01}
    return RigidBody(material=steel, **{**given, **more})
"""

PYTHON = [
    # wrong keyword
    ("Sphere(diameter=0.02, material=steel)", "'radius', half the", "Sphere(0.01, steel)"),
    ("Material(E=2e11, poisson_ratio=0.3)", "'young_modulus'",
     "Material(young_modulus=2e11, poisson_ratio=0.3)"),
    ("Material(young_modulus=2e11, nu=0.3)", "'poisson_ratio'",
     "Material(young_modulus=2e11, poisson_ratio=0.3)"),
    ("Scene(ball, plate, mu=0.2, normal_speed=1.0)", "'friction_coefficient'",
     "Scene(ball, plate, friction_coefficient=0.2, normal_speed=1.0)"),
    ("Scene.at_angle(ball, plate, 0.2, speed=1.0, angle=30)", "'angle_deg'",
     "Scene.at_angle(ball, plate, 0.2, speed=1.0, angle_deg=30)"),
    ("met(omega=[0, 0, 10])", "'spin'", "met(spin=[0, 0, 10])"),
    ("body(I=np.eye(3), principal=None)", "'inertia'", "body(inertia=np.eye(3), principal=None)"),
    ("Simulation('hertz')", "name=value", "Simulation(normal='hertz')"),
    ("Simulation().run(scene()).psi_2", "'psi2'", "Simulation().run(scene()).psi2"),
    # an option or a number to the wrong owner
    ("Simulation(normal='hertz', restitution=0.5)", "viscoelastic takes it",
     "Simulation(normal='viscoelastic', restitution=0.5)"),
    ("Simulation(steps=100)", r"integrator=create\('integrator.symplectic', steps=100\)",
     "Simulation(integrator=create('integrator.symplectic', steps=100))"),
    ("Simulation(annuli=30)", r"tangential=create\('tangential.annulus', annuli=30\)",
     "Simulation(tangential=create('tangential.annulus', annuli=30))"),
    ("Simulation(mu=0.3)", r"Scene\(..., friction_coefficient=0.3\)",
     "Scene(ball, plate, normal_speed=1.0, friction_coefficient=0.3)"),
    ("Simulation(psi1=1.0)", r"Scene.nondimensional\(..., psi1=1.0\)",
     "Scene.nondimensional(chi=1.4, psi1=1.0)"),
    ("collide(met(), 0.9)", "by name: restitution=0.9", "collide(met(), restitution=0.9)"),
    ("collide(met(), Simulation(), restitution=0.5)",
     r"make it with normal=create\('normal.viscoelastic', restitution=0.5\)",
     "collide(met(), Simulation(normal=create('normal.viscoelastic', restitution=0.5)))"),
    ("collide(met(body()), Simulation(normal='tsuji'), restitution=0.5)",
     r"make it with normal=create\('normal.tsuji', restitution=0.5\)",
     "collide(met(body()), Simulation(normal=create('normal.tsuji', restitution=0.5)))"),
    ("collide(met(), Simulation(), restitution=lambda v: 0.5)", "leave out simulation$",
     "collide(met(), restitution=lambda v: 0.5)"),
    ("met(contact=[0, 0, -0.01])", "not to a Sphere; leave it out", "met()"),
    # misspelt law or material
    ("Simulation(normal='herz')", "'hertz'", "Simulation(normal='hertz')"),
    ("Simulation(normal='springs')", "'tangential.springs'", "Simulation(tangential='springs')"),
    ("create('sprngs')", "'tangential.springs'", "create('tangential.springs')"),
    ("create('annulus', steps=100)", "its options: annuli", "create('annulus', annuli=100)"),
    ("create('normal.tsuji', e=0.8)", "'restitution'", "create('normal.tsuji', restitution=0.8)"),
    ("Material.named('stel')", "'steel'", "Material.named('steel')"),
    ("contactlab.Box", "contactlab.shapes.box", "contactlab.shapes.box"),
    # laws that do not go together
    ("Simulation(tangential='fronts', normal='tsuji')", "tangential = springs",
     "Simulation(tangential='springs', normal='tsuji').run(scene())"),
    ("Simulation(tangential='fronts', normal='tsuji')", "use normal = hertz",
     "Simulation(tangential='fronts', normal='hertz').run(scene())"),
    ("Simulation(normal='tsuji', integrator='events')", "integrator='symplectic'",
     "Simulation(normal='tsuji', integrator='symplectic').run(scene())"),
    ("Simulation(normal='jkr', integrator='events')", "tangential='coulomb'",
     "Simulation(normal='jkr', integrator='events', tangential='coulomb')"),
    ("Simulation(tangential='springs', integrator='events')", "tangential = fronts",
     "Simulation(tangential='fronts', integrator='events').run(scene())"),
    ("Simulation(normal='tsuji', integrator='events')", "tangential='coulomb'",
     "Simulation(normal='tsuji', integrator='events', tangential='coulomb').run(scene())"),
    ("Simulation(tangential='springs', integrator='events')", "integrator = symplectic",
     "Simulation(tangential='springs', integrator='symplectic').run(scene())"),
    ("collide(met(body()), Simulation(tangential='annulus'))",
     "tangential='fronts', integrator='events'",
     "collide(met(body()), Simulation(tangential='fronts', integrator='events'))"),
    ("create('normal.viscoelastic', restitution=0.9, relaxation_time=1e-6)", "leave one out",
     "create('normal.viscoelastic', relaxation_time=1e-6)"),
    ("collide(met(body()), restitution=0)", "take at least 0.01",
     "collide(met(body()), restitution=0.01)"),
    ("Simulation(normal=create('normal.viscoelastic', restitution=0), tangential='annulus')"
     ".run(scene(tangential_velocity=0.1))", "or springs",
     "Simulation(normal=create('normal.viscoelastic', restitution=0), tangential='springs')"
     ".run(scene(tangential_velocity=0.1)).check()"),
    # wrong kind of thing
    ("Sphere(0.01, 'steel')", r"Material.named\('steel'\)",
     "Sphere(0.01, Material.named('steel'))"),
    ("Scene(ball, steel, 0.2, 1.0)", r"HalfSpace\(material\)",
     "Scene(ball, HalfSpace(steel), 0.2, 1.0)"),
    ("Simulation().run(met())", "encounter.scene", "Simulation().run(met().scene)"),
    ("collide(scene())", r"simulation.run\(scene\)", "Simulation().run(scene())"),
    ("collide([met(), met()])", "arrays of vectors", "collide(met(velocity=[[0.5, 0, -1]] * 2))"),
    ("Simulation().run(scene(), history='field')", "'fields'",
     "Simulation().run(scene(), history='fields')"),
    ("Sphere(0.01, Material(young_modulus=2e11, poisson_ratio=0.3))", r"Sphere\(mass=...\)",
     "Sphere(0.01, Material(young_modulus=2e11, poisson_ratio=0.3), mass=0.03)"),
    # wrong unit or text
    ("Material(young_modulus='200 GPa', poisson_ratio=0.3)", "give it in Pa",
     "Material(young_modulus=200e9, poisson_ratio=0.3)"),
    ("scene(spin='100 rpm')", "give it in rad/s", "scene(spin=10.47)"),
    ("create('normal.tsuji', restitution=80)", "from 0.01 to 1",
     "create('normal.tsuji', restitution=0.80)"),
    # wrong shape
    ("scene(normal_speed=[1.0, 2.0], tangential_velocity=[1.0, 2.0, 3.0])", "equal length",
     "scene(normal_speed=[1.0, 2.0, 3.0], tangential_velocity=[1.0, 2.0, 3.0])"),
    ("Scene(Sphere([0.01, 0.02], steel), Sphere([0.01, 0.02, 0.03], steel), 0.2, 1.0)",
     "equal length", "Scene(Sphere([0.01, 0.02], steel), Sphere([0.01, 0.02], steel), 0.2, 1.0)"),
    ("met(velocity=[1, 2])", "three numbers", "met(velocity=[1, 2, 0])"),
    ("rebound([1, 2], [1, 2, 3])", "one value of chi for each psi1", "rebound([1, 2], [1, 2])"),
    ("collide(met(), restitution=[0.5, 0.6])", "must be one number",
     "collide(met(), restitution=0.5)"),
    # impossible numbers
    ("rebound(1.2, 1.44, restitution=1.5)", "leave it out for 1", "rebound(1.2, 1.44)"),
    ("collide(met(velocity=[0, 0, 1]))", "turn normal",
     "collide(met(velocity=[0, 0, 1], normal=[0, 0, 1]))"),
    ("collide(met(velocity=[0, 0, -1e-160]))", "must be at least 1e-100.*separating='pass'",
     "collide(met(velocity=[0, 0, -1e-160]), separating='pass')"),
    ("collide(met(body(), velocity=[0, 0, -1e-160]))", "must be at least 1e-100",
     "collide(met(body(), velocity=[0, 0, -1e-100]))"),
    ("scene(normal_speed=1e-200)", "larger speeds or masses", "scene(normal_speed=1e-100)"),
    ("Sphere(1e-120, steel)", "radius, density = .*or give mass",
     "Sphere(1e-120, steel, mass=1e-3)"),
    ("Scene(Sphere(0.01, steel, gyration_ratio=1e-200), plate, 0.2, 1.0)",
     "gyration_ratio = 1e-200: floating point",
     "Scene(Sphere(0.01, steel, gyration_ratio=0.6), plate, 0.2, 1.0)"),
    ("body(principal=[1e-30, 1e-4, 1e-4])", "at least 1e-12 of the largest",
     "body(principal=[1e-16, 1e-4, 1e-4])"),
    ("collide(met(body(principal=[1e-30, 1e-30, 1e-30])))", "lost in rounding beside mass",
     "collide(met(body(principal=[1e-5, 1e-5, 1e-5])))"),
    ("collide(met(body(cross_radius=-0.02, curvature_axis=[1, 0, 0])))",
     r"\(\(0.01, -0.02\), inf\).*take a flatter one",
     "collide(Encounter(body(cross_radius=-0.02, curvature_axis=[1, 0, 0]), ball, 0.2, "
     "normal=[0, 0, -1], velocity=[0, 0, -1], contact=[0, 0, -0.01]))"),
    ("collide(met(body(curvature_radius=np.inf)))", "give a finite curvature_radius",
     "collide(met(body(curvature_radius=1.0)))"),
    ("body(cross_radius=0.02)", "give the direction",
     "body(cross_radius=0.02, curvature_axis=[1, 0, 0])"),
]  # fmt: skip

SCENE = """[sphere]
radius = 0.01
material = "steel"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.2
speed = 1.0
angle_deg = 30
[simulation]
"""
TOML = [
    ("radius = 0.01", "diameter = 0.02", "'radius', half the diameter", "radius = 0.01"),
    ("radius = 0.01", 'radius = "10 ms"', "give it in m", "radius = 0.010"),
    ("speed = 1.0", "", "speed: is missing", "speed = 1"),
    ('[target]\nkind = "half-space"', "[halfspace]", 'kind = "half-space"',
     '[target]\nkind = "half-space"'),
    ("friction_coefficient", "mu", "write friction_coefficient", "friction_coefficient"),
    ("angle_deg", "angle", "'angle_deg'", "angle_deg"),
    ("[impact]", "restitution = 0.8\n[impact]", r"under \[simulation\]", "[impact]"),
    ("[simulation]", "[simulation]\nsteps = 100",
     "integrator = 'symplectic' and options.integrator.steps = 100",
     "[simulation]\nintegrator = 'symplectic'\noptions.integrator.steps = 100"),
    ("[simulation]", "[simulation]\noptions.tangential.annuli = 30", "choose tangential = annulus",
     "[simulation]\ntangential = 'annulus'\noptions.tangential.annuli = 30"),
    ("[simulation]", "[simulation]\nnormal = 'tsuji'\nrestitution = 0.8",
     "leave out normal = tsuji, or restitution, and give normal.restitution = 0.8",
     "[simulation]\nnormal = 'tsuji'\noptions.normal.restitution = 0.8"),
    ("[simulation]", "[simulation]\nnormal = 'tsuji'\nintegrator = 'events'",
     "integrator='symplectic'", "[simulation]\nnormal = 'tsuji'\nintegrator = 'symplectic'"),
]  # fmt: skip

COMMANDS = [
    ("run nofile.toml", "give the path of a scene", "run s.toml"),
    ("run s.toml --tangential anulus", "'annulus'", "run s.toml --tangential annulus"),
    ("run s.toml --normal springs", "'tangential.springs'",
     "run s.toml --tangential tangential.springs"),
    ("run s.toml --tangential zzz", "contactlab plugins list", "plugins list"),
    ("plugins show anulus", "'tangential.annulus'", "plugins show tangential.annulus"),
    ("rnu s.toml", "'run'", "run s.toml"),
    ("run s.toml --normal tsuji --tangential fronts", "tangential = springs",
     "run s.toml --normal tsuji --tangential springs"),
    ("run s.toml --normal tsuji --tangential fronts", "normal = hertz",
     "run s.toml --normal hertz --tangential fronts"),
    ("run s.toml --tangential springs --integrator events", "integrator = symplectic",
     "run s.toml --tangential springs --integrator symplectic"),
    ("run s.toml --tangential springs --integrator events", "tangential = fronts",
     "run s.toml --tangential fronts --integrator events"),
    ("run s.toml --set annuli=30", "write --tangential annulus --set tangential.annuli=",
     "run s.toml --tangential annulus --set tangential.annuli=30"),
    ("run s.toml --set tangential.annuli=30", "choose tangential = annulus",
     "run s.toml --tangential annulus --set tangential.annuli=30"),
    ("run s.toml --set tangential.table=no", "must be True or False",
     "run s.toml --set tangential.table=False"),
    ("run s.toml --set tangential.table='false'", "in a scene file true or false",
     "run s.toml --set tangential.table=false"),
    ("run s.toml --normal hertz --restitution 0.8", "leave out --normal hertz",
     "run s.toml --restitution 0.8"),
    ("run s.toml --normal tsuji --restitution 0.8", "give --set normal.restitution=0.8",
     "run s.toml --normal tsuji --set normal.restitution=0.8"),
    ("run s.toml --restitution 0.8 --set normal.restitution=0.7", "leave out one of the two",
     "run s.toml --restitution 0.8"),
    ("run s.toml --psi1 1.2", "leave out the file", "run --psi1 1.2 --chi 1.44"),
    ("run b.toml --restitution 0", "take at least 0.01", "run b.toml --restitution 0.01"),
    ("run b.toml --tangential annulus", "tangential='fronts', integrator='events'",
     "run b.toml --tangential fronts --integrator events"),
    ("compare --psi1 0.5:1:2 --chi 1.4 --csv out.csv", "--out out.csv",
     "compare --psi1 0.5:1:2 --chi 1.4 --out out.csv"),
    ("bench --quick --csv out.csv", "--out out.csv",
     "bench --quick --out out.csv --time-limit 0.001"),
    ("compare --psi1 0:1:3 --chi 1:2:2", "only one may be a range",
     "compare --psi1 0:1:3 --chi 1"),
    ("compare s.toml --normal hertz --restitution 0.8", "leave out --normal hertz",
     "compare s.toml --restitution 0.8"),
    ("run --psi1 1.2", "--chi: must be given", "run --psi1 1.2 --chi 1.4412"),
    ("run --psi1 0:7 --chi 1.44", "0:7:71", "run --psi1 0:7:71 --chi 1.44"),
    ("sweep --psi1 0:1:3 --chi 1 --resume", "needs --out FILE",
     "sweep --psi1 0:1:3 --chi 1 --resume --out a.csv"),
    # names of options that are no more
    ("compare --psi1 0.5:1:2 --chi 1.4 --laws springs,annulus", "--laws is now --tangential",
     "compare --psi1 0.5:1:2 --chi 1.4 --tangential springs,annulus"),
    ("bench --quick --law coulomb", "--law is now --tangential",
     "bench --quick --tangential coulomb --time-limit 0.001"),
    ("bench --quick --law integrator.paper", "or --normal, --integrator",
     "bench --quick --integrator paper --time-limit 0.001"),
    ("stability --quick --budget 0.001", "--budget is now --time-limit",
     "stability --quick --tangential coulomb --time-limit 0.001"),
    ("run s.toml --estimate", "--estimate is now --estimate-error",
     "run s.toml --estimate-error"),
    ("run s.toml --no-estimate", "--no-estimate is now --no-estimate-error",
     "run s.toml --no-estimate-error"),
    ("explore --inertia 0.4", "--inertia is now --inertia-ratio", "explore --inertia-ratio 0.4"),
    ("sweep s.toml", "use contactlab run", "run s.toml"),
]  # fmt: skip


def tried(code):
    """Return what an expression raises, with the names that a user imports; or None."""
    names = {}
    exec(SETUP, names)
    try:
        eval(code, names)
    except (ValueError, TypeError, AttributeError) as error:
        return str(error)
    return None


@pytest.mark.parametrize(("typed", "word", "mended"), PYTHON)
def test_in_python(typed, word, mended):
    told = tried(typed)
    assert told is not None
    assert re.search(word, told), told
    assert tried(mended) is None


@pytest.mark.parametrize(("right", "typed", "word", "mended"), TOML)
def test_in_a_scene_file(tmp_path, right, typed, word, mended):
    def tried(text):
        path = tmp_path / "scene.toml"
        path.write_text(SCENE.replace(right, text, 1))
        case = read_scene(path)
        return case.laws.simulation().run(case.scene)

    with pytest.raises(ValueError, match=word):
        tried(typed)
    tried(mended).check()


BODY = """[body]
mass = 0.1
principal = [1e-5, 2e-5, 2e-5]
curvature_radius = 0.01
material = "steel"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.2
normal = [0, 0, -1]
velocity = [0.5, 0, -1]
contact = [0.003, 0, -0.01]
"""


@pytest.mark.parametrize(
    ("typed", "word", "mended"), [row for row in COMMANDS if of_commands(row[2])]
)
def test_on_the_command_line(tmp_path, monkeypatch, capsys, typed, word, mended):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text(SCENE)
    (tmp_path / "b.toml").write_text(BODY)
    assert main(typed.split()) == 2
    told = capsys.readouterr().err
    assert re.search(word, told), told
    assert main([*mended.split(), *(["--no-estimate-error"] if "run" in mended else [])]) == 0
    capsys.readouterr()
