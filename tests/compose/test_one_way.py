"""What holds for spheres holds for bodies, by the same row: one scene, one way, one result."""

from __future__ import annotations

import csv
import json
import math
import pickle
import re
from concurrent.futures import ThreadPoolExecutor
from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import (
    Collision,
    Encounter,
    HalfSpace,
    Material,
    RigidBody,
    Scene,
    Simulation,
    Sphere,
    collide,
    create,
    load_path,
    read_scene,
    rebound,
    shapes,
)
from contactlab.contracts import (
    Ends,
    SteppedTangentialLaw,
    TangentialMotion,
    TangentialResponse,
)
from contactlab.contracts.status import Status
from contactlab.contracts.whole_impact import WholeImpact
from contactlab.outcome.export import write_csv, write_json, write_npz
from tests.present import extra

STEEL = Material.named("steel")
FLOOR = HalfSpace(STEEL)
DOWN = (0.0, 0.0, -1.0)
EXACT = Simulation()
SPRINGS = Simulation(tangential="springs", integrator="symplectic")
FEW = Simulation(
    tangential=create("tangential.springs", springs=10),
    integrator=create("integrator.symplectic", steps=40),
)
TURNING = {"chi": [[0.6, 0.1], [0.1, 0.8]], "lam": (-0.2, 0.1), "rho": 0.1}
PSI1 = np.array([0.5, 1.5, 3.0])

#: One impact of spheres, one in which friction changes the approach, and one in which slip turns.
ONES = {
    "central": Scene.nondimensional(psi1=1.5, chi=1.4),
    "planar": Scene.nondimensional(psi1=1.5, chi=1.4, lam=0.2, eta=0.5),
    "space": Scene.nondimensional(psi1=(0.8, 1.6), **TURNING),
}
#: Three impacts alike, and one of each in one batch.
BATCHES = {
    "central": Scene.nondimensional(psi1=PSI1, chi=1.4),
    "planar": Scene.nondimensional(psi1=PSI1, chi=1.4, lam=0.2, eta=0.5),
    "space": Scene.nondimensional(psi1=np.stack((PSI1, 0.3 * PSI1), axis=-1), **TURNING),
    "mixed": Scene.stack(list(ONES.values())),
}
ALL = [*ONES.values(), *BATCHES.values()]
NAMES = [*ONES, *(f"{name} batch" for name in BATCHES)]
COUPLED = [(name, scene) for name, scene in zip(NAMES, ALL, strict=True) if "central" not in name]

every_scene = pytest.mark.parametrize("scene", ALL, ids=NAMES)
one_scene = pytest.mark.parametrize("scene", ONES.values(), ids=ONES)
each_batch = pytest.mark.parametrize("scene", BATCHES.values(), ids=BATCHES)
coupled_scene = pytest.mark.parametrize(
    "scene", [scene for _, scene in COUPLED], ids=[name for name, _ in COUPLED]
)


def body(inertia=(0.01, 0.014, 0.005), **changes):
    return RigidBody(
        mass=1.0, inertia=np.diag(inertia), material=STEEL, curvature_radius=0.01, **changes
    )


def meeting(one=None, *, velocity=(0.5, 0.0, -1.0), contact=(0.0, 0.0, -0.1), **changes):
    """Return a body that meets the floor; with its contact below its centre W does not couple."""
    numbers = {"friction_coefficient": 0.3, "normal": DOWN, "velocity": velocity} | changes
    return Encounter(body() if one is None else one, FLOOR, contact=contact, **numbers)


OFF_CENTRE = meeting(velocity=(0.5, 0.3, -1.0), contact=(0.02, 0.01, -0.1))
BALL = Sphere(0.01, STEEL)


def statuses(result):
    return [status.name for status in np.ravel(np.array(result.status, dtype=object))]


# Results.


@pytest.mark.parametrize("psi1", [-1.5, -0.3, 0.0, 0.8])
def test_a_planar_impact_beside_impacts_in_space_is_that_of_the_plane(psi1):
    """Slip against t1 too, alone and in a batch, told as a vector or as a number."""
    groups = {"chi": 1.4, "lam": 0.2, "eta": 0.5}
    planar = Scene.nondimensional(psi1=psi1, **groups)
    alone = EXACT.run(planar)
    batch = EXACT.run(Scene.stack([ONES["space"], planar, ONES["central"]]))
    single = EXACT.run(batch.scene.take(1))
    for found in (batch.psi2[1], single.psi2):
        assert found == pytest.approx([alone.psi2, 0.0], abs=1e-14)
    assert batch.energy.friction_work[1] == pytest.approx(alone.energy.friction_work, rel=1e-12)
    assert np.linalg.norm(batch.impulse[1] - alone.impulse) < 1e-13


@each_batch
def test_estimates_of_an_item_are_numbers(scene):
    """And those of the impact alone."""
    result = FEW.run(scene, estimate_error=True)
    for place, item in enumerate(result):
        alone = FEW.run(scene.take(place), estimate_error=True)
        for name in ("psi2_error_estimate", "restitution_error_estimate"):
            estimate = getattr(item, name)
            assert isinstance(estimate, float)
            assert estimate == getattr(result, name)[place]
            assert estimate == pytest.approx(getattr(alone, name), rel=1e-6)


@every_scene
def test_a_misspelt_attribute_is_told_its_neighbour(scene):
    result = EXACT.run(scene)
    with pytest.raises(AttributeError, match="did you mean 'energy'"):
        _ = result.energie
    with pytest.raises(AttributeError, match="no attribute 'psi2_eror'"):
        _ = result.plan.psi2_eror


