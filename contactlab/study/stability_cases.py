"""The cases of one method: extreme scenes, ladders of resolutions, and a map over chi."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

import attrs
import numpy as np

from contactlab.contracts import Law
from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Number
from contactlab.registration.bring import sound
from contactlab.registration.hooks import hookimpl
from contactlab.registration.names import full_name, short_name
from contactlab.registry.composition import DEFAULT_NORMAL, misfit
from contactlab.registry.registry import REGISTRY, PluginError
from contactlab.study.bench_methods import Method, Options
from contactlab.study.stability_coupled import (
    answers_space,
    coupled_scenes,
    space_scenes,
    tries_bodies,
)

#: A solid sphere of Poisson's ratio 0.3: the paper's own case.
CHI = 49 / 34
REGIME_CHI = (0.3, 0.5, 0.51, CHI, 3.0)
CHIS = (0.05, 0.1, 0.25, 0.499, 0.5, 0.501, 0.75, 1.0, 3.0, 8.0, 30.0, 100.0, 1e3, 1e4)
QUICK_CHIS = (0.05, 0.5, 3.0, 100.0)
#: Largest chi of a quick report under a tolerance: one impact of annuli at 100 takes 50 s.
QUICK_TOLERANCE_CHI = 30.0
STEPS = (1, 2, 3, 4, 5, 7, 10, 20, 50, 100, 1000, 10_000, 100_000, 1_000_000)
QUICK_STEPS = (1, 2, 3, 4, 5, 10, 50)
PARTS = (1, 2, 3, 5, 10, 100, 1000)
QUICK_PARTS = (1, 2)
TOLERANCES = (1.0, 0.1, 1e-2, 1e-3, 1e-5, 1e-8, 1e-12)
FRICTIONS = (0.0, 1e-300, 1e-12, 1e3, 1e12, 1e300)
#: (psi1, chi) of the scenes on which resolutions are varied.
LADDER = ((0.3, 0.3), (0.5, CHI), (1.2, CHI), (3.0, CHI), (1.2, 30.0), (0.3, 1e3))
QUICK_LADDER = ((1.2, CHI), (1.2, 30.0))
#: Steps over sqrt(chi) at the stability limit, and the multiple of that number for large chi.
LIMIT, ABOVE_LIMIT = 2.85, 8

#: The family of the map: psi1 of the impacts in each cell, its columns and its rows.
MAP, INCIDENCES = "map", (0.3, 0.95, 1.2)
MAP_CHIS = tuple(np.geomspace(0.05, 1e4, 17).tolist())
MAP_STEPS = (
    1, 2, 3, 4, 6, 9, 14, 21, 32, 48, 72, 108, 162, 243, 365, 547, 820, 1230, 1845, 2768, 4152,
)  # fmt: skip
MAP_TOLERANCES = tuple((10.0 ** -np.arange(0.0, 6.1, 1.0)).tolist())
QUICK_MAP_CHIS, QUICK_MAP_STEPS, QUICK_MAP_TOLERANCES = (
    (0.05, 0.5, 3.0, 30.0), (1, 5, 9, 30), (0.1, 1e-3),
)  # fmt: skip
#: Estimated steps under a tolerance, sqrt((1 + chi)/tolerance), beyond which there is no cell.
MOST_STEPS = 3e4


@attrs.frozen(kw_only=True)
class Cell:
    """One cell: a scene under a method at one resolution.

    Attributes
    ----------
    planned : bool
        False: whole-impact answers are not used, the integrator marches the impact.
    normal : str
        Name of the normal law, without the kind.
    """

    family: str
    label: str
    method: Method
    options: Options
    scene: Case = attrs.field(repr=False)
    planned: bool = True
    normal: str = DEFAULT_NORMAL


def all_cases(method: Method, *, quick: bool = False) -> Iterator[Cell]:
    """Iterate over the cases of all plug-ins for a method; a plug-in may bring scenes alone."""

    def fault(item: object) -> str:
        return "" if isinstance(item, Case | Cell) else "which is no Case"

    for told in sound("cases", object, fault, method=method, quick=quick):
        if isinstance(told.item, Case):
            yield _case(method, told.item, {})
        else:
            yield told.item


@hookimpl
def contactlab_cases(method: Method, quick: bool) -> Iterator[Cell]:
    """Return contactlab's own cases."""
    return cases(method, quick=quick)


