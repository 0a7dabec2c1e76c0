"""Public names of a package that are imported on first use."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def imported_on_use(package: str, modules: Mapping[str, str]) -> Callable[[str], Any]:
    """Return the function ``__getattr__`` of a package.

    Parameters
    ----------
    package : str
        Name of the package, its ``__name__``.
    modules : mapping of str to str
        For each public name, the module in ``contactlab`` that defines it, or that it is, if the
        module has no such name.
    """

    def __getattr__(name: str) -> Any:  # noqa: N807
        """Return a public name, imported on first use and kept."""
        if name not in modules:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module = import_module(f"contactlab.{modules[name]}")
        value = getattr(module, name, module)
        setattr(sys.modules[package], name, value)
        return value

    return __getattr__
