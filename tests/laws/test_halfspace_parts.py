"""Parts of the half-space law: its numbers, errors, refusals and steps, by hand."""

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab_laws.halfspace import answer, own_motion, splitting
from contactlab_laws.halfspace.answer import answered
from contactlab_laws.halfspace.course import course
from contactlab_laws.halfspace.impacts import Impacts, Matter, Options, kinds, parts_of
from contactlab_laws.halfspace.rest import Slips, rest

CHI = 49 / 34
STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
RUBBER = Material(young_modulus=5e6, poisson_ratio=0.48, density=1100.0)


def law(**options):
    return Simulation(tangential=contactlab.create("tangential.halfspace", **options))


def one(body=STEEL, target=STEEL, **numbers):
    """An impact in SI with friction 0.4."""
    return Scene(Sphere(0.01, body), HalfSpace(target), 0.4, 0.5, numbers.get("slip", 0.2))


@pytest.mark.parametrize(("body", "target"), [(STEEL, RUBBER), (RUBBER, STEEL), (STEEL, STEEL)])
def test_the_numbers_of_an_impact(body, target):
    """Dundurs' beta of both bodies; nu of kappa = 2 (1 - nu)/(2 - nu) of like ones."""
    scene = one(body, target)
    matter = Matter.of(Simulation().normal_motion(scene))
    soft = [
        (1.0 - 2.0 * each.poisson_ratio) * (1.0 + each.poisson_ratio) / each.young_modulus
        for each in (body, target)
    ]
    stiff = [(1.0 - each.poisson_ratio**2) / each.young_modulus for each in (body, target)]
    beta = 0.5 * abs(soft[0] - soft[1]) / (stiff[0] + stiff[1])
    kappa = scene.pair.stiffness_ratio
    assert matter.lift == pytest.approx([0.4 * beta], abs=1e-15)
    assert matter.drag == pytest.approx([kappa * beta / 0.4], abs=1e-15)
    assert (matter.lift >= 0.0).all()
    assert matter.psi1 == pytest.approx([scene.psi1])
    assert matter.chi == pytest.approx([scene.chi])
    assert matter.stiffness == pytest.approx([1.25])
    nu = matter.poisson[0]
    assert 2.0 * (1.0 - nu) / (2.0 - nu) == pytest.approx(kappa)
    if body is target:
        assert nu == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("chi", "least", "rings", "parts"),
    [
        (1.0, 4, 16, 4),
        ((128.0 / 22.0) ** 2 * 0.999, 4, 16, 4),
        ((128.0 / 22.0) ** 2 * 1.001, 4, 16, 8),
        ((256.0 / 22.0) ** 2 * 1.001, 4, 16, 16),
        ((16.0 / 22.0) ** 2 * 1.001, 1, 8, 2),
        (0.0, 2, 8, 2),
    ],
)
def test_an_impact_has_22_root_chi_steps_at_least(chi, least, rings, parts):
    assert parts_of(chi, least, rings) == parts


@pytest.mark.parametrize(
    ("options", "plain", "dragged", "parts"),
    [
        ((16, 8, "none", True), [True, False, True, False], [False] * 4, [4, 2, 4, 2]),
        ((16, 8, "none", False), [True, False, True, False], [False] * 4, [4, 1, 4, 1]),
        ((16, 8, "one_way", False), [True, False] + [False] * 2, [0, 0, 1, 1], [4, 1, 1, 1]),
        ((16, 8, "two_way", False), [True, False] + [False] * 2, [0, 0, 1, 1], [4, 1, 2, 2]),
        ((16, 1, "none", False), [True] * 4, [False] * 4, [4] * 4),
    ],
)
def test_how_each_impact_is_followed(options, plain, dragged, parts):
    """Along one direction without coupling, of nu = 0 or over one angle alone."""
    same = np.ones(4)
    matter = Matter(same, same, np.array([0, 0.3, 0, 0.3]), np.array([0, 0, 1.0, 1.0]), same, same)
    found = kinds(Options(*options), matter)
    assert found.plain.tolist() == plain
    assert found.dragged.tolist() == [bool(each) for each in dragged]
    assert found.parts.tolist() == parts


