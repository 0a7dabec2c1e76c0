"""Pieces of a sweep solved by an executor: processes, or other machines."""

from __future__ import annotations

import pickle
from collections import deque
from collections.abc import Generator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from queue import SimpleQueue
from typing import Any

from contactlab.compose.composition import Laws, versions
from contactlab.compose.installed import short
from contactlab.compose.pieces import Chunk, Piece, unsolved
from contactlab.compose.workers import MODULE_REMEDY, Reply, reply, stop
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse


def pieces_of(
    laws: Laws, scene: Scene, chunks: Sequence[Chunk], block: int, executor: Executor
) -> Generator[Piece, None, None]:
    """Return the pieces of ``chunks`` as an executor finishes them.

    A chunk that the executor loses has the status ``WORKER_DIED``. A ``ProcessPoolExecutor``
    breaks with any of its processes. So it has one chunk in flight for each process, and when it
    breaks these chunks and the rest go to fresh pools of one process each: a chunk that ends its
    process there too is lost.

    Parameters
    ----------
    laws : Laws
    scene : Scene
        Of the whole sweep.
    chunks : sequence of Chunk
    block : int
        Impacts solved in one call.
    executor : concurrent.futures.Executor
        Or another object with a method ``submit`` that returns futures.

    Raises
    ------
    ValueError
        If ``executor`` takes no work, if a law cannot be sent to it, or if the laws have other
        versions there.
    """
    if isinstance(executor, type) or not callable(getattr(executor, "submit", None)):
        remedy = "give ProcessPoolExecutor(4), or client.get_executor() of dask"
        raise refuse("executor", executor, "must have a method submit", remedy)
    pool: Any = executor if isinstance(executor, ProcessPoolExecutor) else None
    sent, ours = _sent(laws), versions(*laws)
    finished: SimpleQueue[Future[Reply]] = SimpleQueue()
    waiting: dict[Future[Reply], tuple[Any, Chunk]] = {}
    left, again = deque(chunks), set[Chunk]()
    # Executors with room for a chunk; None is a fresh pool, to be made when it is needed.
    free: list[Any] = [executor] * (pool._max_workers if pool else len(chunks))
    try:
        while left or waiting:
            while left and free:
                taker, chunk = free.pop() or _fresh(pool), left.popleft()
                part = pickle.dumps(scene.take(slice(*chunk)))
                future = _submitted(taker, sent, part, chunk, block)
                waiting[future] = taker, chunk
                future.add_done_callback(finished.put)
            future = finished.get()
            taker, chunk = waiting.pop(future)
            try:
                answer = future.result()
            except Exception as error:  # of the executor: ``reply`` returns what it raises
                free.append(taker)
                if pool:
                    free = [None if each is taker else each for each in free]
                if pool and chunk not in again:
                    again.add(chunk)
                    left.append(chunk)
                else:
                    yield unsolved(chunk, Status.WORKER_DIED, short(error))
                continue
            free.append(taker)
            if answer.raised is not None:
                raise answer.raised
            if answer.versions != ours:
                rule = f"its workers have {dict(answer.versions)}, here are {dict(ours)}"
                raise refuse("executor", executor, rule, "install the same versions there")
            assert answer.piece is not None
            yield answer.piece
    finally:
        for future in waiting:
            future.cancel()
        for taker, _ in waiting.values():
            if taker is not executor:
                stop(taker)
        for taker in free:
            if taker is not executor and taker is not None:
                taker.shutdown()


def _sent(laws: Laws) -> bytes:
    """Return the pickled laws, or say which law does not pickle."""
    for kind, law in laws._asdict().items():
        try:
            pickle.dumps(law)
        except Exception as error:
            raise refuse(
                kind, law, f"cannot be sent to an executor: {short(error)}", MODULE_REMEDY
            ) from error
    return pickle.dumps(laws)


def _submitted(executor: Any, *call: Any) -> Future[Reply]:
    """Return the future of a reply; if the executor is broken, the future holds its error."""
    try:
        future: Future[Reply] = executor.submit(reply, *call)
    except BrokenExecutor as error:
        future = Future()
        future.set_exception(error)
    except RuntimeError as error:
        raise refuse("executor", executor, f"takes no work: {error}", "open one") from error
    return future


def _fresh(broken: Any) -> ProcessPoolExecutor:
    """Return a pool of one process, started as those of the broken pool were."""
    pool = ProcessPoolExecutor(
        1,
        mp_context=broken._mp_context,
        initializer=broken._initializer,
        initargs=broken._initargs,
    )
    try:
        pool.submit(abs, 0).result()
    except BrokenExecutor as error:
        remedy = 'in a script, call sweep under if __name__ == "__main__":'
        raise refuse("executor", broken, "its processes end as they start", remedy) from error
    return pool
