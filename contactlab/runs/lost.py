"""Parts of a sweep that an executor lost are solved again, in halves where a process ends.

A law that ends its process at one impact costs that impact alone. An executor of another
library is asked once more for the whole part: it has tried it several times itself, and dask's,
asked for halves again and again, runs out of workers and waits for ever.
"""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor
from typing import NamedTuple, Self

from contactlab.contracts.status import Status
from contactlab.impact import kinetics
from contactlab.outcome.chunk_forms import Chunk
from contactlab.registration.hooks import short
from contactlab.runs.calls import Calls
from contactlab.runs.pieces import Part, Piece, leave_open

#: Processes that may end before the rest is given up: each takes a second to start.
MOST_ENDS = 64
MAIN_REMEDY = 'in a script, call sweep under if __name__ == "__main__":'


class Lost(NamedTuple):
    """A part that an executor lost, and what it raised."""

    part: Part
    error: Exception


class Rescue:
    """Solves what an executor lost; a pool that broke is replaced by one like it."""

    def __init__(self, calls: Calls) -> None:
        self.calls, self.ends = calls, 0
        self._pool: ProcessPoolExecutor | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._pool is not None:
            stop(self._pool)
            self._pool = None

    def solve(self, lost: Sequence[Lost]) -> Generator[Piece, None, list[Part]]:
        """Yield pieces of lost parts; return the parts that have ended no process."""
        pool = self.calls.executor
        broken = isinstance(lost[0].error, BrokenExecutor)
        if self.ends >= MOST_ENDS or (broken and not self._replace(pool, 1)):
            for part, error in lost:
                yield self._give_up(part, error)
            return []
        # A pool takes parts in order: one of those that it was solving has ended a process.
        processes = isinstance(pool, ProcessPoolExecutor)
        workers = pool._max_workers if processes else len(lost)  # type: ignore[attr-defined]  # typeshed
        suspects = workers if broken else len(lost)
        for part, _ in lost[:suspects]:
            piece = self._solve_alone(part)
            answered = any(status is not Status.WORKER_DIED for status in piece.motion.status)
            yield piece._replace(solved=answered or self._pool is not None)
        if broken:
            self._replace(pool, workers)
        return [part for part, _ in lost[suspects:]]

    def _give_up(self, part: Part, error: Exception) -> Piece:
        """Return the piece of a part that the same sweep tries again."""
        started = self.calls.answered or self._pool is not None
        remedy = "" if started else f"; {MAIN_REMEDY}"
        return leave_open(
            part.chunk, kinetics.slip_axes(part.scene), Status.WORKER_DIED, short(error) + remedy
        )

    def _solve_alone(self, part: Part) -> Piece:
        """Return the piece of a part that is solved while nothing else is, or of its halves."""
        answer = self.calls.alone(part)
        if isinstance(answer, Piece):
            return answer
        self.ends += 1
        if not isinstance(answer, BrokenExecutor):
            return self._give_up(part, answer)
        self._replace(self.calls.executor, 1)
        if part.chunk.size == 1 or self.ends >= MOST_ENDS:
            return self._give_up(part, answer)
        return Piece.join([self._solve_alone(half) for half in halves(part)])

    def _replace(self, pool: Executor, workers: int) -> bool:
        """Take another pool with the settings of a pool of processes; False if none starts."""
        if not isinstance(pool, ProcessPoolExecutor):
            return False
        self.__exit__()
        self._pool = ProcessPoolExecutor(
            workers,
            mp_context=pool._mp_context,
            initializer=pool._initializer,
            initargs=pool._initargs,
            max_tasks_per_child=pool._max_tasks_per_child,  # type: ignore[attr-defined]  # typeshed
        )
        if self._pool.submit(os.getpid).exception() is not None:
            self.__exit__()
            return False
        self.calls.executor = self._pool
        return True


def halves(part: Part) -> Iterator[Part]:
    """Yield the two halves of a part, of whole blocks where it has several."""
    size, block = part.chunk.size, part.block
    middle = -(-size // (2 * block)) * block if size > block else size // 2
    for first, stop_at in ((0, middle), (middle, size)):
        chunk = Chunk(part.chunk.first + first, part.chunk.first + stop_at)
        yield Part(chunk, part.scene.take(slice(first, stop_at)), block)


def stop(pool: ProcessPoolExecutor) -> None:
    """End the processes of a pool, in the middle of their calls."""
    running = list((pool._processes or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in running:
        process.terminate()
    pool.shutdown()
