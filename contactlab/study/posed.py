"""Scenes of psi1 and chi for laws whose options have a unit, which need bodies of some size."""

from __future__ import annotations

from collections.abc import Iterable

import attrs

from contactlab.contracts import Law
from contactlab.impact.scene import Scene
from contactlab.registry.acceptance import in_units
from contactlab.testing.load_paths import scene as ball


def need_units(laws: Iterable[Law]) -> bool:
    """Return whether an option of a law has a unit."""
    return any(map(in_units, laws))


def pose(scene: Scene, laws: Iterable[Law]) -> Scene:
    """Return a scene of groups that the laws accept: a ball like one of steel if they need units.

    psi1, chi, lam and eta stay as they are, and so does the friction coefficient.

    Parameters
    ----------
    scene : Scene
        One impact or a batch, without spin about the normal.
    laws : iterable of Law
    """
    if scene.has_units or not need_units(laws):
        return scene
    like, pair = ball(0.0, 1.0), scene.pair
    mass, speed, modulus = like.pair.normal_mass, like.normal_speed, like.pair.effective_modulus
    sized = attrs.evolve(
        pair,
        radius=like.pair.radius,
        effective_modulus=modulus,
        effective_shear_modulus=pair.stiffness_ratio * modulus,
        normal_mass=pair.normal_mass * mass,
        tangential_mass=pair.tangential_mass * mass,
    )
    W = scene.inverse_mass
    return attrs.evolve(
        scene,
        pair=sized,
        normal_speed=scene.normal_speed * speed,
        tangential_velocity=scene.tangential_velocity * speed,
        inverse_mass=None if W is None else W / mass,
        unit_friction=False,
        has_units=True,
    )
