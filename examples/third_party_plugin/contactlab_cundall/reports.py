"""Cases for ``contactlab stability``; a check and a measured set for ``contactlab validate``."""

from collections.abc import Callable
from pathlib import Path

from contactlab import Scene, Simulation
from contactlab.plugin import Case, Finding, Source, hookimpl


@hookimpl
def contactlab_cases() -> list[Case]:
    """Return a scene that every law is to survive, by family and label."""
    return [Case("heavy", "chi=500", lambda: Scene.nondimensional(psi1=2.0, chi=500.0))]


def gross_slip() -> Finding:
    """Return the distance of a grazing impact from psi1 - 4 chi."""
    psi1, chi = 50.0, 1.44
    psi2 = Simulation().run(Scene.nondimensional(psi1=psi1, chi=chi)).psi2
    difference = abs(psi2 - (psi1 - 4.0 * chi))
    return Finding(what="grazing", against="psi1 - 4 chi", difference=difference, bound=1e-12)


@hookimpl
def contactlab_checks() -> list[Callable[[], Finding]]:
    """Return the functions that ``contactlab validate`` calls."""
    return [gross_slip]


@hookimpl
def contactlab_measurements() -> list[Source]:
    """Return the set: a scene file with [[measured]] tables beside this module."""
    path = Path(__file__).with_name("drops.toml")
    return [Source(name="drops", kind="experiment", path=path)]
