"""Distributions made up on the spot, found as installed ones are."""

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
def law_source():
    return LAW


@pytest.fixture
def registry():
    return Registry()


@pytest.fixture
def jax():
    found = pytest.importorskip("jax", reason="JAX is not installed: pip install '.[recipes]'")
    before = found.config.jax_enable_x64
    found.config.update("jax_enable_x64", True)
    yield found
    found.config.update("jax_enable_x64", before)


@pytest.fixture
def torch():
    return pytest.importorskip("torch", reason="PyTorch is not installed: pip install '.[recipes]'")
