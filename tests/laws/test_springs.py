"""The spring bundle: right, second order, and the same in every shape."""

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.contracts import Increment, NormalContact, NormalLaw
from tests.laws.exact_laws import CHI, grid, marched_change, rebound, rms, simulation
from tests.laws.reference import TABLE

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


def contact(**options):
    """Return what a law is started with: scene and normal motion."""
    scene = Scene.nondimensional(**({"psi1": 1.2, "chi": CHI} | options))
    return scene, Simulation().normal_motion(scene)


def take(law, at, moves, radii, forces=None):
    """Advance through ``radii`` (with Hertz's forces); return responses and the last state."""
    state, before, responses = law.start(*at), NormalContact(0.0, 0.0, 0.0, 0.0), []
    forces = [radius**3 * 1.25 for radius in radii] if forces is None else forces
    for move, radius, force in zip(moves, radii, forces, strict=True):
        after = NormalContact(force, radius, radius).complete
        increment = Increment(move, move, after.friction_load, 1.0)
        response, state = law.advance(state, increment, before, after)
        responses.append(response)
        before = after
    return responses, state


@pytest.mark.parametrize("chi", [1.4411764706, 1.0, 3.0])
def test_reference_table(chi):
    """Theory §5, at 400 steps and 100 places."""
    psi1, psi2 = np.array([row[1:] for row in TABLE if row[0] == chi]).T
    found = rebound(psi1, chi, "springs", steps=400, springs=100)
    assert found == pytest.approx(psi2, abs=6e-4)


def test_grid_of_all_regimes():
    psi1, chi, psi2 = grid()
    error = rebound(psi1, chi, "springs", steps=400, springs=100) - psi2
    assert np.abs(error).max() < 1e-3
    assert rms(error) < 2.5e-4


def test_a_sweep_at_few_springs():
    """The setting whose cost is reported: rms error below 5e-4."""
    psi1 = (np.arange(250) + 0.5) / 250 * 4.0 * CHI
    scene = Scene.nondimensional(psi1=psi1, chi=CHI)
    exact = Simulation().run(scene).check().psi2
    swept = simulation("springs", steps=80, springs=12).sweep(scene).check().psi2
    assert rms(swept - exact) < 5e-4


def test_a_batch_gives_what_its_impacts_give_one_by_one():
    """Whether normal motions are shared, alike up to scale, or different."""
    sim = simulation("springs", steps=60, springs=20)
    psi1 = np.array([0.01, 0.4, -1.1, 2.5, 4.0, 9.0])
    for chi in (CHI, np.array([0.4, 1.0, 1.4, 2.0, 3.0, 1.4])):
        batch = Scene.nondimensional(psi1=psi1, chi=chi)
        together = sim.run(batch).check()
        apart = [sim.run(batch.take(slice(k, k + 1))).check() for k in range(len(psi1))]
        alone = [
            sim.run(Scene.nondimensional(psi1=p, chi=c)).check()
            for p, c in zip(psi1.tolist(), np.broadcast_to(chi, psi1.shape).tolist(), strict=True)
        ]
        for other in (apart, alone):
            found = np.array([np.ravel(one.psi2)[0] for one in other])
            assert together.psi2 == pytest.approx(found, rel=1e-12, abs=1e-14)
            work = np.array([np.ravel(one.motion.friction_work)[0] for one in other])
            assert together.motion.friction_work == pytest.approx(work, rel=1e-11, abs=1e-14)


def test_a_batch_of_unlike_impacts_in_si_units():
    """Speeds, sizes and friction differ; one without friction, one central."""
    sim = simulation("springs", steps=60, springs=20)
    scenes = [
        Scene(Sphere(radius, STEEL), HalfSpace(STEEL), mu, speed, tangential, spin)
        for radius, mu, speed, tangential, spin in [
            (5e-3, 0.15, 2.0, 0.7, 0.0), (1e-4, 0.6, 0.1, -0.05, 20.0),
            (0.2, 0.0, 1.0, 0.3, 0.0), (0.01, 0.3, 5.0, 0.0, 0.0), (3e-3, 0.3, 1.0, 0.2, -9.0),
        ]
    ]  # fmt: skip
    batch = sim.run(Scene.stack(scenes)).check()
    for k, scene in enumerate(scenes):
        alone = sim.run(scene).check()
        assert batch.rebound_slip_velocity[k] == pytest.approx(
            alone.rebound_slip_velocity, rel=1e-11
        )