@pytest.mark.parametrize("met", [meeting(), OFF_CENTRE], ids=["central", "space"])
def test_a_misspelt_attribute_of_a_collision(met):
    with pytest.raises(AttributeError, match="did you mean 'velocity'"):
        _ = collide(met).velocty


@every_scene
def test_a_notebook_shows_what_str_says(scene):
    result = EXACT.run(scene)
    assert result._repr_html_().startswith("<pre>ImpactResult(")
    assert repr(result).split(";")[0] in result._repr_html_().replace("&#x27;", "'")


@every_scene
def test_a_history_under_even_steps(scene):
    """Also of a batch; its last instants are those of the motion."""
    history = FEW.run(scene, history=True).history
    instants = len(history.time)
    assert history.normal_force.shape == (instants, *scene.shape)
    assert history.slip_velocity.shape == (instants, *scene.shape, *scene.slip_axes)
    peak = FEW.run(scene).motion.maximum_force
    assert history.normal_force.max(axis=0) == pytest.approx(peak, rel=0.02)


@every_scene
def test_fields_of_a_history(scene):
    """Springs that stick and slip; displacements have the components of the slip."""
    fields = FEW.run(scene, history="fields").history.fields
    assert set(fields) == {"radius", "displacement", "limit", "stuck", "slipping"}
    assert fields["displacement"].shape == (*fields["radius"].shape, *scene.slip_axes)
    for name in ("radius", "limit", "displacement"):
        assert fields[name].dtype == np.float64
    sizes = np.abs(fields["displacement"])
    if scene.slip_axes:
        sizes = np.linalg.norm(fields["displacement"], axis=-1)
        assert np.abs(fields["displacement"][..., 1]).max() > 0.0
    slips = fields["slipping"] != 0
    assert slips.any()
    assert fields["stuck"].any()
    assert not (slips & fields["stuck"]).any()
    assert sizes[slips] == pytest.approx(fields["limit"][slips], rel=1e-9)
    if not scene.slip_axes:
        assert (fields["slipping"][slips] == np.sign(fields["displacement"][slips])).all()


@one_scene
def test_a_run_with_fields_says_where_there_are_none(scene):
    result = EXACT.run(scene, history="fields")
    told = any("stick/slip fields" in str(clause) for clause in result.plan.left_out)
    assert told is (not result.history.fields)


@every_scene
def test_normal_motion(scene):
    """The approach without friction lasts 2.94327 (Hertz)."""
    assert EXACT.normal_motion(scene).duration == pytest.approx(2.9432751842)


@every_scene
def test_figures(scene, tmp_path):
    if scene.shape:
        axes = EXACT.run(scene).plot("psi1", "psi2", width="one")
        assert len(axes.lines) + len(axes.collections) > 0
    else:
        axes = FEW.run(scene, history=True).plot(width="two")
        with pytest.raises(ValueError, match="leave them out"):
            EXACT.run(scene).plot("psi1", "psi2")
    width = axes.figure.get_size_inches()[0]
    assert width == pytest.approx(3.37 if scene.shape else 6.9, abs=0.4)
    axes.figure.savefig(tmp_path / "figure.png")


@every_scene
def test_a_pickled_result_equals_itself(scene):
    """Two runs are equal but for the run time, and results of other laws are not."""
    result, again = FEW.run(scene), FEW.run(scene)
    assert pickle.loads(pickle.dumps(result)) == result
    assert again == result
    assert attrs.evolve(again, run_time=-1.0) == result
    assert SPRINGS.run(scene) != result
    with_history = FEW.run(scene, history="fields")
    assert pickle.loads(pickle.dumps(with_history)) == with_history == FEW.run(
        scene, history="fields"
    )  # fmt: skip
    assert with_history != result


def test_a_pickled_collision_has_the_same_vectors():
    made = collide(OFF_CENTRE, FEW)
    again = pickle.loads(pickle.dumps(made))
    assert again.to_dict() == made.to_dict()
    assert again.result == made.result


# Declared and estimated errors.


@pytest.mark.parametrize("name", ["central", "planar"])
def test_the_exact_law_declares_its_errors(name):
    scene = BATCHES[name]
    bounds = EXACT.plan(scene).psi2_error
    assert bounds == pytest.approx(1e-9 * np.maximum(1.0, np.abs(scene.psi1)), rel=0.01)
    assert (EXACT.plan(scene).restitution_error <= 1e-9).all()
    finer = Simulation(
        tangential=create("tangential.fronts", table=False),
        integrator=create("integrator.events", tolerance=1e-12),
    ).run(scene)
    result = EXACT.run(scene)
    assert (np.abs(result.psi2 - finer.psi2) <= bounds).all()
    assert np.abs(result.normal_restitution - finer.normal_restitution).max() <= 1e-9
    assert np.array_equal(result.plan.psi2_error, bounds)
    assert f"numerical error of psi2: at most {bounds.max():.2g}, declared" in str(result.plan)


def test_in_a_mixed_batch_each_impact_has_its_own_errors():
    plan = EXACT.plan(BATCHES["mixed"])
    assert np.isnan(plan.psi2_error).tolist() == [False, False, True]
    assert np.isnan(plan.restitution_error).tolist() == [False, False, True]
    for place, name in enumerate(ONES):
        alone = EXACT.plan(ONES[name])
        for error in ("psi2_error", "restitution_error"):
            assert getattr(plan[place], error) == pytest.approx(getattr(alone, error), nan_ok=True)


