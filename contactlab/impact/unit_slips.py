"""Cautions about numbers of a scene that are probably in another unit."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.impact.bodies import Sphere
from contactlab.impact.scene import Scene

#: Sphere radius in m from which the unit was probably mm.
LARGE_RADIUS = 1.0
#: Density in kg/m³ and shear modulus in Pa of the lightest and softest solids, aerogels and gels.
LEAST_DENSITY, LEAST_MODULUS = 25.0, 1e4
#: A spin in turns a minute read as rad/s is 9.5 times too fast. Suspect are spins of at least
#: LEAST_SPIN rad/s that move the surface at more than MOST_RIM times the speed of the centre; a
#: rolling sphere has once that speed.
LEAST_SPIN, MOST_RIM = 50.0, 8.0
#: Friction coefficient above which it is doubtful; speed over that of sound, sqrt(E/rho), above
#: which waves carry off energy and Hertz's law is doubtful.
MOST_FRICTION, SOUND_PART = 2.0, 0.1
#: An angle that is a multiple of STEP_DEG degrees, to NEAR_DEG, when read in radians is suspect.
STEP_DEG, NEAR_DEG = 5.0, 0.003


def unit_slips(scene: Scene) -> list[str]:
    """Return one sentence for each number of ``scene`` that is probably in another unit."""
    if scene.sphere is None or scene.target is None:
        return []
    slips = []
    for name, body in (("sphere", scene.sphere), ("target", scene.target)):
        density, modulus = body.material.density, _least(body.material.shear_modulus)
        radius = _most(body.radius) if isinstance(body, Sphere) else 0.0
        if radius >= LARGE_RADIUS:
            slips.append(f"unit: {name}.radius = {radius:.4g} m: is it in mm?")
        if density is not None and _least(density) < LEAST_DENSITY:
            number = f"{name}.material.density = {_least(density):.4g} kg/m³"
            slips.append(f"unit: {number}: is it in g/cm³?")
        if modulus < LEAST_MODULUS:
            young = 2.0 * (1.0 + _least(body.material.poisson_ratio)) * modulus
            number = f"{name}.material.shear_modulus = {modulus:.4g} Pa (Young's {young:.4g} Pa)"
            slips.append(f"unit: {number}: is it in GPa?")
    speed = math.hypot(_most(scene.normal_speed), _most(abs(scene.tangential_velocity)))
    spin = _most(abs(scene.spin))
    rim = _most(scene.sphere.radius) * spin
    if spin >= LEAST_SPIN and rim > MOST_RIM * speed:
        number = f"spin = {spin:.4g} rad/s: the surface moves {rim / speed:.3g} times as fast"
        slips.append(f"unit: {number} as the centre; is it in turns a minute?")
    with np.errstate(all="ignore"):
        slope = _most(abs(scene.tangential_velocity / scene.normal_speed))
    angle_deg = math.degrees(math.atan(slope))
    intended = math.degrees(angle_deg)
    nearest = STEP_DEG * round(intended / STEP_DEG)
    if angle_deg <= 0.5 * math.pi and nearest > 0.0 and abs(intended - nearest) <= NEAR_DEG:
        number = f"angle of incidence {angle_deg:.6g}°: {nearest:g}° are as many radians"
        slips.append(f"unit: {number}; angle_deg is in degrees")
    return slips


def unlikely(scene: Scene) -> list[str]:
    """Return one sentence for each number of ``scene`` that few contacts have."""
    if scene.sphere is None or scene.target is None:
        return []
    slips, speed = [], _most(scene.normal_speed)
    if (friction := _most(scene.friction_coefficient)) > MOST_FRICTION:
        slips.append(
            f"friction_coefficient = {friction:.4g}: above {MOST_FRICTION:g} surfaces stick like "
            "soft rubber; is it in per cent, or an angle?"
        )
    for name, body in (("sphere", scene.sphere), ("target", scene.target)):
        if (density := body.material.density) is not None:
            young = 2.0 * (1.0 + body.material.poisson_ratio) * body.material.shear_modulus
            sound = _least(np.sqrt(np.asarray(young) / density))
            if speed > SOUND_PART * sound:
                slips.append(
                    f"normal speed {speed:.4g} m/s is {speed / sound:.2g} of the speed of sound in "
                    f"the {name}, {sound:.4g} m/s: above {SOUND_PART:g} the contact is not "
                    "quasi-static"
                )
    return slips


def _least(value: Any) -> float:
    """Return the smallest number of a batch, or the number itself."""
    return value if isinstance(value, float) else float(np.min(value))


def _most(value: Any) -> float:
    """Return the largest number of a batch, or the number itself."""
    return value if isinstance(value, float) else float(np.max(value))
