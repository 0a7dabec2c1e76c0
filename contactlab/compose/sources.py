"""The user's own code: modules outside the installed packages that a law needs, with checksums.

Nothing is imported here: imports are read from the text of a file, so that a module counts before
its first import too.
"""

from __future__ import annotations

import ast
import os
import sys
import sysconfig
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.machinery import PathFinder
from importlib.util import find_spec, resolve_name
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple
from zlib import crc32

from contactlab.outcome.files import stamp
from contactlab.registration.names import PROJECT

STANDARD = os.path.realpath(sysconfig.get_path("stdlib")) + os.sep
INSTALLED = ("site-packages", "dist-packages")
#: Names of the script that runs, here and in a process of a pool: it cannot be imported again.
SCRIPTS = ("__main__", "__mp_main__")


class Source(NamedTuple):
    """The code of a module when the module was first seen here.

    A file may change after its import: checksum and imports are those of the first look at
    ``module``, as ``spec`` imported it. ``module`` is None before the import; ``root`` is the
    folder in which Python finds the module, or the package around it.
    """

    module: ModuleType | None
    spec: Any
    path: str
    root: str
    stamp: tuple[int, ...]
    checksum: str
    imports: frozenset[str]


SEEN: dict[str, Source] = {}


def code_of(names: Iterable[str]) -> dict[str, str]:
    """Return checksums of the user's modules that some modules import, themselves included.

    Parameters
    ----------
    names : iterable of str
        Names in ``sys.modules``. A module that a package manager installed is left out: its
        version tells its code.

    Returns
    -------
    dict of str to str
        Checksums by the name of the module; by the file name for scripts and laws in files.
    """
    waiting, found = [(name, "") for name in names], dict[str, Source | None]()
    while waiting:
        name, folder = waiting.pop()
        if name not in found:
            found[name] = source = _source(name, folder)
            waiting += [(each, source.root) for each in source.imports] if source else []
    code = {_label(name, source): source.checksum for name, source in found.items() if source}
    return dict(sorted(code.items()))


def checksum(content: bytes) -> str:
    """Return the checksum of a text, eight hexadecimal digits."""
    return f"{crc32(content):08x}"


def without_file(names: Iterable[str]) -> list[str]:
    """Return the modules whose code is in no file, as that of a notebook is."""
    own = (name for name in names if name.partition(".")[0] not in sys.stdlib_module_names)
    files = {name: getattr(sys.modules.get(name), "__file__", None) or "" for name in own}
    return [name for name, file in files.items() if not os.path.isfile(file)]


def forget_changed(folder: str) -> None:
    """Let Python import changed modules of a folder again, and the modules that import them."""
    beside = {
        name: source
        for name, source in SEEN.items()
        if source.root == folder and name not in SCRIPTS
    }
    changed = {name for name, source in beside.items() if stamp(source.path) != source.stamp}
    while users := {name for name in beside.keys() - changed if beside[name].imports & changed}:
        changed |= users
    for name in changed:
        del SEEN[name]
        module = sys.modules.pop(name, None)
        package, _, last = name.rpartition(".")
        # "from package import name" takes the attribute of the package first
        if module and getattr(sys.modules.get(package), last, None) is module:
            delattr(sys.modules[package], last)


def mistaken(name: str) -> str | None:
    """Return a file that a law's file imports in place of its neighbour of that name, or None."""
    # Python has one module of a name: that of another law's folder, or of an earlier folder.
    for each in sorted(SEEN.keys() & SEEN[name].imports):
        beside = os.path.join(SEEN[name].root, each)
        files = filter(os.path.isfile, (f"{beside}.py", os.path.join(beside, "__init__.py")))
        if (real := [*map(os.path.realpath, files)]) and SEEN[each].path not in real:
            return SEEN[each].path
    return None


@cache
def own_code() -> str:
    """Return a checksum of contactlab if it is a working copy; empty if it is installed."""
    folder = Path(__file__).parents[1]
    if not _is_users(str(folder)):
        return ""
    return checksum(b"".join(path.read_bytes() for path in sorted(folder.rglob("*.py"))))


def _source(name: str, folder: str) -> Source | None:
    """Return the code of a user's module that a file in ``folder`` imports; None for others."""
    top = name.partition(".")[0]
    if top == PROJECT or top in sys.stdlib_module_names:
        return None
    module, path = sys.modules.get(name), _file(name, folder)
    if path is None or not _is_users(path):
        return None
    spec, now = getattr(module, "__spec__", None), stamp(path)
    seen = SEEN.get(name)
    same = seen is not None and seen.module is module and seen.spec is spec and seen.path == path
    if seen and same and (module or seen.stamp == now):
        return seen
    content, is_package = Path(path).read_bytes(), Path(path).name == "__init__.py"
    package = name if is_package else name.rpartition(".")[0]
    if module:
        package = module.__package__ or ""
    values = list(vars(module).values()) if module else []
    held = [each.__name__ for each in values if isinstance(each, ModuleType)]
    # A package has its modules as attributes, whoever imported them.
    held = [each for each in held if not each.startswith(f"{name}.")]
    imports = _imports(content, package) if path.endswith(".py") else ()
    above = (name.count(".") if module is None or spec else 0) + is_package
    SEEN[name] = Source(
        module=module,
        spec=spec,
        path=path,
        root=str(Path(path).parents[above]),
        stamp=now,
        checksum=checksum(content),
        imports=frozenset([*held, *imports]),
    )
    return SEEN[name]


def _label(name: str, source: Source) -> str:
    """Return the name of a module, or the file name of one that is imported by no name."""
    nameless = name in SCRIPTS or (source.module and not source.spec)
    return Path(source.path).name if nameless else name


def _file(name: str, folder: str) -> str | None:
    """Return the real path of a module's file, imported or not; None if it has none."""
    if name in sys.modules:
        path = getattr(sys.modules[name], "__file__", None)
    else:
        path = getattr(_spec(name, folder), "origin", None)
    return os.path.realpath(path) if path and os.path.isfile(path) else None


def _spec(name: str, folder: str) -> Any:
    """Return where Python would find a module, or None."""
    above = name.rpartition(".")[0]
    if not above:  # a law's file is loaded with its folder at the end of the path
        return find_spec(name) or PathFinder.find_spec(name, [folder])
    folders = getattr(sys.modules.get(above), "__path__", None)
    if folders is None and above not in sys.modules:
        folders = getattr(_spec(above, folder), "submodule_search_locations", None)
    return folders and PathFinder.find_spec(name, folders)


@cache
def _is_users(path: str) -> bool:
    """Return True for a file that neither Python nor a package manager installed."""
    return not path.startswith(STANDARD) and not set(INSTALLED).intersection(Path(path).parts)


def _imports(content: bytes, package: str) -> Iterator[str]:
    """Yield the names in the import statements of a file, which may be names of modules."""
    try:
        statements = list(ast.walk(ast.parse(content)))
    except (SyntaxError, ValueError):
        return
    for statement in statements:
        if isinstance(statement, ast.Import):
            for each in statement.names:
                yield from _with_packages(each.name)
        elif isinstance(statement, ast.ImportFrom):
            try:
                name = resolve_name("." * statement.level + (statement.module or ""), package)
            except ImportError:  # beyond the top of its package
                continue
            yield from _with_packages(name)
            yield from (f"{name}.{each.name}" for each in statement.names)


def _with_packages(name: str) -> Iterator[str]:
    """Yield a name and those of the packages around it, which are imported too."""
    while name:
        yield name
        name = name.rpartition(".")[0]
