"""Bundles of springs by parts: scales, limits, parts of steps, and when all steps go at once."""

from types import SimpleNamespace

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create
from contactlab_laws.jaeger import law as profile
from contactlab_laws.jaeger import pressure as pressures
from contactlab_laws.jaeger import step
from contactlab_laws.jaeger.geometry import of_each, of_one
from contactlab_laws.jaeger.gross_slip import gross_slip
from contactlab_laws.jaeger.law import _alike
from contactlab_laws.jaeger.partial_slip import Scales
from contactlab_laws.jaeger.pressure import hemisphere
from contactlab_laws.march.division import midpoints
from contactlab_laws.springs import doubling
from contactlab_laws.springs.doubling import Memory, fitted
from contactlab_laws.springs.law import Midpoints

STEEL = Material.named("steel")


def impact(friction=0.3, slip=0.15):
    return Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), friction, 0.7, slip)


def test_scales_in_si():
    """Theory §1: a, kappa R/(mu a²), mu P_max, P_max and the work of one on the other."""
    scene = impact()
    normal = Simulation().normal_motion(scene)
    a, pair = normal.maximum_radius, scene.pair
    found = Scales.of(scene, normal)
    assert found.radius == a
    slip = 0.3 * a**2 / (pair.stiffness_ratio * pair.radius)
    assert found.displacement == pytest.approx(1.0 / slip)
    assert found.metres == pytest.approx(slip)
    assert found.normal_force == pytest.approx(normal.maximum_force)
    assert found.force == pytest.approx(0.3 * normal.maximum_force)
    assert found.work == pytest.approx(0.3 * normal.maximum_force * slip)
    half = normal.maximum_force / 8.0
    assert found.pressure(0.5, half) == pytest.approx(1.0)
    assert found.pressure(0.5, 0.5 * half) == pytest.approx(0.5)
    assert found.pressure(0.0, 0.0) == 0.0
    smooth = Scales.of(impact(friction=0.0), normal)
    assert (smooth.displacement, smooth.force, smooth.work, float(smooth.metres)) == (0, 0, 0, 0)


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


@pytest.mark.parametrize(("off", "close"), [(0.9e-6, True), (-1.1e-6, False), (1.1e-6, False)])
def test_a_load_is_hertzs_to_a_millionth(off, close):
    scene = impact()
    normal = Simulation().normal_motion(scene)

    def at(phase):
        sample = normal.at(phase)
        hertz = 4.0 / 3.0 * scene.pair.effective_modulus * sample.contact.radius**3 / 0.01
        middle = (np.abs(phase - 0.5 * np.pi) < 1e-9) * off
        return SimpleNamespace(
            contact=SimpleNamespace(
                radius=sample.contact.radius, friction_load=hertz * (1.0 + middle)
            )
        )

    assert pressures._hertzian(SimpleNamespace(scene=scene, at=at)) is close


@pytest.mark.parametrize(
    ("psi1", "slips"), [(4.76, False), (4.77, True), (-4.77, True), ([0.1, 9.0], True)]
)
def test_gross_slip_of_elastic_contacts(psi1, slips):
    scene = Scene.nondimensional(psi1=psi1, chi=1.4411764706)
    answers = gross_slip(scene, Simulation().normal_motion(scene))
    assert bool(answers) is slips
    if slips:
        assert answers[0].reason == "the impact slips from start to end, eq. (45)"
    assert gross_slip(scene, Simulation(normal="tsuji").normal_motion(scene)) == ()


def test_numbers_of_a_batch_that_agree_are_one():
    assert step.common(0.5, (2,)) == 0.5
    assert step.common(np.array([2.0, 2.0 * (1.0 + 4e-15)]), (2,)) == 2.0
    apart = np.array([2.0, 2.0 * (1.0 + 4e-14)])
    assert step.common(apart, (2,)).tolist() == apart.tolist()
    assert step.common(np.array([[1.0], [3.0]]), (2, 2)).tolist() == [1.0, 1.0, 3.0, 3.0]
    assert step.common(np.array([7.0]), (3,)) == 7.0
    assert type(step.float_of_one(np.array([7.0]))) is float
    assert step.float_of_one(apart) is apart
    rows = np.array([[1.0, 1.0], [2.0, 2.0 * (1.0 - 1.5e-14)]])
    assert not _alike(rows)
    rows[1, 1] = 2.0 * (1.0 - 0.5e-14)
    assert _alike(rows)
    assert _alike(np.array([[1.0], [np.nan]]))
    assert not _alike(np.array([[1.0, np.nan]]))


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


