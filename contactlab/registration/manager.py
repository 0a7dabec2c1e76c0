"""The one plug-in manager of the process: what is installed, registered, blocked, and asked."""

from __future__ import annotations

import os
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import ModuleType
from typing import Any, NamedTuple

import pluggy

from contactlab.numeric.names import nearest, quote
from contactlab.registration import hooks
from contactlab.registration.hooks import (
    FURTHER,
    HOOKS,
    REMEDIES,
    REMEDY,
    PluginError,
    guard,
    short,
)
from contactlab.registration.installed import (
    PluginWarning,
    describe_offers,
    entry_points,
    path_times,
)
from contactlab.registration.names import (
    ALL_KINDS,
    BLOCK_VARIABLE,
    COLLECTIONS,
    COMMAND,
    HERE,
    KINDS,
    PROJECT,
    PluginInfo,
    blocks,
    clash,
    is_place,
    kind_of,
    read_blocks,
    resolve_name,
    short_name,
)

#: An import that takes more seconds warns the author.
SLOW = 3.0
#: Order of kinds in a list.
RANK = {kind: place for place, kind in enumerate(ALL_KINDS)}


class Told(NamedTuple):
    """One thing that a plug-in brought."""

    info: PluginInfo
    item: Any


class Manager(pluggy.PluginManager):
    """Plug-ins by entry point, imported when their kind is asked for, and by ``register``.

    A plug-in's name is its distribution and module, ``mylab-contact:mylab.materials``. Plug-ins are
    asked in this order, whenever they were imported: those registered at run time, the last one
    first, contactlab's own, others by name; ``tryfirst`` and ``trylast`` go before it. Each is
    asked alone, with the wrappers of all, so that one that raises does not lose the answers of
    others.
    """

    def __init__(self) -> None:
        super().__init__(PROJECT)
        self.add_hookspecs(hooks)
        #: Grows with each plug-in that comes or goes; caches of answers compare this number.
        self.changes = 0
        #: Classes of laws that are registered in this program, by kind and name.
        self.laws: dict[str, type] = {}
        #: Sentences on plug-ins that are broken, by name.
        self.faults: dict[str, PluginError] = {}
        self._infos: dict[str, PluginInfo] = {}
        self._since: dict[str, int] = {}
        self._callers: dict[str, tuple[int, list[tuple[PluginInfo, Callable[..., Any]]]]] = {}
        self._here: dict[str, tuple[int, bool]] = {}
        self._loaded: set[tuple[str, str, str]] = set()
        self._seen: object = None
        self._found: set[tuple[str, str, str, str]] = set()
        self._stamp: object = None
        self._warned: set[str] = set()

    def installed(self, *kinds: str) -> list[PluginInfo]:
        """Return every installed plug-in, or those of kinds, sorted by kind, without an import."""
        now = path_times()
        if now != self._stamp:
            self._found, self._stamp = entry_points(), now
            there = {f"{distribution}:{module}" for _, distribution, _, module in self._found}
            for name in self._infos.keys() - there:  # taken off the path, as tests do
                del self._infos[name]
                if self.has_plugin(name):
                    self.unregister(name=name)
        everything = describe_offers(self._found)
        self._warn_of_misspelling(everything)
        infos = [info for info in everything if not kinds or info.kind in kinds]
        return sorted(
            infos, key=lambda each: (RANK.get(each.kind, len(RANK)), each.name, each.distribution)
        )

    def _warn_of_misspelling(self, infos: list[PluginInfo]) -> None:
        """Warn once of each blocked name that is not installed: a misspelt name blocks nothing."""
        for entry in sorted(read_blocks() - self._warned):
            if any(blocks({entry}, info.name, info.distribution) for info in infos):
                continue
            self._warned.add(entry)
            known = {name for info in infos for name in (info.name, info.distribution)}
            told = f"{BLOCK_VARIABLE} names {entry!r}, which is not installed; "
            text = (told + nearest(entry, known)).rstrip("; ")
            warnings.warn(text, PluginWarning, stacklevel=5)

    def register(self, plugin: object, name: str | None = None) -> str | None:
        """Register an object with hooks, and return its name.

        Raises
        ------
        PluginError
            If it has an unknown hook, or a hook with unknown arguments.
        ValueError
            If it, or another of its name, is registered.
        """
        try:
            given = super().register(plugin, name)
            self.check_pending()
        except pluggy.PluginValidationError as error:
            if self.is_registered(plugin):  # pluggy before 1.7 keeps what it refuses
                super().unregister(plugin)
            source = self._infos[name].source if name in self._infos else repr(name or plugin)
            raise PluginError(f"{source} does not fit the hooks: {short(error)}") from error
        self.changes += 1
        self._since[str(given)] = self.changes
        return given

    def unregister(self, plugin: object = None, name: str | None = None) -> object:
        """Take out a plug-in, or the class of a law, by itself or by its name."""
        named = [law for law in self.laws if name == law or plugin is self.laws[law]]
        taken = self.laws.pop(named[0]) if named else super().unregister(plugin, name)
        self.changes += 1
        return taken

    def register_law(self, law: type, name: str) -> str:
        """Register the class of a law by kind and name, and return the name.

        Raises
        ------
        ValueError
            If the name is no name of a law, or is taken.
        """
        if kind_of(name) not in KINDS or is_place(name):
            rule = f"must be one of {', '.join(KINDS)}, a dot and a name"
            raise ValueError(f"name = {name!r}: {rule}, such as 'tangential.brush'")
        if name in self.laws:
            remedy = f"plugin_manager().unregister(name={name!r}) takes it out"
            raise ValueError(f"name = {name!r}: is already registered; {remedy}")
        self.laws[name] = law
        self.changes += 1
        return name

    def info_of(self, plugin: object) -> PluginInfo:
        """Return the entry point of a plug-in, or what stands for one that was registered."""
        name = self.get_name(plugin) or ""
        return self._infos.get(name) or PluginInfo(name, HERE, "", name, False)

    def plugin(self, info: PluginInfo) -> object:
        """Import the plug-in of an entry point, register it, and return it.

        Raises
        ------
        PluginError
            If it cannot be imported, or its hooks are not those of its entry points.
        """
        from importlib import metadata

        started = time.perf_counter()
        with guard(info.source, "could not be imported"):
            plugin = metadata.EntryPoint(info.name, info.module, PROJECT).load()
        took = time.perf_counter() - started
        if took > SLOW and info.distribution != PROJECT:  # a user cannot mend ours
            rule = f"took {took:.0f} s to import, and every command that asks for its kind waits"
            remedy = "import what takes long where it is used, in the function"
            warnings.warn(f"{info.source} {rule}; {remedy}", PluginWarning, stacklevel=4)
        name = f"{info.distribution}:{info.module}"
        known = self.get_plugin(name)
        by_class = info.kind in KINDS and not isinstance(plugin, ModuleType)
        if by_class or plugin is known:  # the class of a law stands for itself
            return plugin
        if known is not None:
            self.unregister(known)
        self._infos[name] = info
        self.faults.pop(info.qualified, None)  # a new import is judged anew
        theirs = [each for each in self.installed() if each.module == info.module]
        declared = {hook for each in theirs for hook in _hooks(each.kind)}
        place = self._place(name)
        pairs = [pair for pair in self.list_name_plugin() if pair[1] is not None]
        late = sorted(pairs, key=lambda pair: self._place(pair[0]), reverse=True)
        late = [pair for pair in late if self._place(pair[0]) < place]
        try:
            for each in late:  # the last one registered is asked first
                super().unregister(each[1])
            self.register(plugin, name)
            own = {caller.name for caller in self.get_hookcallers(plugin) or ()}
            complaint = ""
            if HOOKS[info.kind] not in own:
                remedy = REMEDIES.get(HOOKS[info.kind], REMEDY).format(
                    module=info.module, hook=HOOKS[info.kind]
                )
                complaint = f"has no hook: {remedy}"
            elif lost := sorted(own - declared):
                kinds = " or ".join(kind for kind, hook in HOOKS.items() if hook == lost[0])
                complaint = f"has {lost[0]}, but no entry point {kinds}.NAME names {info.module}"
            if complaint:
                self.unregister(plugin)
                raise PluginError(f"{info.source} {complaint}")
        except ValueError as error:
            raise PluginError(f"{info.source} does not fit the hooks: {error}") from error
        finally:
            for each in late:
                super().register(each[1], each[0])
        return plugin

    def ask(self, info: PluginInfo, **arguments: object) -> object:
        """Return what the plug-in of one entry point answers: a law's class, or a command's run."""
        hook, plugin = HOOKS[info.kind], self.plugin(info)
        if info.kind in KINDS and not isinstance(plugin, ModuleType):
            return plugin
        others = [each for each in self.get_plugins() if each is not plugin]
        with guard(info.source, f"raised when asked for its {hook.rpartition('_')[2]}"):
            return self.subset_hook_caller(hook, others)(name=info.name, **arguments)

    def load(self, kind: str, *, only: str = "", again: bool = True) -> None:
        """Import and register the plug-ins of a kind; one that is broken is told once.

        ``only`` is the name after the kind: of options that of their command. With ``again`` the
        folders of ``sys.path`` are looked at for what was installed meanwhile.
        """
        self._load((kind, only, os.environ.get(BLOCK_VARIABLE, "")), again=again)

    def _load(self, key: tuple[str, str, str], *, again: bool) -> None:
        """Load the plug-ins of a kind, all or one name of them, but not the blocked ones."""
        kind, only, _ = key
        if kind not in COLLECTIONS:
            return
        if key in self._loaded and not (again and path_times() != self._stamp):
            return
        infos = [info for info in self.installed(kind) if not only or info.name == f"{kind}.{only}"]
        if self._seen != self._stamp:
            self._loaded.clear()
            self._seen = self._stamp
        for info in infos:
            if info.usable and not self.is_blocked(f"{info.distribution}:{info.module}"):
                try:
                    self.plugin(info)
                except PluginError as error:
                    self.tell(info, error)
        self._loaded.add(key)

    def gather(
        self, kind: str, *, only: str = "", silent: bool = True, **arguments: object
    ) -> list[Told]:
        """Return what all plug-ins bring of a kind, with the plug-in of each.

        A kind that every run asks for is not ``silent``: its hooks may print, and no folder is read
        again.
        """
        blocked = os.environ.get(BLOCK_VARIABLE, "")  # asking takes long
        self._load((kind, only, blocked), again=silent)
        found: list[Told] = []
        for info, caller in self._find_hooks(HOOKS[kind], blocked):
            try:
                with guard(info.source, f"raised when asked for its {kind}", silent=silent):
                    answers = caller(**arguments)
                for answer in answers:
                    if no_list(answer):
                        rule = f"returned {quote(answer)} when asked for its {kind}"
                        raise PluginError(f"{info.source} {rule}: must be a list; return [...]")
                with guard(info.source, f"raised when asked for its {kind}", silent=silent):
                    found += [Told(info, item) for answer in answers for item in answer or ()]
            except PluginError as error:
                self.tell(info, error)
        return found

    def answers_here(self, hook: str) -> bool:
        """Return whether a plug-in that was registered in this program has a hook."""
        since, found = self._here.get(hook, (-1, False))
        if since != self.changes:
            impls = getattr(self.hook, hook).get_hookimpls()
            found = any(self.get_name(impl.plugin) not in self._infos for impl in impls)
            self._here[hook] = self.changes, found
        return found

    def _find_hooks(self, hook: str, blocked: str) -> list[tuple[PluginInfo, Callable[..., Any]]]:
        """Return the plug-ins with a hook, in order, and the callers that ask each of them alone.

        Plug-ins that are ``blocked`` are left out.
        """
        since, callers = self._callers.get(hook, (-1, []))
        if since != self.changes:
            impls = [
                impl
                for impl in reversed(getattr(self.hook, hook).get_hookimpls())
                if not (impl.wrapper or impl.hookwrapper)
            ]
            callers = [
                (
                    self.info_of(impl.plugin),
                    self.subset_hook_caller(
                        hook, [each.plugin for each in impls if each is not impl]
                    ),
                )
                for impl in impls
            ]
            self._callers[hook] = self.changes, callers
        if not blocked:
            return callers
        blocking = read_blocks()
        return [
            (info, caller)
            for info, caller in callers
            if not blocks(blocking, info.name, info.distribution)
        ]

    def tell(self, info: PluginInfo, error: PluginError) -> None:
        """Warn once of a plug-in that is broken."""
        if str(self.faults.get(info.qualified)) != str(error):
            self.faults[info.qualified] = error
            warnings.warn(str(error), PluginWarning, stacklevel=4)

    def _place(self, name: str) -> tuple[int, int, str]:
        """Return the order of a plug-in: run-time ones first, contactlab's own, others by name."""
        info = self._infos.get(name)
        if info is None:
            return 0, -self._since.get(name, 0), name
        return 1 + (info.distribution != PROJECT), 0, name


