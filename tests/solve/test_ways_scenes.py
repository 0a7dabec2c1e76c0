"""Scenes: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor
from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import (
    Scene,
    Simulation,
    collide,
    create,
)
from contactlab.contracts import (
    CausalTangentialLaw,
    TangentialResponse,
)
from contactlab.impact import kinetics
from tests.present import extra
from tests.solve.any_scene import (
    BATCHES,
    EXACT,
    FEW,
    OFF_CENTRE,
    ONES,
    WITH_BODIES,
    every_way,
    many,
    one,
    one_scene,
)


@every_way
def test_the_index_is_numbered(scene):
    if not scene.shape:
        assert scene.index == 0
        assert scene.numbered(7).index == 7
        return
    assert scene.index.tolist() == [0, 1, 2, 3, 4, 5]
    assert scene.take(slice(1, 3)).index.tolist() == [1, 2]
    assert scene.take(2).index == 2
    for where, part in kinetics.parts(scene):
        assert np.array_equal(np.ravel(part.index), np.ravel(scene.index[where]))
        assert np.array_equal(np.ravel(part.central.index), np.ravel(scene.index[where]))


@attrs.frozen
class Seeded(CausalTangentialLaw):
    """No friction; keeps the index that a random seed would come from."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"vectors"})
    seen: ClassVar[list[int]] = []

    def start(self, scene, normal):
        self.seen.extend(np.ravel(scene.index).tolist())

    def advance(self, state, increment, before, after):
        zero = 0.0 * np.asarray(after.force)
        return TangentialResponse(0.0 * np.asarray(increment.displacement), zero), state

    def stiffness(self, scene, normal):
        return 1.0


@pytest.mark.parametrize("name", BATCHES)
@pytest.mark.parametrize("options", [{}, {"chunk": 300}, {"executor": True}], ids=str)
def test_a_seeded_law_gets_as_many_numbers_as_impacts(name, options):
    laws = Simulation(
        tangential=Seeded(), integrator=create("integrator.symplectic", steps=20)
    )  # fmt: skip
    Seeded.seen.clear()
    with ThreadPoolExecutor(2) as pool:
        options = {"executor": pool} if "executor" in options else options
        laws.sweep(many(name), **options).check()
    assert sorted(set(Seeded.seen)) == list(range(2000))


def test_a_seeded_law_in_a_collision_of_which_some_pass():
    """The index is the place in the whole batch of encounters."""
    velocity = np.tile((0.5, 0.3, -1.0), (6, 1))
    velocity[[0, 3], 2] = 1.0
    met = attrs.evolve(OFF_CENTRE, velocity=velocity)
    Seeded.seen.clear()
    laws = Simulation(tangential=Seeded(), integrator="symplectic")
    assert collide(met, laws, separating="pass").collided.sum() == 4
    assert sorted(set(Seeded.seen)) == [1, 2, 4, 5]


GRIDS = [
    {"psi1": [1.0, 2.0], "chi": [1.0, 2.0, 3.0]},
    {"psi1": [1.0, 2.0], "chi": 1.4, "lam": [0.1, 0.2, 0.3], "eta": 0.5},
    {"psi1": 1.0, "chi": 1.4, "lam": [0.1, 0.2], "eta": [0.2, 0.4, 0.5]},
    {"psi1": [1.0, 2.0], "chi": 1.4, "lam": [0.0, 0.2, 0.3], "rho": [0.3, 0.5]},
    {"lam": [0.0, 0.2, 0.3], "psi1": 1.0, "chi": 1.4, "rho": 0.5},
]


@extra("xarray")
@pytest.mark.parametrize("entries", GRIDS, ids=lambda entries: "-".join(entries))
def test_a_grid_of_any_group(entries):
    lists = {name: values for name, values in entries.items() if isinstance(values, list)}
    grid = Scene.grid(**entries)
    assert grid.dimensions == tuple(map(len, lists.values()))
    assert list(grid.axes) == list(lists)
    result = EXACT.sweep(grid).check()
    sizes = {name: len(values) for name, values in lists.items()}
    assert dict(result.to_xarray().sizes) == sizes
    last = {name: values[-1] if name in lists else values for name, values in entries.items()}
    assert result[-1].psi2 == pytest.approx(EXACT.run(Scene.nondimensional(**last)).psi2, abs=1e-11)


