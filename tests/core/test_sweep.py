"""Sweeps: the same answers however the work is shared out, and whatever happens to workers."""

import itertools
import pickle
import sys
import types
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, Status
from contactlab.compose import executors
from contactlab.compose import sweep as sweeping
from contactlab.compose.registry import REGISTRY
from contactlab.compose.workers import WorkerDiedError, Workers
from contactlab.contracts import WholeImpactTangentialLaw
from contactlab.contracts.whole_impact import no_force
from tests.ending_laws import Ending, Raising

CHI = 1.4411764706
SIZE = 150
#: Impacts of a block in these tests: so many that the exact solution takes them together.
BLOCK = 70
RIGID = {"tangential": "coulomb", "integrator": "symplectic"}


def scene(size=SIZE):
    return Scene.nondimensional(psi1=np.linspace(0.3, 9.0, size), chi=CHI)


def blocks_of(monkeypatch, block):
    monkeypatch.setattr(sweeping, "block_of", lambda _: block)


def assert_same(one, other):
    """The same result to the last bit, plan and counters too."""
    for name in one.motion.numbers():
        first, second = (getattr(result.motion, name) for result in (one, other))
        assert first.tobytes() == second.tobytes(), name
    assert list(one.status) == list(other.status)
    assert list(one.motion.detail) == list(other.motion.detail)
    assert one.plan.to_dict() == other.plan.to_dict()
    assert one.plan.marched.tolist() == other.plan.marched.tolist()
    assert (dict(one.counters), one.laws) == (dict(other.counters), other.laws)


@pytest.fixture(scope="module")
def workers():
    with Workers(2) as two:
        yield two


@pytest.fixture(scope="module")
def exact():
    """The exact solution, of which 64 and more impacts are solved by other arithmetic."""
    return Simulation()


@pytest.fixture(scope="module")
def exact_answers(exact):
    with pytest.MonkeyPatch.context() as monkeypatch:
        blocks_of(monkeypatch, BLOCK)
        return exact.sweep(scene())


def test_blocks_do_matter(exact, exact_answers, monkeypatch):
    """Else the next test could not fail."""
    blocks_of(monkeypatch, SIZE)
    together = exact.sweep(scene())
    assert together.psi2 == pytest.approx(exact_answers.psi2, abs=1e-8)
    assert (together.psi2 != exact_answers.psi2).any()


@pytest.mark.parametrize("how", ["here", "workers", "threads", "processes"])
def test_answers_are_the_same_to_the_last_bit(exact, exact_answers, workers, monkeypatch, how):
    blocks_of(monkeypatch, BLOCK)
    executors = {
        "here": lambda: None,
        "workers": lambda: workers,
        "threads": lambda: ThreadPoolExecutor(3),
        "processes": lambda: ProcessPoolExecutor(2, mp_context=get_context("spawn")),
    }
    executor = executors[how]()
    for chunk in (1, 7, 1000) if how == "workers" else (7,):
        assert_same(exact.sweep(scene(), chunk=chunk, executor=executor), exact_answers)
    if how in ("threads", "processes"):
        executor.shutdown()


def test_a_scene_in_si_and_one_of_plain_numbers_go_to_workers(workers):
    steel = contactlab.Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
    ball = contactlab.Sphere(0.0127, steel)
    speed = np.linspace(0.1, 2.0, 30)
    batch = Scene(ball, contactlab.HalfSpace(steel), 0.2, 1.0, tangential_velocity=speed)
    simulation = Simulation(tangential="springs")
    assert_same(simulation.sweep(batch, executor=workers), simulation.sweep(batch))
    alike = [Scene.nondimensional(psi1=1.2, chi=CHI)] * 3
    assert_same(simulation.sweep(alike, executor=workers), simulation.sweep(alike))


@pytest.mark.parametrize("tangential", ["coulomb", "springs", "fronts"])
def test_a_block_depends_on_the_laws_alone(tangential):
    simulation = Simulation(tangential=tangential)
    assert sweeping.block_of(simulation) >= 1000


def progress_of(simulation, **how):
    seen = []
    simulation.sweep(scene(), progress=lambda *n: seen.append(n), **how)
    return seen


