"""Pieces of a sweep solved by an executor: processes of this machine, or other machines."""

from __future__ import annotations

import contextlib
import itertools
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing.context import SpawnContext, SpawnProcess

from contactlab.numeric.checks import refuse, whole
from contactlab.registry.composition import Laws
from contactlab.runs.calls import Calls
from contactlab.runs.lost import Lost, Rescue, stop
from contactlab.runs.pieces import Part, Piece, solve_chunk

#: Most processes: more than any machine has processors.
MOST_PROCESSES = 1024

#: Remedies: objects with a method submit, in general and for libraries whose pools have none.
USUAL = "give ProcessPoolExecutor(4), or client.get_executor() of dask"
GIVE = {
    "joblib": "give joblib.externals.loky.get_reusable_executor(4)",
    "ray": "give an object with submit = lambda call, *its: ray.remote(call).remote(*its).future()",
}


def pieces_of(
    laws: Laws, parts: Iterable[Part], executor: Executor, *, ahead: int | None = None
) -> Generator[Piece, None, None]:
    """Yield the pieces of ``parts`` as an executor finishes them.

    At most ``ahead`` parts are sent before they are answered; all of them if it is None. Parts that
    the executor loses are solved once more, alone and then in halves (``lost.py``).
    """
    if isinstance(executor, type) or not callable(getattr(executor, "submit", None)):
        library = type(executor).__module__.partition(".")[0]
        raise refuse("executor", executor, "must have a method submit", GIVE.get(library, USUAL))
    if isinstance(executor, ThreadPoolExecutor) and _runs_in(executor):
        # A sweep inside a thread of its executor would wait for a thread, perhaps its own.
        yield from (solve_chunk(laws, scene, chunk, block) for chunk, scene, block in parts)
        return
    calls = Calls(laws, executor)
    unsent = iter(parts)
    with Rescue(calls) as rescue:
        try:
            while lost := (yield from _answer_until_lost(calls, unsent, ahead)):
                again = yield from rescue.solve(lost)
                unsent = itertools.chain(again, unsent)
        finally:
            calls.cancel()


def _runs_in(pool: ThreadPoolExecutor) -> bool:
    """Return whether this is a thread of a pool."""
    with pool._shutdown_lock:  # a thread runs before the pool, which holds this lock, lists it
        return threading.current_thread() in pool._threads


def _answer_until_lost(
    calls: Calls, unsent: Iterator[Part], ahead: int | None
) -> Generator[Piece, None, list[Lost]]:
    """Yield pieces until the executor loses a part; return the lost ones, in order."""
    lost: list[Lost] = []
    while True:
        room = None if ahead is None else ahead - len(calls)
        for part in itertools.islice(() if lost else unsent, room):
            calls.send(part)
        if not len(calls):
            return sorted(lost, key=lambda each: each.part.chunk)
        part, answer = calls.next()
        if isinstance(answer, Piece):
            yield answer
            continue
        lost.append(Lost(part, answer))
        if not isinstance(answer, BrokenExecutor):  # the executor goes on with the parts it has
            return lost


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


class _Process(SpawnProcess):
    """A process that Ctrl-C does not reach: the program ends its processes itself."""

    def start(self) -> None:
        mask: Callable[[int, set[int]], set[int]] = getattr(
            signal, "pthread_sigmask", lambda *_: set()
        )
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
