"""Steps that end at the marks of a law: how many, where, and for how long each force acts."""

import math

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, Status
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse, faults
from contactlab_laws.march.tied import march_tied

SCENE = Scene.nondimensional(psi1=1.0, chi=1.2)
PAIR = Scene.nondimensional(psi1=np.array([1.0, 2.0]), chi=1.2)


@attrs.frozen(kw_only=True)
class Marked(SteppedTangentialLaw):
    """A law of one force that has marks."""

    api_version = 2
    at: object = (0.5 * math.pi,)
    force: float = 0.0

    def marks(self, scene, normal):
        return None if self.at is None else np.array(self.at)

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        zero = 0.0 * increment.displacement
        return TangentialResponse(self.force + zero, zero), state


def motion(scene=SCENE):
    return Simulation().normal_motion(scene)


@pytest.mark.parametrize(
    ("fractions", "count", "parts"),
    [
        ((0.5,), 10, (5, 5)),
        ((0.5,), 11, (6, 6)),  # no longer than even steps
        ((0.3,), 10, (3, 7)),  # rounding makes no step
        ((0.3 + 2e-7,), 10, (4, 7)),
        ((0.01, 0.5), 10, (1, 5, 5)),  # one at least
    ],
)
def test_steps_end_at_marks_and_are_even_between_them(fractions, count, parts):
    marks, samples = motion().phase(np.array(fractions)), []
    found = march_tied(motion(), Marked(at=marks), count, samples.append)
    assert found.counters["steps"] == sum(parts)
    time = np.array([0.0, *(sample.time for sample in samples)]) / motion().duration
    ends = [0.0, *fractions, 1.0]
    even = [np.linspace(*each, n + 1)[1:] for *each, n in zip(ends, ends[1:], parts, strict=False)]
    assert time[1:] == pytest.approx(np.concatenate(even), abs=1e-9)


def test_impacts_of_a_batch_are_those_alone_whatever_their_marks():
    """A constant force: the load between the middles of the steps takes all of the momentum."""
    apart = motion().phase(np.array([[0.3, 0.6]]))
    found = march_tied(motion(PAIR), Marked(at=apart, force=1e-3), 10, None)
    assert found.status.tolist() == [Status.SUCCESS] * 2
    for item in range(2):
        scene = Scene.nondimensional(psi1=float(PAIR.psi1[item]), chi=1.2)
        alone = march_tied(motion(scene), Marked(at=apart[:, item], force=1e-3), 10, None)
        change = alone.slip_velocity_change
        assert found.slip_velocity_change[item] == pytest.approx(change, rel=1e-12)
        impulse = 1e-3 * motion(scene).duration / scene.pair.tangential_mass
        assert -change == pytest.approx(impulse, rel=0.06)  # no force at first touch


def test_a_law_without_marks_has_even_steps():
    assert march_tied(motion(), Marked(at=None), 10, None) is None


@pytest.mark.parametrize("at", [(0.0,), (math.pi,), (2.0, 1.0), (1.0, 1.0), (math.nan,)])
def test_marks_that_do_not_grow_are_refused(at):
    with pytest.raises(faults.LawFaultError) as told:
        march_tied(motion(), Marked(at=at), 10, None)
    assert told.value.status is Status.MALFORMED
    assert "marks" in told.value.detail
