"""Numbers of a fit that stand in neither table nor scene."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from contactlab.impact.bodies import SOLID_SPHERE_GYRATION_RATIO, HalfSpace, Sphere
from contactlab.impact.scene import Scene
from contactlab.scene_file import SceneFile
from contactlab.scene_file.entries import POLAR, STRUCK_KEYS
from contactlab_fit.measurements import Measurements
from contactlab_fit.model import Model, open_scene
from contactlab_fit.parameters import defaults_of

#: Motions that are 0 by default, and their units.
STILL = {"tangential_velocity": "m/s", "spin": "rad/s", "normal_spin": "rad/s"}


def tell_assumptions(
    table: Measurements, scene: Scene | SceneFile | str | Path, model: Model
) -> tuple[str, ...]:
    """Return a sentence for each default number that enters a fit.

    Parameters
    ----------
    table : Measurements
    scene : Scene, SceneFile or path
    model : Model
        With the parameters that are fitted.
    """
    found = [*table.taken, *_of_laws(model)]
    if model.setup.scene.sphere is not None or model.setup.scene.encounter is not None:
        file = open_scene(scene, table.given)
        own: Mapping[str, object] = file.tables if isinstance(file, SceneFile) else {}
        found += [*_of_motion(table, file, own), *_of_bodies(model.setup.scene, own)]
    return tuple(dict.fromkeys(found))


def _of_laws(model: Model) -> Iterator[str]:
    """Yield the defaults of laws."""
    fitted = [parameter.name for parameter in model.parameters]
    if model.setup.simulation is None:
        yield "restitution = 1: the laws are elastic where none is named"
    for name, (value, unit) in defaults_of(model.setup, fitted).items():
        yield f"{name} = {value:.4g}{'' if unit == '1' else ' ' + unit}: the default of its law"


def _of_motion(
    table: Measurements, scene: Scene | SceneFile, own: Mapping[str, Any]
) -> Iterator[str]:
    """Yield motions before the impact that are 0 by default, in columns and scene.

    A ``Scene`` does not tell the user's 0 from a default.
    """
    impact = own.get("impact", {})
    stated = {*table.given, *impact}
    if {*POLAR, "velocity"} & stated:
        stated.add("tangential_velocity")
    if isinstance(scene, Scene):
        stated |= {name for name in STILL if np.any(getattr(scene, name))}
    for name, unit in STILL.items():
        if name not in stated:
            yield f"{name} = 0 {unit} before each impact"
    if isinstance(scene, Scene):
        return  # its velocities are relative
    moving = {*table.struck, *impact} & {*STRUCK_KEYS}
    struck: tuple[str, ...] = STRUCK_KEYS[:2] if moving else ()
    met = scene.scene.encounter or scene.scene
    if "velocity" in impact:
        struck = ("target_velocity", "target_spin")
    elif not isinstance(met.target, HalfSpace):
        struck = STRUCK_KEYS
    for name in struck:
        if name not in {*table.struck, *impact}:
            yield f"{name} = 0 before each impact"


def _of_bodies(scene: Scene, own: Mapping[str, Any]) -> Iterator[str]:
    """Yield the gyration ratio of each ball that has the default."""
    first, second = scene.sphere, scene.target
    if scene.encounter is not None:
        first, second = scene.encounter.body, scene.encounter.target
    for name, body in (("sphere", first), ("target", second)):
        if isinstance(body, Sphere) and "gyration_ratio" not in own.get(name, {}):
            ratio = body.gyration_ratio
            if np.all(np.equal(ratio, SOLID_SPHERE_GYRATION_RATIO)):
                yield f"{name}.gyration_ratio = {SOLID_SPHERE_GYRATION_RATIO:.4f}: a solid ball"
