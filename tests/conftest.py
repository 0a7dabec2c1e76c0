"""Profiles of hypothesis, quick by default, long with -m slow; distributions made on the spot."""

from __future__ import annotations

import gc
import os
import sys
from importlib.util import find_spec

# One thread for each process: the tests themselves run side by side (pytest -n auto).
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import HealthCheck, settings

#: Examples of each property in the long run, and in the quick one.
LONG = int(os.environ.get("CONTACTLAB_EXAMPLES", "5000"))
QUICK = 60

#: A law of a stranger.
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

#: Folders of tests that belong to a package under plugins/, which can be taken out.
SHELVES = {
    "contactlab_fit": ("fitting",),
    "contactlab_halfspace": ("halfspace",),
    "contactlab_pages": ("pages", "browser"),
}
collect_ignore = [
    folder for package, folders in SHELVES.items() if find_spec(package) is None
    for folder in folders
]  # fmt: skip

settings.register_profile(
    "quick", max_examples=QUICK, deadline=None, derandomize=True, database=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)  # fmt: skip
settings.register_profile(
    "long", settings.get_profile("quick"), max_examples=LONG, derandomize=False
)
settings.load_profile("long" if "CONTACTLAB_EXAMPLES" in os.environ else "quick")


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Collect without a search for garbage, which takes a third of the time and finds little.

    Tests are run with fewer searches, of what they have made alone.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(20_000)
        gc.enable()


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


def pytest_terminal_summary(terminalreporter):
    """Say how many inputs the properties were tried on."""
    for name, module in list(sys.modules.items()):
        if "test_injected_nan" in name:
            if not any(module.TRIED.values()):
                continue
            counts = ", ".join(f"{count} {what}" for what, count in module.TRIED.items())
            terminalreporter.write_line(f"injected: {counts}")
    modules = [module for name, module in sys.modules.items() if "test_bad_input" in name]
    tried = {name: count for module in modules for name, count in module.TRIED.items()}
    if tried:
        counts = ", ".join(f"{name} {count}" for name, count in sorted(tried.items()))
        total = sum(tried.values())
        terminalreporter.write_line(f"inputs tried: {total} ({counts})")


@pytest.fixture
def law_source():
    return LAW


@pytest.fixture
def registry():
    from contactlab.registry.registry import Registry

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
