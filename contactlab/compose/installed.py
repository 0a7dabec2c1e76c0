"""The entry points that are installed, read so that a broken distribution stops nothing."""

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
    """A word about plug-ins without effect: one is blocked that is not there, or unreadable."""


def stamp() -> object:
    """Return what changes where something is installed: the folders of the path, and when."""
    stamps = []
    for folder in sys.path:
        try:
            stamps.append((folder, os.stat(folder or ".").st_mtime_ns))
        except OSError:
            stamps.append((folder, 0))
    return stamps


def entry_points() -> set[tuple[str, str, str, str]]:
    """Return name, distribution, version and module of every entry point of the group."""
    from importlib import metadata  # 20 ms that only those who look for laws pay

    try:
        points = list(metadata.entry_points(group=GROUP))
    except Exception:  # a single unreadable distribution, anybody's, spoils the common reading
        points = [point for found in metadata.distributions() for point in _points_of(found)]
    origins: dict[int, tuple[str, str]] = {}
    found = set()
    for point in points:
        if id(point.dist) not in origins:  # a file is read for each name and each version
            origins[id(point.dist)] = _name_and_version(point.dist)
        found.add((point.name, *origins[id(point.dist)], point.value))
    return found


def _name_and_version(distribution: metadata.Distribution | None) -> tuple[str, str]:
    """Return name and version as far as they are written down and can be read."""
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
    """Return what was raised, in one line."""
    return f"{type(error).__name__}: {error}"