@pytest.mark.parametrize(("springs", "steps"), [(50, 200), (12, 60)])
def test_the_normal_restitution_has_an_error_of_its_own(springs, steps):
    """Within a factor of three of the distance from the exact law, as that of psi2."""
    scene = Scene.nondimensional(psi1=np.linspace(-3.0, 3.0, 13) + 0.05, chi=1.4, lam=0.2, eta=0.5)
    rough = Simulation(
        tangential=create("tangential.springs", springs=springs),
        integrator=create("integrator.symplectic", steps=steps),
    )
    result, exact = rough.run(scene, estimate_error=True), EXACT.run(scene)
    for estimate, found, true in (
        (result.restitution_error_estimate, result.normal_restitution, exact.normal_restitution),
        (result.psi2_error_estimate, result.psi2, exact.psi2),
    ):
        ratio = np.asarray(estimate) / np.abs(found - true)
        assert np.mean((ratio > 1 / 3) & (ratio < 3.0)) > 0.9
        assert ratio.min() > 0.3
    assert np.isnan(result.plan.restitution_error).all()
    assert "numerical error of the normal restitution: not declared" in str(result.plan)


def test_estimates_of_a_history_are_those_of_its_march():
    """The march of a batch with one time axis is that of springs, for the central impact too."""
    scene = BATCHES["mixed"]
    result = EXACT.run(scene, history=True, estimate_error=True)
    distance = np.abs(result.psi2 - EXACT.run(scene).psi2)[:2, 0]
    assert result.psi2_error_estimate[:2] == pytest.approx(distance, rel=1.0)


# Scenes.


@every_scene
def test_the_index_is_numbered(scene):
    if not scene.shape:
        assert scene.index == 0
        assert scene.numbered(7).index == 7
        return
    assert scene.index.tolist() == [0, 1, 2]
    assert scene.take(slice(1, 3)).index.tolist() == [1, 2]
    assert scene.take(2).index == 2
    for where, part in scene.parts():
        assert np.array_equal(np.ravel(part.index), np.ravel(scene.index[where]))
        assert np.array_equal(np.ravel(part.central.index), np.ravel(scene.index[where]))


@attrs.frozen
class Seeded(SteppedTangentialLaw):
    """No friction; keeps the index that a random seed would come from."""

    api_version: ClassVar[int] = 2
    needs_future: ClassVar[bool] = False
    vectors: ClassVar[bool] = True
    seen: ClassVar[list[int]] = []

    def start(self, scene, normal):
        self.seen.extend(np.ravel(scene.index).tolist())

    def advance(self, state, increment, before, after):
        zero = 0.0 * np.asarray(after.force)
        return TangentialResponse(0.0 * np.asarray(increment.displacement), zero), state

    def stiffness(self, scene, normal):
        return 1.0


def many(name, count=2000):
    """Return a batch of equal impacts of one kind, or of three kinds by turns."""
    psi1, zero = np.full(count, 1.5), np.zeros(count)
    if name == "central":
        return Scene.nondimensional(psi1=psi1, chi=1.4)
    if name == "planar":
        return Scene.nondimensional(psi1=psi1, chi=1.4, lam=0.2, eta=0.5)
    vectors = np.stack((psi1, zero if name == "mixed" else psi1), axis=-1)
    if name == "space":
        return Scene.nondimensional(psi1=vectors, **TURNING)
    lam = np.zeros((count, 2))
    lam[1::3], lam[2::3] = (0.2, 0.0), (0.2, 0.1)
    return Scene.nondimensional(psi1=vectors, chi=0.7 * np.eye(2), lam=lam, rho=0.1)


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


def one(kind, **changes):
    numbers = {
        "central": {"psi1": 1.5, "chi": 1.4},
        "planar": {"psi1": 1.5, "chi": 1.4, "lam": 0.2, "eta": 0.5},
        "space": {"psi1": (0.8, 1.6), **TURNING},
    }[kind]
    return Scene.nondimensional(**(numbers | changes))


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


WITH_BODIES = Scene(BALL, FLOOR, 0.3, 1.0, 0.5)
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


# Laws that fail.


@attrs.frozen
class Liar(SteppedTangentialLaw):
    """Answers both motions as told: NaN, an error for one impact, or books that do not close."""

    api_version: ClassVar[int] = 2
    needs_future: ClassVar[bool] = False
    vectors: ClassVar[bool] = True
    together: ClassVar[bool] = True
    how: str = "nan"

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        raise NotImplementedError

    def whole_impacts(self, scene, normal):
        self._raise(scene)
        change = self._change(scene)
        where = np.ones(scene.shape, dtype=bool) if scene.shape else True
        return (
            WholeImpact(
                where=where, slip_velocity_change=change, friction_work=0.0 * abs(change),
                reason="told",
            ),
        )  # fmt: skip

    def _raise(self, scene):
        if self.how == "raise" and np.any(np.asarray(scene.index) == 1):
            raise RuntimeError("one of them")

    def _change(self, scene):
        factor = {"nan": math.nan, "books": -1.0, "raise": -1e-9}[self.how]
        return factor * np.asarray(scene.slip_velocity)

    def impacts_together(self, scene, normal, accuracy, observer=None):
        self._raise(scene)
        ones = np.ones(scene.shape)
        rate = -scene.normal_speed * ones
        if self.how == "raise":  # a small impulse along n alone keeps the energy
            W = np.asarray(scene.inverse_mass)
            push = scene.normal_speed / W[..., 0, 0] * 1e-9
            rate = (1.0 - 1e-9) * scene.normal_speed * ones
            slip = -W[..., 0, 1:] * np.asarray(push)[..., None]
            change = slip[..., 0] if scene.planar else slip
        else:
            change = self._change(scene) * np.ones((*scene.shape, *scene.slip_axes))
        status = np.full(scene.shape, Status.SUCCESS, dtype=object)
        return TangentialMotion(
            slip_velocity_change=change, friction_work=0.0 * ones,
            status=status if scene.shape else Status.SUCCESS,
            detail=np.full(scene.shape, "", dtype=object) if scene.shape else "", counters={},
            normal=Ends(duration=ones, final_rate=rate, maximum_radius=ones, maximum_approach=ones,
                        maximum_force=ones, dissipation=0.0 * ones, compressions=ones),
        )  # fmt: skip


