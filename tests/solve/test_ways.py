"""Ways of an impact: what holds for spheres holds for bodies, by the same row.

The scenes are those of ``any_scene``, one of each way and all in one batch. Their tables say what
holds at every door, of impacts that are unlike in one sweep, of laws that caution, of laws that
fail, and of laws that cannot follow a scene.
"""

from __future__ import annotations

import itertools
import json
import math
import pickle
import re
from concurrent.futures import ThreadPoolExecutor

import attrs
import numpy as np
import pytest

from contactlab import (
    Encounter,
    RigidBody,
    Scene,
    Simulation,
    Sphere,
    collide,
    create,
    load_path,
    rebound,
)
from contactlab.contracts import Errors
from contactlab.impact import kinetics
from contactlab.outcome.export import write_csv, write_json, write_npz
from contactlab.study.posed import pose
from tests.longer import longer
from tests.solve.any_scene import (
    BALL,
    BATCHES,
    BODIES,
    BY_SPRINGS,
    DOWN,
    EXACT,
    FEW,
    FLOOR,
    OFF_CENTRE,
    ONES,
    SPHERES,
    SPRINGS,
    STEEL,
    WAYS,
    WITH_BODIES,
    body,
    coupled_way,
    each_batch,
    every_way,
    many,
    meeting,
    one_scene,
    statuses,
)
from tests.solve.mistaken import (
    ASKED,
    Bounded,
    Contact,
    Liar,
    Seeded,
    Slider,
    Spoiling,
    Undecided,
)

# Every door takes every scene.


@every_way
def test_the_index_is_numbered(scene):
    if not scene.shape:
        assert scene.index == 0
        assert scene.with_index(7).index == 7
        return
    assert scene.index.tolist() == [0, 1, 2, 3, 4, 5]
    assert scene.take(slice(1, 3)).index.tolist() == [1, 2]
    assert scene.take(2).index == 2
    for where, part in kinetics.parts(scene):
        assert np.array_equal(np.ravel(part.index), np.ravel(scene.index[where]))
        assert np.array_equal(np.ravel(part.central.index), np.ravel(scene.index[where]))


@every_way
def test_normal_motion(scene):
    """The approach without friction lasts 2.94327 (Hertz)."""
    assert EXACT.normal_motion(scene).duration == pytest.approx(2.9432751842)


@every_way
def test_a_result_is_shown_and_written(scene, tmp_path):
    result = EXACT.run(scene)
    with pytest.raises(AttributeError, match="did you mean 'energy'"):
        _ = result.energie
    with pytest.raises(AttributeError, match="no attribute 'psi2_eror'"):
        _ = result.plan.psi2_eror
    assert result._repr_html_().startswith("<pre>ImpactResult(")
    assert repr(result).split(";")[0] in result._repr_html_().replace("&#x27;", "'")
    write_csv(result, tmp_path / "a.csv")
    write_json(result, tmp_path / "a.json")
    write_npz(result, tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as file:
        psi2 = [file[name] for name in file.files if re.fullmatch(r"psi2(_\d)?", name)]
    assert np.squeeze(np.stack(psi2, axis=-1)).tolist() == np.asarray(result.psi2).tolist()
    assert json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))["status"]


@every_way
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


@every_way
def test_a_history_of_springs(scene):
    """Its last instants are those of the motion; springs stick and slip as the slip does."""
    history = FEW.run(scene, history="fields").history
    axes = kinetics.slip_axes(scene)
    assert history.normal_force.shape == (len(history.time), *scene.shape)
    assert history.slip_velocity.shape == (len(history.time), *scene.shape, *axes)
    peak = FEW.run(scene).motion.maximum_force
    assert history.normal_force.max(axis=0) == pytest.approx(peak, rel=0.02)
    fields = history.fields
    assert set(fields) == {"radius", "displacement", "limit", "stuck", "slipping"}
    assert fields["displacement"].shape == (*fields["radius"].shape, *axes)
    for name in ("radius", "limit", "displacement"):
        assert fields[name].dtype == np.float64
    sizes = np.abs(fields["displacement"])
    if axes:
        sizes = np.linalg.norm(fields["displacement"], axis=-1)
        assert np.abs(fields["displacement"][..., 1]).max() > 0.0
    slips = fields["slipping"] != 0
    assert slips.any()
    assert fields["stuck"].any()
    assert not (slips & fields["stuck"]).any()
    assert sizes[slips] == pytest.approx(fields["limit"][slips], rel=1e-9)
    if not axes:
        assert (fields["slipping"][slips] == np.sign(fields["displacement"][slips])).all()