def cases(method: Method, *, quick: bool = False) -> Iterator[Cell]:
    """Iterate over the cases of a method, under its normal law and then under the others.

    A method whose normal law is not the default has only the cases of every normal law.
    """
    if method.normal != DEFAULT_NORMAL:
        yield from _cases_of_normal_laws(method, method.normal, quick=quick)
        return
    law = REGISTRY.law_class(full_name("tangential", method.tangential))
    integrator = REGISTRY.law_class(full_name("integrator", method.integrator))
    by_tolerance = "tolerance" in (law.resolution, integrator.resolution) and not method.whole
    for scene in extreme_scenes(quick=quick):
        long = quick and by_tolerance and scene.family == "chi"
        if long and float(scene.make().chi) > QUICK_TOLERANCE_CHI:
            continue
        yield _case(method, scene, {})
        if method.whole:
            continue
        if scene.family in ("psi1", "friction", "regimes"):
            yield _case(method, scene, {}, planned=False)
        if scene.family == "chi" and integrator.resolution == "steps":
            steps = int(ABOVE_LIMIT * LIMIT * float(scene.make().chi) ** 0.5) + 8
            yield _case(method, scene, {"integrator": {"steps": steps}})
    for normal in other_normal_laws(method):
        yield from _cases_of_normal_laws(method, normal, quick=quick)
    if tries_bodies(method):
        for label, make in coupled_scenes(quick=quick):
            yield _case(method, Case("eccentric", label, make), {})
        for label, make in space_scenes(quick=quick) if answers_space(method) else ():
            yield _case(method, Case("space", label, make), {})
    if method.whole:
        return
    for psi1, chi in QUICK_LADDER if quick else LADDER:
        yield from _ladder(method, law.resolution, integrator, psi1, chi, quick=quick)
    yield from _map(method, integrator, quick=quick)


def _cases_of_normal_laws(method: Method, normal: str, *, quick: bool) -> Iterator[Cell]:
    """Iterate over the cases that are tried under every normal law."""
    for scene in normal_scenes(quick=quick):
        case = _case(method, scene, {})
        yield attrs.evolve(case, normal=normal, label=f"{normal}: {case.label}")


def other_normal_laws(method: Method) -> Iterator[str]:
    """Iterate over the names of the normal laws that fit a method, without the default."""
    tangential = REGISTRY.create(full_name("tangential", method.tangential))
    integrator = REGISTRY.create(full_name("integrator", method.integrator))
    for name in REGISTRY.names("normal"):
        short = short_name(name)
        if short == DEFAULT_NORMAL:
            continue
        try:
            normal = REGISTRY.create(name)
        except (PluginError, ValueError):
            continue  # broken, or an option has no default
        if misfit(normal, tangential, integrator) is None:
            yield short


def _ladder(
    method: Method, part: str | None, integrator: type[Law], psi1: float, chi: float, *, quick: bool
) -> Iterator[Cell]:
    """Yield the cases of one impact at several resolutions."""
    scene = partial(_plain, label=f"psi1={psi1:g} chi={chi:.4g}", psi1=psi1, chi=chi)
    step = integrator.resolution
    if step == "steps":
        refines = hasattr(integrator, "refine")
        for count in QUICK_STEPS if quick else STEPS:
            yield _case(method, scene("steps"), {"integrator": {step: count}})
            if refines and count < QUICK_STEPS[-1]:
                options = {"integrator": {step: count, "refine": False}}
                yield _case(method, scene("steps"), options)
    if "tolerance" in (part, step) or hasattr(integrator, "tolerance"):
        for tolerance in TOLERANCES[:: 3 if quick else 1]:
            yield _case(method, scene("tolerance"), {"integrator": {"tolerance": tolerance}})
    if part and part != "tolerance":
        for count in QUICK_PARTS if quick else PARTS:
            yield _case(method, scene("parts"), {"tangential": {part: count}})
            if step == "steps":
                steps = int(ABOVE_LIMIT * LIMIT * chi**0.5) + 8
                both = {"tangential": {part: count}, "integrator": {step: steps}}
                yield _case(method, scene("parts"), both)


def _map(method: Method, integrator: type[Law], *, quick: bool) -> Iterator[Cell]:
    """Yield the impacts of each resolution and chi, marched in the steps asked for."""
    word = integrator.resolution
    if word is None:
        return
    steps = QUICK_MAP_STEPS if quick else MAP_STEPS
    tolerances = QUICK_MAP_TOLERANCES if quick else MAP_TOLERANCES
    as_asked = {"refine": False} if hasattr(integrator, "refine") else {}
    for fine, chi, psi1 in itertools.product(
        steps if word == "steps" else tolerances, map_chis(quick=quick), INCIDENCES
    ):
        if word == "steps" or ((1.0 + chi) / fine) ** 0.5 <= MOST_STEPS:
            scene = _plain(MAP, f"psi1={psi1:g} chi={chi:.4g}", psi1, chi)
            yield _case(method, scene, {"integrator": {word: fine, **as_asked}}, planned=False)


def map_chis(*, quick: bool = False) -> tuple[float, ...]:
    """Return the values of chi of the map."""
    return QUICK_MAP_CHIS if quick else MAP_CHIS


def _case(method: Method, scene: Case, options: Options, *, planned: bool = True) -> Cell:
    """Return the case of a scene at one resolution."""
    words = [f"{name}={value:g}" for part in options.values() for name, value in part.items()]
    return Cell(
        family=scene.family,
        label=", ".join([scene.label, *words, *([] if planned else ["marched"])]),
        method=method,
        options={"tangential": {}, "integrator": {}, **options},
        scene=scene,
        planned=planned,
    )


class Case(NamedTuple):
    """A scene with its family and label; a ``ValueError`` of ``make`` is an outcome too."""

    family: str
    label: str
    make: Callable[[], Scene]


