"""The installed laws as entry points describe them, and the law that a name means."""

from __future__ import annotations

import contextlib
import os
import sys
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import attrs

from contactlab.compose.hookspecs import PROJECT
from contactlab.compose.names import KINDS, normal_form, parted, same_distribution

if TYPE_CHECKING:
    from importlib import metadata

GROUP, UNKNOWN = "contactlab", "unknown"
#: Stands in place of the distribution for laws in files; their version is a checksum.
FILE = "file"
BLOCK_VARIABLE = "CONTACTLAB_BLOCK_PLUGINS"


class PluginWarning(UserWarning):
    """A blocked name is not installed, or the entry points of a distribution are unreadable."""


@attrs.frozen
class PluginInfo:
    """One installed law as its entry point describes it; its module is not imported.

    Attributes
    ----------
    name, distribution, version, module : str
        Name and module of the entry point, and the distribution that it belongs to.
    blocked : bool
        True if ``CONTACTLAB_BLOCK_PLUGINS`` blocks the law: see ``Registry``.
    meant : bool
        True if the name without a distribution means this law.
    """

    name: str
    distribution: str
    version: str
    module: str
    blocked: bool
    meant: bool = True

    @property
    def qualified(self) -> str:
        """The unique name with the distribution: ``"my-laws:normal.hertz"``."""
        return f"{self.distribution}:{self.name}"

    @property
    def known_as(self) -> str:
        """The shortest name that means this law; the place of a law in a file."""
        if self.distribution == FILE:
            return f"{self.module}:{self.name.rpartition(':')[2]}"
        return self.name if self.meant else self.qualified

    @property
    def source(self) -> str:
        """Name, distribution and version, for messages."""
        return f"{self.name!r} of {self.distribution} {self.version}"

    @property
    def kind(self) -> str:
        """The part of the name before the dot."""
        return self.name.partition(".")[0]

    @property
    def malformed(self) -> bool:
        """True if the name is not a kind, a dot and a name; such a law cannot be made."""
        return self.kind not in KINDS or not self.name.partition(".")[2]

    @property
    def usable(self) -> bool:
        """True if the law can be made: neither blocked nor malformed."""
        return not (self.blocked or self.malformed)


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


def by_name(infos: Iterable[PluginInfo]) -> dict[str, list[PluginInfo]]:
    """Return laws by their names without a distribution."""
    offers: dict[str, list[PluginInfo]] = {}
    for info in infos:
        offers.setdefault(info.name, []).append(info)
    return offers


def meant(rivals: list[PluginInfo]) -> PluginInfo | None:
    """Return the law that a name means, among laws of that name; None if the name is refused."""
    usable = [info for info in rivals if not info.blocked] or rivals
    ours = [info for info in usable if info.distribution == PROJECT]
    if len(usable) == 1 or len(ours) == 1:
        return (ours or usable)[0]
    return None


def clash(rivals: list[PluginInfo]) -> str:
    """Return a sentence on a name of several distributions: its meaning, and how to choose."""
    name, law = rivals[0].name, meant(rivals)
    origins = " and ".join(f"{info.distribution} {info.version}" for info in rivals)
    others = [info for info in rivals if info is not law]
    written = " or ".join(dict.fromkeys(repr(info.qualified) for info in others))
    if len({info.qualified for info in rivals}) < len(rivals):
        return f"name = {name!r}: is offered twice, by {origins}; uninstall one of them"
    remedy = f"or block all laws of one: {BLOCK_VARIABLE}={others[-1].distribution}"
    if law is not None:
        return (
            f"{name!r} is offered by {origins}: it means {law.qualified!r}; write {written} "
            f"for the other, {remedy}"
        )
    return f"name = {name!r}: is offered by {origins}; write {written}, {remedy}"


def blocked_names() -> set[str]:
    """Return the entries of ``CONTACTLAB_BLOCK_PLUGINS``, separated by commas or blanks."""
    return set(os.environ.get(BLOCK_VARIABLE, "").replace(",", " ").split())


def blocks(entries: set[str], name: str, distribution: str) -> bool:
    """Return True if entries of ``CONTACTLAB_BLOCK_PLUGINS`` block a plug-in of a distribution."""
    for entry in entries:
        origin, plain = parted(entry)
        if origin and plain == name and same_distribution(origin, distribution):
            return True
        if entry == name or same_distribution(entry, distribution):
            return True
    return False


def short(error: BaseException) -> str:
    """Return the class and the message of an exception."""
    return f"{type(error).__name__}: {error}"
