"""From the tables of a file to a scene, and which of their entries may vary."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import Any

import numpy as np

from contactlab.bodies import HalfSpace, Material, Sphere
from contactlab.checks import Rule, refuse
from contactlab.scene import Scene
from contactlab.scene_file.table import Table

MATERIAL_KEYS = ("shear_modulus", "young_modulus", "poisson_ratio", "density")
SPHERE_KEYS = ("radius", "mass", "gyration_ratio", "material")
IMPACT_KEYS = (
    "friction_coefficient", "speed", "angle_deg", "normal_speed", "tangential_velocity", "spin",
)  # fmt: skip
NONDIMENSIONAL_KEYS = ("psi1", "chi")
BODY_SECTIONS = ("sphere", "target", "impact")

#: Units for the remedies; the rules themselves are those of the classes that are made.
UNITS = {
    "shear_modulus": "Pa", "young_modulus": "Pa", "poisson_ratio": "1", "density": "kg/m³",
    "radius": "m", "mass": "kg", "gyration_ratio": "1", "friction_coefficient": "1",
    "speed": "m/s", "angle_deg": "deg", "normal_speed": "m/s",
    "tangential_velocity": "m/s", "spin": "rad/s", "psi1": "1", "chi": "1",
}  # fmt: skip

OBLIQUE = Rule(
    lambda degrees: np.abs(degrees) < 90.0, "must lie between -90 and 90, measured from the normal"
)
POSITIVE_SPEED = Rule(lambda value: value > 0.0, "must be positive and finite")


def _entries() -> dict[str, str]:
    """Return every entry that may vary: its short or dotted name, and its dotted path."""
    names = {key: f"impact.{key}" for key in IMPACT_KEYS}
    names |= {key: f"nondimensional.{key}" for key in NONDIMENSIONAL_KEYS}
    dotted = list(names.values())
    for body in ("sphere", "target"):
        dotted += [f"{body}.{key}" for key in SPHERE_KEYS if key != "material"]
        dotted += [f"{body}.material.{key}" for key in MATERIAL_KEYS]
    return names | {path: path for path in dotted}


ENTRIES = _entries()


def entry_path(name: str, *, where: str = "") -> str:
    """Return the dotted path of an entry that may vary.

    Raises
    ------
    ValueError
        If there is no such entry; ``where`` is the dotted path of the table that named it.
    """
    if name not in ENTRIES:
        nearest = difflib.get_close_matches(name, ENTRIES, n=1, cutoff=0.5)
        hint = f"did you mean {nearest[0]!r}? " if nearest else ""
        short = ", ".join((*IMPACT_KEYS, *NONDIMENSIONAL_KEYS))
        raise ValueError(
            f"{where}{name}: is not an entry of a scene; {hint}"
            f"known: {short}, or dotted ones such as sphere.radius"
        )
    return ENTRIES[name]


def entry_unit(name: str) -> str:
    """Return the unit of an entry that may vary."""
    return UNITS[name.rpartition(".")[2]]


def replaced(document: Mapping[str, Any], path: str, value: object) -> dict[str, Any]:
    """Return a copy of ``document`` with ``value`` at the dotted ``path``."""
    key, _, rest = path.partition(".")
    inner = document.get(key, {})
    return {**document, key: replaced(inner, rest, value) if rest else value}


def build_scene(document: Mapping[str, Any]) -> Scene:
    """Return the scene of a file's tables; arrays in the place of numbers make it a batch."""
    given = [section for section in BODY_SECTIONS if section in document]
    if "nondimensional" in document:
        if given:
            raise ValueError(
                f"nondimensional: cannot stand beside [{given[0]}]; psi1 and chi say it all, "
                "leave out one or the other"
            )
        table = Table(document["nondimensional"], "nondimensional", known=NONDIMENSIONAL_KEYS)
        return table.make(Scene.nondimensional, **_numbers(table, NONDIMENSIONAL_KEYS))
    root = Table({section: document[section] for section in given}, "", known=BODY_SECTIONS)
    sphere = _sphere(root.table("sphere", known=SPHERE_KEYS))
    target = _target(root)
    return _impact(root.table("impact", known=IMPACT_KEYS), sphere, target)


def _numbers(table: Table, keys: tuple[str, ...]) -> dict[str, Any]:
    return {key: table.number(key, remedy=f"give it in {UNITS[key]}") for key in keys}


def _given(table: Table, keys: tuple[str, ...]) -> dict[str, Any]:
    return _numbers(table, tuple(key for key in keys if table.has(key)))


def _material(table: Table) -> Material:
    material = table.table("material", known=MATERIAL_KEYS)
    material.require("poisson_ratio", "for example 0.3")
    if material.has("shear_modulus") == material.has("young_modulus"):
        raise ValueError(
            f"{material.path}: exactly one of shear_modulus and young_modulus must be given, in Pa; "
            "the other follows from E = 2 G (1 + nu)"
        )
    return material.make(Material, **_given(material, MATERIAL_KEYS))


def _sphere(table: Table) -> Sphere:
    numbers = _numbers(table, ("radius",)) | _given(table, ("mass", "gyration_ratio"))
    material = _material(table)
    if material.density is None and not table.has("mass"):
        raise ValueError(
            f"{table.path}: mass is not known; give {table.at('mass')} in kg, "
            f"or {table.at('material.density')} in kg/m³"
        )
    return table.make(Sphere, material=material, **numbers)


def _target(root: Table) -> Sphere | HalfSpace:
    raw = root.require("target", 'add [target] with kind = "half-space" or "sphere"')
    kinds = {"half-space": ("kind", "material"), "sphere": ("kind", *SPHERE_KEYS)}
    kind = raw.get("kind") if isinstance(raw, Mapping) else None
    if kind is None and isinstance(raw, Mapping):
        raise ValueError('target.kind: is missing; give "half-space" or "sphere"')
    if kind is not None and kind not in kinds:
        raise refuse("target.kind", kind, 'must be "half-space" or "sphere"')
    table = Table(raw, "target", known=kinds.get(str(kind), ()))
    return HalfSpace(_material(table)) if kind == "half-space" else _sphere(table)


def _impact(table: Table, sphere: Sphere, target: Sphere | HalfSpace) -> Scene:
    numbers = _numbers(table, ("friction_coefficient",)) | _given(table, ("spin",))
    polar, cartesian = ("speed", "angle_deg"), ("normal_speed", "tangential_velocity")
    if table.has(*polar) and table.has(*cartesian):
        raise ValueError(
            "impact: has both speed/angle_deg and normal_speed/tangential_velocity; "
            "leave out one pair"
        )
    if table.has(*polar):
        unit = "give speed in m/s and angle_deg in degrees from the normal"
        speed = table.number("speed", rule=POSITIVE_SPEED, remedy=unit)
        angle = np.radians(table.number("angle_deg", rule=OBLIQUE, remedy=unit))
        numbers["normal_speed"] = speed * np.cos(angle)
        numbers["tangential_velocity"] = speed * np.sin(angle)
    else:
        table.require("normal_speed", "give it in m/s, or give speed and angle_deg")
        numbers |= _given(table, cartesian)
    return table.make(Scene, sphere=sphere, target=target, **numbers)
