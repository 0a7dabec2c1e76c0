"""The hooks of plug-ins: what each is asked for, and what it answers.

An entry point of the group ``contactlab`` has a kind and a name: ``tangential.brush``,
``materials.polymers``, ``command.hello``. Its value is a module or an object with the hook of that
kind, marked by ``hookimpl``; of a law it may be the class itself.

A law and a command are asked for by name, of one plug-in. Every other kind is asked for at once, of
all plug-ins that are installed or registered; a module is imported when its kind is first asked
for.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import pluggy

from contactlab.registration.names import PROJECT

if TYPE_CHECKING:
    import argparse

#: Marks a plug-in's implementation: ``@contactlab.hookimpl``.
hookimpl = pluggy.HookimplMarker(PROJECT)
_specification = pluggy.HookspecMarker(PROJECT)
#: The function that runs a command: it takes the arguments and returns the exit status.
Execute: TypeAlias = "Callable[[argparse.Namespace], int]"

#: Remedy for a plug-in without its hook.
REMEDIES = {
    "contactlab_law": "name the class in the entry point, {module}:Class, "
    "or define @contactlab.hookimpl def contactlab_law(name)",
    "contactlab_command": "name a module in the entry point, "
    "which defines @contactlab.hookimpl def contactlab_command(parser)",
}

REMEDY = "define @contactlab.hookimpl def {hook} in {module}"


class PluginError(RuntimeError):
    """A plug-in is broken or conflicts with another; the message names plug-in and distribution."""


@_specification(firstresult=True)
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


@_specification(firstresult=True)
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


@_specification
def contactlab_materials() -> Iterable[Any] | None:
    """Return ``contactlab.materials.Entry`` objects: a name, numbers in SI units, sources."""


@_specification
def contactlab_columns() -> Iterable[Any] | None:
    """Return ``contactlab.outcome.columns.Column`` objects: a name, a unit, a value of a result.

    Tables, files, frames, figures, ``compare`` and fits know them.
    """


@_specification
def contactlab_shapes() -> Iterable[Any] | None:
    """Return ``contactlab.impact.shapes.Shape`` objects, named by ``shape = "..."`` of a file."""


@_specification
def contactlab_cases(method: Any, quick: bool) -> Iterable[Any] | None:
    """Return the stiff and extreme cases of ``contactlab stability`` for one method."""


@_specification
def contactlab_checks() -> Iterable[Any] | None:
    """Return functions for ``contactlab validate``, which take nothing and return a ``Finding``."""


@_specification
def contactlab_measurements() -> Iterable[Any] | None:
    """Return ``Source`` and ``Slopes`` objects of ``contactlab.study.evidence``: measured sets."""


@_specification
def contactlab_cautions(scene: Any, laws: Any) -> Iterable[str] | None:
    """Return sentences for the plan of a run; asked in every run, so it must be quick."""


@_specification
def contactlab_options(command: str, parser: argparse.ArgumentParser) -> None:
    """Add options to a command of another plug-in."""


@_specification(firstresult=True)
def contactlab_scene_file(arguments: argparse.Namespace, read: Callable[..., Any]) -> Any:
    """Return the scene file of a command with the options of this plug-in; None if none is given.

    ``read`` returns the file; ``defaults`` are velocities to use where the file has none.
    """


#: The hook that answers for each kind, and the further hooks of a kind.
HOOKS = {
    "normal": "contactlab_law", "tangential": "contactlab_law", "integrator": "contactlab_law",
    "command": "contactlab_command",
    "materials": "contactlab_materials", "columns": "contactlab_columns",
    "shapes": "contactlab_shapes", "cases": "contactlab_cases", "checks": "contactlab_checks",
    "measurements": "contactlab_measurements", "cautions": "contactlab_cautions",
    "options": "contactlab_options",
}  # fmt: skip
FURTHER = {"options": ("contactlab_scene_file",)}


@contextlib.contextmanager
def guard(source: str, failed: str, *, silent: bool = True) -> Iterator[None]:
    """Keep a plug-in from ending the program or printing to stdout, which a program may read."""
    try:
        # all threads share sys.stdout: hooks of every run leave it alone
        with contextlib.redirect_stdout(sys.stderr) if silent else contextlib.nullcontext():
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
