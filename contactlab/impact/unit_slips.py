"""Numbers of a scene that look as if they were in another unit."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.impact.bodies import Sphere
from contactlab.impact.scene import Scene

#: Sphere radius in m from which millimetres are more likely.
LARGE_RADIUS = 1.0
#: Density in kg/m³ and shear modulus in Pa that solids exceed: aerogels, the softest gels.
LEAST_DENSITY, LEAST_MODULUS = 25.0, 1e4
#: A spin in turns a minute read as rad/s is 9.5 times too fast: from so many rad/s on, a surface
#: that it moves at so many times the speed of the centres is suspect, since rolling is once.
LEAST_SPIN, MOST_RIM = 50.0, 8.0
#: An angle of so many radians or less, multiple of so many degrees to so many, is suspect.
STEP_DEG, NEAR_DEG = 5.0, 0.003


def unit_slips(scene: Scene) -> list[str]:
    """Return a sentence for each number of ``scene`` that is likely in another unit."""
    if scene.sphere is None or scene.target is None:
        return []
    slips = []
    for name, body in (("sphere", scene.sphere), ("target", scene.target)):
        density, modulus = body.material.density, _least(body.material.shear_modulus)
        radius = _most(body.radius) if isinstance(body, Sphere) else 0.0
        if radius >= LARGE_RADIUS:
            slips.append(f"unit: {name}.radius = {radius:.4g} m: is it in mm?")
        if density is not None and _least(density) < LEAST_DENSITY:
            told = f"{name}.material.density = {_least(density):.4g} kg/m³"
            slips.append(f"unit: {told}: is it in g/cm³?")
        if modulus < LEAST_MODULUS:
            told = f"{name}.material.shear_modulus = {modulus:.4g} Pa"
            slips.append(f"unit: {told}: is it in GPa?")
    speed = math.hypot(_most(scene.normal_speed), _most(abs(scene.tangential_velocity)))
    spin = _most(abs(scene.spin))
    rim = _most(scene.sphere.radius) * spin
    if spin >= LEAST_SPIN and rim > MOST_RIM * speed:
        told = f"spin = {spin:.4g} rad/s: the surface moves {rim / speed:.3g} times as fast"
        slips.append(f"unit: {told} as the centre; is it in turns a minute?")
    with np.errstate(all="ignore"):
        slope = _most(abs(scene.tangential_velocity / scene.normal_speed))
    angle_deg = math.degrees(math.atan(slope))
    meant = math.degrees(angle_deg)
    nearest = STEP_DEG * round(meant / STEP_DEG)
    if angle_deg <= 0.5 * math.pi and nearest > 0.0 and abs(meant - nearest) <= NEAR_DEG:
        told = f"angle of incidence {angle_deg:.6g}°: {nearest:g}° are as many radians"
        slips.append(f"unit: {told}; angle_deg is in degrees")
    return slips


def _least(value: Any) -> float:
    return value if isinstance(value, float) else float(np.min(value))


def _most(value: Any) -> float:
    return value if isinstance(value, float) else float(np.max(value))