@every_way
def test_a_pickled_result_equals_itself(scene):
    """Two runs are equal but for the run time, and results of other laws are not."""
    result, again = FEW.run(scene), FEW.run(scene)
    assert pickle.loads(pickle.dumps(result)) == result
    assert again == result
    assert attrs.evolve(again, run_time=-1.0) == result
    assert SPRINGS.run(scene) != result
    full = FEW.run(scene, history="fields")
    assert pickle.loads(pickle.dumps(full)) == full == FEW.run(scene, history="fields")
    assert full != result


@every_way
@pytest.mark.parametrize("history", [False, True, "fields"])
@pytest.mark.parametrize("simulation", [EXACT, FEW], ids=["default", "springs"])
def test_a_plan_is_that_of_the_run(scene, history, simulation):
    plan, result = simulation.plan(scene, history=history), simulation.run(scene, history=history)
    assert [*map(str, plan.computed)] == [*map(str, result.plan.computed)]
    assert [*map(str, plan.left_out)] == [*map(str, result.plan.left_out)]
    marched = " ".join(str(each) for each in plan.computed if each.code == "tangential_motion")
    for law in re.findall(r"(\w+)\(", marched):
        assert law.lower() in " ".join(result.laws.values())


@one_scene
def test_a_run_with_fields_says_where_there_are_none(scene):
    result = EXACT.run(scene, history="fields")
    told = any("stick/slip fields" in str(clause) for clause in result.plan.left_out)
    assert told is (not result.history.fields)


@one_scene
def test_a_load_path_takes_any_scene(scene):
    """The law alone along a path asks for mu and stiffness, not for the masses."""
    depth = np.linspace(0.0, 1.0, 40)
    central = attrs.evolve(scene.central, pair=scene.pair)
    forces, expected = (load_path(each, depth, 0.3 * depth) for each in (scene, central))
    assert forces.check().friction_force == pytest.approx(expected.friction_force, rel=1e-9)
    assert forces.normal_force[-1] > 0.0


@each_batch
def test_a_kept_sweep_is_taken_up(scene, tmp_path):
    """And another scene is refused."""
    result = FEW.sweep(scene, keep=tmp_path)
    assert FEW.sweep(scene, keep=tmp_path) == result == FEW.sweep(scene)
    slower = attrs.evolve(scene, normal_speed=0.5 * scene.normal_speed)
    with pytest.raises(ValueError, match="holds another sweep"):
        FEW.sweep(slower, keep=tmp_path)


@pytest.mark.parametrize("name", BATCHES)
@pytest.mark.parametrize("options", [{}, {"chunk": 300}, {"executor": True}], ids=str)
def test_a_seeded_law_gets_as_many_numbers_as_impacts(name, options):
    laws = Simulation(tangential=Seeded(), integrator=create("integrator.symplectic", steps=20))
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


# Errors that are declared or estimated.


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
    assert f"numerical error of psi2: below {bounds.max():.2g}" in str(result.plan)


def test_in_a_mixed_batch_each_impact_has_its_own_errors():
    plan = EXACT.plan(BATCHES["mixed"])
    assert np.isfinite(plan.psi2_error).all()
    assert np.isnan(plan.restitution_error).tolist() == [False, False, True]
    for place, name in enumerate(ONES):
        alone = EXACT.plan(ONES[name])
        for error in ("psi2_error", "restitution_error"):
            assert getattr(plan[place], error) == pytest.approx(getattr(alone, error), nan_ok=True)


