"""The registry of laws: finds laws by name among the installed distributions, and makes them."""

from __future__ import annotations

import contextlib
import os
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, overload

from contactlab.contracts.law import Law, class_of, law_kind
from contactlab.numeric.checks import of_kind, refuse
from contactlab.numeric.names import nearest
from contactlab.registration.hooks import PluginError
from contactlab.registration.installed import PluginWarning
from contactlab.registration.manager import MANAGER, RANK
from contactlab.registration.names import (
    BLOCK_VARIABLE,
    COLLECTIONS,
    COMMAND,
    HERE,
    KINDS,
    PAGE,
    PROJECT,
    PluginInfo,
    blocks,
    clash,
    is_place,
    read_blocks,
    resolve_name,
    same_distribution,
    short_name,
    split_name,
)
from contactlab.registry.loading import IN_FILES, check_class, law_at, law_class

if TYPE_CHECKING:
    from contactlab.contracts.integrator import Integrator
    from contactlab.contracts.normal import NormalLaw
    from contactlab.contracts.tangential import TangentialLaw
    from contactlab.registry.named_laws import IntegratorName, NormalName, TangentialName

__all__ = [
    "BLOCK_VARIABLE", "KINDS", "REGISTRY", "PluginError", "PluginInfo", "PluginWarning", "Registry",
]  # fmt: skip

#: What messages call a law of each kind.
CALLED = {"normal": "normal law", "tangential": "friction law", "integrator": "integrator"}


