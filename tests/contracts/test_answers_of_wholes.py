"""Whole-impact answers in closed form: slip, no force, a change of psi; and what laws say first."""

import math
from types import SimpleNamespace
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene
from contactlab.contracts import TangentialLaw, from_change, no_force, sliding
from contactlab.testing.load_paths import scene

HERTZ = contactlab.create("normal.hertz")
PSI1 = [-40.0, -2.0, 0.0, 2.0, 40.0]
CHI = 1.44


def batch():
    return scene(np.array(PSI1), CHI)


def slid(impact, *, stops):
    normal = HERTZ.motion(impact)
    return sliding(impact, normal, where=True, reason="slides", stops=stops), normal


@pytest.mark.parametrize("psi1", PSI1)
@pytest.mark.parametrize("stops", [True, False])
def test_slip_takes_mu_times_the_impulse_until_it_stops(psi1, stops):
    """2 mu v1 M_n/M_t, or all of v_x; work is mu J times the mean velocity."""
    impact = scene(psi1, CHI)
    answer, normal = slid(impact, stops=stops)
    mass, slip = impact.pair.tangential_mass, impact.slip_velocity
    gross = 2.0 * 0.3 * 0.83 * impact.pair.normal_mass / mass
    lost = min(gross, abs(slip)) if stops else gross
    change = -math.copysign(lost, psi1) if psi1 else 0.0
    assert answer.slip_velocity_change == pytest.approx(change, rel=1e-9, abs=1e-300)
    work = -mass * change * (slip + 0.5 * change)
    if psi1 or stops:
        assert answer.friction_work == pytest.approx(work, rel=1e-9, abs=1e-12)
    assert (answer.where, answer.reason, answer.psi2_error) == (True, "slides", 0.0)
    stopped = stops and abs(slip) <= gross
    if stopped:
        assert slip + answer.slip_velocity_change == 0.0
    half = 0.5 * normal.total_load_impulse
    so_far, force = answer.course(half, 7.0)
    early = min(0.5 * gross, abs(slip)) if stops else 0.5 * gross
    sense = np.sign(psi1)
    assert so_far == pytest.approx(-sense * early, rel=1e-9)
    acts = not stops or 0.5 * gross < abs(slip)
    assert force == pytest.approx(sense * 0.3 * 7.0 * acts, rel=1e-12)


@pytest.mark.parametrize("stops", [True, False])
def test_slip_of_a_batch_is_that_of_its_impacts(stops):
    impacts = batch()
    answer, normal = slid(impacts, stops=stops)
    change, force = answer.course(0.3 * normal.total_load_impulse, 7.0)
    for index in range(len(PSI1)):
        alone, motion = slid(impacts.take(index), stops=stops)
        assert type(alone.slip_velocity_change) is float
        assert answer.slip_velocity_change[index] == alone.slip_velocity_change
        assert answer.friction_work[index] == pytest.approx(alone.friction_work, rel=1e-15)
        one, pull = alone.course(0.3 * motion.total_load_impulse, 7.0)
        assert (change[index], force[index]) == pytest.approx((one, pull), rel=1e-15)


@pytest.mark.parametrize("impact", [scene(2.0, CHI), batch()], ids=["one", "batch"])
def test_an_impulse_that_is_no_number_gives_no_answer(impact):
    spoiled = SimpleNamespace(total_load_impulse=math.nan)
    answer = sliding(impact, spoiled, where=True, reason="", stops=True)
    assert np.isnan(answer.slip_velocity_change).all()
    assert np.isnan(answer.friction_work).all()


def test_no_force_is_no_change_along_the_whole_course():
    impacts = batch()
    answer = no_force(impacts, where=True, reason="smooth")
    assert (answer.slip_velocity_change, answer.friction_work, answer.psi2_error) == (0.0, 0.0, 0.0)
    assert (answer.where, answer.reason) == (True, "smooth")
    change, force = answer.course(np.ones((3, 1)), 2.0)
    assert change.shape == force.shape == (3, 5)
    assert not change.any()
    assert not force.any()


def test_a_change_of_psi_is_one_of_velocity_and_of_energy():
    impact = scene(2.0, CHI)
    unit = 0.3 * 0.83 / impact.pair.stiffness_ratio
    mass = impact.pair.tangential_mass

    def told(change):
        return from_change(
            impact, where=True, psi_change=change, psi2_error=1e-7, reason="known", counter="read"
        )

    answer = told(-1.5)
    assert answer.slip_velocity_change == pytest.approx(-1.5 * unit)
    kinetic = 0.5 * mass * unit**2 * (2.0**2 - 0.5**2)
    assert answer.friction_work == pytest.approx(kinetic)
    assert (answer.reason, answer.psi2_error, answer.counter) == ("known", 1e-7, "read")
    assert answer.balanced
    assert told(0.5).friction_work == 0.0  # faster than before: no work is negative
    assert (
        from_change(impact, where=True, psi_change=0.0, psi2_error=0.0, reason="").counter is None
    )
    many = from_change(
        batch(), where=True, psi_change=np.array([1.5, 1.5, 0.5, -1.5, -1.5]), psi2_error=0.0,
        reason="",
    )  # fmt: skip
    assert many.friction_work[3] == pytest.approx(kinetic)
    assert many.friction_work[1] == pytest.approx(kinetic)
    assert many.friction_work[2] == 0.0
    assert np.all(many.slip_velocity_change / unit == pytest.approx([1.5, 1.5, 0.5, -1.5, -1.5]))


@attrs.frozen(kw_only=True)
class Bare(TangentialLaw):
    """A law that states nothing."""

    api_version: ClassVar[int] = 2


def reasons(impact):
    answers = Bare().whole_impacts(impact, HERTZ.motion(impact))
    return [(np.asarray(answer.where).tolist(), answer.reason) for answer in answers]


CENTRAL, SMOOTH = "central impact, no slip velocity", "friction coefficient 0"


def test_a_central_impact_and_one_without_friction_are_answered_by_every_law():
    assert reasons(scene(2.0, CHI)) == []
    assert reasons(scene(0.0, CHI)) == [(True, CENTRAL)]
    still = Scene(None, None, 0.0, 0.83, 0.5, pair=scene(2.0, CHI).pair)
    assert reasons(still) == [(True, SMOOTH)]
    assert reasons(batch()) == [([False, False, True, False, False], CENTRAL)]
    mu = np.array([0.0, 0.3])
    mixed = Scene(None, None, mu, 0.83, 0.5, pair=scene(2.0, CHI).pair)
    assert reasons(mixed) == [([True, False], SMOOTH)]
