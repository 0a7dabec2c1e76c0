"""The work of a sweep's workers, and an executor whose workers are processes of this machine."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import pickle
import signal
import threading
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from multiprocessing.context import SpawnContext, SpawnProcess
from types import FrameType
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.compose.composition import versions
from contactlab.compose.installed import short
from contactlab.compose.pieces import Chunk, Piece, solved
from contactlab.numeric.arrays import locked
from contactlab.numeric.checks import whole

#: Most processes: more than any machine has processors.
MOST = 1024
#: Time in s for a call to end after an interrupt.
GRACE = 5.0
MODULE_REMEDY = "define its class at the top of a module that can be imported"


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
        return Reply(solved(laws, scene, chunk, block), versions(*laws))
    except Exception as error:
        return Reply(None, {}, error)


@contextlib.contextmanager
def processes(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Yield an executor of at most ``workers`` spawned processes, started when they are needed.

    The processes end with the ``with`` block, and with this program, however the program ends.
    Laws that print there write to stderr.
    """
    workers = whole("workers", workers, most=MOST)
    pool = ProcessPoolExecutor(workers, mp_context=_Spawn(), initializer=_begin)
    try:
        yield pool
    finally:
        stop(pool)


def stop(pool: ProcessPoolExecutor) -> None:
    """Interrupt the calls of a pool and end its processes, by force after ``GRACE``."""
    running = list((pool._processes or {}).values())
    for process in running:
        if process.is_alive():
            os.kill(process.pid or 0, signal.SIGINT)
    pool.shutdown(wait=False, cancel_futures=True)
    deadline = time.monotonic() + GRACE
    for process in running:
        process.join(max(0.0, deadline - time.monotonic()))
        if process.is_alive():
            process.terminate()
    pool.shutdown()


class _Process(SpawnProcess):
    """A process that Ctrl-C cannot reach before ``_begin`` has run in it."""

    def start(self) -> None:
        mask: Any = getattr(signal, "pthread_sigmask", lambda *_: set())
        before = mask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            super().start()
        finally:
            mask(signal.SIG_SETMASK, before)


class _Spawn(SpawnContext):
    Process = _Process


def _begin() -> None:
    """Prepare a new process for its calls."""
    signal.signal(signal.SIGINT, _interrupt)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    os.dup2(2, 1)  # stdout belongs to the parent
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _interrupt(_: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt inside ``reply`` only: half a reply would block the pool."""
    while frame is not None:
        if frame.f_code is reply.__code__:
            raise KeyboardInterrupt
        frame = frame.f_back


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
    return locked(tree) if isinstance(tree, np.ndarray) else tree
