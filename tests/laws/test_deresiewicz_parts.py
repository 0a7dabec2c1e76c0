"""Branches of loading, unloading and reloading, by hand (Mindlin & Deresiewicz's curves)."""

import math

import pytest

from contactlab_laws.deresiewicz import branches
from contactlab_laws.deresiewicz.branches import (
    LOADING,
    RELOADING,
    UNLOADING,
    ContactState,
    Step,
    followed,
)


def step(displacement, limit=1.0):
    """Return a step at stiffness 1.5 and limit 1, where q = (2/3) k M^(-1/3) = 1."""
    return Step(limit, 1.5, 1.0, displacement)


#: At the limit 1 a contact was sheared by 0.3: epsilon = 0.3, T = 1 - 0.7^1.5.
SHEARED = ContactState(1.0 - 0.7**1.5, 1.0, 0.3, 1, LOADING)


@pytest.mark.parametrize(
    ("moves", "force", "slipped", "branch", "sense"),
    [
        ([0.3], 1.0 - 0.7**1.5, 0.3, LOADING, 1),
        ([0.3, 0.2], 1.0 - 0.5**1.5, 0.5, LOADING, 1),
        ([-0.3], 0.7**1.5 - 1.0, 0.3, LOADING, -1),
        ([0.6, 0.4], 1.0, 1.0, LOADING, 1),
        ([0.6, 0.7], 1.0, 1.0, LOADING, 1),
        ([0.5, -0.4], (1 - 0.5**1.5) - 2.0 * (1 - 0.8**1.5), 0.2, UNLOADING, -1),
        (
            [0.5, -0.4, 0.2],
            (1 - 0.5**1.5) - 2.0 * (1 - 0.8**1.5) + 2.0 * (1 - 0.9**1.5),
            0.1,
            RELOADING,
            1,
        ),
        ([0.5, -0.4, 0.4], 1 - 0.5**1.5, None, None, 1),  # the loop closes
        ([0.5, -0.4, 0.6], 1 - 0.3**1.5, 0.7, LOADING, 1),  # and loading goes on
        ([0.5, -1.0], 0.5**1.5 - 1.0, None, None, -1),  # as far the other way
        ([0.5, -1.2], 0.3**1.5 - 1.0, 0.7, LOADING, -1),
        ([0.5, -2.5], -1.0, 1.0, LOADING, -1),
        ([0.3, 0.0], 1.0 - 0.7**1.5, 0.0, LOADING, 0),  # sticks
    ],
)
def test_a_path_at_constant_load(moves, force, slipped, branch, sense):
    state = ContactState(limit=1.0)
    for move in moves:
        state, work = followed(state, step(move))
        assert work >= 0.0
        assert state.held == 0.0  # at constant load nothing sticks while it grows
    assert state.force == pytest.approx(force, abs=1e-12)
    assert state.sense == sense
    if sense and slipped is not None:
        assert (state.slipped, state.branch) == (pytest.approx(slipped, abs=1e-12), branch)


def test_work_is_that_of_the_loop():
    """Over a whole cycle of a contact the friction work is the area of its loop."""
    state, work, area, at = ContactState(limit=1.0), 0.0, 0.0, []
    moves = [0.001] * 500 + [-0.001] * 1000 + [0.001] * 1000
    for count, move in enumerate(moves):
        before = state
        state, lost = followed(state, step(move))
        if count >= 500:
            work += lost
            area += 0.5 * (before.force + state.force) * move
        at.append(state.force)
    assert at[-1] == pytest.approx(at[499], abs=1e-9)
    assert work == pytest.approx(area, rel=2e-3)


@pytest.mark.parametrize("displacement", [0.1, -0.1, 0.0])
def test_a_contact_that_only_grows_sticks(displacement):
    """k dD where the limit outruns the displacement, and no more than the limit."""
    state, work = followed(ContactState(), step(displacement, limit=8.0))
    assert state.force == pytest.approx(1.5 * displacement)
    assert (state.sense, state.slipped, state.limit, work) == (0, 0.0, 8.0, 0.0)
    assert state.outrun == pytest.approx(abs(displacement) - 4.0 if displacement else -4.0)
    capped, _ = followed(ContactState(force=-7.0), step(0.0, limit=2.0))
    assert capped.force == -2.0