def extreme_scenes(*, quick: bool = False) -> list[Case]:
    """Return the scenes tried under the default normal law; ``quick`` takes about a third."""
    incidences = (0.0, 1e-300, 1e-12, 1e-3, 0.5, -1.2, 1e6, 1e15, 1e16)
    scenes = [_plain("psi1", f"psi1={psi1:g}", psi1, CHI) for psi1 in incidences[:: 1 + quick]]
    for chi in (0.5, CHI) if quick else REGIME_CHI:
        scenes += _regimes(chi, (-1e-9, 0.0, 1e-9) if quick else (-1e-3, -1e-9, 0.0, 1e-9, 1e-3))
    for chi in QUICK_CHIS if quick else CHIS:
        for psi1 in (0.3, 1.2) if quick else (0.3, 0.98, 1.2, 2.5):
            scenes.append(_plain("chi", f"chi={chi:g} psi1={psi1:g}", psi1, chi))
    scenes += _balls("friction", "mu={:g}", "friction", FRICTIONS)
    scenes += _balls("poisson", "nu={:g}", "poisson", (-1.0, 0.0, 0.5))
    return [*scenes, *_sizes(quick=quick), *_types()]


def normal_scenes(*, quick: bool = False) -> list[Case]:
    """Return the scenes tried under every normal law."""
    scenes = [
        _plain("normal", "psi1=3", 3.0, CHI),
        _plain("normal", "psi1=1.2 chi=3", 1.2, 3.0),
        Case("normal", "steel ball", _ball),
    ]
    if quick:
        return scenes
    incidences = (0.0, 1e-12, 0.5, 1.2, 20.0, 1e15)
    scenes += [_plain("normal", f"psi1={psi1:g}", psi1, CHI) for psi1 in incidences]
    scenes += [_plain("normal", f"chi={chi:g}", 0.3, chi) for chi in (0.05, 0.5, 30.0, 1e3)]
    others = [*_balls("", "mu={:g}", "friction", FRICTIONS), *_sizes(quick=True), *_types()]
    return scenes + [extreme._replace(family="normal") for extreme in others]


def _plain(family: str, label: str, psi1: Number, chi: Number) -> Case:
    """Return a scene defined by psi1 and chi."""
    return Case(family, label, lambda: Scene.nondimensional(psi1=psi1, chi=chi))


def _regimes(chi: float, sides: tuple[float, ...]) -> Iterator[Case]:
    """Yield scenes at and beside psi1 = 1 and psi1 = 4 chi - 1, where the regime changes."""
    for name, edge in (("1", 1.0), ("4chi-1", 4.0 * chi - 1.0)):
        for side in sides:
            yield _plain("regimes", f"psi1={name}{side:+g} chi={chi:.4g}", edge + side, chi)


def _ball(
    *,
    radius: float = 0.01,
    speed: float = 1.0,
    friction: Number = 0.2,
    slip: Number = 0.3,
    poisson: Number = 0.3,
    mass_ratio: float | None = None,
) -> Scene:
    """Return a steel sphere on a half-space, or on a sphere of another mass; slip over speed."""
    material = Material(shear_modulus=80e9, poisson_ratio=poisson, density=7850.0)
    sphere = Sphere(radius, material)
    target: Sphere | HalfSpace = HalfSpace(material)
    if mass_ratio is not None:
        target = Sphere(radius, material, mass=float(sphere.mass) * mass_ratio)
    return Scene(sphere, target, friction, speed, slip * speed, 0.0)


def _balls(family: str, label: str, argument: str, values: Sequence[float]) -> list[Case]:
    """Return steel balls that differ in one argument of ``_ball``."""
    return [
        Case(family, label.format(value), partial(_ball, **{argument: value})) for value in values
    ]


def _sizes(*, quick: bool) -> Iterator[Case]:
    """Yield scenes over speed, radius (at the least and the greatest speed too), and mass."""
    speeds = (1e-12, 1e4) if quick else (1e-165, 1e-12, 1e-6, 1e-2, 1e2, 1e4)
    radii = (1e-9, 1e9) if quick else (1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e9)
    masses = (1e-12, 1e12) if quick else (1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e12)
    yield from _balls("speed", "v1={:g} m/s", "speed", speeds)
    for radius in radii:
        yield from _balls("radius", "R={:g} m", "radius", [radius])
        for speed in (speeds[0], speeds[-1]):
            label = f"R={radius:g} m, v1={speed:g} m/s"
            yield Case("radius", label, partial(_ball, radius=radius, speed=speed))
    yield from _balls("mass", "m2/m1={:g}", "mass_ratio", masses)


def _types() -> list[Case]:
    """Return scenes of single-precision numbers and of integers."""
    single = np.float32
    return [
        _plain("types", "float32", single(1.2), single(CHI)),
        _plain("types", "int", 1, 3),
        _plain("types", "int64", np.int64(2), np.int64(3)),
        Case(
            "types",
            "float32, SI",
            partial(_ball, friction=single(0.2), slip=single(0.3), poisson=single(0.3)),
        ),
        Case("types", "int, SI", partial(_ball, friction=1, slip=1, poisson=0)),
    ]
