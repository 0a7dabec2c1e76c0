"""Bodies: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import pickle

import attrs
import numpy as np
import pytest

from contactlab import (
    Encounter,
    RigidBody,
    Scene,
    Sphere,
    collide,
    shapes,
)
from tests.solve.any_scene import (
    BALL,
    DOWN,
    EXACT,
    FEW,
    OFF_CENTRE,
    SPHERES,
    STEEL,
    WITH_BODIES,
    body,
    meeting,
)

AXES = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
BODIES = {
    "inertia": body(),
    "principal": RigidBody(
        mass=1.0, principal=(0.01, 0.014, 0.005), material=STEEL, curvature_radius=0.01
    ),
    "axes": RigidBody(
        mass=1.0, principal=(0.01, 0.014, 0.005), axes=AXES, material=STEEL, curvature_radius=0.01
    ),
    "batch": RigidBody(
        mass=1.0, principal=np.array([(0.01, 0.014, 0.005), (0.02, 0.02, 0.02)]), axes=AXES,
        material=STEEL, curvature_radius=0.01,
    ),
    "rod": shapes.rod(length=1.0, radius=0.02, material=STEEL, normal=DOWN, axis=(0.5, 0, 0.8))[0],
    "box": shapes.box(
        sides=(0.1, 0.2, 0.3), corner_radius=0.01, material=STEEL, normal=DOWN, axes=AXES
    )[0],
    "ellipsoid": shapes.ellipsoid(semi_axes=(0.02, 0.03, 0.04), material=STEEL, normal=DOWN)[0],
}  # fmt: skip
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
    with pytest.raises(ValueError, match=r"give one of the two.*None for the other"):
        attrs.evolve(BODIES[name], inertia=NEW)


@pytest.mark.parametrize("name", ["inertia", "rod"])
def test_principal_moments_beside_an_inertia_are_refused(name):
    with pytest.raises(ValueError, match=r"give one of the two.*None for the other"):
        attrs.evolve(BODIES[name], principal=(1.0, 1.5, 2.0))
    moments = attrs.evolve(BODIES[name], inertia=None, principal=(1.0, 1.5, 2.0))
    assert np.array_equal(moments.inertia, NEW)


def test_a_body_tells_what_it_was_given():
    assert "principal=" in repr(BODIES["axes"])
    assert "inertia=" not in repr(BODIES["axes"])
    assert "inertia=" in repr(BODIES["inertia"])
    assert "principal=" not in repr(BODIES["inertia"])


@pytest.mark.parametrize(
    ("one_of", "other"),
    [("inertia", "inertia"), ("principal", "axes"), ("principal", "inertia"), ("box", "ellipsoid"),
     ("rod", "box")],
)  # fmt: skip
def test_scenes_of_bodies_stack(one_of, other):
    contact = (0.02, 0.01, -0.1)
    pairs = [
        meeting(BODIES[name], velocity=(0.4, slip, -1.0), contact=contact)
        for name, slip in ((one_of, 0.1), (other, 0.2))
    ]
    result = FEW.sweep([met.scene for met in pairs]).check()
    for met, item in zip(pairs, result, strict=True):
        alone = collide(met, FEW)
        assert item.velocity_in_space == pytest.approx(alone.velocity, rel=1e-9)
        assert item.rebound_spin == pytest.approx(alone.spin, rel=1e-9)


AGAINST_A_BALL = {
    "spheres": Encounter(
        BALL, Sphere(0.1, STEEL), 0.3, normal=DOWN, velocity=(0.5, 0.3, -1.0), spin=(0, 0, 5)
    ),
    "bodies": attrs.evolve(OFF_CENTRE, target=Sphere(0.1, STEEL)),
}


@pytest.mark.parametrize(("name", "met"), [("spheres", SPHERES), ("bodies", OFF_CENTRE)])
def test_scenes_of_unlike_targets_stack(name, met):
    scenes = [met.scene, AGAINST_A_BALL[name].scene]
    result = FEW.sweep(scenes).check()
    assert "2 impacts" in str(result)
    for scene, item in zip(scenes, result, strict=True):
        assert item.psi2 == pytest.approx(FEW.run(scene).psi2, abs=1e-12)


def test_scenes_of_bodies_given_by_inertia_or_by_principal_moments_stack():
    principal = {"mass": 1.0, "material": STEEL, "curvature_radius": 0.01}
    turned = RigidBody(principal=(0.01, 0.014, 0.005), axes=np.eye(3)[[1, 0, 2]], **principal)
    scenes = [meeting(body()).scene, meeting(turned).scene]
    plain = meeting(attrs.evolve(turned, axes=None)).scene
    for order in (scenes, scenes[::-1], [scenes[1], plain], [plain, scenes[1]]):
        stacked = Scene.stack(order)
        inertias = np.array([scene.encounter.body.inertia for scene in order])
        np.testing.assert_array_equal(stacked.encounter.body.inertia, inertias)
        for scene, item in zip(order, EXACT.run(stacked), strict=True):
            assert item.psi2 == EXACT.run(scene).psi2


RINGING = meeting(body(bending_period=1.0), velocity=(0.5, 0.3, -1.0), contact=(0.02, 0.01, -0.1))
YIELDING = Sphere(0.01, attrs.evolve(STEEL, yield_stress=1e5))
#: A body with a narrow contact, small by its mean curvature alone.
NARROW = meeting(attrs.evolve(body(), cross_radius=1e-4, curvature_axis=(1, 0, 0)))
STACKED = [
    ([RINGING.scene, RINGING.scene], "body rings"),
    ([NARROW.scene, meeting().scene], "a/R = 0.768"),
    ([NARROW.scene, OFF_CENTRE.scene], "a/R = 0.768"),
    ([AGAINST_A_BALL["spheres"].scene] * 2, "spin about the normal"),
    ([RINGING.scene, OFF_CENTRE.scene], "body rings"),
    ([OFF_CENTRE.scene, RINGING.scene], "body rings"),
    ([attrs.evolve(WITH_BODIES, sphere=YIELDING), WITH_BODIES], "yield"),
    ([WITH_BODIES, attrs.evolve(WITH_BODIES, sphere=YIELDING)], "yield"),
    ([AGAINST_A_BALL["spheres"].scene, SPHERES.scene], "spin about the normal"),
]  # fmt: skip


@pytest.mark.parametrize(("scenes", "word"), STACKED)
def test_cautions_of_one_scene_hold_in_a_sweep_with_others(scenes, word):
    def told(result):
        return any(word in text for text in (*result.cautions, *map(str, result.plan.left_out)))

    assert any(told(FEW.run(scene)) for scene in scenes)
    assert told(FEW.sweep(scenes))
