"""Types say the truth: to readers of a signature, and to the type checkers of users."""

import inspect
import re
import subprocess
import sys
from typing import get_args

import pytest

import contactlab
from contactlab.cli.guide import pages as guide_pages
from contactlab.cli.guide import text
from contactlab.registration.names import PROJECT
from contactlab.registry.named_laws import IntegratorName, NormalName, TangentialName
from contactlab.registry.registry import REGISTRY
from tests.present import ROOT, needs_sources

BLOCKS = re.compile(r"```python\n(.*?)```", re.DOTALL)
#: Both checkers as a user runs them. Functions of dask have no types, classes of pooltool are
#: not known, and libraries of examples need not be installed.
CHECKERS = {
    "mypy": (
        "-m", "mypy", "--strict", "--no-error-summary", "--no-pretty", "--hide-error-context",
        "--untyped-calls-exclude=dask", "--untyped-calls-exclude=distributed",
        "--allow-subclassing-any",
    ),
    "pyright": ("-m", "pyright", "--pythonpath", sys.executable),
}  # fmt: skip
#: Libraries that examples need, and their folders.
LIBRARIES = ("jax", "pooltool", "pymunk", "torch", "yade")
FOLDERS = ("lammps", "pooltool", "recipes", "yade")
#: Arguments of a function, and of them names and annotations: every function here is annotated.
ARGUMENTS = re.compile(r"\bdef \w+\((.*?)\) ->", re.DOTALL)
ARGUMENT = re.compile(r"(?:^|[,(\s])\*{0,2}[a-z_]\w*: (.*?)(?=,\s*\*{0,2}[a-z_]\w*: |$)", re.DOTALL)
#: A type under another name that is Any, or has Any in it.
ALIAS = re.compile(r"^([A-Z]\w*)(?:: TypeAlias)? = (?!TypeVar).*\bAny\b", re.MULTILINE)
IMPORT = re.compile(r"^from (contactlab\S+) import (\([^)]*\)|.*)", re.MULTILINE)
#: Most arguments whose type is Any, also in part or by an alias: 16 of 1000.
MOST_ANY = 110
#: Locals and returns that are Any, and the most of both together.
LOCAL_OR_RETURN = re.compile(r": Any =|-> Any\b")
MOST_UNKNOWN = 67
ERROR = re.compile(r"(\w+)\.py:(\d+)(?::\d+)?(?: -)?:? error: ")
#: A program of a user: a checker must refuse the lines that end with "# refused", and no other.
PROGRAM = """
import math
from typing import Any, assert_type

import attrs
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

import contactlab as cl
from contactlab.collisions.gathered import GatheringResult
from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, Sphere, collide, rebound

Array = NDArray[np.float64]
steel = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850)
ball, plane = Sphere(0.01, steel), HalfSpace(steel)
scene = Scene.at_angle(ball, plane, friction_coefficient=0.2, speed=1.0, angle_deg=30, spin=20.0)
simulation = Simulation(normal="hertz", tangential="springs")
result = simulation.run(scene).check()
assert_type(steel, Material[float])
assert_type(ball, Sphere[float])
assert_type(plane, HalfSpace[float])
assert_type(scene, Scene[float])
assert_type(scene.psi1 + scene.lam + scene.normal_speed, float)
assert_type(Scene(ball, plane, {0.1: 0.3, 2.0: 0.2}, 1, 2), Scene[float])
assert_type(Scene(Sphere([0.01, 0.02], steel), plane, 0.2, 1.0), Scene[Array])
soft = HalfSpace(Material(young_modulus=[1e9, 2e9], poisson_ratio=0.3))
assert_type(Scene(ball, soft, 0.2, 1.0), Scene[Array])
assert_type(attrs.evolve(scene, spin=3.0), Scene[float])
assert_type(attrs.evolve(ball, mass=3.0), Sphere[float])
assert_type(attrs.evolve(plane, material=steel), HalfSpace[float])
evolved: Scene = attrs.evolve(scene, spin=np.linspace(0.0, 1.0, 3))
assert_type(evolved.take(0), Scene)
assert_type(simulation.run(evolved).psi2, Any)
assert_type(result, cl.ImpactResult[float])
column = pd.Series([1.0, 2.0])
assert_type(Scene.nondimensional(psi1=column, chi=1.44), Scene[Array])
assert_type(Sphere(column, steel), Sphere[Array])
assert_type(cl.create("tangential.annulus", annuli=60), cl.TangentialLaw)
assert_type(cl.create("normal.viscoelastic", restitution=0.9), cl.NormalLaw)
assert_type(cl.create("integrator.symplectic"), cl.Integrator)
Simulation(normal=cl.create("tangential.springs"))  # refused
Simulation(tangential=cl.create("integrator.adaptive"))  # refused
cl.create("normal.hertz").springs  # refused
many = simulation.sweep(Scene.grid(chi=[1.2, 1.4412], psi1=np.linspace(0, 6, 25)))
assert_type(many.check()[1:], cl.ImpactResult[Array])
assert_type(many.psi2, Array)
assert_type(many.energy.start, Array)
assert_type(many.status, NDArray[np.object_])
assert_type(result.status, cl.Status)
assert_type(many.to_dataframe(), pd.DataFrame)
assert_type(many.to_xarray(), xr.Dataset)
assert_type(simulation.sweep(scene, into="here").to_dataframe("psi2"), pd.DataFrame)
told: cl.ImpactResult[float] = simulation.run(scene)
assert_type(told.psi2, float)
assert_type(told.energy, cl.EnergyLedger[float])
assert_type(result.psi2, float)
assert_type(result.impulse, Array)
one: float = result.psi2 + result.psi1 * 2
edge: float = (4.0 / 3.0 * math.pi * ball.radius**3 * round(ball.mass, 3)) ** (1 / 3)
assert_type(simulation.run(Scene.grid(chi=[1, 2], psi1=[1, 2])).psi2, Array)
rows: list[tuple[float, float]] = [(each.psi1, each.psi2) for each in many]
print(round(result.psi2, 3), f"{result.psi2:.3f}", max(result.psi2, 0.0), abs(result.psi2) < 1)
print(math.degrees(result.rebound_angle), result.rebound_speed**2, round(result.motion.duration, 9))
print(round(result.normal_restitution, 3), result.normal_velocity < 0, result.rebound_spin / 2)
print(result.energy.friction_work / result.energy.start, result.status is cl.Status.SUCCESS)
print((many.status == cl.Status.SUCCESS).all(), many.psi2[many.psi2 < 0].max(), many[3].psi2)
print(min(many, key=lambda each: each.psi2), np.degrees(many.local_rebound_angle).reshape(2, 25))
print(simulation.run(scene, estimate_error=True).psi2_error_estimate < 1e-4, result.run_time + 1)
plt.plot(many.psi1, many.psi2)
plt.plot([result.psi1], [result.psi2], "o")
told.psi2.shape  # refused
told.status.shape  # refused
many.status.name  # refused
frame: str = many.to_dataframe()  # refused
labelled: int = many.to_xarray()  # refused
many.to_dict().psi2  # refused
many.psi2.is_integer()  # refused
result.psi2.shape  # refused
simulation.run(Scene.nondimensional(psi1=1, chi=2)).psi2[0]  # refused
simulation.run(Scene.nondimensional(psi1=[1, 2], chi=2)).psi2.is_integer()  # refused
scene.psi1.shape  # refused
scene.normal_speed[0]  # refused
ball.mass.shape  # refused
result.psi3  # refused
assert_type(rebound(1.2, 1.44), float)
assert_type(rebound(1, 1.44, restitution=np.float32(0.9)), float)
assert_type(rebound(np.linspace(0, 4, 5), 1.44), Array)
assert_type(rebound([1, 2], 1.44), Array)
assert_type(rebound(1.2, (1.44, 1.2)), Array)
assert_type(rebound(1.2, 1.44, restitution=[0.9, 0.8]), Array)
assert_type(rebound(1.2, 1.44, derivatives=True), tuple[float, float, float])
assert_type(rebound(1.2, 1.44, derivatives=True, restitution=0.9)[3], float)
assert_type(rebound([1.2], 1.44, derivatives=True), tuple[Array, Array, Array])
met = Encounter(ball, plane, 0.1, normal=[1, 0, 0], velocity=[2, 0, 0])
hit = collide(met)
assert_type(hit.velocity, Array)
print(round(hit.friction_work, 3), hit.normal_velocity < 0, hit.velocity @ hit.spin, hit.impulse[0])
print(hit.energy.start + 1, hit.status is cl.Status.SUCCESS, hit.result.psi2[0], hit.spin.tolist())
hit.speed  # refused
assert_type(hit, cl.Collision)
assert_type(hit.to_dataframe(), pd.DataFrame)
assert_type(hit.result, cl.ImpactResult)
hit.status.psi2  # refused
pair = [cl.Body(ball, velocity=[1, 0, 0]), cl.Body(ball)]
both = collide(cl.Gathering(pair, [cl.Touch(0, 1, 0.0, normal=[1, 0, 0])]))
assert_type(both, GatheringResult)
assert_type(both.to_dataframe("contacts"), pd.DataFrame)
assert_type(both.to_xarray(), xr.Dataset)
both.to_dataframe("touches")  # refused
both.speeds  # refused
both.status.shapes  # refused
assert_type(rebound(column, 1.44), "pd.Series[float]")
assert_type(rebound(1.2, column, restitution=0.9), "pd.Series[float]")
rebound(column, "1.44")  # refused
Encounter(ball, plane, [0.1, 0.2], normal=(1, 0, 0), velocity=np.array([2, 0, 0]))
collide(met, restitution=lambda speed: 1 - 0.1 * speed)
Scene.grid(chi=[1.2, 1.4412], psi1=np.linspace(0, 6, 25))
Scene.nondimensional(psi1=[1, 2], chi=1.4412, rho=None)
Simulation(tangental="springs")  # refused
Simulation(normal=3)  # refused
Sphere("0.01", steel)  # refused
rebound("1.2", 1.44)  # refused
rebound(None, 1.44)  # refused
Encounter()  # refused
Encounter(ball, plane, 0.1, normal=[1, 0, 0])  # refused
Sphere()  # refused
Sphere(0.01, steel, 0.1)  # refused
HalfSpace()  # refused
Material()  # refused
Scene()  # refused
Scene.at_angle()  # refused
Scene.at_angle(ball, plane, 0.2, speed=1.0)  # refused
ball.radius = 0.02  # refused
"""


