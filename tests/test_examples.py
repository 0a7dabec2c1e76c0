"""Every example runs, and says what its text claims."""

from __future__ import annotations

import json
import os
import re
import runpy
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import contactlab
from contactlab.cli.main import main

EXAMPLES = Path(__file__).parents[1] / "examples"
PLUGIN = EXAMPLES / "third_party_plugin"

FIGURES = tuple(f"figure-{number}.png" for number in range(1, 5))
BEYOND = tuple(
    f"beyond-{name}"
    for name in (
        *("experiment.png", "finite-elements.png", "map.png"),
        *("vectors.gif", "vectors.png"),
    )
)
TWO_BODIES = ("any_two_bodies.png", "thousand_poses.png")
#: Script, a word it prints, and the picture or pictures it writes.
SCRIPTS = {
    "one_impact": ("psi2 = -0.4", "one_impact.png"),
    "law_swap": ("exact -0.1805 paper -0.1855 rigid 0.0000", "law_swap.png"),
    "sweep": ("1000 impacts", "sweep.png"),
    "experiment": ("coulomb  rms 0.046", "kharaz2001.png"),
    "stick_slip_map": ("100% of the springs", "stick_slip_map.png"),
    "custom_law": ("mindlin cap", "custom_law.png"),
    "reproduce_the_paper": ("least psi2 = -1.48 at psi1 = 3.61", FIGURES),
    "fit_your_experiment": ("exact          friction 0.0932, rms residual 0.012", "fit.png"),
    "sweep_on_a_cluster": ("the same to the last bit as here: True", "sweep_on_a_cluster.png"),
    "billiards": ("does not add up: ", "billiards.gif"),
    "throw_of_billiard_balls": ("20°  0.45 m/s   4.41°    2.98°", "throw_of_billiard_balls.png"),
    "granular_gas": ("elastic spheres", "granular_gas.png"),
    "superball": ("at most 0.59 of its velocity", "superball.png"),
    "beyond_the_paper": ("one-way coupling: 0.021 from the finite elements (rms)", BEYOND),
    "hysteresis": ("Mindlin and Deresiewicz: 0.1310", "hysteresis.png"),
    "egg": ("after 1, 5, 10 bounces: [0.888", "egg.png"),
    "toe_shot": ("starts 3.0° right, backspin 3840 rpm, axis 1.8°", "toe_shot.png"),
    "any_two_bodies": ("30°: rebound 0.913, slip -0.723", TWO_BODIES),
    "several_contacts": ("tilted by 0.050°: up 0.931 m/s", "several_contacts.png"),
    "loss_in_shear": ("one loss for both       at psi1 = 1:  0.15", "loss_in_shear.png"),
    "signs": ("spin -90 rad/s, slip 0.00 m/s", "signs.png"),
    "law_in_five_minutes": ("0.1 of the normal speed", "law_in_five_minutes.png"),
}
#: Those that take long, but for one of each kind, run by an interpreter of their own; the others
#: in this one, which has matplotlib already.
SLOW = (
    *("sweep_on_a_cluster", "reproduce_the_paper", "fit_your_experiment", "billiards"),
    *("beyond_the_paper", "superball", "law_swap", "stick_slip_map", "granular_gas"),
    *("hysteresis", "signs", "any_two_bodies", "several_contacts", "egg", "toe_shot", "custom_law"),
)
#: Options that make a script short.
OPTIONS = {
    "billiards": ("--collisions", 40, "--frames", 3),
    "granular_gas": ("--grains", 100, "--collisions", 3),
}


def python(*arguments, folder, path="", warnings="error"):
    environment = {**os.environ, "PYTHONPATH": str(path), "PYTHONWARNINGS": warnings}
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_every_script_is_listed_here():
    assert {path.stem for path in EXAMPLES.glob("*.py")} == set(SCRIPTS)
    site = (EXAMPLES.parent / ".ci" / "site" / "examples.py").read_text("utf-8")
    order = re.search(r"^ORDER = \((.*?)^\)", site, re.MULTILINE | re.DOTALL)[1]
    assert set(re.findall(r'"(\w+)"', order)) == set(SCRIPTS)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name in SLOW)) for name in SCRIPTS]
)
def test_script(name, tmp_path, monkeypatch, capsys):
    words, picture = SCRIPTS[name]
    for module in ("dask.distributed", "xarray") if name == "sweep_on_a_cluster" else ():
        pytest.importorskip(module, reason=f"needs the extra {module.partition('.')[0]}")
    script = EXAMPLES / f"{name}.py"
    if name in SLOW:
        done = python(script, *OPTIONS.get(name, ()), folder=tmp_path)
        assert done.returncode == 0, done.stderr
        told = done.stdout
    else:
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "argv", [str(script)])
        runpy.run_path(str(script), run_name="__main__")
        told = capsys.readouterr().out
    assert words in told
    expected = [picture] if isinstance(picture, str) else picture or []
    assert sorted(path.name for path in tmp_path.iterdir()) == list(expected)