def test_chunks_are_whole_blocks(monkeypatch, workers):
    blocks_of(monkeypatch, 40)
    for chunk, first in ((None, 40), (1, 40), (40, 40), (41, 80), (1000, SIZE)):
        for executor in (None, workers):
            seen = progress_of(Simulation(**RIGID), chunk=chunk, executor=executor)
            assert {total for _, total in seen} == {SIZE}
            counts = [done for done, _ in seen]
            steps = sorted(np.diff([0, *counts]), reverse=True)
            assert steps[0] == first
            assert counts[-1] == SIZE


@pytest.mark.parametrize("name", REGISTRY.names())
def test_laws_pickle(name):
    law = contactlab.create(name)
    again = pickle.loads(pickle.dumps(law))
    assert again == law
    assert REGISTRY.describe(again) == REGISTRY.describe(law)


def test_scenes_plans_and_results_pickle():
    result = Simulation().run(Scene.nondimensional(psi1=1.2, chi=CHI), history=True)
    for kind in (result, Simulation().sweep(scene(5))):
        again = pickle.loads(pickle.dumps(kind))
        assert again.scene == kind.scene
        assert str(again.plan) == str(kind.plan)
        assert np.array_equal(again.psi2, kind.psi2)
        assert all(status is Status.SUCCESS for status in np.ravel(again.status))
    assert again.history is None
    assert pickle.loads(pickle.dumps(result)).history.time.tolist() == result.history.time.tolist()
    for status in Status:
        assert pickle.loads(pickle.dumps(status)) is status


def test_ctrl_c_keeps_what_is_done_and_gives_up_the_rest(monkeypatch):
    blocks_of(monkeypatch, 10)
    handed_in = []

    class Slow(ThreadPoolExecutor):
        def submit(self, function, /, *arguments):
            handed_in.append(super().submit(function, *arguments))
            return handed_in[-1]

    def stop(done, total):
        if done >= 20:
            raise KeyboardInterrupt

    with Slow(1) as executor:
        executor.submit(lambda: None)
        result = Simulation(**RIGID).sweep(scene(100), executor=executor, progress=stop)
    names = [status.name for status in result.status]
    assert names.count("INTERRUPTED") == 80
    assert all(future.done() for future in handed_in)
    done = result.status == Status.SUCCESS
    assert (result.psi2[done] == Simulation(**RIGID).sweep(scene(100)).psi2[done]).all()


def test_ctrl_c_that_reaches_a_worker_ends_the_sweep(monkeypatch):
    blocks_of(monkeypatch, 100)

    class Interrupted(ThreadPoolExecutor):
        def submit(self, function, /, *arguments):
            future = Future()
            if arguments[2].first < 100:
                future.set_result(function(*arguments))
            else:
                future.set_exception(KeyboardInterrupt())
            return future

    result = Simulation(**RIGID).sweep(scene(), executor=Interrupted(1))
    assert [status.name for status in result.status] == ["SUCCESS"] * 100 + ["INTERRUPTED"] * 50


@pytest.mark.parametrize("writes", [False, True])
def test_a_law_that_raises_loses_those_impacts_as_in_one_process(monkeypatch, workers, writes):
    blocks_of(monkeypatch, 100)
    simulation = Simulation(tangential=Raising(writes=writes), integrator="symplectic")
    here = simulation.sweep(scene())
    there = simulation.sweep(scene(), executor=workers)
    assert "LAW_RAISED" in {status.name for status in here.status}
    assert_same(there, here)


def test_a_worker_that_dies_once_costs_a_retry(monkeypatch, workers, tmp_path):
    blocks_of(monkeypatch, 50)
    law = Ending(folder=str(tmp_path), times=1)
    result = Simulation(tangential=law, integrator="symplectic").sweep(scene(), executor=workers)
    assert result.check().psi2 == pytest.approx(scene().psi1)
    assert len(list(tmp_path.iterdir())) == 1


