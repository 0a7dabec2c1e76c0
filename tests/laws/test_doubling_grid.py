"""Springs on a doubling grid (theory §13): accuracy, memory, limits, nothing of the future."""

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.contracts import Increment, NormalContact

#: Sizes of the largest contact between two doublings: A jumps at powers of two of the radius.
SIZES = 2.0 ** np.linspace(0.0, 1.0, 10, endpoint=False)
CHI = 49.0 / 34.0


def doubling(springs):
    return contactlab.create("tangential.springs", springs=springs, grid="doubling")


def marched(springs, steps):
    march = contactlab.create("integrator.symplectic", steps=steps)
    return Simulation(tangential=doubling(springs), integrator=march)


def errors(springs, steps, chi, angles=40):
    """Errors of psi2, shape (sizes, angles), over sizes of the largest contact."""
    psi1 = np.linspace(0.02, 4.0 * chi + 0.3, angles)
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    quicker = SIZES[:, None] ** 2.5 * np.ones(angles)  # Hertz's radius goes as v1^(2/5)
    scene = attrs.evolve(
        scene,
        normal_speed=scene.normal_speed * quicker,
        tangential_velocity=scene.tangential_velocity * quicker,
    )
    radius = Simulation().normal_motion(scene).maximum_radius[:, 0]
    assert radius / radius[0] == pytest.approx(SIZES)
    return marched(springs, steps).run(scene).check().psi2 - contactlab.rebound(psi1, chi)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def take(law, moves, radii, loads=None, scene=None, state=None):
    """Forces along displacements, radii and loads (Hertz's by default), and the last state."""
    scene = Scene.nondimensional(psi1=1.2, chi=CHI) if scene is None else scene
    if state is None:
        state = law.start(scene, Simulation().normal_motion(scene))
    pair, forces, works = scene.pair, [], []
    if loads is None:
        stiffness = (4.0 / 3.0) * pair.effective_modulus / pair.radius
        loads = [stiffness * radius**3 for radius in radii]
    for move, radius, load in zip(moves, radii, loads, strict=True):
        after = NormalContact(load, radius, radius).complete
        increment = Increment(move, move, after.friction_load, 1.0)
        response, state = law.advance(state, increment, after, after)
        forces.append(response.force)
        works.append(response.friction_work)
    return np.array(forces), np.array(works), state


@pytest.mark.parametrize(
    ("springs", "worst", "typical"), [(4, 0.09, 0.03), (8, 0.03, 0.008), (16, 0.012, 0.003)]
)
def test_error_of_psi2_at_every_size_of_the_contact(springs, worst, typical):
    """At 50 steps; the exact rebound is the reference."""
    found = np.array([errors(springs, 50, chi) for chi in (1.18, 1.44, 1.75)])
    assert np.abs(found).max() <= worst
    assert rms(found) <= typical


def test_second_order_in_springs_and_steps_together():
    numbers = np.array([8, 16, 32, 64])
    found = [rms(errors(springs, 8 * springs, CHI, 20)) for springs in numbers.tolist()]
    assert -np.polyfit(np.log(numbers), np.log(found), 1)[0] == pytest.approx(2.0, abs=0.3)


def test_it_converges_to_the_springs_that_span_the_largest_contact():
    psi1 = np.linspace(0.1, 5.5, 12)
    scene = Scene.nondimensional(psi1=psi1, chi=CHI)
    spanning = contactlab.create("tangential.springs", springs=200)
    march = contactlab.create("integrator.symplectic", steps=800)
    other = Simulation(tangential=spanning, integrator=march).run(scene).check().psi2
    assert marched(200, 800).run(scene).check().psi2 == pytest.approx(other, abs=3e-4)


def test_nothing_is_taken_from_the_motion_to_come():
    """The same steps in a scene of another normal speed give the same forces to the last bit."""
    moves, radii = [0.3, 0.2, -0.1, 0.05], [0.2, 0.5, 0.9, 0.4]
    scene = Scene.nondimensional(psi1=1.2, chi=CHI)
    slow = attrs.evolve(scene, normal_speed=0.01 * scene.normal_speed)
    assert Simulation().normal_motion(slow).maximum_radius != pytest.approx(1.0, rel=0.1)
    first, second = (take(doubling(8), moves, radii, scene=each)[0] for each in (scene, slow))
    assert (first == second).all()
    spanning = contactlab.create("tangential.springs", springs=8)  # this comparison can fail
    first, second = (take(spanning, moves, radii, scene=each)[0] for each in (scene, slow))
    assert (first != second).any()


@pytest.mark.parametrize("springs", [4, 8, 50])
def test_turning_points_are_remembered(springs):
    """At fixed load: Masing's rule, and a closed loop leaves no trace, both to rounding."""
    law, radius = doubling(springs), 0.7
    loading, _, turned = take(law, [0.0, *[0.01] * 20], [radius] * 21)
    back, _, _ = take(law, [-0.02] * 20, [radius] * 20, state=turned)
    assert back == pytest.approx(loading[-1] - 2.0 * loading[1:], abs=1e-14 * loading[-1] * 100)
    loop, _, closed = take(law, [-0.05, -0.03, 0.03, 0.05, 0.1], [radius] * 5, state=turned)
    direct, _, straight = take(law, [0.1], [radius], state=turned)
    assert loop[-1] == pytest.approx(direct[-1], rel=1e-13)
    assert closed.memory.deflection == pytest.approx(straight.memory.deflection, rel=1e-12)
    assert loop[3] == pytest.approx(loading[-1], rel=1e-13)


