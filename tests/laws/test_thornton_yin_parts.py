"""Branches of loading, unloading and reloading, by hand (Mindlin & Deresiewicz's curves)."""

import pytest

from contactlab_laws.thornton_yin.branches import (
    LOADING,
    RELOADING,
    UNLOADING,
    ContactState,
    Step,
    follow_step,
)


def step(displacement, limit=1.0):
    """Return a step at stiffness 1.5 and limit 1, where q = (2/3) k M^(-1/3) = 1."""
    return Step(limit, 1.5, 1.0, displacement)


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
        state, work = follow_step(state, step(move))
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
        state, lost = follow_step(state, step(move))
        if count >= 500:
            work += lost
            area += 0.5 * (before.force + state.force) * move
        at.append(state.force)
    assert at[-1] == pytest.approx(at[499], abs=1e-9)
    assert work == pytest.approx(area, rel=2e-3)


@pytest.mark.parametrize("displacement", [0.1, -0.1, 0.0])
def test_a_contact_that_only_grows_sticks(displacement):
    """k dD where the limit outruns the displacement, and no more than the limit."""
    state, work = follow_step(ContactState(), step(displacement, limit=8.0))
    assert state.force == pytest.approx(1.5 * displacement)
    assert (state.sense, state.slipped, state.limit, work) == (0, 0.0, 8.0, 0.0)
    assert state.outrun == pytest.approx(abs(displacement) - 4.0 if displacement else -4.0)
    capped, _ = follow_step(ContactState(force=-7.0), step(0.0, limit=2.0))
    assert capped.force == -2.0
