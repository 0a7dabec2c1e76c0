"""Estimates where no tolerance is kept, bounds of the books, and the law that a failure names."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Encounter, Material, Scene, Simulation, Sphere, collide
from contactlab.collisions.collision import VECTORS_AFTER
from contactlab.contracts import (
    SteppedTangentialLaw,
    Taken,
    TangentialResponse,
    quantity,
)
from contactlab.outcome.columns import QUANTITIES, columns_of
from contactlab.outcome.export import write_csv
from contactlab.outcome.plan import PSI2_ERROR
from tests.laws.normal_laws import LinearSpring, in_si
from tests.laws.tangential_laws import Creator

SYMPLECTIC = type(contactlab.create("integrator.symplectic"))


@attrs.frozen(kw_only=True)
class Sure(SYMPLECTIC):
    """Fixed steps that declare an accuracy."""

    offers = frozenset({"controls_error"})
    resolution = "tolerance"
    tolerance = 1e-3
    _steps = 200


@pytest.mark.parametrize("psi1", [6.0, [6.0, 6.0]])
def test_the_bound_of_the_books_is_that_of_the_law_and_ten_accuracies(psi1):
    for integrator, bound in (("symplectic", "0.001"), (Sure(), "0.011")):
        simulation = Simulation(tangential=Creator(), integrator=integrator)
        result = simulation.run(Scene.nondimensional(psi1=psi1, chi=1.44))
        assert result.failures[0].endswith(f" of the energy at the start; declared: {bound}.")


@attrs.frozen(kw_only=True)
class Blind(SteppedTangentialLaw):
    """Sees no number where the slip is fast."""

    api_version: ClassVar[int] = 2

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        force = increment.velocity * np.where(np.abs(increment.velocity) > 2.0, np.nan, 0.0)
        return TangentialResponse(force, 0.0 * force), state


@pytest.mark.parametrize("psi1", [3.0, [1.0, 3.0]])
def test_a_failure_names_the_law_with_its_origin(psi1):
    result = Simulation(tangential=Blind(), integrator="symplectic").run(
        Scene.nondimensional(psi1=psi1, chi=1.0)
    )
    (sentence,) = result.failures.values()
    assert sentence.endswith(f", from Blind in {__name__}.")
    if result.scene.shape:
        assert result.motion.detail.shape == (2,)
        assert result.motion.detail[0] == ""


@attrs.frozen(kw_only=True)
class Guessing(LinearSpring):
    """A spring with a number that nobody can know."""

    loss: float = quantity("1", default=Taken(0.5))


def test_an_author_says_which_default_is_to_be_told():
    scene = in_si(Scene.nondimensional(psi1=1.0, chi=1.0))

    def cautions(law):
        return Simulation(normal=law, tangential="coulomb").plan(scene).cautions

    assert "no loss given, using 0.5" in str(cautions(Guessing()))
    assert "given, using" not in str(cautions(Guessing(loss=0.5)))


def test_the_error_of_a_solved_motion_is_that_of_its_load_impulse():
    """1e-7 of 4 chi, beside 1e-12 max(1, |psi1|): alone, in a batch, known or not."""
    for psi1 in (0.0, 1.2, 9.0):
        one, many = (
            Simulation(normal=LinearSpring(), tangential="coulomb").plan(
                in_si(Scene.nondimensional(psi1=each, chi=2.0))
            )
            for each in (psi1, [psi1, psi1])
        )
        expected = 8e-7 + 1e-12 * max(1.0, psi1)
        assert one.psi2_error == pytest.approx(expected, rel=1e-9)
        assert many.psi2_error == pytest.approx([expected] * 2, rel=1e-9)
        assert [clause.code for clause in one.computed if "error" in str(clause)] == [PSI2_ERROR]


@attrs.frozen(kw_only=True)
class Faulty(SteppedTangentialLaw):
    """The limit mu P from start to end; from a step on it errs where the ball turns fast."""

    api_version: ClassVar[int] = 2

    fault: str = "raises"
    step: int = 1
    factor: float = 1e3

    def start(self, scene, normal):
        return scene.friction_coefficient, scene.spin > 100.0, 1

    def advance(self, state, increment, before, after):
        friction, fast, step = state
        wrong = np.asarray(fast & (step >= self.step))
        force = friction * increment.friction_load
        work = force * increment.displacement
        if self.fault == "raises" and wrong.any():
            raise ArithmeticError("lost")
        if self.fault == "malformed" and wrong.any():
            force = "much"
        if self.fault == "works":
            work = work * np.where(wrong, self.factor, 1.0)
        settled = ~wrong if self.fault == "unsettled" else True
        return TangentialResponse(force, work, settled), (friction, fast, step + 1)


FAULTS = {
    "raises": "LAW_RAISED", "malformed": "MALFORMED", "unsettled": "UNSETTLED",
    "works": "UNBALANCED",
}  # fmt: skip
#: Quantities of a result that are given, not answered.
GIVEN = {
    "psi1", "chi", "normal_speed", "tangential_velocity", "spin", "incidence_angle",
    "incidence_angle_deg",
}  # fmt: skip
STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850)
#: A turning ball, slipping throughout: the spins that do not fail, and that do.
SLOW, FAST = 90.0, 110.0


def struck(spin):
    met = Encounter(
        Sphere(0.01, STEEL), Sphere(0.02, STEEL), 0.1, normal=[0, 0, 1], velocity=[0.01, 0, 0.1],
        spin=np.multiply.outer(spin, [0, 1.0, 0]),
    )  # fmt: skip
    return met, met.scene


@pytest.mark.parametrize(("fault", "status"), FAULTS.items())
@pytest.mark.parametrize("step", [1, 20])
def test_no_number_of_a_failed_impact_can_be_taken_for_an_answer(fault, status, step, tmp_path):
    simulation = Simulation(tangential=Faulty(fault=fault, step=step), integrator="symplectic")
    met, scene = struck(FAST)
    both_met, both_scene = struck([SLOW, FAST])
    single, batch = simulation.run(scene, history=True), simulation.run(both_scene)
    assert [each.name for each in (single.status, *batch.status)] == [status, "SUCCESS", status]
    own = {column.name for column in columns_of(scene)}
    for name, column in QUANTITIES.items():
        if name.removesuffix("_deg") not in own | {"rebound_speed"}:
            continue
        finite = [bool(np.isfinite(each)) for each in (column.of(single), *column.of(batch))]
        assert finite == [name in GIVEN, True, name in GIVEN], name
    books = single.energy.to_dict()
    assert {name for name, value in books.items() if value is not None} == {"start", "checked"}
    assert np.isnan([getattr(single.motion, name) for name in single.motion.numbers()]).all()
    course = single.history
    assert len(course.time) >= step - 1
    assert np.isfinite(course.tangential_force[: step - 1]).all()
    write_csv(batch, tmp_path / "both.csv")
    good, bad = (line.count("nan") for line in (tmp_path / "both.csv").read_text().split()[-2:])
    assert (good, bad) == (0, len(own) - len(GIVEN))
    for found, last in ((collide(met, simulation), ...), (collide(both_met, simulation), 1)):
        vectors = np.array([getattr(found, name)[last] for name, _ in VECTORS_AFTER])
        assert np.isnan(vectors[:, 0]).all()


@pytest.mark.parametrize("spin", [FAST, [SLOW, FAST]])
@pytest.mark.parametrize("factor", [1e3, 1.5, 1.001])
def test_books_that_nobody_declared_are_told_with_their_size(spin, factor):
    """The work misses by factor - 1 of the energy that slip throughout takes."""
    _, scene = struck(spin)
    lost = Simulation(tangential="coulomb").run(scene).energy
    share = float(np.ravel((factor - 1.0) * lost.friction_work / lost.start)[-1])
    law = Faulty(fault="works", factor=factor)
    result = Simulation(tangential=law, integrator="symplectic").run(scene)
    told = [str(caution) for caution in result.plan.cautions if "energy balance" in str(caution)]
    if share > 1.0:
        assert f"Off by {share:.3g} times" in [*result.failures.values()][-1]
    assert len(told) == (1.0 > share > 0.01)
    for sentence in told:
        assert f": off by {share:.2g} of the energy at the start." in sentence
        assert "Faulty is the cause" in sentence
        assert ("(1 of 2 impacts)" in sentence) is bool(scene.shape)
