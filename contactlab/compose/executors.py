"""Pieces of a sweep solved by an executor: processes, or other machines."""

from __future__ import annotations

import contextlib
import pickle
import warnings
from collections import Counter
from collections.abc import Generator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from queue import SimpleQueue
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.compose import composition
from contactlab.compose.installed import short
from contactlab.compose.registry import KINDS
from contactlab.compose.simulation import Simulation
from contactlab.compose.sweep import Chunk, Piece, solved, unsolved
from contactlab.compose.workers import Workers
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import locked
from contactlab.numeric.checks import refuse

#: A chunk that is lost so many times, with the process that solved it, is not tried again.
TRIES = 2
MODULE_REMEDY = "define its class at the top of a module that can be imported"


class Reply(NamedTuple):
    """What a worker sends back: a piece and whose it is, or why there is none."""

    piece: Piece | None
    laws: Mapping[str, str]
    unread: str
    raised: Exception | None


def pieces_of(
    simulation: Simulation, scene: Scene, chunks: Sequence[Chunk], block: int, executor: Executor
) -> Generator[Piece, None, None]:
    """Return the pieces of ``chunks`` as an executor finishes them.

    Of the executor only ``submit`` is used. A chunk that is lost with its process is handed in
    again; lost once more, its impacts have the status ``WORKER_DIED``. An executor that takes no
    more work after such a loss is replaced by one process of this machine.

    Parameters
    ----------
    simulation : Simulation
    scene : Scene
        Of the whole sweep.
    chunks : sequence of Chunk
    block : int
        Impacts solved in one call.
    executor : concurrent.futures.Executor

    Raises
    ------
    ValueError
        If ``executor`` is none, or takes no work, or a law cannot be sent to it, or is another
        one there.
    """
    if not isinstance(executor, Executor):
        raise refuse(
            "executor",
            executor,
            "must be a concurrent.futures.Executor",
            "such as contactlab.compose.workers.Workers(4), or client.get_executor() of dask",
        )
    laws, versions = _sent(simulation), _versions(simulation)
    waiting: dict[Future[Reply], Chunk] = {}
    finished: SimpleQueue[Future[Reply]] = SimpleQueue()
    lost: Counter[Chunk] = Counter()
    with contextlib.ExitStack() as stack:
        stack.callback(lambda: [future.cancel() for future in waiting])

        def submit(chunk: Chunk) -> None:
            nonlocal executor
            part = pickle.dumps(scene.take(slice(*chunk)))
            try:
                future = executor.submit(reply, laws, part, chunk, block)
            except BrokenExecutor as error:
                told = "the executor takes no more work; the rest goes through one process"
                warnings.warn(f"{told} ({short(error)})", RuntimeWarning, stacklevel=5)
                executor = Workers(1)
                stack.callback(executor.shutdown, cancel_futures=True)
                future = executor.submit(reply, laws, part, chunk, block)
            waiting[future] = chunk
            future.add_done_callback(finished.put)

        try:
            for chunk in chunks:
                submit(chunk)
        except RuntimeError as error:
            raise refuse("executor", executor, f"takes no work: {error}", "open one") from error
        while waiting:
            future = finished.get()
            chunk = waiting.pop(future)
            try:
                found = future.result()
            except Exception as error:  # of the executor: a worker returns what it raises
                lost[chunk] += 1
                if lost[chunk] < TRIES:
                    submit(chunk)
                else:
                    yield unsolved(chunk, Status.WORKER_DIED, short(error))
                continue
            yield _checked(found, versions, executor)


def reply(laws: bytes, part: bytes, chunk: Chunk, block: int) -> Reply:
    """Return a worker's reply to a chunk; this is what executors are given to call.

    Parameters
    ----------
    laws, part : bytes
        The pickled simulation, and the pickled scene of the chunk.
    chunk : Chunk
    block : int
    """
    try:
        simulation, scene = pickle.loads(laws), _locked(pickle.loads(part))
    except Exception as error:
        return Reply(None, {}, short(error), None)
    try:
        piece = solved(simulation, scene, chunk, block)
    except Exception as error:
        return Reply(None, {}, "", error)
    return Reply(piece, _versions(simulation), "", None)


def _checked(found: Reply, versions: Mapping[str, str], executor: Executor) -> Piece:
    """Return the piece of a reply by the same laws as here."""
    if found.unread:
        rule = f"its workers cannot load the laws: {found.unread}"
        raise refuse("executor", executor, rule, f"install them there too, and {MODULE_REMEDY}")
    if found.raised is not None:
        raise found.raised
    if found.laws != versions:
        rule = f"its workers have {dict(found.laws)}, here are {dict(versions)}"
        raise refuse("executor", executor, rule, "install the same versions there")
    assert found.piece is not None
    return found.piece


def _versions(simulation: Simulation) -> Mapping[str, str]:
    return composition.versions(*(getattr(simulation, kind) for kind in KINDS))


def _sent(simulation: Simulation) -> bytes:
    """Return the pickled simulation, or say which law does not pickle."""
    for kind in KINDS:
        law = getattr(simulation, kind)
        try:
            pickle.dumps(law)
        except Exception as error:
            raise refuse(
                kind, law, f"cannot be sent to an executor: {short(error)}", MODULE_REMEDY
            ) from error
    return pickle.dumps(simulation)


def _locked(tree: Any) -> Any:
    """Return a tree with its arrays read-only: pickling forgets that they are."""
    if attrs.has(type(tree)):
        for field in attrs.fields(type(tree)):
            _locked(getattr(tree, field.name))
    return locked(tree) if isinstance(tree, np.ndarray) else tree