@each_batch
def test_estimates_of_an_item_are_those_of_the_impact_alone(scene):
    result = FEW.run(scene, estimate_error=True)
    for place, item in enumerate(result):
        alone = FEW.run(scene.take(place), estimate_error=True)
        for name in ("psi2_error_estimate", "restitution_error_estimate"):
            estimate = getattr(item, name)
            assert isinstance(estimate, float)
            assert estimate == getattr(result, name)[place]
            assert estimate == pytest.approx(getattr(alone, name), rel=1e-6)


@pytest.mark.parametrize(("springs", "steps"), [(12, 60), *longer((50, 200))])
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
    assert "numerical error of the normal restitution: the laws state no bound" in str(result.plan)


@pytest.mark.slow
def test_estimates_of_a_history_are_those_of_its_march():
    """The march of a batch with one time axis is that of springs, for the central impact too."""
    scene = BATCHES["mixed"]
    result = EXACT.run(scene, history=True, estimate_error=True)
    distance = np.abs(result.psi2 - EXACT.run(scene).psi2)[:2, 0]
    assert result.psi2_error_estimate[:2] == pytest.approx(distance, rel=1.0)


# Unlike impacts in one sweep: answers and cautions are those of each alone.

TO_A_BALL = Encounter(
    BALL, Sphere(0.1, STEEL), 0.3, normal=DOWN, velocity=(0.5, 0.3, -1.0), spin=(0, 0, 5)
)
BODY_TO_A_BALL = attrs.evolve(OFF_CENTRE, target=Sphere(0.1, STEEL))
RINGING = meeting(body(bending_period=1.0), velocity=(0.5, 0.3, -1.0), contact=(0.02, 0.01, -0.1))
#: A body with a narrow contact, small by its mean curvature alone.
NARROW = meeting(attrs.evolve(body(), cross_radius=1e-4, curvature_axis=(1, 0, 0)))
YIELDING = attrs.evolve(WITH_BODIES, sphere=Sphere(0.01, attrs.evolve(STEEL, yield_stress=1e5)))


def struck(name, slip):
    return meeting(BODIES[name], velocity=(0.4, slip, -1.0), contact=(0.02, 0.01, -0.1))


#: Impacts, the laws, and a word of the cautions of some impact.
SWEPT = [
    *(
        ([ONES[name] for name in names], EXACT, "")
        for names in (
            ("central", "planar"), ("planar", "central"), ("central", "space"), ("space", "planar"),
            ("central", "planar", "space"), ("space", "central", "space", "planar"),
        )
    ),
    *(
        ([struck(one, 0.1), struck(other, 0.2)], FEW, "")
        for one, other in (
            ("inertia", "inertia"), ("principal", "axes"), ("principal", "inertia"),
            ("box", "ellipsoid"), ("rod", "box"),
        )
    ),
    ([SPHERES, TO_A_BALL], FEW, "spin about the normal"),
    ([TO_A_BALL, SPHERES], FEW, "spin about the normal"),
    ([TO_A_BALL] * 2, FEW, "spin about the normal"),
    ([OFF_CENTRE, BODY_TO_A_BALL], FEW, ""),
    ([meeting(), meeting(BODIES["turned"])], EXACT, ""),
    ([meeting(BODIES["turned"]), meeting(BODIES["principal"])], EXACT, ""),
    ([meeting(BODIES["principal"]), meeting(BODIES["turned"])], EXACT, ""),
    ([RINGING] * 2, FEW, "body rings"),
    ([RINGING, OFF_CENTRE], FEW, "body rings"),
    ([OFF_CENTRE, RINGING], FEW, "body rings"),
    ([NARROW, meeting()], FEW, "a/R = 0.768"),
    ([NARROW, OFF_CENTRE], FEW, "a/R = 0.768"),
    ([YIELDING, WITH_BODIES], FEW, "yield"),
    ([WITH_BODIES, YIELDING], FEW, "yield"),
]  # fmt: skip


