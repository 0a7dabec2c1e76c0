"""The ways in which the kit runs a law, their bounds, and how an impact that fails is told."""

import math

import numpy as np
import pytest

import contactlab
from contactlab import Status
from contactlab.contracts import TangentialMotion
from contactlab.impact.hertz import hertz_scales
from contactlab.testing import CheckFailedError
from contactlab.testing.check import NotApplicableError, hold_success
from contactlab.testing.laws import DampedHertz, PullingHertz, SlidingForEver
from contactlab.testing.load_paths import scene
from contactlab.testing.normal import respond, strokes
from contactlab.testing.units import ODD_UNITS, Units, in_units
from contactlab.testing.ways import _which, allowed, course, meet, ways
from tests.testing.broken_laws import Sound
from tests.testing.fresh_sound import HardSphere, SlipThenRoll, Tabled
from tests.testing.test_limits import TooStiff

CHI = 1.44
SPRINGS = contactlab.create("tangential.springs")


@pytest.mark.parametrize(
    ("law", "words", "exact", "room"),
    [  # room: 2e-3 of 200 steps, 0.02 of a law's own discretisation, 1e-9 of rounding
        (Sound(), ["by Symplectic"], [False], [2e-3]),
        (SPRINGS, ["by Symplectic"], [False], [0.022]),
        (HardSphere(), ["as whole impacts"], [True], [1e-9]),
        (Tabled(), ["as whole impacts"], [False], [1e-9]),
        (SlipThenRoll(), ["by Events"], [True], [1e-9]),
    ],
    ids=lambda value: type(value).__name__,
)
def test_every_way_of_a_law(law, words, exact, room):
    listed = ways(law)
    assert [str(way) for way in listed] == words
    assert [way.exact for way in listed] == exact
    tolerance = contactlab.create("integrator.events").accuracy
    room = [tolerance] if words == ["by Events"] else room
    assert [allowed(way) for way in listed] == pytest.approx(room)
    assert all(way.normal == contactlab.create("normal.hertz") for way in listed)


def test_a_way_needs_a_normal_law_that_fits():
    assert [str(way) for way in ways(Sound(), DampedHertz())] == ["by Symplectic"]
    with pytest.raises(
        NotApplicableError, match=r"^There is no way to run it under DampedHertz\.$"
    ):
        ways(SlidingForEver(), DampedHertz())
    with pytest.raises(NotApplicableError, match=r"under PullingHertz\.$"):
        ways(SlipThenRoll(), PullingHertz())
    [way] = ways(Sound())
    assert way.integrator.steps == 200


@pytest.mark.parametrize("units", [None, ODD_UNITS])
def test_an_answer_is_in_psi_and_over_the_unit_of_energy(units):
    """A grazing impact of hard spheres: psi falls by 4 chi, the work is 4 chi (psi1 - 2 chi)."""
    [way] = ways(HardSphere())
    for psi1 in (40.0, -40.0):
        answer = meet(way, psi1, CHI, units=units)
        assert answer.change == pytest.approx(-math.copysign(4.0 * CHI, psi1), rel=1e-9)
        assert answer.work == pytest.approx(4.0 * CHI * (40.0 - 2.0 * CHI), rel=1e-9)
        assert isinstance(answer.motion, TangentialMotion)


def test_a_course_is_seen_by_steps_or_asked_of_the_law():
    [way] = ways(Sound())
    history, motion = course(way, 2.0, CHI)
    assert len(history.time) == motion.counters["steps"]
    alone = meet(way, 2.0, CHI).motion
    assert motion.slip_velocity_change == pytest.approx(alone.slip_velocity_change)
    [whole] = ways(HardSphere())
    history, motion = course(whole, 2.0, CHI)
    assert np.isnan(history.tangential_force).all()
    assert motion.slip_velocity_change == meet(whole, 2.0, CHI).motion.slip_velocity_change


def test_impacts_are_told_by_psi1_and_chi_or_by_their_shape():
    assert _which(scene(1.23456789, 1.4411764706)) == "psi1 = 1.23457, chi = 1.441"
    assert _which(scene(np.zeros((2, 3)), CHI)) == "A batch of shape (2, 3)"


