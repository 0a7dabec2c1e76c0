"""The place of an impact in the whole batch: the key of random draws, kept wherever it goes."""

import pickle

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, Sphere, collide
from contactlab.runs import sweep as sweeping
from contactlab.runs.workers import processes
from tests.laws.random_laws import RandomNormal, RandomStepped, RandomWhole, draws
from tests.longer import longer

SIZE = 12
SIMULATIONS = {
    "normal": Simulation(normal=RandomNormal(), tangential="coulomb", integrator="symplectic"),
    "whole": Simulation(tangential=RandomWhole()),
    "stepped": Simulation(
        tangential=RandomStepped(),
        integrator=contactlab.create("integrator.symplectic", steps=40),
    ),
}


def scene(size=SIZE):
    return Scene.nondimensional(psi1=np.linspace(2.0, 5.0, size), chi=1.4)


def answers(result):
    motion = result.check().motion
    return np.array([motion.normal_velocity, motion.slip_velocity_change])


def test_an_impact_keeps_its_place_in_any_part():
    batch = scene(7)
    assert batch.index.tolist() == [0, 1, 2, 3, 4, 5, 6]
    assert batch.take(slice(2, 6)).take(np.array([True, False, True, True])).index.tolist() == [
        2, 4, 5,
    ]  # fmt: skip
    alone = batch.take(3)
    assert (alone.index, type(alone.index)) == (3, int)
    assert Scene.nondimensional(psi1=1.0, chi=1.0).index == 0
    like = Scene.nondimensional(psi1=np.full(4, 1.0), chi=1.0)  # the impacts differ in nothing else
    assert like.take([1, 3]).index.tolist() == [1, 3]
    assert pickle.loads(pickle.dumps(like.take([1, 3]))).index.tolist() == [1, 3]
    square = Scene.nondimensional(psi1=np.ones((2, 3)), chi=1.0)
    assert square.take((1, 2)).index == 5
    grid = Scene.grid(psi1=[1.0, 2.0], chi=[1.0, 1.5])
    assert grid.index.tolist() == [0, 1, 2, 3]
    assert grid.take(slice(1, 3)).index.tolist() == [1, 2]


def test_the_place_is_no_part_of_what_a_scene_is():
    batch = scene(5)
    alone = Scene.nondimensional(psi1=batch.psi1[3], chi=1.4)
    assert batch.take(3) == alone
    assert hash(batch.take(3)) == hash(alone)
    assert repr(batch.take(3)) == repr(alone)
    assert "index" not in batch.numbers()
    assert Scene.stack([batch.take(3), batch.take(1)]).index.tolist() == [0, 1]  # a new batch
    with pytest.raises(ValueError, match="read-only"):
        batch.index[0] = 9
    with pytest.raises(ValueError, match=r"index = \[1, 2\]: must be whole numbers of the shape"):
        batch.with_index([1, 2])
    with pytest.raises(ValueError, match="whole numbers"):
        alone.with_index(0.5)


@pytest.fixture(scope="module")
def workers():
    with processes(1) as one:
        yield one


@pytest.mark.parametrize("name", SIMULATIONS)
def test_draws_of_a_batch_are_those_of_its_impacts(name):
    """The rest of the answers differs by rounding, a solved normal motion by its tolerance."""
    simulation, batch = SIMULATIONS[name], scene()
    whole = answers(simulation.run(batch))
    alone = [answers(simulation.run(batch.take(i))) for i in range(0, SIZE, 3)]
    np.testing.assert_allclose(whole[:, ::3], np.transpose(alone), rtol=1e-8)
    row = 0 if name == "normal" else 1
    assert len(set(whole[row].round(6))) == SIZE
    some = np.array([11, 3, 4])
    np.testing.assert_allclose(whole[:, some], answers(simulation.run(batch.take(some))), rtol=1e-8)


def test_the_draws_are_those_of_seed_and_index():
    """The change of slip velocity says which number was drawn."""
    batch = scene()
    change = answers(SIMULATIONS["whole"].sweep(batch, chunk=5))[1]
    np.testing.assert_allclose(-change / batch.slip_velocity, draws(7, np.arange(SIZE)))


@pytest.mark.parametrize("name", [*longer("normal"), "whole", "stepped"])
def test_a_sweep_draws_the_same_in_chunks_in_workers_and_after_it_was_ended(
    name, workers, monkeypatch, tmp_path
):
    monkeypatch.setattr(sweeping, "block_for", lambda *_: 4)
    simulation, batch = SIMULATIONS[name], scene()
    expected = answers(simulation.run(batch))
    np.testing.assert_allclose(answers(simulation.sweep(batch)), expected, rtol=1e-8)
    in_chunks = answers(simulation.sweep(batch, chunk=8))
    np.testing.assert_allclose(in_chunks, expected, rtol=1e-8)
    spread = answers(simulation.sweep(batch, chunk=4, executor=workers))
    assert spread.tobytes() == in_chunks.tobytes()

    def end(done, total):
        if done >= 8:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match="8 of"):
        simulation.sweep(batch, chunk=4, keep=tmp_path / "kept", progress=end)
    resumed = answers(simulation.sweep(batch, chunk=8, keep=tmp_path / "kept"))
    assert resumed.tobytes() == in_chunks.tobytes()


def test_a_kept_sweep_of_other_places_is_another_sweep(tmp_path):
    batch = Scene.nondimensional(psi1=np.full(8, 3.0), chi=1.4)
    simulation = SIMULATIONS["whole"]
    simulation.sweep(batch.take(slice(0, 4)), keep=tmp_path / "kept")
    with pytest.raises(ValueError, match="keep"):
        simulation.sweep(batch.take(slice(4, 8)), keep=tmp_path / "kept")


def test_encounters_that_pass_through_leave_the_others_their_places():
    glass = Material(young_modulus=70e9, poisson_ratio=0.25, density=2500.0)
    velocity = [[1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]]
    met = Encounter(
        Sphere(0.005, glass), HalfSpace(glass), 0.1, normal=[0, 0, -1], velocity=velocity
    )
    found = collide(met, SIMULATIONS["whole"], separating="pass")
    np.testing.assert_allclose(
        found.slip_velocity_change[[0, 2]], -draws(7, np.array([0, 2])), rtol=1e-12
    )


def test_evolving_a_scene_makes_a_new_batch():
    part = scene(5).take(slice(2, 4))
    assert attrs.evolve(part, friction_coefficient=0.5).index.tolist() == [0, 1]