@pytest.mark.parametrize(("impacts", "laws", "word"), SWEPT)
def test_unlike_impacts_in_one_sweep_have_the_answers_of_each_alone(impacts, laws, word):
    scenes = [getattr(impact, "scene", impact) for impact in impacts]
    result, told = laws.sweep(scenes).check(), []
    for place, (impact, item) in enumerate(zip(impacts, result, strict=True)):
        made = collide(impact, laws) if isinstance(impact, Encounter) else None
        alone = laws.run(scenes[place]) if made is None else made.result
        found = np.atleast_1d(item.psi2)
        expected = np.zeros_like(found)
        expected[: np.size(alone.psi2)] = alone.psi2
        assert found == pytest.approx(expected, abs=1e-12), place
        assert item.normal_restitution == pytest.approx(alone.normal_restitution, abs=1e-12)
        assert item.energy.friction_work == pytest.approx(alone.energy.friction_work, rel=1e-12)
        told += [*alone.cautions, *map(str, alone.plan.left_out)]
        if made is not None and alone.velocity_in_space is not None:
            assert alone.velocity_in_space == pytest.approx(made.velocity, rel=1e-9)
            if len({type(each.target) for each in impacts}) > 1:
                assert item.velocity_in_space is None
                continue
            assert item.velocity_in_space == pytest.approx(made.velocity, rel=1e-9)
            assert item.rebound_spin == pytest.approx(made.spin, rel=1e-9)
            assert result.velocity_in_space[place] == pytest.approx(made.velocity, rel=1e-9)
    assert f"{len(impacts)} impacts" in str(result)
    for words in (told, [*result.cautions, *map(str, result.plan.left_out)]):
        assert any(word in text for text in words)


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


@pytest.mark.parametrize("psi1", [-1.5, -0.3, 0.0, 0.8])
def test_a_planar_impact_beside_impacts_in_space_is_that_of_the_plane(psi1):
    """Slip against t1 too, alone and in a batch, told as a vector or as a number."""
    planar = Scene.nondimensional(psi1=psi1, chi=1.4, lam=0.2, eta=0.5)
    alone = EXACT.run(planar)
    batch = EXACT.run(Scene.stack([ONES["space"], planar, ONES["central"]]))
    single = EXACT.run(batch.scene.take(1))
    for found in (batch.psi2[1], single.psi2):
        assert found == pytest.approx([alone.psi2, 0.0], abs=1e-14)
    assert batch.energy.friction_work[1] == pytest.approx(alone.energy.friction_work, rel=1e-12)
    assert np.linalg.norm(batch.impulse[1] - alone.impulse) < 1e-13


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


# Where one way ends and the next begins.


@pytest.mark.parametrize("along", [0, 1])
def test_a_rod_on_its_end_is_answered_by_the_table(along):
    """W does not couple, W_tt is uneven, slip lies along a principal axis: M_t = 1/W_11."""
    velocity = [0.0, 0.0, -1.0]
    velocity[along] = 0.5
    result = EXACT.run(meeting(velocity=velocity).scene).check()
    assert result.counters == {"tabulated": 1}
    inverse = 1.0 + 0.1**2 / (0.014, 0.01)[along]
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
    lost = made.energy.friction_work + made.energy.shear_loss  # of a sphere both are one number
    assert lost == pytest.approx(sphere.energy.friction_work, rel=1e-8)
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


# Laws that caution.

