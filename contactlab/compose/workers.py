"""Processes of this machine that sweeps are shared among."""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Future, ThreadPoolExecutor
from typing import Any

from contactlab.numeric.checks import whole

#: Most processes: more than any machine has processors.
MOST = 1024
#: What a process begins with: it knows nothing of the program that started it.
SERVE = "from contactlab.compose.workers import serve; serve()"


class WorkerDiedError(BrokenExecutor):
    """A process ended before it answered; the executor goes on with a new one."""


class Workers(ThreadPoolExecutor):
    """An executor of processes, each fed by a thread of its own.

    A call that ends its process loses nobody else's answer, and the next call gets a new
    process: that is what ``concurrent.futures.ProcessPoolExecutor`` does not do. The program that
    starts it needs no ``if __name__ == "__main__"``, and functions and laws have to stand in
    modules that can be imported. Ctrl-C goes to the program alone. When the program ends in
    whatever way, so do the processes.

    Parameters
    ----------
    workers : int
        Number of processes, started as they are needed.

    Examples
    --------
    >>> with Workers(4) as workers:  # doctest: +SKIP
    ...     result = Simulation().sweep(scene, executor=workers)
    """

    def __init__(self, workers: int) -> None:
        super().__init__(max_workers=whole("workers", workers, most=MOST))
        self._own = threading.local()
        self._started: list[subprocess.Popen[bytes]] = []
        self._lock = threading.Lock()
        self._closed = False

    def submit(self, function: Callable[..., Any], /, *values: Any, **named: Any) -> Future[Any]:
        """Return the future of ``function(*values, **named)`` in one of the processes."""
        return super().submit(self._answer, pickle.dumps((function, values, named)))

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the processes: after what is submitted, or at once with ``cancel_futures``."""
        super().shutdown(wait=wait and not cancel_futures, cancel_futures=cancel_futures)
        if cancel_futures:
            with self._lock:
                self._closed = True
                for process in self._started:
                    process.kill()
            super().shutdown(wait=wait)
        if wait:
            for process in self._started:
                _end(process)

    def _answer(self, call: bytes) -> Any:
        """Return the answer of this thread's process to a call; in a thread of the executor."""
        process = self._process()
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            pickle.dump(call, process.stdin)
            process.stdin.flush()
            well, answer = pickle.load(process.stdout)
        except (OSError, EOFError, pickle.UnpicklingError):
            del self._own.process
            process.kill()
            raise WorkerDiedError(f"A process {_ended(_end(process))}.") from None
        if well:
            return answer
        raise answer

    def _process(self) -> subprocess.Popen[bytes]:
        if not hasattr(self._own, "process"):
            with self._lock:
                if self._closed:
                    raise WorkerDiedError("The processes were ended.")
                process = subprocess.Popen(
                    [sys.executable, "-c", SERVE],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    start_new_session=True,  # out of reach of the terminal's Ctrl-C
                    env={**os.environ, "PYTHONPATH": _path()},
                )
                self._started.append(process)
            self._own.process = process
        found: subprocess.Popen[bytes] = self._own.process
        return found


def _path() -> str:
    """Return where modules are looked for, as the environment says it."""
    return os.pathsep.join(folder or os.getcwd() for folder in sys.path)


def serve() -> None:
    """Answer calls from stdin on stdout until there are no more: all that a process does."""
    with contextlib.suppress(ValueError, OSError):
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    calls, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    # What a plug-in prints, or reads, must not get between.
    os.dup2(2, 1)
    with open(os.devnull, "rb") as nothing:
        os.dup2(nothing.fileno(), 0)
    with contextlib.suppress(EOFError, OSError):
        while True:
            answers.write(_answered(pickle.load(calls)))
            answers.flush()


def _answered(call: bytes) -> bytes:
    """Return the pickle of what a call returned, or of what it raised."""
    try:
        function, values, named = pickle.loads(call)
        return pickle.dumps((True, function(*values, **named)))
    except BaseException as error:
        try:
            pickle.loads(pickle.dumps(error))
        except Exception:
            error = RuntimeError(f"{type(error).__name__}: {error}")
        return pickle.dumps((False, error))


def _end(process: subprocess.Popen[bytes]) -> int:
    """Let a process come to its end, and return its exit status."""
    for stream in (process.stdin, process.stdout):
        if stream is not None:
            with contextlib.suppress(OSError):
                stream.close()
    return process.wait()


def _ended(status: int) -> str:
    """Return how a process ended, in words."""
    if status >= 0:
        return f"ended with exit status {status}"
    try:
        return f"was ended by signal {signal.Signals(-status).name}"
    except ValueError:
        return f"was ended by signal {-status}"
