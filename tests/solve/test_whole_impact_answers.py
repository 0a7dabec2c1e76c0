"""Answers to whole impacts: which one counts, the history that is made of it, and its fields."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, Status
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse, WholeImpactTangentialLaw
from contactlab.contracts.whole_impact import WholeImpact, no_force
from contactlab.solve.answers import INSTANTS

CHI = 1.5


@attrs.frozen(kw_only=True)
class Halves(WholeImpactTangentialLaw):
    """Takes half the slip while the load acts; fields of the fast impacts alone."""

    api_version: ClassVar[int] = 2
    course: bool = True

    def whole_impacts(self, scene, normal):
        total, slip = normal.total_load_impulse, scene.slip_velocity

        def course(load_impulse, friction_load):
            return -0.5 * slip * load_impulse / total, 0.25 * friction_load

        def fields(load_impulse):
            share = np.asarray(load_impulse / total) * np.ones(scene.shape)
            return {"share": share, "pair": np.stack([share, 2.0 * share], axis=-1)}

        answer = WholeImpact(
            where=np.abs(slip) > 1.0,
            slip_velocity_change=-0.5 * slip,
            friction_work=0.375 * scene.pair.tangential_mass * slip**2,
            reason="halved",
            course=course if self.course else None,
            fields=fields,
            psi2_error=0.0,
        )
        never = no_force(scene, where=False, reason="never")
        return never, answer, no_force(scene, where=True, reason="slow")


def run(psi1, history="fields", **options):
    simulation = Simulation(tangential=Halves(**options), integrator="symplectic")
    return simulation.run(Scene.nondimensional(psi1=psi1, chi=CHI), history=history).check()


def test_fields_of_whole_impacts_are_nan_where_an_answer_has_none():
    result = run([2.0, 0.5, -4.0])
    assert result.psi2.tolist() == [1.0, 0.5, -2.0]
    fields = result.history.fields
    assert fields["share"].shape == (INSTANTS, 3)
    assert fields["pair"].shape == (INSTANTS, 3, 2)
    assert np.isnan(fields["share"][:, 1]).all()
    assert np.isnan(fields["pair"][:, 1]).all()
    for impact in (0, 2):
        share = fields["share"][:, impact]
        assert (share[0], share[-1]) == (0.0, pytest.approx(1.0))
        assert np.array_equal(fields["pair"][:, impact, 1], 2.0 * share)
        gone = 1.0 - 0.5 * share
        slip = result.history.slip_velocity[:, impact]
        assert slip == pytest.approx(result.scene.slip_velocity[impact] * gone)
    loads = result.history.normal_force
    assert result.history.tangential_force[:, 0] == pytest.approx(0.25 * loads[:, 0])
    assert not result.history.tangential_force[:, 1].any()
    said = [str(clause) for clause in result.plan.left_out[:2]]
    assert said == [
        "stepping through the contact (2 of 3 impacts): halved",
        "stepping through the contact (1 of 3 impacts): slow",
    ]


def test_fields_of_one_impact_are_those_of_its_answer():
    fast, slow = run(2.0), run(0.5)
    assert fast.history.fields["share"].shape == (INSTANTS,)
    assert fast.history.fields["pair"].shape == (INSTANTS, 2)
    assert slow.history.fields == {}
    assert slow.history.slip_velocity == pytest.approx(np.full(INSTANTS, 0.5))
    assert run(2.0, history=True).history.fields == {}
    assert fast.history.time[-1] == pytest.approx(float(fast.motion.duration))
    middle = INSTANTS // 2
    assert fast.history.normal_force.argmax() == middle
    assert fast.history.contact_radius[middle] == pytest.approx(1.0)  # C = R = 1
    assert fast.history.slip_velocity[middle] == pytest.approx(1.5)


def test_without_a_course_slip_and_force_are_unknown():
    history = run([2.0, 0.5], course=False).history
    assert np.isnan(history.slip_velocity).all(axis=0).tolist() == [True, False]
    assert np.isnan(history.tangential_force).all(axis=0).tolist() == [True, False]
    assert np.isfinite(history.normal_force).all()


@attrs.frozen(kw_only=True)
class Rough(SteppedTangentialLaw):
    """Free of friction in a march; an answer of a declared error, with or without a course."""

    api_version: ClassVar[int] = 2
    error: float = 0.0
    course: bool = False

    def whole_impacts(self, scene, normal):
        known = no_force(scene, where=True, reason="known")
        error = self.error * np.ones(scene.shape) if scene.shape else self.error
        course = known.course if self.course else None
        changed = attrs.evolve(known, psi2_error=error, course=course)
        return (attrs.evolve(changed, slip_velocity_change=0.25 + 0.0 * scene.slip_velocity),)

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        return TangentialResponse(0.0 * increment.velocity, 0.0 * increment.velocity), state


@attrs.frozen(kw_only=True)
class Accurate(type(Simulation(tangential="springs").integrator)):
    """An integrator that keeps psi2 to 1e-3."""

    offers = frozenset({"controls_error"})
    resolution = "tolerance"
    tolerance = 1e-3
    _steps = 200


@pytest.mark.parametrize("batch", [False, True])
@pytest.mark.parametrize(
    ("psi1", "error", "known"),
    [
        (0.5, 1e-3, True), (0.5, 1.0001e-3, False), (4.0, 4e-3, True), (4.0, 4.0004e-3, False),
        (-4.0, 3.9e-3, True), (4.0, np.nan, True),
    ],
)  # fmt: skip
def test_an_answer_counts_if_it_is_as_accurate_as_a_march(psi1, error, known, batch):
    """Within the accuracy of the integrator times max(1, |psi1|)."""
    simulation = Simulation(tangential=Rough(error=error), integrator=Accurate())
    plan = simulation.plan(Scene.nondimensional(psi1=[psi1] * 2 if batch else psi1, chi=CHI))
    assert np.ravel(plan.marched).tolist() == [not known] * (1 + batch)


@pytest.mark.parametrize("batch", [False, True])
def test_an_answer_without_a_course_does_not_serve_a_history(batch):
    scene = Scene.nondimensional(psi1=[0.5, 0.6] if batch else 0.5, chi=CHI)
    for course in (False, True):
        simulation = Simulation(tangential=Rough(course=course), integrator="symplectic")
        marched = [
            np.all(simulation.plan(scene, history=history).marched)
            for history in (False, True, "fields")
        ]
        assert marched == [False, not course, True]


@attrs.frozen(kw_only=True)
class Unsure(WholeImpactTangentialLaw):
    """Knows no slip where it is fast, and says so; counts what it looked up."""

    api_version: ClassVar[int] = 2

    def whole_impacts(self, scene, normal):
        known = no_force(scene, where=True, reason="known")
        fast = np.abs(scene.slip_velocity) > 1.0
        status = np.where(fast, Status.UNRESOLVED, Status.SUCCESS)
        return (
            attrs.evolve(
                known,
                status=status if scene.shape else status.item(),
                detail="No entry." if np.any(fast) else "",
                counter="looked up",
            ),
        )


def test_an_answer_may_be_a_failure_and_may_be_counted():
    simulation = Simulation(tangential=Unsure(), integrator="symplectic")
    results = [
        simulation.run(Scene.nondimensional(psi1=psi1, chi=CHI)) for psi1 in (0.5, 2.0, [0.5, 2.0])
    ]
    slow, fast, both = results
    assert (slow.status, slow.motion.detail) == (Status.SUCCESS, "")
    assert (fast.status, fast.motion.detail) == (Status.UNRESOLVED, "No entry.")
    assert both.status.tolist() == [Status.SUCCESS, Status.UNRESOLVED]
    assert both.motion.detail.tolist() == ["", "No entry."]
    assert [dict(each.counters) for each in results] == [
        {"looked up": 1}, {"looked up": 1}, {"looked up": 2},
    ]  # fmt: skip
    assert dict(run(2.0, history=False).counters) == {}


def test_an_answer_goes_beside_a_march_of_the_others():
    """Central impacts are known, and others are marched: their steps alone are counted."""
    simulation = Simulation(tangential="springs", integrator="symplectic")
    psi1 = [0.0, 1.2, 20.0, 0.7]
    batch = simulation.run(Scene.nondimensional(psi1=psi1, chi=CHI)).check()
    assert batch.plan.marched.tolist() == [False, True, False, True]
    alone = [simulation.run(Scene.nondimensional(psi1=one, chi=CHI)).check() for one in psi1]
    assert batch.psi2 == pytest.approx([one.psi2 for one in alone], abs=1e-12)
    assert batch.counters["steps"] == alone[1].counters["steps"]
    assert "steps" not in alone[0].counters
    work = [one.motion.friction_work for one in alone]
    assert batch.motion.friction_work == pytest.approx(work, rel=1e-11, abs=1e-15)
