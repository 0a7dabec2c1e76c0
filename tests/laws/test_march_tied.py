"""Steps that end at the marks of a law: how many, where, and for how long each force acts."""

import math

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, Status
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse, faults
from contactlab_laws.march import tied
from contactlab_laws.march.tied import march_tied

SCENE = Scene.nondimensional(psi1=1.0, chi=1.2)
PAIR = Scene.nondimensional(psi1=np.array([1.0, 2.0]), chi=1.2)


@attrs.frozen(kw_only=True)
class Marked(SteppedTangentialLaw):
    """A law without force that has marks."""

    api_version = 2
    at: object = (0.5 * math.pi,)

    def marks(self, scene, normal):
        return None if self.at is None else np.array(self.at)

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        zero = 0.0 * increment.displacement
        return TangentialResponse(zero, zero), state


def motion(scene=SCENE):
    return Simulation().normal_motion(scene)


def divided(monkeypatch, law, count, scene=SCENE, observer=None, **options):
    """Return the steps of each march that the law's marks lead to."""
    kept, march = [], tied.march

    def noted(normal, law, steps, observer):
        kept.append(steps)
        return march(normal, law, steps, observer)

    monkeypatch.setattr(tied, "march", noted)
    found = march_tied(motion(scene), law, count, observer, **options)
    return kept, found


def shares(steps):
    """Return the instants of samples, drifts and kicks over the duration."""
    return [np.ravel(each) / motion().duration for each in (steps.time, steps.drift, steps.kick)]


def test_forces_act_from_half_way_to_half_way(monkeypatch):
    """The middle is a mark: of 6 and 4 steps; there is no force at first touch."""
    instants = np.array([0.0, *np.arange(1, 11) / 10])
    (steps,), _ = divided(monkeypatch, Marked(), 10)
    time, drift, kick = shares(steps)
    assert time == pytest.approx(instants[1:], abs=1e-9)
    stretch = kick[:-1] / 0.1
    assert stretch == pytest.approx(np.full(9, stretch[0]))
    assert stretch[0] == pytest.approx(1.0, abs=0.01)
    assert kick[-1] / stretch[0] == pytest.approx(0.05)
    assert drift / stretch[0] == pytest.approx(np.full(10, 0.1), abs=1e-9)
    load = np.ravel(steps.friction_load * steps.kick)
    edges = np.array([0.0, *np.arange(1.5, 10.0) / 10, 1.0])
    impulse = motion().at(motion().phase(edges)).load_impulse
    assert load == pytest.approx(np.diff(impulse), abs=1e-9)


@pytest.mark.parametrize(
    ("fractions", "count", "options", "parts"),
    [
        ((0.5,), 11, {}, (6, 6)),  # no longer than even steps
        ((0.5,), 1, {}, (1, 1)),
        ((0.3,), 10, {}, (3, 7)),  # rounding makes no step
        ((0.3 + 2e-7,), 10, {}, (4, 7)),
        ((0.3 + 0.5e-7,), 10, {}, (3, 7)),
        ((0.01, 0.5), 10, {}, (1, 5, 5)),  # one at least
        ((0.5,), 16, {"least": 4}, (8, 8)),
        ((0.55,), 16, {"least": 4}, (12, 8)),  # of four steps 3 and 2, each four times
        ((0.55,), 24, {"least": 4}, (16, 12)),  # of six, which is not halved: 4 and 3
        ((0.55,), 16, {"least": 9}, (9, 8)),
    ],
)
def test_numbers_of_steps_between_marks(fractions, count, options, parts, monkeypatch):
    marks = motion().phase(np.array(fractions))
    (steps,), found = divided(monkeypatch, Marked(at=marks), count, **options)
    ends = np.cumsum(parts) - 1
    assert len(steps.time) == sum(parts)
    time = shares(steps)[0]
    assert time[ends] == pytest.approx([*fractions, 1.0], abs=1e-9)
    for first, last, number in zip([-1, *ends], ends, parts, strict=False):
        even = np.diff([0.0, *time][first + 1 : last + 2])
        assert even == pytest.approx(np.full(number, even[0]), abs=1e-9)
    assert found.counters["steps"] == sum(parts)


def test_impacts_of_a_batch_with_equal_numbers_are_marched_together(monkeypatch):
    apart = motion().phase(np.array([[0.3, 0.6]]))
    kept, found = divided(monkeypatch, Marked(at=apart), 10, PAIR)
    assert [len(steps.time) for steps in kept] == [10, 10]
    assert found.status.tolist() == [Status.SUCCESS] * 2
    kept, _ = divided(monkeypatch, Marked(at=np.full((1, 2), apart[0, 0])), 10, PAIR)
    assert [steps.time.shape for steps in kept] == [(10, 2)]
    # An observer sees all impacts at once: each part has the most steps that one of them takes.
    samples = []
    kept, _ = divided(monkeypatch, Marked(at=apart), 10, PAIR, samples.append)
    assert [steps.time.shape for steps in kept] == [(13, 2)]
    assert len(samples) == 13


def test_a_law_without_marks_has_even_steps():
    assert march_tied(motion(), Marked(at=None), 10, None) is None


@pytest.mark.parametrize("at", [(0.0,), (math.pi,), (2.0, 1.0), (1.0, 1.0), (math.nan,)])
def test_marks_that_do_not_grow_are_refused(at):
    with pytest.raises(faults.LawFaultError) as told:
        march_tied(motion(), Marked(at=at), 10, None)
    assert told.value.status is Status.MALFORMED
    assert told.value.detail == "At step 1: marks that do not grow from 0 to pi, from Marked."