ELASTIC_SHEAR = {
    "tangential": create("tangential.springs", shear_loss=0.0),
    "integrator": "symplectic",
}
FIVE_STEPS = create("integrator.symplectic", steps=5)
SPRINGS_WORDS = ("each spring is limited separately", "pressure profile")
SHARED_WORDS = ("equal damping", "damping law")
CAUTIONED = [
    ({"normal": "tsuji", **ELASTIC_SHEAR}, (*SPRINGS_WORDS, "damping law", "given, using")),
    ({"normal": "tsuji"}, (*SHARED_WORDS, "given, using")),
    ({"tangential": "coulomb"}, ("rigid contact",)),
    ({"tangential": "mindlin_cap"}, ("one spring", "create energy")),
    ({"tangential": "linear_spring", "integrator": FIVE_STEPS}, ("one spring", "steps raised")),
]
#: Laws whose normal motion is solved, which takes longer.
SOLVED = [
    ({"normal": "hunt_crossley", **ELASTIC_SHEAR}, (*SPRINGS_WORDS, "damping law")),
    ({"normal": "hunt_crossley", **BY_SPRINGS}, SHARED_WORDS),
    ({"normal": "jkr", **BY_SPRINGS}, SPRINGS_WORDS),
    ({"normal": "thornton", **BY_SPRINGS}, SPRINGS_WORDS),
    ({"normal": "walton_braun", **BY_SPRINGS}, (*SPRINGS_WORDS, "damping law")),
]


LONG = ("jkr", "thornton")


@pytest.mark.parametrize(
    ("scene", "laws", "words"),
    [
        pytest.param(
            scene, laws, words, id="-".join((*map(str, laws.values()), name)),
            marks=[pytest.mark.slow] * (name == "batch" or laws.get("normal") in LONG),
        )
        for scenes, table in (
            (WAYS | {"central batch": BATCHES["central"]}, CAUTIONED), (ONES, SOLVED),
        )
        for laws, words in table
        for name, scene in scenes.items()
    ],
)  # fmt: skip
def test_the_laws_own_cautions_hold(scene, laws, words):
    """And where friction changes the approach their sizes are said to be of spheres."""
    simulation = Simulation(**laws)
    scene = pose(scene, simulation.laws)
    result = simulation.run(scene).check()
    told, planned = str(result), [str(clause) for clause in simulation.plan(scene).cautions]
    for word in words:
        assert any(word in text for text in result.cautions), word
        assert word in told
        if word != "steps raised":
            assert any(word in text for text in planned), word
    coupled = scene.inverse_mass is not None
    assert any("measured on spheres" in text for text in result.cautions) is coupled


@pytest.mark.parametrize("coupling", [{}, {"lam": 1e-6, "eta": 1e-6}], ids=["central", "planar"])
def test_a_spring_far_off_is_told_so(coupling):
    """Truth is -1.498, by Coulomb's law at every point."""
    laws = Simulation(normal=create("normal.hunt_crossley", restitution=0.2), **ELASTIC_SHEAR)
    result = laws.run(Scene.nondimensional(psi1=4.346, chi=5.652, **coupling)).check()
    sizes = re.search(r"psi2 is off by up to ([\d.]*\d)", str(result))
    assert sizes is not None
    assert abs(result.psi2 + 1.498) < float(sizes.group(1))


def test_rigid_theory_is_not_taken_in_silence():
    """By name it answers, with a caution."""
    with pytest.raises(ValueError, match="runs only rigid friction"):
        Simulation(normal="tsuji", integrator="events")
    for scene in ONES.values():
        rigid = Simulation(normal="tsuji", tangential="coulomb", integrator="events")
        assert any("rigid contact" in text for text in rigid.run(scene).check().cautions)


# Laws that fail, with the one status that each way gives.

