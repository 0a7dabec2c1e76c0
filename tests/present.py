"""What some tests need and may be missing: an extra, or the repository around the package."""

from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

import pytest

import contactlab
from contactlab.registration.manager import commands

#: The repository or source archive that the tests stand in, and the package that they test.
ROOT, PACKAGE = Path(__file__).parents[1], Path(contactlab.__file__).parent
#: Why a test is skipped where the package is not the one beside the tests.
INSTALLED = "reads sources that are not in an installed package"


def extra(module):
    """Return a mark that skips a test where an extra, or a folder of plugins, is missing."""
    return pytest.mark.skipif(find_spec(module) is None, reason=f"needs {module}")


needs_sources = pytest.mark.skipif(not (ROOT / "contactlab").is_dir(), reason=INSTALLED)


def of_commands(*rows):
    """Return those rows of a table, words or parameters, whose command is installed.

    The first word of a row is the command; its folder under plugins may be taken out.
    """
    return [row for row in rows if command_of(row) in commands("contactlab")]


def command_of(row):
    """Return the first word of a row of words, of a line, or of parameters."""
    while not isinstance(row, str):
        row = getattr(row, "values", row)[0]
    return row.split()[0]


@contextmanager
def column(*columns):
    """Have columns of a plug-in while a test runs."""

    class Brings:
        @contactlab.hookimpl
        def contactlab_columns(self):
            return columns

    name = contactlab.register(Brings(), "columns of a test")
    try:
        yield
    finally:
        contactlab.plugin_manager().unregister(name=name)