@pytest.mark.parametrize(
    "name",
    [
        "Body",
        "Encounter",
        "Gathering",
        "HalfSpace",
        "RigidBody",
        "Scene",
        "Sphere",
        "Touch",
    ],
)
def test_the_arguments_that_a_class_states_are_those_it_takes(name):
    made = getattr(contactlab, name)
    stated = list(inspect.signature(made).parameters.values())
    taken = list(inspect.signature(made.__attrs_init__, follow_wrapped=False).parameters.values())
    assert made.__init__.__wrapped__ is not made.__attrs_init__
    assert [(one.name, one.kind, one.default) for one in stated] == [
        (one.name, one.kind, one.default) for one in taken[1:]
    ]


@pytest.mark.parametrize(
    ("made", "shown"),
    [
        (contactlab.Sphere, "radius: 'Numbers', material: 'Material', *, mass: 'Numbers | None'"),
        (contactlab.Encounter, "*, normal: 'Numbers', velocity: 'Numbers', spin: 'Numbers' = (0.0"),
        (contactlab.Material, "shear_modulus: 'Numbers | None' = None, young_modulus: 'Numbers |"),
        (REGISTRY.law_class("tangential.annulus"), "*, annuli: 'int' = 50, displacement: 'str'"),
        (REGISTRY.law_class("normal.hunt_crossley"), "restitution: 'Numbers"),
    ],
)
def test_a_signature_shows_types_and_defaults(made, shown):
    assert shown in str(inspect.signature(made))