@every_scene
def test_a_law_that_answers_nan_is_not_finite(scene):
    result = Simulation(tangential=Liar("nan")).run(scene)
    assert set(statuses(result)) == {"NON_FINITE"}
    assert np.isnan(result.psi2).all()
    assert "Liar" in str(result)


@each_batch
@pytest.mark.parametrize("count", [3, 2001])
def test_one_impact_that_raises_costs_that_impact_alone(scene, count):
    """Under a law that answers both motions together, in a batch of three or of thousands."""
    places = np.resize(np.arange(3), count)
    laws = Simulation(tangential=Liar("raise"), integrator="symplectic")
    batch = scene.take(places).numbered(np.arange(count))
    result = laws.sweep(batch) if count > 3 else laws.run(batch)
    assert list(result.failures) == [1]
    assert statuses(result)[1] == "LAW_RAISED"
    assert "one of them" in result.failures[1]


@attrs.frozen
class FailsAtOne(SteppedTangentialLaw):
    """No friction, and no answer for the impact of index 1."""

    api_version: ClassVar[int] = 2
    needs_future: ClassVar[bool] = False
    vectors: ClassVar[bool] = True
    how: str = "raises"

    def start(self, scene, normal):
        return np.asarray(scene.index)

    def advance(self, state, increment, before, after):
        force, work = 0.0 * np.asarray(increment.displacement), 0.0 * np.asarray(after.force)
        bad = state == 1
        if self.how == "raises" and np.any(bad):
            raise ArithmeticError("that one")
        if self.how == "nan":
            force = np.where(bad[..., None] if force.ndim > work.ndim else bad, math.nan, force)
        return TangentialResponse(force, work, ~bad if self.how == "unsettled" else True), state

    def stiffness(self, scene, normal):
        return 1.0


@each_batch
@pytest.mark.parametrize("integrator", ["symplectic", "adaptive", "paper"])
@pytest.mark.parametrize(
    ("how", "status"),
    [("nan", "NON_FINITE"), ("raises", "LAW_RAISED"), ("unsettled", "UNSETTLED")],
)
def test_an_impact_that_fails_in_a_march_takes_no_other_with_it(scene, integrator, how, status):
    laws = Simulation(tangential=FailsAtOne(how), integrator=integrator)
    result = laws.run(scene)
    assert statuses(result) == ["SUCCESS", status, "SUCCESS"]
    assert list(result.failures) == [1]
    assert "FailsAtOne" in result.failures[1]
    assert statuses(laws.run(scene.take(1))) == [status]
    assert result.normal_restitution[[0, 2]] == pytest.approx(1.0, abs=1e-6)


def test_one_of_two_thousand_that_raises_in_a_march():
    laws = Simulation(tangential=FailsAtOne(), integrator="symplectic")
    for name in ("planar", "mixed"):
        result = laws.sweep(many(name))
        assert list(result.failures) == [1], name


@every_scene
def test_books_that_nobody_bounds_are_cautioned_of(scene):
    result = Simulation(tangential=Liar("books")).run(scene)
    assert set(statuses(result)) == {"SUCCESS"}
    off = np.max(np.abs(result.energy.relative_imbalance))
    assert off > 0.05
    told = [text for text in result.cautions if "Liar declares no bound" in text]
    assert len(told) == 1
    assert f"off by {off:.2g} of the energy at the start" in told[0]
    assert told[0] in str(result)


@attrs.frozen
class Bounded(Liar):
    def books_bound(self, scene):
        return 0.01


@every_scene
def test_books_off_a_declared_bound_fail(scene):
    result = Simulation(tangential=Bounded("books")).run(scene)
    assert set(statuses(result)) == {"UNBALANCED"}
    assert "declared: 0.01" in str(result)


# Cautions of laws.

FIVE_STEPS = create("integrator.symplectic", steps=5)
BY_SPRINGS = {"tangential": "springs", "integrator": "symplectic"}
ELASTIC_SHEAR = {
    "tangential": create("tangential.springs", shear_loss=0.0),
    "integrator": "symplectic",
}
SPRINGS_WORDS = ("each spring is limited separately", "hemispherical")
SHARED_WORDS = ("one loss for pressure and shear", "restitution alone")
CAUTIONED = [
    ({"normal": "tsuji", **ELASTIC_SHEAR}, (*SPRINGS_WORDS, "restitution alone", "by default")),
    ({"normal": "tsuji"}, (*SHARED_WORDS, "by default")),
    ({"tangential": "coulomb"}, ("rigid bodies",)),
    ({"tangential": "mindlin_cap"}, ("one spring", "energy from nothing")),
    ({"tangential": "linear_spring", "integrator": FIVE_STEPS}, ("one spring", "steps raised")),
]
#: Laws whose normal motion is solved, which takes longer.
SOLVED = [
    ({"normal": "hunt_crossley", **ELASTIC_SHEAR}, (*SPRINGS_WORDS, "restitution alone")),
    ({"normal": "hunt_crossley", **BY_SPRINGS}, SHARED_WORDS),
    ({"normal": "jkr", **BY_SPRINGS}, SPRINGS_WORDS),
    ({"normal": "thornton", **BY_SPRINGS}, SPRINGS_WORDS),
    ({"normal": "walton_braun", **BY_SPRINGS}, (*SPRINGS_WORDS, "restitution alone")),
]
ROWS = [
    pytest.param(
        scene,
        laws,
        words,
        id="-".join((*(str(law) for law in laws.values()), name)),
        marks=[pytest.mark.slow] * (name in ("mixed batch", "space batch")),
    )
    for scenes, table in ((dict(zip(NAMES, ALL, strict=True)), CAUTIONED), (ONES, SOLVED))
    for laws, words in table
    for name, scene in scenes.items()
]


