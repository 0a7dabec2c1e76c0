"""Sweeps: the same answers however the work is shared out, and whatever happens to workers."""

import os
import pickle
import re
import signal
import subprocess
import sys
import time
import types
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, Status
from contactlab.contracts import WholeImpactTangentialLaw
from contactlab.contracts.whole_impact import no_force
from contactlab.registry.registry import REGISTRY
from contactlab.runs import into
from contactlab.runs import sweep as sweeping
from contactlab.runs.workers import processes
from tests.laws.ending_laws import Ending, Raising
from tests.longer import longer

CHI = 1.4411764706
SIZE = 150
#: Impacts of a block in these tests.
BLOCK = 70
RIGID = {"tangential": "coulomb", "integrator": "symplectic"}


def scene(size=SIZE):
    return Scene.nondimensional(psi1=np.linspace(0.3, 9.0, size), chi=CHI)


def blocks_of(monkeypatch, block):
    monkeypatch.setattr(sweeping, "block_for", lambda *_: block)
    monkeypatch.setattr(into, "block_for", lambda *_: block)


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
    with processes(2) as two:
        yield two


@pytest.fixture(scope="module")
def exact():
    """A law whose last bits depend on the impacts beside."""
    return Simulation(tangential="springs")


@pytest.fixture(scope="module")
def exact_answers(exact):
    with pytest.MonkeyPatch.context() as monkeypatch:
        blocks_of(monkeypatch, BLOCK)
        return exact.sweep(scene())


@pytest.mark.parametrize("how", ["here", "threads", *longer("workers", "processes")])
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
    assert not again.history
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
        result = Simulation(**RIGID).sweep(
            scene(100), executor=executor, progress=stop, return_partial=True
        )
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

    result = Simulation(**RIGID).sweep(scene(), executor=Interrupted(1), return_partial=True)
    assert [status.name for status in result.status] == ["SUCCESS"] * 100 + ["INTERRUPTED"] * 50
    with pytest.raises(KeyboardInterrupt, match=r"^100 of 150 impacts$"):
        Simulation(**RIGID).sweep(scene(), executor=Interrupted(1))


@pytest.mark.parametrize("writes", [False, True])
def test_a_law_that_raises_loses_those_impacts_as_in_one_process(monkeypatch, workers, writes):
    blocks_of(monkeypatch, 100)
    simulation = Simulation(tangential=Raising(writes=writes), integrator="symplectic")
    here = simulation.sweep(scene())
    there = simulation.sweep(scene(), executor=workers)
    assert "LAW_RAISED" in {status.name for status in here.status}
    assert_same(there, here)


def ending(folder, **options):
    return Simulation(tangential=Ending(folder=str(folder), **options), integrator="symplectic")


@pytest.mark.slow
@pytest.mark.parametrize("status", [0, None, 3])
def test_a_process_that_ends_once_costs_no_impact(monkeypatch, tmp_path, status):
    """``os._exit(0)`` runs nobody's handlers, and looks like a process that ended well."""
    blocks_of(monkeypatch, 50)
    options = {} if status is None else {"status": status}
    simulation = ending(tmp_path / "ends", above=6.2, times=1, **options)
    (tmp_path / "ends").mkdir()
    with processes(1) as one:
        result = simulation.sweep(scene(), executor=one, keep=tmp_path / "kept")
        assert result.check().psi2 == pytest.approx(scene().psi1)
        with pytest.raises(BrokenExecutor):
            one.submit(os.getpid)
        again = Simulation(**RIGID).sweep(scene(), executor=one)
    assert_same(again, Simulation(**RIGID).sweep(scene()))


@pytest.mark.slow
@pytest.mark.parametrize("way", ["here", "keep", "into"])
def test_a_law_that_ends_its_process_at_one_impact_costs_that_impact(tmp_path, way):
    simulation, batch = ending(tmp_path / "ends", at=7.0), scene(12_000)
    (tmp_path / "ends").mkdir()
    place = int(np.argmin(np.abs(batch.psi1 - 7.0)))
    batch = Scene.nondimensional(psi1=np.where(batch.index == place, 7.0, batch.psi1), chi=CHI)
    folder = {} if way == "here" else {way: tmp_path / "swept"}
    seen = []
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = simulation.sweep(batch, executor=pool, **folder, progress=lambda *n: seen.append(n))
    assert seen[-1] == (12_000, 12_000)
    assert [*found.failures] == [place]
    with pytest.raises(contactlab.ImpactError, match=rf"impact {place}: .*ended before") as error:
        found.check()
    assert error.value.status is Status.WORKER_DIED
    psi2 = np.asarray(found["psi2"] if way == "into" else found.psi2)
    alive = batch.index != place
    assert psi2[alive] == pytest.approx(batch.psi1[alive])
    assert np.isnan(psi2[place])
    if way == "here":
        return
    # The folder is complete: what ended a process does not end this one.
    ends = len([*(tmp_path / "ends").iterdir()])
    assert ends < 30
    again = simulation.sweep(batch, **folder, progress=lambda *_: pytest.fail("ran"))
    assert [*again.failures] == [place]
    assert len([*(tmp_path / "ends").iterdir()]) == ends


