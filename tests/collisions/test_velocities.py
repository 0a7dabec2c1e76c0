"""Velocities and spins after an impact, from arrays of JAX and PyTorch, against ``collide``."""

import numpy as np
import pytest

from contactlab import (
    Collision,
    Encounter,
    HalfSpace,
    Material,
    Sphere,
    collide,
    shapes,
)

STEEL, GLASS = Material.named("steel"), Material.named("soda-lime glass")
BALL, BEAD, FLOOR = Sphere(0.01, STEEL), Sphere(0.02, GLASS), HalfSpace(STEEL)
#: One impact: the slip reverses, is partial, and is gross at these coefficients of friction.
ONE = {
    "normal": [0.3, 0.1, -1.0], "velocity": [1.0, 0.2, -2.0], "spin": [0.0, 30.0, 10.0],
    "target_velocity": [0.0, 0.0, 0.1], "target_spin": [10.0, 0.0, 0.0],
}  # fmt: skip
FRICTIONS = (0.5, 0.3, 0.02)
ROD, _ = shapes.rod(length=0.1, radius=0.01, material=STEEL, normal=(0, 0, 1), axis=(0, 0, 1))
SIZES = {"velocity": 1.0, "spin": 0.01, "target_velocity": 1.0, "target_spin": 0.02}


def drawn(count=200):
    """Return vectors of impacts, a third of which separate; some without slip or spin."""
    draw = np.random.default_rng(3)
    vectors = {name: draw.normal(size=(count, 3)) for name in ONE}
    vectors["spin"] *= 100.0
    vectors["target_spin"] *= 50.0
    for name in ("spin", "target_spin", "target_velocity"):
        vectors[name][:20] = 0.0
    vectors["velocity"][:10] = vectors["normal"][:10]
    return vectors


def flat(after):
    """Return the velocities of surfaces in one array, m/s."""
    return np.concatenate([SIZES[n] * np.asarray(getattr(after, n)) for n in SIZES], axis=-1)


def assert_equal(made, target, friction, restitution, array, atol=1e-12):
    vectors = {n: v for n, v in drawn().items() if not (n == "target_spin" and target is FLOOR)}
    encounter = Encounter(BALL, target, friction, **vectors)
    plain = collide(encounter, restitution=restitution, separating="pass")
    assert 20 < np.sum(plain.collided) < 180
    given = {name: array(values) for name, values in vectors.items()}
    found = made(given, target, friction, restitution)
    np.testing.assert_allclose(flat(found), flat(plain), rtol=0.0, atol=atol)


def after(vectors, target, friction, restitution):
    return Collision.of_arrays(BALL, target, friction, **vectors, restitution=restitution)


def falling(speed):
    """Return a restitution that falls with the speed."""
    return 0.9 / (1.0 + 0.1 * speed)


def test_arrays_of_numpy_are_referred_to_collide():
    with pytest.raises(ValueError, match=r"arrays = .*one of JAX or PyTorch; collide takes NumPy"):
        Collision.of_arrays(BALL, BEAD, 0.3, **ONE)


@pytest.mark.parametrize(
    ("target", "restitution"),
    [
        (FLOOR, 0.8),
        pytest.param(BEAD, 0.0, marks=pytest.mark.slow),
        pytest.param(BEAD, falling, marks=pytest.mark.slow),
    ],
    ids=["floor", "bead", "by speed"],
)
def test_jax_gives_what_collide_gives(jax, target, restitution):
    """To 1e-12 m/s below e = 0.99."""

    def made(vectors, target, friction, restitution):
        return jax.jit(lambda v: after(v, target, friction, restitution))(vectors)

    friction = np.random.default_rng(4).uniform(0.0, 1.0, 200)
    assert_equal(made, target, friction, restitution, jax.numpy.asarray)


@pytest.mark.slow
def test_jax_gives_elastic_impacts(jax):
    """To the 1e-9 of psi2 that the table is made to: NumPy leaves out small terms of it."""

    def mapped(vectors, target, friction, restitution):
        one = lambda v: after(v, target, friction, restitution)  # noqa: E731
        return jax.jit(jax.vmap(one))(vectors)

    for friction in (0.0, 0.3):
        assert_equal(mapped, BEAD, friction, 1.0, jax.numpy.asarray, atol=1e-10)
    hollow = Sphere(0.01, STEEL, gyration_ratio=0.8)
    assert Collision.of_arrays(
        hollow, FLOOR, 0.2, normal=[0, 0, -1], velocity=jax.numpy.asarray([1.0, 0.0, -1.0])
    ).velocity[2] == pytest.approx(1.0)


def differences(parts, friction, restitution):
    """Return central differences of all answers by all numbers, over the sizes of spins."""
    columns = []
    for name, part in parts.items():
        for k in range(3):
            step = 1e-5 / SIZES.get(name, 1.0)
            ends = []
            for sense in (1.0, -1.0):
                moved = dict(parts, **{name: np.array(part)})
                moved[name][k] += sense * step
                encounter = Encounter(BALL, BEAD, friction, **moved)
                ends.append(flat(collide(encounter, restitution=restitution)))
            columns.append((ends[0] - ends[1]) / 2e-5)
    return np.stack(columns, axis=-1)