@pytest.mark.slow
def test_the_laws_order_the_temperatures_of_a_gas(tmp_path):
    """The ratios that the docstring tells, to the scatter of 2,000 grains."""
    options = ("--grains", 2000, "--collisions", 30)
    done = python(EXAMPLES / "granular_gas.py", *options, folder=tmp_path)
    found = [float(line.split()[-3]) for line in done.stdout.splitlines() if "±" in line]
    assert found == pytest.approx([0.77, 0.69, 0.65, 0.53], abs=0.03)


def test_the_throw_of_rigid_balls_is_the_published_formula(tmp_path):
    """Balls that rub without giving way tangentially throw by min(mu, tan(cut)/7)."""
    from contactlab import Encounter, Simulation, collide

    code = (EXAMPLES / "throw_of_billiard_balls.py").read_text("utf-8")
    script: dict[str, object] = {}
    exec(code.partition("print(")[0], script)
    ball, friction, no_slip = (script[name] for name in ("BALL", "friction", "no_slip"))
    rigid = Simulation(tangential="coulomb")
    for cut in np.radians([5.0, 15.0, 25.0, 45.0]):
        mu = float(friction(0.45 * np.sin(cut)))
        met = Encounter(ball, ball, mu, normal=[np.cos(cut), np.sin(cut), 0], velocity=[0.45, 0, 0])
        velocity = collide(met, rigid).target_velocity
        thrown = np.degrees(cut - np.arctan2(velocity[1], velocity[0]))
        assert thrown == pytest.approx(float(no_slip(cut, mu)), rel=1e-9)


def begun(name, until):
    """Run the beginning of an example, up to some words; return what it defines."""
    script: dict[str, object] = {"__name__": name}
    code = (EXAMPLES / f"{name}.py").read_text("utf-8")
    assert until in code
    exec(compile(code.partition(until)[0], name, "exec"), script)
    return script


def test_mujoco_without_damping_follows_rigid_bodies():
    """What the picture of the dropped rod shows, and its caption says: to within 0.001 m/s."""
    from contactlab import Simulation, collide

    script = begun("any_two_bodies", "# %%")
    for tilt, rebound, slip in script["MUJOCO"]:
        met = script["dropped"](float(tilt))
        after = collide(met, Simulation(tangential="coulomb")).check()
        end = after.velocity + np.cross(after.spin, met.contact)
        assert [end[2], end[0]] == pytest.approx([rebound, slip], abs=1e-3)


@pytest.mark.slow
def test_the_words_below_the_contact_from_above_are_what_it_does():
    """Where it sticks and where it slips: x is forward, and angles are those of the upper half."""
    script = begun("beyond_the_paper", "with styled():")
    fields, instants = script["history"].fields, script["instants"]
    places = []
    for row in instants:
        x = np.broadcast_to(
            fields["radius"][row] * np.cos(fields["angle"][row])[:, None],
            fields["stuck"][row].shape,
        )
        touching = fields["pressure"][row] > 0.0
        stuck = (fields["stuck"][row] > 0.0) & touching
        slips = touching & ~stuck
        edge = script["history"].contact_radius[row]
        places.append(
            (x[stuck].mean() / edge, x[slips].mean() / edge, stuck.sum() / touching.sum())
        )
    (rear, front, _), (_, ahead, most), (_, behind, _), (middle, _, _) = places
    assert rear < -0.3 < 0.0 < front  # begins to stick at the rear
    assert ahead > 0.2  # sticks all but in front
    assert most > 0.75
    assert behind < -0.1  # slips back at the rear
    assert abs(middle) < 0.2  # slips back at the rim
    # psi1 < 1: axisymmetric theory sticks throughout first, then from the rim ever less
    largest = script["result"].motion.maximum_radius
    edges = script["history"].contact_radius[instants] / largest
    first, second, third, last = np.array([script["disc_radius"](row) for row in instants]) / edges
    assert min(first, second) > 0.97
    assert last < 0.7 < third < 0.9


def test_one_impact_is_six_lines():
    lines = (EXAMPLES / "one_impact.py").read_text(encoding="utf-8").splitlines()
    code = lines[lines.index('"""') + 1 :]
    statements = [line for line in code if line and not line.startswith(("from ", "print"))]
    assert len(statements) <= 6


