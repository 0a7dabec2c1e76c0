"""Disks that are full, or that a signal meets in the middle of a file."""

import errno
import os


def full_disk(monkeypatch, *, after=0, error=None):
    """Let every file after the first ``after`` fail as on a full disk, or by another ``error``."""
    fsync, calls = os.fsync, []

    def full(number):
        calls.append(number)
        if len(calls) > after:
            raise error or OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        fsync(number)

    monkeypatch.setattr(os, "fsync", full)
