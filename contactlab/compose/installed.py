"""The installed entry points; a broken distribution is passed over."""

from __future__ import annotations

import contextlib
import os
import sys
import warnings
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from importlib import metadata

GROUP = "contactlab"


class PluginWarning(UserWarning):
    """A blocked name is not installed, or the entry points of a distribution are unreadable."""


def stamp() -> object:
    """Return the folders of ``sys.path`` with their times: an installation changes the value."""
    stamps = []
    for folder in sys.path:
        try:
            stamps.append((folder, os.stat(folder or ".").st_mtime_ns))
        except OSError:
            stamps.append((folder, 0))
    return stamps


def entry_points() -> set[tuple[str, str, str, str]]:
    """Return name, distribution, version and module of every entry point of the group."""
    from importlib import metadata  # takes 20 ms to import

    try:
        points = list(metadata.entry_points(group=GROUP))
    except Exception:  # one unreadable distribution makes the common reading fail
        points = [point for each in metadata.distributions() for point in _points_of(each)]
    origins: dict[int, tuple[str, str]] = {}
    entries = set()
    for point in points:
        if id(point.dist) not in origins:  # each reading opens a file
            origins[id(point.dist)] = _name_and_version(point.dist)
        entries.add((point.name, *origins[id(point.dist)], point.value))
    return entries


def _name_and_version(distribution: metadata.Distribution | None) -> tuple[str, str]:
    """Return name and version of a distribution; "unknown" if they cannot be read."""
    about: Any = {}
    with contextlib.suppress(Exception):
        about = distribution.metadata if distribution else {}
    return about.get("Name") or "unknown", about.get("Version") or "unknown"


def _points_of(distribution: metadata.Distribution) -> list[metadata.EntryPoint]:
    """Return a distribution's entry points of the group; none, with a warning, if unreadable."""
    try:
        return list(distribution.entry_points.select(group=GROUP))
    except Exception as error:
        where = getattr(distribution, "_path", "a distribution")
        text = f"the entry points of {where} cannot be read and are passed over: {short(error)}"
        warnings.warn(text, PluginWarning, stacklevel=5)
        return []


def short(error: BaseException) -> str:
    """Return the class and the message of an exception."""
    return f"{type(error).__name__}: {error}"