@pytest.mark.slow
def test_a_law_that_ends_every_process_is_given_up(tmp_path):
    """It takes a minute at most, and the next run tries what was not judged."""
    simulation = ending(tmp_path / "ends", above=-1.0)
    (tmp_path / "ends").mkdir()
    with processes(2) as pool:
        folder = simulation.sweep(scene(40), executor=pool, into=tmp_path / "swept", chunk=1)
    assert set(folder.statuses) <= {"WORKER_DIED"}
    assert len([*(tmp_path / "ends").iterdir()]) < 100


class Losing:
    """An executor that always loses the part with one impact."""

    def submit(self, function, /, *arguments):
        future = Future()
        if arguments[2].first <= 70 < arguments[2].stop:
            future.set_exception(OSError("the machine went away"))
        else:
            future.set_result(function(*arguments))
        return future


def test_an_executor_that_loses_a_part_loses_no_other(monkeypatch):
    blocks_of(monkeypatch, 50)
    result = Simulation(**RIGID).sweep(scene(), executor=Losing())
    assert np.flatnonzero(result.status == Status.WORKER_DIED).tolist() == [*range(50, 100)]
    assert "OSError: the machine went away" in result.failures[70]
    others = np.arange(150) // 50 != 1
    expected = Simulation(**RIGID).sweep(scene()).psi2
    np.testing.assert_allclose(result.psi2[others], expected[others], rtol=1e-14)


def test_a_sweep_in_a_thread_of_its_executor_does_not_wait_for_itself():
    simulation = Simulation(**RIGID)
    with ThreadPoolExecutor(1) as one:
        nested = one.submit(lambda: simulation.sweep(scene(), executor=one)).result(timeout=60)
    assert_same(nested, simulation.sweep(scene()))


def test_processes_that_do_not_start_say_what_a_script_needs():
    """As those of a script without ``if __name__ == "__main__"``: nothing is lost in silence."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn"), initializer=os.abort) as pool:
        result = Simulation(**RIGID).sweep(scene(3), executor=pool)
    assert set(result.status) == {Status.WORKER_DIED}
    with pytest.raises(contactlab.ImpactError, match="__main__"):
        result.check()


def _absent():
    raise ImportError("no such law here")


class Absent(type(contactlab.create("tangential.frictionless"))):
    """A law that cannot be loaded where it is sent."""

    def __reduce__(self):
        return _absent, ()


def test_workers_that_cannot_load_a_law_say_so():
    with ThreadPoolExecutor(1) as executor, pytest.raises(ValueError, match="cannot load the laws"):
        Simulation(tangential=Absent()).sweep(scene(), executor=executor)


def test_what_is_no_executor_is_refused(monkeypatch):
    for bad in (4, "dask", ThreadPoolExecutor):
        with pytest.raises(ValueError, match=r"executor = .*get_executor"):
            Simulation(**RIGID).sweep(scene(), executor=bad)
    closed = ThreadPoolExecutor(1)
    closed.shutdown()

    def gone(*_):
        raise OSError("the cluster is closed")

    for executor in (closed, types.SimpleNamespace(submit=gone)):
        with pytest.raises(ValueError, match=r"executor = .*takes no work: .*Error: .*; open one"):
            Simulation(**RIGID).sweep(scene(), executor=executor)
    done = Future()
    done.set_result(None)
    for answer, words in ((4, "returns no future"), (done, "what its call did not return")):
        wrong = types.SimpleNamespace(submit=lambda *_, answer=answer: answer)
        with pytest.raises(ValueError, match=rf"executor = .*{words}; submit\(call"):
            Simulation(**RIGID).sweep(scene(), executor=wrong)
    answers = []

    def remembered(function, *arguments):
        answers.append(function(*arguments))
        future = Future()
        future.set_result(answers[0])
        return future

    blocks_of(monkeypatch, 50)
    with pytest.raises(ValueError, match=r"executor = .*answers another call; submit\(call"):
        Simulation(**RIGID).sweep(scene(), executor=types.SimpleNamespace(submit=remembered))
    for bad in (0, 1.5, True):
        with pytest.raises(ValueError, match="workers"):
            processes(bad).__enter__()


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


def test_other_versions_there_are_refused():
    def elsewhere(function, *arguments):
        answer, future = function(*arguments), Future()
        future.set_result(answer._replace(versions={"normal": "hertz 2"}))
        return future

    executor = types.SimpleNamespace(submit=elsewhere)
    with pytest.raises(ValueError, match=r"workers have .*hertz 2.*same versions"):
        Simulation(**RIGID).sweep(scene(3), executor=executor)


PROGRAM = """
import os, signal, sys, time
import numpy as np
if __name__ == "__mp_main__":  # Ctrl-C while a process is being started
    os.kill(os.getpid(), signal.SIGINT)
