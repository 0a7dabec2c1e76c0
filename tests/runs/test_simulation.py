"""Runs and sweeps."""

import pickle
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, ImpactError, Material, Scene, Simulation, Sphere, Status
from contactlab.contracts import (
    Integrator,
    SteppedTangentialLaw,
    TangentialResponse,
)
from tests.laws.normal_laws import ForceFree, LinearSpring, in_si

CHI = 1.4411764706


STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


RIGID = {"tangential": "coulomb", "integrator": "symplectic"}


@attrs.frozen(kw_only=True)
class Misbehaving(SteppedTangentialLaw):
    """Answers as told at one step."""

    api_version: ClassVar[int] = 2
    answer: object = 0.0
    at: int = 5

    def start(self, scene, normal):
        return 0

    def advance(self, state, increment, before, after):
        if state + 1 == self.at:
            if isinstance(self.answer, Exception):
                raise self.answer
            return TangentialResponse(self.answer, 0.0), state + 1
        return TangentialResponse(0.0, 0.0), state + 1


def scene(psi1=1.2):
    return Scene.nondimensional(psi1=psi1, chi=CHI)


def test_results_are_told_on_a_line_and_can_be_sliced():
    psi1 = np.array([0.5, 2.0, 3.0, 9.0])
    result = Simulation(**RIGID).run(Scene.nondimensional(psi1=psi1, chi=CHI))
    assert len(repr(result)) < 150
    assert "4 SUCCESS" in repr(result)
    assert "psi2=0;" in repr(result[0])
    assert result[1:3].psi1.tolist() == [2.0, 3.0]
    assert result[1:3].psi2.tolist() == result.psi2[1:3].tolist()
    assert result[-1].psi2 == result.psi2[-1]
    assert "instants" in repr(Simulation(**RIGID).run(scene(), history=True).history)
    for bad in (4, -5, slice(4, 9)):
        with pytest.raises(IndexError):
            result[bad]
    with pytest.raises(TypeError, match="number or a slice"):
        result["psi2"]


def test_frictionless_leaves_the_tangential_velocity_alone():
    result = Simulation(tangential="frictionless", integrator="paper").run(scene())
    assert result.psi2 == 1.2
    assert result.energy.friction_work == 0.0


def test_zero_friction_coefficient_leaves_the_velocity_alone():
    given = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.0, 1.0, 0.3)
    result = Simulation(**RIGID).run(given).check()
    assert result.rebound_tangential_velocity == 0.3
    assert result.rebound_normal_velocity == -1.0


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
@pytest.mark.parametrize("steps", [7, 50, 400])
def test_a_normal_law_without_closed_form_is_solved_whatever_the_steps(integrator, steps):
    """P = k u: duration pi sqrt(M/k), e = 1; the end of contact is located, not overshot."""
    sim = Simulation(
        normal=LinearSpring(),
        tangential="frictionless",
        integrator=contactlab.create(f"integrator.{integrator}", steps=steps),
    )
    result = sim.run(in_si(scene())).check()
    assert result.motion.duration == pytest.approx(np.pi, rel=1e-8)
    assert result.normal_restitution == pytest.approx(1.0, rel=1e-8)


@pytest.mark.parametrize("tangential", ["coulomb", Misbehaving()])
@pytest.mark.parametrize("integrator", ["paper", "symplectic", "adaptive"])
def test_contact_that_never_ends_is_a_status(tangential, integrator):
    sim = Simulation(normal=ForceFree(), tangential=tangential, integrator=integrator)
    result = sim.run(scene())
    assert result.status is Status.NOT_SEPARATED
    assert "did not separate" in str(result.plan)
    assert "ForceFree" in result.motion.detail
    assert np.isnan(result.psi2)
    with pytest.raises(ImpactError, match="did not part"):
        result.check()


@pytest.mark.parametrize("integrator", ["paper", "symplectic"])
@pytest.mark.parametrize(
    ("answer", "status"),
    [
        (float("nan"), Status.NON_FINITE),
        (float("inf"), Status.NON_FINITE),
        (RuntimeError("oops"), Status.LAW_RAISED),
    ],
)
def test_a_misbehaving_law_is_reported_never_an_answer(integrator, answer, status):
    result = Simulation(tangential=Misbehaving(answer=answer), integrator=integrator).run(
        scene(), history=True
    )
    assert result.status is status
    assert not result.status
    assert len(result.history.time) >= 4
    with pytest.raises(ImpactError, match=r"Misbehaving|oops"):
        result.check()


def test_sweep_equals_one_by_one_and_keeps_order():
    sim = Simulation(**RIGID)
    psi1 = np.array([-9.0, 0.0, 0.5, 3.0, 5.9, 12.0])
    sweep = sim.sweep([scene(float(value)) for value in psi1], chunk=2)
    assert len(sweep) == 6
    assert sweep.psi2 == pytest.approx(
        [sim.run(scene(float(value))).psi2 for value in psi1], abs=1e-15
    )
    assert [item.psi1 for item in sweep] == psi1.tolist()
    assert all(status is Status.SUCCESS for status in sweep.status)
    assert sweep[2].psi2 == sim.run(scene(0.5)).psi2
    with pytest.raises(IndexError):
        sweep[6]


