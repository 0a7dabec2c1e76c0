"""The half-space is asked for on the command line, with its fixtures."""

import importlib.util
from pathlib import Path

from tests.timed_once import timed_once  # noqa: F401

_path = Path(__file__).parents[1] / "cli" / "conftest.py"
_spec = importlib.util.spec_from_file_location("cli_fixtures", _path)
_cli = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_cli)

run = _cli.run