if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job ignores it
    from contactlab import Scene, Simulation
    from contactlab.runs import sweep
    from contactlab.runs.workers import processes
    from tests.laws.ending_laws import Waiting
    sweep.block_for = lambda *_: 10
    scene = Scene.nondimensional(psi1=np.linspace(0.3, 9.0, 150), chi=1.4411764706)
    simulation = Simulation(tangential=Waiting(folder=sys.argv[1]), integrator="symplectic")
    with processes(2) as two:
        result = simulation.sweep(scene, executor=two, return_partial=True)
    print([status.name for status in result.status].count("INTERRUPTED"))
"""


def waiting_program(tmp_path):
    """Return a program whose two processes wait for ever in a law, and their process ids."""
    program, folder = tmp_path / "program.py", tmp_path / "pids"
    program.write_text(PROGRAM)
    folder.mkdir()
    running = subprocess.Popen(
        [sys.executable, program, folder],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])},
        start_new_session=True,
    )
    while len(pids := [int(path.name) for path in folder.iterdir()]) < 2:
        assert running.poll() is None, running.communicate()
        time.sleep(0.01)
    return running, pids


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize("everybody", [True, *longer(False)])
def test_ctrl_c_ends_calls_and_processes(tmp_path, everybody):
    """Of a terminal it reaches every process, and of ``kill`` the program alone."""
    running, pids = waiting_program(tmp_path)
    (os.killpg if everybody else os.kill)(running.pid, signal.SIGINT)
    out, err = running.communicate(timeout=60)
    assert (running.returncode, out) == (0, b"150\n")
    assert sorted(err.replace(b"law", b"law\n").split(b"\n"))[-2:] == [b"printed by a law"] * 2
    assert len(err) == 2 * len(b"printed by a law\n")  # the two may write at once
    assert not any(map(alive, pids))


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_processes_end_with_a_program_that_is_killed(tmp_path):
    running, pids = waiting_program(tmp_path)
    running.kill()
    running.communicate(timeout=60)  # until the last of them has closed stderr
    deadline = time.monotonic() + 60.0
    while any(map(alive, pids)):
        assert time.monotonic() < deadline
        time.sleep(0.01)


def test_a_call_is_ended_with_its_processes():
    with processes(1) as pool:
        call = pool.submit(time.sleep, 60.0)
        while not call.running():
            time.sleep(0.01)
    assert isinstance(call.exception(), BrokenExecutor)


def alive(pid):
    """Whether a process runs; one that ended may wait for its parent to ask."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.parametrize(
    ("library", "line"),
    [
        ("joblib.parallel", "joblib.externals.loky.get_reusable_executor(4)"),
        ("ray.util.multiprocessing", "ray.remote(call).remote(*its).future()"),
        ("mine", "ProcessPoolExecutor(4)"),
    ],
)
def test_a_pool_without_submit_is_refused_with_what_has_one(library, line):
    pool = type("Pool", (), {"__module__": library})()
    with pytest.raises(ValueError, match=re.escape(line)):
        Simulation(**RIGID).sweep(scene(3), executor=pool)


class Late(KeyboardInterrupt):
    """What a limit of time raises."""


@pytest.mark.parametrize("to_disk", [False, True])
def test_an_interrupt_stays_of_its_kind(monkeypatch, tmp_path, to_disk):
    blocks_of(monkeypatch, 10)

    def stop(done, total):
        raise Late

    into = tmp_path / "swept" if to_disk else None
    with pytest.raises(Late, match="impacts"):
        Simulation(**RIGID).sweep(scene(), progress=stop, into=into)