def test_bad_arguments_of_run_and_sweep():
    sim = Simulation(**RIGID)
    for bad in (None, 3.0, "scene"):
        with pytest.raises(ValueError, match="scene"):
            sim.run(bad)
    with pytest.raises(ValueError, match="history"):
        sim.run(scene(), history="all")
    with pytest.raises(ValueError, match="chunk"):
        sim.sweep([scene()], chunk=0)
    with pytest.raises(ValueError, match="scenes"):
        sim.sweep(scene())
    with pytest.raises(ValueError, match="scenes"):
        sim.sweep([])


def test_a_history_of_a_run_that_failed_at_once_has_no_instants():
    refusing = contactlab.create("integrator.symplectic", steps=5, refine=False)
    result = Simulation(tangential="springs", integrator=refusing).run(scene(), history=True)
    assert not result.status
    assert repr(result.history) == "History(no instants)"


def test_a_history_changes_nothing_and_spans_the_contact():
    for psi1 in (0.0, 1.2, 7.0):
        for integrator in ("paper", "symplectic"):
            sim = Simulation(tangential="coulomb", integrator=integrator)
            plain, kept = sim.run(scene(psi1)), sim.run(scene(psi1), history=True)
            assert kept.psi2 == plain.psi2
            assert not plain.history
            assert kept.history.time[-1] == pytest.approx(plain.motion.duration, rel=0.01)


def test_simulations_pickle():
    sim = pickle.loads(pickle.dumps(Simulation(**RIGID)))
    assert sim.run(scene(3.0)).psi2 == Simulation(**RIGID).run(scene(3.0)).psi2


def test_two_spheres_share_the_impulse():
    """Equal spheres, head on: they exchange their normal velocities."""
    ball = Sphere(0.01, STEEL)
    result = Simulation(**RIGID).run(Scene(ball, ball, 0.1, 2.0, 0.1))
    assert result.rebound_normal_velocity == pytest.approx(0.0, abs=1e-14)
    assert result.normal_restitution == pytest.approx(1.0, rel=1e-14)


class GivesUpNeighbours(Integrator):
    """Of a batch it gives up the impact before a fast one too."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[type]] = frozenset({SteppedTangentialLaw})

    def integrate(self, scene, normal, tangential, observer=None):
        inner = contactlab.create("integrator.symplectic", steps=50)
        motion = inner.integrate(scene, normal, tangential, observer)
        fast = np.asarray(scene.psi1) > 2.0
        if scene.shape:
            fast = fast | np.roll(fast, -1)
        return motion.failing(fast, Status.NON_FINITE, "Too fast.") if np.any(fast) else motion


def test_an_impact_given_up_for_its_neighbour_is_followed_by_itself():
    scene = Scene.nondimensional(psi1=np.array([1.0, 1.2, 2.5, 0.5]), chi=CHI)
    result = Simulation(tangential="springs", integrator=GivesUpNeighbours()).run(scene)
    assert [one.name for one in result.status] == ["SUCCESS", "SUCCESS", "NON_FINITE", "SUCCESS"]
    alone = Simulation(tangential="springs", integrator=GivesUpNeighbours()).run(scene.take(1))
    assert result.psi2[1] == pytest.approx(alone.psi2, abs=1e-12)


def test_values_of_the_wrong_kind_are_refused_with_what_was_meant():
    with pytest.raises(ValueError, match=r"by its name: Material\.named\('steel'\)"):
        Sphere(0.01, "steel")
    with pytest.raises(ValueError, match=r"of a file: case = read_scene\(path\)"):
        Simulation().run("scene.toml")


@pytest.mark.parametrize("psi1", [0.0, 9.0])
def test_fields_are_followed_where_the_impact_is_known_as_a_whole(psi1):
    """Without slip, and in slip throughout: the closed form has no tractions."""
    scene = Scene.nondimensional(psi1=psi1, chi=1.0)
    simulation = Simulation(tangential="springs")
    assert not simulation.plan(scene).marched.any()
    result = simulation.run(scene, history="fields").check()
    assert result.plan.marched.all()
    assert set(result.history.fields) >= {"radius", "displacement", "limit"}
    assert len(result.history.fields["limit"]) == len(result.history.time)


def test_evolve_swaps_a_law_and_carries_only_what_was_given():
    tsuji = attrs.evolve(Simulation(normal="tsuji"), tangential="springs")
    assert tsuji == Simulation(normal="tsuji", tangential="springs")
    assert tsuji.laws.named == {"normal", "tangential"}
    back = attrs.evolve(attrs.evolve(Simulation(), tangential="springs"), tangential=None)
    assert (back, back.laws.named) == (Simulation(), frozenset())
    assert pickle.loads(pickle.dumps(tsuji)).laws == tsuji.laws
    steps = contactlab.create("integrator.symplectic", steps=400)
    with pytest.raises(ValueError, match=r"integrator = symplectic: runs .*integrator = events"):
        attrs.evolve(Simulation(tangential="springs", integrator=steps), tangential="fronts")
