"""Laws that fail: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import math
import re
from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import Simulation, create
from contactlab.contracts import (
    CausalTangentialLaw,
    CoupledIntegrator,
    CoupledTangentialLaw,
    Ends,
    SteppedTangentialLaw,
    TangentialMotion,
    TangentialResponse,
)
from contactlab.contracts.status import Status
from contactlab.contracts.whole_impact import WholeImpact
from contactlab.impact import kinetics
from contactlab_laws.springs.law import Springs
from tests.solve.any_scene import (
    ONES,
    each_batch,
    every_way,
    many,
    statuses,
)


class OfVectors(CausalTangentialLaw):
    """Base of laws that need no future, of slip that turns too."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"vectors"})


@attrs.frozen
class Liar(OfVectors, CoupledTangentialLaw):
    """Answers both motions as told: NaN, an error for one impact, or books that do not close."""

    how: str = "nan"

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        raise NotImplementedError

    def whole_impacts(self, scene, normal):
        self._raise(scene)
        change = self._change(scene)
        where = np.ones(scene.shape, dtype=bool) if scene.shape else True
        return (
            WholeImpact(
                where=where, slip_velocity_change=change, friction_work=0.0 * abs(change),
                reason="told",
            ),
        )  # fmt: skip

    def _raise(self, scene):
        if self.how == "raise" and np.any(np.asarray(scene.index) == 1):
            raise RuntimeError("one of them")

    def _change(self, scene):
        factor = {"nan": math.nan, "books": -1.0, "raise": -1e-9}[self.how]
        return factor * np.asarray(scene.slip_velocity)

    def solve_coupled(self, scene, normal, accuracy, observer=None):
        self._raise(scene)
        ones = np.ones(scene.shape)
        rate = -scene.normal_speed * ones
        if self.how == "raise":  # a small impulse along n alone keeps the energy
            W = np.asarray(scene.inverse_mass)
            push = scene.normal_speed / W[..., 0, 0] * 1e-9
            rate = (1.0 - 1e-9) * scene.normal_speed * ones
            slip = -W[..., 0, 1:] * np.asarray(push)[..., None]
            change = slip[..., 0] if scene.planar else slip
        else:
            change = self._change(scene) * np.ones((*scene.shape, *kinetics.slip_axes(scene)))
        status = np.full(scene.shape, Status.SUCCESS, dtype=object)
        return TangentialMotion(
            slip_velocity_change=change, friction_work=0.0 * ones,
            status=status if scene.shape else Status.SUCCESS,
            detail=np.full(scene.shape, "", dtype=object) if scene.shape else "", counters={},
            normal=Ends(duration=ones, final_rate=rate, maximum_radius=ones, maximum_approach=ones,
                        maximum_force=ones, dissipation=0.0 * ones, compressions=ones),
        )  # fmt: skip


@every_way
def test_a_law_that_answers_nan_is_not_finite(scene):
    result = Simulation(tangential=Liar("nan")).run(scene)
    assert set(statuses(result)) == {"NON_FINITE"}
    assert np.isnan(result.psi2).all()
    assert "Liar" in str(result)


@each_batch
@pytest.mark.parametrize("count", [3, 2001])
def test_one_impact_that_raises_costs_that_impact_alone(scene, count):
    """Under a law that answers both motions together, in a batch of three or of thousands."""
    places = np.resize(np.arange(3), count)
    laws = Simulation(tangential=Liar("raise"), integrator="symplectic")
    batch = scene.take(places).numbered(np.arange(count))
    result = laws.sweep(batch) if count > 3 else laws.run(batch)
    assert list(result.failures) == [1]
    assert statuses(result)[1] == "LAW_RAISED"
    assert "one of them" in result.failures[1]


