"""Prediction of measured quantities from parameters of a scene and of laws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array
from contactlab.outcome.columns import QUANTITIES, Column
from contactlab.outcome.result import ImpactResult
from contactlab.registry.bound import bind
from contactlab.registry.law_words import in_words
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import SceneFile, read_scene
from contactlab.scene_file.entries import CARTESIAN, POLAR, is_option
from contactlab_fit import tabulated
from contactlab_fit.parameters import RESTITUTION, Parameter, Setup

FRICTION = "friction_coefficient"
#: Stand-ins for missing entries of a scene file. Searches have their own starts, and numbers that
#: depend on this friction are left out: ``unknown_friction``.
DEFAULTS = {FRICTION: 0.1}
#: Points whose predictions are kept: those of a search and its diagnosis, not of a bootstrap; and
#: impacts at them, of 8 bytes for each quantity.
REMEMBERED, REMEMBERED_IMPACTS = 1000, 2e7
#: Impacts that run in one batch, which takes some 300 bytes for each.
TOGETHER = 500_000
TABULATED = "exact elastic law (tabulated rebound)"
#: Digits of an option of a law: within them impacts run once, and normal motions are kept.
DIGITS = 7
#: The quantity that needs the course of the normal motion, not its restitution alone.
CONTACT_TIME = "contact_time"
#: Needs of a column that no table meets: its impacts are followed.
FOLLOWED = {"motion", "history"}


@attrs.frozen(kw_only=True, eq=False)
class Model:
    """A scene, laws, and the parameters to fit; ``needs`` are those of the measured columns."""

    setup: Setup
    parameters: tuple[Parameter, ...]
    needs: frozenset[str] = frozenset()
    tabled: bool = attrs.field(init=False)
    _repeated: dict[int, Scene] = attrs.field(factory=dict, init=False, repr=False)
    _known: dict[bytes, dict[str, Array]] = attrs.field(factory=dict, init=False, repr=False)

    @tabled.default
    def _(self) -> bool:
        """Return whether the table of rebounds holds at all values of the parameters."""
        if self.setup.scene.inverse_mass is not None or self.needs & FOLLOWED:
            return False
        kinds = {getattr(parameter, "kind", "normal") for parameter in self.parameters}
        return kinds <= {"normal"} and tabulated.holds(self.setup.simulation)

    def predict(self, points: Array, quantities: Sequence[str]) -> dict[str, Array]:
        """Return quantities of all impacts, shape (m, n), at points of shape (m, parameters).

        Points with equal options of laws run together in one batch. A point seen before
        is not run again.
        """
        points = self._rounded_points(points)
        count = self.setup.scene.shape[0]
        if len(self._known) > min(REMEMBERED, REMEMBERED_IMPACTS / count):
            self._known.clear()
        keys = [point.tobytes() for point in points]
        fresh = [
            row
            for row, key in enumerate(keys)
            if not self._known.setdefault(key, {}).keys() >= set(quantities)
        ]
        if fresh:
            self._run(points[fresh], [keys[row] for row in fresh], quantities)
        return {name: np.array([self._known[key][name] for key in keys]) for name in quantities}

    def _rounded_points(self, points: Array) -> Array:
        """Return points, shape (m, parameters), with rounded options of laws."""
        near = points.copy()
        for place, parameter in enumerate(self.parameters):
            if not parameter.batched:
                near[:, place] = [float(f"{v:.{DIGITS}g}") for v in points[:, place].tolist()]
        return near

    def _run(self, points: Array, keys: Sequence[bytes], quantities: Sequence[str]) -> None:
        """Run the impacts at some points and keep the quantities under their keys."""
        each = self._common_restitution(quantities)
        alone = [place for place, p in enumerate(self.parameters) if not (p.batched or p is each)]
        _, group = np.unique(points[:, alone], axis=0, return_inverse=True)
        group = np.reshape(group, -1)  # its shape depends on the version of numpy
        for number in range(int(group.max()) + 1):
            rows = np.flatnonzero(group == number)
            most = max(TOGETHER // self.setup.scene.shape[0], 1)
            for some in np.split(rows, range(most, len(rows), most)):
                for name, values in self._run_batch(points[some], quantities).items():
                    for row, line in zip(some.tolist(), values, strict=True):
                        self._known[keys[row]][name] = line

    def _run_batch(self, points: Array, quantities: Sequence[str]) -> dict[str, Array]:
        """Return the quantities, shape (m, n), at points with equal laws, from one batch."""
        many, count = len(points), self.setup.scene.shape[0]
        setup, restituted = (
            self.setup._replace(scene=self._times(many)),
            self._common_restitution(quantities),
        )
        restitution = None
        for parameter, column in zip(self.parameters, points.T, strict=True):
            each = many > 1 and (parameter.batched or parameter is restituted)
            value = np.repeat(column, count) if each else float(column[0])
            if parameter is restituted:
                restitution = value
            else:
                setup = parameter.apply(setup, value)
        if restitution is None:
            result = self._impacts(setup)
        else:
            result = tabulated.rebounds(setup.scene, restitution)
        read = {name: _read(QUANTITIES[name], result, setup.simulation) for name in quantities}
        return {name: values.reshape(many, count) for name, values in read.items()}

    def at_once(self, quantities: Sequence[str]) -> bool:
        """Return whether any points run in one batch: no option of a law differs in them."""
        each = self._common_restitution(quantities)
        return all(parameter.batched or parameter is each for parameter in self.parameters)

    def _common_restitution(self, quantities: Sequence[str]) -> Parameter | None:
        """Return the restitution if each impact of a batch may have its own; else None."""
        if not self.tabled or CONTACT_TIME in quantities or self.needs:
            return None
        return next((p for p in self.parameters if p.name == f"normal.{RESTITUTION}"), None)

    def _impacts(self, setup: Setup) -> ImpactResult:
        """Return the impacts of a scene under its laws."""
        if self.tabled:
            return tabulated.impacts(setup.scene, setup.simulation)
        laws = setup.simulation or Simulation()
        return laws.sweep(setup.scene).check()

    def impacts(self, values: Array) -> ImpactResult:
        """Return the impacts, shape (n,), at values of the parameters, shape (parameters,)."""
        return self._impacts(self._setup(self._rounded_points(values[None])[0].tolist()))

    def _setup(self, values: Sequence[float]) -> Setup:
        """Return scene and laws at values of the parameters."""
        setup = self.setup
        for parameter, value in zip(self.parameters, values, strict=True):
            setup = parameter.apply(setup, value)
        return setup

    def _times(self, many: int) -> Scene:
        """Return the batch of impacts repeated ``many`` times."""
        scene = self.setup.scene
        if many == 1:
            return scene
        if many not in self._repeated:
            self._repeated[many] = scene.take(np.tile(np.arange(scene.shape[0]), many))
        return self._repeated[many]

    def at(self, scene: Scene) -> Model:
        """Return the model of other impacts."""
        return attrs.evolve(self, setup=self.setup._replace(scene=scene))

    def laws(self, values: Array) -> str:
        """Return the laws in words, with the values of the parameters."""
        simulation = self._setup([float(f"{value:.6g}") for value in values]).simulation
        if simulation is None and self.tabled:
            return TABULATED
        simulation = simulation or Simulation()
        if self.tabled:
            return f"{in_words(simulation.normal)}, partial slip (tabulated rebound)"
        return ", ".join(map(in_words, simulation.laws))


def _read(column: Column, result: ImpactResult, simulation: Simulation | None) -> Array:
    """Return the numbers of a column; impacts are run again, each alone, if it needs a history."""
    if "history" not in column.needs:
        return column.of(result)
    laws, scene = simulation or Simulation(), result.scene
    impacts = (scene.take(place) for place in range(scene.shape[0]))
    return np.array([float(column.of(laws.run(one, history=True).check())) for one in impacts])


def open_scene(
    scene: Scene | SceneFile | str | Path, given: Mapping[str, Array]
) -> Scene | SceneFile:
    """Return a scene, or a scene file with the measured entries."""
    if isinstance(scene, Scene):
        return scene
    path = scene.path if isinstance(scene, SceneFile) else scene
    return read_scene(path, entries=given, defaults=DEFAULTS)


def setup_of(
    scene: Scene | SceneFile | str | Path,
    given: Mapping[str, Array],
    count: int,
    simulation: Simulation | None,
) -> Setup:
    """Return the batch of the measured impacts, and the laws with the options of each impact."""
    for name in filter(is_option, given):
        kind, option = name.split(".")
        if simulation is None:
            rule = "is an option of a law, and no law is named"
            raise refuse("measurements", name, rule, "give simulation=Simulation(...)")
        laws: dict[str, Any] = simulation.laws.by_kind()
        try:
            laws[kind] = attrs.evolve(laws[kind], **{option: given[name]})
        except (TypeError, ValueError) as error:
            raise refuse("measurements", name, f"is no option of its law: {error}") from None
        simulation = Simulation(**laws)
    batch = scene_of(scene, {k: v for k, v in given.items() if not is_option(k)}, count)
    if simulation is None:
        return Setup(batch, None)
    laws_bound, batch = bind(simulation.laws, batch)
    changed = laws_bound is not simulation.laws
    return Setup(batch, Simulation.of(laws_bound) if changed else simulation)


def scene_of(
    scene: Scene | SceneFile | str | Path, given: Mapping[str, Array], count: int
) -> Scene:
    """Return the batch of the measured impacts."""
    file = open_scene(scene, given)
    if isinstance(file, SceneFile):
        batch = file.scene if file.scene.along else file.of_spheres
    else:
        scene = file
        if given and scene.sphere is None and scene.encounter is not None:
            rule = "has vectors in space, which columns cannot replace"
            raise refuse("scene", scene, rule, "give the TOML file of the bodies, with along")
        batch = attrs.evolve(scene, **_velocities(given, scene)) if given else scene
    if not batch.shape:
        batch = attrs.evolve(batch, normal_speed=np.full(count, batch.normal_speed))
    if batch.shape != (count,):
        raise refuse("scene", batch.shape, f"must be one impact, or the {count} that were measured")
    return batch


def _velocities(given: Mapping[str, Array], scene: Scene) -> dict[str, Any]:
    """Return the fields of a scene that the measured entries set."""
    fields: dict[str, Any] = {}
    speed = np.hypot(scene.normal_speed, scene.tangential_velocity)
    for name, values in given.items():
        if name in POLAR:
            angle = np.radians(given["angle_deg"]) if "angle_deg" in given else None
            if angle is None:
                angle = np.arctan2(scene.tangential_velocity, scene.normal_speed)
            size = given.get("speed", speed)
            fields["normal_speed"] = size * np.cos(angle)
            fields["tangential_velocity"] = size * np.sin(angle)
        elif name in (*CARTESIAN, "spin", "friction_coefficient"):
            fields[name] = values
        else:
            remedy = "give the scene as a TOML file, or velocities alone"
            raise refuse("measurements", name, "cannot be put into a Scene", remedy)
    return fields


def simulation_of(value: object) -> Simulation | None:
    """Return the laws to fit; None for the tabulated exact rebound."""
    if value is None or isinstance(value, Simulation):
        return value
    raise refuse("simulation", value, "must be a Simulation", "or None for the exact elastic law")