@pytest.fixture
def plugin_path(tmp_path):
    """The plug-in as an installer would lay it out, from its own pyproject.toml."""
    project = tomllib.loads((PLUGIN / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    info = tmp_path / "site" / f"contactlab_cundall-{project['version']}.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
    )
    (group,) = project["entry-points"].items()
    lines = [f"{name} = {module}" for name, module in group[1].items()]
    (info / "entry_points.txt").write_text("\n".join([f"[{group[0]}]", *lines]) + "\n")
    return f"{tmp_path / 'site'}{os.pathsep}{PLUGIN}"


@pytest.mark.slow
def test_third_party_plugin_keeps_its_own_tests(plugin_path, tmp_path):
    done = python(
        *("-m", "pytest", "-q", "-p", "no:cacheprovider", "-c", PLUGIN / "pyproject.toml"),
        PLUGIN / "tests",
        folder=tmp_path,
        path=plugin_path,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert " passed" in done.stdout
    assert int(done.stdout.rpartition(" passed")[0].split()[-1]) >= 40


def test_third_party_plugin_on_the_command_line(plugin_path, tmp_path):
    both = (
        "import sys; from contactlab.cli.main import main; "
        "shown = main(['plugins', 'show', 'tangential.cundall']); print('shown'); "
        "sys.exit(shown or main(['run', *sys.argv[1:]]))"
    )
    scene = ("--psi1", "1.2", "--chi", "1.4412", "--tangential", "cundall")
    ran = python("-c", both, *scene, folder=tmp_path, path=plugin_path)
    assert ran.returncode == 0, ran.stderr
    shown, _, told = ran.stdout.partition("\nshown\n")
    assert "contactlab-cundall" in shown
    assert "cundall (contactlab-cundall 1.0.0)" in told


KNOWLEDGE = ("materials", "columns", "shapes", "cautions", "reports", "options")


@pytest.mark.slow
def test_third_party_plugin_brings_one_of_each_kind(plugin_path, tmp_path):
    code = (
        "import contactlab; from contactlab.cli.main import main; "
        "kinds = 'materials columns shapes cautions cases checks measurements'.split(); "
        "bad = [kind for kind in kinds if main(['plugins', 'check', kind + '.cundall'])]; "
        "print('bad', bad, contactlab.Material.named('filled ptfe').density)"
    )
    ran = python("-c", code, folder=tmp_path, path=plugin_path)
    assert ran.stdout.endswith("bad [] 2200.0\n"), ran.stdout + ran.stderr
    scene = json.loads(
        python(
            *("-m", "contactlab", "run", EXAMPLES / "steel_ball.toml", "--json"),
            folder=tmp_path,
            path=plugin_path,
        ).stdout
    )
    file = tomllib.loads((EXAMPLES / "steel_ball.toml").read_text("utf-8"))
    radius = file["sphere"]["radius"]
    steel = contactlab.Material(**file["sphere"]["material"])
    stiffness = steel.young_modulus / (2.0 * (1.0 - steel.poisson_ratio**2))
    mass = 4.0 / 3.0 * np.pi * radius**3 * steel.density
    energy = 15.0 / 16.0 * mass * scene["normal_speed"] ** 2
    contact = (radius * (energy / (stiffness * radius**0.5)) ** 0.4) ** 0.5  # Hertz
    heated = 2.0 / 3.0 * np.pi * contact**3 * 3.6e6
    assert scene["flash_temperature"] == pytest.approx(scene["friction_work"] / heated, rel=1e-6)


def test_the_guide_shows_the_files_of_the_plugin():
    page = (Path(contactlab.__file__).parent / "guide" / "extending-knowledge.md").read_text(
        "utf-8"
    )
    for name in KNOWLEDGE:
        source = (PLUGIN / "contactlab_cundall" / f"{name}.py").read_text("utf-8")
        assert f"```python\n{source}```" in page, name
        assert len(source.splitlines()) <= 40


@pytest.mark.slow
def test_third_party_plugin_is_put_through_the_stability_report(plugin_path, tmp_path):
    command = ("-m", "contactlab", "stability", "--quick", "--tangential", "cundall", "--json")
    ran = python(*command, folder=tmp_path, path=plugin_path)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert json.loads(ran.stdout)["tried"] > 200


def test_the_guide_shows_the_command_of_another_distribution():
    page = (Path(contactlab.__file__).parent / "guide" / "extending-command.md").read_text("utf-8")
    source = (EXAMPLES / "third_party_command" / "contactlab_hello.py").read_text("utf-8")
    assert f"```python\n{source}```" in page
    assert len(source.splitlines()) <= 24


@pytest.mark.slow
def test_a_command_of_another_distribution_installs_with_pip(tmp_path):
    """Needs a package index for the build back end."""
    target = tmp_path / "site"
    install = ("-m", "pip", "install", "-q", "--no-deps", "--target", target)
    done = python(*install, EXAMPLES / "third_party_command", folder=tmp_path, warnings="ignore")
    assert done.returncode == 0, done.stderr
    greeted = python("-m", "contactlab", "hello", "Ada", folder=tmp_path, path=target)
    assert greeted.stdout == "Hello Ada, a ball leaves at psi2 = -0.180\n"


def test_without_the_plugin_its_law_is_unknown(capsys):
    assert main(["run", "--psi1", "1.2", "--chi", "1.4412", "--tangential", "cundall"]) == 2
    assert "no friction law" in capsys.readouterr().err


@pytest.mark.slow
def test_third_party_plugin_installs_with_pip(tmp_path):
    """Needs a package index for the build back end."""
    target = tmp_path / "site"
    install = ("-m", "pip", "install", "-q", "--no-deps", "--target", target, PLUGIN)
    done = python(*install, folder=tmp_path, warnings="ignore")
    assert done.returncode == 0, done.stderr
    shown = python("-m", "contactlab", "plugins", "list", folder=tmp_path, path=target)
    assert "tangential.cundall" in shown.stdout