@pytest.mark.parametrize(("scene", "laws", "words"), ROWS)
def test_the_laws_own_cautions_hold(scene, laws, words):
    """And where friction changes the approach their sizes are said to be of spheres."""
    simulation = Simulation(**laws)
    result = simulation.run(scene).check()
    for word in words:
        assert any(word in text for text in result.cautions), word
        assert word in str(result)
        if word != "steps raised":
            assert any(word in str(clause) for clause in simulation.plan(scene).cautions), word
    coupled = scene.inverse_mass is not None
    assert any("sizes were measured for spheres" in text for text in result.cautions) is coupled


@pytest.mark.parametrize("coupling", [{}, {"lam": 1e-6, "eta": 1e-6}], ids=["central", "planar"])
def test_a_spring_far_off_is_told_so(coupling):
    """Truth is -1.498, by Coulomb's law at every point."""
    laws = Simulation(normal=create("normal.hunt_crossley", restitution=0.2), **ELASTIC_SHEAR)
    result = laws.run(Scene.nondimensional(psi1=4.346, chi=5.652, **coupling)).check()
    sizes = re.search(r"psi2 is off by up to ([\d.]+)", str(result))
    assert sizes is not None
    assert abs(result.psi2 + 1.498) < float(sizes.group(1))


@pytest.mark.slow
@pytest.mark.parametrize(
    "met",
    [Encounter(BALL, FLOOR, 0.3, normal=DOWN, velocity=(0.5, 0.3, -1.0)), meeting(),
     meeting(contact=(0.02, 0.0, -0.1)), OFF_CENTRE],
    ids=["sphere", "central", "planar", "space"],
)  # fmt: skip
@pytest.mark.parametrize("restitution", [0.3, 0.9])
def test_cautions_of_a_restitution(met, restitution):
    """A given restitution is not called taken by default."""
    made = collide(met, restitution=restitution)
    slides = met is OFF_CENTRE and restitution == 0.3  # from touch to separation: mu decides
    told = any("one loss for pressure and shear" in text for text in made.cautions)
    assert told is not slides
    assert not any("default" in text for text in made.cautions)
    assert not any("default" in str(clause) for clause in made.result.plan.computed)


@every_scene
@pytest.mark.slow
def test_a_restitution_that_is_given_is_not_by_default(scene):
    given = Simulation(normal=create("normal.tsuji", restitution=0.9)).run(scene)
    assert "by default" not in str(given)
    assert "by default" in str(Simulation(normal="tsuji").run(scene))


# Which laws answer.


@coupled_scene
@pytest.mark.slow
def test_laws_that_nobody_named_give_way_to_springs_and_the_plan_says_so(scene):
    simulation = Simulation(normal="linear")
    result = simulation.run(scene).check()
    stand_in = [str(each) for each in result.plan.computed if str(each).startswith("laws")]
    assert len(stand_in) == 1
    assert "Springs for Annulus" in stand_in[0]
    assert "friction changes the approach" in stand_in[0]
    assert [*map(str, simulation.plan(scene).computed)] == [*map(str, result.plan.computed)]
    assert "springs" in result.laws["tangential"]
    named = Simulation(normal="linear", **BY_SPRINGS).run(scene)
    where = np.asarray(scene.size_of(np.asarray(scene.lam))) > 0.0
    assert np.array_equal(np.asarray(result.psi2)[where], np.asarray(named.psi2)[where])


REMEDIED = [
    {"normal": "tsuji", "integrator": "events"},
    {"tangential": "annulus"},
    {"tangential": "annulus", "integrator": "symplectic"},
    {"normal": "tsuji", "tangential": "annulus"},
    {"tangential": "halfspace"},
    {"normal": "jkr", "tangential": "annulus"},
]
IN_SPACE_ALONE = [
    {"integrator": "events"},
    {"tangential": "fronts"},
    {"tangential": "mindlin_deresiewicz"},
]


def follow(error, laws):
    """Return the laws by each remedy of a refusal, word by word."""
    words = re.search(r"take ((?:\w+='\w+'(?:, )?)+), or leave both out", str(error))
    assert words is not None, str(error)
    told = dict(re.findall(r"(\w+)='(\w+)'", words.group(1)))
    yield laws | told
    yield {kind: name for kind, name in laws.items() if kind not in told}
    for kind, name in re.findall(r"or name it: (\w+)='(\w+)'", str(error)):
        yield laws | {kind: name}


@coupled_scene
@pytest.mark.parametrize(
    "laws",
    [
        *REMEDIED[:1],
        *IN_SPACE_ALONE,
        *(pytest.param(one, marks=pytest.mark.slow) for one in REMEDIED[1:]),
    ],
    ids=str,
)
@pytest.mark.slow
def test_a_remedy_that_is_followed_works(scene, laws):
    """And plan and sweep refuse what run refuses, in the same words."""
    simulation = Simulation(**laws)
    if laws in IN_SPACE_ALONE and scene.planar:
        simulation.run(scene).check()
        return
    with pytest.raises(ValueError, match="take") as caught:
        simulation.run(scene)
    doors = [simulation.plan, *([simulation.sweep] if scene.shape else [])]
    for door in doors:
        with pytest.raises(ValueError, match=re.escape(str(caught.value))):
            door(scene)
    for remedied in follow(caught.value, laws):
        Simulation(**remedied).run(scene).check()


