"""What a law may ask beyond forces: marks, a normal motion of its own, partners, bounds, groups."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, Status
from contactlab.contracts import (
    NormalContact,
    NormalLaw,
    SampledMotion,
    SteppedTangentialLaw,
    TangentialLaw,
    TangentialResponse,
    WholeImpact,
    WholeImpactTangentialLaw,
)
from contactlab.testing.coupled_laws import Exchanging, Marked
from contactlab_laws.hertz.law import Hertz
from contactlab_laws.springs.law import Springs

CHI = 1.4412


def test_the_normal_motion_that_came_of_friction_is_that_of_the_result():
    impact = Scene.nondimensional(psi1=1.2, chi=CHI)
    result = Simulation(tangential=Exchanging(), integrator="symplectic").run(impact).check()
    assert abs(result.normal_restitution - 1.0) > 0.01
    # Hertz's law declares no dissipation, and a conservative coupling makes none.
    assert result.energy.normal_loss == pytest.approx(0.0, abs=1e-12)
    assert abs(result.energy.relative_imbalance) < 1e-4
    kinetic = 0.5 * (1.0 - result.normal_restitution**2)
    assert result.motion.exchange == pytest.approx(kinetic, rel=1e-12)
    elastic = Simulation(tangential="springs").run(impact)
    assert result.motion.maximum_force > elastic.motion.maximum_force
    assert elastic.motion.exchange == 0.0


def test_the_error_of_the_books_of_a_coupling_is_of_second_order():
    impact = Scene.nondimensional(psi1=1.2, chi=CHI)
    left = [
        Simulation(
            tangential=Exchanging(), integrator=contactlab.create("integrator.symplectic", steps=n)
        )
        .run(impact)
        .energy.relative_imbalance
        for n in (100, 200, 400)
    ]
    slope = np.polyfit(np.log([100, 200, 400]), np.log(np.abs(left)), 1)[0]
    assert slope < -1.8


def test_a_batch_of_coupled_and_central_impacts_is_its_impacts():
    psi1 = np.array([0.0, 0.6, 1.2, 0.0, 3.0])
    simulation = Simulation(tangential=Exchanging(), integrator="symplectic")
    batch = simulation.run(Scene.nondimensional(psi1=psi1, chi=CHI)).check()
    for one, psi in zip(batch, psi1, strict=True):
        alone = simulation.run(Scene.nondimensional(psi1=float(psi), chi=CHI)).check()
        assert one.normal_restitution == pytest.approx(alone.normal_restitution, rel=1e-12)
        assert one.psi2 == pytest.approx(alone.psi2, abs=1e-12)
        assert one.motion.exchange == pytest.approx(alone.motion.exchange, abs=1e-12)
        assert one.motion.duration == pytest.approx(alone.motion.duration, rel=1e-12)
    swept = simulation.sweep(Scene.nondimensional(psi1=psi1, chi=CHI), chunk=1)
    assert np.array_equal(swept.normal_restitution, batch.normal_restitution)


@attrs.frozen(kw_only=True)
class Touchy(Exchanging):
    """Raises for impacts of psi1 from 1 to 1.5, alone or in a batch."""

    def start(self, scene, normal):
        if np.any((scene.psi1 > 1.0) & (scene.psi1 < 1.5)):
            raise ArithmeticError("such an impact")
        return super().start(scene, normal)


def test_impacts_beside_one_that_fails_keep_their_normal_motions():
    psi1 = np.array([0.6, 1.2, 2.0, 3.0])
    result = Simulation(tangential=Touchy(), integrator="symplectic").run(
        Scene.nondimensional(psi1=psi1, chi=CHI)
    )
    assert list(result.failures) == [1]
    sound = Simulation(tangential=Exchanging(), integrator="symplectic")
    for index in (0, 2, 3):
        alone = sound.run(Scene.nondimensional(psi1=float(psi1[index]), chi=CHI)).check()
        assert result.normal_restitution[index] == pytest.approx(alone.normal_restitution)
        assert result.motion.duration[index] == pytest.approx(alone.motion.duration)


def test_a_history_shows_the_normal_motion_that_came_of_friction():
    impact = Scene.nondimensional(psi1=1.2, chi=CHI)
    result = Simulation(tangential=Exchanging(), integrator="symplectic").run(impact, history=True)
    history = result.history
    assert history.normal_velocity[-1] == result.motion.normal_velocity
    assert history.normal_force.max() == result.motion.maximum_force


@attrs.frozen(kw_only=True)
class Silent(Hertz):
    """Hertz's law, which declares no dissipation."""

    api_version: ClassVar[int] = 2

    def dissipation(self, motion):
        return NormalLaw.dissipation(self, motion)


