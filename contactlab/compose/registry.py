"""The registry of laws: found by name among the installed distributions, and made one at a time."""

from __future__ import annotations

import contextlib
import os
import warnings
from functools import cached_property
from typing import Any
from weakref import WeakKeyDictionary

from contactlab.compose import hookspecs
from contactlab.compose.installed import PluginWarning, entry_points, stamp
from contactlab.compose.loading import KINDS, Loader, PluginError, PluginInfo
from contactlab.contracts.law import Law
from contactlab.numeric.checks import nearest, refuse

__all__ = [
    "BLOCK_VARIABLE",
    "KINDS",
    "REGISTRY",
    "PluginError",
    "PluginInfo",
    "Registry",
    "blocked_names",
]

BLOCK_VARIABLE = "CONTACTLAB_BLOCK_PLUGINS"
#: Names that are not of laws, and may be blocked too.
OTHER_GROUPS = ("rebound.",)


class Registry:
    """The laws installed in this environment.

    Entry points of the group ``contactlab`` are read when they are needed first; a module is
    imported only when one of its laws is made, so that a broken plug-in stops no other.
    """

    def __init__(self) -> None:
        self._loader = Loader()
        self._loaded: dict[str, tuple[type[Law], PluginInfo]] = {}
        self._warned: set[str] = set()
        self._found: set[tuple[str, str, str, str]] = set()
        self._stamp: object = None
        self._origins: WeakKeyDictionary[type[Law], PluginInfo | None] = WeakKeyDictionary()

    @cached_property
    def _modules(self) -> list[tuple[str, str]]:
        """Names and modules of the laws found at first; reading entry points takes a while."""
        return [(info.name, info.module) for info in self.installed()]

    def installed(self) -> list[PluginInfo]:
        """Return every law found, sorted by kind and name, without importing any."""
        now = stamp()
        if now != self._stamp:
            self._found, self._stamp = entry_points(), now
        blocked = blocked_names()
        infos = {
            PluginInfo(name, distribution, version, module, name in blocked)
            for name, distribution, version, module in self._found
        }
        self._warn_of_unknown({info.name for info in infos})
        return sorted(infos, key=lambda info: (_rank(info.kind), info.name, info.distribution))

    def _warn_of_unknown(self, known: set[str]) -> None:
        """Warn once of each name that is blocked and not installed: misspelt, it blocks nothing."""
        others = {name for name in blocked_names() if name.startswith(OTHER_GROUPS)}
        unknown = blocked_names() - known - others - self._warned
        self._warned |= unknown
        for name in sorted(unknown):
            hint = nearest(name, known).strip()
            text = f"{BLOCK_VARIABLE} names {name!r}, which is not installed; {hint}"
            warnings.warn(text.rstrip("; "), PluginWarning, stacklevel=4)

    def names(self, kind: str | None = None) -> list[str]:
        """Return the names of laws that may be made, of one kind or of all."""
        return sorted(
            {
                info.name
                for info in self.installed()
                if not (info.blocked or info.malformed) and kind in (None, info.kind)
            }
        )

    def info(self, name: str) -> PluginInfo:
        """Return the one installed law called ``name``.

        Raises
        ------
        ValueError
            If there is none (with the nearest match) or it is blocked.
        PluginError
            If two distributions offer it.
        """
        found = [info for info in self.installed() if info.name == name]
        if len(found) > 1:
            both = " and ".join(f"{info.distribution} {info.version}" for info in found)
            raise PluginError(
                f"{name!r} is offered by {both}: uninstall one, or set {BLOCK_VARIABLE}"
            )
        if not found:
            raise self._unknown(name)
        if found[0].malformed:
            source = f"{name!r} of {found[0].distribution} {found[0].version}"
            raise PluginError(
                f"{source}: the name must be one of {', '.join(KINDS)}, a dot, a name"
            )
        if found[0].blocked:
            raise refuse("name", name, f"is blocked by {BLOCK_VARIABLE}", "unset it to use the law")
        return found[0]

    def at_hand(self, info: PluginInfo) -> bool:
        """Return whether a law is of this distribution, or its plug-in was imported already."""
        return info.distribution == hookspecs.PROJECT or info.name in self._loaded

    def law_class(self, name: str) -> type[Law]:
        """Import the plug-in that offers ``name`` and return the law's class."""
        if name not in self._loaded or name in blocked_names():
            info = self.info(name)
            self._loaded[name] = (self._loader.law_class(info), info)
        return self._loaded[name][0]

    def create(self, name: str, **options: Any) -> Any:
        """Return a new law: ``create("tangential.annulus", annuli=50)``.

        Raises
        ------
        ValueError
            If the name is not installed, or an option is unknown or out of range.
        PluginError
            If the plug-in cannot be imported or breaks the contract, with its traceback.
        """
        import inspect

        if not isinstance(name, str):
            raise refuse("name", name, "must be a text such as 'tangential.springs'")
        law = self.law_class(name)
        known = inspect.signature(law).parameters
        for option, value in options.items():
            if option not in known:
                remedy = f"{nearest(option, known)}it has {', '.join(known) or 'no options'}"
                raise refuse(option, value, f"{name} does not know it", remedy)
        for option, parameter in known.items():
            if parameter.default is parameter.empty and option not in options:
                raise ValueError(
                    f"{name}: {option} must be given; in Python create({name!r}, {option}=...), "
                    f"on the command line --set {name.partition('.')[0]}.{option}=..."
                )
        try:
            return law(**options)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error

    def describe(self, law: Law) -> str:
        """Return a law's name and version: of its distribution, or its class if unregistered."""
        law_class = type(law)
        if law_class not in self._origins:
            self._origins[law_class] = self._origin(law_class)
        info = self._origins[law_class]
        if info is None:
            return f"{law_class.__module__}.{law_class.__qualname__} (not registered)"
        return f"{info.name.partition('.')[2]} ({info.distribution} {info.version})"

    def _origin(self, law_class: type[Law]) -> PluginInfo | None:
        """Return the plug-in that offers this class, asked for by name or not, if any does."""
        for name, module in self._modules:
            if f"{law_class.__module__}.".startswith(f"{module}."):
                with contextlib.suppress(ValueError, PluginError):
                    self.law_class(name)
        return next((info for known, info in self._loaded.values() if known is law_class), None)

    def _unknown(self, name: str) -> ValueError:
        kind, _, short = str(name).rpartition(".")
        names = self.names(kind if kind in KINDS else None)
        others = [known for known in self.names() if known.endswith(f".{short}")]
        if kind in KINDS and others:
            hint = f"{short!r} is a law of another kind, {others[0]!r}; "
        else:
            # The kind, which all of them begin with, would make any two names alike.
            import difflib  # only for those who misspell

            known = {full.rpartition(".")[2]: full for full in others or names}
            found = difflib.get_close_matches(short, known, n=1, cutoff=0.0 if others else 0.5)
            hint = f"did you mean {known[found[0]]!r}? " if found else ""
        return refuse(
            "name", name, "no such law is installed", f"{hint}installed: {', '.join(names)}"
        )


def blocked_names() -> set[str]:
    """Return the names in ``CONTACTLAB_BLOCK_PLUGINS``, separated by commas or blanks."""
    return set(os.environ.get(BLOCK_VARIABLE, "").replace(",", " ").split())


def _rank(kind: str) -> int:
    return KINDS.index(kind) if kind in KINDS else len(KINDS)


REGISTRY = Registry()
