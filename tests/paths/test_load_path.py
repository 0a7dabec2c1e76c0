"""Prescribed paths against Cattaneo, Mindlin and Deresiewicz, and against what laws do wrong."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import (
    Encounter,
    HalfSpace,
    ImpactError,
    Material,
    RigidBody,
    Scene,
    Simulation,
    Sphere,
    Status,
    load_path,
)
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse

MU, DEEP = 0.3, 1e-6
BALL = Sphere(0.01, Material.named("steel"))
SCENE = Scene(BALL, BALL, MU, normal_speed=1.0)
#: Displacement at which a contact of approach DEEP begins to slip all over, in m.
FULL = MU * DEEP / SCENE.pair.stiffness_ratio


def springs(count):
    return contactlab.create("tangential.springs", springs=count)


def share(reach):
    """Return Cattaneo and Mindlin's F/(mu P) at a displacement over FULL, from 0 to 1."""
    return 1.0 - (1.0 - np.minimum(reach, 1.0)) ** 1.5


@pytest.mark.parametrize("law", [springs(200), "annulus", "mindlin_deresiewicz", "thornton_yin"])
def test_cattaneo(law):
    reach = np.linspace(0.0, 1.3, 131)
    path = load_path(SCENE, np.full(131, DEEP), reach * FULL, tangential=law).check()
    assert path.friction_force / (MU * path.normal_force) == pytest.approx(share(reach), abs=1e-3)
    hertz = (4 / 3) * SCENE.pair.effective_modulus * np.sqrt(SCENE.pair.radius) * DEEP**1.5
    assert path.normal_force == pytest.approx(np.full(131, hertz), rel=1e-12)
    assert path.contact_radius == pytest.approx(
        np.full(131, np.sqrt(DEEP * SCENE.pair.radius)), rel=1e-12
    )


@pytest.mark.parametrize("turn", [0.3, 0.8])
def test_loops_of_mindlin_and_deresiewicz(turn):
    """Closed forms at constant load: Mindlin & Deresiewicz, J. Appl. Mech. 20 (1953) 327-344."""
    up = np.linspace(0.0, turn, 101)
    down, again = np.linspace(turn, -turn, 201)[1:], np.linspace(-turn, turn, 201)[1:]
    reach = np.concatenate((up, down, again))
    path = load_path(
        SCENE, np.full(len(reach), DEEP), reach * FULL, tangential=springs(200)
    ).check()
    force = path.friction_force / (MU * path.normal_force)
    most = share(turn)
    unloading = most - 2.0 * share((turn - down) / 2.0)
    reloading = -most + 2.0 * share((turn + again) / 2.0)
    assert force[:101] == pytest.approx(share(up), abs=1e-3)
    assert force[101:301] == pytest.approx(unloading, abs=1e-3)
    assert force[301:] == pytest.approx(reloading, abs=1e-3)
    # The loss of a cycle is the area of the loop.
    area = -4.0 * most * turn + 8.0 * (turn - 0.4 * (1.0 - (1.0 - turn) ** 2.5))
    unit = MU * path.normal_force[0] * FULL
    lost = (path.friction_work[-1] - path.friction_work[100]) / unit
    assert lost == pytest.approx(area, rel=5e-3)
    assert (path.work[-1] - path.work[100]) / unit == pytest.approx(area, rel=5e-3)


def test_load_alone_gives_no_friction_force():
    depth = np.concatenate((np.linspace(0.0, DEEP, 51), np.linspace(DEEP, 0.2 * DEEP, 50)))
    path = load_path(SCENE, depth, np.full(101, 3.7e-6)).check()
    assert not path.friction_force.any()
    assert not path.friction_work.any()
    # A sheared contact that is pressed more keeps its force; a spring stiffened by load does not.
    half = np.concatenate((np.full(51, 0.5 * DEEP), np.linspace(0.5 * DEEP, DEEP, 50)))
    moved = np.concatenate((np.linspace(0.0, 0.25 * FULL, 51), np.full(50, 0.25 * FULL)))
    kept = load_path(SCENE, half, moved).check().friction_force
    assert kept[51:] == pytest.approx(np.full(50, kept[50]), rel=1e-3)
    stiffened = load_path(SCENE, half, moved, tangential="mindlin_cap").check().friction_force
    assert stiffened[-1] / stiffened[50] == pytest.approx(np.sqrt(2.0), rel=1e-9)


def oscillating(cycles, low):
    """Return a path: pressed, sheared by a tenth of FULL, and the load made to oscillate."""
    swing = np.concatenate((np.linspace(DEEP, low, 21)[1:], np.linspace(low, DEEP, 21)[1:]))
    depth = np.concatenate((np.full(41, DEEP), np.tile(swing, cycles)))
    moved = np.concatenate((np.linspace(0.0, 0.1 * FULL, 41), np.full(40 * cycles, 0.1 * FULL)))
    return depth, moved


