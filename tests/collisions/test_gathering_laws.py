"""Laws in a gathering as they are: strangers' that pass the kit, and every one that is built in."""

from typing import ClassVar, NamedTuple

import attrs
import numpy as np
import pytest

from contactlab import (
    Body,
    Encounter,
    Gathering,
    NormalContact,
    NormalLaw,
    RigidBody,
    Simulation,
    Sphere,
    Touch,
    collide,
    create,
)
from contactlab.contracts import CausalTangentialLaw, TangentialResponse
from contactlab.contracts.law import claims
from contactlab.contracts.status import Status
from contactlab.numeric.checks import NON_NEGATIVE, POSITIVE, quantity
from contactlab.registry.registry import REGISTRY
from contactlab.testing import check_law
from tests.collisions.gathered import STEEL, laws, row
from tests.laws.outside_laws import Plastic
from tests.longer import longer


@attrs.frozen(kw_only=True)
class Foam(NormalLaw):
    """P = k z² (1 + c z'), a force of a user's own without memory, that never pulls."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius"})

    damping: float = quantity("s/m", rule=NON_NEGATIVE, default=0.2)

    def start(self, scene):
        return 0.1 * scene.pair.effective_modulus, scene.pair.radius

    def respond(self, state, approach, rate):
        stiffness, radius = state
        inside = approach * (approach > 0.0)
        force = stiffness * inside * inside * (1.0 + self.damping * rate)
        force = force * (force > 0.0)
        return NormalContact(force, (radius * inside) ** 0.5, approach, force), state


class Stretched(NamedTuple):
    """Stiffness of a spring in N/m, mu, and the forces of two springs, shape (..., 2) each."""

    stiffness: object
    friction: object
    first: object
    second: object


@attrs.frozen(kw_only=True)
class TwoSprings(CausalTangentialLaw):
    """Two springs side by side; one slips at ``share`` of the limit, the other at the rest."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"vectors"})

    share: float = quantity("1", rule=POSITIVE, default=0.3)

    def stiffness(self, scene, normal):
        frequency = scene.normal_speed / normal.maximum_approach
        return 0.8 * scene.pair.normal_mass * frequency * frequency

    def start(self, scene, normal):
        return self.begin(scene, normal)

    def begin(self, scene, normal, *, vectors=False):
        zero = np.zeros((*scene.shape, 2)) if vectors else np.zeros(scene.shape)[()]
        stiffness = 0.5 * np.asarray(self.stiffness(scene, normal))
        friction = np.asarray(scene.friction_coefficient)
        if vectors:
            stiffness, friction = stiffness[..., None], friction[..., None]
        return Stretched(stiffness, friction, zero, zero)

    def advance(self, state, increment, before, after):
        load = np.asarray(after.friction_load)
        if np.ndim(state.first) > load.ndim:
            load = load[..., None]
        moved, work, forces = np.asarray(increment.displacement), 0.0, []
        for held, share in ((state.first, self.share), (state.second, 1.0 - self.share)):
            trial = held + state.stiffness * moved
            size = abs(trial)
            if np.ndim(state.first) > np.ndim(after.friction_load):
                size = np.linalg.norm(trial, axis=-1, keepdims=True)
            most = share * state.friction * load
            force = trial * np.minimum(1.0, most / (size + (size == 0.0)))
            lost = 0.5 * (held + force) * (trial - force) / state.stiffness
            if np.ndim(state.first) > np.ndim(after.friction_load):
                lost = lost.sum(axis=-1)
            work = work + np.maximum(lost, 0.0)
            forces.append(force)
        whole = forces[0] + forces[1]
        if not np.ndim(whole):
            whole, work = float(whole), float(work)
        return TangentialResponse(whole, work), Stretched(*state[:2], *forces)


STRANGERS = {"foam": Foam(), "plastic": Plastic(), "two springs": TwoSprings()}
STEPS = create("integrator.symplectic", steps=200)


def _simulation(law, steps=STEPS):
    """Return a stranger's law in even steps beside a law of the house."""
    if isinstance(law, NormalLaw):
        springs = create("tangential.springs", springs=12)
        return Simulation(normal=law, tangential=springs, integrator=steps)
    return Simulation(tangential=law, integrator=STEPS)


@pytest.mark.slow
@pytest.mark.parametrize("name", STRANGERS)
def test_the_kit_passes_what_strangers_wrote(name):
    check_law(STRANGERS[name])  # it raises where a check fails