FEW_SPRINGS = {"tangential": FEW.tangential, "integrator": FEW.integrator}
CONTACTS = {
    "doubled": "UNBALANCED",
    "2 % more": "UNBALANCED",
    "negative": "MALFORMED",
    "negative where deep": "MALFORMED",
    "list": "MALFORMED",
    "without force": "NOT_SEPARATED",
}
#: What viscous friction declares or answers that is no number.
SLIDERS = [
    ("stiffness", math.nan), ("stiffness", [1.0]), ("stiffness", -1.0), ("stiffness", None),
    ("books_bound", math.nan), ("books_bound", [0.1]), ("books_bound", -1.0),
    ("books_bound", "small"),
    ("errors", Errors([1e-3])), ("errors", Errors(-1.0)), ("errors", (1e-3, 1e-3)),
    ("force listed",), ("work listed",), ("loss listed",), ("settled listed",),
    ("settled nan",),
]  # fmt: skip
MOTIONS = {
    "none": "gave None, not a TangentialMotion",
    "tuple": "not a TangentialMotion",
    "complex": "slip_velocity_change = .*must be real",
    "column": "friction_work = .*must be real",
    "empty": "slip_velocity_change = .*of shape",
    "word": "status = 'SUCCESS': must be a Status",
    "no status": "status = None: must be a Status",
}
OVERFLOW = pytest.mark.filterwarnings("ignore:(overflow|invalid)")
#: Laws, the status, and words of the failure.
FAULTS = [
    *(
        pytest.param(
            {"normal": Contact(how=how), **FEW_SPRINGS}, status, "", id=f"contact {how}",
            marks=[pytest.mark.slow] * (how == "2 % more"),
        )
        for how, status in CONTACTS.items()
    ),
    *(
        pytest.param(
            {"tangential": Slider(*told), "integrator": FEW.integrator}, "MALFORMED", "Slider",
            id=f"slider {told}",
        )
        for told in SLIDERS
    ),
    *(
        pytest.param(
            {"tangential": "springs", "integrator": Spoiling(how=how)}, "LAW_RAISED", words,
            id=f"integrator {how}",
        )
        for how, words in MOTIONS.items()
    ),
    pytest.param({"tangential": Liar("nan")}, "NON_FINITE", "Liar", id="nan"),
    pytest.param({"tangential": Bounded("books")}, "UNBALANCED", "declared: 0.01", id="bounded"),
    *(
        pytest.param(
            {"tangential": Slider(how)}, "UNBALANCED UNRESOLVED", "", id=how, marks=OVERFLOW
        )
        for how in ("pushes", "pulls")
    ),
]  # fmt: skip


@every_way
@pytest.mark.parametrize(("laws", "status", "words"), FAULTS)
def test_a_law_that_fails_has_a_status_and_no_answer(scene, laws, status, words):
    result = Simulation(**laws).run(scene)
    assert set(statuses(result)) <= set(status.split())
    assert np.isnan(result.psi2).all()
    assert re.search(words, f"{result.failures[0]} {result}")
    assert "needs at least" not in result.failures[0]
    if "integrator" in laws and isinstance(laws["integrator"], Spoiling):
        assert "Spoiling" in result.failures[0]


@every_way
def test_the_same_laws_without_mistakes_answer(scene):
    assert np.isfinite(Simulation(normal=Contact(), **FEW_SPRINGS).run(scene).check().psi2).all()


@one_scene
@pytest.mark.parametrize(
    "laws",
    [
        {"normal": Contact(how="doubled"), "tangential": "mindlin_cap"},
        {"normal": Contact(how="doubled"), "tangential": "linear_spring"},
        {"tangential": Slider("work below zero"), "integrator": FEW.integrator},
        {"tangential": Slider("loss below zero"), "integrator": FEW.integrator},
    ],
    ids=["capped", "spring", "work", "loss"],
)
def test_energy_from_nothing_is_seen_where_no_bound_is_declared(scene, laws):
    """Also where the books close: what one entry lacks the other has too much."""
    fast = attrs.evolve(scene, tangential_velocity=20.0 * np.asarray(scene.tangential_velocity))
    impact = scene if "normal" in laws else fast
    assert statuses(Simulation(**laws).run(impact)) == ["UNBALANCED"]


