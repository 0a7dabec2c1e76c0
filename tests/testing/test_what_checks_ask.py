"""The courses along which checks lead a law: what their sentences say is what they do."""

from typing import Any

import attrs
import numpy as np
import pytest

from contactlab.testing import checks_for, outcome
from contactlab.testing.load_paths import Bench
from contactlab.testing.normal_motions import RATES
from tests.testing.broken_laws import Sound
from tests.testing.fresh_sound import Press

BENCH = Bench.of()


@attrs.frozen(kw_only=True)
class Recording(Sound):
    """Keeps slip, zeta, friction load over that of zeta, and duration of each step of each run."""

    runs: Any = attrs.field(factory=list, eq=False)

    def start(self, scene, normal):
        if not scene.shape:
            self.runs.append([])
        return super().start(scene, normal)

    def advance(self, state, increment, before, after):
        if not np.ndim(increment.displacement):
            level = float(after.overlap / BENCH.approach)
            load = increment.friction_load / (BENCH.force * level**1.5) if level > 0.0 else 0.0
            slip = float(increment.displacement / BENCH.slip)
            self.runs[-1].append((slip, level, float(load), increment.duration / BENCH.time))
        return super().advance(state, increment, before, after)


@attrs.frozen(kw_only=True)
class RecordingPress(Press):
    """Keeps approach and rate of each contact of each run."""

    runs: Any = attrs.field(factory=list, eq=False)

    def start(self, scene):
        self.runs.append([])
        return super().start(scene)

    def respond(self, state, approach, rate):
        if not np.ndim(approach):
            self.runs[-1].append((float(approach), float(rate)))
        return super().respond(state, approach, rate)


def asked(name, law):
    """The runs of a check, arrays with a column for each quantity."""
    outcome(law, next(check for check in checks_for(law) if check.name == name))
    return [np.array(run).T for run in law.runs if run]


def paths(name):
    """Slip so far, zeta, load and duration along each path of a check of stepped laws."""
    return [(np.cumsum(moved), *others) for moved, *others in asked(name, Recording())]


def test_cycles_are_closed_and_begin_by_pressing():
    runs = paths("closed_cycles")
    assert len(runs) == 15
    for slip, level, _, _ in runs:
        assert not slip[:24].any()
        assert level[0] == pytest.approx(level[23] / 24)
        second, third = (slice(24 * first, 24 * (first + 4)) for first in (5, 9))
        assert slip[second] == pytest.approx(slip[third], abs=1e-12)
        assert level[second] == pytest.approx(level[third])
        assert slip[24 * 5 - 1] == pytest.approx(slip[24 * 13 - 1])
        assert np.ptp(slip) == pytest.approx(2.0 * slip.max())
    assert sorted({round(slip.max(), 9) for slip, *_ in runs}) == [0.15, 0.5, 2.0]
    assert {(round(level[24:].min(), 9), round(level.max(), 9)) for _, level, _, _ in runs} == {
        (0.6, 0.6), (0.2, 0.8), (0.4, 1.0),
    }  # fmt: skip


def test_random_paths_begin_without_slip_and_half_of_them_keep_the_load():
    runs = paths("random_paths")
    kept = [bool(np.ptp(level[15:]) < 1e-12) for _, level, _, _ in runs]
    assert kept == [True] * 6 + [False] * 6
    for slip, level, load, duration in runs:
        assert not slip[:16].any()
        assert level.min() > 0.0
        assert load == pytest.approx(1.0)
        assert duration == pytest.approx(1.0 / len(slip))


def test_books_are_closed_where_the_bodies_part():
    runs = paths("books")
    assert len(runs) == 3
    for slip, level, _, _ in runs:
        assert level[-1] == 0.0
        assert level[-2] > 0.0
        assert not np.diff(slip[-128:]).any()
        assert np.diff(level[-129:]) == pytest.approx(-level[-129] / 128)


def test_a_sheared_contact_is_released_and_pushed_back():
    runs = paths("partial_unloading")
    for slip, level, _, _ in runs:
        size = slip.max()
        assert slip[-1] == pytest.approx(-2.0 * size)
        assert level[39] == level[79] == level[:80].max()
        assert level[-1] == pytest.approx(level[119])
    sheared = {(round(run[1][39], 9), round(run[1][-1], 9)) for run in runs}
    assert {(1.0, 0.4), (1.0, 0.1), (0.4, 1.0), (0.1, 0.8)} <= sheared


def test_a_step_back_is_small_after_long_ones():
    [(slip, level, _, duration)] = paths("work_in_its_step")
    assert np.diff(slip)[-2:] == pytest.approx([0.1, -0.002])
    assert (slip[-2], level[-1]) == pytest.approx((4.0, 0.7))
    assert duration[-1] == pytest.approx(1.0 / 40)