GOOD, BAD, WORSE = Status.SUCCESS, Status.NON_FINITE, Status.UNRESOLVED


@pytest.mark.parametrize(
    ("status", "detail", "told"),
    [
        (BAD, "it broke", "NON_FINITE it broke"),
        ([GOOD, BAD, WORSE], ["", "first", "second"], "NON_FINITE first"),
        ([WORSE, BAD], ["first", "second"], "UNRESOLVED first"),
        ([[GOOD, GOOD], [GOOD, WORSE]], "it broke", "UNRESOLVED it broke"),
    ],
)
def test_the_first_failure_is_told(status, detail, told):
    many = isinstance(status, list)
    numbers = np.zeros(np.shape(status)) if many else 0.0
    motion = TangentialMotion(
        slip_velocity_change=numbers,
        friction_work=numbers,
        status=np.array(status, dtype=object) if many else status,
        detail=np.array(detail, dtype=object) if isinstance(detail, list) else detail,
    )
    with pytest.raises(CheckFailedError, match=f"^it: {told}!$"):
        hold_success(motion, "it: {}!")


def test_the_stiffest_impact_of_a_batch_is_told():
    """2 G* a of the stiffest ball, times the factor of the law, and the steps that it asks for."""
    law = TooStiff()
    [way] = ways(law)
    impacts = scene(np.array([2.0, 2.0]), CHI, bodies=np.array([1.0, 1.6]))
    stiffest = law.stiffness(impacts, contactlab.create("normal.hertz").motion(impacts)).max()
    with pytest.raises(CheckFailedError) as error:
        way.run(impacts)
    words = str(error.value)
    assert words.startswith(
        f"A batch of shape (2,): the stiffness that it states, {stiffest:.3g} N/m, asks for "
    )
    assert words.endswith(" steps; 20000 are the limit of a check.")


@pytest.mark.parametrize("units", [None, ODD_UNITS])
def test_a_stroke_leads_from_touch_to_the_largest_approach_and_out(units):
    given, approach, rate = strokes(units)
    scales = hertz_scales(given)
    assert len(approach) == len(rate) == 121
    assert approach[0] == 0.0
    assert rate[0] == given.normal_speed
    assert approach.max() == pytest.approx(scales.approach, rel=1e-2)
    assert approach.max() <= scales.approach
    assert approach[-1] == pytest.approx(scales.approach * math.sin(1.05 * math.pi))
    assert rate[-1] == pytest.approx(given.normal_speed * math.cos(1.05 * math.pi))
    assert np.diff(np.sign(approach)).nonzero()[0].tolist() == [0, 114]  # one touch, one end
    many, depths, speeds = strokes(bodies=np.array([[0.6, 1.0], [1.2, 1.6]]))
    assert depths.shape == speeds.shape == (121, 2, 2)
    assert depths[:, 0, 1] == pytest.approx(strokes()[1])
    assert many.shape == (2, 2)
    other, _, _ = strokes(given=given)
    assert other is given


def test_the_answers_to_a_course_are_its_contacts_in_order():
    law = PullingHertz()
    impact = scene(0.0, 1.0)
    depths, rates = np.array([1e-6, 5e-6, -1e-6]), np.zeros(3)
    answers = respond(law, impact, depths, rates)
    assert answers.shape == (4, 3)
    for place, depth in enumerate(depths.tolist()):
        contact, _ = law.respond(law.start(impact), depth, 0.0)
        assert answers[:, place].tolist() == list(contact)
    pressed = respond(DampedHertz(), impact, depths, rates)
    assert pressed[3].tolist() == pressed[0].tolist()  # the load that it leaves out


class Plain:
    """A law that attrs knows nothing of."""

    damping = 2.0


def test_a_law_without_parameters_is_the_same_in_any_units():
    plain, sound = Plain(), Sound()
    assert in_units(plain, ODD_UNITS) is plain
    assert in_units(sound, ODD_UNITS) is sound
    assert Units() == (1.0, 1.0, 1.0)
