"""No silent wrong answer: steps, energy books, limits."""

import itertools
import pickle
import re
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import ImpactError, Scene, Simulation, Status
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse, resolution_of
from contactlab.impact.hertz import hertz_scales
from tests.laws.normal_laws import LinearSpring, in_si
from tests.longer import longer
from tests.solve.spoiled import SpoiledMotion

HERTZ = contactlab.registry.registry.REGISTRY.law_class("normal.hertz")


def annulus(integrator, **options):
    return Simulation(
        tangential=contactlab.create("tangential.annulus", annuli=20),
        integrator=contactlab.create(f"integrator.{integrator}", **options),
    )


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
def test_too_few_steps_are_raised_and_the_plan_says_so(integrator):
    """Five steps at chi = 30: psi2 would be off by more than 1 (theory §4)."""
    scene = Scene.nondimensional(psi1=1.2, chi=30.0)
    sim = annulus(integrator, steps=5)
    assert "steps raised from 5 to 75" in str(sim.plan(scene))  # 63 would do; see RAISE
    result = sim.run(scene).check()
    assert result.counters["steps"] >= 63
    fine = annulus(integrator, steps=2000).run(scene)
    assert result.psi2 == pytest.approx(fine.psi2, abs=0.25)


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
@pytest.mark.parametrize("refine", [True, False])
def test_a_stiff_impact_costs_no_other_of_its_batch_anything(integrator, refine):
    sim = annulus(integrator, steps=50, refine=refine)
    chi = np.array([[1.4, 300.0], [30.0, 3000.0]])
    batch = sim.run(Scene.nondimensional(psi1=1.2, chi=chi))
    alone = [sim.run(Scene.nondimensional(psi1=1.2, chi=value)) for value in chi.ravel().tolist()]
    assert batch.status.ravel().tolist() == [one.status for one in alone]
    assert batch.motion.detail.ravel().tolist() == [one.motion.detail for one in alone]
    assert batch.psi2.ravel() == pytest.approx([one.psi2 for one in alone], abs=1e-12, nan_ok=True)
    said = r"raised from 50 to \d+ for 3 of 4" if refine else "50 steps are too few for 3 of 4"
    assert re.search(said, str(sim.plan(batch.scene)))


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
def test_too_few_steps_are_refused_with_the_number_needed(integrator):
    sim = annulus(integrator, steps=5, refine=False)
    result = sim.run(Scene.nondimensional(psi1=1.2, chi=30.0))
    assert result.status is Status.TOO_FEW_STEPS
    assert "at least 63" in result.motion.detail
    assert np.isnan(result.psi2)


def test_the_limit_follows_the_law_and_the_scene():
    """omega = sqrt(3.75 chi) in scaled time: N >= 2.94 sqrt(3.75 chi)/0.5.

    A rigid law has no stiffness: the half oscillation of the normal motion remains, N >= 2 pi.
    """
    scene = Scene.nondimensional(psi1=1.2, chi=100.0)
    assert "raised" not in str(annulus("symplectic", steps=114).plan(scene))
    assert "raised from 113 to 142" in str(annulus("symplectic", steps=113).plan(scene))
    rigid = Simulation(
        tangential="coulomb", integrator=contactlab.create("integrator.paper", steps=7)
    )
    assert "raised" not in str(rigid.plan(scene))
    assert "too few" not in str(rigid.plan(scene))


def test_without_partial_slip_steps_must_keep_the_phase():
    """(omega t)³/(24 N²) <= 0.05: omega t = 2.9433 sqrt(3.75 chi) = 57.0 at chi = 100, N >= 393.

    Where slip damps the oscillation, the lead of phase is forgotten: N >= 114 is enough there.
    """
    scene = Scene.nondimensional(psi1=1.2, chi=100.0)
    for steps, cautions in ((393, 0), (392, 1)):
        ringing = Simulation(
            tangential="mindlin_cap",
            integrator=contactlab.create("integrator.symplectic", steps=steps, refine=False),
        )
        said = [caution for caution in ringing.plan(scene).cautions if "steps" in caution.words]
        assert len(said) == cautions
        assert (ringing.run(scene).status is Status.SUCCESS) is (not cautions)


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
def test_the_normal_motion_takes_no_steps(integrator):
    """In one explicit step a rigid sphere would rebound 18 times as fast as it came."""
    scene = Scene.nondimensional(psi1=1.2, chi=1.44)
    for steps, refine in itertools.product((1, 2, 7), (True, False)):
        march = contactlab.create(f"integrator.{integrator}", steps=steps, refine=refine)
        for tangential in ("coulomb", FailsWhenFast()):
            result = Simulation(tangential=tangential, integrator=march).run(scene)
            raised = tangential != "coulomb" and steps < 7
            refused = raised and not refine
            assert refused or result.normal_restitution == 1.0
            assert result.status is (Status.TOO_FEW_STEPS if refused else Status.SUCCESS)
            assert ("steps raised" in str(result.plan)) is (raised and refine)


