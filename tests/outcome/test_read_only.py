"""Arrays that a law, an observer or a user is given are read-only."""

import sys
from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status
from contactlab.contracts import (
    Errors,
    NormalContact,
    NormalLaw,
    SteppedTangentialLaw,
    TangentialResponse,
)
from contactlab.solve.normal_motion import normal_motion
from tests.laws.outside_laws import Tsuji

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


SPEEDS, SLIPS = (1.0, 2.0, 4.0), (0.1, 0.5, 2.0)


def scene_of(speed, slip):
    return Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.2, speed, slip)


def batch():
    """Impacts of unlike normal motions: what all share is given to laws in plain numbers."""
    return scene_of(np.array(SPEEDS), np.array(SLIPS))


PSI1 = batch().psi1.tolist()


@attrs.frozen(kw_only=True)
class Writer(SteppedTangentialLaw):
    """Writes into what it is given: ``what`` says into which of it."""

    api_version: ClassVar[int] = 2
    what: str = "velocity"

    def start(self, scene, normal):
        if self.what == "scene":
            scene.tangential_velocity[0] *= 0.5
        return

    def advance(self, state, increment, before, after):
        if self.what in ("force", "radius", "friction_load"):
            given = getattr(after, self.what)
        else:
            given = getattr(increment, self.what, 0.0)
        given *= 0.999
        return TangentialResponse(0.0 * increment.velocity, 0.0 * increment.velocity), state


@pytest.mark.parametrize("integrator", ["symplectic", "paper", "adaptive"])
@pytest.mark.parametrize("what", ["velocity", "displacement", "friction_load", "force", "radius"])
def test_a_law_that_writes_in_place_changes_nothing_of_anyone_elses(integrator, what):
    """It changed the scene, and the answer: psi1 of the result was that of the law.

    The batch is given up, and each impact tried alone: there numbers are plain, and nothing can
    be written. The answers are then those of the impacts one by one.
    """
    scene, sim = batch(), Simulation(tangential=Writer(what=what), integrator=integrator)
    result = sim.run(scene)
    assert scene.psi1.tolist() == PSI1
    assert result.scene.psi1.tolist() == PSI1
    alone = [sim.run(scene_of(*given)) for given in zip(SPEEDS, SLIPS, strict=True)]
    assert result.psi2.tolist() == [one.psi2 for one in alone]
    assert result.motion.friction_work.tolist() == [one.motion.friction_work for one in alone]
    # With a history the impacts stay together, and the law is named.
    if integrator != "adaptive":
        watched = sim.run(scene, history=True)
        assert {status.name for status in watched.status} == {"LAW_RAISED"}
        assert "Writer" in watched.failures[0]
        assert "read-only" in watched.failures[0]
        assert watched.psi1.tolist() == PSI1


@pytest.mark.parametrize("integrator", ["symplectic", "paper", "adaptive"])
def test_a_law_that_writes_into_the_scene_is_named(integrator):
    scene = batch()
    result = Simulation(tangential=Writer(what="scene"), integrator=integrator).run(scene)
    assert {status.name for status in result.status} == {"LAW_RAISED"}
    assert "Writer" in result.failures[0]
    assert scene.psi1.tolist() == PSI1


def test_a_normal_law_that_writes_in_place_is_named():
    class Presser(Tsuji):
        def respond(self, state, approach, rate):
            approach *= 0.999
            return super().respond(state, approach, rate)

    scene = attrs.evolve(batch(), normal_speed=np.array([1.0, 1.1, 1.2]))
    result = Simulation(normal=Presser(), tangential="springs").run(scene)
    assert {status.name for status in result.status} == {"LAW_RAISED"}
    assert "Presser" in result.failures[0]


def test_results_are_read_only():
    result = Simulation(tangential="springs").run(batch(), history=True).check()
    locked = [
        result.scene.tangential_velocity,
        result.motion.slip_velocity_change,
        result.motion.friction_work,
        result.motion.duration,
        result.motion.normal_velocity,
    ]
    for array in locked:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1e9
    assert result.psi1.tolist() == PSI1


def test_what_a_user_gives_is_not_what_a_scene_keeps():
    mine = np.array(PSI1)
    scene = Scene.nondimensional(psi1=mine, chi=1.44)
    mine[0] = 1e9  # is the user's own
    assert scene.psi1.tolist() == PSI1


