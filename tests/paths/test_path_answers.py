"""Prescribed paths by hand: the work of a spring, times of points, and what laws do wrong."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab import HalfSpace, ImpactError, Material, Scene, Sphere, Status, create, load_path
from contactlab.contracts import NormalContact, SteppedTangentialLaw, TangentialResponse
from contactlab.impact.hertz import hertz_scales
from tests.laws.normal_laws import LinearSpring

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
SCENE = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.3, normal_speed=1.0)
BATCH = Scene(SCENE.sphere, SCENE.target, np.array([0.3, 0.7]), normal_speed=1.0)
DEPTH = np.array([1e-6, 2e-6, 2e-6, 1e-6])
MOVED = np.array([5e-6, 6e-6, 8e-6, 7e-6])
FIRM = LinearSpring(stiffness=1e7)


@attrs.frozen(kw_only=True)
class Spring(SteppedTangentialLaw):
    """F = 1e6 N/m times the displacement since first touch; fails as told at a step."""

    api_version: ClassVar[int] = 2
    fault: str = ""
    at: int = 3

    def start(self, scene, normal):
        return 0, 0.0

    def advance(self, state, increment, before, after):
        step, moved = state[0] + 1, state[1] + increment.displacement
        force, work, settled = 1e6 * moved, 0.0 * moved + 2.0, True
        if step == self.at:
            force = {"nan": force * np.nan, "word": "1"}.get(self.fault, force)
            work = work * np.inf if self.fault == "work" else work
            settled = np.asarray(moved > np.inf) if self.fault == "unsettled" else True
        return TangentialResponse(force, work, settled), (step, moved)

    def fields(self, state):
        return {"moved": np.asarray(state[1])}


def path(scene=SCENE, law=None, normal=FIRM, **options):
    return load_path(scene, DEPTH, MOVED, normal=normal, tangential=law or Spring(), **options)


@pytest.mark.parametrize("scene", [SCENE, BATCH])
def test_a_spring_has_half_its_force_times_its_stretch_as_work(scene):
    """The surfaces touch without traction at the first point: 0, 1, 3 and 2 µm."""
    made = path(scene).check()
    stretch, tail = np.array([0.0, 1e-6, 3e-6, 2e-6]), scene.shape

    def spread(column):
        return np.broadcast_to(column.reshape(4, *(1 for _ in tail)), (4, *tail))

    assert made.friction_force == pytest.approx(spread(1e6 * stretch), abs=1e-12)
    assert made.work == pytest.approx(spread(0.5e6 * stretch**2), rel=1e-12, abs=1e-24)
    assert made.friction_work == pytest.approx(spread(np.array([2.0, 4.0, 6.0, 8.0])))
    assert made.normal_force == pytest.approx(spread(1e7 * DEPTH))
    assert made.friction_load == pytest.approx(made.normal_force)
    assert not made.contact_radius.any()
    assert made.fields["moved"].reshape(4, -1)[:, 0] == pytest.approx(stretch, abs=1e-18)
    assert np.array_equal(made.approach, spread(DEPTH))
    assert np.array_equal(made.displacement, spread(MOVED))
    assert repr(made) == f"LoadPath(4 points, shape {tail}; LinearSpring, Spring; SUCCESS)"
    for name in ("time", "approach", "friction_force"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(made, name)[0] = 1.0


def test_times_of_the_points():
    duration = float(hertz_scales(SCENE).duration)
    assert path().time == pytest.approx(1e12 * duration * np.arange(1, 5), rel=1e-12)
    assert path(BATCH).time.shape == (4, 2)
    given = np.array([2.0, 3.0, 5.0, 6.0])
    assert path(time=given).time == pytest.approx(given)
    one = load_path(SCENE, [1e-6], [0.0], time=[2.0], normal=FIRM, tangential=Spring())
    assert one.time == pytest.approx([2.0])


@attrs.frozen(kw_only=True)
class Dashpot(LinearSpring):
    """P = k z + c z' with c = 1 N s/m: shows the rate."""

    def respond(self, state, approach, rate):
        contact, state = super().respond(state, approach, rate)
        return contact._replace(force=contact.force + rate), state


def test_rates_are_differences_over_the_times():
    """The first point is pressed as slowly as the path goes on: 1 µm in a second."""
    made = path(normal=Dashpot(stiffness=1e-30), time=[2.0, 3.0, 5.0, 5.5])
    assert made.normal_force == pytest.approx([1e-6, 1e-6, 0.0, -2e-6], abs=1e-20)
    once = load_path(SCENE, [1e-6], [0.0], time=[2.0], normal=Dashpot(stiffness=1e-30),
                     tangential=Spring())  # fmt: skip
    assert once.normal_force == pytest.approx([1e-6 / float(hertz_scales(SCENE).duration)])