@attrs.frozen(kw_only=True)
class OtherHertz(NormalLaw):
    """Hertz's law without its closed form, and with a force of its own at a radius."""

    api_version = 2
    offers = frozenset({"radius"})
    factor: float = 1.0

    def start(self, scene):
        return scene.pair

    def respond(self, state, approach, rate):
        compression = approach * (approach > 0.0)
        radius = (state.radius * compression) ** 0.5
        force = self.factor * (4.0 / 3.0) * state.effective_modulus * radius * compression
        return NormalContact(force, radius, approach), state


def test_any_normal_law_with_a_radius():
    """Under a Hertz law without closed form the answer is the exact one too."""
    sim = attrs.evolve(simulation("springs", steps=400, springs=100), normal=OtherHertz())
    exact = Simulation().run(Scene.nondimensional(psi1=1.2, chi=CHI)).check()
    assert sim.run(Scene.nondimensional(psi1=1.2, chi=CHI)).check().psi2 == pytest.approx(
        exact.psi2, abs=2e-3
    )


def test_unequal_contacts_of_a_batch_away_from_hertz():
    """A batch whose contact radii do not go together takes another path to the same end."""
    sim = attrs.evolve(simulation("springs", steps=80, springs=15), normal=OtherHertz(factor=2.0))
    psi1, chi = np.array([0.3, 1.4, -2.0]), np.array([0.8, 1.4, 2.0])
    scenes = [
        attrs.evolve(Scene.nondimensional(psi1=p, chi=c), normal_speed=v)
        for p, c, v in zip(psi1.tolist(), chi.tolist(), (1.0, 1.3, 0.7), strict=True)
    ]
    batch = sim.run(Scene.stack(scenes)).check()
    for k, scene in enumerate(scenes):
        alone = sim.run(scene).check().psi2
        # The normal motions are solved in steps of their own, to 1e-10 in each of them.
        assert batch.psi2[k] == pytest.approx(alone, abs=1e-8)


@pytest.mark.parametrize("places", [1, 2, 3, 200])
def test_any_number_of_places(places):
    """One or two are coarse, but still friction: |F| <= mu P, and no energy from nothing."""
    sim = simulation("springs", steps=200, springs=places)
    for psi1 in (0.3, 1.2, 3.0):
        result = sim.run(Scene.nondimensional(psi1=psi1, chi=CHI), history=True).check()
        history = result.history
        assert (np.abs(history.tangential_force) <= history.normal_force * (1 + 1e-12)).all()
        assert abs(result.psi2) <= psi1 * (1.0 + 1e-9)
        exact = Simulation().run(Scene.nondimensional(psi1=psi1, chi=CHI)).check().psi2
        assert result.psi2 == pytest.approx(exact, abs=0.5 / places**2 + 2e-3)


@pytest.mark.parametrize("places", [1, 2, 7, 50])
def test_gross_slip_is_exactly_coulomb(places):
    """F = mu P to rounding, in loading and in unloading."""
    radii = [0.1, 0.35, 0.7, 1.0, 0.95, 0.6, 0.52]
    law = contactlab.create("tangential.springs", springs=places)
    responses, _ = take(law, contact(), [9.0] * len(radii), radii)
    for response, radius in zip(responses, radii, strict=True):
        met = radius * places > 0.5  # else no spring is met yet
        assert response.force == pytest.approx(1.25 * radius**3 * met, rel=1e-12)


