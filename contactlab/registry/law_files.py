"""The user's own files that hold the classes of laws, with checksums of their text.

A change of functions, files of data and notebooks shows in what the law answers: a resumed
sweep computes blocks again (``recomputed.py``).
"""

from __future__ import annotations

import os
import sys
import sysconfig
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any
from zlib import crc32

import attrs

from contactlab.contracts.law import Law
from contactlab.registration.names import PROJECT

STANDARD = os.path.realpath(sysconfig.get_path("stdlib")) + os.sep
INSTALLED = ("site-packages", "dist-packages")
#: Names of the script that runs, here and in a process of a pool.
SCRIPTS = ("__main__", "__mp_main__")


def code_of(tree: object) -> dict[str, str]:
    """Return checksums of the files with the classes and functions in a tree of laws.

    The keys are names of modules, and file names for scripts and laws in files. Files that a
    package manager installed are left out, as a version tells their code; contactlab itself counts
    as one file where it is a working copy. A class of a notebook has no file.
    """
    code = {}
    for name in _modules(tree):
        module = sys.modules.get(name)
        path = getattr(module, "__file__", None)
        if name.partition(".")[0] == PROJECT or not path or not os.path.isfile(path):
            continue
        if is_users(os.path.realpath(path)):
            named = name not in SCRIPTS and getattr(module, "__spec__", None)
            code[name if named else Path(path).name] = checksum(Path(path).read_bytes())
    if own := _own_code():
        code[PROJECT] = own
    return dict(sorted(code.items()))


def checksum(content: bytes) -> str:
    """Return the checksum of a text, eight hexadecimal digits."""
    return f"{crc32(content):08x}"


@cache
def is_users(path: str) -> bool:
    """Return True for a file that neither Python nor a package manager installed."""
    return not path.startswith(STANDARD) and not set(INSTALLED).intersection(Path(path).parts)


@cache
def _own_code() -> str:
    """Return a checksum of contactlab if it is a working copy; empty if it is installed."""
    folder = Path(__file__).parents[1]
    if not is_users(str(folder)):
        return ""
    return checksum(b"".join(path.read_bytes() for path in sorted(folder.rglob("*.py"))))


def _modules(tree: Any) -> set[str]:
    """Return the names of the modules with the classes and functions in a tree of laws."""
    if isinstance(tree, Mapping | list | tuple | set | frozenset):
        values = tree.values() if isinstance(tree, Mapping) else tree
        return set[str]().union(*map(_modules, values))
    names = {each.__module__ for each in type(tree).__mro__}
    if isinstance(tree, type | FunctionType):
        names.add(tree.__module__ or "")
    if attrs.has(type(tree)):
        names |= _modules([getattr(tree, field.name) for field in attrs.fields(type(tree))])
    elif isinstance(tree, Law):
        names |= _modules(getattr(tree, "__dict__", {}))
    return names
