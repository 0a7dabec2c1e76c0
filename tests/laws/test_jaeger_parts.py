"""Bundles of springs by parts: scales, limits, parts of steps, and when all steps go at once."""

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create
from contactlab_laws.jaeger.pressure import hemisphere
from contactlab_laws.springs.doubling import Memory, fitted
from contactlab_laws.springs.law import Midpoints

STEEL = Material.named("steel")


def impact(friction=0.3, slip=0.15):
    return Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), friction, 0.7, slip)


@pytest.mark.parametrize("name", ["springs", "annulus", "sharp_annulus"])
@pytest.mark.parametrize("slip", [0.15, np.array([0.15, 0.0])])
def test_fields_without_friction(name, slip):
    """They ended in a ZeroDivisionError: there is no force, and nothing that tells slips apart."""
    result = Simulation(tangential=name).run(impact(friction=0.0, slip=slip), history="fields")
    fields = result.check().history.fields
    for each in ("traction", "limit", "displacement"):
        if each in fields:
            assert (fields[each] == 0.0).all()
    assert fields["radius"].max() > 0.0
    assert (result.history.tangential_force == 0.0).all()


ASSUMED = (
    "the friction law assumes a hemispherical pressure over the contact radius, with the friction "
    "load as its sum; the normal law does not declare one (model error)"
)
DAMPED = (
    "the normal law assumes a hemispherical pressure for its damped force; no theory gives the "
    "pressure of the damping (model error)"
)


@pytest.mark.parametrize(
    ("name", "options", "text"),
    [
        ("hertz", {}, None),
        ("tsuji", {"restitution": 1.0}, None),
        ("tsuji", {"restitution": 0.9}, DAMPED),
        ("hunt_crossley", {"damping": 0.0}, None),
        ("hunt_crossley", {"damping": 0.1}, DAMPED),
        ("dmt", {"work_of_adhesion": 0.1}, None),
        ("thornton", {}, ASSUMED),
        ("linear", {}, ASSUMED),
    ],
)
@pytest.mark.parametrize("batch", [False, True])
def test_whose_hemisphere_is_assumed(name, options, text, batch):
    scene = impact(slip=np.array([0.1, 0.2]) if batch else 0.1)
    normal = Simulation(normal=create(f"normal.{name}", **options)).normal_motion(scene)
    assert hemisphere(normal) == (() if text is None else (text,))


@pytest.mark.parametrize("springs", [1, 2, 5])
def test_springs_carry_the_load_of_gross_slip(springs):
    """At their limits they give b³; while one touches its weight is 9/8 of 1.5/n at most."""
    made = Midpoints(springs)
    places = (np.arange(springs) + 0.5) / springs
    squares = np.array([0.2, 0.55, 0.8, 1.0, 1.3]) ** 2
    together, factor = made.weights(squares), made.limit_factor(squares)
    for k, square in enumerate(squares.tolist()):
        touching = int((places**2 < square).sum())
        alone = made.weights_of_one(square, touching)
        assert alone == pytest.approx(together[:touching, k])
        assert made.limit_factor(square) == pytest.approx(factor[k])
        limits = factor[k] * (square - places[:touching] ** 2)
        if touching:
            assert alone @ limits == pytest.approx(square**1.5)
        assert (alone <= 1.125 * 1.5 / springs * (1.0 + 1e-15)).all()
        assert factor[k] >= 1.0


def memory(size, held, radius=0.0):
    rows = np.array(held, dtype=float)[:, None]
    return Memory(np.array([size]), np.array([radius]), rows, 0.0 * rows)


@pytest.mark.parametrize(
    ("size", "radius", "held", "expected", "after", "lost"),
    [
        (1.0, 1.0, [4.0, 2.0, 1.0, 0.0], [4.0, 2.0, 1.0, 0.0], 1.0, 0.0),
        # pairs to their means; a quarter of a cell of 1/4 times the squares 4 and 1
        (1.0, 1.5, [4.0, 2.0, 1.0, 0.0], [3.0, 0.5, 0.0, 0.0], 2.0, 0.0625 * 5.0),
        # then cells of 1/2: 2.5²/8 more
        (1.0, 3.0, [4.0, 2.0, 1.0, 0.0], [1.75, 0, 0, 0], 4.0, 0.3125 + 0.125 * 6.25),
        (1.0, 0.26, [4.0, 2.0, 0.0, 0.0], [4.0, 2.0, 0.0, 0.0], 1.0, 0.0),
        # halves of each; what stood outside is lost, half a cell times its squares
        (1.0, 0.25, [4.0, 2.0, 1.0, 3.0], [4.0, 4.0, 2.0, 2.0], 0.5, 0.125 * 10.0),
        (1.0, 0.125, [4.0, 2.0, 0.0, 0.0], [4.0, 4.0, 4.0, 4.0], 0.25, 0.0625 * 8.0),
        (0.0, 0.3, [0.0, 0.0], [0.0, 0.0], 0.5, 0.0),  # of a unit of 1: the next power of two
    ],
)
def test_a_grid_is_doubled_and_halved(size, radius, held, expected, after, lost):
    found = fitted(memory(size, held), np.array([radius]), np.array([1.0]))
    assert found[0].tolist() == [after]
    assert found[1][:, 0].tolist() == expected
    assert np.ravel(found[2]) == pytest.approx([lost])