class Own(BaseException):
    """Of a plug-in's own making."""


def bad(how):
    if how == "exit":
        sys.exit(3)
    if how == "own":
        raise Own("mine")
    if how == "generator":
        raise GeneratorExit
    if how == "interrupt":
        raise KeyboardInterrupt
    if how == "seterr":
        np.seterr(all="raise")
    return 0.0


@attrs.frozen(kw_only=True)
class Rude(SteppedTangentialLaw):
    """At one place, does what a plug-in should not."""

    api_version: ClassVar[int] = 2
    place: str = "advance"
    how: str = "exit"

    def start(self, scene, normal):
        return bad(self.how) if self.place == "start" else None

    def stiffness(self, scene, normal):
        return bad(self.how) if self.place == "stiffness" else 0.0

    def whole_impacts(self, scene, normal):
        if self.place == "whole_impacts":
            bad(self.how)
        return super().whole_impacts(scene, normal)

    def errors(self, scene, normal, steps, accuracy=None):
        return bad(self.how) if self.place == "errors" else Errors()

    def cautions(self, scene, normal):
        if self.place == "cautions":
            bad(self.how)
        return ()

    def advance(self, state, increment, before, after):
        if self.place == "advance":
            bad(self.how)
        return TangentialResponse(0.0 * increment.velocity, 0.0 * increment.velocity), state


@attrs.frozen(kw_only=True)
class RudePress(NormalLaw):
    """A spring that does it."""

    api_version: ClassVar[int] = 2
    place: str = "respond"
    how: str = "exit"

    def start(self, scene):
        return bad(self.how) if self.place == "start" else None

    def respond(self, state, approach, rate):
        if self.place == "respond":
            bad(self.how)
        return NormalContact(approach * (approach > 0.0), 0.0 * approach, approach), state


PLACES = ("start", "stiffness", "whole_impacts", "errors", "cautions", "advance")
SCENES = {"one": Scene.nondimensional(psi1=1.2, chi=1.44), "batch": batch()}


@pytest.mark.parametrize("how", ["exit", "own", "generator"])
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("integrator", ["symplectic", "adaptive"])
def test_a_plug_in_does_not_end_the_process(how, place, scene, integrator):
    if (place, integrator) == ("errors", "adaptive"):
        pytest.skip("the adaptive integrator declares nothing, and asks no law to")
    result = Simulation(tangential=Rude(place=place, how=how), integrator=integrator).run(scene)
    if place == "cautions":  # the numbers are sound without them
        assert "cautions of Rude: not known" in str(result.check())
        return
    assert np.all(np.asarray(result.status, dtype=object) == Status.LAW_RAISED)
    assert "Rude" in result.failures[0]


@pytest.mark.parametrize("how", ["exit", "own", "generator"])
@pytest.mark.parametrize("place", ["start", "respond"])
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_normal_plug_in_does_not_either(how, place, scene):
    result = Simulation(normal=RudePress(place=place, how=how), tangential="coulomb").run(scene)
    assert np.all(np.asarray(result.status, dtype=object) == Status.LAW_RAISED)
    assert "RudePress" in result.failures[0]


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_what_a_plug_in_does_to_numpy_stays_in_its_run(place, scene):
    before = np.geterr()
    try:
        rude = Simulation(tangential=Rude(place=place, how="seterr"), integrator="symplectic")
        str(rude.run(scene))
        assert np.geterr() == before
    finally:
        np.seterr(**before)


@pytest.mark.parametrize("place", ["start", "respond"])
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_what_a_normal_plug_in_does_to_numpy_stays_too(place, scene):
    before = np.geterr()
    law = RudePress(place=place, how="seterr")
    try:
        Simulation(normal=law, tangential="coulomb").run(scene)
        assert np.geterr() == before
        normal_motion(law, scene)
        assert np.geterr() == before
    finally:
        np.seterr(**before)


@pytest.mark.parametrize("place", PLACES)
def test_the_users_own_interrupt_passes(place):
    sim = Simulation(tangential=Rude(place=place, how="interrupt"), integrator="symplectic")
    with pytest.raises(KeyboardInterrupt):
        str(sim.run(SCENES["one"]))
    with pytest.raises(KeyboardInterrupt):
        Simulation(normal=RudePress(how="interrupt"), tangential="coulomb").run(SCENES["one"])