def test_rigid_theory_is_not_taken_in_silence():
    """Spheres have it with a caution; by name it answers."""
    laws = Simulation(normal="tsuji", integrator="events")
    assert any("rigid bodies" in text for text in laws.run(ONES["central"]).cautions)
    for name in ("planar", "space"):
        with pytest.raises(ValueError, match="rigid theory is not taken unless it is named"):
            laws.run(ONES[name])
        rigid = Simulation(normal="tsuji", tangential="coulomb", integrator="events")
        assert any("rigid bodies" in text for text in rigid.run(ONES[name]).check().cautions)


HISTORIES = [
    (EXACT, BATCHES["planar"]),
    (EXACT, Scene.stack([ONES["central"], ONES["planar"]])),
    (Simulation(tangential="coulomb"), BATCHES["planar"]),
    (Simulation(tangential="coulomb"), BATCHES["space"]),
    (Simulation(tangential="coulomb"), BATCHES["mixed"]),
]


@pytest.mark.parametrize("history", [True, "fields"])
@pytest.mark.parametrize(("simulation", "scene"), HISTORIES)
def test_plan_refuses_the_histories_that_run_refuses(simulation, scene, history):
    with pytest.raises(ValueError, match="instants of their own") as caught:
        simulation.run(scene, history=history)
    with pytest.raises(ValueError, match=re.escape(str(caught.value))):
        simulation.plan(scene, history=history)
    assert "run them one by one" in str(caught.value)
    for place in range(len(scene.index)):
        assert simulation.run(scene.take(place), history=history).check().history


@every_scene
@pytest.mark.parametrize("history", [False, True, "fields"])
@pytest.mark.parametrize("simulation", [EXACT, FEW], ids=["default", "springs"])
def test_a_plan_is_that_of_the_run(scene, history, simulation):
    if simulation is EXACT and history and scene is BATCHES["planar"]:
        return
    plan, result = simulation.plan(scene, history=history), simulation.run(scene, history=history)
    assert [*map(str, plan.computed)] == [*map(str, result.plan.computed)]
    assert [*map(str, plan.left_out)] == [*map(str, result.plan.left_out)]
    marched = " ".join(str(each) for each in plan.computed if each.code == "tangential_motion")
    for law in re.findall(r"(\w+)\(", marched):
        assert law.lower() in " ".join(result.laws.values())


def test_a_history_of_unlike_impacts_tells_the_laws_of_its_march():
    result = EXACT.run(BATCHES["mixed"], history=True)
    assert "fronts" not in result.laws["tangential"]
    assert "Fronts(" not in str(result.plan)
    springs = SPRINGS.run(BATCHES["mixed"], history=True)
    assert np.array_equal(result.psi2, springs.psi2)


def test_a_run_of_a_scene_in_space_is_what_collide_answers():
    made, result = collide(OFF_CENTRE), EXACT.run(OFF_CENTRE.scene)
    assert np.array_equal(made.result.psi2, result.psi2)
    assert made.result.laws == result.laws
    assert "springs" in result.laws["tangential"]
    assert "Springs for Fronts" in str(result.plan)
    assert np.array_equal(made.velocity, result.velocity_in_space)


def falling(count, contact):
    """Return bodies with equal moments that fall at slips from 0.1 to 3 m/s along x."""
    velocity = np.column_stack((np.linspace(0.1, 3.0, count), np.zeros(count), -np.ones(count)))
    return meeting(body((0.01, 0.01, 0.005)), velocity=velocity, contact=contact)


@pytest.mark.parametrize("moved", [(0.02, 0.0), (0.02, 0.02)], ids=["planar", "space"])
def test_one_row_that_couples_moves_no_other(moved):
    contact = np.tile((0.0, 0.0, -0.1), (1000, 1))
    central = collide(falling(1000, contact)).result
    contact[0, :2] = moved
    result = collide(falling(1000, contact)).result.check()
    first = EXACT.run(central.scene.take(0)).counters.get("tabulated", 0)
    assert result.counters["tabulated"] == central.counters["tabulated"] - first
    slips = np.asarray(result.rebound_slip_velocity)
    slips = slips[..., 0] if slips.ndim > 1 else slips
    assert np.array_equal(slips[1:], central.rebound_slip_velocity[1:])
    alone = EXACT.run(result.scene.take(0))
    assert np.array_equal(result[0].psi2, alone.psi2)


# Bodies whose impact is central.


@pytest.mark.parametrize("along", [0, 1])
def test_a_rod_on_its_end_is_answered_by_the_table(along):
    """W does not couple, W_tt is uneven, slip lies along a principal axis: M_t = 1/W_11."""
    velocity = [0.0, 0.0, -1.0]
    velocity[along] = 0.5
    scene = meeting(velocity=velocity).scene
    result = EXACT.run(scene).check()
    assert result.counters == {"tabulated": 1}
    moment = (0.014, 0.01)[along]
    inverse = 1.0 + 0.1**2 / moment
    kappa = 2.0 * (1.0 - STEEL.poisson_ratio) / (2.0 - STEEL.poisson_ratio)
    psi1, chi = kappa * 0.5 / 0.3, 0.5 * kappa * inverse
    assert abs(result.psi1) == pytest.approx(psi1, rel=1e-12)
    psi2 = math.copysign(1.0, float(result.psi1)) * rebound(psi1, chi)
    assert result.psi2 == pytest.approx(psi2, abs=1e-9)
    assert result.normal_restitution == 1.0