@pytest.mark.parametrize(("integrator", "tolerance"), [("paper", 1e-9), ("symplectic", 1e-6)])
def test_whole_slip_is_the_closed_form(integrator, tolerance):
    """Eq. (45) in both directions, to the error of the steps."""
    psi1 = np.array([4.0 * CHI - 1.0, -6.0, 50.0, 1e9])
    sim = simulation("springs", integrator, steps=500, springs=10)
    expected = -np.sign(psi1) * 4.0 * CHI
    assert marched_change(sim, psi1, CHI) == pytest.approx(expected, rel=tolerance)


def test_fixed_normal_force_gives_cattaneo_and_mindlin():
    """F = 1 - (1 - xi)^1.5 on loading, and Masing's rule when the motion turns back."""
    law = contactlab.create("tangential.springs", springs=400)
    moves = np.array([0.2, 0.2, 0.2, -0.3, -0.4])
    first, _ = take(law, contact(), [0.0, *moves], [1.0] * 6)
    xi = np.cumsum(moves)
    forth = 1.0 - (1.0 - xi[:3]) ** 1.5
    back = forth[2] - 2.0 * (1.0 - (1.0 - 0.5 * (xi[2] - xi[3:])) ** 1.5)
    found = np.array([response.force for response in first[1:]]) / 1.25
    assert found == pytest.approx(np.concatenate((forth, back)), abs=1e-5)


def test_growing_pressure_alone_makes_no_force():
    law = contactlab.create("tangential.springs", springs=30)
    responses, _ = take(law, contact(), [0.1, 0.0, 0.0], [0.5, 0.7, 1.0])
    assert responses[1].force == pytest.approx(responses[0].force, rel=2e-2)
    assert responses[2].force == pytest.approx(responses[1].force, rel=2e-2)
    nothing, _ = take(law, contact(), [0.0, 0.0, 0.0], [0.5, 0.7, 1.0])
    assert [response.force for response in nothing] == [0.0, 0.0, 0.0]


def test_odd_to_the_last_bit():
    psi1, chi, _ = grid()
    sim = simulation("springs", steps=50, springs=12)
    forth = sim.run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2
    back = sim.run(Scene.nondimensional(psi1=-psi1, chi=chi)).check().psi2
    assert (forth == -back).all()


@pytest.mark.parametrize("shape", [(), (3,)])
def test_nan_gives_nan(shape):
    """Never "no contact", whichever number it is and whether or not there is contact."""
    law = contactlab.create("tangential.springs", springs=10)
    at = contact(psi1=np.full(shape, 1.2) if shape else 1.2)
    for spoilt in range(3):
        for radius in (0.0, 0.6):
            numbers = [np.full(shape, value) if shape else value for value in (0.1, radius, 0.3)]
            numbers[spoilt] = numbers[spoilt] * np.nan
            responses, _ = take(law, at, [numbers[0]], [numbers[1]], [numbers[2]])
            assert np.isnan(responses[0].force).all()


@pytest.mark.parametrize("psi1", [1.2, np.array([0.3, 1.2])])
def test_fields(psi1):
    """Stuck inside, slipping outside, nothing beyond the contact; w follows the limit there."""
    result = simulation("springs", steps=40, springs=25).run(
        Scene.nondimensional(psi1=psi1, chi=CHI), history="fields"
    )
    fields, history = result.check().history.fields, result.history
    assert {field.shape for field in fields.values()} == {(40, *np.shape(psi1), 25)}
    touching = fields["radius"] < np.asarray(history.contact_radius)[..., None]
    assert ((fields["stuck"] | (fields["slipping"] != 0)) == touching).all()
    slips = fields["slipping"] != 0
    held = np.abs(fields["displacement"])
    assert held[slips] == pytest.approx(fields["limit"][slips])
    assert (held[fields["stuck"]] < fields["limit"][fields["stuck"]]).all()
    assert fields["stuck"].any()
    assert (fields["slipping"] > 0).any()
    assert (fields["slipping"] < 0).any()


def test_a_refused_number_of_springs_names_it():
    with pytest.raises(ValueError, match="springs = 0"):
        contactlab.create("tangential.springs", springs=0)
