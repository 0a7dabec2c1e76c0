"""The hooks of plug-ins, and how the plug-in behind an entry point is asked for its answer.

An entry point of the group ``contactlab`` has a kind and a name: ``tangential.brush``,
``command.hello``. Its value is a module with the hook of that kind, marked by ``hookimpl``; of a
law it may be the class itself, which stands for a hook that returns it.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeAlias

import pluggy

from contactlab.compose.names import PROJECT, PluginInfo

if TYPE_CHECKING:
    import argparse

#: Marks a plug-in's implementation: ``@contactlab.hookimpl``.
hookimpl = pluggy.HookimplMarker(PROJECT)
_specification = pluggy.HookspecMarker(PROJECT)(firstresult=True)
#: What runs a command: from its arguments to the exit status.
Execute: TypeAlias = "Callable[[argparse.Namespace], int]"

#: What a plug-in without the hook is told.
REMEDIES = {
    "contactlab_law": "name the class in the entry point, {module}:Class, "
    "or define @contactlab.hookimpl def contactlab_law(name)",
    "contactlab_command": "name a module in the entry point, "
    "which defines @contactlab.hookimpl def contactlab_command(parser)",
}


class PluginError(RuntimeError):
    """A plug-in is broken or conflicts with another; the message names plug-in and distribution."""


@_specification
def contactlab_law(name: str) -> type | None:
    """Return the class of the law called ``name``, or None; never called in a step.

    Parameters
    ----------
    name : str
        The entry point's name, kind and law: ``"tangential.annulus"``. A module with a single
        entry point may leave the argument out.

    Returns
    -------
    type
        A subclass of ``NormalLaw``, ``TangentialLaw`` or ``Integrator`` whose parameters are
        keyword arguments.
    """


@_specification
def contactlab_command(name: str, parser: argparse.ArgumentParser) -> Execute | None:
    """Add the arguments of a subcommand, and return the function that runs it.

    The first line of the module's docstring is the summary in ``contactlab --help``, and the rest,
    examples, ends the command's own help. ``contactlab --help`` reads summaries from the files, and
    a command's own help imports the module of that command alone.

    Parameters
    ----------
    name : str
        The entry point's name: ``"command.hello"``. It may be left out.
    parser : argparse.ArgumentParser
        The parser of the subcommand.

    Returns
    -------
    callable
        Takes the parsed arguments and returns the exit status: 0 of success, 1 if what was asked
        for failed. It raises ``ValueError`` for bad input, which is printed on one line.
    """


class Named:
    """The plug-in of an entry point that names a law's class itself."""

    def __init__(self, value: object) -> None:
        self.value = value

    @hookimpl
    def contactlab_law(self) -> object:
        """Return the class."""
        return self.value


def ask(info: PluginInfo, hook: str, **arguments: object) -> Any:
    """Import the plug-in of an entry point, and return what its hook answers.

    Raises
    ------
    PluginError
        If the plug-in cannot be imported, has no such hook, or raises an exception.
    """
    from importlib import metadata

    with guarded(info.source, "could not be imported"):
        plugin = metadata.EntryPoint(info.name, info.module, PROJECT).load()
    if not isinstance(plugin, ModuleType):
        plugin = Named(plugin)
    manager = pluggy.PluginManager(PROJECT)  # of its own: modules do not see each other
    manager.add_hookspecs(sys.modules[__name__])
    try:
        manager.register(plugin, name=info.module)
        manager.check_pending()
    except Exception as error:
        raise PluginError(f"{info.source} does not fit the hooks: {short(error)}") from error
    caller = getattr(manager.hook, hook)
    if not caller.get_hookimpls():
        remedy = REMEDIES[hook].format(module=info.module)
        raise PluginError(f"{info.source} has no hook: {remedy}")
    with guarded(info.source, f"raised when asked for its {hook.rpartition('_')[2]}"):
        return caller(name=info.name, **arguments)


@contextlib.contextmanager
def guarded(source: str, failed: str) -> Iterator[None]:
    """Keep a plug-in from ending the program or printing to stdout, which a program may read."""
    try:
        with contextlib.redirect_stdout(sys.stderr):
            yield
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        own = ("<frozen", str(Path(__file__).parents[1]), os.path.dirname(importlib.__file__))
        frames = traceback.extract_tb(error.__traceback__)
        theirs = [frame for frame in frames if not frame.filename.startswith(own)]
        theirs = [] if isinstance(error, SyntaxError) else theirs  # it names its own place
        place = "".join(f" ({Path(f.filename).name}, line {f.lineno})" for f in theirs[-1:])
        raise PluginError(f"{source} {failed}: {short(error)}{place}") from error


def short(error: BaseException) -> str:
    """Return the class and the message of an exception."""
    return f"{type(error).__name__}: {error}"
