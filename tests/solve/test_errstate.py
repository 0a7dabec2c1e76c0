"""Users who ask NumPy to raise get the same answers as the others, everywhere."""

from itertools import product

import numpy as np
import pytest

import contactlab
from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, Sphere, collide, rebound
from contactlab.solve.normal_motion import normal_motion
from tests.longer import longer

STEEL = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)
PSI1 = np.array([0.0, 1e-320, 1e-300, 1e-160, 1e-12, 0.4, 1.0, 2.5, 1e5, 1e15, 1e300])
NORMALS = ("hertz", "tsuji", "linear", "jkr", "dmt", "thornton", "hunt_crossley", "walton_braun")
#: Normal motions that take longer than those of the same law or kind of scene.
LONGER = (("jkr", "nano"), ("jkr", "unlike"), ("thornton", "unlike"), ("hunt_crossley", "unlike"))


def scene(slip, *, speed=1.0, mu=0.2, radius=0.005):
    """Return a steel sphere on steel."""
    return Scene(Sphere(radius, STEEL), HalfSpace(STEEL), mu, speed, slip)


SCENES = {
    "one": lambda: scene(0.3),
    "tiny": lambda: scene(1e-12),
    "no friction": lambda: scene(1.0, mu=0.0),
    "hardly any": lambda: scene(1.0, mu=1e-300),
    "unlike": lambda: scene(
        np.array([0.0, 1e-300, 1e-12, 1e5]), speed=np.array([1.0, 0.1, 2.0, 9.0])
    ),
    "nano": lambda: scene(0.1, speed=5.0, radius=1e-9),
}


@pytest.mark.parametrize(
    ("options", "chi"),
    [
        *product(({}, {"derivatives": True}), (1e-300, 1e-12, 0.02, 0.5, 0.8, 1.44, 2.5)),
        *product(({"restitution": 0.9},), (1e-300, 1e-12, 0.8, 1.44)),
        *longer(*product(({"restitution": 0.9},), (0.02, 0.5, 2.5))),
    ],
)
def test_rebound(chi, options):
    if options.get("restitution") and chi < 0.02:
        options = {}
    plain = rebound(PSI1, chi, **options)
    with np.errstate(all="raise"):
        strict = rebound(PSI1, chi, **options)
        for psi1 in PSI1[::3].tolist():
            rebound(psi1, chi, **options)
    assert np.array_equal(np.array(strict), np.array(plain))
    assert np.isfinite(strict).all()


@pytest.mark.parametrize(
    ("normal", "given"),
    [
        pytest.param(
            normal, SCENES[name], id=f"{normal}-{name}",
            marks=[pytest.mark.slow] * ((normal, name) in LONGER),
        )
        for normal, name in product(NORMALS, SCENES)
    ],
)  # fmt: skip
def test_normal_motions(normal, given):
    law, phases = contactlab.create(f"normal.{normal}"), np.linspace(0.0, np.pi, 33)
    plain = normal_motion(law, given())
    with np.errstate(all="raise"):
        motion = normal_motion(law, given())
        sample = motion.at(phases.reshape((-1,) + (1,) * len(motion.scene.shape)))
        motion.phase(np.linspace(0.0, 1.0, 9))
        law.cautions(motion.scene, motion)
    assert np.array_equal(motion.final_rate, plain.final_rate, equal_nan=True)
    assert np.array_equal(motion.duration, plain.duration, equal_nan=True)
    assert np.all(np.isfinite(sample.approach) | (np.array(motion.status) != 0))


@pytest.mark.parametrize(
    ("normal", "tangential", "given"),
    [
        pytest.param(
            *laws, SCENES[name], id=f"{'-'.join(laws)}-{name}",
            marks=[pytest.mark.slow] * ((laws[0], name) in LONGER),
        )
        for laws, name in product(
            (
                ("tsuji", "coulomb"),
                ("tsuji", "springs"),
                ("linear", "linear_spring"),
                ("jkr", "stronge"),
                ("tsuji", "mindlin_deresiewicz"),
                ("hunt_crossley", "thornton_yin"),
                ("walton_braun", "walton"),
                ("hertz", "fronts"),
            ),
            SCENES,
        )
    ],
)  # fmt: skip
def test_runs_with_their_history(normal, tangential, given):
    simulation = Simulation(normal=normal, tangential=tangential)
    history = not given().shape
    plain = simulation.run(given(), history=history)
    with np.errstate(all="raise"):
        result = simulation.run(given(), history=history)
        str(result), str(result.plan), result.energy.relative_imbalance, result.psi_change
    assert np.array_equal(result.psi2, plain.psi2, equal_nan=True)
    assert np.array_equal(result.status, plain.status)


@pytest.mark.parametrize("velocity", [[1, 0, -1], [1e-9, 0, -1e-9], [1e10, 0, -1], [1, 1e-300, -1]])
@pytest.mark.parametrize("restitution", [1.0, 0.9])
def test_collisions(velocity, restitution):
    ball = Sphere(0.01, STEEL)
    with np.errstate(all="raise"):
        for spin in ([0, 0, 0], [1e-200, 40, 3]):
            met = Encounter(ball, ball, 0.2, normal=[0, 0, 1], velocity=velocity, spin=spin)
            found = collide(met, restitution=restitution, separating="pass")
            assert np.isfinite(found.energy.relative_imbalance)
            assert np.isfinite(found.impulse).all()
