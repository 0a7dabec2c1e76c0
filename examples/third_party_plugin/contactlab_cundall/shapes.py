"""A shape for scene files: ``shape = "pebble"``."""

from contactlab import shapes
from contactlab.plugin import Shape, hookimpl


def pebble(*, radius, height, normal, axes, material, mass=None):
    """Return an ellipsoid of revolution, and its contact from its centre."""
    sizes = (radius, radius, height)
    return shapes.ellipsoid(semi_axes=sizes, normal=normal, axes=axes, material=material, mass=mass)


@hookimpl
def contactlab_shapes():
    """Return the shape with its keys, and the numbers that checks make it with."""
    example = {"radius": 0.02, "height": 0.01}
    return [Shape(name="pebble", make=pebble, needed=("radius", "height"), example=example)]