def test_a_rod_on_its_end_with_slip_between_its_axes_turns():
    scene = meeting(velocity=(0.5, 0.3, -1.0)).scene
    assert not scene.planar
    assert EXACT.run(scene).check().psi2[1] != 0.0


@pytest.mark.parametrize(("restitution", "room"), [(1.0, 1e-13), (0.7, 1e-9)])
def test_a_sphere_given_as_a_body_is_that_sphere(restitution, room):
    """The relaxation time of a restitution gives it to 2e-10."""
    moment = 0.4 * BALL.mass * BALL.radius**2
    same = RigidBody(
        mass=BALL.mass, principal=3 * (moment,), material=STEEL, curvature_radius=BALL.radius
    )
    numbers = {"normal": DOWN, "velocity": (0.5, 0.3, -1.0), "spin": (3.0, 1.0, 0.0)}
    sphere = collide(Encounter(BALL, FLOOR, 0.3, **numbers), restitution=restitution)
    made = collide(
        Encounter(same, FLOOR, 0.3, contact=(0.0, 0.0, -BALL.radius), **numbers),
        restitution=restitution,
    )
    assert made.velocity == pytest.approx(sphere.velocity, abs=room)
    assert made.spin == pytest.approx(sphere.spin, abs=100.0 * room)
    assert made.energy.friction_work == pytest.approx(sphere.energy.friction_work, rel=1e-8)
    assert made.result.counters == sphere.result.counters
    assert made.result.laws == sphere.result.laws


@pytest.mark.parametrize("coupling", [1e-14, 1e-12, 1.1e-12, 1e-11, 1e-10])
def test_elastic_laws_are_continuous_across_the_border(coupling):
    psi1 = np.linspace(-3.0, 3.0, 13) + 0.01
    near = Scene.nondimensional(psi1=psi1, chi=1.4, lam=coupling, eta=coupling)
    central = Scene.nondimensional(psi1=psi1, chi=1.4)
    one_side, other = EXACT.run(near).check(), EXACT.run(central).check()
    assert np.abs(one_side.psi2 - other.psi2).max() < 1e-9
    assert np.abs(one_side.normal_restitution - 1.0).max() < 1e-9
    assert np.abs(one_side.energy.friction_work - other.energy.friction_work).max() < 1e-9


@pytest.mark.parametrize("name", ["planar", "space"])
def test_springs_are_continuous_across_the_border_within_their_error(name):
    """Their grids differ on both sides: they differ by no more than both estimates say."""
    psi1 = np.linspace(-3.0, 3.0, 13) + 0.01
    central = Scene.nondimensional(psi1=psi1, chi=1.4)
    near = Scene.nondimensional(psi1=psi1, chi=1.4, lam=1e-11, eta=1e-11)
    if name == "space":
        slips = np.stack((psi1, 0.0 * psi1), axis=-1)
        chi = [[1.4, 1e-11], [1e-11, 1.0]]
        near = Scene.nondimensional(psi1=slips, chi=chi, lam=(0.0, 0.0), rho=1.0)
    one_side, other = (SPRINGS.run(each, estimate_error=True) for each in (near, central))
    found = np.asarray(one_side.psi2)
    found = found if found.ndim == 1 else found[:, 0]
    both = one_side.psi2_error_estimate + other.psi2_error_estimate
    assert (np.abs(found - other.psi2) <= 2.0 * both).all()
    assert np.abs(found - other.psi2).max() < 1e-3


# Collisions.

ELSEWHERE = meeting(
    velocity=(5.0, 0.0, -1.0), contact=(0.05, 0.0, -0.1), friction_coefficient=0.9
)  # fmt: skip
SPHERES = Encounter(BALL, FLOOR, 0.3, normal=DOWN, velocity=(0.5, 0.3, -1.0))


@pytest.mark.parametrize(
    "met", [SPHERES, meeting(), meeting(contact=(0.02, 0, -0.1)), OFF_CENTRE],
    ids=["sphere", "central", "planar", "space"],
)  # fmt: skip
def test_a_collision_of_a_foreign_result_is_refused(met):
    own = Collision.of(met, EXACT.run(met.scene))
    assert own.velocity == pytest.approx(collide(met).velocity, rel=1e-9)
    faster = attrs.evolve(met, velocity=1.5 * met.velocity)
    for other in (ELSEWHERE, faster):
        with pytest.raises(ValueError, match=r"must be the result of encounter.scene"):
            Collision.of(met, EXACT.run(other.scene))
    with pytest.raises(ValueError, match=r"must be the result of encounter.scene"):
        Collision.of(met, collide(met))


