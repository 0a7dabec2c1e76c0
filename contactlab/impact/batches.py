"""A scene as a batch of impacts: its parts, stacked scenes, the axes of a grid."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self, TypeVar

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.impact.kinetics import Motions, batch_of
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import check_place, refuse
from contactlab.numeric.types import Array, Index, Numbers, Places


class NoIndexError(LookupError):
    """A law asked for the index of a scene that stands for many impacts."""


AnyScene = TypeVar("AnyScene", bound="Batches")


class Batches(Motions):
    """Base of scenes: one impact or many, each with an index, perhaps over the axes of a grid."""

    __slots__ = ()

    if TYPE_CHECKING:
        sphere: Any
        encounter: Any
        unit_friction: bool
        has_units: bool
        _of_slip: Any
        _index: int | Places | None
        _axes: tuple[tuple[str, Array], ...]
        _varied: tuple[tuple[str, Array], ...]
        _shapes: Any

    @property
    def varied(self) -> Mapping[str, Array]:
        """The values of each varying entry, one for each impact, by name; empty if not recorded."""
        if not self._axes:
            return MappingProxyType(dict(self._varied))
        from contactlab.impact.grid import product  # needed for grids only

        return MappingProxyType(product(dict(self._axes)))

    @property
    def axes(self) -> Mapping[str, Array]:
        """The values of each entry that varies over a grid, by name; empty for other scenes.

        ``np.unravel_index(i, scene.dimensions)`` is the index of impact ``i`` on each axis.
        """
        return MappingProxyType({name: batch.lock_arrays(values) for name, values in self._axes})

    @property
    def dimensions(self) -> tuple[int, ...]:
        """The length of each axis of a grid; () for other scenes."""
        return tuple(values.size for _, values in self._axes)

    @classmethod
    def stack(cls, scenes: Iterable[Self]) -> Self:
        """Return one batch scene of shape (len(scenes),) from scalar scenes.

        Parameters
        ----------
        scenes : sequence of Scene
            Scenes of single impacts, all with bodies or all without.
        """
        if not isinstance(scenes, Iterable):
            raise refuse("scenes", scenes, "must be a sequence of Scene")
        scenes = list(scenes)
        if not scenes:
            raise refuse("scenes", scenes, "must hold at least one Scene")
        for position, scene in enumerate(scenes):
            if not isinstance(scene, cls):
                raise refuse(f"scenes[{position}]", scene, "must be a Scene")
            if scene.links is not None:
                remedy = "make one Gathering with arrays of velocities, gaps or numbers"
                raise refuse(f"scenes[{position}]", scene, "is that of a gathering", remedy)
            if scene.shape:
                remedy = "batches go one after another into a folder: sweep(scenes, into=...)"
                raise refuse(f"scenes[{position}]", scene.shape, "must be a single impact", remedy)
            if (scene.sphere is None) != (scenes[0].sphere is None):
                raise refuse(
                    f"scenes[{position}]",
                    scene,
                    "must have a sphere if, and only if, scenes[0] has: else spin would be lost",
                    "give all of spheres, all of other bodies, or all by psi1 and chi",
                )
            if scene.has_units != scenes[0].has_units:
                raise refuse(
                    f"scenes[{position}]",
                    scene,
                    "must have units if, and only if, scenes[0] has",
                    "give all in SI, or all by Scene.nondimensional",
                )
            if scene.unit_friction != scenes[0].unit_friction:
                raise refuse(
                    f"scenes[{position}]",
                    scene,
                    "must have a friction coefficient if, and only if, scenes[0] has",
                    "give friction_coefficient to every Scene.nondimensional, or to none",
                )
        if len({id(getattr(scene._of_slip, "law", None)) for scene in scenes}) > 1:
            scenes = [scene._with(_of_slip=None) for scene in scenes]  # several functions
        kinds = {
            tuple(type(getattr(scene.encounter, name, None)) for name in ("body", "target"))
            for scene in scenes
        }
        if len(kinds) > 1:  # bodies of several kinds fit in no encounter
            scenes = [scene._evolve(encounter=None) for scene in scenes]
        if any(scene.inverse_mass is not None for scene in scenes):
            planar = all(scene.planar for scene in scenes)
            scenes = [scene._of_any_shape(planar) for scene in scenes]
        stacked = batch.stack_trees(scenes)
        assert isinstance(stacked, cls)
        encounter = stacked.encounter
        if encounter is not None and not encounter.shape:  # one index an impact, even if all agree
            velocity = np.tile(encounter.velocity, (len(scenes), 1))
            stacked = stacked._with(encounter=attrs.evolve(encounter, velocity=velocity))
        if stacked.shape:
            return stacked
        return stacked._evolve(normal_speed=np.full(len(scenes), stacked.normal_speed))

    def _evolve(self, **entries: object) -> Self:
        """Return this scene with other entries, which are checked."""
        scene: Any = self
        changed: Self = attrs.evolve(scene, **entries)
        return changed

    def _of_any_shape(self, planar: bool) -> Self:
        """Return this scene of one impact with its inverse mass, and slip as a vector in space."""
        slip = self.tangential_velocity
        if self.planar and not planar:
            slip = np.array([slip, 0.0])
        W, pair = self.inverse_mass, self.pair
        if W is None:
            W = np.diag([1.0 / pair.normal_mass, *2 * [1.0 / pair.tangential_mass]])
        return self._evolve(tangential_velocity=slip, inverse_mass=W, planar=planar)

    def take(self, part: Index) -> Self:
        """Return the scene of the impacts that ``part`` indexes.

        Numbers that all impacts share stay plain numbers, which are faster. Each impact keeps its
        ``index`` in the whole batch.

        Parameters
        ----------
        part : slice, array of bool or int, int, tuple of int or Ellipsis
            Index of an array of the batch shape.
        """
        if part is ... or (
            isinstance(part, slice) and self.shape and part == slice(0, self.shape[0])
        ):
            return self
        if self.links is not None:
            return self._gatherings(part)
        plain = self if self.encounter is None else self._with(encounter=None)
        taken: Self = batch.take(plain, self.shape, part)
        if self.encounter is not None:
            object.__setattr__(taken, "encounter", self.encounter.take(part))
        object.__setattr__(taken, "_varied", ())
        object.__setattr__(taken, "shape", np.broadcast_shapes(*taken._shapes().values()))
        object.__setattr__(taken, "_axes", ())
        if (self._axes or self._varied) and not isinstance(part, int | tuple):
            object.__setattr__(taken, "_varied", self._take_varying(part))
        if taken.shape or isinstance(part, int | tuple):
            return taken
        count = np.shape(taken.index)
        spread = taken._evolve(normal_speed=np.full(count, taken.normal_speed))
        return spread.with_index(taken.index)

    def _gatherings(self, part: Index) -> Self:
        """Return the scene of some gatherings, whole: no contact is cut from its neighbours."""
        shape = batch_of(self)
        try:
            found = np.shape(np.empty(shape, dtype=bool)[part])
        except IndexError:
            found = ()
        if len(found) != 1:
            rule = "would take contacts of a gathering apart"
            raise refuse("part", part, rule, "give a slice or a mask of the gatherings")
        taken: Self = batch.take(self, shape, part)
        object.__setattr__(taken, "shape", (*found, self.shape[-1]))
        return taken

    def _take_varying(self, part: Index) -> tuple[tuple[str, Array], ...]:
        """Return the values of each entry that varies, of the impacts that ``part`` indexes."""
        if not self._axes:
            return tuple((name, batch.lock_arrays(values[part])) for name, values in self._varied)
        size = self.shape[0]  # a grid is flat, and too large to be made anew for each part
        if isinstance(part, slice):
            impacts = np.arange(*part.indices(size))
        else:
            impacts = np.arange(size)[part]
        places = zip(self._axes, np.unravel_index(impacts, self.dimensions), strict=True)
        return tuple((name, batch.lock_arrays(values[place])) for (name, values), place in places)

    @property
    def index(self) -> int | Places:
        """Index of each impact in the whole batch, integers of the batch shape; 0 for one impact.

        ``take``, blocks, chunks and workers keep the index, which a law may use as a random seed.
        """
        if self._index is None:
            raise NoIndexError("the scene stands for many impacts")
        return self._index

    def with_index(self, index: int | np.integer | Sequence[int] | NDArray[np.integer]) -> Self:
        """Return this scene with another ``index`` of its impacts in the whole batch.

        Parameters
        ----------
        index : int or array of int
            Indices, of the batch shape.

        Raises
        ------
        ValueError
            If ``index`` has another shape, or its numbers are not integers.
        """
        check_place("index", index)
        try:
            indices = np.array(index)
        except ValueError:  # rows of unequal length
            indices = np.empty(())
        if indices.shape != self.shape or indices.dtype.kind not in "iu":
            rule = f"must be whole numbers of the shape {self.shape}"
            raise refuse("index", index, rule, "such as scene.index of the whole batch")
        return self._with(_index=batch.lock_arrays(indices) if self.shape else int(indices))


def over(scene: AnyScene, axes: Mapping[str, Numbers]) -> AnyScene:
    """Return this batch as a grid of ``axes``, whose combinations it must have in order.

    Parameters
    ----------
    axes : mapping of str to array, shape (n_i,)
        Values of each entry that varies, the last varying fastest.
    """
    lines = [(name, np.array(values, dtype=np.float64)) for name, values in axes.items()]
    return scene._with(_axes=tuple((name, batch.lock_arrays(v)) for name, v in lines))


def varying(scene: AnyScene, entries: Mapping[str, Numbers]) -> AnyScene:
    """Return this batch with the values of the entries that vary together.

    Parameters
    ----------
    entries : mapping of str to array
        Values of the batch shape.
    """
    lines = tuple((name, batch.lock_arrays(np.array(each))) for name, each in entries.items())
    return scene._with(_varied=lines)


def drop_varying(scene: AnyScene) -> AnyScene:
    """Return this batch without the values of entries that vary, which no law reads."""
    return scene._with(_axes=(), _varied=()) if scene._axes or scene._varied else scene


def drop_index(scene: AnyScene) -> AnyScene:
    """Return this scene without ``index``: a law that asks for it raises ``NoIndexError``."""
    return scene._with(_index=None)
