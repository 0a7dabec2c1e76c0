"""Cautions about shells, and about numbers of rigid bodies that are probably mistaken."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.encounter import Encounter
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.rigid_body import FLAT, RigidBody
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import for_share
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Array, Real

#: Mass over that of a solid sphere, or ellipsoid, below which it is a shell, with a wall below a
#: fifth of R; and above which the unit of the mass of a sphere is suspect.
SHELL, HEAVY = 0.5, 20.0
#: Radius of gyration over R above which most mass lies in a shell; 0.632 of a solid sphere, 0.816
#: of a thin shell.
HOLLOW = 0.72
#: Distance in m of a contact from the centre of mass above which the unit is suspect.
LONG = 10.0
#: Distance of a contact from the centre of mass, over the radius of gyration, above which a unit is
#: suspect; the end of a slender rod has 2.1.
LONG_ARM = 20.0
#: Radius of curvature in m, and over the size (mass/density)^(1/3), above which it is suspect.
CURVED, OVER_SIZE = 1.0, 20.0
#: Radius of gyration over (mass/density)^(1/3), and over the distance of the contact, above which
#: it is suspect; a rod a thousand times as long as wide has 31 of the first.
SPREAD, OVER_ARM = 100.0, 200.0
#: Least radius of gyration over the distance of the contact below which it is suspect: a rod ten
#: thousand times as long as wide has a third of it.
UNDER_ARM = 1e-4
#: As for spheres: spin in rad/s, and speed that spin gives the contact over that of the centre.
LEAST_SPIN, MOST_RIM = 50.0, 8.0


@np.errstate(all="ignore")
def shells(scene: Scene, bodies: Mapping[str, Sphere | HalfSpace | RigidBody]) -> list[str]:
    """Return the caution of each body that is a shell, and of spheres far heavier than solid ones.

    ``bodies`` are those of the scene by the names of their arguments.
    """
    said = []
    for name, body in bodies.items():
        if isinstance(body, HalfSpace):
            continue
        share = _of_solid(body)
        if isinstance(body, RigidBody):
            if (least := float(np.fmin.reduce(share, initial=math.inf))) < SHELL:
                said.append(
                    f"model: {name}.mass is {least:.2g} of a solid body's mass, so that the body "
                    "may be a shell. A thin wall bends, but Hertz's contact is that of a solid."
                )
            continue
        if (most := float(np.fmax.reduce(share, initial=0.0))) > HEAVY:
            said.append(
                f"unit: {name}.mass = {_most(body.mass):.4g} kg: is the mass in g? A solid sphere "
                f"of this density has 1/{most:.3g} of that."
            )
        if (least := float(np.fmin.reduce(share, initial=math.inf))) < SHELL:
            said.append(
                f"model: {name}.mass is {least:.2g} of a solid sphere's mass, so that the {name} "
                f"is a shell. {_spring(scene, body)}"
            )
        elif _most(body.gyration_ratio) > HOLLOW:
            said.append(
                f"model: {name}.gyration_ratio = {_most(body.gyration_ratio):.3g} is that of a "
                "shell (0.632 if solid). A thin wall bends, but Hertz's contact is that of a solid."
            )
    return said


def _of_solid(body: Sphere | RigidBody) -> Array:
    """Return the masses over those of solid bodies of their density, 1 of unknown density.

    For a rigid body the solid is the ellipsoid of its mass and inertia: its semi-axes squared are 5
    times the mean squares of x, y and z of its mass. This ellipsoid has 1.08 times the volume of a
    cylinder of any length, and 1.13 times that of a box.
    """
    density = body.material.density
    if density is None:
        return np.ones(1)
    if isinstance(body, Sphere):
        product = np.asarray(body.radius) ** 3  # the cube of a float raises OverflowError
    else:
        moments = np.linalg.eigvalsh(body.inertia)
        squares = 0.5 * moments.sum(axis=-1)[..., None] - moments
        per_mass = 5.0 * np.maximum(squares, 0.0) / np.asarray(body.mass)[..., None]
        product = np.sqrt(per_mass.prod(axis=-1))
    return np.ravel(body.mass / (4.0 / 3.0 * math.pi * product * density))


def _spring(scene: Scene, body: Sphere) -> str:
    """Return words on the contact of a thin shell.

    Reissner, J. Math. Phys. 25 (1946) 279-300: F = 4 E h²/(R sqrt(3 (1 - nu²))) times the
    deflection under a force at a point, until the wall buckles at about its thickness.
    """
    density = body.material.density
    assert density is not None
    wall = np.asarray(body.mass) / (4.0 * math.pi * np.asarray(body.radius) ** 2 * density)
    nu = body.material.poisson_ratio
    young = 2.0 * body.material.shear_modulus * (1.0 + nu)
    stiffness = 4.0 * young * wall * wall / (body.radius * np.sqrt(3.0 * (1.0 - nu * nu)))
    lasting = math.pi * np.sqrt(scene.pair.normal_mass / stiffness)
    hertz = float(np.max(hertz_scales(scene).duration))
    return (
        f"Its wall of {_most(wall) * 1e3:.2g} mm is a spring of {_most(stiffness) / 1e3:.2g} kN/m "
        f"(Reissner 1946). The contact lasts about {_most(lasting) * 1e3:.2g} ms, not the "
        f"{hertz * 1e3:.2g} ms computed; forces and psi are wrong too."
    )


def units_of_bodies(encounter: Encounter) -> list[str]:
    """Return one sentence for each number of a rigid body that is probably in another unit."""
    speed = np.linalg.norm(encounter.velocity - encounter.target_velocity, axis=-1)
    spins = encounter.spin, encounter.target_spin
    said = []
    bodies = ("body", encounter.body), ("target", encounter.target)
    arms = encounter.contact, encounter.target_contact
    for (name, body), arm, spin in zip(bodies, arms, spins, strict=True):
        if not isinstance(body, RigidBody):
            continue
        mass, density = np.asarray(body.mass), body.material.density
        size = None if density is None else np.cbrt(mass / density)
        length = np.linalg.norm(arm, axis=-1)
        if _most(length) > LONG:
            told = f"the contact of the {name} is {_most(length):.4g} m from the centre of mass"
            said.append(f"unit: {told}: are lengths in mm?")
        radius = _curvature(body)
        taken = isinstance(body.curvature_radius, Taken)
        if radius >= CURVED and not taken and (size is None or radius > OVER_SIZE * _most(size)):
            said.append(f"unit: {name}.curvature_radius = {radius:.4g} m: is the radius in mm?")
        gyration = np.sqrt(np.trace(body.inertia, axis1=-2, axis2=-1) / (3.0 * mass))
        over = gyration / np.maximum(length, 1e-300)
        if (size is not None and _most(gyration / size) > SPREAD) or _most(over) > OVER_ARM:
            told = f"{name}.inertia has a radius of gyration of {_most(gyration):.4g} m"
            said.append(f"unit: {told}: is the inertia in kg mm² or g cm²?")
        least = np.sqrt(np.linalg.eigvalsh(body.inertia)[..., 0] / mass)
        if float(np.min(least / np.maximum(length, 1e-300))) < UNDER_ARM:
            told = f"{name}.inertia has a least radius of gyration of {float(np.min(least)):.2g} m"
            said.append(
                f"unit: {told}: is the inertia in kg m²? So small an inertia needs many steps."
            )
        turning = np.linalg.norm(spin, axis=-1)
        rim = _most(turning * length)
        if _most(turning) >= LEAST_SPIN and rim > MOST_RIM * _most(speed) > 0.0:
            told = f"the {name} spins at {_most(turning):.4g} rad/s: is the spin in turns a minute?"
            told += f" The contact moves {rim / _most(speed):.3g} times as fast as the centre."
            said.append(f"unit: {told}")
    return said


def tell_radii(encounter: Encounter, *, several: bool = False) -> list[str]:
    """Return one sentence for each radius of curvature that the user left out.

    That radius changes velocities if there are ``several`` contacts at once.
    """
    said = []
    for name, body in (("body", encounter.body), ("target", encounter.target)):
        if not (isinstance(body, RigidBody) and isinstance(body.curvature_radius, Taken)):
            continue
        radius = f"using {body.curvature_radius:.3g} m"
        if body.cross_radius is None:
            when = "as contacts act together" if several else "under laws of a rate or of yield"
            said.append(
                f"{name}: no curvature_radius given, {radius}, that of a solid ball of this mass. "
                f"This radius moves duration and force, and velocities {when}. "
                "Set your own: curvature_radius=..."
            )
        else:
            said.append(
                f"{name}: no crown_radius given, {radius} along the edge, ten times the longest "
                "side. Between 1 and 100 times it moves velocities by less than 0.01 of the "
                "approach speed. Set your own: crown_radius=..."
            )
    return said


def contact_vectors(encounter: Encounter) -> tuple[str, ...]:
    """Return the cautions of contacts of rigid bodies on the wrong side, or very far off."""
    normal = encounter.normal / np.linalg.norm(encounter.normal, axis=-1)[..., None]
    said = []
    sides = (("contact", encounter.body, 1.0), ("target_contact", encounter.target, -1.0))
    for name, body, sense in sides:
        if not isinstance(body, RigidBody):
            continue
        arm = getattr(encounter, name)
        behind = np.asarray(sense * np.sum(arm * normal, axis=-1) < 0.0)
        if behind.any():
            said.append(
                f"{name} lies behind the centre of mass{for_share(behind)}, where a convex body "
                f"does not touch. {name} is the vector from the centre of mass to the contact."
            )
        gyration = np.sqrt(
            np.trace(body.inertia, axis1=-2, axis2=-1) / (3.0 * np.asarray(body.mass))
        )
        ratio = _most(np.linalg.norm(arm, axis=-1) / gyration)
        if ratio > LONG_ARM:
            said.append(
                f"unit: {name} is {ratio:.3g} radii of gyration long: are lengths in m, and is the "
                "inertia in kg m²?"
            )
    return tuple(said)


def _curvature(body: RigidBody) -> float:
    """Return the largest radius of curvature in m that is not flat."""
    radii = np.abs(np.stack([np.ravel(each)[0] for each in (body.curvature_radius, body.crossing)]))
    finite = radii[radii < FLAT]
    return float(finite.max()) if finite.size else 0.0


def _most(value: Real) -> float:
    return float(np.max(value))
