"""The installed entry points; a broken distribution is passed over."""

from __future__ import annotations

import contextlib
import os
import sys
import warnings
from typing import TYPE_CHECKING, Any

from contactlab.compose.names import normal_form

if TYPE_CHECKING:
    from importlib import metadata

GROUP, UNKNOWN = "contactlab", "unknown"


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

    entries, seen = set(), set()
    for distribution in metadata.distributions():
        where = getattr(distribution, "_path", "a distribution")
        try:
            points = list(distribution.entry_points.select(group=GROUP))
        except Exception as error:
            text = f"the entry points of {where} cannot be read and are passed over: {short(error)}"
            warnings.warn(text, PluginWarning, stacklevel=4)
            continue
        if points:  # only then are the papers read: each reading opens a file
            name, version = _name_and_version(distribution)
            if name == UNKNOWN or normal_form(name) not in seen:  # the first is the one imported
                entries |= {(point.name, name, version, point.value) for point in points}
            seen.add(normal_form(name))
    return entries


def _name_and_version(distribution: metadata.Distribution) -> tuple[str, str]:
    """Return name and version of a distribution; ``UNKNOWN`` if they cannot be read."""
    about: Any = {}
    with contextlib.suppress(Exception):
        about = distribution.metadata
    return about.get("Name") or UNKNOWN, about.get("Version") or UNKNOWN


def short(error: BaseException) -> str:
    """Return the class and the message of an exception."""
    return f"{type(error).__name__}: {error}"
