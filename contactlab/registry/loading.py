"""Loading of a law: asks its plug-in for the class or runs its file, and checks the class."""

from __future__ import annotations

import ast
import contextlib
import copyreg
import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from contactlab.contracts.law import Law, law_kind
from contactlab.numeric.checks import refuse
from contactlab.numeric.names import nearest
from contactlab.registration.hooks import PluginError, guard
from contactlab.registration.manager import MANAGER
from contactlab.registration.names import FILE, KINDS, PluginInfo, Untrusted
from contactlab.registry.law_classes import is_law_class, unfit

#: Laws that were loaded from files.
IN_FILES: dict[type[Law], PluginInfo] = {}
#: Modules of such files by path, with the stamp of the file that was run.
LOADED: dict[str, tuple[tuple[int, ...], ModuleType]] = {}


def law_class(info: PluginInfo) -> type[Law]:
    """Return the class of an installed law: its entry point names the class, or a hook's module.

    Raises
    ------
    PluginError
        If the plug-in cannot be imported or has no hook, or its law breaks the contract.
    """
    with np.errstate():  # a plug-in does not change numpy's settings
        law = MANAGER.ask(info)
    return check_class(law, info.kind, info.source)


def law_at(place: str) -> type[Law]:
    """Return the class of the law at a place: ``my_law.py:Stribeck``, ``package.module:Stribeck``.

    Raises
    ------
    ValueError
        If there is no such file, or no such law in the file; the message names the laws there.
        If a scene names the place without the user's word.
    PluginError
        If the file or module raises an exception, or the law breaks the contract.
    """
    from importlib import import_module

    where, _, title = place.rpartition(":") if not place.endswith(".py") else (place, "", "")
    if "\0" in place:
        raise refuse("name", place, "must not hold a null character")
    if isinstance(place, Untrusted):
        code = os.path.realpath(where) if where.endswith(".py") else where
        remedy = "if you trust it, add --allow-code, or in Python read_scene(path, allow_code=True)"
        raise refuse("name", place, f"the scene names code, which would run: {code!r}", remedy)
    if where.endswith(".py"):
        path = Path(os.path.expanduser(where))
        try:
            path.stat()
        except OSError as error:
            remedy = f"the path begins in {Path.cwd()}" if not path.is_absolute() else ""
            raise refuse("name", place, f"{where}: {error.strerror}", remedy) from None
        with np.errstate(), guard(repr(place), "could not be loaded"):
            module = _module(str(path.resolve()))
    else:
        with (
            np.errstate(),
            guard(repr(place), "could not be imported (a file is named by its path, x.py)"),
        ):
            module = import_module(where)
    law = getattr(module, title, None)
    if not is_law_class(law):
        laws = [name for name, each in _laws(module).items() if not each.__abstractmethods__]
        remedy = f"{nearest(title, laws)}{where} has {', '.join(laws) or 'no law'}"
        rule = f"{title} is no law" if title else "the class is missing"
        raise refuse("name", place, rule, remedy)
    return check_class(law, law_kind(law), repr(place))


def _module(path: str) -> ModuleType:
    """Return a file as a module, loaded again if it changed."""
    from contactlab.outcome.files import stamp
    from contactlab.registry.law_files import checksum  # only laws in files need it

    # A module's name has no dots, and no two paths may agree.
    name = path.removesuffix(".py").replace("%", "%25").replace(".", "%2E")
    before, now = LOADED.get(path), stamp(path)
    if before and before[0] == now and sys.modules.get(name) is before[1]:
        return before[1]
    module = ModuleType(name)
    module.__file__ = path
    sys.modules[name] = module
    folder, content = os.path.dirname(path), Path(path).read_bytes()
    sys.path.append(folder)  # for other files beside this one
    try:
        exec(compile(content, path, "exec", dont_inherit=True), vars(module))
    finally:
        with contextlib.suppress(ValueError):  # the file may have changed sys.path itself
            del sys.path[len(sys.path) - 1 - sys.path[::-1].index(folder)]
    if other := _mistaken(module, content, folder):
        raise ImportError(f"it imports {other}, not the file beside it; rename one of the two")
    for title, law in _laws(module).items():
        own = f"{law_kind(law)}.{Path(path).name}:{title}"
        IN_FILES[law] = PluginInfo(own, FILE, checksum(content), path, False)
        copyreg.pickle(law, _reduce)
    LOADED[path] = now, module
    return module