@pytest.mark.parametrize("springs", [2, 4, 8, 16])
def test_gross_slip_has_the_whole_limit_down_to_a_millionth_of_the_load(springs):
    """Cells that are never split would lose their friction below a few cells."""
    radii = np.concatenate((np.geomspace(1e-3, 1.0, 40), np.geomspace(1.0, 1e-2, 90)))
    forces, _, _ = take(doubling(springs), [9.0] * len(radii), radii.tolist())
    scene = Scene.nondimensional(psi1=1.2, chi=CHI)
    peak = (4.0 / 3.0) * scene.pair.effective_modulus / scene.pair.radius
    limit = scene.friction_coefficient * peak * radii**3
    assert limit[-1] <= 1.001e-6 * limit.max()
    assert forces == pytest.approx(limit, rel=1e-12)


def test_fixed_load_gives_cattaneo_and_mindlin():
    law, radius = doubling(400), 0.9
    scene = Scene.nondimensional(psi1=1.2, chi=CHI)
    pair, friction = scene.pair, scene.friction_coefficient
    limit = friction * (4.0 / 3.0) * pair.effective_modulus / pair.radius * radius**3
    slips = friction * radius**2 / (pair.stiffness_ratio * pair.radius)  # gross slip begins
    forces, _, _ = take(law, [0.0, *[0.05 * slips] * 20], [radius] * 21)
    xi = np.minimum(np.arange(1, 21) * 0.05, 1.0)
    assert forces[1:] / limit == pytest.approx(1.0 - (1.0 - xi) ** 1.5, abs=1e-4)


def test_load_alone_makes_no_force_and_touch_without_area_none():
    law = doubling(8)
    forces, works, _ = take(law, [0.0] * 5, [0.1, 0.6, 1.0, 0.2, 0.0])
    assert not forces.any()
    assert not works.any()
    forces, _, state = take(law, [0.3, 0.3], [0.0, 0.0])  # exact touch: b = 0
    assert not forces.any()
    forces, _, state = take(law, [0.3, 0.3, 0.3], [5e-324, 0.5, 5e-324])
    assert (forces != 0.0).tolist() == [False, True, False]
    forces, _, _ = take(law, [0.1, 0.1], [0.3, 0.5], state=state)
    fresh, _, _ = take(law, [0.1, 0.1], [0.3, 0.5])
    assert (forces == fresh).all()


def test_a_batch_is_each_contact_alone_each_on_a_grid_of_its_own():
    random = np.random.default_rng(3)
    items, steps = 12, 60
    scale = np.geomspace(1e-3, 1.0, items)
    moves = random.normal(0.0, 0.1, (steps, items)) * scale**2
    radii = np.abs(np.cumsum(random.normal(0.0, 0.2, (steps, items)), axis=0)) * scale
    radii[random.uniform(size=radii.shape) < 0.05] = 0.0
    scene = Scene.nondimensional(psi1=np.full(items, 1.2), chi=CHI)
    forces, works, state = take(doubling(6), list(moves), list(radii), scene=scene)
    assert len(set(np.log2(state.memory.size[state.memory.size > 0.0]))) > 3
    for k in range(items):
        alone, work, _ = take(doubling(6), moves[:, k].tolist(), radii[:, k].tolist())
        assert forces[:, k] == pytest.approx(alone, rel=1e-13, abs=1e-300)
        assert works[:, k] == pytest.approx(work, rel=1e-12, abs=1e-300)


def test_what_is_not_finite_stays_so_until_the_contact_ends():
    law = doubling(4)
    for spoilt in range(3):
        numbers = [[0.1, 0.1, 0.1, 0.0, 0.1], [0.3, 0.4, 0.5, 0.0, 0.3], [1.0, 1.0, 1.0, 0.0, 1.0]]
        for value in (np.nan, np.inf):
            numbers[spoilt][1] = value
            with np.errstate(invalid="ignore"):
                forces, _, _ = take(law, *numbers)
            assert np.isfinite(forces).tolist() == [True, False, False, True, True]


def test_fields_of_a_batch():
    result = marched(16, 40).run(
        Scene.nondimensional(psi1=np.array([0.3, 1.2]), chi=CHI), history="fields"
    )
    fields, history = result.check().history.fields, result.history
    assert {field.shape for field in fields.values()} == {(40, 2, 16)}
    touching = fields["radius"] < np.asarray(history.contact_radius)[..., None]
    assert ((fields["stuck"] | (fields["slipping"] != 0)) == touching).all()
    assert (touching.sum(axis=-1) >= 4).all()


def test_pairs_are_merged_so_their_number_is_even():
    with pytest.raises(ValueError, match=r'springs = 7: must be even with grid = "doubling".*8'):
        doubling(7)
    with pytest.raises(ValueError, match="grid = 'halving'"):
        contactlab.create("tangential.springs", grid="halving")
    assert contactlab.create("tangential.springs", springs=7).grid == "largest"
