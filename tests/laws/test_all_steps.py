"""All steps at once: springs of a batch, and answers of laws that are no answers."""

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status
from contactlab.contracts import AllStepsResponse, AllStepsTangentialLaw, TangentialResponse
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.impacts import all_steps
from contactlab_laws.march.division import midpoints
from tests.testing.broken_impacts import AllAtOnce


def test_batches_of_one_scaled_contact_are_taken_at_once(monkeypatch):
    """Hertz impacts of any speed are one contact in units of their own; two axes none in Python."""
    law = contactlab.create("tangential.springs", springs=9)
    impact = Scene.nondimensional(psi1=np.array([0.3, 1.2, 3.0]), chi=np.array([1.0, 1.4, 2.0]))
    unlike = attrs.evolve(impact, normal_speed=np.array([0.1, 1.0, 7.0]))
    for scene in (impact, unlike):
        normal = normal_motion(contactlab.create("normal.hertz"), scene)
        response = law.advance_all(scene, normal, midpoints(normal, 20))
        assert response.force.shape == (20, 3)
        assert np.shape(response.friction_work) == (3,)
    grid = Scene.nondimensional(psi1=np.array([[0.3, 1.2, 3.0]]), chi=np.array([[1.0], [1.4]]))
    normal = normal_motion(contactlab.create("normal.hertz"), grid)
    monkeypatch.setenv("CONTACTLAB_COMPILED", "0")
    assert law.advance_all(grid, normal, midpoints(normal, 20)) is None


@pytest.mark.parametrize("name", ["tsuji", "linear", "viscoelastic", "kuwabara_kono"])
@pytest.mark.parametrize("speed", [0.3, np.array([0.3, 4.0])])
def test_steps_in_units_of_their_own_have_the_force_of_the_law(name, speed):
    """Impacts that are one but for their units share samples; the law itself tells the forces."""
    law = contactlab.create(f"normal.{name}", restitution=0.6)
    steel = Material.named("steel")
    scene = Scene(Sphere(0.01, steel), HalfSpace(steel), 0.2, speed, 0.5)
    normal = normal_motion(law, scene)
    for steps in (midpoints(normal, 40, graded=True), midpoints(normal, 40)):
        asked, _ = law.respond(law.start(scene), steps.approach, steps.rate)
        for entry, most in (("force", normal.maximum_force), ("radius", normal.maximum_radius)):
            off = abs(getattr(asked, entry) - getattr(steps.contact, entry))
            assert np.all(off < 1e-5 * np.asarray(most))
        impulse = np.sum(steps.kick * steps.friction_load, axis=0)
        assert impulse == pytest.approx(normal.total_load_impulse, rel=1e-9)
        assert np.sum(steps.kick, axis=0) == pytest.approx(normal.duration, rel=1e-3)


@attrs.frozen(kw_only=True)
class Told(AllStepsTangentialLaw):
    """No friction, unless all steps are taken at once: then what ``answer`` makes of the shape."""

    api_version = 2
    answer = attrs.field()

    def start(self, scene, normal):
        return None

    def advance(self, state, increment, before, after):
        nothing = 0.0 * increment.displacement
        return TangentialResponse(nothing, nothing), state

    def advance_all(self, scene, normal, steps):
        return self.answer((len(steps.drift), *scene.shape))


def _right(shape):
    return AllStepsResponse(np.zeros(shape), np.zeros(shape[1:]) if shape[1:] else 0.0, True)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (lambda shape: _right((shape[0] - 1, *shape[1:])), "forces of shape (29"),
        (lambda shape: _right((shape[0] + 1, *shape[1:])), "forces of shape (31"),
        (lambda shape: _right((*shape, 2))._replace(friction_work=0.0), "forces of shape (30"),
        (lambda shape: _right(shape)._replace(force=[0.0] * shape[0]), "the forces [0.0"),
        (lambda shape: _right(shape)._replace(force=np.zeros(shape, dtype=object)), "the forces"),
        (lambda shape: _right(shape)._replace(friction_work=None), "friction work None"),
        (lambda shape: _right(shape)._replace(friction_work=np.zeros(7)), "friction work array"),
    ],
)
@pytest.mark.parametrize("psi1", [1.2, np.array([0.5, 1.2])])
def test_answers_that_are_none(answer, words, psi1):
    """Of the wrong kind or shape, of one impact or of a batch: a status with a sentence."""
    integrator = contactlab.create("integrator.symplectic", steps=30)
    result = Simulation(tangential=Told(answer=answer), integrator=integrator).run(
        Scene.nondimensional(psi1=psi1, chi=1.4)
    )
    for status, detail in zip(
        np.ravel(result.motion.status), np.ravel(result.motion.detail), strict=True
    ):
        assert status is Status.MALFORMED
        assert words in detail


def test_batches_that_fail_are_tried_one_by_one():
    """A law that answers a batch as if it were one impact costs time, and no answer."""

    def single(shape):
        return _right(shape[:1])

    integrator = contactlab.create("integrator.symplectic", steps=30)
    simulation = Simulation(tangential=Told(answer=single), integrator=integrator)
    result = simulation.run(Scene.nondimensional(psi1=np.array([0.5, 1.2, 2.0]), chi=1.4))
    assert result.check().psi2 == pytest.approx([0.5, 1.2, 2.0])


class OtherwiseInBatches(AllAtOnce):
    """A little weaker where all steps of a batch are taken at once."""

    def told(self, response):
        return response._replace(force=response.force * (0.99 if response.force.ndim > 1 else 1.0))


class HalfTheWorkInBatches(AllAtOnce):
    """Half the friction work where all steps of a batch are taken at once."""

    def told(self, response):
        share = 0.5 if response.force.ndim > 1 else 1.0
        return response._replace(friction_work=share * response.friction_work)


@pytest.mark.parametrize("law", [OtherwiseInBatches, HalfTheWorkInBatches])
def test_the_kit_holds_batches_too(law):
    """A batch that is another at once than step by step is found, in force and in work."""
    all_steps(AllAtOnce())
    with pytest.raises(AssertionError, match=r"A batch of shape \(8,\): differs by"):
        all_steps(law())
