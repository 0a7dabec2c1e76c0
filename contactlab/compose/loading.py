"""Loading of a plug-in: imports its module, calls its hook and checks its law."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator

import numpy as np
import pluggy

from contactlab.compose import hookspecs
from contactlab.compose.installed import GROUP, PluginInfo, short
from contactlab.compose.older import REMEDY, other_version
from contactlab.contracts.law import API_VERSION, Law


class PluginError(RuntimeError):
    """A plug-in is broken or conflicts with another; the message names plug-in and distribution."""


def law_class(info: PluginInfo) -> type[Law]:
    """Return the class of an installed law, from the hook of its module.

    Raises
    ------
    PluginError
        If the plug-in cannot be imported or has no hook, or its law breaks the contract.
    """
    from importlib import metadata

    source = info.source
    with _guarded(source, "could not be imported"):
        module = metadata.EntryPoint(info.name, info.module, GROUP).load()
    manager = pluggy.PluginManager(hookspecs.PROJECT)  # of its own: modules do not see each other
    manager.add_hookspecs(hookspecs)
    try:
        manager.register(module, name=info.module)
        manager.check_pending()
    except Exception as error:
        raise PluginError(f"{source} does not fit the hooks: {short(error)}") from error
    if not manager.get_hookcallers(module):
        raise PluginError(
            f"{source} has no hook: define @contactlab.hookimpl def contactlab_law(name)"
        )
    with _guarded(source, "raised when asked for its law"):
        law = manager.hook.contactlab_law(name=info.name)
    return _checked(law, info, source)


@contextlib.contextmanager
def _guarded(source: str, failed: str) -> Iterator[None]:
    """Keep a plug-in from ending the program, printing to stdout or changing numpy's settings."""
    # Every exception but an interruption becomes a PluginError. Output goes to stderr, because a
    # program may read stdout.
    try:
        with np.errstate(), contextlib.redirect_stdout(sys.stderr):
            yield
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        if (sentence := other_version(error)) is not None:
            raise PluginError(f"{source} {sentence}") from None
        raise PluginError(f"{source} {failed}: {short(error)}") from error


def _checked(law: object, info: PluginInfo, source: str) -> type[Law]:
    """Return ``law``, or raise PluginError unless it is a law's class of right kind and version."""
    if not (isinstance(law, type) and issubclass(law, Law)):
        raise PluginError(f"{source} returned {law!r}, which is not the class of a law")
    if law.kind != info.kind:
        raise PluginError(
            f"{source} returned {law.__name__}, a {law.kind} law; "
            "each entry point needs a module of its own with a function contactlab_law"
        )
    if (complaint := outdated(law)) is not None:
        raise PluginError(f"{source}: {complaint}")
    if law.__abstractmethods__:
        missing = ", ".join(sorted(law.__abstractmethods__))
        raise PluginError(f"{source}: {law.__name__} does not define {missing}")
    return law


def outdated(law: type[Law]) -> str | None:
    """Return a complaint on the version of the contracts that a law was written for, or None."""
    version = getattr(law, "api_version", None)
    if version == API_VERSION:
        return None
    written = f"write api_version: ClassVar[int] = {API_VERSION} in its class"
    if isinstance(version, int) and version < API_VERSION:
        return (
            f"{law.__name__} was written for version {version} of the contracts, contactlab has "
            f"{API_VERSION}; {REMEDY}; then {written}"
        )
    return (
        f"{law.__name__}.api_version is {version!r}, contactlab has {API_VERSION}; if the law "
        f"keeps to these contracts, {written}"
    )