class Registry:
    """The laws installed in this environment.

    Entry points of the group ``contactlab`` are read at the first use. A module is imported only
    when one of its laws is made, so that a broken plug-in stops no other plug-in.

    Names
    -----
    1. Each law has a unique name, ``distribution:kind.name``.
    2. ``kind.name`` alone means the law of the distribution ``contactlab`` if it offers that name;
       else the law of the only distribution that offers it. If several others do, it is refused.
    3. ``CONTACTLAB_BLOCK_PLUGINS`` takes names of either form, and names of distributions, whose
       laws are then all blocked. Blocked laws do not count in rule 2.
    4. A name without its kind means the law of this name if only one kind has it.
    """

    def __init__(self) -> None:
        self._loaded: dict[str, tuple[type[Law], PluginInfo]] = {}
        self._meant: dict[tuple[str, str, int], str] = {}

    @cached_property
    def _modules(self) -> list[tuple[str, str]]:
        """Names and modules of the laws at first use: reading entry points takes long."""
        return [(info.qualified, info.module.partition(":")[0]) for info in self.installed()]

    def installed(self) -> list[PluginInfo]:
        """Return every law, installed or registered, sorted by kind and name, without an import."""
        infos = MANAGER.installed()
        here = self._here()
        laws = [info for info in infos if info.kind not in (COMMAND, PAGE, *COLLECTIONS)]
        laws += [info for _, info in here.values()]
        return sorted(
            laws, key=lambda each: (RANK.get(each.kind, len(RANK)), each.name, each.distribution)
        )

    def _here(self) -> dict[str, tuple[type[Law], PluginInfo]]:
        """Return the laws that are registered at run time, by their names with "this program"."""
        blocking = read_blocks()
        found = {}
        for name, law in MANAGER.laws.items():
            own = PluginInfo(name, HERE, "", law.__module__, blocks(blocking, name, HERE))
            found[own.qualified] = (check_class(law, own.kind, own.source), own)
        return found

    def names(self, kind: str | None = None) -> list[str]:
        """Return the shortest names of laws that can be made, of one kind or of all kinds."""
        usable = (info for info in self.installed() if info.usable)
        return sorted({info.known_as for info in usable if kind in (None, info.kind)})

    def info(self, name: str) -> PluginInfo:
        """Return the installed law that ``name`` means.

        Raises
        ------
        ValueError
            If the name is not installed (with the nearest match), is blocked, or is offered by
            several distributions other than ``contactlab``.
        PluginError
            If the name in the entry point is malformed.
        """
        if is_place(name):
            found = law_at(name)
            info = PluginInfo(
                f"{law_kind(found)}.{name}", "not installed", "", found.__module__, False
            )
            return IN_FILES.get(found, info)
        distribution, plain = split_name(name)
        installed = self.installed()
        matches = [info for info in installed if info.name == name] or [
            info
            for info in installed
            if info.name == plain and same_distribution(info.distribution, distribution)
        ]
        if not matches and "." not in plain:
            full = {info.name for info in installed if info.name.partition(".")[2] == plain}
            if len(full) == 1:  # the only law of this name
                return self.info(f"{distribution}:{full.pop()}".removeprefix(":"))
        if not matches:
            raise self._refuse_name(name)
        if matches[0].malformed:
            rule = f"the name must be one of {', '.join(KINDS)}, a dot, a name in lower case"
            raise PluginError(f"{matches[0].source}: {rule}")
        usable = [info for info in matches if not info.blocked]
        if not usable:
            raise refuse("name", name, f"is blocked by {BLOCK_VARIABLE}", "unset it to use the law")
        law = resolve_name(usable)
        if law is None:
            raise ValueError(clash(usable))
        return law

    def at_hand(self, info: PluginInfo) -> bool:
        """Return True for contactlab's own laws, and for plug-ins that were imported before."""
        return info.distribution == PROJECT or info.qualified in self._loaded

    def law_class(self, name: str) -> type[Law]:
        """Import the plug-in that offers ``name`` and return the law's class."""
        if is_place(name):
            return law_at(name)
        # blocking and registration change the meaning of a name
        key = name, os.environ.get(BLOCK_VARIABLE, ""), MANAGER.changes
        if self._meant.get(key) not in self._loaded:
            info = self.info(name)
            if info.distribution == HERE:
                self._loaded |= self._here()
            elif info.qualified not in self._loaded:
                self._loaded[info.qualified] = (law_class(info), info)
            self._meant[key] = info.qualified
        return self._loaded[self._meant[key]][0]

    @overload
    def create(self, name: NormalName, **options: object) -> NormalLaw: ...
    @overload
    def create(self, name: TangentialName, **options: object) -> TangentialLaw: ...
    @overload
    def create(self, name: IntegratorName, **options: object) -> Integrator: ...
    @overload
    def create(self, name: str, **options: object) -> Law: ...
    def create(self, name: str, **options: object) -> Law:
        """Return a new law: ``create("tangential.annulus", annuli=50)``.

        Raises
        ------
        ValueError
            If the name is not installed, or an option is unknown or out of range.
        PluginError
            If the plug-in cannot be imported or breaks the contract, with its traceback.
        """
        of_kind("name", name, str, rule="must be a text such as 'tangential.springs'")
        law = self.law_class(name)
        for option, value in options.items():
            if option not in (parameters := _parameters(law)):
                names = ", ".join(parameters) or "none"
                remedy = f"{nearest(option, parameters)}its options: {names}"
                raise refuse(option, value, f"{short_name(name)} has no such option", remedy)
        for option, required in _parameters(law).items():
            if required and option not in options:
                raise ValueError(
                    f"{name}: {option} must be given; in Python create({name!r}, {option}=...), "
                    f"on the command line --set {law_kind(law)}.{option}=..."
                )
        try:
            return law(**options)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error

    def short_name(self, law: Law | type[Law]) -> str:
        """Return the name of an installed law, without its kind; else the name of its class.

        A law in a file has the name of the file and of the class.
        """
        law_class = class_of(law)
        info = self._origin(law_class)
        return law_class.__name__ if info is None else info.name.partition(".")[2]

    def describe(self, law: Law | type[Law]) -> str:
        """Return a law's name, distribution and version; its class if no distribution offers it."""
        law_class = class_of(law)
        info = self._origin(law_class)
        if info is None:
            return f"{law_class.__module__}.{law_class.__qualname__} (not registered)"
        return f"{info.name.partition('.')[2]} ({info.distribution} {info.version})"

    def _origin(self, law_class: type[Law]) -> PluginInfo | None:
        """Return the plug-in that offers this class, imported by name or not; None if none does."""
        if law_class in IN_FILES:
            return IN_FILES[law_class]
        for name, module in self._modules:
            if f"{law_class.__module__}.".startswith(f"{module}."):
                with contextlib.suppress(ValueError, PluginError):
                    self.law_class(name)
        return next((info for each, info in self._loaded.values() if each is law_class), None)

    def _refuse_name(self, name: str) -> ValueError:
        """Return the refusal of a name that is not installed, with the nearest installed name."""
        distribution, plain = split_name(str(name))
        kind, _, short = plain.rpartition(".")
        offered = [
            info.qualified
            for info in self.installed()
            if plain in (info.name, short_name(info.name))
        ]
        if offered:
            hint = f"write {' or '.join(map(repr, offered))}; "
        elif distribution:
            others = {info.distribution for info in self.installed()} - {distribution}
            hint = nearest(distribution, others)
        else:  # kinds are left out, which would make any two names similar
            near = nearest(short, [short_name(each) for each in self.names(kind)])
            hint = near or nearest(short, self.names(), alike=0.5 if kind not in KINDS else 1.0)
        typed = f"{distribution}:{short}" if distribution else short
        what = CALLED.get(kind, f"{kind} law" if kind else "law")
        return ValueError(
            f"no {what} {typed!r} is installed; {hint}all names: contactlab plugins list"
        )


@lru_cache(maxsize=256)
def _parameters(law: type[Law]) -> dict[str, bool]:
    """Return the options of a law, and whether each must be given; reading a signature is slow."""
    import inspect

    parameters = inspect.signature(law).parameters
    return {name: each.default is each.empty for name, each in parameters.items()}


REGISTRY = Registry()
