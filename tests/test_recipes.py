"""Recipes for other people's loops; each runs where what it needs is installed."""

import importlib.util
import json
import re
import shutil
import subprocess
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Material, Sphere, collide, rebound
from contactlab.cli.main import main
from tests.present import PACKAGE, needs_sources

RECIPES = Path(__file__).parents[1] / "examples" / "recipes"
PSI1 = np.array([-3.0, 0.2, 0.9, 1.2, 2.0, 4.0, 7.0])
CHI = 49 / 34


def recipe(name):
    """Return a recipe as a module."""
    spec = importlib.util.spec_from_file_location(name, RECIPES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def differences(psi1, chi, step=1e-5):
    """Return central differences of psi2 by psi1 and by chi."""
    by_psi1 = (rebound(psi1 + step, chi) - rebound(psi1 - step, chi)) / (2.0 * step)
    by_chi = (rebound(psi1, chi + step) - rebound(psi1, chi - step)) / (2.0 * step)
    return by_psi1, by_chi


def test_every_recipe_is_run_here():
    names = {path.name for path in RECIPES.iterdir() if path.is_file()}
    assert names == {
        "ball_in_planck.mjs",
        "ball_in_pymunk.py",
        "bouncing_ball.mjs",
        "contact.c",
        "contact.cpp",
        "contact.rs",
        "event_driven_gas.py",
        "rebound_in_jax.py",
        "rebound_in_torch.py",
    }


def test_jax():
    jax = pytest.importorskip("jax", reason="JAX is not installed: pip install .[recipes]")
    ours = recipe("rebound_in_jax").rebound
    by_psi1, by_chi = differences(PSI1, CHI)
    assert np.asarray(ours(PSI1, CHI)) == pytest.approx(rebound(PSI1, CHI), abs=1e-9)
    gradient = jax.jit(jax.vmap(jax.grad(ours, argnums=(0, 1)), in_axes=(0, None)))
    found = gradient(PSI1, CHI)
    assert np.asarray(found[0]) == pytest.approx(by_psi1, abs=1e-4)
    assert np.asarray(found[1]) == pytest.approx(by_chi, abs=1e-4)
    value, slope = jax.jvp(ours, (PSI1, CHI), (np.ones_like(PSI1), 2.0))
    assert np.asarray(value) == pytest.approx(rebound(PSI1, CHI), abs=1e-9)
    assert np.asarray(slope) == pytest.approx(by_psi1 + 2.0 * by_chi, abs=1e-4)
    together = jax.grad(lambda psi1: (ours(psi1, CHI) ** 2).sum())(PSI1)
    assert np.asarray(together) == pytest.approx(2.0 * rebound(PSI1, CHI) * by_psi1, abs=1e-3)


def test_torch():
    torch = pytest.importorskip("torch", reason="PyTorch is not installed: pip install .[recipes]")
    ours = recipe("rebound_in_torch").rebound
    psi1 = torch.tensor(PSI1, requires_grad=True)
    chi = torch.tensor(CHI, dtype=torch.float64, requires_grad=True)
    psi2 = ours(psi1, chi)
    assert psi2.detach().numpy() == pytest.approx(rebound(PSI1, CHI), abs=1e-9)
    (psi2**2).sum().backward()
    by_psi1, by_chi = differences(PSI1, CHI)
    weight = 2.0 * rebound(PSI1, CHI)
    assert psi1.grad.numpy() == pytest.approx(weight * by_psi1, abs=1e-3)
    assert float(chi.grad) == pytest.approx(float((weight * by_chi).sum()), abs=1e-3)
    smooth = torch.tensor([0.7, 1.5, 3.0, 8.0], dtype=torch.float64, requires_grad=True)
    assert torch.autograd.gradcheck(ours, (smooth, chi), eps=1e-5, atol=1e-4)
    single = torch.tensor([1.2], dtype=torch.float32, requires_grad=True)
    ours(single, torch.tensor(CHI)).sum().backward()
    assert single.grad.dtype == torch.float32


@pytest.fixture(scope="module")
def gas():
    """Return the edge of the box, the beginning, and 400 events of a gas that fills a tenth."""
    ours = recipe("event_driven_gas")
    edge, *state = ours.beginning(side=4, filled=0.1)
    return ours.BALL, edge, state, list(islice(ours.events(*state, edge), 400))


def test_the_gas_keeps_momentum_and_its_energy_books(gas):
    ball, _, (_, velocity, spin), course = gas

    def energy(velocity, spin):
        return 0.5 * ball.mass * ((velocity**2).sum() + 0.4 * ball.radius**2 * (spin**2).sum())

    first = energy(velocity, spin)
    for _, _, moving, turning, work in course[::20]:
        assert np.abs(moving.sum(axis=0) - velocity.sum(axis=0)).max() < 1e-12
        assert energy(moving, turning) + work == pytest.approx(first, rel=1e-12)
    assert work > 0.05 * first


def test_no_spheres_of_the_gas_overlap(gas):
    ball, edge, _, course = gas
    one, other = np.triu_indices(64, 1)
    for _, place, *_ in course:
        apart = place[other] - place[one]
        apart -= edge * np.round(apart / edge)
        assert np.linalg.norm(apart, axis=1).min() > 2.0 * ball.radius * (1.0 - 1e-9)


def test_spheres_of_the_gas_collide_as_often_as_enskog_says(gas):
    """2 N n d^2 g sqrt(pi T/m) collisions in a time, g of Carnahan and Starling.

    In fifteen gases of 400 events the ratio had a standard deviation of 0.04.
    """
    ball, edge, (_, velocity, _), course = gas
    count, filled = len(velocity), 0.1
    contact = (1.0 - 0.5 * filled) / (1.0 - filled) ** 3
    fixed = 2.0 * np.sqrt(np.pi) * count * (count - 1) / edge**3 * (2.0 * ball.radius) ** 2
    expected = 0.0
    for since, _, moving, *_ in course:
        expected += since * fixed * contact * np.sqrt((velocity**2).sum() / (3 * (count - 1)))
        velocity = moving
    assert expected == pytest.approx(len(course), rel=0.12)


BOUNCES = """
import {BALLS} from KERNEL;
import {frame, rests} from BALL;
const ball = (velocity, spin) => ({
  body: {radius: 0.02, mass: 0.1, poisson: 0.3}, contact: {friction: 0.4},
  position: [0, 0, 0.05], velocity, spin,
});
const slips = JSON.parse(process.argv[2]);
const bounced = slips.map(([along, spin]) => {
  const one = ball([0.6 * along, 0.8 * along, -3], [-0.8 * spin, 0.6 * spin, 0]);
  for (let k = 0; k < 2; k++) frame(one, 0);
  return [one.velocity, one.spin, one.position];
});
const long = ball([1, 0, 0], [0, 0, 0]);
const heights = [];
for (let k = 0; k < 600; k++) {
  frame(long);
  heights.push(9.81 * long.position[2] + long.velocity[2] ** 2 / 2);
}
const resting = Object.values(BALLS).map(({body, contact}) => {
  const position = [0, 0, body.radius + 1];
  const one = {body, contact, position, velocity: [1, -2, 0], spin: [9, -60, 20]};
  const course = [];
  for (let k = 0; k < 6000 && !rests(one); k++) {
    frame(one);
    course.push([...one.position, ...one.velocity, ...one.spin]);
  }
  frame(one);
  return {body, contact, course, after: [...one.position, ...one.velocity, ...one.spin]};
});
console.log(JSON.stringify({bounced, heights, resting}));
"""


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    """Return slips of bounces, and what the recipe tells of them and of balls that come to rest."""
    folder = tmp_path_factory.mktemp("bounces")
    kernel = PACKAGE / "kernels" / "contactlab_bounce.mjs"
    script = BOUNCES.replace("BALL;", json.dumps((RECIPES / "bouncing_ball.mjs").as_uri()) + ";")
    (folder / "bounces.mjs").write_text(
        script.replace("KERNEL", json.dumps(kernel.as_uri())), "utf-8"
    )
    slips = np.stack([np.linspace(-2.0, 9.0, 12), np.linspace(60.0, -90.0, 12)], axis=1)
    done = subprocess.run(
        ["node", "bounces.mjs", json.dumps(slips.tolist())],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    )
    return slips.T, json.loads(done.stdout)


needs_node = pytest.mark.skipif(shutil.which("node") is None, reason="node is not there")


@needs_node
@needs_sources
def test_a_ball_in_a_game_bounces_as_rebound_says(told):
    """psi2 to 1e-6; ten seconds of elastic bounces reach the same height."""
    (along, spin), told = told
    velocity, turning, place = map(np.array, zip(*told["bounced"], strict=True))
    kappa, radius = 2.0 * 0.7 / 1.7, 0.02
    assert velocity[:, 2] == pytest.approx(3.0, rel=1e-12)
    after = velocity[:, 0] * 0.6 + velocity[:, 1] * 0.8
    about = turning[:, 1] * 0.6 - turning[:, 0] * 0.8
    scale = kappa / (0.4 * 3.0)
    psi2 = scale * (after - about * radius)
    expected = rebound(scale * (along - spin * radius), 1.75 * kappa)
    assert psi2 == pytest.approx(expected, abs=1e-6 * scale * 11.0)
    assert np.abs(expected).max() > 1.0
    # The contact point at rest keeps what no torque about it changes.
    assert after + 0.4 * radius * about == pytest.approx(along + 0.4 * radius * spin, abs=1e-12)
    flown = 2.0 / 60.0 - 0.03 / 3.0
    assert place[:, 2] == pytest.approx(radius + 3.0 * flown, rel=1e-12)
    assert place[:, 0] == pytest.approx(0.6 * along * 0.01 + velocity[:, 0] * flown, abs=1e-12)
    assert told["heights"] == pytest.approx([9.81 * 0.05] * 600, rel=1e-9)


@needs_node
@needs_sources
@pytest.mark.parametrize("which", range(4))
def test_a_ball_of_the_collection_comes_to_rest(told, which):
    """Its energy never grows; it rises to e^2 of the height before; and it stays where it rests."""
    one = told[1]["resting"][which]
    body, e = one["body"], one["contact"]["restitution"]
    course = np.array(one["course"])
    assert len(course) < 3000
    assert (course[-1, 3:] == 0.0).all()
    assert course[-1, 2] == body["radius"]
    assert one["after"] == course[-1].tolist()
    inertia = body["mass"] * (body.get("gyration_ratio", 0.4**0.5) * body["radius"]) ** 2
    squares = (course[:, 3:6] ** 2).sum(axis=1), (course[:, 6:] ** 2).sum(axis=1)
    energy = body["mass"] * (9.81 * course[:, 2] + 0.5 * squares[0]) + 0.5 * inertia * squares[1]
    assert (np.diff(energy) <= 1e-12).all()
    rise = course[:, 2] - body["radius"] + course[:, 5] ** 2 / (2.0 * 9.81)  # of each hop
    hops = rise[np.flatnonzero(np.abs(np.diff(rise)) < 1e-9)]
    hops = hops[np.insert(np.diff(hops) < -1e-9, 0, values=True)]
    assert hops[:4] == pytest.approx(e ** (2.0 * np.arange(4)), rel=1e-9)


@needs_node
@needs_sources
def test_the_ball_runs_as_printed():
    script = (RECIPES / "bouncing_ball.mjs").read_text("utf-8")
    command = re.search(r"^ \*     (node .*)$", script, re.MULTILINE)[1].split()
    done = subprocess.run(
        command, cwd=RECIPES.parents[1], capture_output=True, text=True, check=True
    )
    lines = done.stdout.splitlines()
    assert re.match(r"0\.4\d s: \d\.\d+ m/s along, 3\.\d+ up, -?\d+ rad/s", lines[0])
    assert re.match(r"\d+\.\d\d s: at rest, \d+\.\d\d m along", lines[-1])


#: Velocity (m/s) and spin (rad/s) of balls thrown at a floor: in stick, partial slip, gross slip.
THROWS = [((1.0, -3.0), 0.0), ((2.0, -4.4), 80.0), ((6.0, -2.0), -40.0), ((-3.0, -4.0), 10.0)]


def bounced(ball, floor, friction, e, velocity, spin):
    """Return velocity along and up, and spin of a ball that meets the floor, by ``collide``."""
    made = collide(
        Encounter(
            ball, floor, friction, normal=[0, -1, 0], velocity=(*velocity, 0.0), spin=(0, 0, spin)
        ),
        restitution=e,
    )
    return [*made.velocity[:2], made.spin[2]]


def test_a_ball_in_pymunk():
    """Without gravity one bounce is that of ``collide``; with it the ball comes to rest."""
    pytest.importorskip("pymunk", reason="pymunk is not installed: pip install .[recipes]")
    ours = recipe("ball_in_pymunk")
    for velocity, spin in THROWS:
        space, body = ours.thrown(velocity, spin, gravity=0.0)
        for _ in range(200):
            space.step(1e-3)
        expected = bounced(ours.BALL, ours.FLOOR, ours.FRICTION, ours.RESTITUTION, velocity, spin)
        assert [*body.velocity, body.angular_velocity] == pytest.approx(expected, abs=1e-9)
    space, body = ours.thrown((2.0, -4.4), 150.0)
    for _ in range(12 * 240):
        space.step(1 / 240)
    assert body.velocity.y == pytest.approx(0.0, abs=1e-6)
    assert body.position.y == pytest.approx(ours.BALL.radius, abs=1e-3)


IN_PLANCK = """
import {thrown} from "./ball_in_planck.mjs";
import {BALLS} from "contactlab";
const told = ({body}) => {
  const {x, y} = body.getLinearVelocity();
  return [x, y, body.getAngularVelocity()];
};
const bounced = JSON.parse(process.argv[2]).map(([velocity, spin]) => {
  const one = thrown(BALLS.superball, velocity, spin, {gravity: 0});
  for (let k = 0; k < 50; k++) one.world.step(1 / 240);
  return told(one);
});
const one = thrown(BALLS.superball, [2, -4.4], 150);
for (let k = 0; k < 15 * 240; k++) one.world.step(1 / 240);
console.log(JSON.stringify({bounced, rests: told(one), height: one.body.getPosition().y}));
"""


@pytest.mark.slow
@needs_node
@pytest.mark.skipif(shutil.which("npm") is None, reason="npm is not there")
def test_a_ball_in_planck(tmp_path):
    """Without gravity one bounce is that of ``collide`` to 1e-4; with it the ball comes to rest."""
    kernels = RECIPES.parents[1] / "contactlab" / "kernels"
    install = ["npm", "install", "--no-audit", "--no-fund", "planck@1", str(kernels)]
    installed = subprocess.run(install, cwd=tmp_path, capture_output=True, text=True, check=False)
    if installed.returncode:
        pytest.skip(f"npm cannot install planck: {installed.stderr.strip()[-200:]}")
    shutil.copy(RECIPES / "ball_in_planck.mjs", tmp_path)
    (tmp_path / "run.mjs").write_text(IN_PLANCK, "utf-8")
    words = ["node", "run.mjs", json.dumps(THROWS)]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True)
    told = json.loads(done.stdout)
    material = Material(young_modulus=1e6, poisson_ratio=0.5)
    superball = Sphere(0.023, material, mass=0.0462)
    for (velocity, spin), found in zip(THROWS, told["bounced"], strict=True):
        expected = bounced(superball, HalfSpace(material), 0.39, 0.9, velocity, spin)
        unit = 0.39 * 4.4 / 0.67  # of psi, m/s
        assert found[:2] == pytest.approx(expected[:2], abs=1e-4 * unit)
        assert 0.023 * found[2] == pytest.approx(0.023 * expected[2], abs=3e-4 * unit)
    assert told["rests"][1] == 0.0
    assert told["height"] == pytest.approx(0.023, abs=0.011)  # planck keeps 1 cm between shapes