@pytest.mark.parametrize(
    "met", [SPHERES, meeting(), OFF_CENTRE], ids=["sphere", "central", "space"]
)
@pytest.mark.parametrize("options", [{}, {"restitution": 0.5}, {"simulation": FEW}], ids=str)
def test_a_single_encounter_that_does_not_approach_passes(met, options):
    away = attrs.evolve(met, velocity=(0.5, 0.0, 1.0), spin=(1.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="separating='pass'"):
        collide(away, **options)
    made = collide(away, separating="pass", **options)
    assert not made.collided
    assert made.velocity.tolist() == [0.5, 0.0, 1.0]
    assert made.spin.tolist() == [1.0, 0.0, 0.0]
    assert made.impulse.tolist() == [0.0, 0.0, 0.0]
    assert made.status is Status.SUCCESS
    assert made.energy.friction_work == 0.0
    assert made.normal_velocity == pytest.approx(away.meeting().approach)
    assert "pass through untouched" in str(made.plan)
    assert "passed through" in repr(made)
    assert made.cautions == []


@pytest.mark.parametrize("target", [FLOOR, Sphere(0.1, STEEL)], ids=["floor", "ball"])
@pytest.mark.parametrize(
    "met", [SPHERES, meeting(), meeting(contact=(0.02, 0, -0.1)), OFF_CENTRE],
    ids=["sphere", "central", "planar", "space"],
)  # fmt: skip
def test_surfaces_part_and_slip_as_the_result_says(met, target):
    """Contact velocities of both bodies, of their centres and spins, are those of the scene."""
    made = collide(attrs.evolve(met, target=target, spin=(1.0, 2.0, 3.0)))
    relative = made.contact_velocity - made.target_contact_velocity
    approach = relative @ np.array(DOWN)
    assert approach == pytest.approx(made.normal_velocity, abs=1e-12)
    slip = np.linalg.norm(relative - approach * np.array(DOWN))
    size = np.linalg.norm(made.result.rebound_slip_velocity)
    assert slip == pytest.approx(size, abs=1e-4 if made.known is None else 1e-12)


@each_batch
def test_a_kept_sweep_is_taken_up(scene, tmp_path):
    """And another scene is refused."""
    result = FEW.sweep(scene, keep=tmp_path)
    assert FEW.sweep(scene, keep=tmp_path) == result == FEW.sweep(scene)
    slower = attrs.evolve(scene, normal_speed=0.5 * scene.normal_speed)
    with pytest.raises(ValueError, match="holds another sweep"):
        FEW.sweep(slower, keep=tmp_path)


@one_scene
def test_a_load_path_takes_any_scene(scene):
    """The law alone along a path asks for mu and stiffness, not for the masses."""
    depth = np.linspace(0.0, 1.0, 40)
    central = attrs.evolve(scene.central, pair=scene.pair)
    forces, expected = (load_path(each, depth, 0.3 * depth) for each in (scene, central))
    assert forces.check().friction_force == pytest.approx(expected.friction_force, rel=1e-9)
    assert forces.normal_force[-1] > 0.0


# Files.

ROD = """
[body]
shape = "rod"
length = 1.0
radius = 0.02
material = "steel"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.3
normal = [0, 0, -1]
velocity = [0.2, 0.1, -1.0]
[sweep]
tilt_deg = [0, 10, 30, 60]
"""


@pytest.fixture
def swept(tmp_path):
    """Return a sweep over the tilt of a rod, the encounters and a folder."""
    (tmp_path / "rod.toml").write_text(ROD, encoding="utf-8")
    file = read_scene(tmp_path / "rod.toml")
    return file.laws.simulation().sweep(file.scene).check(), file.encounter, tmp_path


#: Columns of a vector, and the vector of the collision that it is.
VECTORS = {
    "velocity_in_space": "velocity",
    "rebound_spin": "spin",
    "target_velocity_in_space": "target_velocity",
    "target_rebound_spin": "target_spin",
}


@pytest.mark.parametrize("suffix", ["csv", "npz", "json"])
def test_files_hold_what_was_swept_and_what_came_out(swept, suffix):
    result, encounter, folder = swept
    path = folder / f"out.{suffix}"
    {"csv": write_csv, "npz": write_npz, "json": write_json}[suffix](result, path)
    if suffix == "csv":
        with path.open(encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream))
        read = {name.split(" ")[0]: [row[name] for row in rows] for name in rows[0]}
        assert "tilt_deg (deg)" in rows[0]
        assert "velocity_in_space_1 (m/s)" in rows[0]
        assert "rebound_spin_1 (rad/s)" in rows[0]
    elif suffix == "npz":
        with np.load(path) as file:
            read = {name: file[name] for name in file.files}
    else:
        read = json.loads(path.read_text(encoding="utf-8"))
    assert np.asarray(read["tilt_deg"], dtype=float).tolist() == [0.0, 10.0, 30.0, 60.0]
    made = collide(encounter)
    for name, vector in VECTORS.items():
        columns = [np.asarray(read[f"{name}_{place}"], dtype=float) for place in (1, 2, 3)]
        assert np.stack(columns, axis=-1) == pytest.approx(getattr(made, vector), rel=1e-9)
    for name, values in (("psi2", result.psi2), ("psi1", result.psi1), ("lam", result.scene.lam)):
        columns = [np.asarray(read[f"{name}_{place}"], dtype=float) for place in (1, 2)]
        assert np.array_equal(np.stack(columns, axis=-1), values)
    found = np.asarray(read["normal_restitution"], dtype=float)
    assert np.array_equal(found, result.normal_restitution)
    assert list(read["status"]) == 4 * ["SUCCESS"]


@extra("pandas")
def test_frames_hold_what_was_swept(swept):
    result, encounter, _ = swept
    frame = result.to_dataframe()
    assert frame["tilt_deg"].tolist() == [0.0, 10.0, 30.0, 60.0]
    velocity = frame[[f"velocity_in_space_{place}" for place in (1, 2, 3)]].to_numpy()
    assert velocity == pytest.approx(collide(encounter).velocity, rel=1e-9)
    assert frame.attrs["units"]["velocity_in_space_1"] == "m/s"


@every_scene
def test_every_result_is_written(scene, tmp_path):
    result = EXACT.run(scene)
    write_csv(result, tmp_path / "a.csv")
    write_json(result, tmp_path / "a.json")
    write_npz(result, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as file:
        psi2 = [file[name] for name in file.files if re.fullmatch(r"psi2(_\d)?", name)]
    assert np.squeeze(np.stack(psi2, axis=-1)).tolist() == np.asarray(result.psi2).tolist()
    assert json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))["status"]


# Bodies.

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
    ([NARROW.scene, meeting().scene], "C = 0.768"),
    ([NARROW.scene, OFF_CENTRE.scene], "C = 0.768"),
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