def test_books_of_a_coupling_are_unknown_where_the_normal_law_declares_no_dissipation():
    simulation = Simulation(normal=Silent(), tangential=Exchanging(), integrator="symplectic")
    result = simulation.run(Scene.nondimensional(psi1=1.2, chi=CHI)).check()
    assert np.isnan(result.energy.normal_loss)
    assert np.isnan(result.energy.imbalance)
    assert Simulation(normal=Silent()).run(result.scene).energy.normal_loss == 0.0


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
class MarkedSprings(Springs):
    """Springs whose steps end where the contact meets a spring."""

    api_version: ClassVar[int] = 2

    def marks(self, scene, normal):
        place = np.arange(1, 8) / 8.0
        phases = np.linspace(0.0, np.pi, 4001)[:-1].reshape(-1, *(1,) * len(scene.shape))
        radius = np.asarray(normal.at(phases).contact.radius) / normal.maximum_radius
        radius = radius.reshape(len(radius), -1)
        columns = []
        for column in radius.T:
            top = int(column.argmax())
            line = phases.ravel()
            up = np.interp(place, column[: top + 1], line[: top + 1])
            # A viscous contact ends with a radius.
            down = np.interp(place[5:], column[top:][::-1], line[top:][::-1])
            columns.append(np.concatenate((up, down[::-1])))
        return np.array(columns).T.reshape(-1, *scene.shape)


@pytest.mark.parametrize("integrator", ["symplectic", "paper"])
def test_steps_tied_to_marks_keep_the_second_order(integrator):
    impact = Scene.nondimensional(psi1=1.2, chi=CHI)
    law = MarkedSprings(springs=400)
    psi2 = [
        Simulation(
            tangential=law, integrator=contactlab.create(f"integrator.{integrator}", steps=steps)
        )
        .run(impact)
        .check()
        .psi2
        for steps in (50, 100, 200, 3200)
    ]
    errors = np.abs(np.array(psi2[:3]) - psi2[3])
    assert np.polyfit(np.log([50, 100, 200]), np.log(errors), 1)[0] < -1.7
    unmarked = Simulation(
        tangential=Springs(springs=400),
        integrator=contactlab.create(f"integrator.{integrator}", steps=3200),
    ).run(impact)
    assert psi2[3] == pytest.approx(unmarked.psi2, abs=2e-5)


def test_adaptive_steps_end_at_marks_and_keep_the_tolerance():
    impact = Scene.nondimensional(psi1=np.array([0.5, 1.2, 2.0]), chi=CHI)
    adaptive = contactlab.create("integrator.adaptive", tolerance=1e-5)
    found = Simulation(tangential=MarkedSprings(), integrator=adaptive).run(impact).check()
    fine = Simulation(
        tangential=Springs(), integrator=contactlab.create("integrator.symplectic", steps=6400)
    )
    assert np.abs(found.psi2 - fine.run(impact).psi2).max() < 3e-5


def test_impacts_with_other_marks_are_marched_as_alone():
    damped = Simulation(
        normal=contactlab.create("normal.kuwabara_kono"),
        tangential=MarkedSprings(springs=20),
        integrator="symplectic",
    )
    ball = contactlab.Sphere(0.01, contactlab.Material.named("steel"))
    speeds = np.array([0.5, 0.5, 3.0, 6.0])
    scene = Scene(ball, ball, 0.2, speeds, 0.3 * speeds)
    batch = damped.run(scene).check()
    for index, one in enumerate(batch):
        assert one.psi2 == pytest.approx(damped.run(scene.take(index)).check().psi2, abs=1e-12)


@attrs.frozen(kw_only=True)
class Mismarked(Marked):
    """A law whose marks do not grow."""

    def marks(self, scene, normal):
        return np.array([1.0, 0.5])


def test_marks_that_do_not_grow_are_a_malformed_answer():
    simulation = Simulation(tangential=Mismarked(), integrator="symplectic")
    result = simulation.run(Scene.nondimensional(psi1=1.2, chi=CHI))
    assert result.status is Status.MALFORMED
    assert "marks" in result.motion.detail
    assert "Mismarked" in result.motion.detail


@attrs.frozen(kw_only=True)
class Plain(contactlab.contracts.Integrator):
    """An integrator that knows nothing of marks."""

    api_version: ClassVar[int] = 2
    tangential_contract: ClassVar[type] = SteppedTangentialLaw

    def integrate(self, normal, tangential, scene, observer=None):
        raise NotImplementedError


@pytest.mark.parametrize(("law", "word"), [(Marked(), "marks"), (Exchanging(), "normal_motion")])
def test_an_integrator_that_does_not_offer_it_is_refused(law, word):
    with pytest.raises(ValueError, match=f"Plain.*{word!r}.*{type(law).__name__}"):
        Simulation(tangential=law, integrator=Plain())
    assert Simulation(tangential="springs", integrator=Plain()).integrator == Plain()


@attrs.frozen(kw_only=True)
class Choosy(Hertz):
    """A normal law that goes with one spring only."""

    api_version: ClassVar[int] = 2

    def refuses(self, other):
        if isinstance(other, TangentialLaw) and not isinstance(other, Springs):
            return "its pressure is that of springs"
        return None


def test_a_law_may_refuse_a_partner():
    with pytest.raises(ValueError, match=r"Choosy.*tangential = .*Annul.*pressure is that of spri"):
        Simulation(normal=Choosy(), tangential="annulus")
    assert isinstance(Simulation(normal=Choosy(), tangential="springs").tangential, Springs)
    # The default is the first that fits, so it is not one that is refused.
    assert isinstance(Simulation(normal=Choosy()).tangential, Springs)


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


def test_a_step_tells_how_long_the_bodies_moved():
    law = Marked()
    Simulation(tangential=law, integrator="symplectic").run(
        Scene.nondimensional(psi1=1.2, chi=CHI), history=True
    ).check()
    for step, _ in law.seen:
        assert step.displacement == pytest.approx(step.velocity * step.drift, rel=1e-14)


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