@pytest.mark.parametrize("name", ["two springs", *longer("foam", "plastic")])
def test_a_strangers_law_runs_unchanged(name):
    simulation = _simulation(STRANGERS[name])
    given = row(4, mu=0.2, gaps=[0.0, 2e-6, 0.0], spin=80.0)
    hit = collide(given, simulation)
    assert hit.status is Status.SUCCESS
    np.testing.assert_allclose(hit.velocity.sum(axis=0), [1, 0, 0], atol=1e-13)
    assert hit.energy.end < hit.energy.start
    assert abs(hit.energy.relative_imbalance) < 2e-3
    turned = [
        attrs.evolve(each, first=each.second, second=each.first, normal=-each.normal)
        for each in reversed(given.touches)
    ]
    other = collide(Gathering(given.bodies, turned), simulation)
    np.testing.assert_allclose(other.velocity, hit.velocity, atol=1e-12)


@attrs.frozen(kw_only=True)
class Mistaken(TwoSprings):
    """The same springs; friction makes energy, and as much is lost in shear: the books balance."""

    def advance(self, state, increment, before, after):
        told, state = super().advance(state, increment, before, after)
        return TangentialResponse(
            told.force, -told.friction_work, shear_loss=2.0 * told.friction_work
        ), state


def test_friction_that_makes_energy_is_told_of_a_gathering_as_of_an_encounter():
    simulation, given = _simulation(Mistaken()), row(3, mu=0.2, spin=80.0)
    hit = collide(given, simulation)
    assert hit.status is Status.UNBALANCED
    assert np.isnan(hit.velocity).all()
    alone = collide(given.alone(0), simulation)
    for told in (hit, alone):
        assert "The friction work is -" in str(told.failures)


@attrs.frozen(kw_only=True)
class Counted(TwoSprings):
    """The same springs, whose friction work is told as half as much again."""

    def advance(self, state, increment, before, after):
        told, state = super().advance(state, increment, before, after)
        return TangentialResponse(told.force, 1.5 * told.friction_work), state


@pytest.mark.parametrize("count", [2, 3])
def test_books_of_a_gathering_that_nobody_declared_are_told_with_their_size(count):
    given = row(count, mu=0.2, spin=80.0)
    true = collide(given, _simulation(TwoSprings())).energy
    cautions = collide(given, _simulation(Counted())).cautions
    (told,) = [text for text in cautions if "energy balance" in text]
    assert f"off by {0.5 * true.friction_work / true.start:.2g} of the energy at the start" in told


@attrs.frozen(kw_only=True)
class Eager(Foam):
    """Foam without loss; from its second touch on it pushes harder as it parts."""

    damping: float = 0.0

    def start(self, scene):
        return super().start(scene), np.zeros(scene.shape), np.zeros(scene.shape)

    def respond(self, state, approach, rate):
        numbers, pressed, parted = state
        contact, _ = super().respond(numbers, approach, rate)
        parted = np.maximum(parted, (pressed > 0.0) & (approach <= 0.0))
        pressed = np.maximum(pressed, approach > 0.0)
        force = contact.force * (1.0 + 0.3 * parted * (rate < 0.0))
        force = force if np.ndim(force) else float(force)
        return contact._replace(force=force, friction_load=force), (numbers, pressed, parted)


def test_pressure_that_makes_less_energy_than_friction_takes_is_told_of_a_gathering():
    """Alone the law is sound; between two heavier balls one touches twice, and some is made."""
    heavy, light = Sphere(0.02, STEEL), Sphere(0.016, STEEL)
    bodies = [Body(heavy, velocity=[1, 0, 0], spin=[0, 0, 40.0]), Body(light), Body(heavy)]
    touches = [Touch(k, k + 1, 0.3, normal=[1, 0, 0], gap=1e-3 * k) for k in (0, 1)]
    given, steps = Gathering(bodies, touches), create("integrator.symplectic", steps=50)
    simulation = _simulation(Eager(), steps)
    assert collide(given.alone(0), simulation).status is Status.SUCCESS
    hit = collide(given, simulation)
    assert hit.status is Status.UNBALANCED
    assert "The normal force makes 0.085 of the energy at the start." in hit.failures[0]


