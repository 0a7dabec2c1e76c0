"""Largest force, largest approach and duration of normal impacts, as other codes' tests have them.

Chung & Ooi, Granular Matter 13 (2011) 643-656, doi:10.1007/s10035-011-0277-0, tests 1 and 2:
Hertz's theory, read off their figures by the authors of the benchmarks of Kratos and Cabana.
Where two read it, the mean stands here.
"""

from __future__ import annotations

from typing import NamedTuple

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene

#: Stiff enough for a plane that is to be rigid, in Pa.
RIGID = 1e25


class Scalars(NamedTuple):
    """A normal impact, and its force in N, approach in m and duration in s as far as known."""

    name: str
    scene: Scene
    force: float | None = None
    approach: float | None = None
    duration: float | None = None


def hertz_scalars() -> tuple[Scalars, ...]:
    """Return the impacts of tests 1 and 2."""
    return (
        Scalars("test 1, glass", _spheres(48e9, 0.20, 2800.0), 10.7055e3, 274.96e-6, 40.48e-6),
        Scalars("test 1, limestone", _spheres(20e9, 0.25, 2500.0), 7108.0),
        Scalars("test 2, aluminium", _on_plane(70e9, 0.30, 2699.0), 11.357e3, 49.855e-6, 727.5e-6),
        Scalars("test 2, magnesium", _on_plane(40e9, 0.35, 1800.0), 7233.0),
    )


def _spheres(young: float, poisson: float, density: float) -> Scene:
    """Return test 1: two like spheres of 10 mm radius that close at 20 m/s."""
    material = Material(young_modulus=young, poisson_ratio=poisson, density=density)
    return Scene(Sphere(0.01, material), Sphere(0.01, material), 0.0, 20.0)


def _on_plane(young: float, poisson: float, density: float) -> Scene:
    """Return test 2: a sphere of 0.1 m radius that meets a rigid plane at 0.2 m/s."""
    material = Material(young_modulus=young, poisson_ratio=poisson, density=density)
    plane = HalfSpace(Material(young_modulus=RIGID, poisson_ratio=0.3))
    return Scene(Sphere(0.1, material), plane, 0.0, 0.2)
