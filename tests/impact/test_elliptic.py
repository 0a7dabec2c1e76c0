"""The ellipse of a contact: constants by quadrature, curvatures by tensors (theory §16)."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from contactlab import Encounter, HalfSpace, Material, RigidBody, Scene, Sphere
from contactlab.impact import kinetics
from contactlab.impact.elliptic import ellipse, of_axes
from contactlab.impact.hertz import hertz_scales, peak_pressure

STEEL = Material(shear_modulus=79.3e9, poisson_ratio=0.29, density=7800.0)
DOWN = np.array([0.0, 0.0, -1.0])
#: B/A, b/a, R (A + B), a and b over a_e, p_0 over the circle's, share of nu along x.
ROWS = [
    (1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.5),
    (2.0, 0.630595701, 1.081965077, 1.2427543, 0.7836755, 1.02678, 0.442990612),
    (4.0, 0.399887015, 1.351490525, 1.5021194, 0.6006780, 1.10829, 0.390109466),
    (25.0, 0.125881950, 3.819343736, 2.2081330, 0.2779641, 1.62924, 0.283747986),
    (400.0, 0.024714785, 30.7241028, 3.2386581, 0.0800427, 3.85756, 0.196353523),
    (1e4, 0.004124857, 445.9027876, 4.3780617, 0.0180589, 12.64816, 0.145404679),
]


def body(**given):
    entries = {"mass": 0.1, "inertia": 1e-5 * np.eye(3), "material": STEEL} | given
    return RigidBody(**entries)


def met(first, second=None, **given):
    """Return the scene of two bodies with their centres on the normal."""
    second = HalfSpace(STEEL) if second is None else second
    entries = {"friction_coefficient": 0.3, "normal": DOWN, "velocity": [0.2, 0.0, -1.0]} | given
    sides = {"contact": (first, 1.0), "target_contact": (second, -1.0)}
    entries |= {
        name: sense * np.asarray(entries["normal"]) * 0.01
        for name, (each, sense) in sides.items()
        if isinstance(each, RigidBody)
    }
    return Encounter(first, second, **entries).scene


@pytest.mark.parametrize("row", ROWS)
def test_constants_of_the_table(row):
    """From a program of its own that solves for the contact; to the digits given there."""
    found = ellipse(1.0 / row[0])
    told = found.axis_ratio, found.radius, found.major, found.minor
    told = (*told, 1.0 / (found.major * found.minor), found.weight_major)
    for value, expected in zip(told, row[1:], strict=True):
        digits = len(f"{expected:.10g}".partition(".")[2])
        assert float(value) == pytest.approx(expected, abs=0.5000001 * 10.0**-digits)


@pytest.mark.parametrize("k", [0.9, 0.3, 0.01, 1e-3])
def test_constants_by_quadrature_of_their_definitions(k):
    """The potential of Hertz's pressure over an ellipsoid, and the shares of Cerruti's kernel."""

    def integral(function, end=math.pi / 2):
        return quad(function, 0.0, end, epsabs=0.0, epsrel=1e-12, limit=500)[0]

    def potential(power, other):  # w = s² is the parameter of confocal ellipsoids
        return integral(lambda s: (1 + s * s) ** -power * (k * k + s * s) ** -other, math.inf)

    def root(t):
        return math.sqrt(math.sin(t) ** 2 + k * k * math.cos(t) ** 2)

    whole = integral(lambda t: 1.0 / root(t))
    found = of_axes(k)
    share = integral(lambda t: math.sin(t) ** 2 / root(t)) / whole
    assert found.weight_major == pytest.approx(share, rel=1e-10)
    assert found.weight_minor == pytest.approx(1.0 - share, rel=1e-9)
    assert found.major == pytest.approx(2.0 * whole / math.pi, rel=1e-11)
    least, most = potential(1.5, 0.5), potential(0.5, 1.5)
    assert ellipse(least / most).axis_ratio == pytest.approx(k, rel=1e-9)
    # z = 3 P/(4 E* a) times 2/pi times the integral for the approach, and of curvatures A and B
    approach = potential(0.5, 0.5)
    assert found.radius == pytest.approx((least + most) * whole**-3 * (math.pi / 2) ** 2, rel=1e-9)
    assert approach == pytest.approx(whole, rel=1e-10)


def test_curvatures_and_axes_belong_together_to_a_ratio_of_1e12():
    """b/a found from A/B gives A/B again, by integrals of Legendre's form where these hold."""
    from scipy.special import ellipe, ellipkm1

    ratio = np.exp(np.random.default_rng(1).uniform(math.log(1e-12), 0.0, 20_000))
    k = ellipse(ratio).axis_ratio
    m = 1.0 - k * k
    far = (m > 1e-2) & (k > 1e-3)
    first, second = ellipkm1(k * k), ellipe(m)
    again = (k * k * (first - second) / (second - k * k * first))[far]
    assert again == pytest.approx(ratio[far], rel=1e-9)
    assert (np.diff(k[np.argsort(ratio)]) > 0.0).all()