def test_one_impossible_impact_does_not_spoil_a_batch():
    chi = np.array([1.0, 1e300, 3.0])
    result = annulus("symplectic", steps=50).run(Scene.nondimensional(psi1=0.5, chi=chi))
    assert [status.name for status in result.status] == ["SUCCESS", "TOO_FEW_STEPS", "SUCCESS"]
    assert np.isfinite(result.psi2).tolist() == [True, False, True]


@attrs.frozen(kw_only=True)
class FailsWhenFast(SteppedTangentialLaw):
    """Coulomb's law, but for slip beyond psi = 2.5: there it does what it was made to do."""

    api_version: ClassVar[int] = 2

    fault: str = "nan"

    def start(self, scene, normal):
        return scene.friction_coefficient, scene.pair.tangential_mass

    def advance(self, state, increment, before, after):
        limit = state[0] * after.friction_load
        arresting = state[1] * increment.velocity / increment.duration
        force = np.clip(arresting, -limit, limit)
        fast = np.abs(increment.velocity) > 2.5
        if self.fault == "raises" and np.any(fast):
            raise ArithmeticError("too fast")
        if self.fault == "unsettled":
            return TangentialResponse(force, 0.0 * force, ~np.asarray(fast)), state
        return TangentialResponse(force * np.where(fast, np.nan, 1.0), 0.0 * force), state


@pytest.mark.parametrize("integrator", ["symplectic", "paper", "adaptive"])
@pytest.mark.parametrize(
    ("fault", "status"),
    [("nan", "NON_FINITE"), ("raises", "LAW_RAISED"), ("unsettled", "UNSETTLED")],
)
@pytest.mark.parametrize("column", [False, True])
def test_an_impact_that_fails_takes_no_other_of_its_batch_with_it(
    integrator, fault, status, column
):
    simulation = Simulation(tangential=FailsWhenFast(fault=fault), integrator=integrator)
    psi1 = np.array([1.0, 3.0, 2.0, 4.0])
    batch = simulation.run(Scene.nondimensional(psi1=psi1[:, None] if column else psi1, chi=3.0))
    alone = [simulation.run(Scene.nondimensional(psi1=value, chi=3.0)) for value in psi1.tolist()]
    statuses = [item.status.name for item in alone]
    assert statuses == ["SUCCESS", status, "SUCCESS", status]
    assert [item.name for item in batch.status.ravel()] == statuses
    assert batch.psi2.ravel()[[0, 2]].tolist() == [alone[0].psi2, alone[2].psi2]
    assert batch.failures == {index: alone[index].failures[0] for index in (1, 3)}
    if not column:
        assert batch[0].motion.detail == ""
        assert batch[1].motion.detail == alone[1].motion.detail
    with pytest.raises(ImpactError, match="impact 1: ") as caught:
        batch.check()
    sent = pickle.loads(pickle.dumps(caught.value))  # as a pool of processes does
    assert (str(sent), sent.status) == (str(caught.value), caught.value.status)


@pytest.mark.parametrize("shape", [(100,), (10, 10)])
def test_a_few_failures_in_a_large_batch_are_found(shape):
    psi1 = np.linspace(0.1, 2.0, 100)
    psi1[[3, 70, 71]] = 3.5
    simulation = Simulation(tangential=FailsWhenFast(), integrator="symplectic")
    result = simulation.run(Scene.nondimensional(psi1=psi1.reshape(shape), chi=3.0))
    assert list(result.failures) == [3, 70, 71]
    good = simulation.run(Scene.nondimensional(psi1=np.delete(psi1, [3, 70, 71]), chi=3.0)).check()
    assert np.delete(result.psi2.ravel(), [3, 70, 71]).tolist() == good.psi2.tolist()


@pytest.mark.parametrize("law", ["springs", "annulus", "mindlin_cap"])
@pytest.mark.parametrize("chi", [41.6, *longer(1000.0)])
def test_adaptive_steps_are_stable_where_slip_is_too_small_to_see(law, chi):
    """Unstable steps grew it up to the tolerance, unseen: by 1e14 for psi1 = 1e-20."""
    sim = Simulation(tangential=law, integrator="adaptive")
    for psi1 in (1e-20, 1e-8):
        result = sim.run(Scene.nondimensional(psi1=psi1, chi=chi)).check()
        assert abs(result.psi2) <= (1.1 if law == "mindlin_cap" else 1.0) * psi1


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
@pytest.mark.parametrize("stiffer", [1e4, 1e-8])
def test_steps_divide_the_contact_that_there_is(integrator, stiffer):
    """In 200 steps of a Hertz duration a contact of a hundredth of it lasts 2: e was 0.54."""
    scene = in_si(Scene.nondimensional(psi1=[0.5, 1.2], chi=1.44))
    hertz = float(hertz_scales(scene).duration)
    spring = LinearSpring(stiffness=stiffer * float(scene.pair.normal_mass) * (np.pi / hertz) ** 2)
    for refine in (True, False):
        march = contactlab.create(f"integrator.{integrator}", refine=refine)
        sim = Simulation(normal=spring, tangential=FailsWhenFast(), integrator=march)
        result = sim.run(scene).check()
        assert result.normal_restitution == pytest.approx(1.0, abs=1e-8)
        assert result.motion.duration == pytest.approx(hertz / np.sqrt(stiffer), rel=1e-8)
        assert result.counters["steps"] == resolution_of(march)
        assert not any("raised" in str(caution) for caution in result.plan.cautions)
        course = sim.run(scene, history=True).check()
        assert course.psi2.tolist() == result.psi2.tolist()
        assert len(course.history.time) == resolution_of(march)


