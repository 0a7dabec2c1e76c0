"""Laws as a stranger writes them from the page of the contract alone: they pass the kit."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import (
    Integrator,
    NormalContact,
    NormalLaw,
    Scene,
    Simulation,
    SteppedTangentialLaw,
    TangentialMotion,
    TangentialResponse,
)
from contactlab.contracts import Increment, Sample, count, faults, quantity
from contactlab.testing import Verdict, check_law


@attrs.frozen(kw_only=True)
class Square(NormalLaw):
    """P = k z², over the radius of elastic spheres, b² = R z."""

    api_version = 2
    offers = frozenset({"radius"})

    stiffness: float = quantity("Pa", default=1e12)

    def start(self, scene):
        return scene.pair.radius

    def respond(self, state, approach, rate):
        inside = approach * (approach > 0.0)
        radius = (state * inside) ** 0.5
        return NormalContact(self.stiffness * inside * inside, radius, approach), state

    def dissipation(self, motion):
        return 0.0


@attrs.frozen(kw_only=True)
class TwoSprings(SteppedTangentialLaw):
    """Two springs side by side, the stiffer held at a smaller share of Coulomb's limit."""

    api_version = 2
    needs = frozenset({"radius"})
    expected_failures: ClassVar = {
        "impact_reference": "two springs are no continuum of springs",
        "cattaneo_mindlin": "two springs are no continuum of springs",
    }

    def start(self, scene, normal):
        return scene.friction_coefficient, self.stiffness(scene, normal), 0.0, 0.0

    def advance(self, state, increment, before, after):
        friction, stiffness, *stretches = state
        force, work, kept = 0.0, 0.0, []
        for share, part, old in zip((0.3, 0.7), (0.6, 0.4), stretches, strict=True):
            limit = share * friction * after.friction_load / (part * stiffness)
            trial = old + increment.displacement
            new = np.minimum(np.maximum(trial, -limit), limit)
            force = force + part * stiffness * new
            work = work + np.maximum(0.5 * part * stiffness * (old + new) * (trial - new), 0.0)
            kept.append(new)
        return TangentialResponse(force, work), (friction, stiffness, *kept)

    def stiffness(self, scene, normal):
        return scene.pair.tangential_stiffness(normal.maximum_radius)


@attrs.frozen(kw_only=True)
class HalfKicks(Integrator):
    """Even steps: drift to the end of a step, and kick for half of it and half of the next."""

    api_version = 2
    needs = frozenset({SteppedTangentialLaw})
    resolution = "steps"

    steps: int = count(default=400, most=100_000)

    def integrate(self, scene, normal, tangential, observer=None):
        shape, status, what, number = scene.shape, contactlab.Status.SUCCESS, "", 1
        phases = np.array(normal.phase(np.linspace(0.0, 1.0, 2 * self.steps + 1)))
        phases[-1] = np.pi
        at = normal.at(phases.reshape(-1, *(1,) * len(shape)))
        change = work = np.zeros(shape) if shape else 0.0
        before = NormalContact(*(each[0] for each in at.contact))
        try:
            state = tangential.start(scene, normal)
            for number in range(1, self.steps + 1):
                here = 2 * number
                after = NormalContact(*(each[here] for each in at.contact))
                left, right = here - 1, min(here + 1, 2 * self.steps)
                kick, drift = at.time[right] - at.time[left], at.time[here] - at.time[here - 2]
                velocity = scene.slip_velocity + change
                load = (at.load_impulse[right] - at.load_impulse[left]) / kick
                step = Increment(velocity * drift, velocity, load, kick, drift)
                answer, state = tangential.advance(state, step, before, after)
                slowed = answer.force * kick / scene.pair.tangential_mass
                if not np.all(answer.settled):
                    status, what = contactlab.Status.UNSETTLED, "it has no answer"
                elif not np.all(np.isfinite(answer.force)):
                    status, what = contactlab.Status.NON_FINITE, f"force {answer.force}"
                if observer is not None:
                    observer(
                        Sample(
                            at.time[here], at.approach[here], at.rate[here], after,
                            velocity - 0.5 * slowed, answer.force,
                            lambda state=state: tangential.fields(state),
                        )
                    )  # fmt: skip
                if what:
                    break
                change, work, before = change - slowed, work + answer.friction_work, after
        except Exception as error:
            status, what = contactlab.Status.LAW_RAISED, faults.tell_error(error)
        return TangentialMotion(
            slip_velocity_change=change,
            friction_work=work,
            status=np.full(shape, status, dtype=object) if shape else status,
            detail=faults.sentence(tangential, what, number) if what else "",
            counters={"steps": number},
        )


@pytest.mark.slow
@pytest.mark.parametrize("law", [Square(), TwoSprings(), HalfKicks()], ids=repr)
def test_a_law_from_the_page_passes_the_kit(law):
    found = {each.check: each.verdict for each in check_law(law)}
    failing = {name for name, verdict in found.items() if verdict is Verdict.EXPECTED_FAILURE}
    assert failing == set(law.expected_failures)
    assert list(found.values()).count(Verdict.PASSED) > 20


def test_three_laws_of_strangers_run_together():
    """Beside a march of contactlab's own, and the closed form of the normal motion."""
    ball = contactlab.Sphere(0.01, contactlab.Material.named("steel"))
    scene = Scene(ball, ball, 0.3, normal_speed=1.0, tangential_velocity=0.4)
    laws = {"normal": Square(), "tangential": TwoSprings()}
    mine = Simulation(**laws, integrator=HalfKicks(steps=2000)).run(scene).check()
    theirs = Simulation(**laws, integrator="symplectic").run(scene).check()
    assert mine.psi2 == pytest.approx(theirs.psi2, abs=1e-3)
    assert mine.normal_restitution == pytest.approx(1.0, abs=1e-6)
    mass, k = scene.pair.normal_mass, Square().stiffness
    deepest = (1.5 * mass * scene.normal_speed**2 / k) ** (1 / 3)
    assert mine.motion.maximum_approach == pytest.approx(deepest, rel=1e-6)
