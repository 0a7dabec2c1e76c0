"""Scaled impacts under the event-locating integrator: units, faults and what observers see."""

import math

import attrs
import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status, create
from contactlab.contracts import LostPathError, PathTangentialLaw, Stretch
from contactlab_laws.events.scaled import solve

STEEL = Material.named("steel")


def impact(slip=-0.15, friction=0.3):
    return Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), friction, 0.7, slip)


SCENE = impact()


@attrs.frozen
class Line(Stretch):
    """A stretch over which the change grows as x, with a force of 1."""

    start: float
    stop: float
    change: float = 0.0
    work: float = 0.0
    solves: int = 7

    def states(self, contact):
        return 0.1 * contact.phase, np.ones_like(contact.phase)

    def fields(self, normal, contact, factor):
        return {"place": np.array([self.stop, contact.phase]), "factor": np.array(factor)}


@attrs.frozen(kw_only=True)
class Given(PathTangentialLaw):
    """A path that is written down; ``fault`` is raised after it."""

    api_version = 2
    stretches: tuple = ()
    fault: Exception | None = None
    linear_below: float = 0.0
    seen: list = attrs.field(factory=list)

    def path(self, velocity, inertia, motion, tolerance):
        self.seen.append((velocity, inertia, tolerance))
        yield from self.stretches
        if self.fault is not None:
            raise self.fault


def normal(scene=SCENE):
    return Simulation().normal_motion(scene)


def test_a_scaled_answer_in_si():
    """The change in mu v1/kappa, the force in mu P_max, the work in both times z_max/v1."""
    motion = normal()
    velocity = 0.15 * SCENE.pair.stiffness_ratio / (0.3 * 0.7)
    inertia = 2.5 * SCENE.chi
    change = -0.4
    work = -change * (velocity + 0.5 * change) / inertia
    law = Given(stretches=(Line(0.0, math.pi, change, work),))
    found = solve(law, motion, 1e-6)
    assert law.seen[0] == pytest.approx((velocity, inertia, 1e-6))
    unit = 0.3 * 0.7 / SCENE.pair.stiffness_ratio
    assert found.motion.status is Status.SUCCESS
    assert found.motion.slip_velocity_change == pytest.approx(0.4 * unit)  # the slip is negative
    limit = 0.3 * motion.maximum_force
    assert found.motion.friction_work == pytest.approx(
        work * unit * limit * motion.maximum_approach / 0.7
    )
    lost = 0.5 * SCENE.pair.tangential_mass * (0.15**2 - (0.15 - 0.4 * unit) ** 2)
    assert found.motion.friction_work == pytest.approx(lost)
    assert (found.velocity_unit, found.force_unit) == pytest.approx((-unit, -limit))
    assert found.motion.counters == {"panels": 1, "solves": 7}
    assert found.factor == -1.0


def test_small_velocities_are_scaled_where_a_law_is_linear():
    law = Given(stretches=(Line(0.0, math.pi),), linear_below=0.5)
    slow = impact(0.05)
    velocity = 0.05 * SCENE.pair.stiffness_ratio / 0.21
    found = solve(law, normal(slow), 1e-6)
    assert law.seen[0][0] == 0.5
    assert found.factor == pytest.approx(velocity / 0.5)
    assert found.velocity_unit == pytest.approx(velocity / 0.5 * 0.21 / SCENE.pair.stiffness_ratio)
    assert solve(attrs.evolve(law, linear_below=0.1), normal(slow), 1e-6).factor == 1.0
    assert law.seen[1][0] == pytest.approx(velocity)


@pytest.mark.parametrize("changed", [{"slip": 0.0}, {"friction": 0.0}])
def test_where_nothing_moves_or_nothing_resists_no_path_is_asked_for(changed):
    law = Given()
    scene = impact(**changed)
    found = solve(law, normal(scene), 1e-6)
    assert found.motion.status is Status.SUCCESS
    assert (found.motion.slip_velocity_change, found.motion.friction_work) == (0.0, 0.0)
    assert found.motion.counters == {"panels": 0, "solves": 0}
    assert law.seen == []
    samples = []
    create("integrator.events").integrate(normal(scene), law, scene, samples.append)
    assert len(samples) == 201
    assert samples[100].fields() == {}
    assert [sample.tangential_force for sample in samples] == [0.0] * 201


