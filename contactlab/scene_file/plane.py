"""Impacts by numbers along the normal and one tangent, of bodies that may both move."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import attrs
import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.encounter import Encounter
from contactlab.impact.scene import OBLIQUE, Scene
from contactlab.numeric.checks import NON_NEGATIVE, real, refuse
from contactlab.numeric.types import Array, Real
from contactlab.scene_file.entries import CARTESIAN, POLAR, STRUCK_KEYS, UNITS
from contactlab.scene_file.table import Table


def velocity(table: Table) -> tuple[Real, Real]:
    """Return the velocity of the first body in m/s, along the normal and along the tangent."""
    if table.has(*POLAR) and table.has(*CARTESIAN):
        raise ValueError(
            f"{table.path}: has both speed/angle_deg and normal_speed/tangential_velocity; "
            "leave out one pair"
        )
    if table.has(*POLAR):
        unit = "give speed in m/s and angle_deg in degrees from the normal"
        speed, angle = (table.number(key, remedy=unit) for key in POLAR)
        if table.has("along", *STRUCK_KEYS):  # of spheres on what stands still a scene checks
            moving = "write normal_speed and tangential_velocity, with their signs"
            speed = real(table.at("speed"), speed, rule=NON_NEGATIVE, remedy=moving)
            angle = real(table.at("angle_deg"), angle, rule=OBLIQUE, remedy=moving)
        return speed * np.cos(np.radians(angle)), speed * np.sin(np.radians(angle))
    table.require(CARTESIAN[0], "give it in m/s, or give speed and angle_deg")
    normal, along = (_number(table, key) for key in CARTESIAN)
    return normal, along


def surface(table: Table, target: Sphere | HalfSpace) -> tuple[Real, Real]:
    """Return the velocity of the struck surface at the contact in m/s, normal and tangential."""
    normal, along, spin = (_number(table, key) for key in STRUCK_KEYS)
    if isinstance(target, HalfSpace):
        check_spin(table.at(STRUCK_KEYS[2]), spin)
        return normal, along
    inward, sideward = rim(spin, (-np.asarray(target.radius), 0.0))
    return normal + inward, along + sideward


def check_spin(path: str, spin: Real) -> None:
    """Refuse a spin of a half-space that is not zero."""
    turning = np.ravel(spin)[np.flatnonzero(spin)]
    if turning.size:
        rule = "must be zero: a half-space does not spin"
        raise refuse(path, turning[0].item(), rule, f"give {STRUCK_KEYS[1]}, that of its surface")


def rim(spin: Real, arm: tuple[Real, Real]) -> tuple[Real, Real]:
    """Return the velocity at the end of an arm by a spin, in m/s along normal and tangent."""
    return -spin * arm[1], spin * arm[0]


def of_bodies(
    table: Table, bodies: list[Any], contacts: Mapping[str, Array]
) -> tuple[Scene, Encounter]:
    """Return scene and encounter of bodies by speeds along ``normal`` and ``along``."""
    n, t = directions(table)
    across = np.cross(n, t)

    def vector(normal: Real, along: Real) -> Array:
        whole = np.asarray(normal)[..., None] * n + np.asarray(along)[..., None] * t
        return np.asarray(whole)

    spin, target_spin = (
        np.asarray(_number(table, key))[..., None] * across for key in ("spin", "target_spin")
    )
    if isinstance(bodies[1], HalfSpace):
        check_spin(table.at(STRUCK_KEYS[2]), _number(table, STRUCK_KEYS[2]))
    friction = table.friction()

    before = vector(*velocity(table))
    struck = vector(*(_number(table, key) for key in STRUCK_KEYS[:2]))

    about: dict[str, Any] = dict(contacts)

    def meet() -> Encounter:
        return Encounter(
            body=bodies[0],
            target=bodies[1],
            friction_coefficient=friction,
            normal=n,
            velocity=before,
            spin=spin,
            target_velocity=struck,
            target_spin=target_spin,
            **about,
        )

    encounter = table.make(meet)
    x, y, z = t.tolist()
    return table.make(lambda: attrs.evolve(encounter.scene, along=(x, y, z))), encounter


def directions(table: Table) -> tuple[Array, Array]:
    """Return the unit normal, and the unit tangent nearest to ``along``."""
    n, t = (
        np.asarray(real(table.at(key), table.content[key]), dtype=float)
        for key in ("normal", "along")
    )
    for key, vector in (("normal", n), ("along", t)):
        if vector.shape != (3,):
            raise refuse(table.at(key), vector.tolist(), "must be a vector of three numbers")
    if not np.linalg.norm(n) > 0.0:
        raise refuse(table.at("normal"), n.tolist(), "must not be zero")
    n = n / np.linalg.norm(n)
    t = t - (t @ n) * n
    if not np.linalg.norm(t) > 1e-6 * np.linalg.norm(table.content["along"]):
        rule = "must not lie along the normal"
        raise refuse(table.at("along"), table.content["along"], rule, "give a tangent")
    return n, t / np.linalg.norm(t)


def _number(table: Table, key: str) -> Real:
    """Return the number of a key, 0 if it is not there."""
    return table.number(key, remedy=f"give it in {UNITS[key]}") if table.has(key) else 0.0
