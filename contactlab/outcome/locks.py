"""Locks of files, which the operating system ends with the process."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import IO

#: Errors of the system if another process holds the lock.
HELD = (errno.EACCES, errno.EAGAIN, errno.EDEADLK)
#: The byte that Windows locks, which keeps others from reading it: beyond the end of any file.
BYTE = 1 << 30
#: Descriptors of the locks that this process holds.
_OURS: set[int] = set()


class InUseError(Exception):
    """Other code, in this process or another, holds the lock of a file."""


@contextlib.contextmanager
def alone_with(path: Path) -> Iterator[tuple[IO[str], bool]]:
    """Open a text file, made if missing, and hold its exclusive lock.

    The second entry is False on a disk without locks. Where nothing can be written the text is
    open for reading.

    Raises
    ------
    InUseError
        If another holds the lock.
    OSError
        If there is no such file, and none can be made.
    """
    mode = "r+"
    try:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError as error:
        if error.errno not in (errno.EACCES, errno.EROFS, errno.EPERM) or not path.is_file():
            raise
        mode, descriptor = "r", os.open(path, os.O_RDONLY)
    _OURS.add(descriptor)
    try:
        locked = _lock(descriptor)
        with open(descriptor, mode, encoding="utf-8", newline="", closefd=False) as stream:
            yield stream, locked
    finally:
        _OURS.discard(descriptor)
        os.close(descriptor)


def _lock(descriptor: int) -> bool:
    """Lock an open file until it is closed; return False on a disk without locks."""
    try:
        if sys.platform == "win32":
            import msvcrt

            os.lseek(descriptor, BYTE, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
            os.lseek(descriptor, 0, os.SEEK_SET)
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
