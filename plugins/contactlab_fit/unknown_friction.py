"""Fits of scenes without a friction coefficient, from numbers that do not depend on friction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import attrs
import numpy as np

from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array
from contactlab.outcome.result import ImpactResult
from contactlab.scene_file import SceneFile
from contactlab_fit.measurements import Measurements
from contactlab_fit.model import FRICTION, Model, open_scene
from contactlab_fit.problem import Problem

#: Friction coefficients from ice to more than rubber: numbers equal under all do not depend on it.
FRICTIONS = (0.01, 0.1, 1.0, 10.0)
#: Relative difference up to which predictions are the same.
ALIKE = 1e-12


def lacks_friction(
    scene: Scene | SceneFile | str | Path, given: Mapping[str, Array], parameters: Sequence[str]
) -> bool:
    """Return whether the friction coefficient is missing from table, scene and parameters."""
    file = open_scene(scene, given)
    return isinstance(file, SceneFile) and FRICTION in file.defaulted and FRICTION not in parameters


def without_friction(problem: Problem, table: Measurements) -> tuple[Measurements, str]:
    """Return the measurements that do not depend on friction, and a sentence on the others.

    Raises
    ------
    ValueError
        If friction moves all of them.
    """
    model, names = problem.model, list(problem.measured)
    start = np.array([[parameter.starts[0] for parameter in model.parameters]])
    each = [under(model, friction).predict(start, names) for friction in FRICTIONS]
    unmoved = [
        name
        for name in names
        if all(
            np.allclose(one[name], each[0][name], rtol=ALIKE, atol=0.0, equal_nan=True)
            for one in each[1:]
        )
    ]
    moved = ", ".join(name for name in names if name not in unmoved)
    remedy = f"fit {FRICTION} too, or give it under [impact] of the scene"
    if not unmoved:
        raise ValueError(
            f"{FRICTION}: stands in neither table nor scene, and moves {moved}; {remedy}"
        )
    if not moved:
        return table, ""
    words = f"{moved}: not met, for {FRICTION} stands in neither table nor scene; {remedy}"
    return table.only(unmoved), words


def under(model: Model, friction: float) -> Model:
    """Return the model of the same impacts under a friction coefficient."""
    return model.at(attrs.evolve(model.setup.scene, friction_coefficient=friction))


def normal_motion_alone(result: ImpactResult) -> ImpactResult:
    """Return impacts of unknown friction: numbers that depend on friction are NaN."""
    nothing = np.full(result.scene.shape, np.nan)
    motion = attrs.evolve(result.motion, slip_velocity_change=nothing, friction_work=nothing)
    return attrs.evolve(result, motion=motion)
