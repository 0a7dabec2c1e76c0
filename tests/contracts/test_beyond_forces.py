"""What a law may ask beyond forces: a normal motion of its own, partners, bounds, scenes."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, Status
from contactlab.contracts import (
    NormalContact,
    SampledMotion,
    SteppedTangentialLaw,
    TangentialResponse,
    WholeImpact,
    WholeImpactTangentialLaw,
)
from contactlab_laws.springs.law import Springs

CHI = 1.4412


@attrs.frozen(kw_only=True)
class Softened(WholeImpactTangentialLaw):
    """No force, and a normal motion that keeps 0.9 of the speed; fast impacts keep all of it."""

    api_version: ClassVar[int] = 2
    rate: ClassVar[float] = 0.9

    def whole_impacts(self, scene, normal):
        one = np.ones((1, *scene.shape))
        motion = SampledMotion(
            normal.law, scene, time=2.0 * one, approach=0.0 * one, rate=-self.rate * one,
            contact=NormalContact(0.0 * one, 0.0 * one, 0.0 * one),
        )  # fmt: skip
        slow = np.abs(scene.slip_velocity) < 2.0
        answer = {"slip_velocity_change": 0.0, "friction_work": 0.0, "reason": "a test"}
        return WholeImpact(where=slow, normal=motion, **answer), WholeImpact(where=True, **answer)


@attrs.frozen(kw_only=True)
class Hastened(Softened):
    """A normal motion that ends with 1.3 of the speed."""

    rate: ClassVar[float] = 1.3


def test_bodies_that_gain_energy_from_a_coupling_are_told():
    scenes = Scene.nondimensional(psi1=np.array([1.0, 3.0]), chi=CHI)
    result = Simulation(tangential=Hastened()).run(scenes)
    assert list(result.status) == [Status.UNBALANCED, Status.SUCCESS]
    # 1.3² of the normal energy, 1/2, beside that of slip, 1/2 M_t = 1/(4 chi), which stays
    slip = 0.25 / CHI
    gain = (0.5 * 1.3**2 + slip) / (0.5 + slip) - 1.0
    assert f"The bodies gain {gain:.2g} of" in result.failures[0]


def test_a_whole_impact_answer_may_have_a_normal_motion():
    simulation = Simulation(tangential=Softened())
    batch = simulation.run(Scene.nondimensional(psi1=np.array([1.0, 3.0]), chi=CHI))
    assert batch.normal_restitution == pytest.approx([0.9, 1.0])
    alone = simulation.run(Scene.nondimensional(psi1=1.0, chi=CHI))
    assert alone.normal_restitution == pytest.approx(0.9)
    assert alone.motion.duration == 2.0
    # Nothing lost the energy: the books do not close.
    assert alone.energy.imbalance == pytest.approx(0.5 * (1.0 - 0.9**2))


@attrs.frozen(kw_only=True)
class Drawn(SteppedTangentialLaw):
    """Makes energy; its books may miss by a tenth up to psi1 = 2, and by nothing beyond."""

    api_version: ClassVar[int] = 2

    def books_bound(self, scene):
        return np.where(np.asarray(scene.psi1) <= 2.0, 0.1, 0.0)

    def start(self, scene, normal):
        return scene.friction_coefficient

    def advance(self, state, increment, before, after):
        return TangentialResponse(-0.01 * state * increment.friction_load, 0.0), state


def test_the_bound_of_the_books_may_depend_on_the_scene():
    simulation = Simulation(tangential=Drawn(), integrator="symplectic")
    batch = simulation.run(Scene.nondimensional(psi1=np.array([1.0, 3.0]), chi=CHI))
    assert list(batch.status) == [Status.SUCCESS, Status.UNBALANCED]
    assert "declared: 0." in batch.failures[1]
    assert simulation.run(Scene.nondimensional(psi1=1.0, chi=CHI)).status is Status.SUCCESS


@attrs.frozen(kw_only=True)
class TwoWay(Springs):
    """A law that needs mu itself."""

    api_version: ClassVar[int] = 2

    def accept(self, scene):
        if scene.unit_friction and np.any(scene.pair.dundurs_beta):
            raise ValueError("friction_coefficient = None: is needed by a coupling both ways")


def test_a_law_may_refuse_a_scene():
    simulation = Simulation(tangential=TwoWay())
    plain = Scene.nondimensional(psi1=1.2, chi=CHI)
    coupled = Scene.nondimensional(psi1=1.2, chi=CHI, coupling_number=0.5)
    known = Scene.nondimensional(psi1=1.2, chi=CHI, coupling_number=0.5, friction_coefficient=1.0)
    assert simulation.run(plain).status
    assert simulation.run(known).status
    for refused in (simulation.run, simulation.plan):
        with pytest.raises(ValueError, match="friction_coefficient"):
            refused(coupled)
    with pytest.raises(ValueError, match="friction_coefficient"):
        simulation.sweep(Scene.stack([coupled, coupled]))
    with pytest.raises(ValueError, match="friction_coefficient"):
        simulation.run(attrs.evolve(coupled, tangential_velocity=0.1))
