"""``run(estimate_error=True)``: which laws are made finer, and what becomes of the answers."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, Status
from contactlab.contracts import NormalLaw, SteppedTangentialLaw, TangentialResponse
from contactlab.numeric.checks import count
from tests.laws.outside_laws import Walton

CHI = 49.0 / 34.0


@attrs.frozen(kw_only=True)
class Tight(type(contactlab.create("integrator.adaptive"))):
    """The adaptive integrator, for which no tolerance below 1e-3 can be kept."""

    api_version: ClassVar[int] = 2

    def integrate(self, scene, normal, tangential, observer=None):
        motion = super().integrate(scene, normal, tangential, observer)
        sentence = "The tolerance is not kept."
        return motion.failing(
            np.full(scene.shape, self.tolerance < 1e-3), Status.UNRESOLVED, sentence
        )


def test_no_estimate_is_less_than_rounding():
    scene = Scene.nondimensional(psi1=[0.3, 1.2, 2.0], chi=CHI)
    result = Simulation().run(scene, estimate_error=True).check()
    assert (result.psi2_error_estimate >= 1e-12).all()
    assert (result.psi2_error_estimate <= result.plan.psi2_error).all()


def test_what_is_known_has_the_declared_error():
    result = Simulation(tangential="springs").run(
        Scene.nondimensional(psi1=np.array([0.0, 1.2, 9.0]), chi=CHI), estimate_error=True
    )
    assert result.psi2_error_estimate[[0, 2]].tolist() == result.plan.psi2_error[[0, 2]].tolist()
    assert 0.0 < result.psi2_error_estimate[1] < 0.01
    assert Simulation().run(Scene.nondimensional(psi1=1.2, chi=CHI)).psi2_error_estimate is None


def test_where_steps_are_raised_it_is_what_was_taken_that_is_doubled():
    """Asked for 100, 200 or 400 steps, a heavy inertia takes 392 or 400 of them."""
    laws = {
        "normal": "linear",
        "tangential": contactlab.create("tangential.springs", springs=50),
        "integrator": contactlab.create("integrator.symplectic", steps=200),
    }
    scene = Scene.nondimensional(psi1=0.3, chi=1e3)
    result = Simulation(**laws).run(scene, estimate_error=True).check()
    fine = Simulation(
        normal="linear",
        tangential=contactlab.create("tangential.springs", springs=1000),
        integrator=contactlab.create("integrator.symplectic", steps=6000),
    )
    error = abs(result.psi2 - fine.run(scene).check().psi2)
    assert error > 0.1
    assert error / 3.0 < result.psi2_error_estimate < 3.0 * error


@pytest.mark.slow
def test_a_batch_is_estimated_as_its_impacts_are_alone():
    laws = {"tangential": "springs", "integrator": "symplectic"}
    scene = Scene.nondimensional(psi1=np.array([0.3, 1.2, 9.0, 0.3]), chi=np.array([1e3, 1, 1, 50]))
    together = Simulation(**laws).run(scene, estimate_error=True).psi2_error_estimate
    alone = [Simulation(**laws).run(one, estimate_error=True) for one in map(scene.take, range(4))]
    assert together == pytest.approx([one.psi2_error_estimate for one in alone], rel=1e-6)


@pytest.mark.slow
def test_of_an_integrator_with_a_tolerance_the_law_is_refined_too():
    """Few springs on a damped contact, beside many."""
    scene = Scene.nondimensional(psi1=1.2, chi=3.0)
    law = contactlab.create("tangential.springs", springs=6)
    simulation = Simulation(normal="hunt_crossley", tangential=law, integrator="adaptive")
    result = simulation.run(scene, estimate_error=True).check()
    many = contactlab.create("tangential.springs", springs=400)
    steps = contactlab.create("integrator.symplectic", steps=1600)
    fine = attrs.evolve(simulation, tangential=many, integrator=steps).run(scene).check()
    error = abs(result.psi2 - fine.psi2)
    assert error > 1e-3
    assert error / 3.0 < result.psi2_error_estimate < 3.0 * error


@pytest.mark.slow
def test_where_a_tolerance_cannot_be_tightened_the_law_alone_is_refined():
    """The annuli at least are seen; a stepped law that jumps may need millions of steps."""
    tight = Tight(tolerance=1e-2)
    law = contactlab.create("tangential.annulus", annuli=1)
    scene = Scene.nondimensional(psi1=[1.2, 2.0], chi=CHI)
    result = Simulation(tangential=law, integrator=tight).run(scene, estimate_error=True).check()
    error = np.abs(result.psi2 - Simulation().run(scene).psi2)
    assert (error > 0.1).all()
    assert (result.psi2_error_estimate > error / 3.0).all()
    assert (result.psi2_error_estimate < 3.0 * error).all()


@attrs.frozen(kw_only=True)
class Leaks(NormalLaw):
    """Hertz's law with a dashpot that vanishes as ``parts`` grow."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius", "hertzian_pressure"})
    resolution: ClassVar[str] = "parts"
    parts: int = 10

    def start(self, scene):
        return contactlab.create("normal.hertz").start(scene)

    def respond(self, state, approach, rate):
        contact, state = contactlab.create("normal.hertz").respond(state, approach, rate)
        return contact._replace(force=contact.force * (1.0 + 0.5 / self.parts * rate)), state


