"""What is declared of the numerical error: by exact laws a bound that holds, by the others NaN."""

import json
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.contracts import NormalMotion, WholeImpact
from tests.laws.outside_laws import Walton
from tests.longer import longer
from tests.solve.error_scenes import numbers

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
UNDECLARED = [*longer("annulus"), "mindlin_cap", "linear_spring"]


def test_what_nobody_declared_is_not_a_number():
    """A whole-impact answer and a normal motion were exact where their author said nothing."""
    silent = WholeImpact(where=True, slip_velocity_change=0.0, friction_work=0.0, reason="")
    assert np.isnan(silent.psi2_error)
    assert np.isnan(NormalMotion.accuracy)


def test_the_whole_impact_law_of_a_stranger_is_not_exact():
    """The impacts that the contract itself answers are: no slip velocity, no friction."""
    scene = Scene.nondimensional(psi1=[0.0, 1.2, 9.0], chi=1.44)
    simulation = Simulation(tangential=Walton())
    result = simulation.run(scene)
    assert np.isfinite(result.plan.psi2_error).tolist() == [True, False, False]
    assert "numerical error of psi2 (2 of 3 impacts): the laws state no bound" in str(result.plan)
    one = Simulation(tangential=Walton()).run(scene.take(1))
    assert "numerical error of psi2: not estimated; not declared" in str(one)


@pytest.mark.parametrize(
    "laws",
    [
        {},
        {"tangential": contactlab.create("tangential.fronts", table=False)},
        {"normal": "tsuji", "tangential": "stronge"},
    ],
    ids=["default", "fronts", "stronge"],
)
def test_as_much_is_declared_for_either_sense_of_slip(laws):
    assert_declared_alike(laws)


def assert_declared_alike(laws):
    """One impact and both, with slip either way, declare one error."""
    simulation = Simulation(**laws)
    sides = [
        float(simulation.plan(Scene.nondimensional(psi1=psi1, chi=1.44)).psi2_error)
        for psi1 in (3.0, -3.0)
    ]
    assert sides[0] > 0.0
    assert sides[0] == sides[1]
    both = simulation.plan(Scene.nondimensional(psi1=[3.0, -3.0], chi=1.44)).psi2_error
    assert both == pytest.approx(sides[0], rel=1e-12)


class SilentMotion(NormalMotion):
    """Hertz's motion, without a word of its accuracy."""

    def __init__(self, motion):
        self.__dict__.update(
            {name: getattr(motion, name) for name in NormalMotion.__annotations__
             if name != "accuracy"}
        )  # fmt: skip
        self.motion = motion

    at = property(lambda self: self.motion.at)
    phase = property(lambda self: self.motion.phase)

    def take(self, part):
        return SilentMotion(self.motion.take(part))


def test_nothing_is_declared_along_a_motion_that_declares_nothing():
    class Silent(type(contactlab.create("normal.hertz"))):
        api_version: ClassVar[int] = 2

        def motion(self, scene):
            return SilentMotion(super().motion(scene))

    scene = Scene.nondimensional(psi1=[1.2, 9.0], chi=1.44)
    plan = Simulation(normal=Silent(), tangential="coulomb").plan(scene)
    assert np.isnan(plan.psi2_error).all()


@pytest.mark.parametrize("normal", ["hertz", "tsuji", "linear"])
@pytest.mark.parametrize("tangential", ["coulomb", "frictionless", "walton", "stronge"])
def test_closed_forms_of_ours_declare_rounding(normal, tangential):
    scene = Scene.nondimensional(psi1=[0.0, 0.5, 3.0, 50.0], chi=1.44)
    plan = Simulation(normal=normal, tangential=tangential).plan(scene)
    assert (plan.psi2_error <= 1e-12 * np.maximum(1.0, scene.psi1) + 1e-13).all()


