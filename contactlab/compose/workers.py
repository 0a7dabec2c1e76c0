"""The work of a sweep's workers, and an executor whose workers are processes of this machine."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import pickle
import signal
import sys
import threading
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from multiprocessing.context import SpawnContext, SpawnProcess
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
    return locked(tree) if isinstance(tree, np.ndarray) else tree
