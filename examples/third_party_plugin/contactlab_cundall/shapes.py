"""A shape for scene files: ``shape = "pebble"``."""

from typing import Any

from contactlab import Material, RigidBody, shapes
from contactlab.plugin import Shape, hookimpl


def pebble(
    *,
    radius: float,
    height: float,
    normal: Any,
    axes: Any,
    material: Material,
    mass: float | None = None,
) -> tuple[RigidBody, Any]:
    """Return an ellipsoid of revolution, and its contact from its centre."""
    sizes = (radius, radius, height)
    return shapes.ellipsoid(semi_axes=sizes, normal=normal, axes=axes, material=material, mass=mass)


@hookimpl
def contactlab_shapes() -> list[Shape]:
    """Return the shape with its keys, and the numbers that checks make it with."""
    example = {"radius": 0.02, "height": 0.01}
    return [Shape(name="pebble", make=pebble, needed=("radius", "height"), example=example)]