@pytest.mark.parametrize("form", ["displacement_rescaled", "increment_rescaled"])
def test_rescaled_capped_springs_creep_under_an_oscillating_load(form):
    """While the radius shrinks the force is scaled with it; growing gives nothing back."""
    cap = contactlab.create("tangential.mindlin_cap", form=form)
    path = load_path(SCENE, *oscillating(8, 0.64 * DEEP), tangential=cap).check()
    ends = path.friction_force[40::40]
    assert ends[1:] / ends[:-1] == pytest.approx(np.full(8, 0.8), rel=1e-9)
    held = load_path(SCENE, *oscillating(8, 0.64 * DEEP), tangential=springs(200)).check()
    ends = held.friction_force[40::40]
    assert ends[1:] == pytest.approx(np.full(8, ends[1]), rel=1e-9)  # after the first cycle
    assert ends[1] > 0.75 * ends[0]


def test_a_batch_is_its_paths():
    rng = np.random.default_rng(3)
    depth = np.abs(np.cumsum(rng.normal(0.05, 0.2, (30, 3)), axis=0)) * DEEP
    moved = np.cumsum(rng.normal(0.0, 0.2, (30, 3)), axis=0) * FULL
    scenes = Scene(BALL, BALL, np.array([0.1, 0.3, 0.9]), normal_speed=1.0)
    batch = load_path(scenes, depth, moved).check()
    for item in range(3):
        alone = load_path(scenes.take(item), depth[:, item], moved[:, item]).check()
        for name in ("normal_force", "friction_force", "friction_work", "contact_radius", "work"):
            assert getattr(batch, name)[:, item] == pytest.approx(
                getattr(alone, name), rel=1e-9, abs=1e-12 * np.abs(getattr(alone, name)).max()
            )
        for name, field in alone.fields.items():
            assert batch.fields[name][:, item] == pytest.approx(field, rel=1e-9, abs=1e-16)
    shared = load_path(scenes, depth[:, 0], moved[:, 0])
    assert shared.friction_force.shape == (30, 3)


def test_random_paths_give_no_energy():
    rng = np.random.default_rng(5)
    depth = np.repeat(rng.uniform(0.05, 1.0, (40, 20)), 12, axis=0) * DEEP
    depth = np.apply_along_axis(
        lambda line: np.interp(np.arange(480), np.arange(0, 480, 12), line[::12]), 0, depth
    )
    knots = rng.normal(0.0, 0.8, (40, 20)) * FULL
    moved = np.apply_along_axis(
        lambda line: np.interp(np.arange(480), np.arange(0, 480, 12), line), 0, knots
    )
    path = load_path(SCENE, depth, moved).check()
    unit = MU * path.normal_force.max() * FULL
    assert (path.work - path.friction_work).min() > -2e-3 * unit
    assert np.diff(path.friction_work, axis=0).min() >= -1e-12 * unit


@pytest.mark.parametrize("normal", ["tsuji", "kuwabara_kono", "thornton", "jkr", "dmt", "linear"])
def test_any_normal_law(normal):
    depth = np.concatenate((np.linspace(0.0, DEEP, 61)[1:], np.linspace(DEEP, 0.0, 61)[1:-1]))
    law = contactlab.create(f"normal.{normal}")
    tangential = "linear_spring" if normal == "linear" else "annulus"
    path = load_path(SCENE, depth, np.linspace(0, FULL, 119), normal=law, tangential=tangential)
    path.check()
    state, forces = law.start(SCENE), []
    for approach in depth.tolist():
        contact, state = law.respond(state, approach, 0.0)
        forces.append(float(contact.force))
    assert path.normal_force == pytest.approx(forces, rel=1e-6, abs=1e-9 * max(forces))
    assert (np.abs(path.friction_force) <= 1.05 * MU * path.friction_load + 1e-12).all()