def test_nearly_round_contacts_are_continuous():
    circle, ratios = ellipse(1.0), 1.0 - np.array([1e-12, 1e-10, 1e-8])
    for each, expected in zip(ellipse(ratios), circle, strict=True):
        assert each == pytest.approx(float(expected), abs=2e-8)


def test_a_circle_given_as_an_ellipse_is_that_circle_to_the_last_bit():
    plain = met(body(curvature_radius=0.013), Sphere(0.01, STEEL))
    given = {"curvature_radius": 0.013, "cross_radius": 0.013, "curvature_axis": [1, 2, 0]}
    round_ = met(body(**given), Sphere(0.01, STEEL))
    assert plain == round_


def test_curvatures_of_both_bodies_add_as_tensors():
    """Two random bodies at random angles, their axes out of the tangent plane and at any length."""
    rng = np.random.default_rng(2)
    for _ in range(50):
        radii, angles = rng.uniform(0.1, 10.0, 4), rng.uniform(0.0, math.pi, 2)
        turn = Rotation.random(random_state=int(rng.integers(1 << 30))).as_matrix()
        frame = turn.T  # rows n, t1, t2
        tensor, bodies = np.zeros((2, 2)), []
        for (one, other), angle in zip(radii.reshape(2, 2), angles, strict=True):
            axis = math.cos(angle) * frame[1] + math.sin(angle) * frame[2] + 0.3 * frame[0]
            bodies.append(body(curvature_radius=one, cross_radius=other, curvature_axis=5 * axis))
            way = np.array([math.cos(angle), math.sin(angle)])
            tensor += np.outer(way, way) / one + (np.eye(2) - np.outer(way, way)) / other
        scene = met(*bodies, normal=frame[0], velocity=frame[0] + 0.1 * frame[1])
        least, most = np.linalg.eigvalsh(tensor)
        shape = ellipse(least / most)
        radius = 2.0 * shape.radius / (least + most)
        assert scene.pair.radius == pytest.approx(radius, rel=1e-12)
        ratio = scene.pair.axis_ratio
        assert min(ratio, 1.0 / ratio) == pytest.approx(shape.axis_ratio, rel=1e-12)
        # the axes of the frame are those of the tensor
        rows = scene.frame[1:] @ frame[1:].T
        along = rows @ tensor @ rows.T
        assert abs(along[0, 1]) < 1e-12 * most
        assert (along[0, 0] > along[1, 1]) == (ratio > 1.0)


def test_a_rod_across_a_rod_keeps_its_digits_however_unlike():
    """The determinant has no difference: crossed cylinders have exactly the curvatures of each."""
    thin = body(curvature_radius=math.inf, cross_radius=1e-6, curvature_axis=[0, 1, 0])
    wide = body(curvature_radius=math.inf, cross_radius=3e3, curvature_axis=[1, 0, 0])
    shape = ellipse(1e-6 / 3e3)
    found = met(thin, wide).pair
    assert found.radius == pytest.approx(2.0 * shape.radius / (1e6 + 1.0 / 3e3), rel=1e-13)