@pytest.mark.parametrize(
    ("law", "status", "sentence"),
    [
        (Given(), Status.UNRESOLVED, "At step 1: the path ends before contact does, at x = 0"),
        (
            Given(stretches=(Line(0.0, 1.0), Line(1.0, math.nan))),
            Status.NON_FINITE,
            "At step 2: velocity, work or x is not finite, at x = 1",
        ),
        (
            Given(stretches=(Line(0.0, math.pi, math.inf),)),
            Status.NON_FINITE,
            "At step 1: velocity, work or x is not finite, at x = 0",
        ),
        (
            Given(stretches=(Line(0.0, 1.0),), fault=LostPathError("gone")),
            Status.UNRESOLVED,
            "At step 2: gone, at x = 1",
        ),
        (
            Given(stretches=(Line(0.0, 1.0),), fault=ValueError("bad")),
            Status.LAW_RAISED,
            "ValueError: bad",
        ),
        (
            Given(stretches=(Line(0.0, math.pi, 0.0, 1e-3),)),
            Status.UNRESOLVED,
            "the energy books miss ",
        ),
    ],
)
def test_a_path_that_fails_is_told_with_its_place(law, status, sentence):
    found = solve(law, normal(), 1e-6).motion
    assert found.status is status
    assert sentence in found.detail
    assert "from Given" in found.detail
    assert np.isnan([found.slip_velocity_change, found.friction_work]).all()


@pytest.mark.parametrize("batch", [False, True])
def test_what_an_observer_sees(batch):
    """Stretches meet at x = 1; a single impact shows that instant besides the even ones."""
    law = Given(stretches=(Line(0.0, 1.0), Line(1.0, math.pi)))
    slips = np.array([-0.15, 0.3]) if batch else -0.15
    scene = impact(slips)
    samples = []
    create("integrator.events").integrate(normal(scene), law, scene, samples.append)
    assert len(samples) == (201 if batch else 202)
    x = np.linspace(0.0, math.pi, 201)
    if not batch:
        x = np.sort([*x, 1.0])
    unit = 0.21 / SCENE.pair.stiffness_ratio
    sign = np.array([-1.0, 1.0]) if batch else -1.0
    known = normal(scene).at(x[:, None] if batch else x)
    for k in (0, 50, 64, 120, 200):
        sample = samples[k]
        assert sample.time == pytest.approx(known.time[k] + 0.0 * slips)
        assert sample.approach == pytest.approx(known.approach[k] + 0.0 * slips)
        assert sample.normal_velocity == pytest.approx(known.rate[k] + 0.0 * slips)
        assert sample.contact.force == pytest.approx(known.contact.force[k] + 0.0 * slips)
        assert sample.contact.radius == pytest.approx(known.contact.radius[k] + 0.0 * slips)
        assert sample.slip_velocity == pytest.approx(slips + sign * unit * 0.1 * x[k])
        limit = 0.3 * normal().maximum_force
        assert sample.tangential_force == pytest.approx(sign * limit)
        fields = sample.fields()
        stop = 1.0 if x[k] <= 1.0 else math.pi
        place = np.array([stop, x[k]])
        assert fields["place"] == pytest.approx(np.array([place, place]) if batch else place)
        assert fields["factor"] == pytest.approx(sign)


def test_the_error_aimed_at_is_of_the_larger_of_one_and_psi1():
    """And the law's own beside it."""

    class Rough(Given):
        def psi2_error(self, scene, normal, steps):
            assert steps == math.inf
            return 0.5

    scene = Scene.nondimensional(psi1=np.array([0.5, -3.0]), chi=1.2)
    march = create("integrator.events", tolerance=1e-4)
    assert march.psi2_error(normal(scene), Rough(), scene) == pytest.approx([0.5001, 0.5003])