def untyped():
    """Return (file, annotation) of every argument with Any in its type, and the number of all."""
    folders = (ROOT / "contactlab", ROOT / "plugins")
    sources = {path: path.read_text("utf-8") for each in folders for path in each.rglob("*.py")}
    modules = {path: ".".join(path.with_suffix("").parts) for path in sources}
    aliases = {(modules[path], name) for path in sources for name in ALIAS.findall(sources[path])}
    found, number = [], 0
    for path, code in sources.items():
        own = {"Any", *ALIAS.findall(code)}
        for module, names in IMPORT.findall(code):
            imported = re.findall(r"\w+", names)
            own |= {name for at, name in aliases if at.endswith(module) and name in imported}
        for arguments in ARGUMENTS.findall(code):
            annotations = ARGUMENT.findall(arguments)
            number += len(annotations)
            found += [(path, each) for each in annotations if own & {*re.findall(r"\w+", each)}]
    return found, number


@needs_sources
def test_few_arguments_have_no_type():
    found, number = untyped()
    assert number > 4500
    assert 0 < len(found) <= MOST_ANY, found


@needs_sources
def test_few_locals_and_returns_have_no_type():
    folders = (ROOT / "contactlab", ROOT / "plugins")
    sources = {path: path.read_text("utf-8") for each in folders for path in each.rglob("*.py")}
    found = [path for path, code in sources.items() for _ in LOCAL_OR_RETURN.findall(code)]
    assert 0 < len(found) <= MOST_UNKNOWN, found


