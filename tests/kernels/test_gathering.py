"""A gathering by a C program of one's own, beside ``collide``."""

import subprocess

import numpy as np
import pytest

from contactlab import Gathering, collide
from contactlab_laws.springs import compiled
from tests.collisions.gathered import laws, random_gathering, row
from tests.kernels.test_kernels import needs_c, program

pytestmark = needs_c


@pytest.fixture(scope="module", params=["c99", pytest.param("c++", marks=pytest.mark.slow)])
def gathered(request, tmp_path_factory):
    """Return a function of numbers that gives what the program writes."""
    folder = tmp_path_factory.mktemp("gathering")
    built = program("gathering", request.param, folder)

    def run(numbers):
        np.concatenate([np.ravel(each) for each in numbers]).astype(float).tofile(folder / "in")
        subprocess.run([built, folder / "in", folder / "out"], check=True, timeout=120)
        return np.fromfile(folder / "out")

    return run


def numbers(gathering, springs, steps):
    """Return what the program reads of an elastic gathering."""
    assembly, places = gathering.assembly, gathering.places
    scene = gathering.scene
    hit = collide(gathering, laws(springs, steps))
    normal = hit._way.prepare(False).normal
    step = np.min(normal.duration) / hit.plan.steps
    bodies = []
    for body in gathering.bodies:
        shape = body.shape
        inertia = getattr(shape, "inertia", None)
        if inertia is None:
            inertia = shape.mass * shape.gyration_ratio**2 * shape.radius**2 * np.eye(3)
        bodies.append([shape.mass, *np.linalg.inv(inertia).ravel(), *body.velocity, *body.spin])
    contacts = compiled._contacts(scene, normal, None)[0]
    contacts[:, :3] = np.nan  # the program finds velocities
    touches = []
    for k, (first, second) in enumerate(places):
        arms = []
        for place in (first, second):
            arm = np.zeros(3) if place is None else assembly.reaches[place][k].arm
            arms.append([float(np.ravel(each)[0]) for each in arm])
        second = -1 if second is None else second
        touches.append([first, second, *arms[0], *arms[1], *assembly.axes[0, k].ravel()])
    head = [len(bodies), len(touches), springs, 0, step, 0.0]
    rows = [np.concatenate(pair) for pair in zip(touches, contacts, strict=True)]
    return hit, [head, *bodies, *rows]


@pytest.mark.parametrize("count", [2, pytest.param(20, marks=pytest.mark.slow)])
def test_a_game_gathers_as_collide_does(gathered, count):
    draw, found = np.random.default_rng(count), [row(4, mu=0.15, spin=50.0)]
    while len(found) < count:
        given = random_gathering(draw, most=6)
        try:
            given.scene  # noqa: B018 it refuses what parts
        except ValueError:
            continue
        if len(given.bodies) <= 8:
            found.append(given)
    for gathering in found:
        hit, told = numbers(gathering, 12, 60)
        status, *after = gathered(told)
        velocity, spin = np.array(after).reshape(2, -1, 3)
        assert status == 0
        np.testing.assert_allclose(velocity, hit.velocity, atol=1e-11)
        np.testing.assert_allclose(spin, hit.spin, atol=1e-9)


def test_bodies_that_are_equal_keep_their_place(gathered):
    """The order of contacts is that of the program."""
    gathering = row(3, mu=0.15, spin=50.0)
    turned = Gathering(gathering.bodies, [*gathering.touches][::-1])
    one, other = (gathered(numbers(each, 8, 60)[1]) for each in (gathering, turned))
    np.testing.assert_allclose(one, other, atol=1e-11)