def test_a_chunk_that_ends_its_workers_has_a_status(monkeypatch, workers, tmp_path):
    blocks_of(monkeypatch, 50)
    law = Ending(folder=str(tmp_path), above=6.2)
    result = Simulation(tangential=law, integrator="symplectic").sweep(scene(), executor=workers)
    assert [status.name for status in result.status] == ["SUCCESS"] * 100 + ["WORKER_DIED"] * 50
    assert "SIGKILL" in result.failures[100]
    assert result.psi2[:100] == pytest.approx(scene().psi1[:100])
    assert len(list(tmp_path.iterdir())) == executors.TRIES
    assert Simulation(**RIGID).sweep(scene(), executor=workers).check()


def test_an_executor_that_breaks_is_replaced(monkeypatch, tmp_path):
    """A pool of the standard library is lost with any of its processes."""
    blocks_of(monkeypatch, 50)
    law = Ending(folder=str(tmp_path), above=6.2)
    simulation = Simulation(tangential=law, integrator="symplectic")
    with (
        ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool,
        pytest.warns(RuntimeWarning, match="through one process"),
    ):
        result = simulation.sweep(scene(), executor=pool)
    assert [status.name for status in result.status] == ["SUCCESS"] * 100 + ["WORKER_DIED"] * 50


def test_what_is_no_executor_is_refused(workers):
    class Client:
        def submit(self, function, *arguments):
            raise AssertionError

    for bad in (4, Client(), ThreadPoolExecutor):
        with pytest.raises(ValueError, match=r"executor = .*get_executor"):
            Simulation(**RIGID).sweep(scene(), executor=bad)
    closed = ThreadPoolExecutor(1)
    closed.shutdown()
    with pytest.raises(ValueError, match=r"executor = .*takes no work"):
        Simulation(**RIGID).sweep(scene(), executor=closed)
    for bad in (0, 1.5, True):
        with pytest.raises(ValueError, match="workers"):
            Workers(bad)


def local_law(kind="Local", module=None):
    @attrs.frozen(kw_only=True)
    class Local(WholeImpactTangentialLaw):
        api_version = 2

        def whole_impacts(self, scene, normal):
            return (no_force(scene, where=True, reason="a test"),)

    if module is not None:
        Local.__module__, Local.__qualname__ = module, kind
    return Local


def test_a_law_that_does_not_pickle_is_named(workers):
    simulation = Simulation(tangential=local_law()(), integrator="symplectic")
    assert simulation.sweep(scene(3)).check()
    with pytest.raises(ValueError, match=r"tangential = Local\(\): cannot be sent .*module"):
        simulation.sweep(scene(3), executor=workers)


def test_a_law_that_is_not_there_is_named(workers, monkeypatch):
    module = types.ModuleType("only_here")
    module.Local = local_law(module="only_here")
    monkeypatch.setitem(sys.modules, "only_here", module)
    simulation = Simulation(tangential=module.Local(), integrator="symplectic")
    with pytest.raises(ValueError, match=r"cannot load the laws: .*only_here"):
        simulation.sweep(scene(3), executor=workers)


def test_other_versions_there_are_refused(monkeypatch):
    versions = itertools.chain([{"normal": "hertz 1"}], itertools.repeat({"normal": "hertz 2"}))
    monkeypatch.setattr(executors, "_versions", lambda _: next(versions))
    with (
        ThreadPoolExecutor(1) as executor,
        pytest.raises(ValueError, match=r"hertz 2.*hertz 1.*same versions"),
    ):
        Simulation(**RIGID).sweep(scene(3), executor=executor)


def test_workers_are_an_executor():
    with Workers(2) as two:
        assert list(two.map(abs, range(-3, 3))) == [3, 2, 1, 0, 1, 2]
        assert two.submit(int, "7", base=8).result() == 7
        with pytest.raises(ZeroDivisionError):
            two.submit(divmod, 1, 0).result()
        assert two.submit(print, "not between the answers").result() is None
        for status in (3, 0):
            with pytest.raises(WorkerDiedError, match=f"exit status {status}"):
                two.submit(eval, f"__import__('os')._exit({status})").result()
        assert two.submit(abs, -1).result() == 1
        waiting = [two.submit(eval, "__import__('time').sleep(60)") for _ in range(3)]
        two.shutdown(cancel_futures=True)
    assert all(future.cancelled() or future.exception() for future in waiting)