@pytest.mark.parametrize("tangential", ["coulomb", "springs"])
def test_a_normal_law_with_a_resolution_is_refined(tangential):
    """Gross slip ends at psi1 - 2 chi (1 + e), whether the impact is marched or known."""
    scene = Scene.nondimensional(psi1=20.0, chi=CHI)
    result = Simulation(normal=Leaks(), tangential=tangential).run(scene, estimate_error=True)
    error = 2.0 * CHI * (1.0 - result.normal_restitution)
    assert abs(result.psi2 - (20.0 - 4.0 * CHI)) == pytest.approx(error, rel=1e-3)
    assert error > 0.01
    assert result.psi2_error_estimate == pytest.approx(error, rel=0.2)


@attrs.frozen(kw_only=True)
class Terms(Walton):
    """A whole impact by a series: each doubling of its terms halves the error."""

    api_version: ClassVar[int] = 2
    resolution: ClassVar[str] = "terms"
    terms: int = 5

    def whole_impacts(self, scene, normal):
        *known, answer = super().whole_impacts(scene, normal)
        change = (1.0 - 0.1 / self.terms) * answer.slip_velocity_change
        return (*known, attrs.evolve(answer, slip_velocity_change=change))


def test_a_law_of_whole_impacts_with_a_resolution_is_refined():
    """Of impacts in a batch too; the central one is known exactly, and keeps what is declared."""
    scene = Scene.nondimensional(psi1=[0.0, 2.0, 20.0], chi=CHI)
    result = Simulation(tangential=Terms()).run(scene, estimate_error=True).check()
    error = np.abs(result.psi2 - Simulation(tangential=Walton()).run(scene).psi2)
    assert error[1:].min() > 0.01
    assert result.psi2_error_estimate[1:] == pytest.approx(error[1:], rel=0.1)
    assert result.psi2_error_estimate[0] == result.plan.psi2_error[0] > 0.0


@attrs.frozen(kw_only=True)
class Limited(Terms):
    """A series that is known up to 12 terms."""

    terms: int = count(default=5, most=12)


def test_where_a_law_allows_no_finer_resolution_there_is_no_estimate():
    scene = Scene.nondimensional(psi1=2.0, chi=CHI)
    result = Simulation(tangential=Limited()).run(scene, estimate_error=True).check()
    assert np.isnan(result.psi2_error_estimate)
    assert "no estimate" in str(result)


@attrs.frozen(kw_only=True)
class Wanders(SteppedTangentialLaw):
    """Brakes by about half of what friction could; how much more depends on its parts."""

    api_version: ClassVar[int] = 2
    resolution: ClassVar[str] = "parts"
    parts: int = 50
    turns: bool = True

    def start(self, scene, normal):
        return scene.friction_coefficient

    def advance(self, state, increment, before, after):
        off = {50: 0.4, 100: 0.3 if self.turns else 0.0, 200: 0.0 if self.turns else -0.1}
        force = (0.5 + 0.1 * off[self.parts]) * state * increment.friction_load
        return TangentialResponse(force, force * increment.displacement), state


@pytest.mark.parametrize(("turns", "units"), [(True, 0.4 + 0.15), (False, 0.5 + 0.05)])
def test_the_estimate_is_the_distance_and_half_the_last_change(turns, units):
    """In units of the force by which the answers differ; gross slip changes psi by 4 chi."""
    scene = Scene.nondimensional(psi1=5.0, chi=1.0)
    simulation = Simulation(tangential=Wanders(turns=turns), integrator="symplectic")
    found = simulation.run(scene, estimate_error=True).check().psi2_error_estimate
    assert found == pytest.approx(0.1 * units * 4.0, rel=1e-3)
