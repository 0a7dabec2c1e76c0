"""Materials, bodies and the reduction of a pair (theory §1)."""

import math
import pickle

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Sphere
from contactlab.impact.bodies import Pair
from contactlab.testing.load_paths import Bench, drive, straight
from tests.solve.any_scene import BODIES, meeting

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


def test_moduli_are_two_views_of_one_material():
    same = Material(shear_modulus=STEEL.shear_modulus, poisson_ratio=0.3, density=7850.0)
    assert STEEL.shear_modulus == pytest.approx(208e9 / 2.6, rel=1e-15)
    assert same.young_modulus == pytest.approx(208e9, rel=1e-15)


def test_default_sphere_is_solid_and_homogeneous():
    sphere = Sphere(0.01, STEEL)
    assert sphere.mass == pytest.approx(4 / 3 * math.pi * 1e-6 * 7850.0)
    assert sphere.gyration_ratio**2 == pytest.approx(0.4)


def test_like_bodies_give_the_papers_kappa_and_chi():
    """Eqs (29) and (38): kappa = 2(1-nu)/(2-nu), chi = (1-nu)(1+1/K²)/(2-nu)."""
    pair = Pair.of(Sphere(0.01, STEEL), HalfSpace(STEEL))
    assert pair.stiffness_ratio == pytest.approx(2 * 0.7 / 1.7, rel=1e-14)
    assert pair.inertia_ratio == pytest.approx(0.7 * 3.5 / 1.7, rel=1e-14)
    assert pair.inertia_ratio == pytest.approx(1.4411764706, abs=1e-10)


def test_two_equal_spheres_halve_radius_and_mass_but_keep_chi():
    sphere = Sphere(0.01, STEEL)
    pair = Pair.of(sphere, sphere)
    assert pair.radius == pytest.approx(0.005)
    assert pair.normal_mass == pytest.approx(sphere.mass / 2)
    assert pair.inertia_ratio == pytest.approx(1.4411764706, abs=1e-10)


def test_unlike_bodies_add_their_compliances():
    """Kharaz's pair, G* and E* worked out by hand from E and nu (Hertz-Mindlin)."""
    ball = Material(young_modulus=380e9, poisson_ratio=0.23, density=4000.0)
    glass = Material(young_modulus=70e9, poisson_ratio=0.25, density=2500.0)
    pair = Pair.of(Sphere(2.5e-3, ball), HalfSpace(glass))
    normal = (1 - 0.23**2) / 380e9 + (1 - 0.25**2) / 70e9
    shear = (2 - 0.23) * 1.23 / (2 * 380e9) + (2 - 0.25) * 1.25 / (2 * 70e9)
    assert pair.effective_modulus == pytest.approx(1 / normal, rel=1e-14)
    assert pair.effective_shear_modulus == pytest.approx(1 / shear, rel=1e-14)


def test_tangential_stiffness_is_mindlins_8_g_a_of_discrete_element_codes():
    """k = 8 a / sum((2 - nu)/G), Mindlin (1949), by the moduli of the materials alone."""
    ball = Material(young_modulus=380e9, poisson_ratio=0.23, density=4000.0)
    glass = Material(young_modulus=70e9, poisson_ratio=0.25, density=2500.0)
    pair = Pair.of(Sphere(2.5e-3, ball), HalfSpace(glass))
    of_codes = 1 / ((2 - 0.23) / (380e9 / 2.46) + (2 - 0.25) / (70e9 / 2.5))
    radii = np.array([1e-5, 3e-5, 1e-4])
    np.testing.assert_allclose(pair.tangential_stiffness(radii), 8 * of_codes * radii, rtol=1e-14)
    assert pair.tangential_stiffness(1e-4) == pytest.approx(8 * of_codes * 1e-4, rel=1e-14)
    assert pair.effective_shear_modulus == pytest.approx(4 * of_codes, rel=1e-14)
    batch = Pair.of(Sphere(np.array([1e-3, 2e-3, 4e-3]), ball), HalfSpace(glass))
    assert batch.tangential_stiffness(radii).shape == (3,)
    assert np.isnan(pair.tangential_stiffness(math.nan))