OTHERS = [
    ("central", {"psi1": 1.6}),
    ("central", {"chi": 1.5}),
    ("planar", {"psi1": 1.6}),
    ("planar", {"lam": 0.4, "eta": 1.0}),
    ("planar", {"eta": 0.6}),
    ("space", {"psi1": (0.8, 1.7)}),
    ("space", {"lam": (-0.2, 0.2)}),
    ("space", {"chi": [[0.6, 0.1], [0.1, 0.9]]}),
    ("space", {"rho": 0.2}),
]


@pytest.mark.parametrize(("kind", "changes"), OTHERS)
def test_scenes_are_equal_if_their_numbers_are(kind, changes):
    scene = one(kind)
    assert scene == one(kind) == attrs.evolve(scene) == pickle.loads(pickle.dumps(scene))
    assert hash(scene) == hash(one(kind))
    assert {scene: 1}[one(kind)] == 1
    other = one(kind, **changes)
    assert scene != other
    assert len({scene, other}) == 2


def test_scenes_of_other_kinds_are_not_equal():
    assert len(set(ONES.values())) == 3
    assert len(set(BATCHES.values())) == 4
    batch = BATCHES["mixed"]
    assert batch == attrs.evolve(batch) == Scene.stack(list(ONES.values()))
    assert batch != Scene.stack(list(reversed(ONES.values())))
    assert batch != BATCHES["space"]


WITH_FRICTION = Scene.nondimensional(
    psi1=1.5, chi=1.4, lam=0.2, friction_coefficient=0.3, poisson_ratio=0.3
)


@one_scene
@pytest.mark.parametrize(
    ("other", "words"),
    [
        (3, "scenes.1. = 3: must be a Scene"),
        (None, "must be a Scene"),
        (BATCHES["planar"], "must be a single impact"),
        (BATCHES["mixed"], "must be a single impact"),
        (WITH_BODIES, "must have a sphere if, and only if"),
        (WITH_FRICTION, "must have a friction coefficient if"),
    ],
    ids=["3", "None", "batch", "mixed", "bodies", "friction"],
)
def test_sweeps_that_are_refused(scene, other, words):
    with pytest.raises(ValueError, match=words):
        EXACT.sweep([scene, other])


@pytest.mark.parametrize(
    "names",
    [("central", "planar"), ("planar", "central"), ("central", "space"), ("space", "planar"),
     ("central", "planar", "space"), ("space", "central", "space", "planar")],
)  # fmt: skip
def test_unlike_impacts_in_one_sweep_have_the_answers_of_each_alone(names):
    scenes = [ONES[name] for name in names]
    result = EXACT.sweep(scenes).check()
    for place, (scene, item) in enumerate(zip(scenes, result, strict=True)):
        alone = EXACT.run(scene)
        found = np.atleast_1d(item.psi2)
        expected = np.zeros_like(found)
        expected[: np.size(alone.psi2)] = alone.psi2
        assert found == pytest.approx(expected, abs=1e-12), place
        assert item.normal_restitution == pytest.approx(alone.normal_restitution, abs=1e-12)
        assert item.energy.friction_work == pytest.approx(alone.energy.friction_work, rel=1e-12)


def test_a_batch_of_two_axes_goes_its_own_ways():
    lam = np.array([[0.0, 0.2, 0.1], [0.0, 0.2, 0.3]])
    psi1 = np.array([[0.5, 1.5, 3.0], [1.0, 2.0, 2.5]])
    scene = Scene.nondimensional(psi1=psi1, chi=1.4, lam=lam, rho=0.4)
    result = EXACT.run(scene).check()
    for place in np.ndindex(2, 3):
        assert result.psi2[place] == EXACT.run(scene.take(place)).psi2
    assert FEW.run(scene, estimate_error=True).restitution_error_estimate.shape == (2, 3)
    history = FEW.run(scene, history="fields").history
    assert history.normal_force.shape[1:] == (2, 3)
    assert history.fields["radius"].shape[1:] == (2, 3, 10)
