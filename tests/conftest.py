"""Profiles of hypothesis: quick and always the same by default, long with -m slow."""

from __future__ import annotations

import os
import sys

# One thread for each process: the tests themselves run side by side (pytest -n auto).
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from hypothesis import HealthCheck, settings

#: Examples of each property in the long run, and in the quick one.
LONG = int(os.environ.get("CONTACTLAB_EXAMPLES", "5000"))
QUICK = 60

settings.register_profile(
    "quick", max_examples=QUICK, deadline=None, derandomize=True, database=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)  # fmt: skip
settings.register_profile(
    "long", settings.get_profile("quick"), max_examples=LONG, derandomize=False
)
settings.load_profile("long" if "CONTACTLAB_EXAMPLES" in os.environ else "quick")


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
