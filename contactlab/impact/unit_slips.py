"""Numbers that look as if they were in another unit: cautions, for no rule forbids them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.impact.bodies import Sphere
from contactlab.impact.scene import Scene

#: Sphere radius in m from which millimetres are more likely.
LARGE_RADIUS = 1.0
#: Densities in kg/m³ between which those of solids lie: aerogels and foams, osmium (22 590).
LEAST_DENSITY, MOST_DENSITY = 25.0, 22_700.0
#: Shear moduli in Pa: below are only the softest gels, above is nothing (diamond has 535 GPa).
LEAST_MODULUS, MOST_MODULUS = 1e4, 6e11
#: Coulomb's coefficient of dry bodies stays below; rubber on rubber comes to 3.
MOST_FRICTION = 5.0
#: A spin in turns a minute read as rad/s is 9.5 times too fast: from so many rad/s on, a surface
#: that it moves at so many times the speed of the centres is suspect, since rolling is once.
LEAST_SPIN, MOST_RIM = 50.0, 8.0
#: An angle of so many radians or less, multiple of so many degrees to so many, is suspect.
STEP_DEG, NEAR_DEG = 5.0, 0.003


def unit_slips(scene: Scene) -> list[str]:
    """Return a sentence for each number of ``scene`` that is likely in another unit."""
    if scene.sphere is None or scene.target is None:
        return []
    found = []
    for name, body in (("sphere", scene.sphere), ("target", scene.target)):
        if isinstance(body, Sphere):
            found += _of_sphere(name, body)
        modulus = body.material.shear_modulus
        if _least(modulus) < LEAST_MODULUS:
            told = f"{name}.material.shear_modulus = {_least(modulus):.4g} Pa"
            found.append(f"unit: {told}: is it in GPa?")
        elif _most(modulus) > MOST_MODULUS:
            told = f"{name}.material.shear_modulus = {_most(modulus):.4g} Pa: stiffer than diamond"
            found.append(f"unit: {told}; moduli are in Pa")
    friction = _most(scene.friction_coefficient)
    if friction > MOST_FRICTION:
        told = f"friction_coefficient = {friction:.4g}: no dry bodies have so much"
        found.append(f"unit: {told}; is it in per cent, or an angle of friction in degrees?")
    return found + _of_spin(scene, scene.sphere) + _of_angle(scene)


def _of_sphere(name: str, body: Sphere) -> list[str]:
    if _most(body.radius) >= LARGE_RADIUS:
        return [f"unit: {name}.radius = {_most(body.radius):.4g} m: is it in mm?"]
    density = body.material.density
    if density is not None and _least(density) < LEAST_DENSITY:
        told = f"{name}.material.density = {_least(density):.4g} kg/m³"
        return [f"unit: {told}: is it in g/cm³?"]
    with np.errstate(all="ignore"):  # one after another: the cube of a tiny radius is zero
        mean = body.mass / body.radius / body.radius / body.radius / (4.0 / 3.0 * math.pi)
    if _most(mean) > MOST_DENSITY:
        told = f"{name}: mass and radius give a mean density of {_most(mean):.3g} kg/m³"
        return [f"unit: {told}, more than any solid has; mass is in kg, radius in m"]
    return []


def _of_spin(scene: Scene, sphere: Sphere) -> list[str]:
    """Return a sentence if the fastest spin is far beyond rolling at the greatest speed."""
    spin, radius = _most(abs(scene.spin)), _most(sphere.radius)
    along = _most(abs(scene.tangential_velocity))
    speed = math.hypot(_most(scene.normal_speed), along)
    if spin < LEAST_SPIN or not radius * spin > MOST_RIM * speed:
        return []
    told = f"spin = {spin:.4g} rad/s: the surface moves {radius * spin / speed:.3g} times as fast"
    return [f"unit: {told} as the centre; is it in turns a minute?"]


def _of_angle(scene: Scene) -> list[str]:
    """Return a sentence if the greatest angle is a round number of degrees, read as radians."""
    with np.errstate(all="ignore"):
        ratio = abs(scene.tangential_velocity / scene.normal_speed)
    angle_deg = math.degrees(math.atan(_most(ratio)))
    if not 0.0 < angle_deg <= 0.5 * math.pi:
        return []
    meant = math.degrees(angle_deg)
    round_one = STEP_DEG * round(meant / STEP_DEG)
    if round_one == 0.0 or abs(meant - round_one) > NEAR_DEG:
        return []
    told = f"angle of incidence {angle_deg:.6g}°: {round_one:g}° are as many radians"
    return [f"unit: {told}; angle_deg is in degrees"]


def _least(value: Any) -> float:
    return value if isinstance(value, float) else float(np.min(value))


def _most(value: Any) -> float:
    return value if isinstance(value, float) else float(np.max(value))
