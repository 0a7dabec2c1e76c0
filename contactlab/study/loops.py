"""Hysteresis loops of laws along the same load paths."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from contactlab.contracts import SteppedTangentialLaw
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array
from contactlab.paths.load_path import LoadPath, load_path
from contactlab.runs.simulation import Simulation

#: Points of a quarter of a cycle: forces of smooth laws are then exact to 1e-3.
QUARTER = 60
#: Largest displacement over that of gross slip at the largest load.
REACH = 0.7
#: Least load over the largest, as approaches, where the load oscillates.
LEAST = 0.5
#: Cycles with an oscillating load: some laws creep.
CYCLES = 5


class Loops(NamedTuple):
    """Displacement over that of gross slip, and F/(mu P_max), of each law by name.

    Attributes
    ----------
    constant : mapping of str to (array, array)
        Cycles of the displacement at constant normal load.
    oscillating : mapping of str to (array, array)
        Cycles of the displacement and of the load, which is least as the displacement passes 0.
    left_out : mapping of str to str
        Laws without loops, and why.
    """

    constant: Mapping[str, tuple[Array, Array]]
    oscillating: Mapping[str, tuple[Array, Array]]
    left_out: Mapping[str, str]


def loops(scene: Scene, simulations: Mapping[str, Simulation]) -> Loops:
    """Return the loops of each simulation's laws, for the bodies of ``scene``.

    The largest approach is that of an elastic impact at the normal speed of the scene.

    Parameters
    ----------
    scene : Scene
        One impact; of a batch the first.
    simulations : mapping of str to Simulation
    """
    first = scene.take((0,) * len(scene.shape)) if scene.shape else scene
    if first.friction_coefficient == 0.0:
        raise refuse("friction_coefficient", 0.0, "must be positive, for loops of friction")
    depth = float(hertz_scales(first).approach)
    full = float(first.friction_coefficient * depth / first.pair.stiffness_ratio)
    turn = np.arange(4 * QUARTER * CYCLES + 1) * (0.5 * np.pi / QUARTER)
    moved = REACH * np.sin(turn)
    level = 0.5 * (1.0 + LEAST) - 0.5 * (1.0 - LEAST) * np.cos(2.0 * turn)
    levels = {"constant": np.ones_like(moved), "oscillating": level}
    drawn: dict[str, dict[str, tuple[Array, Array]]] = {name: {} for name in levels}
    left_out = {}
    for name, simulation in simulations.items():
        if not isinstance(simulation.tangential, SteppedTangentialLaw):
            left_out[name] = "it answers to whole impacts or along a path of events, not to steps"
            continue
        for which, level in levels.items():
            path = _path(first, depth * level, full * moved, simulation)
            largest = float(first.friction_coefficient * np.max(path.friction_load))
            force = path.friction_force[-len(moved) :]
            drawn[which][name] = (moved, force / largest)
    return Loops(**drawn, left_out=left_out)


def _path(scene: Scene, depth: Array, moved: Array, simulation: Simulation) -> LoadPath:
    """Return the path of a simulation's laws, pressed without displacement first."""
    pressing = np.linspace(0.0, depth[0], QUARTER + 1)[1:-1]
    return load_path(
        scene,
        np.concatenate((pressing, depth)),
        np.concatenate((np.zeros(len(pressing)), moved)),
        normal=simulation.normal,
        tangential=simulation.tangential,
    ).check()
