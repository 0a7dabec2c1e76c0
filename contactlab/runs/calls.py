"""Calls that solve parts of a sweep in an executor, and their replies."""

from __future__ import annotations

import pickle
from collections.abc import Mapping
from concurrent.futures import BrokenExecutor, Executor, Future
from queue import SimpleQueue
from typing import NamedTuple

import attrs

from contactlab.numeric.arrays import lock_arrays
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Tree
from contactlab.outcome.chunk_forms import Chunk
from contactlab.registration.hooks import short
from contactlab.registry.composition import Laws, versions
from contactlab.runs.pieces import Part, Piece, solve_chunk

FUTURES = "submit(call, *arguments) must return a future of call(*arguments)"
MODULE_REMEDY = "define its class at the top of a module that can be imported"


class Calls:
    """Calls of one sweep in an executor; the executor may be replaced."""

    def __init__(self, laws: Laws, executor: Executor) -> None:
        self.executor, self.answered = executor, False
        self._sent, self._ours = _pickle(laws), versions(*laws)
        self._finished: SimpleQueue[Future[Reply]] = SimpleQueue()
        self._waiting: dict[Future[Reply], Part] = {}

    def __len__(self) -> int:
        """Return the number of parts that were sent and not answered."""
        return len(self._waiting)

    def send(self, part: Part) -> None:
        """Send a part, which ``next`` answers."""
        future = self._submit(part)
        self._waiting[future] = part
        future.add_done_callback(self._finished.put)

    def next(self) -> tuple[Part, Piece | Exception]:
        """Return a finished part with its piece, or with the error of the executor."""
        future = self._finished.get()
        part = self._waiting.pop(future)
        return part, self._answer(future, part)

    def alone(self, part: Part) -> Piece | Exception:
        """Return the piece of a part once it is solved, or the error of the executor."""
        return self._answer(self._submit(part), part)

    def cancel(self) -> None:
        """Give up the parts that were not answered."""
        for future in self._waiting:
            future.cancel()

    def _submit(self, part: Part) -> Future[Reply]:
        """Return the future of a reply; the future holds the error of a broken executor."""
        chunk, scene, block = part
        try:
            future: Future[Reply] = self.executor.submit(
                reply, self._sent, pickle.dumps(scene), chunk, block
            )
        except BrokenExecutor as error:
            future = Future()
            future.set_exception(error)
        except Exception as error:  # each library has its own error for a shut executor
            rule = f"takes no work: {short(error)}"
            raise refuse("executor", self.executor, rule, "open one") from error
        if not callable(getattr(future, "add_done_callback", None)):
            raise refuse("executor", self.executor, "has a submit that returns no future", FUTURES)
        return future

    def _answer(self, future: Future[Reply], part: Part) -> Piece | Exception:
        """Return the piece of a future, or the executor's error; refuse any other answer."""
        try:
            answer = future.result()
        except Exception as error:  # the executor failed: ``reply`` returns errors of the laws
            return error
        self.answered = True
        if not isinstance(answer, Reply):
            rule = "answers what its call did not return"
            raise refuse("executor", self.executor, rule, FUTURES)
        if answer.raised is not None:
            raise answer.raised
        if answer.versions != self._ours:
            rule = f"its workers have {dict(answer.versions)}, this process {dict(self._ours)}"
            raise refuse("executor", self.executor, rule, "install the same versions there")
        assert answer.piece is not None
        if answer.piece.chunk != part.chunk:
            raise refuse("executor", self.executor, "answers another call", FUTURES)
        return answer.piece


def _pickle(laws: Laws) -> bytes:
    """Return the pickled laws, or refuse the first that does not pickle."""
    for kind, law in laws.by_kind().items():
        try:
            pickle.dumps(law)
        except Exception as error:
            raise refuse(
                kind, law, f"cannot be sent to an executor: {short(error)}", MODULE_REMEDY
            ) from error
    return pickle.dumps(laws)


class Reply(NamedTuple):
    """A piece and the versions of its laws by kind, or the exception that was raised."""

    piece: Piece | None
    versions: Mapping[str, str]
    raised: Exception | None = None


def reply(sent: bytes, part: bytes, chunk: Chunk, block: int) -> Reply:
    """Return the reply to a chunk, from pickled laws and the pickled scene of the chunk."""
    try:
        laws, scene = pickle.loads(sent), _lock(pickle.loads(part))
    except Exception as error:
        rule = f"executor: its workers cannot load the laws: {short(error)}"
        remedy = f"install them there too, and {MODULE_REMEDY}"
        return Reply(None, {}, ValueError(f"{rule}; {remedy}"))
    try:
        return Reply(solve_chunk(laws, scene, chunk, block), versions(*laws))
    except Exception as error:
        return Reply(None, {}, error)


def _lock(tree: Tree) -> Tree:
    """Return a tree with read-only arrays, a flag that pickling loses."""
    kind: type = type(tree)
    if attrs.has(kind):
        for field in attrs.fields(kind):
            _lock(getattr(tree, field.name))
    return lock_arrays(tree)
