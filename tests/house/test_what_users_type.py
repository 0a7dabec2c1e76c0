"""What users type, and the key words of what they are told: a line each."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import contactlab
from contactlab import Encounter, HalfSpace, Material, RigidBody, Scene, Sphere, collide, shapes
from contactlab.cli.main import main
from tests.cli.conftest import EXAMPLES

STEEL = Material.named("steel")
DOWN = np.array([0.0, 0.0, -1.0])
SCENE = """[sphere]
radius = 0.01
material = "steel"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.2
normal_speed = 1.0
"""


def met(body=None, **given):
    body = Sphere(0.01, STEEL) if body is None else body
    return Encounter(body, HalfSpace(STEEL), 0.2, normal=DOWN, velocity=DOWN, **given)


def block():
    return RigidBody(mass=1.0, inertia=np.eye(3), material=STEEL, curvature_radius=0.1)


def rod(**given):
    return shapes.rod(length=1.0, radius=0.1, material=STEEL, normal=DOWN, **given)


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        (lambda: collide(met()).rebound_velocity, "did you mean 'velocity'?"),
        (lambda: collide(met()).rebound_spin, "did you mean 'spin'?"),
        (lambda: met(block(), contact=[0, 0, 0]), "contact = [0.0, 0.0, 0.0]: is needed"),
        (lambda: met(block()), "contact = None: is needed"),
        (lambda: shapes.cube, "that body is made by shapes.box; it has box, disc"),
        (lambda: shapes.cylinder, "made by shapes.rod (rounded ends) or shapes.disc"),
        (lambda: shapes.Sphere, "made by contactlab.Sphere"),
        (lambda: contactlab.Box, "made by contactlab.shapes.box"),
        (lambda: contactlab.ball, "made by contactlab.Sphere"),
        (lambda: shapes.box(sides=[1, 1, 1], corner_radius=0.1, material=STEEL, normal=[1, 1, 1],
                            axes=Rotation.identity()), "as axes.as_matrix()"),
        (lambda: rod(axis=30), "such as [0, 0, 1], up; an angle is tilt_deg of a scene file"),
        (lambda: shapes.rod(1.0, 0.02), "write arguments as name=value; arguments: length"),
        (lambda: rod(axes=np.eye(3)), "rod: axes is not an argument; did you mean 'axis'?"),
        (lambda: rod(), "rod: axis must be given"),
        (lambda: Scene.nondimensional(psi1=[0.1, 0.1], chi=np.eye(2), lam=[9.0, 0.0], rho=1.0),
         "lam · chi⁻¹ · eta must be below 2"),
    ],
)  # fmt: skip
def test_in_python(typed, words):
    with pytest.raises((ValueError, TypeError, AttributeError)) as caught:
        typed()
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "normal_speed",
            "restitution = 0.9\nnormal_speed",
            "impact.restitution: unknown key; write it under [simulation]",
        ),
        (
            "[impact]",
            "[simulation]\nrestitution = 'high'\n[impact]",
            "simulation.restitution = 'high': is neither a number, nor",
        ),
        (
            "[impact]",
            "[simulation]\nrestitution = { v = [1.0], e = [0.9] }\n[impact]",
            "or [[0.5, 0.95], [2, 0.9]], e over the speed in m/s",
        ),
        ("0.01", "0,01", "write numbers with a point: radius = 0.01"),
        ("0.01", ".01", "write radius = 0.01"),
        ('"steel"', "steel", 'put words in quotes: material = "steel"'),
    ],
)
def test_in_toml(old, new, words, tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.replace(old, new, 1), encoding="utf-8")
    assert main(["run", str(path)]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("help", "help is an option: write contactlab --help"),
        ("version", "version is an option: write contactlab --version"),
        ("run drops.csv", "measured impacts go to contactlab fit drops.csv bodies.toml"),
        ("run --psi1 1.2 --chi 1.44 --set springs=8",
         "springs: belongs to tangential.springs: write --tangential springs --set "
         "tangential.springs=..."),
    ],
)  # fmt: skip
def test_on_the_command_line(line, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "drops.csv").write_text("angle,psi2\n1,2\n", encoding="utf-8")
    assert main(line.split()) == 2
    assert words in capsys.readouterr().err


def test_exchanged_arguments_of_a_rebound_are_told():
    with pytest.warns(UserWarning, match="exchanged"):
        contactlab.rebound(1.44, 6.0)


@pytest.mark.slow
def test_laws_that_one_reason_leaves_out_are_told_in_one_line(capsys):
    assert main(["compare", str(EXAMPLES / "foot.toml"), "--all"]) == 0
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 1
    assert "annulus, annulus mean" in told[0]
    assert "are left out: each has no answer, as friction affects the approach" in told[0]


LAW = """
import sys
from typing import ClassVar
import attrs
from contactlab.contracts import SteppedTangentialLaw
{at_once}
@attrs.frozen(kw_only=True)
class Mine(SteppedTangentialLaw):
    api_version: ClassVar[int] = 2
    def start(self, scene, normal):
        {start}
    def advance(self, state, increment, before, after):
        return None
"""


@pytest.mark.parametrize(
    ("start", "at_once", "words"),
    [
        ("sys.exit(3)", "", "Raised SystemExit: 3 (in start, line 11)"),
        pytest.param(
            "while True: pass", "", "was stopped after 0.2 s of computing", marks=pytest.mark.slow
        ),
        pytest.param(
            "return 1",
            "while True: pass",
            "did not return within 0.2 s of computing",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_a_law_that_exits_or_never_returns(start, at_once, words, tmp_path, capsys):
    path = tmp_path / "law.py"
    path.write_text(LAW.format(start=start, at_once=at_once), encoding="utf-8")
    assert main(["plugins", "check", f"{path}:Mine", "--time-limit", "0.2"]) == 1
    out, err = capsys.readouterr()
    assert words in " ".join((out + err).split())
