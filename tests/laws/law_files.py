"""Laws out of files that are not installed: the examples."""

import functools
import importlib.util
import sys
from pathlib import Path

EXAMPLES = Path(__file__).parents[2] / "examples"


def of_file(path, name):
    """The class ``name`` of a Python file, which can be pickled as if it were imported."""
    return getattr(_module(path), name)


@functools.cache
def _module(path):
    """The module of a file, loaded once: a class can be pickled while its module has it."""
    spec = importlib.util.spec_from_file_location(f"example_{path.stem}", path)
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