def _mistaken(module: ModuleType, content: bytes, folder: str) -> str | None:
    """Return a file that a law's file imports in place of its neighbour of that name, or None."""
    from contactlab.registry.law_files import is_users  # only laws in files need it

    # Python keeps one module of a name, which may be from another law's folder or an earlier one.
    names = [each.__name__ for each in vars(module).values() if isinstance(each, ModuleType)]
    for statement in ast.walk(ast.parse(content)):
        if isinstance(statement, ast.Import):
            names += [each.name for each in statement.names]
        elif isinstance(statement, ast.ImportFrom) and not statement.level:
            names.append(statement.module or "")
    for name in dict.fromkeys(each.partition(".")[0] for each in names):
        beside = os.path.join(folder, name)
        files = filter(os.path.isfile, (f"{beside}.py", os.path.join(beside, "__init__.py")))
        real = [*map(os.path.realpath, files)]
        used = os.path.realpath(getattr(sys.modules.get(name), "__file__", None) or os.devnull)
        if real and used not in (*real, os.path.realpath(os.devnull)) and is_users(used):
            return used
    return None


def _laws(module: ModuleType) -> dict[str, type[Law]]:
    """Return the laws that a module defines, by name."""
    own = (each for each in vars(module).values() if is_law_class(each))
    return {law.__name__: law for law in own if law.__module__ == module.__name__}


def _reduce(law: Law) -> tuple[Any, ...]:
    """Return what ``pickle`` writes of a law in a file: path, class and parameters."""
    return _blank, (IN_FILES[type(law)].known_as,), law.__reduce_ex__(2)[2]


def _blank(place: str) -> Law:
    """Return a law without its parameters, which ``pickle`` adds."""
    law = law_at(place)
    return law.__new__(law)


def check_class(law: object, kind: str, source: str) -> type[Law]:
    """Return ``law``, or raise PluginError unless it is a law's class of right kind and version."""
    if not is_law_class(law):
        raise PluginError(f"{source} returned {law!r}, which is not the class of a law")
    if (own := law_kind(law)) != kind:
        raise PluginError(
            f"{source} returned {law.__name__}, a {own} law; an entry point names "
            "a class of its kind, or a module whose contactlab_law returns one"
        )
    if (complaint := unfit(law)) is not None:
        raise PluginError(f"{source}: {complaint}")
    if law.__abstractmethods__:
        missing = ", ".join(sorted(law.__abstractmethods__))
        raise PluginError(f"{source}: {law.__name__} does not define {missing}")
    return law


def register(plugin: Any, name: str | None = None) -> str | None:
    """Register a plug-in in this program: an object with hooks, or the class of a law by name.

    ``register(Brush, "tangential.brush")``; ``register(MyHooks())``. The plug-in is known at once
    to all that ask for its kind, and forgotten by ``plugin_manager().unregister``.

    Parameters
    ----------
    plugin : object
        An object or a module with hooks, or the class of a law.
    name : str, optional
        The plug-in's name; of a law kind and name, by default that of the class in lower case.

    Raises
    ------
    PluginError
        If a hook or one of its arguments is unknown, or a law breaks the contract.
    ValueError
        If the name is taken, or what is given is no law and has no hooks.
    """
    if is_law_class(plugin):
        full = name or f"{law_kind(plugin)}.{plugin.__name__.lower()}"
        if plugin.__abstractmethods__:
            lacking = ", ".join(sorted(plugin.__abstractmethods__))
            raise PluginError(f"{full}: {plugin.__name__} lacks {lacking}")
        if (kind := full.partition(".")[0]) in KINDS:  # else the name is refused
            check_class(plugin, kind, full)
        return MANAGER.register_law(plugin, full)
    given = MANAGER.register(plugin, name)
    if not MANAGER.get_hookcallers(plugin):
        MANAGER.unregister(plugin)
        rule = "is not the class of a law, and has no hooks"
        remedy = "derive a law from a class of contactlab.contracts, mark a hook @hookimpl"
        raise refuse("plugin", plugin, rule, remedy)
    return given