def test_a_rate_counts_if_times_are_given():
    law = contactlab.create("normal.tsuji", restitution=0.8)
    depth = np.linspace(0.0, DEEP, 101)[1:]
    still = np.zeros(100)
    slow = load_path(SCENE, depth, still, normal=law)
    fast = load_path(SCENE, depth, still, normal=law, time=np.linspace(2.0, 2.0 + 1e-6, 100))
    assert fast.time[0] == pytest.approx(2.0, rel=1e-15)
    elastic = load_path(SCENE, depth, still)
    assert slow.normal_force == pytest.approx(elastic.normal_force, rel=1e-9)
    state = law.start(SCENE)
    expected = [float(law.respond(state, z, DEEP / 100 * 99e6)[0].force) for z in depth.tolist()]
    assert fast.normal_force == pytest.approx(expected, rel=1e-6)
    assert fast.normal_force[50] > 1.01 * slow.normal_force[50]
    damped = contactlab.create("tangential.mindlin_cap", damping=0.3)
    path = np.full(100, DEEP), np.linspace(0.0, 0.2 * FULL, 100)
    quick = load_path(SCENE, *path, tangential=damped, time=np.linspace(0.0, 1e-6, 100))
    assert quick.friction_force[50] > 1.01 * load_path(SCENE, *path).friction_force[50]


@attrs.frozen(kw_only=True)
class Fails(SteppedTangentialLaw):
    """NaN, an exception or no answer from a tenth of FULL on, where mu is 0.5 or more."""

    api_version: ClassVar[int] = 2
    way: str = "nan"

    def start(self, scene, normal):
        return np.asarray(scene.friction_coefficient) + 0.0 * normal.duration, 0.0

    def advance(self, state, increment, before, after):
        friction, moved = state[0], state[1] + increment.displacement
        bad = (moved >= 0.1 * FULL) & (friction >= 0.5)
        if self.way == "raise" and np.any(bad):
            raise ArithmeticError("as it was asked to")
        force = moved + np.where(bad, np.nan if self.way == "nan" else 0.0, 0.0)
        answer = TangentialResponse(force, 0.0 * moved, ~bad if self.way == "unsettled" else True)
        return answer, (friction, moved)


@pytest.mark.parametrize(
    ("way", "status"),
    [
        ("nan", Status.NON_FINITE),
        ("raise", Status.LAW_RAISED),
        ("unsettled", Status.UNSETTLED),
    ],
)
def test_a_failure_costs_its_path_only(way, status):
    scenes = Scene(BALL, BALL, np.array([0.1, 0.7]), normal_speed=1.0)
    moved = np.linspace(0.0, FULL, 21)
    path = load_path(scenes, np.full(21, DEEP), moved, tangential=Fails(way=way))
    assert list(path.status) == [Status.SUCCESS, status]
    assert "Fails" in path.detail
    assert "At step 4:" in path.detail
    assert path.friction_force[:, 0] == pytest.approx(moved, abs=1e-20)
    assert np.isnan(path.friction_force[-1, 1])
    assert np.isfinite(path.friction_force[0, 1]) == (way != "raise")
    with pytest.raises(ImpactError, match="Fails"):
        path.check()
    alone = load_path(scenes.take(1), np.full(21, DEEP), moved, tangential=Fails(way=way))
    assert alone.status is status


PATH = np.full(4, DEEP)


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        ((SCENE, PATH, np.zeros(5)), {}, "same number of points"),
        ((SCENE, DEEP, np.zeros(4)), {}, r"approach = .*for one point give \[1e-06\]"),
        ((SCENE, None, None), {}, "approach = None: .*; give the path in m"),
        ((SCENE, PATH, None), {}, "displacement = None: .*; give the path in m"),
        ((SCENE, PATH, [0.0, 0.0, np.nan, 0.0]), {}, "displacement = "),
        ((SCENE, np.zeros((4, 2)), np.zeros((4, 3))), {}, "must broadcast"),
        ((SCENE, PATH, PATH), {"time": [0.0, 1.0, 1.0, 2.0]}, "must grow"),
        ((SCENE, PATH, PATH), {"tangential": "coulomb"}, "must be a law of steps"),
        ((SCENE, PATH, PATH), {"tangential": "springz"}, "springs"),
        (("steel", PATH, PATH), {}, "must be a Scene"),
    ],
)
def test_bad_input_is_refused(arguments, options, words):
    with pytest.raises(ValueError, match=words):
        load_path(*arguments, **options)


@pytest.mark.parametrize("deep", [1e-8, DEEP])
@pytest.mark.parametrize("speed", [1e-3, 1.0])
def test_one_spring_is_as_stiff_as_an_impact_as_deep_as_the_path(speed, deep):
    """k_n = M v²/z², where ½ M v² = (8/15) E* sqrt(R) z^2.5, whatever the scene's speed."""
    pair = SCENE.pair
    moved = [0.0, 1e-6 * deep]
    scene = Scene(BALL, BALL, MU, normal_speed=speed)
    path = load_path(scene, [deep, deep], moved, tangential="linear_spring").check()
    stiffness = 16.0 / 15.0 * pair.effective_modulus * np.sqrt(pair.radius * deep)
    expected = pair.stiffness_ratio * stiffness * moved[1]
    assert path.friction_force[1] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("law", ["springs", "annulus", "linear_spring"])