def test_a_contact_without_load_or_slip_rate_does_no_work():
    """It leaves with its limit 0: no force, nothing that slips."""
    state, work = followed(ContactState(sense=1, slipped=0.4), Step(0.0, 0.0, 0.0, 0.2))
    assert (state.force, state.slipped, state.limit, work) == (0.0, 0.0, 0.0, 0.0)
    assert state.sense == 0


def test_turning_points_move_with_the_load():
    """The last turn, out of slip forward, grows by dM; the earlier one falls by as much."""
    state = ContactState(0.2, 1.0, 0.1, -1, UNLOADING, 0.0, 0.6, 0.0)
    after = branches._slipped(state, step(-0.1, limit=1.2))
    assert after.turn == pytest.approx(0.6 + 0.2)
    grown = 1.2 ** (2 / 3)
    slipped = (0.1 + 0.5 * 0.1 + 0.5 * (grown - 1.0)) / grown
    assert after.slipped == pytest.approx(slipped)
    assert after.force == pytest.approx(0.8 - 2.4 * (1.0 - (1.0 - slipped) ** 1.5))
    again = state._replace(sense=1, branch=RELOADING, turn=-0.3, earlier=0.6)
    after = branches._slipped(again, step(0.1, limit=1.2))
    assert (after.turn, after.earlier) == pytest.approx((-0.5, 0.8))


@pytest.mark.parametrize(
    ("slipped", "used"), [(0.0, 0.0), (0.19, 1.0 - 0.9**3), (0.75, 0.875), (1.0, 1.0)]
)
def test_edge_and_force_are_each_others_inverse(slipped, used):
    assert branches._used(slipped) == pytest.approx(used, abs=1e-15)
    assert branches._edge(used) == pytest.approx(slipped, abs=1e-15)
    assert branches._used(1.1) == branches._edge(1.1) == 1.0
    theta = math.sqrt(1.0 - slipped)
    assert branches._annulus(slipped) == pytest.approx(1 - 1.5 * theta + 0.5 * theta**3, abs=1e-15)


@pytest.mark.parametrize(
    ("outrun", "begun"), [(-0.1, 0.1 / 0.3), (0.0, 0.5), (0.1, 0.5), (-0.4, 0.4 / 0.6)]
)
def test_where_slip_begins_in_a_contact_that_stuck(outrun, begun):
    """T = 0.3 at the limit 1; slip began before or after the middle as the gap stood still."""
    state = ContactState(force=0.3, limit=1.0, outrun=outrun)
    now = Step(1.331, 1.5, 1.0, 0.2 + 0.21)  # 1.331^(2/3) - 1 = 0.21: 0.2 ahead
    found = branches._turned(state, now)
    later = (begun - 0.5) * 0.331
    held = (0.3 + later) / (1.0 + later)
    assert (found.sense, found.branch) == (1, LOADING)
    assert found.held == pytest.approx(held)
    slipped = 1.0 - (1.0 - (0.3 - held) / (1.0 - held)) ** (2.0 / 3.0)
    assert found.slipped == pytest.approx(slipped)


def test_an_edge_that_may_slip_both_ways_goes_on_as_before():
    """Under a falling load: both outrun the limit; under a growing one neither, and it sticks."""
    falling = Step(0.9, 1.5, 1.0, 0.01)
    assert branches._turned(SHEARED, falling) is SHEARED
    back = branches._turned(SHEARED, Step(0.9, 1.5, 1.0, -0.2))
    assert (back.sense, back.branch, back.turn, back.slipped) == (-1, UNLOADING, SHEARED.force, 0.0)
    again = branches._turned(back._replace(force=0.1), step(0.2))
    assert (again.sense, again.branch) == (1, RELOADING)
    assert (again.turn, again.earlier) == (0.1, SHEARED.force)
    third = branches._turned(again, step(-0.2))
    assert (third.sense, third.branch) == (-1, UNLOADING)
    stuck = branches._turned(SHEARED, step(0.2, limit=2.0))
    assert stuck.sense == 0


def test_what_stuck_begins_to_slip_along_its_force_where_nothing_moves():
    state = ContactState(force=-0.3, limit=1.0)
    found = branches._turned(state, Step(0.8, 1.5, 1.0, 0.0))
    assert found.sense == -1
    assert branches._turned(ContactState(limit=1.0), Step(0.8, 1.5, 1.0, 0.0)).sense == 0
