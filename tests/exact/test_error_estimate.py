"""``run(estimate_error=True)``: an estimate of the error, for laws that declare none too."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse
from tests.outside_laws import RescaledSpring

pytestmark = pytest.mark.slow

CHI = 49.0 / 34.0
#: A dozen impacts.
PSI1 = np.array([0.1, 0.4, 0.7, 0.9, 1.2, 1.7, 2.3, 3.1, 0.5, 1.2, 2.2, 4.0])
CHIS = np.array([CHI] * 8 + [3.0] * 4)
SCENE = Scene.nondimensional(psi1=PSI1, chi=CHIS)
RESOLUTIONS = {"coarse": (60, 15), "finer": (200, 50)}
FINE = (12_000, 400)


def simulation(name, steps, parts):
    integrator = contactlab.create("integrator.symplectic", steps=steps)
    if name == "rescaled":
        return Simulation(tangential=RescaledSpring(), integrator=integrator)
    word = {"springs": "springs", "mindlin_cap": None}.get(name, "annuli")
    options = {word: parts} if word else {}
    law = contactlab.create(f"tangential.{name}", **options)
    return Simulation(tangential=law, integrator=integrator)


def true(name):
    if name in ("springs", "sharp_annulus", "annulus"):
        return Simulation().run(SCENE).check().psi2
    return simulation(name, *FINE).run(SCENE).check().psi2


LAWS = ("springs", "sharp_annulus", "annulus", "mindlin_cap", "rescaled")


def within_three(name):
    """Whether the estimate is within a factor of three of the error, over a dozen impacts twice."""
    exact, ratios = true(name), []
    for steps, parts in RESOLUTIONS.values():
        result = simulation(name, steps, parts).run(SCENE, estimate_error=True).check()
        with np.errstate(divide="ignore"):
            ratios.append(result.psi2_error_estimate / np.abs(result.psi2 - exact))
    ratio = np.concatenate(ratios)
    return (ratio > 1.0 / 3.0) & (ratio < 3.0)


def test_the_estimate_is_within_a_factor_of_three_mostly():
    """Of all, 19 of 20; of the annuli, whose error jumps with the resolution, 17 of 20."""
    shares = {name: float(within_three(name).mean()) for name in LAWS}
    assert np.mean(list(shares.values())) >= 0.95, shares
    assert min(shares.values()) >= 0.85, shares


def test_what_is_known_has_the_declared_error():
    result = Simulation(tangential="springs").run(
        Scene.nondimensional(psi1=np.array([0.0, 1.2, 9.0]), chi=CHI), estimate_error=True
    )
    assert result.psi2_error_estimate[[0, 2]].tolist() == result.plan.psi2_error[[0, 2]].tolist()
    assert 0.0 < result.psi2_error_estimate[1] < 0.01
    assert Simulation().run(Scene.nondimensional(psi1=1.2, chi=CHI)).psi2_error_estimate is None


@pytest.mark.parametrize("name", ["springs", "sharp_annulus"])
def test_where_steps_are_raised_it_is_what_was_taken_that_is_doubled(name):
    """Asked for 100, 200 or 400 steps, a heavy inertia takes 392 or 400 of them."""
    laws = {"normal": "linear", "integrator": "symplectic"}
    scene = Scene.nondimensional(psi1=0.3, chi=1e3)
    result = Simulation(tangential=name, **laws).run(scene, estimate_error=True).check()
    law = contactlab.create(f"tangential.{name}")
    fine = Simulation(
        normal="linear",
        tangential=attrs.evolve(law, **{law.resolution: 1000}),
        integrator=contactlab.create("integrator.symplectic", steps=6000),
    )
    error = abs(result.psi2 - fine.run(scene).check().psi2)
    assert error > 0.1
    assert error / 3.0 < result.psi2_error_estimate < 3.0 * error


def test_a_batch_is_estimated_as_its_impacts_are_alone():
    laws = {"tangential": "springs", "integrator": "symplectic"}
    scene = Scene.nondimensional(psi1=np.array([0.3, 1.2, 9.0, 0.3]), chi=np.array([1e3, 1, 1, 50]))
    together = Simulation(**laws).run(scene, estimate_error=True).psi2_error_estimate
    alone = [Simulation(**laws).run(one, estimate_error=True) for one in map(scene.take, range(4))]
    assert together == pytest.approx([one.psi2_error_estimate for one in alone], rel=1e-6)


def test_of_an_integrator_with_a_tolerance_the_law_alone_is_refined():
    """Annuli of a heavy inertia on an adhesive contact are off by a fifth of the range."""
    laws = {"normal": "jkr", "tangential": "sharp_annulus", "integrator": "adaptive"}
    scene = Scene.nondimensional(psi1=0.3, chi=1e3)
    result = Simulation(**laws).run(scene, estimate_error=True).check()
    springs = contactlab.create("tangential.springs", springs=400)
    steps = contactlab.create("integrator.symplectic", steps=12_800)
    fine = Simulation(normal="jkr", tangential=springs, integrator=steps).run(scene).check()
    error = abs(result.psi2 - fine.psi2)
    assert error > 0.1
    assert error / 3.0 < result.psi2_error_estimate < 3.0 * error


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
        off = {25: 0.0, 50: 0.4, 100: 0.3 if self.turns else 0.5}[self.parts]
        force = (0.5 + 0.1 * off) * state * increment.friction_load
        return TangentialResponse(force, force * increment.displacement), state


def test_answers_that_turn_back_show_no_order():
    """Changes of 4 and then of -1 leave twice the last; of 4 and then of 1, four thirds of it."""
    scene = Scene.nondimensional(psi1=5.0, chi=1.0)
    left = {}
    for turns in (True, False):
        sim = Simulation(tangential=Wanders(turns=turns), integrator="symplectic")
        left[turns] = sim.run(scene, estimate_error=True).check().psi2_error_estimate
    assert left[True] == pytest.approx(1.5 * left[False], rel=1e-6)