@pytest.mark.parametrize(("place", "apart"), [(2, 1), (3, 2), (4, 5)])
def test_contacts_are_made_again_after_steps_apart(place, apart):
    runs = asked("contact_again", Recording())
    whole = runs[1]  # the fresh contact; what follows goes on from the first one
    slip, level, _, _ = whole
    out = np.flatnonzero(level < 0.0)
    groups = np.split(out, np.flatnonzero(np.diff(out) > 1) + 1)
    assert len(groups[place - 2]) == apart
    first = groups[place - 2][-1] + 1
    again = slice(first, first + 32)
    assert level[again] == pytest.approx(level[:32], abs=1e-12)
    assert np.cumsum(slip[again]) == pytest.approx(np.cumsum(slip[:32]), abs=1e-12)


def test_a_contact_that_is_held_still_does_not_move():
    [(slip, level, _, _)] = asked("held_still", Recording())
    assert len(slip) == 32 + 400
    assert not slip[32:].any()
    assert np.ptp(level[32:]) == 0.0
    assert np.cumsum(slip)[31] == pytest.approx(0.3)


def test_the_load_of_friction_may_differ_from_that_of_pressure():
    runs = asked("friction_load", Recording())
    assert [len(slip) for slip, *_ in runs] == [13, 13, 13]
    for (slip, level, load, _), share in zip(runs, (0.6, 1.0, 1.5), strict=True):
        assert slip.tolist() == pytest.approx([0.0, *[0.5] * 12])
        assert level == pytest.approx(0.7)
        assert load == pytest.approx(share)


def test_the_last_step_has_less_load_than_its_mean():
    runs = asked("last_step", Recording())
    assert [float(np.sum(slip[:32])) for slip, *_ in runs] == pytest.approx([0.2, 2.0])
    for slip, level, _, _ in runs:
        assert slip[32:] == pytest.approx(0.1)
        assert level[32:].tolist() == pytest.approx([1e-6, 1e-12, 1e-32, 0.0], abs=1e-40)


def test_separation_and_pressing_alone():
    [(slip, level, _, _)] = paths("separation")
    assert level[-1] == pytest.approx(-0.3)
    assert slip[level <= 0.0].min() >= 0.5
    alone, sheared = paths("normal_load_alone")
    assert not alone[0].any()
    assert {round(level, 9) for level in alone[1][39::40]} == {1.0, 0.2, 0.6}
    assert sheared[0][39::40] == pytest.approx([0.0, 0.3, 0.3])
    assert sheared[1][39::40] == pytest.approx([0.4, 0.4, 1.0])


def test_pressing_goes_in_and_out_and_far_behind():
    law = RecordingPress()
    [(approach, rate)] = asked("presses", law)
    deepest = int(approach.argmax())
    assert approach[0] == 0.0
    assert np.all(np.diff(approach[: deepest + 1]) > 0.0)
    assert np.all(np.diff(approach[deepest + 1 :]) < 0.0)
    assert approach[1] == pytest.approx(1e-9 * approach[deepest])
    assert approach[-1] == pytest.approx(-0.5 * approach[deepest])
    assert approach[2 * deepest + 1] == 0.0
    assert np.all(rate[: deepest + 1] == 0.83)
    assert np.all(rate[deepest + 1 :] == -0.83)


def test_cycles_of_pressing_are_closed_at_the_rates_that_are_told():
    runs = asked("normal_passive", RecordingPress())
    assert len(runs) == len(RATES)
    for (approach, rate), rates in zip(runs, RATES, strict=True):
        legs = approach.reshape(len(rates), 401)
        depth = approach.max()
        knots = [0.0, 1.0, -0.2] if len(rates) == 2 else [0.0, 1.0, 0.6, 0.9, -0.2]
        assert legs[:, 0] / depth == pytest.approx(knots[:-1], abs=1e-12)
        assert legs[:, -1] / depth == pytest.approx(knots[1:], abs=1e-12)
        senses = np.sign(np.diff(knots))
        expected = 0.83 * np.array(rates) * senses
        assert rate.reshape(len(rates), 401) == pytest.approx(
            np.repeat(expected, 401).reshape(-1, 401)
        )


@pytest.mark.parametrize("name", ["contacts_unlike", "grows"])
def test_a_press_begins_at_touch_and_grows(name):
    for approach, rate in asked(name, RecordingPress()):
        assert approach[0] == 0.0
        assert approach.max() > 1e-6
        assert rate[0] > 0.0
        if name == "grows":
            assert np.all(np.diff(approach) > 0.0)
            assert np.all(rate == 0.5 * 0.83)
        else:
            assert approach[-1] == pytest.approx(0.0, abs=1e-12)
            assert rate[-1] == pytest.approx(-rate[0])
