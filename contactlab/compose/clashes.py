"""The meaning of a name that several distributions offer, and the blocking of laws."""

from __future__ import annotations

import os

from contactlab.compose import hookspecs
from contactlab.compose.loading import PluginInfo
from contactlab.compose.names import parted, same_distribution

BLOCK_VARIABLE = "CONTACTLAB_BLOCK_PLUGINS"


def meant(rivals: list[PluginInfo]) -> PluginInfo | None:
    """Return the law that a name means, among laws of that name; None if the name is refused."""
    usable = [info for info in rivals if not info.blocked] or rivals
    ours = [info for info in usable if info.distribution == hookspecs.PROJECT]
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


def blocks(entries: set[str], name: str, distribution: str) -> bool:
    """Return True if entries of ``CONTACTLAB_BLOCK_PLUGINS`` block a plug-in of a distribution."""
    for entry in entries:
        origin, plain = parted(entry)
        if origin and plain == name and same_distribution(origin, distribution):
            return True
        if entry == name or same_distribution(entry, distribution):
            return True
    return False


def blocked_names() -> set[str]:
    """Return the entries of ``CONTACTLAB_BLOCK_PLUGINS``, separated by commas or blanks."""
    return set(os.environ.get(BLOCK_VARIABLE, "").replace(",", " ").split())
