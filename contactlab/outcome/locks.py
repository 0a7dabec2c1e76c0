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
#: Name of the file that is locked. It stays, empty: two could lock a file that one deletes.
NAME = ".contactlab-lock"
#: Descriptors of the locks that this process holds.
_OURS: set[int] = set()


class InUseError(Exception):
    """Another sweep, of this process or another, holds the lock of a folder."""


@contextlib.contextmanager
def lock(folder: Path) -> Iterator[bool]:
    """Hold the lock of a folder; False where nothing can be written, or the disk knows no locks.

    Raises
    ------
    InUseError
        If another holds it.
    """
    descriptor = None
    with contextlib.suppress(OSError):
        descriptor = os.open(folder / NAME, os.O_RDWR | os.O_CREAT, 0o666)
    if descriptor is None:
        yield False
        return
    _OURS.add(descriptor)
    try:
        yield _locked(descriptor)
    finally:
        _OURS.discard(descriptor)
        os.close(descriptor)


def _locked(descriptor: int) -> bool:
    """Lock an open file until it is closed; return False on a disk without locks."""
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
        return False
    return True


def _let_go() -> None:
    """Close the locks of the parent: a forked process may outlive it, and would hold them."""
    for descriptor in _OURS:
        os.close(descriptor)
    _OURS.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_let_go)