@attrs.frozen
class FailsAtOne(OfVectors):
    """No friction, and no answer for the impact of index 1."""

    how: str = "raises"

    def start(self, scene, normal):
        return np.asarray(scene.index)

    def advance(self, state, increment, before, after):
        force, work = 0.0 * np.asarray(increment.displacement), 0.0 * np.asarray(after.force)
        bad = state == 1
        if self.how == "raises" and np.any(bad):
            raise ArithmeticError("that one")
        if self.how == "nan":
            force = np.where(bad[..., None] if force.ndim > work.ndim else bad, math.nan, force)
        return TangentialResponse(force, work, ~bad if self.how == "unsettled" else True), state

    def stiffness(self, scene, normal):
        return 1.0


#: How a law fails, and the integrator under which it does so in the default suite.
FAILING = {
    "nan": ("NON_FINITE", "symplectic"),
    "raises": ("LAW_RAISED", "adaptive"),
    "unsettled": ("UNSETTLED", "paper"),
}


@each_batch
@pytest.mark.parametrize(
    ("how", "status", "integrator"),
    [
        pytest.param(how, status, name, marks=[pytest.mark.slow] * (name != usual))
        for how, (status, usual) in FAILING.items()
        for name in ("symplectic", "adaptive", "paper")
    ],
)
def test_an_impact_that_fails_in_a_march_takes_no_other_with_it(scene, integrator, how, status):
    laws = Simulation(tangential=FailsAtOne(how), integrator=integrator)
    result = laws.run(scene)
    assert statuses(result) == ["SUCCESS", status, "SUCCESS"]
    assert list(result.failures) == [1]
    assert "FailsAtOne" in result.failures[1]
    assert statuses(laws.run(scene.take(1))) == [status]
    assert result.normal_restitution[[0, 2]] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.slow
def test_one_of_two_thousand_that_raises_in_a_march():
    laws = Simulation(tangential=FailsAtOne(), integrator="symplectic")
    for name in ("planar", "mixed"):
        result = laws.sweep(many(name))
        assert list(result.failures) == [1], name


@every_way
def test_books_that_nobody_bounds_are_cautioned_of(scene):
    result = Simulation(tangential=Liar("books")).run(scene)
    assert set(statuses(result)) == {"SUCCESS"}
    off = np.max(np.abs(result.energy.relative_imbalance))
    assert off > 0.05
    told = [text for text in result.cautions if "Liar is the cause" in text]
    assert len(told) == 1
    assert f"off by {off:.2g} of the energy at the start" in told[0]
    assert told[0] in str(result)


@attrs.frozen
class Bounded(Liar):
    def books_bound(self, scene):
        return 0.01


@every_way
def test_books_off_a_declared_bound_fail(scene):
    result = Simulation(tangential=Bounded("books")).run(scene)
    assert set(statuses(result)) == {"UNBALANCED"}
    assert "declared: 0.01" in str(result)


@attrs.frozen
class Mistaken(OfVectors):
    """Viscous friction, but for a mistake that the step does not show by itself."""

    how: str = "moves"

    def start(self, scene, normal):
        return 0.1 * np.max(scene.pair.tangential_mass / normal.duration)

    def advance(self, state, increment, before, after):
        if self.how == "moves" and isinstance(increment.displacement, np.ndarray):
            increment.displacement[...] *= 0.5
        if self.how == "slows" and isinstance(increment.velocity, np.ndarray):
            increment.velocity[...] *= 0.5
        if self.how == "loads" and isinstance(after.friction_load, np.ndarray):
            after.friction_load[...] *= 0.5
        force = np.asarray(increment.velocity) * state
        work = (force * increment.displacement).reshape(*np.shape(after.force), -1).sum(axis=-1)
        if self.how == "cuts":
            force, work = force.reshape(-1)[:1], work.reshape(-1)[:1]
        return TangentialResponse(force, np.abs(work)), state


