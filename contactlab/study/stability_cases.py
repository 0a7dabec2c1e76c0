"""The cases of one method: scenes at its own resolution, and resolutions on a few scenes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import attrs

from contactlab.compose.composition import DEFAULT_NORMAL, misfit
from contactlab.compose.names import full_name, short_name
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.impact.scene import Scene
from contactlab.study.bench_methods import Method
from contactlab.study.stability_scenes import CHI, Extreme, extreme_scenes, normal_scenes

STEPS = (1, 2, 3, 4, 5, 7, 10, 20, 50, 100, 1000, 10_000, 100_000, 1_000_000)
QUICK_STEPS = (1, 2, 3, 4, 5, 10, 50)
PARTS = (1, 2, 3, 5, 10, 100, 1000)
QUICK_PARTS = (1, 2)
TOLERANCES = (1.0, 0.1, 1e-2, 1e-3, 1e-5, 1e-8, 1e-12)
#: Scenes for the ladders of resolution: (psi1, chi).
LADDER = ((0.3, 0.3), (0.5, CHI), (1.2, CHI), (3.0, CHI), (1.2, 30.0), (0.3, 1e3))
QUICK_LADDER = ((1.2, CHI), (1.2, 30.0))
#: Steps over sqrt(chi) at the stability limit, and how many times that follow a large chi.
LIMIT, ABOVE_LIMIT = 2.85, 8

Options = dict[str, dict[str, Any]]


@attrs.frozen(kw_only=True)
class Case:
    """One cell: a scene under a method at one resolution.

    Attributes
    ----------
    planned : bool
        False: the plan's short cuts are not taken, the march does the whole impact.
    normal : str
        The normal law.
    """

    family: str
    label: str
    method: Method
    options: Options
    scene: Extreme = attrs.field(repr=False)
    planned: bool = True
    normal: str = DEFAULT_NORMAL


def cases(method: Method, *, quick: bool = False) -> Iterator[Case]:
    """Iterate over the cases of a method, under its normal law and then under the others.

    Of a method whose normal law is not the default, only what is tried under every normal law.
    """
    if method.normal != DEFAULT_NORMAL:
        yield from _under(method, method.normal, quick=quick)
        return
    law = REGISTRY.law_class(full_name("tangential", method.tangential))
    integrator = REGISTRY.law_class(full_name("integrator", method.integrator))
    for scene in extreme_scenes(quick=quick):
        yield _case(method, scene, {})
        if method.whole:
            continue
        if scene.family in ("psi1", "friction", "regimes"):
            yield _case(method, scene, {}, planned=False)
        if scene.family == "chi" and integrator.resolution == "steps":
            steps = int(ABOVE_LIMIT * LIMIT * float(scene.make().chi) ** 0.5) + 8
            yield _case(method, scene, {"integrator": {"steps": steps}})
    for normal in other_normal_laws(method):
        yield from _under(method, normal, quick=quick)
    if method.whole:
        return
    for psi1, chi in QUICK_LADDER if quick else LADDER:
        yield from _ladder(method, law.resolution, integrator.resolution, psi1, chi, quick=quick)


def _under(method: Method, normal: str, *, quick: bool) -> Iterator[Case]:
    """Iterate over the cases that are tried under every normal law."""
    for scene in normal_scenes(quick=quick):
        case = _case(method, scene, {})
        yield attrs.evolve(case, normal=normal, label=f"{normal}: {case.label}")


def other_normal_laws(method: Method) -> Iterator[str]:
    """Iterate over the installed normal laws, but the default, that fit a method."""
    tangential = REGISTRY.create(full_name("tangential", method.tangential))
    integrator = REGISTRY.create(full_name("integrator", method.integrator))
    for name in REGISTRY.names("normal"):
        short = short_name(name)
        if short == DEFAULT_NORMAL:
            continue
        try:
            normal = REGISTRY.create(name)
        except (PluginError, ValueError):
            continue  # broken, or it cannot be made without options
        if misfit(normal, tangential, integrator) is None:
            yield short


def _ladder(
    method: Method, part: str | None, step: str | None, psi1: float, chi: float, *, quick: bool
) -> Iterator[Case]:
    """Yield the cases of one impact at several resolutions.

    Parameters
    ----------
    method : Method
    part, step : str or None
        Names of the resolutions of tangential law and integrator.
    psi1, chi : float
    quick : bool
        Whether fewer values will do.
    """

    def scene(family: str) -> Extreme:
        label = f"psi1={psi1:g} chi={chi:.4g}"
        return Extreme(family, label, lambda: Scene.nondimensional(psi1=psi1, chi=chi))

    if step == "steps":
        refines = hasattr(_class(method), "refine")
        for count in QUICK_STEPS if quick else STEPS:
            yield _case(method, scene("steps"), {"integrator": {step: count}})
            if refines and count < QUICK_STEPS[-1]:
                options = {"integrator": {step: count, "refine": False}}
                yield _case(method, scene("steps"), options)
    if "tolerance" in (part, step) or hasattr(_class(method), "tolerance"):
        for tolerance in TOLERANCES[:: 3 if quick else 1]:
            yield _case(method, scene("tolerance"), {"integrator": {"tolerance": tolerance}})
    if part and part != "tolerance":
        for count in QUICK_PARTS if quick else PARTS:
            yield _case(method, scene("parts"), {"tangential": {part: count}})
            if step == "steps":
                steps = int(ABOVE_LIMIT * LIMIT * chi**0.5) + 8
                both = {"tangential": {part: count}, "integrator": {step: steps}}
                yield _case(method, scene("parts"), both)


def _class(method: Method) -> Any:
    return REGISTRY.law_class(full_name("integrator", method.integrator))


def _case(method: Method, scene: Extreme, options: Options, *, planned: bool = True) -> Case:
    """Return the case of a scene at one resolution.

    Parameters
    ----------
    method : Method
    scene : Extreme
    options : mapping of str to mapping
        Of tangential law and integrator, by kind.
    planned : bool
        Whether whole-impact answers are taken; everything is marched otherwise.
    """
    words = [f"{name}={value:g}" for part in options.values() for name, value in part.items()] + (
        [] if planned else ["marched"]
    )
    return Case(
        family=scene.family,
        label=", ".join([scene.label, *words]),
        method=method,
        options={"tangential": {}, "integrator": {}, **options},
        scene=scene,
        planned=planned,
    )