@pytest.mark.parametrize(
    ("given", "second", "words"),
    [
        ({"curvature_radius": 0.01, "cross_radius": 0.02}, None, "curvature_axis.*is needed"),
        ({"curvature_radius": 0.01, "curvature_axis": [1, 0, 0]}, None, "cross_radius"),
        (
            {"curvature_radius": 0.01, "cross_radius": 0.02, "curvature_axis": [0, 0, 0]},
            None, "curvature_axis.*zero",
        ),
        (
            {"curvature_radius": 0.01, "cross_radius": 0.02, "curvature_axis": [0, 0, 3]},
            None, "curvature_axis.*right angles",
        ),
        (
            {"curvature_radius": math.inf, "cross_radius": 0.02, "curvature_axis": [1, 0, 0]},
            None, "a line.*crown_radius",
        ),
        ({"curvature_radius": 0.0}, None, "curvature_radius.*zero"),
        ({"curvature_radius": 1e101}, None, "curvature_radius.*up to 1e100; .*inf if flat"),
        ({"curvature_radius": 1.0, "cross_radius": 0.0}, None, "cross_radius.*zero"),
        ({"curvature_radius": math.inf}, None, "two planes"),
        ({"curvature_radius": -0.01}, Sphere(0.02, STEEL), "curve apart.*a hollow must be less"),
        ({"curvature_radius": -0.01}, None, "a hollow must be less curved"),
        (
            {"curvature_radius": -0.01, "cross_radius": 1.0, "curvature_axis": [1, 0, 0]},
            Sphere(0.02, STEEL), "curve apart",
        ),
        ({"curvature_radius": math.nan}, None, "curvature_radius.*a number"),
        ({"curvature_radius": 1e-160}, None, "curvature_radius.*zero"),
        ({"curvature_radius": np.array(["a", "b"])}, None, "curvature_radius.*real number"),
        ({"curvature_radius": np.array([math.inf, None])}, None, "curvature_radius.*real number"),
        ({"curvature_radius": [math.inf, 0.0]}, None, "curvature_radius = .inf, 0.0.: .*zero"),
        (
            {
                "curvature_radius": 0.01, "cross_radius": [0.01, 0.02],
                "curvature_axis": np.ones((3, 3)),
            },
            None, r"cross_radius \(2,\), curvature_axis \(3,\) must broadcast",
        ),
    ],
)  # fmt: skip
def test_refusals(given, second, words):
    with pytest.raises(ValueError, match=words):
        met(body(**given), second)


@pytest.mark.parametrize("kind", [list, tuple, np.array, np.float32])
def test_infinite_radii_come_in_every_kind_of_number(kind):
    radii = kind([math.inf, 0.5])
    found = body(curvature_radius=radii, cross_radius=0.5, curvature_axis=[1, 0, 0])
    assert found.curvature_radius.tolist() == [math.inf, 0.5]
    assert body(curvature_radius=np.float32(math.inf)).curvature_radius == math.inf


def test_parallel_rods_touch_along_a_line_and_crossed_ones_at_a_point():
    rods = [
        body(curvature_radius=math.inf, cross_radius=0.01, curvature_axis=axis)
        for axis in ([1, 0, 0], [math.cos(1e-7), math.sin(1e-7), 0], [0, 1, 0])
    ]
    with pytest.raises(ValueError, match="a line"):
        met(rods[0], rods[1])
    assert met(rods[0], rods[2]).pair.radius == pytest.approx(0.01)


def test_a_ball_in_a_hollow_has_the_difference_of_curvatures():
    bowl = body(curvature_radius=-0.03)
    assert met(bowl, Sphere(0.02, STEEL)).pair.radius == pytest.approx(0.06)
    groove = body(curvature_radius=math.inf, cross_radius=-0.03, curvature_axis=[1, 0, 0])
    shape = ellipse((50.0 - 100.0 / 3.0) / 50.0)
    radius = 2.0 * shape.radius / (100.0 - 100.0 / 3.0)
    assert met(groove, Sphere(0.02, STEEL)).pair.radius == pytest.approx(radius, rel=1e-12)


def test_peak_pressure_is_that_of_the_ellipse():
    given = {"curvature_radius": 0.05, "cross_radius": 0.002, "curvature_axis": [1, 0, 0]}
    scene = met(body(**given))
    scales = hertz_scales(scene)
    shape = ellipse(0.04)
    area = math.pi * scales.radius**2 * shape.major * shape.minor
    assert peak_pressure(scene) == pytest.approx(1.5 * scales.force / area, rel=1e-12)


