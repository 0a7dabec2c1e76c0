"""Make a scene from the tables of a file; arrays in place of numbers make a batch."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.encounter import Encounter
from contactlab.impact.material import Material
from contactlab.impact.rigid_body import RigidBody
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import of_kind, real, refuse, unit_remedy
from contactlab.numeric.types import Array
from contactlab.scene_file import plane
from contactlab.scene_file.bodies import rigid_body
from contactlab.scene_file.entries import (
    BODY_SECTIONS,
    CARTESIAN,
    COUPLING_KEYS,
    GROUP_KEYS,
    IMPACT_KEYS,
    NONDIMENSIONAL_KEYS,
    POLAR,
    SPHERE_KEYS,
    SPHERE_VECTORS,
    SPIN_KEYS,
    STRUCK_KEYS,
    UNITS,
    VECTOR_KEYS,
)
from contactlab.scene_file.table import MATERIAL_KEYS, PROPERTIES, Table

#: Key of the tangent of an impact of bodies by speeds, its other keys, and vectors to the contact.
ALONG, CONTACTS = "along", ("contact", "target_contact")
PLANE_KEYS = (*IMPACT_KEYS[:-1], *STRUCK_KEYS, "normal", ALONG, *CONTACTS)


def build_scene(
    document: Mapping[str, object],
) -> tuple[Scene, Encounter | None]:
    """Return the scene of a file's tables, and the encounter in space if vectors are sections."""
    sections = [name for name in BODY_SECTIONS if name in document]
    if "nondimensional" in document:
        if sections:
            raise ValueError(
                f"nondimensional: psi1 and chi define the whole scene; leave out [{sections[0]}], "
                "or [nondimensional]"
            )
        known = (*NONDIMENSIONAL_KEYS, *GROUP_KEYS, *COUPLING_KEYS, *SPIN_KEYS)
        table = Table(document["nondimensional"], "nondimensional", known=known)
        if table.has(*COUPLING_KEYS):
            table.require("lam", "eta and rho need lam, the effect of friction on the approach")
        groups = _present(table, (*GROUP_KEYS, *SPIN_KEYS, "eta", "rho"))
        for key in (*NONDIMENSIONAL_KEYS, "lam"):
            if table.has("rho") and isinstance(table.content.get(key), list):
                groups[key] = table.content[key]  # a vector or tensor of the tangent plane
            elif key != "lam" or table.has(key):
                groups |= _numbers(table, (key,))
        return table.make(Scene.nondimensional, **groups), None
    root = Table({name: document[name] for name in sections}, "", known=BODY_SECTIONS)
    if "body" in sections or _is_rigid(document.get("target")):
        given = document.get("impact")
        if isinstance(given, Mapping) and ALONG in given:
            if "velocity" in given:
                rule = "velocity is a vector, but along goes with speeds as numbers"
                raise ValueError(f"impact: {rule}; leave out one of the two")
            impact = root.table("impact", known=PLANE_KEYS)
            bodies, contacts = _bodies(root, impact)
            contacts |= {key: impact.content[key] for key in CONTACTS if impact.has(key)}
            return plane.of_bodies(impact, bodies, contacts)
        _refuse_speeds(document.get("impact"))
        impact = root.table("impact", known=("friction_coefficient", *VECTOR_KEYS))
        bodies, contacts = _bodies(root, impact)
        encounter = _encounter(impact, *bodies, **contacts)
        return impact.make(lambda: encounter.scene), encounter
    sphere = read_sphere(root.table("sphere", known=SPHERE_KEYS))
    target = _target(root)
    keys = dict.fromkeys((*IMPACT_KEYS, *SPHERE_VECTORS, *STRUCK_KEYS))
    impact = root.table("impact", known=keys)
    if impact.has("velocity", "normal", "target_velocity"):
        encounter = _encounter(impact, sphere, target)
        return impact.make(lambda: encounter.scene), encounter
    return _impact(impact, sphere, target), None


def _refuse_speeds(impact: object) -> None:
    """Refuse speed and angle, which a file of spheres or a fit gives, in place of a vector."""
    for key in IMPACT_KEYS[1:]:
        if key not in VECTOR_KEYS and isinstance(impact, Mapping) and key in impact:
            raise ValueError(
                f"impact.{key}: is for spheres; for a body write velocity = [x, y, z] in m/s, or "
                f"keep {key} and add along = [x, y, z], the tangential direction"
            )


def _numbers(table: Table, keys: tuple[str, ...]) -> dict[str, Any]:
    """Return the numbers of ``keys``, all of them required."""
    remedies = {key: unit_remedy(UNITS[key]) for key in keys}
    return {key: table.number(key, remedy=remedies[key]) for key in keys}


def _present(table: Table, keys: tuple[str, ...]) -> dict[str, Any]:
    """Return the numbers of those ``keys`` that the table has."""
    return _numbers(table, tuple(key for key in keys if table.has(key)))


