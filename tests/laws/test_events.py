"""Other laws under the event-locating integrator."""

import math
from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, Status
from contactlab.contracts import LostPathError, PathTangentialLaw, Stretch
from contactlab.impact.hertz import rigid_body_rebound
from tests.laws.normal_laws import LinearSpring

CHI = 1.4411764706


@pytest.mark.parametrize("chi", [0.3, 1.0, CHI, 8.0])
@pytest.mark.parametrize("share", [-2.0, -0.5, 1e-9, 0.1, 0.25, 0.999999, 1.0, 1.000001, 3.0])
def test_rigid_coulomb_is_exact(share, chi):
    """psi2 = 0 below 4 chi, psi1 - 4 chi above: to rounding, since slip's end is located."""
    psi1 = share * 4.0 * chi
    result = Simulation(tangential="coulomb", integrator="events").run(
        Scene.nondimensional(psi1=psi1, chi=chi), history=True
    )
    assert result.check().psi2 == pytest.approx(rigid_body_rebound(psi1, chi), abs=1e-11)
    assert abs(result.energy.relative_imbalance) < 1e-11


def test_sliding_stops_at_its_instant():
    """Slip ends where mu times the normal impulse has taken all of psi1: 2 chi (1 - V) = psi1."""
    result = Simulation(tangential="coulomb", integrator="events").run(
        Scene.nondimensional(psi1=2.0, chi=CHI), history=True
    )
    history = result.history
    rolling = np.abs(history.slip_velocity) < 1e-12
    ended = 1.0 - 2.0 / (2.0 * CHI)
    assert (rolling == (history.normal_velocity <= ended)).all()
    assert 20 < rolling.sum() < len(rolling) - 20
    assert (history.tangential_force[rolling] == 0.0).all()
    sliding = history.tangential_force[~rolling]
    assert sliding == pytest.approx(history.normal_force[~rolling], rel=1e-12)
    gone = 2.0 - 2.0 * CHI * (1.0 - history.normal_velocity[~rolling])
    assert history.slip_velocity[~rolling] == pytest.approx(gone, abs=1e-12)


def test_laws_of_whole_impacts_fit_every_integrator():
    scene = Scene.nondimensional(psi1=2.0, chi=CHI)
    values = [
        Simulation(tangential="coulomb", integrator=name).run(scene).check().psi2
        for name in ("events", "paper", "symplectic")
    ]
    assert values == pytest.approx([0.0, 0.0, 0.0], abs=1e-11)


def test_frictionless_under_events():
    result = Simulation(tangential="frictionless", integrator="events").run(
        Scene.nondimensional(psi1=2.0, chi=CHI), history=True
    )
    assert result.check().psi2 == 2.0


@attrs.frozen
class Free(Stretch):
    """A stretch without force."""

    start: float
    stop: float
    change: float = 0.0
    work: float = 0.0

    def states(self, contact):
        return 0.0 * contact.force, 0.0 * contact.force


@attrs.frozen(kw_only=True)
class Turns(PathTangentialLaw):
    """No force, after so many stretches of no length; ends at ``end``."""

    api_version: ClassVar[int] = 2
    turns: int
    end: float = math.pi

    def path(self, velocity, inertia, motion, tolerance):
        for _ in range(self.turns):
            yield Free(0.0, 0.0)
        yield Free(0.0, self.end)


@attrs.frozen(kw_only=True)
class Lost(PathTangentialLaw):
    """A law that loses its way at x = 1, or whose books miss."""

    api_version: ClassVar[int] = 2
    work: float = 0.0

    def path(self, velocity, inertia, motion, tolerance):
        yield Free(0.0, 1.0)
        if not self.work:
            raise LostPathError("the way is lost")
        yield Free(1.0, math.pi, 0.0, self.work)


@pytest.mark.parametrize("psi1", [1.2, [0.5, 1.2]])
def test_stretches_of_no_length_are_followed_but_not_without_end(psi1):
    """A law may take leave of a long history at one point, in up to a hundred stretches."""
    scene = Scene.nondimensional(psi1=psi1, chi=CHI)
    some = Simulation(tangential=Turns(turns=100), integrator="events").run(scene)
    assert some.check().psi2 == pytest.approx(np.asarray(psi1), abs=1e-15)
    result = Simulation(tangential=Turns(turns=101), integrator="events").run(scene)
    assert {*np.ravel(np.array(result.status, dtype=object))} == {Status.UNRESOLVED}
    assert "events follow one another without end" in result.failures[0]


@pytest.mark.parametrize(
    ("law", "sentence"),
    [
        (Turns(turns=0, end=3.0), "the path ends before contact does, at x = 3, from Turns"),
        (Lost(), "the way is lost, at x = 1, from Lost"),
        (Lost(work=0.1), "the energy books miss 5.0e-01 of the tangential energy"),
    ],
)
def test_a_path_that_does_not_arrive_or_add_up_is_no_answer(law, sentence):
    scene = Scene.nondimensional(psi1=1.2, chi=CHI)
    result = Simulation(tangential=law, integrator="events").run(scene, history=True)
    assert result.status is Status.UNRESOLVED
    assert sentence in result.failures[0]
    assert np.isnan(result.psi2)
    assert len(result.history.time) > 10


def test_a_normal_law_without_closed_form_does_not_fit():
    with pytest.raises(ValueError, match="closed form, and LinearSpring is not one"):
        Simulation(normal=LinearSpring(), tangential=Turns(turns=0), integrator="events")


@pytest.mark.parametrize(("psi1", "chi"), [(0.5, CHI), (1.2, CHI), (3.0, CHI), (1.2, 3.0)])
def test_a_history_obeys_newton(psi1, chi):
    """The velocity at each instant is what the force up to then leaves."""
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    course = Simulation().run(scene, history=True).check().history
    means = 0.5 * (course.tangential_force[1:] + course.tangential_force[:-1])
    impulse = np.concatenate(([0.0], np.cumsum(means * np.diff(course.time))))
    velocity = course.slip_velocity[0] - impulse / scene.pair.tangential_mass
    assert course.slip_velocity == pytest.approx(velocity, abs=1e-3 * np.ptp(velocity))