@every_way
@pytest.mark.parametrize("how", ["moves", "slows", "loads", "cuts"])
def test_no_mistake_of_a_step_looks_like_an_answer(scene, how):
    """What a law is given it may not change, and the force of one impact is not that of all."""
    sound = Simulation(tangential=Mistaken("none")).run(scene).check()
    found = Simulation(tangential=Mistaken(how)).run(scene)
    for one, other, status in zip(
        np.reshape(sound.psi2, (len(statuses(sound)), -1)),
        np.reshape(found.psi2, (len(statuses(sound)), -1)),
        statuses(found),
        strict=True,
    ):
        told = status == ("MALFORMED" if how == "cuts" else "LAW_RAISED")
        assert told or other == pytest.approx(one, rel=1e-9)


@attrs.frozen
class Pushing(Mistaken):
    """Forces along an axis whose energy is beyond the numbers."""

    sense: float = 1.0

    def advance(self, state, increment, before, after):
        load = self.sense * 1e200 * np.asarray(after.friction_load)
        many = np.ndim(increment.velocity) > np.ndim(load)
        force = np.stack([load, load], axis=-1) if many else load
        return TangentialResponse(force, 0.0), state


@every_way
@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.filterwarnings("ignore:(overflow|invalid)")
def test_energy_beyond_the_numbers_is_no_answer(scene, sense):
    result = Simulation(tangential=Pushing(sense=sense)).run(scene)
    assert set(statuses(result)) <= {"UNBALANCED", "UNRESOLVED"}


@attrs.frozen(kw_only=True)
class Spoiling(CoupledIntegrator):
    """Symplectic steps, whose motion is spoilt."""

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[type]] = frozenset({SteppedTangentialLaw})
    how: str

    def integrate(self, scene, normal, tangential, observer=None):
        sound = create("integrator.symplectic")
        return self.spoilt(sound.integrate(scene, normal, tangential, observer))

    def integrate_coupled(self, scene, normal, tangential, observer=None):
        sound = create("integrator.symplectic", steps=20)
        return self.spoilt(sound.integrate_coupled(scene, normal, tangential, observer))

    def spoilt(self, motion):
        change = motion.slip_velocity_change
        return {
            "none": lambda: None,
            "tuple": lambda: (change, motion.friction_work),
            "complex": lambda: attrs.evolve(motion, slip_velocity_change=change + 0j),
            "column": lambda: attrs.evolve(motion, friction_work=np.full((1, 1), 0.1)),
            "empty": lambda: attrs.evolve(motion, slip_velocity_change=np.ravel(change)[:0]),
            "word": lambda: attrs.evolve(motion, status="SUCCESS"),
            "no status": lambda: attrs.evolve(motion, status=None),
        }[self.how]()


@every_way
@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("none", "gave None, not a TangentialMotion"),
        ("tuple", "not a TangentialMotion"),
        ("complex", "slip_velocity_change = .*must be real"),
        ("column", "friction_work = .*must be real"),
        ("empty", "slip_velocity_change = .*of shape"),
        ("word", "status = 'SUCCESS': must be a Status"),
        ("no status", "status = None: must be a Status"),
    ],
)
def test_what_is_no_motion_of_an_integrator_is_told(scene, how, words):
    result = Simulation(tangential="springs", integrator=Spoiling(how=how)).run(scene)
    assert set(statuses(result)) == {"LAW_RAISED"}
    assert re.search(words, result.failures[0])
    assert "Spoiling" in result.failures[0]


@attrs.frozen
class Unsure(Springs):
    """Springs, of which one answer is no answer."""

    how: str = ""

    def accept(self, scene):
        if self.how == "accept":
            raise TypeError("unknown scene")

    def books_bound(self, scene):
        return "small" if self.how == "books_bound" else 0.1


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("accept", "tangential = Unsure: its accept raised TypeError: unknown scene"),
    ],
)
def test_a_law_that_cannot_say_whether_it_runs_does_not_run(how, words):
    with pytest.raises(ValueError, match=words):
        Simulation(tangential=Unsure(how=how)).run(ONES["central"])


@every_way
def test_a_bound_of_the_books_in_words_is_malformed(scene):
    result = Simulation(tangential=Unsure(how="books_bound")).run(scene)
    assert set(statuses(result)) == {"MALFORMED"}
    assert "books_bound gave 'small'" in result.failures[0]