def read_material(table: Table) -> Material:
    """Return the material of a table."""
    material = table.table("material", known=(*MATERIAL_KEYS, PROPERTIES))
    material.require("poisson_ratio", "for example 0.3")
    if material.has("shear_modulus") == material.has("young_modulus"):
        raise ValueError(
            f"{material.path}: give exactly one of shear_modulus and young_modulus, in Pa; the "
            "other follows from E = 2 G (1 + nu)"
        )
    numbers = _present(material, MATERIAL_KEYS)
    if material.has(PROPERTIES):
        properties = material.content[PROPERTIES]
        of_kind(material.at(PROPERTIES), properties, Mapping, rule="must be a table")
        for name, value in properties.items():
            if isinstance(value, list):
                remedy = "put lists in [sweep]"
                raise refuse(
                    material.at(f"{PROPERTIES}.{name}"), value, "must be one number", remedy
                )
        numbers[PROPERTIES] = properties
    return material.make(Material, **numbers)


def read_sphere(table: Table) -> Sphere:
    """Return a sphere; its mass needs a value of its own or a density."""
    numbers = _numbers(table, ("radius",)) | _present(table, ("mass", "gyration_ratio"))
    material = read_material(table)
    if material.density is None and not table.has("mass"):
        raise ValueError(
            f"{table.path}: mass is unknown; give {table.at('mass')} in kg, "
            f"or {table.at('material.density')} in kg/m³"
        )
    return table.make(Sphere, material=material, **numbers)


def _target(root: Table) -> Sphere | HalfSpace:
    """Return the target, a half-space or a sphere."""
    raw = root.require("target", 'add [target] with kind = "half-space" or "sphere"')
    kinds = {"half-space": ("kind", "material"), "sphere": ("kind", *SPHERE_KEYS), "body": ()}
    kind = raw.get("kind") if isinstance(raw, Mapping) else None
    if kind is None and isinstance(raw, Mapping):
        raise ValueError('target.kind: is missing; give "half-space" or "sphere"')
    if kind is not None and not (isinstance(kind, str) and kind in kinds):
        raise refuse("target.kind", kind, 'must be "half-space", "sphere" or "body"')
    table = Table(raw, "target", known=kinds.get(str(kind), ()))
    return HalfSpace(read_material(table)) if kind == "half-space" else read_sphere(table)


def _is_rigid(target: object) -> bool:
    """Return whether a target is a body that is no sphere."""
    return isinstance(target, Mapping) and target.get("kind") == "body"


def _bodies(root: Table, impact: Table) -> tuple[list[Any], dict[str, Any]]:
    """Return two bodies, at least one of which is no sphere, and their contacts by name."""
    if root.has("body", "sphere") and root.has("body") == root.has("sphere"):
        raise ValueError("sphere: [body] takes the place of [sphere]; leave out one of the two")
    normal = impact.require("normal", "an impact of bodies needs normal = [x, y, z]")
    contacts: dict[str, Any] = {}
    bodies: list[Any] = []
    outward = np.asarray(real(impact.at("normal"), normal))
    for name, key, sense in (("body", "contact", 1.0), ("target", "target_contact", -1.0)):
        content = root.content.get(name)
        if name == "body" and content is None:
            bodies.append(read_sphere(root.table("sphere", known=SPHERE_KEYS)))
        elif name == "target" and not _is_rigid(content):
            bodies.append(_target(root))
        else:
            body, contact = rigid_body(content, name, sense * outward, read_material)
            bodies.append(body)
            if contact is not None:
                if impact.has(key):
                    raise ValueError(f"{impact.at(key)}: follows from the shape; leave it out")
                contacts[key] = contact
    return bodies, contacts


def _encounter(
    table: Table,
    body: Sphere | RigidBody,
    target: Sphere | HalfSpace | RigidBody,
    **contacts: Array,
) -> Encounter:
    """Return the encounter of an impact with velocity and normal as vectors."""
    in_plane = [key for key in IMPACT_KEYS if key not in ("friction_coefficient", "spin")]
    rivals = [key for key in (*in_plane, *STRUCK_KEYS[:2]) if table.has(key)]
    if rivals:
        raise ValueError(
            f"{table.path}: velocity and normal define the impact; leave them out, or {rivals[0]}"
        )
    for key in ("velocity", "normal"):
        table.require(key, f"an impact in space needs {key} = [x, y, z]")
    vectors = {key: table.content[key] for key in VECTOR_KEYS if table.has(key)}
    for key, value in vectors.items():
        if not isinstance(value, list):
            remedy = "beside vectors write [x, y, z]"
            raise refuse(table.at(key), value, "must be a vector of three numbers", remedy)
    numbers: dict[str, Any] = {"friction_coefficient": table.friction()}
    return table.make(Encounter, body=body, target=target, **numbers, **vectors, **contacts)


def _impact(table: Table, sphere: Sphere, target: Sphere | HalfSpace) -> Scene:
    """Return the scene of an impact with polar or normal and tangential velocity."""
    numbers: dict[str, Any] = {"friction_coefficient": table.friction()}
    numbers |= _present(table, ("spin", "normal_spin"))
    normal, along = plane.velocity(table)
    if table.has(*STRUCK_KEYS):
        surface = plane.surface(table, target)
        numbers |= {"normal_speed": normal - surface[0], "tangential_velocity": along - surface[1]}
        return table.make(Scene, sphere=sphere, target=target, **numbers)
    if table.has(*POLAR):
        numbers |= {key: table.content[key] for key in POLAR}
        return table.make(Scene.at_angle, sphere=sphere, target=target, **numbers)
    numbers |= _present(table, CARTESIAN)
    return table.make(Scene, sphere=sphere, target=target, **numbers)
