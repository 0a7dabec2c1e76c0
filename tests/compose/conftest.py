"""Distributions made up on the spot, found as installed ones are."""

import sys

import pytest

from contactlab.compose.registry import Registry

LAW = """
from typing import ClassVar
import attrs
import contactlab
from contactlab.contracts import SteppedTangentialLaw, TangentialResponse

@attrs.frozen(kw_only=True)
class Mine(SteppedTangentialLaw):
    api_version: ClassVar[int] = 2
    def start(self, scene, normal):
        return 0.0
    def advance(self, state, increment, before, after):
        return TangentialResponse(0.0, 0.0), state

@contactlab.hookimpl
def contactlab_law(name):
    return Mine
"""


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Return a function that installs a distribution with one module and its entry points."""
    monkeypatch.syspath_prepend(str(tmp_path))
    modules = []

    def install(distribution, module, source, *names):
        path = module.partition(":")[0]
        (tmp_path / f"{path}.py").write_text(source, encoding="utf-8")
        info = tmp_path / f"{distribution}-1.5.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(
            f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 1.5\n"
        )
        points = "\n".join(f"{name} = {module}" for name in names)
        (info / "entry_points.txt").write_text(f"[contactlab]\n{points}\n")
        modules.append(path)

    yield install
    for module in modules:
        sys.modules.pop(module, None)


@pytest.fixture
def law_source():
    return LAW


@pytest.fixture
def registry():
    return Registry()