@every_way
@pytest.mark.parametrize("how", ["moves", "slows", "loads", "cuts"])
def test_no_mistake_of_a_step_looks_like_an_answer(scene, how):
    """What a law is given it may not change, and the force of one impact is not that of all."""
    sound = Simulation(tangential=Slider()).run(scene).check()
    found = Simulation(tangential=Slider(how)).run(scene)
    rows = (np.reshape(result.psi2, (len(statuses(sound)), -1)) for result in (sound, found))
    for one, other, status in zip(*rows, statuses(found), strict=True):
        told = status == ("MALFORMED" if how == "cuts" else "LAW_RAISED")
        assert told or other == pytest.approx(one, rel=1e-9)


#: How a law fails at one impact, and the integrator under which it does so in the default suite.
FAILING = {
    "not finite": ("NON_FINITE", "symplectic"),
    "raises": ("LAW_RAISED", "adaptive"),
    "unsettled": ("UNSETTLED", "paper"),
}


@each_batch
@pytest.mark.parametrize(
    ("law", "status", "integrator"),
    [
        (Liar("raises"), "LAW_RAISED", "symplectic"),
        *(
            pytest.param(
                Slider(how, damping=0.0), status, name, marks=[pytest.mark.slow] * (name != usual)
            )
            for how, (status, usual) in FAILING.items()
            for name in ("symplectic", "adaptive", "paper")
        ),
    ],
)
def test_an_impact_that_fails_takes_no_other_with_it(scene, integrator, law, status):
    laws = Simulation(tangential=law, integrator=integrator)
    result = laws.run(scene)
    assert statuses(result) == ["SUCCESS", status, "SUCCESS"]
    assert list(result.failures) == [1]
    assert type(law).__name__ in result.failures[1]
    assert status != "LAW_RAISED" or "that one" in result.failures[1]
    assert statuses(laws.run(scene.take(1))) == [status]
    if not isinstance(law, Liar):
        assert result.normal_restitution[[0, 2]] == pytest.approx(1.0, abs=1e-6)


@each_batch
def test_one_of_thousands_that_raises_costs_that_impact_alone(scene):
    batch = scene.take(np.resize(np.arange(3), 2001)).with_index(np.arange(2001))
    result = Simulation(tangential=Liar("raises"), integrator="symplectic").sweep(batch)
    assert list(result.failures) == [1]
    assert statuses(result)[1] == "LAW_RAISED"
    assert "that one" in result.failures[1]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["planar", "mixed"])
def test_one_of_two_thousand_that_raises_in_a_march(name):
    result = Simulation(tangential=Slider("raises"), integrator="symplectic").sweep(many(name))
    assert list(result.failures) == [1]


@every_way
def test_books_that_nobody_bounds_are_cautioned_of(scene):
    result = Simulation(tangential=Liar("books")).run(scene)
    assert set(statuses(result)) == {"SUCCESS"}
    off = np.max(np.abs(result.energy.relative_imbalance))
    assert off > 0.05
    told = [text for text in result.cautions if "Liar is the cause" in text]
    assert len(told) == 1
    assert f"off by {off:.2g} of the energy at the start" in told[0]
    assert told[0] in str(result)


#: Numbers of laws that differ in nothing else.
NUMBERS = itertools.count(1)


@pytest.mark.parametrize("name", ["central", "planar", *longer("space")])
@pytest.mark.parametrize("how", ["held", "without force", "at rest"])
def test_a_contact_that_never_ends_costs_some_usual_impacts(name, how):
    """By how often the normal law is asked, whatever the clock says."""
    counts = []
    for law in (Contact(), Contact(how=how)):
        ASKED[0] = 0
        fresh = attrs.evolve(law, number=next(NUMBERS))  # motions of equal laws are kept
        result = Simulation(normal=fresh, **BY_SPRINGS).run(ONES[name])
        counts.append(ASKED[0])
    assert statuses(result) == ["NOT_SEPARATED"]
    assert "the bodies do not separate" in result.failures[0]
    assert counts[1] <= 20 * counts[0]