@pytest.mark.slow
def test_jax_differentiates(jax):
    """Against central differences, to 1e-6; without slip too, which has no direction."""

    def answers(parts, friction):
        made = Collision.of_arrays(BALL, BEAD, friction, **parts, restitution=0.8)
        return jax.numpy.concatenate([SIZES[n] * getattr(made, n) for n in SIZES])

    slopes = jax.jit(jax.jacfwd(answers))
    central = dict(ONE, velocity=ONE["normal"], target_velocity=[0.0] * 3)
    central |= {"spin": [0.0] * 3, "target_spin": [0.0] * 3}
    for parts, friction in (*((ONE, each) for each in FRICTIONS), (central, 0.3)):
        given = {name: np.array(part, dtype=float) for name, part in parts.items()}
        found = slopes(given, friction)
        found = np.concatenate([np.asarray(found[n]) / SIZES.get(n, 1.0) for n in given], axis=1)
        expected = differences(given, friction, 0.8)
        # the change of slip has a kink in its third derivative at no slip
        np.testing.assert_allclose(found, expected, atol=1e-6 if parts is ONE else 1e-5)
    one = {name: jax.numpy.asarray(part) for name, part in ONE.items()}
    back = jax.jit(jax.grad(lambda mu: (answers(one, mu) ** 2).sum()))(0.3)
    ahead, behind = (
        (flat(collide(Encounter(BALL, BEAD, 0.3 + s, **ONE), restitution=0.8)) ** 2).sum()
        for s in (1e-5, -1e-5)
    )
    assert float(back) == pytest.approx((ahead - behind) / 2e-5, abs=1e-6)


def test_known_numbers_are_refused(jax):
    one = jax.numpy.asarray([1.0, 0.0, -1.0])
    good = {"normal": [0.0, 0.0, -1.0], "velocity": one}
    for changed, words in (
        ({"velocity": one[:2]}, r"velocity\.shape = \(2,\): must end with 3"),
        ({"velocity": one * np.nan}, "velocity = .*finite"),
        ({"normal": one * 0.0}, "normal = .*must not be zero"),
        ({"target_spin": one}, "target_spin = .*half-space does not spin"),
        ({"friction_coefficient": -0.1}, "friction_coefficient = -0.1"),
        ({"restitution": 1.5}, "restitution = 1.5"),
        ({"restitution": np.array([0.9 + 0.1j])}, "restitution = .*must be a real number"),
        ({"restitution": None}, "restitution = None: must be a real number"),
        ({"velocity": jax.numpy.ones((4, 3)), "normal": np.ones((2, 3))}, "shapes = .*must fit"),
        ({"body": ROD}, "body = RigidBody.*must be a Sphere; arrays of .* are for spheres"),
        ({"body": Sphere(0.01, STEEL, gyration_ratio=0.2)}, "chi = .* with arrays of jax"),
    ):
        arguments = {"body": BALL, "target": FLOOR, "friction_coefficient": 0.3} | good | changed
        with pytest.raises(ValueError, match=words):
            Collision.of_arrays(**arguments)


@pytest.mark.slow
def test_traced_numbers_out_of_range_are_nan(jax):
    one = jax.numpy.asarray([1.0, 0.0, -1.0])
    good = {"normal": [0.0, 0.0, -1.0], "velocity": one}
    for name in ("friction_coefficient", "restitution"):
        traced = jax.jit(
            lambda x, name=name: Collision.of_arrays(
                BALL, FLOOR, **{"friction_coefficient": 0.3} | good | {name: x}
            )
        )
        assert np.isnan(traced(-0.1).velocity).any(), name
        assert np.isfinite(traced(0.1).velocity).all(), name
    lost = jax.jit(lambda v: Collision.of_arrays(BALL, BEAD, 0.3, normal=[0, 0, -1.0], velocity=v))
    assert np.isnan(flat(lost(one * np.nan))).all()


def test_tensors_give_what_collide_gives(torch):
    each = np.random.default_rng(4).uniform(0.0, 0.99, 200)
    for restitution in (0.8, each, falling):
        assert_equal(after, BEAD, 0.3, restitution, torch.tensor)
    assert_equal(after, FLOOR, 0.3, 1.0, torch.tensor, atol=1e-10)
    velocity = torch.tensor(ONE["velocity"], dtype=torch.float64, requires_grad=True)
    for friction in FRICTIONS:
        assert torch.autograd.gradcheck(
            lambda v, mu=friction: after(ONE | {"velocity": v}, BEAD, mu, 0.8), (velocity,),
            eps=1e-6, atol=1e-6,
        )  # fmt: skip
    single = after(ONE | {"velocity": velocity.float()}, BEAD, 0.3, 0.8)
    assert {each.dtype for each in single} == {torch.float32}
