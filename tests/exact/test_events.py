"""Other laws under the event-locating integrator."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, Status
from contactlab.contracts import ClosedPhase, Phase, PhasedTangentialLaw, PhaseResponse
from contactlab.impact.hertz import rigid_body_rebound
from tests.normal_laws import LinearSpring

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


class Nowhere(ClosedPhase):
    """A motion in closed form that ends where it began."""

    def __init__(self, state):
        self.end, self.event = state, 0

    def states(self, contact):
        return np.zeros_like(contact.phase), np.zeros_like(contact.phase)


@attrs.frozen
class Turning(Phase):
    """Phases without force that end at once, so many of them one after another."""

    left: int
    closed: bool

    singular_events = (False,)

    def respond(self, contact, slip, memo):
        return PhaseResponse(0.0 * slip, None, None, ())

    def margin(self, event, sample):
        phase = sample.contact.phase
        return phase[0] - phase if self.left else np.ones_like(phase)

    def after_event(self, event, state, contact, output):
        return Turning(self.left - 1, self.closed)

    def closed_form(self, state, motion, inertia):
        return Nowhere(state) if self.left and self.closed else None


@attrs.frozen(kw_only=True)
class Unfinished(PhasedTangentialLaw):
    """A law whose phase says nothing of its force."""

    api_version: ClassVar[int] = 2

    def begin(self, velocity, inertia, motion):
        return Phase()


def test_a_phase_without_a_force_is_named():
    result = Simulation(tangential=Unfinished(), integrator="events").run(
        Scene.nondimensional(psi1=1.2, chi=CHI)
    )
    assert result.status is Status.LAW_RAISED
    assert "Phase has neither respond nor closed_form" in result.failures[0]


def test_a_phase_with_a_margin_of_no_event_is_refused():
    """Its events would be passed over: the word of an older contract, or a misspelt one."""
    with pytest.raises(TypeError, match="Old: has a margin, and no singular_events"):

        class Old(Phase):
            rough = (False,)

            def margin(self, event, sample):
                return 1.0 - sample.velocity


@attrs.frozen(kw_only=True)
class Turns(PhasedTangentialLaw):
    """No force, after so many phases of no length."""

    api_version: ClassVar[int] = 2
    phases: int
    closed: bool

    def begin(self, velocity, inertia, motion):
        return Turning(self.phases, self.closed)


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("psi1", [1.2, [0.5, 1.2]])
def test_phases_of_no_length_are_followed_but_not_without_end(closed, psi1):
    """A law may take leave of a long history at one point, in up to a hundred phases."""
    scene = Scene.nondimensional(psi1=psi1, chi=CHI)
    some = Simulation(tangential=Turns(phases=100, closed=closed), integrator="events").run(scene)
    assert some.check().psi2 == pytest.approx(np.asarray(psi1), abs=1e-15)
    endless = Turns(phases=101 if np.ndim(psi1) else -1, closed=closed)
    result = Simulation(tangential=endless, integrator="events").run(scene)
    assert {*np.ravel(np.array(result.status, dtype=object))} == {Status.UNRESOLVED}
    assert "Events follow one another without end. In phase Turning" in result.failures[0]


def test_a_normal_law_without_closed_form_does_not_fit():
    with pytest.raises(ValueError, match=r"Events.*ClosedFormNormalLaw.*LinearSpring"):
        Simulation(
            normal=LinearSpring(), tangential=Turns(phases=0, closed=False), integrator="events"
        )


@pytest.mark.parametrize(("psi1", "chi"), [(0.5, CHI), (1.2, CHI), (3.0, CHI), (1.2, 3.0)])
def test_a_history_obeys_newton(psi1, chi):
    """The velocity at each instant is what the force up to then leaves."""
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    course = Simulation().run(scene, history=True).check().history
    means = 0.5 * (course.tangential_force[1:] + course.tangential_force[:-1])
    impulse = np.concatenate(([0.0], np.cumsum(means * np.diff(course.time))))
    velocity = course.slip_velocity[0] - impulse / scene.pair.tangential_mass
    assert course.slip_velocity == pytest.approx(velocity, abs=1e-3 * np.ptp(velocity))