@pytest.mark.parametrize("how", ["negative", "negative where deep"])
@pytest.mark.parametrize("shape", [(), (2,)])
def test_a_radius_below_zero_is_refused_along_a_path(how, shape):
    depth = np.linspace(0.0, 1.0, 50).reshape(-1, *(1 for _ in shape)) * np.ones(shape)
    path = load_path(ONES["central"], depth, depth, normal=Contact(how=how))
    assert set(statuses(path)) == {"MALFORMED"}
    assert "radius below zero" in path.detail


def test_a_law_that_cannot_say_whether_it_runs_does_not_run():
    words = "tangential = Undecided: its accept raised TypeError: unknown scene"
    with pytest.raises(ValueError, match=words):
        Simulation(tangential=Undecided()).run(ONES["central"])


# Laws that cannot follow a scene: others stand in where nobody named them, else they are refused.


@coupled_way
@pytest.mark.slow
def test_laws_that_nobody_named_give_way_to_springs_and_the_plan_says_so(scene):
    simulation = Simulation(normal="linear")
    result = simulation.run(scene).check()
    stand_in = [str(each) for each in result.plan.computed if str(each).startswith("laws")]
    assert len(stand_in) == 1
    assert "springs for annulus" in stand_in[0]
    assert "cannot follow this impact" in stand_in[0]
    assert [*map(str, simulation.plan(scene).computed)] == [*map(str, result.plan.computed)]
    assert "springs" in result.laws["tangential"]
    named = Simulation(normal="linear", **BY_SPRINGS).run(scene)
    where = np.asarray(kinetics.size_of(scene, np.asarray(scene.lam))) > 0.0
    assert np.array_equal(np.asarray(result.psi2)[where], np.asarray(named.psi2)[where])


IN_SPACE_ALONE = [
    {"integrator": "events"},
    {"tangential": "fronts"},
    {"tangential": "mindlin_deresiewicz"},
    {"tangential": "thornton_yin"},
]
REMEDIED = [
    {"tangential": "annulus"},
    *IN_SPACE_ALONE,
    {"tangential": "annulus", "integrator": "symplectic"},
    {"normal": "tsuji", "tangential": "annulus"},
    {"normal": "hunt_crossley", "tangential": "annulus"},
]


def follow(error, laws):
    """Return the laws by each remedy of a refusal, word by word."""
    words = re.search(r"use ((?:\w+='\w+'(?:, )?)+), or leave both out", str(error))
    assert words is not None, str(error)
    told = dict(re.findall(r"(\w+)='(\w+)'", words.group(1)))
    yield laws | told
    yield {kind: name for kind, name in laws.items() if kind not in told}
    for kind, name in re.findall(r"or name it: (\w+)='(\w+)'", str(error)):
        yield laws | {kind: name}


def follow_all(scene, laws):
    """Every remedy of the refusal of laws is followed; plan and sweep refuse in the same words."""
    simulation = Simulation(**laws)
    with pytest.raises(ValueError, match="use") as caught:
        simulation.run(scene)
    doors = [simulation.plan, *([simulation.sweep] if scene.shape else [])]
    for door in doors:
        with pytest.raises(ValueError, match=re.escape(str(caught.value))):
            door(scene)
    for remedied in follow(caught.value, laws):
        Simulation(**remedied).run(scene).check()


@coupled_way
@pytest.mark.parametrize("laws", REMEDIED, ids=str)
@pytest.mark.slow
def test_a_remedy_that_is_followed_works(scene, laws):
    if laws in IN_SPACE_ALONE and scene.planar:
        Simulation(**laws).run(scene).check()
    else:
        follow_all(scene, laws)


RIGID = Simulation(tangential="coulomb")
HISTORIES = [
    (EXACT, BATCHES["planar"]),
    (EXACT, Scene.stack([ONES["central"], ONES["planar"]])),
    *((RIGID, BATCHES[name]) for name in ("planar", "space", "mixed")),
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
    assert "springs for fronts" in str(result.plan)
    assert np.array_equal(made.velocity, result.velocity_in_space)