def no_list(answer: object) -> bool:
    """Return whether an answer is no list of things; None counts as an empty list."""
    one = isinstance(answer, str | bytes | Mapping) or hasattr(answer, "_fields")
    return answer is not None and (one or not isinstance(answer, Iterable))


def _hooks(kind: str) -> Iterator[str]:
    """Yield the hooks of a kind."""
    yield from (HOOKS[kind],) if kind in HOOKS else ()
    yield from FURTHER.get(kind, ())


def commands(only: str | None = None) -> dict[str, PluginInfo]:
    """Return the subcommands by name, all or those of one distribution."""
    infos = MANAGER.installed(COMMAND) if only is None else describe_offers(entry_points(only))
    usable = [info for info in infos if info.kind == COMMAND and info.usable]
    return dict(sorted((short_name(info.known_as), info) for info in usable))


def command(word: str) -> PluginInfo | None:
    """Return the subcommand that a word means, or None.

    A name of contactlab's own means contactlab's, as of laws, and then no other distribution is
    read.

    Raises
    ------
    ValueError
        If several distributions offer it.
    """
    if (own := commands(PROJECT).get(word)) is not None:
        return own
    found = commands().get(word)
    if found is None:
        rivals = [
            info for info in MANAGER.installed(COMMAND)
            if info.usable and info.name == f"{COMMAND}.{word}"
        ]  # fmt: skip
        if len(rivals) > 1 and resolve_name(rivals) is None:
            raise ValueError(clash(rivals))
    return found


def plugin_manager() -> Manager:
    """Return the plug-in manager of the process, a ``pluggy.PluginManager``."""
    return MANAGER


MANAGER = Manager()