@pytest.mark.parametrize("integrator", ["events", "adaptive"])
@pytest.mark.parametrize("bad", [0.0, 2.0, [1e-6, 1e-7], "1e-6", True])
def test_bad_tolerance(integrator, bad):
    with pytest.raises(ValueError, match="tolerance = "):
        contactlab.create(f"integrator.{integrator}", tolerance=bad)


class LateNan(SpoiledMotion):
    """The radius is NaN from the middle of restitution on."""

    def at(self, phase):
        sample = self.motion.at(phase)
        radius = np.where(np.asarray(phase) > 0.75 * np.pi, np.nan, sample.contact.radius)
        return sample._replace(contact=sample.contact._replace(radius=radius))

    def take(self, part):
        return LateNan(self.motion.take(part), self.spoil, self.name)


class LateHertz(HERTZ):
    """Hertz's law with that motion."""

    def motion(self, scene):
        return LateNan(super().motion(scene), None, "")


@pytest.mark.parametrize("psi1", [1.2, np.array([0.5, 1.2])])
def test_the_step_is_named_where_a_normal_motion_ceases_to_be_finite(psi1):
    march = contactlab.create("integrator.symplectic", steps=100)
    result = Simulation(normal=LateHertz(), tangential="springs", integrator=march).run(
        Scene.nondimensional(psi1=psi1, chi=1.44)
    )
    told = result.failures[0]
    assert "nan" in told
    step = int(re.search(r"step (\d+)", told)[1])
    rising = np.asarray(HERTZ().motion(Scene.nondimensional(psi1=1.2, chi=1.44)).phase(0.01 * step))
    assert float(rising) == pytest.approx(0.75 * np.pi, abs=0.05)


@attrs.frozen(kw_only=True)
class AnswersInTuples(LinearSpring):
    """A normal law that answers with plain tuples, or with nothing."""

    answer: object = None

    def respond(self, state, approach, rate):
        return self.answer, state


class ForgetsState(SteppedTangentialLaw):
    """A friction law that answers without its next state."""

    api_version = 2

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        return TangentialResponse(0.0 * increment.friction_load, 0.0 * increment.friction_load)


class ForgetsItsState(LinearSpring):
    """A normal law that does."""

    def respond(self, state, approach, rate):
        return super().respond(state, approach, rate)[0]


@pytest.mark.parametrize(
    "laws",
    [{"tangential": ForgetsState()}, {"normal": ForgetsItsState(), "tangential": "coulomb"}],
)
def test_a_law_that_forgets_the_next_state_is_told_so(laws):
    result = Simulation(**laws).run(in_si(Scene.nondimensional(psi1=1.2, chi=1.44)))
    assert result.status is Status.LAW_RAISED
    assert "must be a pair, response or contact and the next state" in result.failures[0]
    assert type(next(iter(laws.values()))).__name__ in result.failures[0]


@pytest.mark.parametrize("answer", [None, (1.0, 1e-3, 1e-6, 1.0)])
def test_a_normal_law_that_gives_no_contact_is_a_status(answer):
    law = AnswersInTuples(answer=answer)
    result = Simulation(normal=law, tangential="coulomb").run(
        in_si(Scene.nondimensional(psi1=1.2, chi=1.44))
    )
    assert result.status is Status.LAW_RAISED
    assert "not a NormalContact" in result.failures[0]
    assert "AnswersInTuples" in result.failures[0]


class OfTwiceTheSpeed(HERTZ):
    """Hertz's law with the motion of another scene: the march would follow that scene."""

    def motion(self, scene):
        return super().motion(attrs.evolve(scene, normal_speed=2.0 * scene.normal_speed))


@pytest.mark.parametrize("psi1", [1.2, np.array([0.5, 1.2])])
@pytest.mark.parametrize("tangential", ["springs", "coulomb"])
def test_the_motion_of_another_scene_is_a_status(tangential, psi1):
    scene = Scene.nondimensional(psi1=psi1, chi=1.44)
    result = Simulation(normal=OfTwiceTheSpeed(), tangential=tangential).run(scene)
    assert np.all(np.asarray(result.status, dtype=object) == Status.LAW_RAISED)
    assert "motion returned the motion of another scene" in result.failures[0]
    assert "OfTwiceTheSpeed" in result.failures[0]