DIVISION = "At step 3: no division into stick and slip found, from Spring"


@pytest.mark.parametrize("scene", [SCENE, BATCH])
@pytest.mark.parametrize(
    ("fault", "status", "words"),
    [
        ("nan", Status.NON_FINITE, "At step 3: a force that is not finite, from Spring"),
        ("work", Status.NON_FINITE, "At step 3: a force that is not finite, from Spring"),
        (
            "unsettled",
            Status.UNSETTLED,
            DIVISION,
        ),
    ],
)
def test_after_a_failure_there_are_no_numbers(scene, fault, status, words):
    made = path(scene, Spring(fault=fault))
    assert np.ravel(np.array(made.status, dtype=object)).tolist() == [status] * (made.time[0].size)
    words = f"{words} in {__name__}."
    assert made.detail == words
    for name in ("normal_force", "friction_force", "friction_work", "contact_radius"):
        known = np.isfinite(getattr(made, name)).reshape(4, -1)
        assert known.all(axis=1).tolist() == [True, True, False, False], name
    with pytest.raises(ImpactError) as caught:
        made.check()
    assert str(caught.value) == "impact 0: " * bool(scene.shape) + f"{status.value} {words}"
    assert caught.value.status is status


def test_an_answer_that_is_no_number_is_named():
    made = path(law=Spring(fault="word", at=2))
    assert made.status is Status.MALFORMED
    assert made.detail == f"At step 2: the answer '1', from Spring in {__name__}."
    assert np.isnan(made.friction_force).all()
    assert made.fields == {}
    assert repr(made).endswith("; LinearSpring, Spring; MALFORMED)")


@attrs.frozen(kw_only=True)
class Torn(LinearSpring):
    """A spring without an answer from 1.5 µm on."""

    def respond(self, state, approach, rate):
        contact, state = super().respond(state, approach, rate)
        gone = np.where(np.asarray(approach) > 1.5e-6, np.nan, 0.0)
        force = contact.force + (float(gone) if np.ndim(approach) == 0 else gone)
        return NormalContact(force, 0.0 * force, approach), state


@attrs.frozen(kw_only=True)
class Wrong(LinearSpring):
    """A spring that answers three forces, or whose friction load is no number."""

    load: bool = False

    def respond(self, state, approach, rate):
        contact, state = super().respond(state, approach, rate)
        force = contact.force if self.load else np.ones(3)
        return NormalContact(force, contact.radius, approach, contact.force + np.nan), state


@pytest.mark.parametrize(
    ("load", "status", "words"),
    [
        (False, Status.MALFORMED, "the answer array([1., 1., 1.])"),
        (True, Status.NON_FINITE, "a contact that is not finite"),
    ],
)
def test_a_wrong_answer_of_a_normal_law_is_its_own(load, status, words):
    made = path(normal=Wrong(stiffness=1e7, load=load))
    assert made.status is status
    assert made.detail == f"At step 1: {words}, from Wrong in {__name__}."


def test_the_first_law_that_fails_is_blamed():
    made = path(law=Spring(fault="unsettled"), normal=Torn(stiffness=1e7))
    assert made.status is Status.NON_FINITE
    assert made.detail == f"At step 2: a contact that is not finite, from Torn in {__name__}."
    assert np.isfinite(made.friction_work).tolist() == [True, False, False, False]


@attrs.frozen(kw_only=True)
class Choosy(Spring):
    """A law that runs no scene."""

    def accept(self, scene):
        raise ValueError("scene: not this one")


@attrs.frozen(kw_only=True)
class Picky(LinearSpring):
    """A normal law that runs no scene."""

    def accept(self, scene):
        raise ValueError("scene: nor this one")


def test_a_law_of_either_kind_may_refuse_the_scene():
    with pytest.raises(ValueError, match="not this one"):
        path(law=Choosy())
    with pytest.raises(ValueError, match="nor this one"):
        path(normal=Picky())


def test_a_path_of_one_point_has_its_fields():
    path = load_path(SCENE, [1e-6], [0.0], tangential=create("tangential.springs", springs=5))
    shapes = {name: values.shape for name, values in path.fields.items()}
    assert shapes == dict.fromkeys(("radius", "displacement", "limit", "stuck", "slipping"), (1, 5))