@pytest.mark.parametrize(
    ("before", "after", "throughout", "part"),
    [
        (0.04, 0.5, 1, [(0.5 - 0.09) / 0.46, (0.5 - 0.25) / 0.46, (0.5 - 0.49) / 0.46]),
        (0.3, 0.5, 3, [0.05]),
        (0.5, 0.3, 3, []),
        (0.0, 0.005, 0, []),
    ],
)
def test_springs_that_a_contact_meets_move_for_a_part_of_the_step(before, after, throughout, part):
    """Of five springs at 0.1, 0.3 ... 0.9: b² grows evenly."""
    made = Midpoints(5)
    alone = of_one(made, before, after, 2.0)
    assert alone.throughout == throughout
    assert alone.part[:, 0] == pytest.approx(np.array(part))
    squares = made.squares[: len(alone.limit)]
    factor = made.limit_factor(after)
    assert alone.limit[:, 0] == pytest.approx(2.0 * factor * (after - squares))
    each = of_each(made, np.array([before, 0.02]), np.array([after, 0.02]), np.array([2.0, 3.0]))
    count = len(alone.limit)
    assert each.limit[:count, 0] == pytest.approx(alone.limit[:, 0])
    whole = np.ones(max(count, 1))
    whole[throughout:count] = part
    parts = np.ones(max(count, 1))
    parts[each.throughout :] = each.part[: max(count, 1) - each.throughout, 0]
    assert parts[:count] == pytest.approx(whole[:count])
    assert (each.part[:, 1] == 1.0).all()


@pytest.mark.parametrize(
    ("shape", "most", "at_once"),
    [
        ((), 600, True),
        ((), 599, False),
        ((2,), 600, True),
        ((90,), 2700, True),
        ((90,), 2699, False),
    ],
)
def test_long_runs_go_step_by_step(shape, most, at_once, monkeypatch):
    """20 springs and 30 steps; a batch counts where it has more impacts than springs."""
    monkeypatch.setattr(profile, "LARGEST_RUN", most)
    law = create("tangential.springs", springs=20)
    scene = Scene.nondimensional(psi1=np.full(shape, 1.2) if shape else 1.2, chi=1.4)
    normal = Simulation().normal_motion(scene)
    answer = law.advance_all(scene, normal, midpoints(normal, 30))
    assert (answer is not None) is at_once


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


@pytest.mark.parametrize(
    ("radius", "size"), [(0.3, 0.5), (0.5, 0.5), (0.51, 1.0), (3.0, 4.0), (2e-9, 2.0**-28)]
)
def test_the_least_grid_is_a_power_of_two_of_the_pair(radius, size):
    found = doubling._least_size(np.array([3.0 * radius]), np.array([3.0]))
    assert found == pytest.approx([3.0 * size])


def test_a_doubled_spring_is_met_on_the_way():
    places = np.array([0.1, 0.3, 0.5])[:, None]
    found = doubling.part_of_step(places, np.array([0.2]), np.array([0.4]))
    assert found[:, 0] == pytest.approx([1.0, 0.5, 0.0])
    assert doubling.part_of_step(places, np.array([0.4]), np.array([0.2])) == 1.0
    assert doubling.part_of_step(places, np.array([0.4]), np.array([0.4])) == 1.0
    both = doubling.part_of_step(
        np.hstack((places, places)), np.array([0.2, 0.5]), np.array([0.4, 0.3])
    )
    assert both[:, 1].tolist() == [1.0, 1.0, 1.0]
    assert both[:, 0] == pytest.approx([1.0, 0.5, 0.0])


def test_a_step_of_four_springs_by_hand():
    """A = 1, springs at 1/8, 3/8, 5/8 and 7/8, of 1/2 N/m each; all slip at the limit."""
    state = memory(1.0, [0.0, 0.0, 0.0, 0.0], radius=1.0)
    heights = 1.0 - np.array([1, 9, 25, 49]) / 64.0
    most = heights * 0.3 / (0.5 * heights.sum())
    force, work, now = doubling.moved(
        state, np.array([5.0]), np.array([1.0]), np.array([0.3]),
        unit=np.array([1.0]), modulus=np.array([2.0]),
    )  # fmt: skip
    assert force == pytest.approx([0.3])
    assert now.deflection[:, 0] == pytest.approx(most)
    assert now.limit[:, 0] == pytest.approx(most)
    assert work == pytest.approx([0.5 * 0.5 * ((5.0 - most) * most).sum()])
    force, work, now = doubling.moved(
        now, np.array([0.0]), np.array([0.0]), np.array([0.0]),
        unit=np.array([1.0]), modulus=np.array([2.0]),
    )  # fmt: skip
    assert (force[0], now.size[0], np.abs(now.deflection).max()) == (0.0, 0.0, 0.0)
    assert work == pytest.approx([0.5 * 0.5 * (most**2).sum()])  # what it held is lost


def test_the_stiffness_of_a_doubling_grid_is_half_a_spring_more():
    scene = impact()
    normal = Simulation().normal_motion(scene)
    known = create("tangential.springs", springs=10).stiffness(scene, normal)
    assert known == pytest.approx(2.0 * scene.pair.effective_shear_modulus * normal.maximum_radius)
    other = create("tangential.springs", springs=10, grid="doubling").stiffness(scene, normal)
    assert other == pytest.approx(1.2 * known)


def test_an_odd_doubling_grid_is_refused_by_name():
    with pytest.raises(ValueError) as told:  # noqa: PT011
        create("tangential.springs", springs=9, grid="doubling")
    assert str(told.value) == (
        'tangential.springs: springs = 9: must be even with grid = "doubling", which merges '
        "springs in pairs; take 10"
    )
    assert create("tangential.springs", springs=9).springs == 9
