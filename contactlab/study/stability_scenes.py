"""The stiff and extreme scenes, by family."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene

#: A solid sphere of Poisson's ratio 0.3: the paper's own case.
CHI = 49 / 34
REGIME_CHI = (0.3, 0.5, 0.51, CHI, 3.0)
CHIS = (0.05, 0.1, 0.25, 0.499, 0.5, 0.501, 0.75, 1.0, 3.0, 8.0, 30.0, 100.0, 1e3, 1e4)
QUICK_CHIS = (0.05, 0.5, 3.0, 100.0)


class Extreme(NamedTuple):
    """A scene by family and label; ``make`` may refuse it, which is an outcome too."""

    family: str
    label: str
    make: Callable[[], Scene]


def extreme_scenes(*, quick: bool = False) -> list[Extreme]:
    """Return the scenes, or about a third of them."""
    found = [*_incidence(quick), *_inertia(quick), *_friction(), *_materials()]
    found += [*_sizes(quick), *_masses(quick), *_types()]
    return found


def normal_scenes(*, quick: bool = False) -> list[Extreme]:
    """Return the scenes that are tried under every normal law."""
    found = [
        _plain("normal", "psi1=3", 3.0, CHI),
        _plain("normal", "psi1=1.2 chi=3", 1.2, 3.0),
        Extreme("normal", "steel ball", _ball),
    ]
    if quick:
        return found
    incidences = (0.0, 1e-12, 0.5, 1.2, 20.0, 1e15)
    found += [_plain("normal", f"psi1={psi1:g}", psi1, CHI) for psi1 in incidences]
    found += [_plain("normal", f"chi={chi:g}", 0.3, chi) for chi in (0.05, 0.5, 30.0, 1e3)]
    found += [
        each._replace(family="normal")
        for each in (*_friction(), *_sizes(quick=True), *_masses(quick=True), *_types())
    ]
    return found


def _plain(family: str, label: str, psi1: Any, chi: Any) -> Extreme:
    """Return an impact of given psi1 and chi.

    Parameters
    ----------
    family, label : str
        For the report.
    psi1, chi : float or array
    """
    return Extreme(family, label, lambda: Scene.nondimensional(psi1=psi1, chi=chi))


def _incidence(quick: bool) -> Iterator[Extreme]:
    tiny = (0.0, 1e-300, 1e-12, 1e-3, 0.5, -1.2, 1e6, 1e15, 1e16)
    for psi1 in tiny[:: 2 if quick else 1]:
        yield _plain("psi1", f"psi1={psi1:g}", psi1, CHI)
    for chi in (0.5, CHI) if quick else REGIME_CHI:
        for name, edge in (("1", 1.0), ("4chi-1", 4.0 * chi - 1.0)):
            for side in (-1e-3, -1e-9, 0.0, 1e-9, 1e-3):
                if edge > 0.0 and not (quick and abs(side) == 1e-3):
                    label = f"psi1={name}{side:+g} chi={chi:.4g}"
                    yield _plain("regimes", label, edge + side, chi)


def _inertia(quick: bool) -> Iterator[Extreme]:
    for chi in QUICK_CHIS if quick else CHIS:
        for psi1 in (0.3, 1.2) if quick else (0.3, 0.98, 1.2, 2.5):
            yield _plain("chi", f"chi={chi:g} psi1={psi1:g}", psi1, chi)


def _ball(
    *,
    radius: float = 0.01,
    speed: float = 1.0,
    friction: Any = 0.2,
    slip: Any = 0.3,
    poisson: Any = 0.3,
    other: float | None = None,
) -> Scene:
    """Return the scene of a steel sphere, changed in some of its numbers.

    Parameters
    ----------
    radius : float
        In m.
    speed : float
        Normal speed, in m/s.
    friction : float or array
        mu.
    slip : float or array
        Tangential velocity over normal speed.
    poisson : float or array
        nu of both bodies.
    other : float, optional
        Mass of a second sphere over that of the first; a half-space is hit without it.
    """
    material = Material(shear_modulus=80e9, poisson_ratio=poisson, density=7850.0)
    sphere = Sphere(radius, material)
    target: Sphere | HalfSpace = HalfSpace(material)
    if other is not None:
        target = Sphere(radius, material, mass=float(sphere.mass) * other)
    return Scene(sphere, target, friction, speed, slip * speed, 0.0)


def _friction() -> Iterator[Extreme]:
    for friction in (0.0, 1e-300, 1e-12, 1e3, 1e12, 1e300):
        yield Extreme("friction", f"mu={friction:g}", lambda mu=friction: _ball(friction=mu))  # type: ignore[misc]


def _materials() -> Iterator[Extreme]:
    for ratio in (-1.0, 0.0, 0.5):
        yield Extreme("poisson", f"nu={ratio:g}", lambda nu=ratio: _ball(poisson=nu))  # type: ignore[misc]


def _sizes(quick: bool) -> Iterator[Extreme]:
    speeds = (1e-12, 1e4) if quick else (1e-165, 1e-12, 1e-6, 1e-2, 1e2, 1e4)
    radii = (1e-9, 1e9) if quick else (1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e9)
    for v1 in speeds:
        yield Extreme("speed", f"v1={v1:g} m/s", lambda v=v1: _ball(speed=v))  # type: ignore[misc]
    for size in radii:
        yield Extreme("radius", f"R={size:g} m", lambda r=size: _ball(radius=r))  # type: ignore[misc]
        for v1 in speeds[:: len(speeds) - 1]:
            label = f"R={size:g} m, v1={v1:g} m/s"
            yield Extreme("radius", label, lambda r=size, v=v1: _ball(radius=r, speed=v))  # type: ignore[misc]


def _masses(quick: bool) -> Iterator[Extreme]:
    for ratio in (1e-12, 1e12) if quick else (1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e12):
        yield Extreme("mass", f"m2/m1={ratio:g}", lambda m=ratio: _ball(other=m))  # type: ignore[misc]


def _types() -> Iterator[Extreme]:
    single = np.float32
    yield _plain("types", "float32", single(1.2), single(CHI))
    yield _plain("types", "int", 1, 3)
    yield _plain("types", "int64", np.int64(2), np.int64(3))
    yield Extreme(
        "types",
        "float32, SI",
        lambda: _ball(friction=single(0.2), slip=single(0.3), poisson=single(0.3)),
    )
    yield Extreme("types", "int, SI", lambda: _ball(friction=1, slip=1, poisson=0))
