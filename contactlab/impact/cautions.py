"""Cautions about bodies and materials, and about numbers that are probably in another unit."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.hertz import elongation_of, hertz_scales, peak_pressure, semi_axes
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import for_share, some
from contactlab.numeric.types import Real
from contactlab.numeric.vectors import rows

#: Peak pressure of Hertz's contact at which yield begins beneath the surface, over the yield
#: stress Y (Thornton's law has the same factor).
FIRST_YIELD = 1.6
GPA = 1e9
#: Above this ratio of contact radius to R the theory of half-spaces is doubtful (theory §8).
DOUBTFUL_SIZE_RATIO = 0.1
#: Growth of beta0 of deep contacts over C² = z/R, and the deepest of the 13 bounces of a superball
#: from which it is (theory §15; ``study/measured/superball.toml``).
DEEPER, DEEPEST = (0.8, 2.0), 0.175
#: Words of a caution whose size lies beyond its measurements.
OUTSIDE = "outside the measured range"
#: Range of attraction of surfaces in m, about the distance between atoms.
RANGE = 3e-10
#: Sphere radius in m from which the unit was probably mm.
LARGE_RADIUS = 1.0
#: Density in kg/m³ and shear modulus in Pa of the lightest and softest solids, aerogels and gels.
LEAST_DENSITY, LEAST_MODULUS = 25.0, 1e4
#: Above this density in kg/m³ solids are metals, stones and glasses, whose shear modulus in Pa is
#: above this; a number below MEGA was probably meant in GPa, one above it in MPa.
HEAVY, LEAST_HARD, MEGA = 2000.0, 1e7, 1e3
#: Several angles are suspect whose largest in degrees lies between this and 90 degrees in radians.
SEVERAL, LEAST_RADIANS = 3, 0.4
#: A spin in turns a minute read as rad/s is 9.5 times too fast. Suspect are spins of at least
#: LEAST_SPIN rad/s that move the surface at more than MOST_RIM times the speed of the centre; a
#: rolling sphere has once that speed.
LEAST_SPIN, MOST_RIM = 50.0, 8.0
#: Friction coefficient above which it is doubtful; speed over that of sound, sqrt(E/rho), above
#: which waves carry off energy and Hertz's law is doubtful.
MOST_FRICTION, SOUND_PART = 2.0, 0.1
#: An angle that is a multiple of STEP_DEG degrees, to NEAR_DEG, when read in radians is suspect.
STEP_DEG, NEAR_DEG = 5.0, 0.003


def large_contact(ratio: float) -> tuple[str, ...]:
    """Return the caution of a contact that is not small; ``ratio`` is its ``size_of_contact``."""
    if not ratio > DOUBTFUL_SIZE_RATIO:
        return ()
    low, high = (rate * ratio * ratio for rate in DEEPER)
    here = f"For balls beta0 is then {low:.2g} to {high:.2g} higher."
    if ratio * ratio > DEEPEST:
        here = f"Its effect on beta0 is {OUTSIDE}."
    return (
        f"model: large contact, a/R = {ratio:.3g}. The theory holds below about "
        f"{DOUBTFUL_SIZE_RATIO}. {here}",
    )


def size_of_contact(scene: Scene, radius: Real) -> float:
    """Return the largest contact radius over R, for contact radii in m.

    Between bodies that are no spheres: of the minor semi-axis over the least radius of curvature,
    and of the major one over the distances of the centres of mass.
    """
    largest = radius / scene.pair.radius
    encounter = scene.encounter
    if encounter is None or encounter.of_spheres:
        return float(np.max(largest))
    from contactlab.impact.body_contact import gap_of  # spheres need none of this
    from contactlab.impact.rigid_body import RigidBody

    one, other = semi_axes(scene.pair)
    minor, major = radius * np.minimum(one, other), radius * np.maximum(one, other)
    if np.all(np.equal(one, other)):
        major = 0.0 * major
    else:
        assert scene.frame is not None
        _, t1, t2 = rows(scene.frame)
        largest = minor * gap_of(encounter, t1, t2).most
    arms = encounter.contact, encounter.target_contact
    for body, arm in zip(name_bodies(scene).values(), arms, strict=True):
        if isinstance(body, RigidBody):
            least = np.minimum(np.abs(body.curvature_radius), np.abs(body.crossing))
            length = np.linalg.norm(arm, axis=-1)
            with np.errstate(divide="ignore", invalid="ignore"):
                over = np.where(major > 0.0, major / length, 0.0)
            largest = np.maximum(np.maximum(largest, minor / least), over)
    return float(np.max(largest))


def path_cautions(scene: Scene, deepest: float, *, plastic: bool) -> tuple[str, ...]:
    """Return the cautions of bodies that are pressed together by ``deepest`` m."""
    if not (name_bodies(scene) and deepest > 0.0):
        return ()
    ratio = np.sqrt(deepest / scene.pair.radius)
    one, other = semi_axes(scene.pair)
    pressure = (2.0 / math.pi) * scene.pair.effective_modulus * ratio / (one * other)
    cautions = () if plastic else yielding(scene, pressure)
    return (*cautions, *large_contact(size_of_contact(scene, ratio * scene.pair.radius)))


def rigid_bodies(scene: Scene) -> tuple[str, ...]:
    """Return the cautions of bodies that are no spheres: they ring."""
    if scene.encounter is None:
        return ()
    from contactlab.impact.rigid_body import RigidBody  # spheres need none of this

    bodies = [body for body in name_bodies(scene).values() if isinstance(body, RigidBody)]
    if not bodies:
        return ()
    shortest = _least(hertz_scales(scene).duration)
    return tuple(text for body in bodies for text in body.cautions(shortest))


def of_ellipse(scene: Scene, name: str) -> tuple[str, ...]:
    """Return the caution of a law, by its name, that takes an elliptic contact for a circle."""
    elongation = np.broadcast_to(elongation_of(scene.pair), scene.shape)
    ratio = float(np.max(elongation))
    if ratio == 1.0:
        return ()
    share = "" if np.all(elongation > 1.0) else for_share(elongation > 1.0)
    return (
        f"model{share}: the contact is an ellipse of {ratio:.3g} : 1, but {name} was made for a "
        "circle. A circle as stiff stands in.",
    )


def yielding(scene: Scene, peak: Real | None = None) -> tuple[str, ...]:
    """Return the caution of a Hertz pressure above 1.6 Y; empty without yield stresses.

    Parameters
    ----------
    scene : Scene
    peak : float or array, optional
        Greatest pressure in Pa; that of the elastic impact by default.
    """
    stresses: dict[str, Any] = {
        name: body.material.yield_stress
        for name, body in name_bodies(scene).items()
        if body.material.yield_stress is not None
    }
    if not stresses:
        return ()
    pressure = np.broadcast_to(peak_pressure(scene) if peak is None else peak, scene.shape)
    limits = np.stack(
        [np.broadcast_to(FIRST_YIELD * stress, scene.shape) for stress in stresses.values()]
    )
    limit = np.fmin.reduce(limits)  # NaN without a yield stress
    yields = pressure > limit
    if not yields.any():
        return ()
    worst = np.unravel_index(np.nanargmax(pressure / limit), scene.shape) if scene.shape else ()
    softest = list(stresses)[int(np.nanargmin([each[worst] for each in limits]))]
    return (
        f"model{for_share(yields)}: the {softest} would yield, which the normal law ignores. "
        f"Peak pressure: {pressure[worst] / GPA:.2g} GPa; yield begins at "
        f"{limit[worst] / GPA:.2g} GPa.",
    )


def tell_yield(scene: Scene) -> tuple[str, Any, Real]:
    """Return words on bodies without yield stress, where there are any, and pressures in GPa.

    The words are empty if all bodies have one.
    """
    where: dict[str, Any] = {}
    for name, body in name_bodies(scene).items():
        stress = body.material.yield_stress
        missing = True if stress is None else np.isnan(stress)
        if some(missing):
            where[f"the {name}"] = np.broadcast_to(missing, scene.shape) if scene.shape else missing
    if not where:
        return "", False, 0.0
    have = "has" if len(where) == 1 else "have"
    words = (
        f"yield check: {' and '.join(where)} {have} no yield_stress. Peak pressure: {{:.2g}} GPa."
    )
    return words, np.logical_or.reduce([*where.values()]), peak_pressure(scene) / GPA


def tabor_caution(
    scene: Scene,
    work_of_adhesion: float,
    *,
    other: str,
    least: float = 0.0,
    most: float = math.inf,
) -> tuple[str, ...]:
    """Return the caution if Tabor's parameter lies outside [``least``, ``most``].

    Tabor's parameter is (R Gamma²/(E*² h³))^(1/3), h the range of attraction: Tabor, J. Colloid
    Interface Sci. 58 (1977) 2-13, doi:10.1016/0021-9797(77)90366-6. ``work_of_adhesion`` is Gamma
    in J/m², ``other`` names the law for the other range.
    """
    if scene.sphere is None or work_of_adhesion == 0.0:
        return ()
    pair = scene.pair
    tabor = np.cbrt(pair.radius * (work_of_adhesion / pair.effective_modulus) ** 2) / RANGE
    low, high = float(np.min(tabor)), float(np.max(tabor))
    if least <= low and high <= most:
        return ()
    bound, value = (f"above {least:g}", low) if low < least else (f"below {most:g}", high)
    return (f"model: Tabor's parameter is {value:.2g}, but the theory holds {bound}. Use {other}.",)


def name_bodies(scene: Scene) -> dict[str, Any]:
    """Return the bodies of a scene by the name of their argument; none of a scene of numbers.

    A batch with targets of several kinds has no target.
    """
    if scene.sphere is not None:
        bodies = {"sphere": scene.sphere, "target": scene.target}
        return {name: body for name, body in bodies.items() if body is not None}
    if scene.encounter is None:
        return {}
    return {name: getattr(scene.encounter, name) for name in ("body", "target")}


def unit_slips(scene: Scene, *, several: bool = False) -> list[str]:
    """Return one sentence for each number of ``scene`` that is probably in another unit.

    ``several`` is True of one of the contacts of a gathering.
    """
    slips = []
    for name, body in name_bodies(scene).items():
        density, modulus = body.material.density, _least(body.material.shear_modulus)
        radius = _most(body.radius) if isinstance(body, Sphere) else 0.0
        if radius >= LARGE_RADIUS:
            slips.append(f"unit: {name}.radius = {radius:.4g} m: is the length in mm?")
        if density is not None and _least(density) < LEAST_DENSITY:
            number = f"{name}.material.density = {_least(density):.4g} kg/m³"
            slips.append(f"unit: {number}: is the density in g/cm³?")
        if modulus < LEAST_MODULUS:
            unit = "GPa" if modulus < MEGA else "MPa"
            slips.append(f"unit: {_modulus(name, body)}: is the modulus in {unit}?")
        elif density is not None and _least(density) > HEAVY and modulus < LEAST_HARD:
            slips.append(f"unit: {_modulus(name, body)}: is the modulus in MPa?")
    if scene.sphere is None:
        met = scene.encounter
        if met is None or met.of_spheres:
            return slips
        from contactlab.impact import body_cautions  # spheres need none of this

        told = body_cautions.tell_radii(met, several=several)
        return [*slips, *body_cautions.units_of_bodies(met), *told]
    speed = math.hypot(_most(scene.normal_speed), _most(abs(scene.tangential_velocity)))
    spin = _most(abs(scene.spin))
    rim = _most(scene.sphere.radius) * spin
    if spin >= LEAST_SPIN and rim > MOST_RIM * speed:
        number = f"spin = {spin:.4g} rad/s: is the spin in turns a minute?"
        slips.append(
            f"unit: {number} The surface moves {rim / speed:.3g} times as fast as the centre."
        )
    with np.errstate(all="ignore"):
        slope = _most(abs(scene.tangential_velocity / scene.normal_speed))
    angle_deg = math.degrees(math.atan(slope))
    intended = math.degrees(angle_deg)
    nearest = STEP_DEG * round(intended / STEP_DEG)
    if angle_deg <= 0.5 * math.pi and nearest > 0.0 and abs(intended - nearest) <= NEAR_DEG:
        number = f"angle of incidence {angle_deg:.6g}°: was this {nearest:g}° in radians?"
        slips.append(f"unit: {number} angle_deg is in degrees.")
    elif _like_radians(scene):
        number = f"all angles of incidence lie below {angle_deg:.4g}°: are they in radians?"
        slips.append(f"unit: {number} angle_deg is in degrees.")
    return slips


def _modulus(name: str, body: Sphere | HalfSpace) -> str:
    """Return the shear modulus of a body in words."""
    modulus = _least(body.material.shear_modulus)
    young = 2.0 * (1.0 + _least(body.material.poisson_ratio)) * modulus
    return f"{name}.material.shear_modulus = {modulus:.4g} Pa (Young's {young:.4g} Pa)"


def _like_radians(scene: Scene) -> bool:
    """Return whether several angles look like radians: all below 90 degrees in radians."""
    if len(scene.shape) != 1 or np.any(scene.spin):
        return False
    angles = np.degrees(np.arctan2(np.abs(scene.tangential_velocity), scene.normal_speed))
    angles = np.broadcast_to(angles, scene.shape)
    several = np.unique(angles.round(9)).size >= SEVERAL
    return bool(several and LEAST_RADIANS <= np.max(angles) <= 0.5 * math.pi)


def unlikely(scene: Scene) -> list[str]:
    """Return one sentence for each unusual number of ``scene``."""
    bodies = name_bodies(scene)
    if not bodies:
        return []
    from contactlab.impact.body_cautions import shells  # numbers without bodies need none of this

    slips, speed = shells(scene, bodies), _most(scene.normal_speed)
    if (friction := _most(scene.friction_coefficient)) > MOST_FRICTION:
        slips.append(
            f"unit: friction_coefficient = {friction:.4g} is very high: is the number in per cent, "
            "or an angle?"
        )
    for name, body in bodies.items():
        if (density := body.material.density) is not None:
            young = 2.0 * (1.0 + body.material.poisson_ratio) * body.material.shear_modulus
            sound = _least(np.sqrt(np.asarray(young) / density))
            if speed > SOUND_PART * sound:
                slips.append(
                    f"model: the normal speed is {speed / sound:.2g} of the speed of sound in the "
                    f"{name}. Above {SOUND_PART:g} the contact is not quasi-static."
                )
    return slips


def three_numbers(scene: Scene) -> tuple[str, ...]:
    """Return the caution of a single entry with three numbers, which may be meant as a vector."""
    if scene.shape != (3,) or scene.sphere is None:
        return ()
    arrays = [name for name, number in scene.numbers().items() if np.ndim(number)]
    if len(arrays) != 1:
        return ()
    return (
        f"{arrays[0]}: three numbers were read as three impacts. For a vector in space use an "
        "Encounter.",
    )


def _least(value: Real) -> float:
    """Return the smallest number of a batch, or the number itself."""
    return value if isinstance(value, float) else float(np.nanmin(value))


def _most(value: Real) -> float:
    """Return the largest number of a batch, or the number itself."""
    return value if isinstance(value, float) else float(np.max(value))
