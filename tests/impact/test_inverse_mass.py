"""The inverse mass of bodies at their contact."""

import attrs
import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Material, RigidBody, Scene
from contactlab.impact import kinetics


@pytest.mark.parametrize("size", [3, 4])
def test_a_contact_that_all_bodies_of_a_batch_share(size):
    """Of as many bodies as there are axes, an inverse inertia of them all is no vector."""
    moments = np.linspace(1.0, 2.0, size)[:, None, None] * np.diag([0.01, 0.014, 0.005])
    steel = Material.named("steel")
    body = RigidBody(mass=1.0, inertia=moments, material=steel, curvature_radius=0.01)
    spin = np.tile((0.0, 0.0, 3.0), (size, 1))
    motion = {"normal": (0.0, 0.0, -1.0), "velocity": (0.5, 0.0, -1.0), "spin": spin}
    contact = (0.02, 0.01, -0.1)
    many = Encounter(body, HalfSpace(steel), 0.3, contact=contact, **motion).scene.inverse_mass
    for place, moment in enumerate(moments):
        r = np.array(contact)
        K = np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])
        W = np.eye(3) - K @ np.linalg.inv(moment) @ K
        assert many[place][0, 0] == pytest.approx(W[2, 2], rel=1e-12)
        assert np.linalg.eigvalsh(many[place]) == pytest.approx(np.linalg.eigvalsh(W), rel=1e-12)


def test_no_inverse_mass_is_refused_or_taken_but_by_its_eigenvalues():
    """Random ones, of which some are indefinite and some nearly singular, alone and together."""
    random = np.random.default_rng(1)
    axes = np.linalg.qr(random.normal(size=(300, 3, 3)))[0]
    least = random.choice([-1e-3, -1e-15, 1e-16, 3e-13, 1e-11, 1e-9, 0.1], 300)
    sizes = np.stack([least, *random.uniform(0.5, 2.0, (2, 300))], axis=-1)
    W = np.einsum("nij,nj,nkj->nik", axes, sizes, axes)
    diagonal = np.sqrt(np.abs(np.einsum("nii->ni", W)))
    scaled = W / (diagonal[:, :, None] * diagonal[:, None, :])
    right = (np.linalg.eigvalsh(scaled)[:, 0] > 1e-14) & (np.einsum("nii->ni", W) > 0).all(axis=-1)
    pair = Scene.nondimensional(psi1=1.0, chi=1.0).pair
    entries = {"pair": pair, "friction_coefficient": 0.3, "normal_speed": 1.0}

    for inverse in (W, *W[~right]):
        with pytest.raises(ValueError, match="positive definite"):
            Scene(None, None, inverse_mass=inverse, **entries)
    for inverse in (W[right], *W[right]):
        assert Scene(None, None, inverse_mass=inverse, **entries).shape == inverse.shape[:-2]


def turned_poles(count, *slip):
    """Bodies of three moments that land on a pole, in any frame; slip along two of their axes."""
    random = np.random.default_rng(2)
    axes = np.linalg.qr(random.normal(size=(count, 3, 3)))[0]
    axes[:, :, 0] *= np.sign(np.linalg.det(axes))[:, None]
    normal, turn = axes[:, :, 2], random.uniform(0.0, np.pi, count)
    cosine, sine = np.cos(turn)[:, None], np.sin(turn)[:, None]
    about = np.stack([cosine * axes[:, :, 0] + sine * axes[:, :, 1],
                      cosine * axes[:, :, 1] - sine * axes[:, :, 0], normal], axis=-1)  # fmt: skip
    body = RigidBody(mass=0.3, principal=(1e-4, 2e-4, 3e-4), axes=about,
                     material=Material.named("steel"), curvature_radius=0.02)  # fmt: skip
    return Encounter(body, HalfSpace(body.material), 0.3, normal=normal, contact=0.05 * normal,
                     velocity=1.3 * normal + about[:, :, :2] @ slip)  # fmt: skip


@pytest.mark.parametrize(
    ("slip", "central"),
    [((0.0, 0.0), True), ((1e-13, 1e-13), True), ((1e-9, 0.0), True), ((1e-6, 1e-6), False)],
)
def test_a_slip_that_is_rounding_turns_by_nothing(slip, central):
    """Its rounding has no direction beside the axes of W: the impact is central, and exact."""
    assert (turned_poles(50, *slip).scene.inverse_mass is None) == central


@pytest.mark.parametrize("ratio", [1.0, 0.7])
def test_groups_of_one_impact_are_those_of_its_batch(ratio):
    """One is asked in plain numbers; determinants tell the share of W_nn that friction leaves."""
    random = np.random.default_rng(4)
    given = {
        "psi1": random.uniform(-2.0, 2.0, (30, 2)),
        "lam": random.uniform(-0.3, 0.3, (30, 2)),
        "chi": np.diag([1.3, 1.6 * ratio]),
    }
    many = Scene.nondimensional(**given, rho=0.4, cross_stiffness_ratio=ratio)
    W = many.inverse_mass
    share = np.linalg.det(W) / (W[:, 0, 0] * np.linalg.det(W[:, 1:, 1:]))
    assert kinetics.free_share(many) == pytest.approx(share, rel=1e-12)
    groups = (many.lam, many.eta, many.psi1)
    lengths = np.stack([np.linalg.norm(each, axis=-1) for each in groups])
    assert np.stack(kinetics.sizes(many)) == pytest.approx(lengths, rel=1e-14)
    for place in range(30):
        one = many.take(place)
        assert kinetics.sizes(one) == pytest.approx(lengths[:, place], rel=1e-14)
        assert kinetics.free_share(one) == pytest.approx(share[place], rel=1e-12)
        assert kinetics.largest_chi(one) == pytest.approx(kinetics.largest_chi(many)[place])


def test_one_encounter_is_refused_or_made_as_a_batch_of_one():
    """Of absurd scales too: one alone takes a shorter way to its scene."""
    random = np.random.default_rng(5)
    steel, made, refused = Material.named("steel"), 0, 0
    for far in (0, 0, 60, 90, 160, 160) * 20:
        scale = 10.0 ** random.uniform(-far, far, 3)
        body = RigidBody(mass=1.0, principal=random.uniform(0.6, 1.0, 3), material=steel,
                         curvature_radius=0.1)  # fmt: skip
        given = np.clip(scale[:2, None] * random.normal(size=(2, 3)), -1e100, 1e100)
        given[0, 2] = abs(given[0, 2])
        about = {"normal": (0, 0, 1), "contact": random.normal(size=3)}
        alone, batch = (
            Encounter(body, HalfSpace(steel), scale[2], velocity=velocity, spin=spin, **about)
            for velocity, spin in (given, given[:, None])
        )
        try:
            many = batch.scene
        except ValueError:
            with pytest.raises(ValueError, match=r"must|cannot|separate"):
                alone.scene  # noqa: B018
            refused += 1
            continue
        scene = alone.scene
        assert scene == attrs.evolve(scene)
        for name, number in scene.numbers().items():
            assert isinstance(number, float) or not number.flags.writeable
            other = np.reshape(many.numbers()[name], np.shape(number))
            assert number == pytest.approx(other, rel=1e-12, abs=1e-300)
        assert scene.inverse_mass == pytest.approx(many.inverse_mass[0], rel=1e-12, abs=1e-12)
        made += 1
    assert min(made, refused) > 20