def column(*values):
    return np.array(values)[:, None]


@pytest.mark.parametrize(
    ("psi1", "chi", "by_chance"),
    [
        (0.2, 1.5, 0.6 * 1.5 * 0.07 * 2.25),
        (-0.2, 1.5, 0.6 * 1.5 * 0.07 * 2.25),
        (2.0, 1.0, 0.1),  # no less
        (2.0, 10.0, 10.0),  # no more
    ],
)
@pytest.mark.parametrize("coupled", [False, True])
def test_answers_over_all_and_half_the_rings(psi1, chi, by_chance, coupled, monkeypatch):
    fine = Impacts(
        np.array([-0.5]), np.array([0.1]), np.array([1e-8]),
        column(0.0, 0.5, 1.0, 1.5, 2.0), column(0.2, 0.4, 0.6, 0.8, 1.0), None,
    )  # fmt: skip
    coarse = Impacts(
        np.array([-0.53]), np.array([0.13]), np.array([2e-8]),
        column(0.0, 1.0, 2.0), column(0.2, 0.5, 1.0), None,
    )  # fmt: skip
    rows = [(np.array([0]), fine, coarse, coupled)]
    monkeypatch.setattr(answer, "followed", lambda *_: rows)
    normal = Simulation().normal_motion(Scene.nondimensional(psi1=psi1, chi=chi))
    options = Options(16, 8, "one_way", True)
    found = answered(options, normal)
    assert found.residual.tolist() == [2e-8]
    assert found.impulse[0].tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    error = 0.03 + by_chance / 256.0
    if coupled:
        assert found.error == pytest.approx([error + 3e-4])
        assert (found.change[0], found.work[0]) == (-0.5, 0.1)
        assert found.share[0].tolist() == [0.2, 0.4, 0.6, 0.8, 1.0]
    else:
        shares = np.array([0.2, 0.4 + 0.05 / 3, 0.6 + 0.1 / 3, 0.8 + 0.05 / 3, 1.0])
        assert found.error == pytest.approx([error])
        assert found.work == pytest.approx([0.09])
        assert found.share[0] == pytest.approx(shares)
        assert found.change == pytest.approx([-chi * 0.5 * (shares[1:] + shares[:-1]).sum()])
    rows[:] = [(np.array([0]), fine, None, coupled)]
    found = answered(options, normal)
    assert np.isnan(found.error).all()
    assert (found.change[0], found.work[0], found.residual[0]) == (-0.5, 0.1, 1e-8)


def test_the_force_between_two_instants():
    """Of shares 0, 1 and 0.5 at impulses 0, 2 and 4: linear between, with their integrals."""
    passed, share = answer._along(
        np.array([0.0, 1.0, 2.0, 3.0, 4.0]), np.array([0.0, 2.0, 4.0]), np.array([0.0, 1.0, 0.5])
    )
    assert share == pytest.approx([0.0, 0.5, 1.0, 0.75, 0.5])
    assert passed == pytest.approx([0.0, 0.25, 1.0, 1.875, 2.5])


@pytest.mark.parametrize(
    ("slips", "duration", "inside", "further"),
    [
        ((1.5, 1.0, 0.0), 1.0, 2, 0.0625),  # slowing by 1/2 from 1/4: 1/16 further
        ((1.5, 1.0, 0.75), 1.0, 2, 0.5 / 3.0),  # gaining: backward differences
        ((1.5, 1.0, 0.75), 2.0, 2, 0.5 * 4.0 / 5.0),
        ((-1.5, -1.0, 0.0), 1.0, 2, -0.0625),
        ((1.5, 1.0, 0.0), 1.0, 1, 0.0),  # in contact too short to know
        ((1.0, 1.0, 0.0), 1.0, 2, 0.0),
    ],
)
def test_where_slip_comes_to_rest(slips, duration, inside, further):
    past = Slips(*(np.array([each]) for each in slips), (1.0, 1.0), np.array([inside]))
    assert rest(past, duration, vectors=False) == pytest.approx([slips[0] + further])
    turned = past._replace(
        **{name: np.stack((0.6 * each, 0.8 * each)) for name, each in past._asdict().items()
           if name in ("last", "before", "first")}
    )  # fmt: skip
    found = rest(turned, duration, vectors=True)
    assert found == pytest.approx(np.array([[0.6], [0.8]]) * (slips[0] + further))


