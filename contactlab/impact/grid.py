"""Grids: batches of every combination of some entries of a scene, which know their axes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, TypeVar

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.impact.bodies import Sphere
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import real, refuse

#: Most impacts of a grid: a slip of the finger should not fill the memory.
MOST_IMPACTS = 10_000_000
#: Units of the entries that a scene may be made of.
UNITS: dict[str, str] = {
    field.name: field.metadata["unit"]
    for kind in (Scene, Sphere, Material)
    for field in attrs.fields(kind)
    if "unit" in field.metadata
} | {"speed": "m/s", "angle_deg": "deg", "psi1": "1", "chi": "1", "young_modulus": "Pa"}
Array = NDArray[np.float64]
Kind = TypeVar("Kind", bound=Scene)


@attrs.frozen
class Grid(Scene):
    """A one-dimensional batch of every combination of some entries, the last varying fastest.

    ``Scene.grid`` and the ``[sweep]`` of a file make it; any part of it is a plain ``Scene``.

    Attributes
    ----------
    axes : mapping of str to array
        The values of each entry that varies, by its name, in the order of the dimensions: row
        ``i`` of the batch is ``np.unravel_index(i, grid.dimensions)`` of them.
    """

    axes: Mapping[str, Array] = attrs.field(kw_only=True, eq=False)

    @property
    def dimensions(self) -> tuple[int, ...]:
        """Return the length of each axis."""
        return tuple(values.size for values in self.axes.values())

    @property
    def scene(self) -> Scene:
        """Return the batch without its axes."""
        return _copied(self, Scene)

    def take(self, part: Any) -> Scene:
        """Return the plain scene of some of the impacts."""
        return self.scene.take(part)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what pickles of it: a mapping that is read-only does not."""
        return over, (self.scene, dict(self.axes))


def grid(*bodies: Any, **entries: Any) -> Grid:
    """Return the grid of a scene's entries: a list for each that varies, numbers for the others.

    Parameters
    ----------
    *bodies
        As ``Scene`` takes them; none for ``psi1`` and ``chi``.
    **entries
        As ``Scene``, ``Scene.at_angle`` or ``Scene.nondimensional`` takes them.

    Raises
    ------
    ValueError
        If nothing varies, a list has more than one dimension, or the scene is refused.
    """
    axes = {}
    for name, values in entries.items():
        if np.ndim(values):
            axes[name] = real(name, values)
            if np.ndim(axes[name]) != 1:
                raise refuse(name, values, "must be a number or a plain list of numbers")
    if not axes:
        raise refuse("entries", tuple(entries), "none of them varies", "give a list of one or more")
    make: Callable[..., Scene] = Scene
    if not bodies and {"psi1", "chi"} & set(entries):
        make = Scene.nondimensional
    elif {"speed", "angle_deg"} & set(entries):
        make = Scene.at_angle
    made = make(*bodies, **(entries | product(axes)))
    return over(made, axes)


def entry_unit(name: str) -> str:
    """Return the unit of an entry, by a dotted name too: ``"sphere.radius"`` is in m."""
    return UNITS[name.rpartition(".")[2]]


def product(axes: Mapping[str, Any]) -> dict[str, Array]:
    """Return the values of each axis in every combination, flat, the last varying fastest."""
    size = math.prod(np.size(values) for values in axes.values())
    if size > MOST_IMPACTS:
        raise refuse("product", size, f"must be at most {MOST_IMPACTS} impacts", "vary less")
    spread = np.meshgrid(*axes.values(), indexing="ij")
    return {name: values.ravel() for name, values in zip(axes, spread, strict=True)}


def over(scene: Scene, axes: Mapping[str, Any]) -> Grid:
    """Return the grid of a batch that has every combination of ``axes`` in its order."""
    found = _copied(scene, Grid)
    lines = {name: np.array(values, dtype=np.float64) for name, values in axes.items()}
    for values in lines.values():
        values.flags.writeable = False
    object.__setattr__(found, "axes", MappingProxyType(lines))
    return found


def _copied(scene: Scene, kind: type[Kind]) -> Kind:
    found = object.__new__(kind)  # every number was checked when the scene was made
    for field in attrs.fields(Scene):
        object.__setattr__(found, field.name, getattr(scene, field.name))
    return found
