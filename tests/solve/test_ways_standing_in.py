"""Which laws answer: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import re

import numpy as np
import pytest

from contactlab import (
    Scene,
    Simulation,
    collide,
)
from contactlab.impact import kinetics
from tests.solve.any_scene import (
    BATCHES,
    BY_SPRINGS,
    EXACT,
    FEW,
    OFF_CENTRE,
    ONES,
    SPRINGS,
    body,
    coupled_way,
    every_way,
    meeting,
)


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


REMEDIED = [
    {"tangential": "annulus"},
    {"tangential": "annulus", "integrator": "symplectic"},
    {"normal": "tsuji", "tangential": "annulus"},
    {"normal": "hunt_crossley", "tangential": "annulus"},
]
IN_SPACE_ALONE = [
    {"integrator": "events"},
    {"tangential": "fronts"},
    {"tangential": "mindlin_deresiewicz"},
    {"tangential": "thornton_yin"},
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


@coupled_way
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
    if laws in IN_SPACE_ALONE and scene.planar:
        Simulation(**laws).run(scene).check()
        return
    follow_all(scene, laws)


def follow_all(scene, laws):
    """Every remedy of the refusal of laws is followed."""
    simulation = Simulation(**laws)
    with pytest.raises(ValueError, match="use") as caught:
        simulation.run(scene)
    doors = [simulation.plan, *([simulation.sweep] if scene.shape else [])]
    for door in doors:
        with pytest.raises(ValueError, match=re.escape(str(caught.value))):
            door(scene)
    for remedied in follow(caught.value, laws):
        Simulation(**remedied).run(scene).check()


def test_rigid_theory_is_not_taken_in_silence():
    """By name it answers, with a caution."""
    with pytest.raises(ValueError, match="runs only rigid friction"):
        Simulation(normal="tsuji", integrator="events")
    for name in ("central", "planar", "space"):
        rigid = Simulation(normal="tsuji", tangential="coulomb", integrator="events")
        assert any("rigid contact" in text for text in rigid.run(ONES[name]).check().cautions)


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