@pytest.mark.parametrize(
    ("approach", "expected"),
    [
        (  # still in contact at the last instant
            [0.0, 1.0, 0.5, 0.2],
            [[0, 1, 2, 2.7], [0, 1, 0.5, 0], [1, 0, -1, -1], [0, 5, 3, 0]],
        ),
        (  # apart at the third
            [0.0, 1.0, 0.5, -0.1],
            [[0, 1, 2, 2.5], [0, 1, 0.5, 0], [1, 0, -1, -1], [0, 5, 3, 0]],
        ),
    ],
)
def test_nothing_happens_after_the_bodies_parted(approach, expected):
    rows = [[0.0, 1.0, 2.0, 2.5], approach, [1.0, 0.0, -1.0, -1.0], [0.0, 5.0, 3.0, 2.0]]
    found = own_motion._parted([np.array(each) for each in rows], 1)
    assert np.array(found) == pytest.approx(np.array(expected, dtype=float))


def test_without_mixing_a_step_comes_to_the_same_answer(monkeypatch):
    scene = Scene.nondimensional(psi1=0.9, chi=CHI, poisson_ratio=0.3, coupling_number=0.5)
    options = {"coupling": "one_way", "rings": 4, "angles": 2, "extrapolate": False}
    known = law(**options).run(scene).psi2
    monkeypatch.setattr(splitting, "dposv", lambda matrix, right: (matrix, right, 1))
    assert law(**options).run(scene).psi2 == pytest.approx(known, abs=1e-6)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"angles": 1, "coupling": "one_way"},
            "angles = 1: must be at least 2 with coupling = 'one_way', which drags radially; "
            "give angles=8",
        ),
        (
            {"rings": 9},
            "rings = 9: must be even, for the impact is followed over half as many too; "
            "give an even number, or extrapolate=False",
        ),
        (
            {"rings": 98},
            "rings = 98: must be at most 96 with more than one angle: matrices grow as rings³; "
            "give fewer rings, or angles=1",
        ),
    ],
)
def test_what_is_refused_and_what_is_next_to_it(options, message):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        contactlab.create("tangential.halfspace", **options)
    assert str(refused.value) == f"tangential.halfspace: {message}"
    for allowed in (
        {"angles": 2, "coupling": "one_way"},
        {"angles": 1},
        {"rings": 9, "extrapolate": False},
        {"rings": 96},
        {"rings": 98, "angles": 1},
    ):
        contactlab.create("tangential.halfspace", **allowed)


def test_a_course_ends_on_edges():
    """Of 4 rings in 2 steps each; the time is Hertz's where the radius is the largest."""
    normal = Simulation().normal_motion(one())
    path = course(normal, 4, 2)
    assert path.inside.tolist() == [0, 1, 1, 2, 2, 3, 3, 4, 4, 4, 3, 3, 2, 2, 1, 1, 0]
    edges = 1.0 - (1.0 - np.arange(5) / 4) ** 1.5
    assert path.radius[::2] == pytest.approx([*edges, *edges[-2::-1]], abs=1e-12)
    assert path.share[::2] == pytest.approx(np.ones(9))
    half = 1.0 - (1.0 - 1 / 8) ** 1.5
    assert path.share[1] == pytest.approx((half / edges[1]) ** 2)
    assert path.time[8, 0] == pytest.approx(0.5 * path.time[-1, 0])
    assert path.impulse[[0, 8, -1], 0] == pytest.approx([0.0, 1.0, 2.0])
    assert path.pressure[1:-1, 0] == pytest.approx(np.ones(15), abs=1e-6)
    assert path.pressure[[0, -1], 0].tolist() == [0.0, 0.0]