@pytest.mark.parametrize("name", STRANGERS)
def test_one_contact_of_a_strangers_law_is_its_encounter(name):
    simulation, ball = _simulation(STRANGERS[name]), Sphere(0.01, STEEL)
    other = Sphere(0.03, STEEL)
    moves = {"velocity": [1.0, 0.3, -0.1], "spin": [0.0, 60.0, 40.0]}
    hit = collide(
        Gathering([Body(ball, **moves), Body(other)], [Touch(0, 1, 0.2, normal=[1, 0, 0])]),
        simulation,
    )
    alone = collide(Encounter(ball, other, 0.2, normal=[1, 0, 0], **moves), simulation)
    np.testing.assert_allclose(hit.velocity[0], alone.velocity, atol=2e-4)
    np.testing.assert_allclose(hit.velocity[1], alone.target_velocity, atol=2e-4)


def _answers_several(name):
    """Return whether a law is causal and takes vectors."""
    law = create(name)
    return isinstance(law, CausalTangentialLaw) and "vectors" in claims(law)


@pytest.mark.parametrize("name", [each for each in REGISTRY.names("tangential") if ":" not in each])
def test_every_friction_law_runs_as_it_is_or_is_refused(name):
    given = row(3, mu=0.2, gaps=[0.0, 2e-6], spin=80.0)
    if not _answers_several(name):
        with pytest.raises(ValueError, match="several contacts act at once"):
            collide(given, Simulation(tangential=name))
        return
    hit = collide(given, Simulation(tangential=name, integrator="symplectic"))
    assert hit.status is Status.SUCCESS
    np.testing.assert_allclose(hit.velocity.sum(axis=0), [1, 0, 0], atol=1e-14)
    assert abs(hit.energy.relative_imbalance) < 5e-3  # a cap that shrinks has books of its own


@pytest.mark.slow
@pytest.mark.parametrize("name", [each for each in REGISTRY.names("normal") if ":" not in each])
def test_every_normal_law_runs(name):
    simulation = Simulation(normal=name, tangential="springs", integrator="symplectic")
    hit = collide(row(3, mu=0.1, spin=20.0), simulation)
    assert hit.status in (Status.SUCCESS, Status.NOT_SEPARATED)
    if hit.status is Status.SUCCESS:
        np.testing.assert_allclose(hit.velocity.sum(axis=0), [1, 0, 0], atol=1e-14)
        assert hit.energy.end <= hit.energy.start * (1.0 + 1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("friction", ["springs", "linear_spring", "mindlin_cap"])
@pytest.mark.parametrize("name", [each for each in REGISTRY.names("normal") if ":" not in each])
def test_one_contact_is_its_encounter_under_every_law(name, friction):
    steps = create("integrator.symplectic", steps=60)
    simulation = Simulation(normal=name, tangential=friction, integrator=steps)
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    body = RigidBody(
        mass=1.0, principal=[1e-3, 1.2e-3, 8e-4], axes=turn, material=STEEL, curvature_radius=0.02
    )
    ball, arm = Sphere(0.03, STEEL), [0.01, 0.02, -0.015]
    moves = {"velocity": [3.0, 0.3, -0.1], "spin": [0.0, 6.0, 4.0]}
    touch = Touch(0, 1, 0.2, normal=[1, 0, 0], contact=arm)
    hit = collide(Gathering([Body(body, **moves), Body(ball)], [touch]), simulation)
    alone = collide(
        Encounter(body, ball, 0.2, normal=[1, 0, 0], contact=arm, **moves), simulation
    ).check()
    np.testing.assert_allclose(hit.velocity[0], alone.velocity, atol=3e-13)
    np.testing.assert_allclose(0.03 * hit.spin[1], 0.03 * alone.target_spin, atol=3e-13)
    for entry in ("friction_work", "normal_loss", "shear_loss"):
        one, other = getattr(hit.energy, entry), getattr(alone.energy, entry)
        assert one == pytest.approx(other, abs=1e-12)


def test_restitutions_of_contacts_are_those_of_a_law_that_has_one_for_each():
    usual = {
        "tangential": create("tangential.springs", springs=12),
        "integrator": create("integrator.symplectic", steps=50),
    }
    e = [1.0, 0.9, 0.6]
    hit = collide(row(4, mu=0.1, e=e), Simulation(**usual))
    law = create("normal.viscoelastic", restitution=e)
    other = collide(row(4, mu=0.1), Simulation(normal=law, **usual))
    assert other.velocity.tobytes() == hit.velocity.tobytes()
    elastic = collide(row(4, mu=0.1), laws(12, 50))
    assert np.abs(hit.velocity - elastic.velocity).max() > 0.1
