"""The faulty laws of the kit: sound up to the step or the phase of their fault, and not after."""

import math
import pickle

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene
from contactlab.contracts import Increment, NormalContact, TangentialMotion
from contactlab.testing import faulty_laws as faulty
from contactlab.testing.check import CheckFailedError, hold_success

HERTZ = contactlab.create("normal.hertz")
SCENE = Scene.nondimensional(psi1=-2.0, chi=1.4411764706)
NORMAL = HERTZ.motion(SCENE)
LOADED = NormalContact(5.0, 0.1, 1e-3, 4.0)
STEP = Increment(0.1, 0.2, 4.0, 0.5)


@pytest.mark.parametrize(
    ("law", "step", "force", "settled"),
    [
        (faulty.FailingSpring(at=2), 1, 0.0, True),
        (faulty.FailingSpring(at=2), 2, math.nan, True),
        (faulty.FailingSpring(at=2), 3, math.nan, True),
        (faulty.UnsettledSpring(at=2), 1, 0.0, True),
        (faulty.UnsettledSpring(at=2), 2, 0.0, False),
        (faulty.UnsettledSpring(at=2), 3, 0.0, False),
    ],
)
def test_springs_fail_from_their_step_on(law, step, force, settled):
    response, state = law.advance(step - 1, STEP, LOADED, LOADED)
    assert response.force == pytest.approx(force, nan_ok=True)
    assert response.friction_work == pytest.approx(force, nan_ok=True)
    assert response.settled is settled
    assert state == step


def test_a_spring_raises_from_its_step_on():
    law = faulty.FailingSpring(at=2, raises=True)
    assert law.start(SCENE, NORMAL) == 0
    assert law.advance(0, STEP, LOADED, LOADED)[1] == 1
    for state in (1, 2):
        with pytest.raises(ArithmeticError, match="as it was asked to"):
            law.advance(state, STEP, LOADED, LOADED)
    with pytest.raises(ArithmeticError, match="as it was asked to"):
        faulty.FailingSpring(at=0, raises=True).start(SCENE, NORMAL)
    assert faulty.FailingSpring(at=0).start(SCENE, NORMAL) == 0
    assert faulty.FailingSpring() == faulty.FailingSpring(at=7, raises=False)


def test_laws_without_end_are_stopped_after_many_calls(monkeypatch):
    monkeypatch.setattr(faulty, "MOST_CALLS", 3)
    stiff = faulty.Unyielding()
    assert stiff.stiffness(SCENE, NORMAL) == 1e300
    for _ in range(3):
        assert stiff.advance(None, STEP, LOADED, LOADED) == ((0.0, 0.0, True), None)
    with pytest.raises(faulty.TooManyCallsError, match=r"The law was asked 3 times\."):
        stiff.advance(None, STEP, LOADED, LOADED)
    path = faulty.Endless().path(1.0, 1.0, NORMAL, 1e-9)
    stretches = [next(path) for _ in range(3)]
    assert {(s.start, s.stop, s.change, s.work) for s in stretches} == {(0.0, 0.0, 0.0, 0.0)}
    assert stretches[0].states(NORMAL.scaled_at(1.0)) == (0.0, 0.0)
    with pytest.raises(faulty.TooManyCallsError):
        next(path)


def test_a_spoiled_motion_is_sound_up_to_its_phase_and_nan_from_there():
    law = faulty.SpoiledHertz()
    spoiled = law.motion(SCENE)
    phases = np.array([0.5, 0.999, 1.0, 2.0])
    sound, bad = NORMAL.at(phases), spoiled.at(phases)
    for entry, expected in (
        (bad.approach, sound.approach),
        (bad.rate, sound.rate),
        (bad.load_impulse, sound.load_impulse),
        *zip(bad.contact, sound.contact, strict=True),
    ):
        assert entry[:2].tolist() == np.asarray(expected)[:2].tolist()
        assert np.isnan(entry[2:]).all()
    assert bad.time.tolist() == sound.time.tolist()
    scaled, wanted = spoiled.scaled(phases), NORMAL.scaled(phases)
    assert scaled.phase.tolist() == phases.tolist()
    for entry, expected in zip(scaled[1:], wanted[1:], strict=True):
        assert entry[:2].tolist() == np.asarray(expected)[:2].tolist()
        assert np.isnan(entry[2:]).all()
    assert spoiled.scaled_at(0.999) == NORMAL.scaled_at(0.999)
    assert spoiled.scaled_at(1.0).phase == 1.0
    assert np.isnan(spoiled.scaled_at(1.0)[1:]).all()
    assert spoiled.phase_at_rate(0.3) == NORMAL.phase_at_rate(0.3)
    assert spoiled.phase(0.3) == NORMAL.phase(0.3)
    assert spoiled.scaled_mass == NORMAL.scaled_mass
    for name in ("duration", "final_rate", "maximum_radius", "maximum_force", "maximum_approach",
                 "total_load_impulse", "scene"):  # fmt: skip
        assert getattr(spoiled, name) == getattr(NORMAL, name)
    assert law.respond(law.start(SCENE), 1e-3, 0.5) == HERTZ.respond(HERTZ.start(SCENE), 1e-3, 0.5)
    assert pickle.loads(pickle.dumps(law)) == law


def test_success_is_of_all_impacts():
    success, failure = contactlab.Status.SUCCESS, contactlab.Status.NON_FINITE
    motion = TangentialMotion.nothing((), success, "")
    hold_success(motion)
    hold_success(TangentialMotion.nothing((2,), success, ""))
    with pytest.raises(CheckFailedError, match=r"^NON_FINITE$"):
        hold_success(TangentialMotion.nothing((), failure, ""))
    status = np.array([success, failure], dtype=object)
    with pytest.raises(CheckFailedError, match=r"^NON_FINITE of one$"):
        hold_success(attrs.evolve(motion, status=status, detail="of one"))
    with pytest.raises(CheckFailedError, match=r"^None at all$"):
        hold_success(attrs.evolve(motion, status=None, detail="at all"))