def programs():
    """Yield the code of each page, of the README and of the site, and each example, by name."""
    pages = {name: text(name) for name in guide_pages()}
    pages |= {"README": (ROOT / "README.md").read_text("utf-8")}
    pages |= {"site": (ROOT / ".ci" / "site" / "index.md").read_text("utf-8")}
    for name, page in pages.items():
        if blocks := BLOCKS.findall(page):
            yield f"{name.replace('-', '_')}_page", "\n".join(blocks)
    examples = ROOT / "examples"
    for path in (*examples.glob("*.py"), *examples.glob("third_party_*/**/*.py")):
        if not path.stem.startswith(("test_", "__")):
            yield path.stem, path.read_text("utf-8")
    for folder in FOLDERS:  # scripts that import each other; two folders have one of the same name
        scripts = {path.stem: path.read_text("utf-8") for path in (examples / folder).glob("*.py")}
        beside = re.compile(rf"^from ({'|'.join(scripts)}) import", re.MULTILINE)
        for name, code in scripts.items():
            yield f"{folder}_{name}", beside.sub(rf"from {folder}_\1 import", code)


def test_checkers_know_the_kind_of_every_law_that_comes_with_the_package():
    kinds = NormalName, TangentialName, IntegratorName
    named = {name for kind in kinds for name in get_args(kind)}
    own = {info.name for info in REGISTRY.installed() if info.distribution == PROJECT}
    assert own <= named  # a folder of plugins may be taken out
    assert all(name.startswith(("normal.", "tangential.", "integrator.")) for name in named)


@needs_sources
@pytest.mark.slow
@pytest.mark.parametrize("checker", CHECKERS)
def test_a_checker_takes_what_is_printed_and_refuses_what_fails(checker, tmp_path):
    pytest.importorskip(checker)
    written = {"program": PROGRAM, **dict(programs())}
    assert len(written) > 55
    for name, code in written.items():
        (tmp_path / f"{name}.py").write_text(code, encoding="utf-8")
    skipped = "ignore_missing_imports = True\nfollow_imports = skip\n"
    # the law of the README is written as short as it can be: that of the guide has types
    settings = "[mypy-README_page]\ndisallow_untyped_defs = False\n[mypy]\n" + "".join(
        f"[mypy-{name}.*]\n{skipped}" for name in LIBRARIES
    )
    (tmp_path / "mypy.ini").write_text(settings, encoding="utf-8")
    (tmp_path / "pyrightconfig.json").write_text('{"reportMissingImports": false}', "utf-8")
    told = subprocess.run(
        [sys.executable, *CHECKERS[checker], *(f"{name}.py" for name in written)],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    lines = enumerate(PROGRAM.splitlines(), 1)
    refused = {("program", str(number)) for number, line in lines if line.endswith("# refused")}
    found = {match.groups(): match.string for match in map(ERROR.search, told.stdout.splitlines())
             if match}  # fmt: skip
    assert [line for place, line in found.items() if place not in refused] == []
    assert refused <= set(found), told.stdout + told.stderr
