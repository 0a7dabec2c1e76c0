"""Which law a name means that several distributions offer, and which laws are blocked."""

from __future__ import annotations

import os

from contactlab.compose import hookspecs
from contactlab.compose.loading import PluginInfo
from contactlab.compose.names import parted, same_distribution

BLOCK_VARIABLE = "CONTACTLAB_BLOCK_PLUGINS"


def meant(rivals: list[PluginInfo]) -> PluginInfo | None:
    """Return which of the laws of one name that name means; None if it is refused."""
    usable = [info for info in rivals if not info.blocked] or rivals
    ours = [info for info in usable if info.distribution == hookspecs.PROJECT]
    if len(usable) == 1 or len(ours) == 1:
        return (ours or usable)[0]
    return None


def clash(rivals: list[PluginInfo]) -> str:
    """Return what a name means that several distributions offer, and how to say which."""
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
    """Return whether any of some entries of ``CONTACTLAB_BLOCK_PLUGINS`` blocks a plug-in.

    Parameters
    ----------
    entries : set of str
        Names, names with a distribution, and names of distributions.
    name, distribution : str
        Of the plug-in.
    """
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