#: A recipe, and the commands that build it: those of its head.
COMPILED = {
    "contact.cpp": (
        "g++ -std=c++17 -O2 -Wall -Wextra -Werror -I. {recipes}/contact.cpp -o contact",
    ),
    "contact.rs": (
        "gcc -O2 -c -I. -DCONTACTLAB_REAL=float {recipes}/contact.c -o contact.o",
        "rustc -O -D warnings {recipes}/contact.rs -C link-arg=contact.o -o contact",
    ),
}


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.slow] * name.endswith(".rs")) for name in COMPILED],
)
def test_a_code_of_ones_own_in_single_precision(name, tmp_path):
    """Eight springs are within 0.024 in double precision."""
    commands = [command.format(recipes=RECIPES).split() for command in COMPILED[name]]
    for command in commands:
        if shutil.which(command[0]) is None:
            pytest.skip(f"{command[0]} is not installed")
    main(["kernel", "--out", str(tmp_path)])
    for command in commands:
        subprocess.run(command, cwd=tmp_path, check=True)
    told = subprocess.run([tmp_path / "contact"], capture_output=True, text=True, check=True)
    _, psi1, psi2 = np.array([line.split() for line in told.stdout.splitlines()], dtype=float).T
    assert len(psi1) == 11
    kappa = 2.0 * (1.0 - 0.3) / (2.0 - 0.3)
    assert np.abs(psi2 - rebound(psi1, 1.75 * kappa)).max() < 0.016