def test_tangential_stiffness_is_the_slope_of_the_annulus_methods_first_force():
    """The kernel of eqs (13), (14) knows nothing of the formula; the load is held."""
    bench = Bench.of()
    law = contactlab.create("tangential.annulus", annuli=200)
    slip = 1e-3
    force = drive(law, bench, straight((0.0, 1.0), (slip, 1.0))).force[-1]
    slope = force * bench.friction_force / (slip * bench.slip)
    pair = bench.scene.pair
    assert slope == pytest.approx(pair.tangential_stiffness(bench.radius), rel=0.01)


@pytest.mark.parametrize(
    ("ratios", "moduli", "beta"),
    [
        ((0.25, 0.25), (1e9, 1e9), 0.0),
        ((0.5, 0.5), (1e9, 3e9), 0.0),
        ((0.0, 0.25), (1e9, 3e9), 1.0 / 3.0),
        ((0.25, 0.0), (3e9, 1e9), -1.0 / 3.0),
    ],
)
def test_dundurs_beta(ratios, moduli, beta):
    """Half of (1-2nu)/G, body less body, over the sum of (1-nu)/G: none for like bodies."""
    one, other = (
        Material(shear_modulus=modulus, poisson_ratio=ratio, density=1e3)
        for modulus, ratio in zip(moduli, ratios, strict=True)
    )
    assert Scene.nondimensional(psi1=1.0, chi=1.0).pair.dundurs_beta == 0.0
    for target in (HalfSpace(other), Sphere(0.02, other)):
        assert Pair.of(Sphere(0.01, one), target).dundurs_beta == pytest.approx(beta, abs=1e-15)


BAD = [0.0, -1.0, math.nan, math.inf, "1", None, True, 1j, [[1], [1, 2]]]
REFUSED = [
    *((Sphere, (bad, STEEL), {}, "radius") for bad in BAD),
    *((Sphere, (0.01, STEEL), {"gyration_ratio": bad}, "gyration_ratio")
      for bad in (0.0, 1.01, -0.4, math.nan)),
    (Sphere, (0.01, "steel"), {"mass": 1.0}, "material"),
    (Sphere, (0.01, Material(shear_modulus=1e9, poisson_ratio=0.3)), {}, r"mass.*density"),
    (HalfSpace, (0.3,), {}, "material"),
    (Material, (), {"young_modulus": 1e9}, "poisson_ratio"),
    (Material, (), {"young_modulus": 1e9, "poisson_ratio": 0.6}, "poisson_ratio"),
    (Material, (), {"young_modulus": 1e9, "poisson_ratio": -1.1}, "poisson_ratio"),
    (Material, (), {"young_modulus": 1e9, "poisson_ratio": -1.0}, "young_modulus"),
    (Material, (), {"young_modulus": 1e9, "poisson_ratio": [0.3, -1.0]},
     "does not determine the shear modulus"),
    (Material, (), {"young_modulus": -1e9, "poisson_ratio": 0.3}, "young_modulus"),
    (Material, (), {"shear_modulus": math.inf, "poisson_ratio": 0.3}, "shear_modulus"),
    (Material, (), {"shear_modulus": 1e9, "young_modulus": 1e9, "poisson_ratio": 0.3},
     "exactly one"),
    (Material, (), {"poisson_ratio": 0.3}, "exactly one"),
    (Material, (), {"shear_modulus": 1e9, "poisson_ratio": 0.3, "density": 0.0}, "density"),
]  # fmt: skip


@pytest.mark.parametrize(("made", "arguments", "keywords", "words"), REFUSED)
def test_bad_input_is_refused_by_name(made, arguments, keywords, words):
    with pytest.raises((ValueError, TypeError), match=words):
        made(*arguments, **keywords)


def test_auxetic_limit_is_allowed_by_shear_modulus():
    assert Material(shear_modulus=1e9, poisson_ratio=-1.0).young_modulus == 0.0


