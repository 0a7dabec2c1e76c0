"""Locks of folders by the operating system, which ends them with the process that holds them."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Iterator
from pathlib import Path

#: What a system answers if another holds the lock.
HELD = (errno.EACCES, errno.EAGAIN, errno.EDEADLK)
#: Name of the file that is locked. It stays, empty: a file that is deleted may be locked by two.
NAME = ".contactlab-lock"
#: Descriptors of locks that this process holds.
_OURS: set[int] = set()


class InUseError(Exception):
    """Another sweep, here or in another process, holds the lock of a folder."""


@contextlib.contextmanager
def lock(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder; ``InUseError`` if another holds it.

    Where nothing can be written, and on disks that know no locks, there is none.
    """
    try:
        descriptor = os.open(folder / NAME, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError:
        yield
        return
    try:
        _lock(descriptor)
        _OURS.add(descriptor)
        yield
    finally:
        _OURS.discard(descriptor)
        os.close(descriptor)


def _lock(descriptor: int) -> None:
    """Lock an open file until it is closed, or raise ``InUseError``."""
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in HELD:
            raise InUseError from error


def _let_go() -> None:
    """Close the locks of the parent: a forked process may outlive it, and would hold them."""
    for descriptor in _OURS:
        os.close(descriptor)
    _OURS.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_let_go)
