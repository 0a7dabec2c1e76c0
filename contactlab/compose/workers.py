"""Pieces of a sweep solved by an executor: processes of this machine, or other machines."""

from __future__ import annotations

import contextlib
import itertools
import multiprocessing
import os
import pickle
import signal
import sys
import threading
from collections.abc import Generator, Iterable, Iterator, Mapping
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from multiprocessing.context import SpawnContext, SpawnProcess
from queue import SimpleQueue
from typing import Any, NamedTuple

import attrs

from contactlab.compose.composition import Laws, versions
from contactlab.compose.pieces import Part, Piece, unsolved
from contactlab.compose.solve import solve_chunk
from contactlab.contracts.status import Status
from contactlab.numeric.arrays import locked
from contactlab.numeric.checks import refuse, whole
from contactlab.outcome.chunk_forms import Chunk
from contactlab.registration.hooks import short

#: Most processes: more than any machine has processors.
MOST_PROCESSES = 1024
MAIN_REMEDY = 'in a script, call sweep under if __name__ == "__main__":'
FUTURES = "submit(call, *arguments) must return a future of call(*arguments)"
MODULE_REMEDY = "define its class at the top of a module that can be imported"


def pieces_of(
    laws: Laws, parts: Iterable[Part], executor: Executor, *, ahead: int | None = None
) -> Generator[Piece, None, None]:
    """Yield the pieces of ``parts`` as an executor finishes them.

    At most ``ahead`` parts are sent before they are answered; all of them if it is None.
    """
    # A chunk that the executor loses gets the status WORKER_DIED. A ProcessPoolExecutor loses all
    # that are left when one of its processes dies; a sweep with ``keep`` resumes.
    if isinstance(executor, type) or not callable(getattr(executor, "submit", None)):
        remedy = "give ProcessPoolExecutor(4), or client.get_executor() of dask"
        raise refuse("executor", executor, "must have a method submit", remedy)
    sent, ours = _sent(laws), versions(*laws)
    finished: SimpleQueue[Future[Reply]] = SimpleQueue()
    waiting: dict[Future[Reply], tuple[Chunk, tuple[int, ...]]] = {}
    answered, unsent = False, iter(parts)
    try:
        while True:
            room = None if ahead is None else ahead - len(waiting)
            for chunk, scene, block in itertools.islice(unsent, room):
                future = _submitted(executor, sent, pickle.dumps(scene), chunk, block)
                waiting[future] = chunk, scene.slip_axes
                future.add_done_callback(finished.put)
            if not waiting:
                return
            future = finished.get()
            chunk, axes = waiting.pop(future)
            try:
                answer = future.result()
            except Exception as error:  # the executor failed: ``reply`` returns errors of the laws
                remedy = "" if answered else f"; {MAIN_REMEDY}"
                yield unsolved(chunk, axes, Status.WORKER_DIED, short(error) + remedy)
                continue
            answered = True
            if not isinstance(answer, Reply):
                raise refuse("executor", executor, "answers what its call did not return", FUTURES)
            if answer.raised is not None:
                raise answer.raised
            if answer.versions != ours:
                rule = f"its workers have {dict(answer.versions)}, this process {dict(ours)}"
                raise refuse("executor", executor, rule, "install the same versions there")
            assert answer.piece is not None
            if answer.piece.chunk != chunk:
                raise refuse("executor", executor, "answers another call", FUTURES)
            yield answer.piece
    finally:
        for future in waiting:
            future.cancel()


def _sent(laws: Laws) -> bytes:
    """Return the pickled laws, or refuse the first that does not pickle."""
    for kind, law in laws.by_kind().items():
        try:
            pickle.dumps(law)
        except Exception as error:
            raise refuse(
                kind, law, f"cannot be sent to an executor: {short(error)}", MODULE_REMEDY
            ) from error
    return pickle.dumps(laws)


def _submitted(executor: Executor, *call: Any) -> Future[Reply]:
    """Return the future of a reply; the future holds the error of a broken executor."""
    try:
        future: Future[Reply] = executor.submit(reply, *call)
    except BrokenExecutor as error:
        future = Future()
        future.set_exception(error)
    except Exception as error:  # of executors that are shut, each library has one of its own
        raise refuse("executor", executor, f"takes no work: {short(error)}", "open one") from error
    if not callable(getattr(future, "add_done_callback", None)):
        raise refuse("executor", executor, "has a submit that returns no future", FUTURES)
    return future


class Reply(NamedTuple):
    """A piece and the versions of its laws by kind, or the exception that was raised."""

    piece: Piece | None
    versions: Mapping[str, str]
    raised: Exception | None = None


def reply(sent: bytes, part: bytes, chunk: Chunk, block: int) -> Reply:
    """Return the reply to a chunk, from pickled laws and the pickled scene of the chunk."""
    try:
        laws, scene = pickle.loads(sent), _locked(pickle.loads(part))
    except Exception as error:
        rule = f"executor: its workers cannot load the laws: {short(error)}"
        remedy = f"install them there too, and {MODULE_REMEDY}"
        return Reply(None, {}, ValueError(f"{rule}; {remedy}"))
    try:
        return Reply(solve_chunk(laws, scene, chunk, block), versions(*laws))
    except Exception as error:
        return Reply(None, {}, error)


@contextlib.contextmanager
def processes(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Yield an executor of at most ``workers`` spawned processes, started when they are needed.

    The processes end with the ``with`` block, and with this program, however the program ends.
    Laws that print there write to stderr.
    """
    workers = whole("workers", workers, most=MOST_PROCESSES)
    pool = ProcessPoolExecutor(workers, mp_context=_Spawn(), initializer=_begin)
    try:
        yield pool
    finally:
        stop(pool)


def stop(pool: ProcessPoolExecutor) -> None:
    """End the processes of a pool, in the middle of their calls."""
    running = list((pool._processes or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in running:
        process.terminate()
    pool.shutdown()


class _Process(SpawnProcess):
    """A process that Ctrl-C does not reach: the program ends its processes itself."""

    def start(self) -> None:
        mask: Any = getattr(signal, "pthread_sigmask", lambda *_: set())
        before = mask(signal.SIG_BLOCK, {signal.SIGINT})  # the process keeps this mask
        try:
            super().start()
        finally:
            mask(signal.SIG_SETMASK, before)


class _Spawn(SpawnContext):
    Process = _Process


def _begin() -> None:
    """Prepare a new process for its calls."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.dup2(2, 1)  # stdout belongs to the parent
    sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """Wait for the parent process to end, then end this one."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def _locked(tree: Any) -> Any:
    """Return a tree with its arrays read-only: pickling loses that flag."""
    if attrs.has(type(tree)):
        for field in attrs.fields(type(tree)):
            _locked(getattr(tree, field.name))
    return locked(tree)