def test_sphere_needs_a_mass_from_somewhere():
    weightless = Material(shear_modulus=1e9, poisson_ratio=0.3)
    assert Sphere(0.01, weightless, mass=0.2).mass == 0.2


def test_bodies_are_values():
    sphere = Sphere(0.01, STEEL)
    assert pickle.loads(pickle.dumps(sphere)) == sphere
    assert Sphere(np.float32(0.5), STEEL) == Sphere(0.5, STEEL)
    assert Sphere(1, STEEL).radius == 1.0
    assert Sphere([0.01, 0.02], STEEL) != sphere


def test_batch_bodies_are_values_too():
    """Mass, gyration and density hold arrays as radius does."""
    ratio = [0.6, 0.7]
    light = Material(young_modulus=1e9, poisson_ratio=0.3, density=[1e3, 2e3])
    same = Material(young_modulus=1e9, poisson_ratio=0.3, density=[1e3, 2e3])
    one, two = (Sphere([0.01, 0.02], of, gyration_ratio=ratio) for of in (light, same))
    assert one == two
    assert len({one, two, Sphere([0.01, 0.03], light, gyration_ratio=ratio)}) == 2
    assert one != Sphere([0.01, 0.02], light, gyration_ratio=ratio, mass=[1.0, 2.0])


def test_quantities_of_a_class_of_keywords_are_keywords():
    with pytest.raises(TypeError, match="positional argument"):
        Pair(*[1.0] * 5)


by_principal = pytest.mark.parametrize("name", ["principal", "axes", "batch", "box", "ellipsoid"])
NEW = np.diag((1.0, 1.5, 2.0))


@pytest.mark.parametrize("name", BODIES)
def test_evolve_keeps_what_was_given(name):
    given = BODIES[name]
    assert attrs.evolve(given) == given
    heavier = attrs.evolve(given, mass=2.0 * given.mass)
    assert heavier != given
    assert np.array_equal(heavier.inertia, given.inertia)
    assert heavier.principal is given.principal or np.array_equal(
        heavier.principal, given.principal
    )
    assert pickle.loads(pickle.dumps(heavier)) == heavier
    assert np.array_equal(attrs.evolve(given, inertia=NEW, principal=None, axes=None).inertia, NEW)


@by_principal
def test_other_moments_of_a_body_by_principal_moments(name):
    given = BODIES[name]
    turned = attrs.evolve(given, principal=(1.0, 1.5, 2.0))
    axes = np.eye(3) if given.axes is None else given.axes
    assert turned.inertia == pytest.approx(axes @ NEW @ axes.T, rel=1e-12, abs=1e-15)


@by_principal
def test_an_inertia_beside_principal_moments_is_refused(name):
    with pytest.raises(ValueError, match=r"give one of the two.*None for it"):
        attrs.evolve(BODIES[name], inertia=NEW)


@pytest.mark.parametrize("name", ["inertia", "rod"])
def test_principal_moments_beside_an_inertia_are_refused(name):
    with pytest.raises(ValueError, match=r"give one of the two.*None for it"):
        attrs.evolve(BODIES[name], principal=(1.0, 1.5, 2.0))
    moments = attrs.evolve(BODIES[name], inertia=None, principal=(1.0, 1.5, 2.0))
    assert np.array_equal(moments.inertia, NEW)


def test_a_body_tells_what_it_was_given():
    assert "principal=" in repr(BODIES["axes"])
    assert "inertia=" not in repr(BODIES["axes"])
    assert "inertia=" in repr(BODIES["inertia"])
    assert "principal=" not in repr(BODIES["inertia"])


def test_scenes_of_bodies_given_by_inertia_or_by_principal_moments_stack():
    for names in (("inertia", "turned"), ("turned", "principal"), ("principal", "turned")):
        bodies = [BODIES[name] for name in names]
        stacked = Scene.stack([meeting(body).scene for body in bodies]).encounter.body
        assert np.array_equal(stacked.inertia, [body.inertia for body in bodies])