@pytest.mark.parametrize("tangential", UNDECLARED)
def test_discretised_laws_declare_nothing_where_they_march(tangential):
    scene = Scene.nondimensional(psi1=[0.0, 1.2, 50.0], chi=1.44)
    for integrator in ("symplectic", "adaptive"):
        result = Simulation(tangential=tangential, integrator=integrator).run(scene)
        assert np.array_equal(np.isnan(result.plan.psi2_error), result.plan.marched)
        assert json.loads(json.dumps(result.plan.to_dict()))["psi2_error"][1] is None


def test_springs_declare_nothing_where_a_tolerance_is_no_bound():
    """Under even steps they declare (``tests/laws/test_springs_errors.py``)."""
    scene = Scene.nondimensional(psi1=[0.0, 1.2, 50.0], chi=1.44)
    plan = Simulation(tangential="springs", integrator="adaptive").plan(scene)
    assert np.array_equal(np.isnan(plan.psi2_error), plan.marched)


@pytest.mark.parametrize("count", [120, *longer(600)])
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_no_exact_answer_is_further_off_than_declared(tolerance, count):
    """Solved, against the table, which is another program, over the scenes that it covers."""
    psi1, chi = (values[:count] for values in numbers())
    inside = chi < 2.4
    scene = Scene.nondimensional(psi1=psi1[inside], chi=chi[inside])
    events = contactlab.create("integrator.events", tolerance=tolerance)
    law = contactlab.create("tangential.fronts", table=False)
    result = Simulation(tangential=law, integrator=events).run(scene).check()
    table = Simulation().run(scene)
    bound = result.plan.psi2_error + table.plan.psi2_error
    assert (np.abs(result.psi2 - table.psi2) <= bound).all()


def test_the_error_is_declared_in_psi_whatever_the_units():
    scene = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.2, 1.0, 0.5, 20.0)
    same = Scene.nondimensional(psi1=scene.psi1, chi=scene.chi)
    plans = [Simulation().plan(either) for either in (scene, same)]
    assert plans[0].psi2_error == pytest.approx(plans[1].psi2_error, rel=1e-9)


@attrs.frozen(kw_only=True)
class Boasts(Walton):
    """A law whose answer is off by 0.1/terms of the impulse, and declared exact."""

    api_version: ClassVar[int] = 2
    resolution: ClassVar[str] = "terms"

    terms: int = 5
    claimed: float = 0.0

    def whole_impacts(self, scene, normal):
        *known, answer = super().whole_impacts(scene, normal)
        change = (1.0 - 0.1 / self.terms) * answer.slip_velocity_change
        return (*known, attrs.evolve(answer, slip_velocity_change=change, psi2_error=self.claimed))


def test_a_false_declaration_is_said_loudly():
    """With both numbers; not where the estimate does not contradict it."""
    scene = Scene.nondimensional(psi1=9.0, chi=1.0)
    said = str(Simulation(tangential=Boasts()).run(scene, estimate_error=True))
    false = "the stated bound of the error of psi2 is wrong"
    assert f"caution: {false}: stated 9e-12, estimated 0.08" in said
    honest = Simulation(tangential=Boasts(claimed=0.1)).run(scene, estimate_error=True)
    assert false not in str(honest)
    assert "about 0.08, estimated; at most 0.1, declared" in str(honest)
    batch = Scene.nondimensional(psi1=[0.0, 5.0, 9.0], chi=1.0)
    said = str(Simulation(tangential=Boasts()).run(batch, estimate_error=True))
    assert f"caution: {false} for 2 of 3 impacts" in said


def test_a_coarse_answer_is_told_so():
    """Two springs at chi = 30 miss psi2 by 0.43 of 1.9; at 1.44 they miss by less than 0.04."""
    springs = Simulation(tangential=contactlab.create("tangential.springs", springs=2))
    scene = Scene.nondimensional(psi1=0.95, chi=[1.44, 30.0])
    said = str(springs.run(scene, estimate_error=True))
    assert "caution: coarse for 1 of 2 impacts: no digit" in said
    assert "coarse" not in str(springs.run(scene.take(0), estimate_error=True))
