"""Bodies that are no spheres: ``[body]`` of a scene file, by mass and inertia or by a shape."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from contactlab.impact.material import Material
from contactlab.impact.rigid_body import RigidBody
from contactlab.impact.shapes import Shape, shapes_by_name
from contactlab.numeric.checks import real, refuse
from contactlab.numeric.types import Array, Real
from contactlab.scene_file.entries import RIGID_KEYS, TILT
from contactlab.scene_file.table import Table

#: Default axis of a rod or disc: up, so that a rod hangs over what lies below.
UPRIGHT = (0.0, 0.0, 1.0)
#: No shapes.
NONE: Mapping[str, Shape] = {}


def rigid_body(
    content: object,
    path: str,
    normal: Array,
    material: Callable[[Table], Material],
    *,
    further: Mapping[str, Shape] = NONE,
    beside: tuple[str, ...] = (),
) -> tuple[Any, ...]:
    """Return the body of a table, and its contact in m; None if the table has no shape.

    Parameters
    ----------
    content : table of the file
    path : str
        Its dotted path.
    normal : vector
        Outward normal of the body at the contact.
    material : callable
        Reads the material of a table.
    further : mapping
        More shapes by name; of those that land flat contacts and gaps follow the body.
    beside : tuple of str
        Keys of the table that are not of the body.
    """
    name = content.get("shape") if isinstance(content, Mapping) else None
    known = {**shapes_by_name(), **further}
    if name is None:
        table = Table(content, path, known=("kind", "shape", *RIGID_KEYS, *beside))
        numbers = {key: table.content[key] for key in RIGID_KEYS if table.has(key)}
        table.require("mass", "or name a shape: " + ", ".join(known))
        return table.make(RigidBody, **numbers | {"material": material(table)}), None
    if not (isinstance(name, str) and name in known):
        raise refuse(f"{path}.shape", name, "is no shape", "known: " + ", ".join(known))
    shape = known[name]
    table = Table(content, path, known=("kind", "shape", TILT, *shape.keys, *beside))
    options = {key: table.content[key] for key in shape.keys if table.has(key)}
    options |= {"material": material(table), "normal": normal}
    tilt = real(table.at(TILT), table.content.get(TILT, 0.0), remedy="in degrees, about y")
    upright = options.pop(shape.oriented, UPRIGHT if shape.oriented == "axis" else np.eye(3))

    def make(**numbers: object) -> tuple[Any, ...]:
        try:
            turned = _about_y(tilt) @ np.asarray(upright, dtype=float)
        except ValueError:
            raise refuse(shape.oriented, upright, "must be vectors of three numbers") from None
        return shape.make(**numbers, **{shape.oriented: turned})

    for key in shape.needed:
        table.require(key, f"a {name} needs {', '.join(shape.needed)} in m")
    return table.make(make, **options)


def _about_y(degrees: Real) -> Array:
    """Return the matrix of a turn about y, shape (..., 3, 3)."""
    s, c = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
    one, none = np.ones_like(s), np.zeros_like(s)
    rows = [[c, none, s], [none, one, none], [-s, none, c]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))
