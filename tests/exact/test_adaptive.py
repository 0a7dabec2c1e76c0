"""`integrator.adaptive`: steps under error control, over any laws."""

import math
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, Status
from contactlab.closed_forms import rigid_body_rebound
from contactlab.contracts import (
    SteppedTangentialLaw,
    TangentialResponse,
)
from tests.normal_laws import LinearSpring

CHI = 1.4411764706


@attrs.frozen(kw_only=True)
class Elastic(SteppedTangentialLaw):
    """F = k x: with the linear normal spring, psi = psi1 cos(sqrt(k/M_t) t) in closed form.

    ``seen`` keeps every state that ``advance`` was given, with a copy of what it held then.
    """

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset] = frozenset({"advance"})
    stiffness_in_newton_per_metre: float = 1.0
    seen: list = attrs.field(factory=list)

    def start(self, problem):
        return np.zeros(1)

    def advance(self, state, increment, before, after):
        self.seen.append((state, float(state[0])))
        new = state + increment.displacement
        force = self.stiffness_in_newton_per_metre * float(new[0])
        return TangentialResponse(force, 0.0), new


def adaptive(tolerance):
    return contactlab.create("integrator.adaptive", tolerance=tolerance)


def scene(psi1=1.2, chi=CHI):
    return Scene.nondimensional(psi1=psi1, chi=chi)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_duration_and_restitution_of_a_law_without_closed_form(tolerance):
    sim = Simulation(normal=LinearSpring(), tangential="coulomb", integrator=adaptive(tolerance))
    result = sim.run(scene(7.0)).check()
    assert result.motion.duration == pytest.approx(math.pi, abs=10 * tolerance)
    assert result.normal_restitution == pytest.approx(1.0, abs=10 * tolerance)


def test_error_follows_the_tolerance():
    """A linear oscillator: the error stays below the tolerance and falls in proportion to it."""
    tolerances, errors = [1e-2, 1e-3, 1e-4, 1e-5], []
    for tolerance in tolerances:
        law = Elastic(stiffness_in_newton_per_metre=1.7)
        sim = Simulation(normal=LinearSpring(), tangential=law, integrator=adaptive(tolerance))
        exact = 1.2 * math.cos(math.sqrt(1.7 * 2 * CHI) * math.pi)
        errors.append(abs(sim.run(scene()).check().psi2 - exact))
    assert all(error < 3 * tolerance for error, tolerance in zip(errors, tolerances, strict=True))
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.3)


def fine(law, psi1, chi):
    """Return psi2 by many steps of fixed length, which are chosen by nobody."""
    steps = contactlab.create("integrator.symplectic", steps=10_000)
    return Simulation(tangential=law, integrator=steps).run(scene(psi1, chi)).check().psi2


@pytest.mark.parametrize("chi", [0.5, CHI, 30.0])
@pytest.mark.parametrize(("name", "options"), [("springs", {"springs": 12}), ("mindlin_cap", {})])
def test_error_of_smooth_laws_is_below_the_tolerance(name, options, chi):
    law = contactlab.create(f"tangential.{name}", **options)
    for psi1 in (0.6, 1.2):
        exact = fine(law, psi1, chi)
        for tolerance in (1e-2, 1e-3):
            sim = Simulation(tangential=law, integrator=adaptive(tolerance))
            assert abs(sim.run(scene(psi1, chi)).check().psi2 - exact) < tolerance * max(1.0, psi1)


@pytest.mark.parametrize("annuli", [10, 50])
def test_error_of_annuli_falls_as_the_root_of_the_tolerance(annuli):
    """A newcomer's reference is off by the part of the step before it came, in either way."""
    law = contactlab.create("tangential.annulus", annuli=annuli)
    for psi1 in (0.6, 1.2):
        exact = fine(law, psi1, CHI)
        for tolerance in (1e-2, 1e-3, 1e-4):
            sim = Simulation(tangential=law, integrator=adaptive(tolerance))
            error = abs(sim.run(scene(psi1)).check().psi2 - exact)
            assert error < 0.5 * math.sqrt(tolerance)


def test_cost_grows_as_the_inverse_root_of_the_tolerance():
    """An upper bound for laws that jump too: what is rejected stays below what is kept."""
    tolerances = [1e-2, 1e-3, 1e-4]
    for name in ("springs", "annulus"):
        kept = []
        for tolerance in tolerances:
            sim = Simulation(tangential=name, integrator=adaptive(tolerance))
            counters = sim.run(scene()).check().counters
            assert counters["rejected"] < counters["steps"]
            assert counters["evaluations"] <= 3 * (counters["steps"] + counters["rejected"])
            kept.append(counters["steps"])
        slope = np.polyfit(np.log(tolerances), np.log(kept), 1)[0]
        assert slope == pytest.approx(-0.5, abs=0.15), name


def test_rejected_steps_change_nothing():
    """Steps are rejected, and no state given to the law was changed by a later attempt."""
    law = Elastic(stiffness_in_newton_per_metre=400.0)
    result = Simulation(tangential=law, integrator=adaptive(1e-2)).run(scene()).check()
    assert result.counters["rejected"] > 0
    assert all(float(state[0]) == held for state, held in law.seen)


def test_rigid_friction_is_exact_at_any_tolerance():
    for psi1 in (-3.0, 0.4, 5.7, 6.0):
        for tolerance in (1e-2, 1e-5):
            result = Simulation(tangential="coulomb", integrator=adaptive(tolerance)).run(
                scene(psi1)
            )
            assert result.psi2 == pytest.approx(rigid_body_rebound(psi1, CHI), abs=1e-13)


def test_batch_equals_one_by_one_and_history_changes_nothing():
    sim = Simulation(tangential="annulus", integrator=adaptive(1e-2))
    psi1 = np.array([0.5, 1.2, 6.5])
    batch = sim.sweep(Scene.nondimensional(psi1=psi1, chi=CHI))
    ones = [sim.run(scene(float(value))) for value in psi1]
    assert batch.psi2.tolist() == [one.psi2 for one in ones]
    kept = sim.run(scene(1.2), history=True)
    assert kept.psi2 == ones[1].psi2
    assert (np.diff(kept.history.time) > 0).all()


def test_history_of_a_batch_is_refused():
    sim = Simulation(tangential="annulus", integrator=adaptive(1e-2))
    with pytest.raises(ValueError, match=r"history = True.*one by one"):
        sim.run(Scene.nondimensional(psi1=np.array([0.5, 1.2]), chi=CHI), history=True)


@pytest.mark.parametrize("bad", [0.0, 1e-13, 2.0, math.nan, "fine", None])
def test_bad_tolerance(bad):
    with pytest.raises(ValueError, match="tolerance"):
        adaptive(bad)


def test_contact_that_never_ends_is_given_up():
    sim = Simulation(
        normal=LinearSpring(stiffness=1e-9), tangential="coulomb", integrator=adaptive(1e-2)
    )
    result = sim.run(scene())
    assert result.status is Status.NOT_SEPARATED
    assert result.counters["steps"] < 1000


def test_non_finite_force_is_reported():
    law = Elastic(stiffness_in_newton_per_metre=math.nan)
    result = Simulation(tangential=law, integrator=adaptive(1e-3)).run(scene(), history=True)
    assert result.status is Status.NON_FINITE