def test_a_batch_of_circles_and_ellipses_is_its_impacts_one_by_one():
    cross = np.array([0.02, 0.01, 0.005, 0.02])
    axes = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 2, 0.5]])
    velocity = np.array([[0.2, 0, -1], [0.2, 0.1, -1], [0.3, 0, -1], [0.1, 0.1, -1]])
    many = body(curvature_radius=0.02, cross_radius=cross, curvature_axis=axes)
    scene = met(many, velocity=velocity)
    for place in range(4):
        one = body(
            curvature_radius=0.02, cross_radius=float(cross[place]), curvature_axis=axes[place]
        )
        alone = met(one, velocity=velocity[place])
        part = scene.take(place)
        for name in ("radius", "effective_shear_modulus", "cross_stiffness_ratio", "axis_ratio"):
            assert getattr(part.pair, name) == pytest.approx(getattr(alone.pair, name), rel=1e-14)
        assert np.allclose(part.frame, alone.frame, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize(
    "varied",
    [
        {"curvature_radius": [0.02, 0.03]},
        {"cross_radius": [0.01, 0.02]},
        {"curvature_axis": [[1, 0, 0], [1, 1, 0]]},
        {"inertia": [1e-5 * np.eye(3), 2e-5 * np.eye(3)]},
    ],
    ids=lambda varied: next(iter(varied)),
)
def test_a_batch_that_varies_one_entry_of_a_body(varied):
    given = {"curvature_radius": 0.02, "cross_radius": 0.01, "curvature_axis": [1, 0, 0]}
    ((name, values),) = varied.items()
    scene = met(body(**given | varied))
    assert scene.shape == (2,)
    for place, value in enumerate(values):
        alone = met(body(**given | {name: value}))
        assert np.linalg.norm(scene.take(place).psi1) == pytest.approx(
            np.linalg.norm(alone.psi1), rel=1e-13
        )
        assert scene.take(place).pair.radius == pytest.approx(alone.pair.radius, rel=1e-13)


def test_groups_in_space_have_the_stiffness_of_each_direction():
    kappa, ratio = np.array([0.8, 1.0]), 1.25
    X = np.array([[0.9, 0.2], [0.2, 1.4]])
    given = {"psi1": [1.2, 0.4], "chi": kappa[:, None] * X, "lam": [0.1, -0.2], "rho": 0.25}
    scene = Scene.nondimensional(**given, cross_stiffness_ratio=ratio)
    assert scene.psi1 == pytest.approx(np.array(given["psi1"]))
    assert scene.chi == pytest.approx(given["chi"])
    assert scene.lam == pytest.approx(np.array(given["lam"]))
    assert scene.eta == pytest.approx(np.array(given["lam"]) / 0.25 * [1.0, ratio])
    with pytest.raises(ValueError, match=r"chi.*symmetric"):
        Scene.nondimensional(**given | {"chi": X}, cross_stiffness_ratio=ratio)
    for other in (-1.0, 0.49, 2.01, [1.0, 100.0]):
        with pytest.raises(ValueError, match=r"cross_stiffness_ratio.*\[0.5, 2\]"):
            Scene.nondimensional(**given, cross_stiffness_ratio=other)


@pytest.mark.parametrize("ratio", [1.0, 0.7])
def test_the_largest_chi_is_an_eigenvalue_of_a_tensor_that_is_not_symmetric(ratio):
    given = {"psi1": [2.0, 1.0], "lam": [0.2, 0.1], "rho": 0.2}
    chi = np.array([[0.9, 0.2], [0.2 * ratio, 1.4 * ratio]])
    scene = Scene.nondimensional(**given, chi=chi, cross_stiffness_ratio=ratio)
    assert kinetics.largest_chi(scene) == pytest.approx(
        np.linalg.eigvals(scene.chi).max(), rel=1e-14
    )
    plane = Scene.nondimensional(psi1=[1.0, 2.0], chi=1.5, lam=0.1, rho=0.2)
    assert kinetics.largest_chi(plane).tolist() == plane.chi.tolist()