@pytest.mark.parametrize("normal", ["hertz", "tsuji", "walton_braun", "jkr"])
def test_the_path_of_an_impact_has_its_forces(normal, law):
    """The slip is integrated here from the history of a run, by the trapezium rule."""
    scene = Scene(BALL, BALL, MU, normal_speed=0.5, tangential_velocity=0.2)
    history = Simulation(normal=normal, tangential=law).run(scene, history=True).check().history
    slips = history.slip_velocity
    steps = np.diff(history.time) * 0.5 * (slips[1:] + slips[:-1])
    moved = np.concatenate(([0.0], np.cumsum(steps)))
    path = load_path(
        scene, history.approach, moved, normal=normal, tangential=law, time=history.time
    ).check()
    largest = np.abs(history.tangential_force).max()
    off = path.friction_force - history.tangential_force
    assert np.abs(off[:-1]).max() < 0.03 * largest


@pytest.mark.parametrize(
    "law", ["springs", "annulus", "linear_spring", "mindlin_deresiewicz", "thornton_yin"]
)
@pytest.mark.parametrize("normal", ["hertz", "thornton", "jkr"])
def test_bodies_that_never_touch_have_no_forces(normal, law):
    moved = np.linspace(0.0, 2.0 * FULL, 9)
    laws = {"normal": normal, "tangential": law}
    apart = np.full(9, -DEEP)
    alone = load_path(SCENE, apart, moved, **laws).check()
    both = load_path(SCENE, np.transpose([apart, -apart]), moved, **laws).check()
    for name in ("normal_force", "friction_force", "friction_work", "work"):
        assert np.all(getattr(alone, name) == 0.0)
        assert np.all(getattr(both, name)[:, 0] == 0.0)
    assert np.all(both.friction_force[1:, 1] > 0.0)


def test_a_path_may_have_one_point():
    path = load_path(SCENE, [DEEP], [1.0]).check()
    assert path.friction_force == 0.0
    assert path.work == 0.0


@pytest.mark.slow
def test_a_path_says_where_a_law_does_not_hold():
    """Thirty cycles of the load by 10 % at a held displacement, against many springs."""
    scene = Scene(BALL, BALL, 0.3, 1.0)
    press = np.linspace(1e-8, 1e-6, 100)
    load = np.concatenate((press, np.full(100, 1e-6)))
    load = np.append(load, 1e-6 * (1.0 + 0.1 * np.sin(np.linspace(0.0, 60.0 * np.pi, 3000))))
    held = np.concatenate((0.0 * press, np.linspace(0.0, 2.2e-7, 100), np.full(3000, 2.2e-7)))
    paths = {
        name: load_path(scene, load, held, tangential=name)
        for name in ("springs", "mindlin_deresiewicz", "thornton_yin", "mindlin_cap")
    }
    last = {name: path.friction_force[-1] for name, path in paths.items()}
    assert last["mindlin_deresiewicz"] == pytest.approx(last["springs"], rel=2e-3)
    assert not (*paths["springs"].cautions, *paths["mindlin_deresiewicz"].cautions)
    for name in ("thornton_yin", "mindlin_cap"):
        assert abs(last[name] / last["springs"] - 1.0) > 0.1
        assert "a held displacement" in str(paths[name])
        with pytest.raises(ImpactError, match="caution"):
            paths[name].check(cautions=True)


@pytest.mark.parametrize("name", ["jkr", "thornton"])
def test_a_law_made_for_a_circle_says_so_along_a_path(name):
    axes = {"curvature_radius": 0.02, "cross_radius": 0.005, "curvature_axis": (1, 0, 0)}
    body = RigidBody(mass=0.1, inertia=1e-5 * np.eye(3), material=Material.named("steel"), **axes)
    floor, down = HalfSpace(body.material), (0, 0, -1)
    scene = Encounter(
        body, floor, 0.3, normal=down, velocity=(0.2, 0, -1), contact=(0, 0, -0.01)
    ).scene
    steps = np.linspace(0.0, 1e-7, 11)
    for normal, told in ((name, True), ("hertz", False)):
        path = load_path(scene, 1e-7 + steps, steps, normal=normal)
        assert any("an ellipse of" in text for text in path.cautions) == told


def test_a_path_cautions_of_its_bodies():
    lead = Sphere(0.01, Material.named("lead"))
    path = load_path(Scene(lead, lead, 0.3, 1.0), [1e-6, 2e-4], [0.0, 0.0])
    assert any("yield" in text for text in path.cautions)
    assert any("large contact" in text for text in path.cautions)
