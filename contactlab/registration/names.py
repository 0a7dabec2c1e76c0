"""Names of plug-ins: ``kind.name``, or ``distribution:kind.name`` if two distributions offer it.

A law that is not installed is named by its place: ``my_law.py:Stribeck``, a class in a file, or
``package.module:Stribeck``. Such a name has neither distribution nor kind.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

import attrs

#: Name of the program, of its distribution and of its group of entry points.
PROJECT = "contactlab"
BLOCK_VARIABLE = "CONTACTLAB_BLOCK_PLUGINS"
KINDS = ("normal", "tangential", "integrator")
#: The kind of an entry point that offers a subcommand: ``command.hello``.
COMMAND = "command"
#: The kind of an entry point that offers a page of the guide: ``page.fitting = "package"``, the
#: file ``fitting.md`` of that package.
PAGE = "page"
#: Kinds that every plug-in is asked for at once: ``materials.polymers``. Equal names do not clash;
#: what they bring does (see ``bring.by_name``).
COLLECTIONS = (
    "materials", "columns", "shapes", "cases", "checks", "measurements", "cautions", "options",
)  # fmt: skip
#: First words of names.
ALL_KINDS = (*KINDS, COMMAND, PAGE, *COLLECTIONS)
#: The distribution of what is registered at run time.
HERE = "this program"
#: The place of a law: a Python file, or a module and a class, which begins with a capital.
PLACE = re.compile(r"\.py(:|$)|:[A-Z]\w*$")
#: Stands in place of the distribution for laws in files; their version is a checksum.
FILE = "file"


class Untrusted(str):
    """Place of a law that a scene names without the user's word: ``law_at`` refuses it."""

    __slots__ = ()


def is_place(name: str) -> bool:
    """Return True if a name is the place of a law: ``my_law.py:Stribeck``."""
    return PLACE.search(name) is not None


def name_from(folder: Path, name: str, *, trusted: bool) -> str:
    """Return a name in a file of ``folder``: the path of a law in a file begins there."""
    if re.search(r"\.py(:|$)", name):
        name = str(folder / os.path.expanduser(name))
    # The text itself carries the mark, so that no function that takes names can forget it.
    return Untrusted(name) if is_place(name) and not trusted else name


def split_name(name: str) -> tuple[str, str]:
    """Return distribution and plain name: ``("my-laws", "normal.hertz")``; "" if there is none."""
    if is_place(name):
        return "", name
    distribution, _, plain = name.rpartition(":")
    return distribution, plain


def kind_of(name: str) -> str:
    """Return the part of a name before its dot, without the distribution: ``"normal"``."""
    return split_name(name)[1].partition(".")[0]


def full_name(kind: str, name: str) -> str:
    """Return a name with its kind: ``"my-laws:normal.hertz"`` for ``"my-laws:hertz"``."""
    distribution, plain = split_name(name)
    if is_place(name) or plain.startswith(f"{kind}."):
        return name
    return f"{distribution}:{kind}.{plain}" if distribution else f"{kind}.{plain}"


def short_name(name: str) -> str:
    """Return a name without its kind: ``"my-laws:hertz"`` for ``"my-laws:normal.hertz"``."""
    distribution, plain = split_name(name)
    kind, _, short = plain.partition(".")
    if is_place(name) or kind not in ALL_KINDS or not short:
        return name
    return f"{distribution}:{short}" if distribution else short


def same_distribution(first: str, second: str) -> bool:
    """Return True if two names mean the same distribution, as ``My_Laws`` and ``my-laws`` do."""
    plain, other = (re.sub(r"[-_.]+", "-", name).lower() for name in (first, second))
    return plain == other


def blocks(entries: set[str], name: str, distribution: str) -> bool:
    """Return True if entries of ``CONTACTLAB_BLOCK_PLUGINS`` block a plug-in of a distribution."""
    for entry in entries:
        origin, plain = split_name(entry)
        if entry == name or same_distribution(entry, distribution):
            return True
        if plain == name and same_distribution(origin, distribution):
            return True
    return False


def read_blocks() -> set[str]:
    """Return the entries of ``CONTACTLAB_BLOCK_PLUGINS``, separated by commas or blanks."""
    return set(os.environ.get(BLOCK_VARIABLE, "").replace(",", " ").split())


@attrs.frozen
class PluginInfo:
    """One installed plug-in as its entry point describes it; its module is not imported.

    For a law in a file, ``distribution`` is ``FILE``, ``version`` a checksum and ``module`` the
    path; ``malformed`` and ``usable`` tell nothing there.

    Attributes
    ----------
    name, distribution, version, module : str
        Name and module of the entry point, and the distribution that it belongs to.
    blocked : bool
        True if ``CONTACTLAB_BLOCK_PLUGINS`` blocks the plug-in: see ``Registry``.
    meant : bool
        True if the name without a distribution means this plug-in.
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
        """True if the name is not a kind, a dot and a name in lower case; it cannot be made."""
        # the name of a place, with the distribution or alone, would mean a file or a module
        short = self.name.partition(".")[2]
        place = is_place(self.name) or is_place(f"{self.distribution}:{short}")
        return self.kind not in ALL_KINDS or not short or place

    @property
    def usable(self) -> bool:
        """True if the law can be made: neither blocked nor malformed."""
        return not (self.blocked or self.malformed)


def resolve_name(rivals: list[PluginInfo]) -> PluginInfo | None:
    """Return the law that a name means, among laws of that name; None if the name is refused.

    The name of a command of contactlab's own means no other, even where contactlab is blocked.
    """
    if rivals[0].kind == COMMAND and any(info.distribution == PROJECT for info in rivals):
        rivals = [info for info in rivals if info.distribution == PROJECT]
    free = [info for info in rivals if not info.blocked] or rivals
    ours = [info for info in free if info.distribution == PROJECT]
    return (ours or free)[0] if 1 in (len(free), len(ours)) else None


def clash(rivals: list[PluginInfo]) -> str:
    """Return a sentence on a name of several distributions: its meaning, and how to choose."""
    name, law = rivals[0].name, resolve_name(rivals)
    origins = " and ".join(f"{info.distribution} {info.version}" for info in rivals)
    others = [info for info in rivals if info is not law]
    written = " or ".join(repr(info.qualified) for info in others)
    if law is None and rivals[0].kind == COMMAND:
        calls = (f"contactlab {info.distribution}:{short_name(name)}" for info in rivals)
        return f"name = {name!r}: is offered by {origins}; write {' or '.join(calls)}"
    meaning = f"means {law.qualified!r}" if law else "is refused"
    return (
        f"name = {name!r}: is offered by {origins}, and {meaning}; write {written}, or block all "
        f"laws of one: {BLOCK_VARIABLE}={others[-1].distribution}"
    )
