"""Plug-ins among the installed distributions, found by their entry points without an import."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterable

import attrs

from contactlab.registration.hooks import short
from contactlab.registration.names import (
    PROJECT,
    PluginInfo,
    blocks,
    clash,
    read_blocks,
    resolve_name,
    same_distribution,
)


class PluginWarning(UserWarning):
    """A blocked name is not installed, or the entry points of a distribution are unreadable."""


def entry_points(only: str | None = None) -> set[tuple[str, str, str, str]]:
    """Return name, distribution, version and module of every entry point of the group.

    Reading one distribution (``only``) takes a tenth of the time.
    """
    from importlib import metadata  # takes 20 ms to import

    entries, seen = set(), list[str]()
    for distribution in metadata.distributions(name=only):
        try:
            points = list(distribution.entry_points.select(group=PROJECT))
            if not points:  # metadata are read only then: each reading opens a file
                continue
            name, version = str(distribution.metadata["Name"]), distribution.version
        except Exception as error:
            where = getattr(distribution, "_path", "a distribution")
            text = f"the entry points of {where} cannot be read and are passed over: {short(error)}"
            warnings.warn(text, PluginWarning, stacklevel=4)
            continue
        if only and not same_distribution(name, only):  # metadata takes names that begin alike
            continue
        if not any(same_distribution(name, other) for other in seen):  # the first is imported
            entries |= {(point.name, name, version, point.value) for point in points}
        seen.append(name)
    return entries


def path_times() -> object:
    """Return the folders of ``sys.path`` with their times: an installation changes the value."""
    folders = [folder or "." for folder in sys.path]
    return tuple((each, os.path.exists(each) and os.stat(each).st_mtime_ns) for each in folders)


def by_name(infos: list[PluginInfo]) -> dict[str, list[PluginInfo]]:
    """Return plug-ins by their names without a distribution."""
    offers: dict[str, list[PluginInfo]] = {}
    for info in infos:
        offers.setdefault(info.name, []).append(info)
    return offers


def clashes(infos: Iterable[PluginInfo]) -> list[str]:
    """Return a sentence on each name that several distributions offer, with its meaning."""
    offers = by_name([info for info in infos if info.usable])
    return [clash(rivals) for rivals in offers.values() if len(rivals) > 1]


def describe_offers(found: Iterable[tuple[str, str, str, str]]) -> list[PluginInfo]:
    """Return what entry points offer, what is blocked, and what an ambiguous name means."""
    blocking = read_blocks()
    infos = [PluginInfo(*each, blocks(blocking, *each[:2])) for each in found]
    return [
        attrs.evolve(info, meant=info is resolve_name(rivals))
        for rivals in by_name(infos).values()
        for info in rivals
    ]
