"""A law that hangs or crawls is told so: which check, after how long, and where it was."""

import time
from typing import ClassVar

import attrs
import pytest

from contactlab.testing import CheckFailedError, Verdict, checks_for, examine, limits
from tests.longer import longer
from tests.testing.fresh_sound import HardSphere, Press, Slider
from tests.testing.made import checked

#: Seconds that a check may take here: enough for any that does not hang.
SECONDS = 0.5
#: The same where nothing is asserted of the place, so that no check need get anywhere.
BRIEFLY = 0.1


class Hangs(Slider):
    """Searches for ever where the contact is deep."""

    def advance(self, state, increment, before, after):
        while after.friction_load > 1.0:
            pass
        return super().advance(state, increment, before, after)


class Sleeps(HardSphere):
    """Waits for something that never comes."""

    def friction(self, scene):
        time.sleep(1e6)
        return 0.3


class SwallowsEverything(Press):
    """Tries again, whatever is raised."""

    def dashpot(self, damping, rate):
        tried = 0
        while tried < 2:
            try:
                while True:
                    pass
            except BaseException:
                tried += 1
        raise RuntimeError("given up")


@attrs.frozen(kw_only=True)
class TooStiff(Slider):
    """States a stiffness that asks for 10 million steps."""

    factor: ClassVar[float] = 1e12

    def stiffness(self, scene, normal):
        return self.factor * super().stiffness(scene, normal)


@pytest.fixture(autouse=True)
def _looks_often(monkeypatch):
    """The clock is looked at often, and who waits is stopped after a second."""
    monkeypatch.setattr(limits, "AGAIN", 0.1)
    monkeypatch.setattr(limits, "WAITING", 2.0)


@pytest.mark.parametrize(
    ("law", "name", "words"),
    [
        (Hangs(), "odd_in_slip", "in a path of 192 steps at step 1, in Hangs.advance, line "),
        *longer(
            (
                Hangs(),
                "impact_odd",
                "in an impact, psi1 = 0.01, chi = 0.4 (Hangs by Symplectic), in Hangs.",
            )
        ),
        (Sleeps(), "impact_odd", "in an impact, psi1 = 0.01, chi = 0.4 (as whole impacts), in Sle"),
        (Press(), "contacts", ""),
    ],
    ids=["path", "march", "sleep", "sound"],
)
def test_a_law_that_hangs_is_told_check_time_and_place(law, name, words):
    found = checked(law, name, seconds=SECONDS if words else limits.SECONDS)
    assert found.out_of_time == bool(words)
    if words:
        assert found.verdict is Verdict.FAILED
        assert found.sentence.startswith(f"The check {name} was stopped after ")
        assert words in found.sentence
        assert found.sentence.endswith("the law hangs, or crawls.")


def test_a_check_that_is_stopped_fails_and_does_not_end_the_process():
    check = next(check for check in checks_for(Sleeps()) if check.name == "impact_odd")
    with pytest.raises(CheckFailedError, match="check impact_odd was stopped after"):
        check(Sleeps(), seconds=BRIEFLY)


def test_a_law_that_swallows_the_interruption_is_interrupted_again():
    found = checked(SwallowsEverything(), "grows", seconds=BRIEFLY)
    assert found.verdict is Verdict.FAILED


def test_a_law_that_asks_for_too_many_steps_is_told_how_many():
    found = checked(TooStiff(), "impact_odd")
    assert found.verdict is Verdict.FAILED
    assert "psi1 = 0.01, chi = 0.4: the stiffness that it states, " in found.sentence
    assert "steps; 20000 are the limit of a check." in found.sentence


def test_after_three_checks_out_of_time_the_others_are_not_tried():
    found = examine(Hangs(), seconds=BRIEFLY)
    assert sum(one.out_of_time for one in found) == limits.MOST_TIMEOUTS
    left = [one for one in found if one.sentence.startswith("Not tried: 3 checks before it ran")]
    assert len(left) > 20
    assert all(one.verdict is Verdict.FAILED for one in left)


def test_what_runs_after_a_check_is_not_interrupted():
    checked(Slider(), "opposes_slip", seconds=BRIEFLY)
    time.sleep(1.5 * BRIEFLY)
