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
    """Yield the pieces of ``chunks`` as an executor finishes them; ``scene`` is the whole sweep."""
    # A chunk that the executor loses gets the status WORKER_DIED. A ProcessPoolExecutor breaks
    # when any of its processes dies. So each process has one chunk at a time, and after a break
    # these chunks and the rest go to new pools of one process each: a chunk that ends its process
    # a second time is lost.
    if isinstance(executor, type) or not callable(getattr(executor, "submit", None)):
        remedy = "give ProcessPoolExecutor(4), or client.get_executor() of dask"
        raise refuse("executor", executor, "must have a method submit", remedy)
    pool: Any = executor if isinstance(executor, ProcessPoolExecutor) else None
    sent, ours = _sent(laws), versions(*laws)
    finished: SimpleQueue[Future[Reply]] = SimpleQueue()
    waiting: dict[Future[Reply], tuple[Any, Chunk]] = {}
    left, retried = deque(chunks), set[Chunk]()
    # Executors with room for a chunk; None stands for a new pool, made when it is needed.
    free: list[Any] = [executor] * (pool._max_workers if pool else len(chunks))
    try:
        while left or waiting:
            while left and free:
                taker, chunk = free.pop() or _new_pool(pool), left.popleft()
                part = pickle.dumps(scene.take(slice(*chunk)))
                future = _submitted(taker, sent, part, chunk, block)
                waiting[future] = taker, chunk
                future.add_done_callback(finished.put)
            future = finished.get()
            taker, chunk = waiting.pop(future)
            try:
                answer = future.result()
            except Exception as error:  # the executor failed: ``reply`` returns errors of the laws
                free.append(taker)
                if pool:
                    free = [None if each is taker else each for each in free]
                if pool and chunk not in retried:
                    retried.add(chunk)
                    left.append(chunk)
                else:
                    yield unsolved(chunk, Status.WORKER_DIED, short(error))
                continue
            free.append(taker)
            if answer.raised is not None:
                raise answer.raised
            if answer.versions != ours:
                rule = f"its workers have {dict(answer.versions)}, this process {dict(ours)}"
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
    """Return the pickled laws, or refuse the first that does not pickle."""
    for kind, law in laws._asdict().items():
        try:
            pickle.dumps(law)
        except Exception as error:
            raise refuse(
                kind, law, f"cannot be sent to an executor: {short(error)}", MODULE_REMEDY
            ) from error
    return pickle.dumps(laws)


def _submitted(executor: Any, *call: Any) -> Future[Reply]:
    """Return the future of a reply; the future holds the error of a broken executor."""
    try:
        future: Future[Reply] = executor.submit(reply, *call)
    except BrokenExecutor as error:
        future = Future()
        future.set_exception(error)
    except RuntimeError as error:
        raise refuse("executor", executor, f"takes no work: {error}", "open one") from error
    return future


def _new_pool(broken: Any) -> ProcessPoolExecutor:
    """Return a pool of one process with the settings of the broken pool."""
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
