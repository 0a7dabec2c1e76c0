"""Options with a unit need a scene with units: at every door, of our laws and of anybody's."""

import json
import math

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Encounter, Material, Scene, Simulation, Sphere, collide, load_path
from contactlab.cli.main import main
from contactlab.numeric.checks import quantity
from contactlab.study.posed import pose
from contactlab.study.questions import questions
from contactlab.study.work_precision import bench
from contactlab_laws.springs.law import Springs
from tests.laws.normal_laws import LinearSpring, in_si
from tests.present import of_commands

BARE = Scene.nondimensional(psi1=1.2, chi=1.4412)
STEEL = Material.named("steel")
BALL = Scene(Sphere(0.01, STEEL), Sphere(0.02, STEEL), 0.2, 1.0, 0.5)


@attrs.frozen(kw_only=True)
class Sticky(Springs):
    """Springs with an option in m that nothing uses."""

    length: float | None = quantity("m", default=None)


#: Laws whose options have a unit, given or by default: kind, name or law, options, unit.
WITH_UNITS = [
    ("normal", "jkr", {}, "J/m^2"),
    ("normal", "dmt", {"work_of_adhesion": 0.1}, "J/m^2"),
    ("normal", "thornton", {}, "m/s"),
    ("normal", "thornton", {"yield_pressure": 1e9}, "Pa"),
    ("normal", "walton_braun", {"stiffness": 1e6}, "N/m"),
    ("normal", "linear", {"stiffness": 1e6}, "N/m"),
    ("normal", "hunt_crossley", {"damping": 0.1}, "s/m"),
    ("normal", "kuwabara_kono", {"relaxation_time": 1e-6}, "is in s"),
    ("normal", "viscoelastic", {"relaxation_time": 1e-6}, "is in s"),
    ("normal", "viscoelastic", {"speed_loss": 0.02}, "(s/m)"),
    ("normal", "viscoelastic", {"restitutions": [[0.1, 0.9], [2.0, 0.8]]}, "m/s"),
    ("normal", LinearSpring, {}, "N/m"),
    ("tangential", Sticky, {"length": 1e-3}, "is in m"),
]


def laws(kind, law, options):
    """Return the simulation of a law, by name or class, beside the laws that fit it."""
    made = contactlab.create(f"{kind}.{law}", **options) if isinstance(law, str) else law(**options)
    return Simulation(**{kind: made})


@pytest.mark.parametrize(("kind", "law", "options", "unit"), WITH_UNITS)
def test_a_law_whose_option_has_a_unit_needs_a_scene_with_units(kind, law, options, unit):
    simulation = laws(kind, law, options)
    name = law if isinstance(law, str) else law.__name__
    for scene in (BARE, Scene.nondimensional(psi1=[0.5, 1.2], chi=1.0)):
        for door in (simulation.run, simulation.plan):
            with pytest.raises(ValueError, match=f"{name} needs a scene with units") as caught:
                door(scene)
            assert unit in str(caught.value)
    simulation.run(BALL).check()


@pytest.mark.parametrize(
    ("kind", "law", "options"),
    [("normal", name, {}) for name in ("linear", "walton_braun", "hunt_crossley", "viscoelastic")]
    + [("tangential", Sticky, {})],
)
def test_an_option_that_is_none_asks_for_nothing(kind, law, options):
    laws(kind, law, options).run(BARE).check()


def test_where_friction_changes_the_approach_too():
    bodies = Scene.nondimensional(psi1=0.5, chi=1.5, lam=0.1, rho=0.3)
    jkr = Simulation(normal="jkr", tangential="springs")
    with pytest.raises(ValueError, match="jkr needs a scene with units"):
        jkr.run(bodies)
    jkr.run(pose(bodies, jkr.laws)).check()


def test_no_door_of_many_or_of_paths_lets_them_in(tmp_path):
    jkr = Simulation(normal="jkr")
    parts = Scene.grid_in_parts(psi1=[0.5, 1.2], chi=[1.0, 1.4])
    doors = (
        lambda: jkr.sweep([BARE, BARE]),
        lambda: jkr.sweep([BARE], into=tmp_path / "folder"),
        lambda: jkr.sweep(parts, into=tmp_path / "parts"),
        lambda: jkr.sweep(BARE.stack([BARE, BARE]), keep=tmp_path / "kept"),
        lambda: jkr.normal_motion(BARE),
        lambda: load_path(BARE, [1e-6, 2e-6], [0.0, 1e-6], normal="jkr"),
    )
    for door in doors:
        with pytest.raises(ValueError, match="jkr needs a scene with units"):
            door()


def test_scenes_with_and_without_units_do_not_stack():
    met = Encounter(BALL.sphere, BALL.target, 0.2, normal=[1, 0, 0], velocity=[1, 0.5, 0])
    assert met.scene.has_units
    assert met.scene.has_units
    assert BALL.has_units
    assert not BARE.has_units
    assert not Scene.grid(psi1=[0.5, 1.2], chi=[1.0, 1.4]).take([0, 3]).has_units
    collide(met, Simulation(normal="jkr")).check()
    with pytest.raises(ValueError, match="must have units if, and only if"):
        Scene.stack([BARE, in_si(BARE)])


FILE = """
[nondimensional]
psi1 = 0.5
chi = 1.4412
[simulation]
normal = "jkr"
"""


def test_files_and_the_command_line_tell_it(tmp_path, capsys):
    path = tmp_path / "scene.toml"
    path.write_text(FILE, encoding="utf-8")
    several = tmp_path / "sweep.toml"
    several.write_text(FILE + "[sweep]\npsi1 = [0.2, 1.2]\n", encoding="utf-8")
    groups = ["--psi1", "0.2:5:4", "--chi", "1.4412", "--tangential", "annulus"]
    for words in of_commands(
        ["run", str(path)],
        ["sweep", str(several)],
        ["report", str(path), "--out", str(tmp_path / "page.html")],
        ["compare", str(path), "--tangential", "annulus"],
        ["compare", *groups, "--normal", "jkr"],
        ["sweep", *groups, "--normal", "jkr"],
    ):
        assert main(words) == 2, words
        assert "jkr needs a scene with units" in capsys.readouterr().err, words
    assert main(["compare", *groups, "--normal", "hertz,jkr", "--json"]) == 0
    out, err = capsys.readouterr()
    assert "jkr is left out" in err
    assert "jkr needs a scene with units" in err
    assert "jkr" not in json.dumps(json.loads(out)["laws"])


def test_scenes_are_posed_with_units_for_such_laws_alone():
    groups = Scene.nondimensional(psi1=[0.5, 1.2], chi=[1.0, 2.0], lam=0.1, rho=0.3)
    assert pose(groups, Simulation().laws) is groups
    sized = pose(groups, Simulation(normal="jkr").laws)
    assert sized.has_units
    for name in ("psi1", "chi", "lam", "eta"):
        assert getattr(sized, name) == pytest.approx(getattr(groups, name), rel=1e-12)
    alike = Simulation(tangential="springs")
    assert alike.run(sized).psi2 == pytest.approx(alike.run(groups).psi2, abs=1e-9)


@pytest.mark.slow
def test_the_benchmark_poses_them_with_units():
    laws = ["tangential.springs", "integrator.symplectic", "normal.thornton"]
    (row, *_) = bench(questions(laws), quick=True).rows
    assert row.ok
    assert math.isfinite(row.error_rms)
    assert np.isfinite(row.sweep_time_s)
