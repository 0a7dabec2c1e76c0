"""Several contacts at once in a scene file: ``[bodies.NAME]`` and ``[[touches]]``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import attrs
import numpy as np

from contactlab.impact import material as materials
from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.gathering import Body, Gathering, Touch
from contactlab.impact.rigid_body import RigidBody
from contactlab.numeric.checks import POSITIVE, of_kind, real, refuse, unit_remedy
from contactlab.numeric.types import Numbers
from contactlab.scene_file.build import read_material
from contactlab.scene_file.entries import RIGID_KEYS, SPHERE_KEYS, UNITS
from contactlab.scene_file.table import Table, nearest_of

#: What a body is, with its keys.
KINDS = {
    "sphere": ("kind", *SPHERE_KEYS),
    "body": ("kind", *RIGID_KEYS),
    "half-space": ("kind", "material"),
}
#: Vectors of a body that moves, and the keys of a contact, numbers and others.
MOTION = ("velocity", "spin", "force", "position")
NUMBERS = ("friction_coefficient", "gap", "restitution")
OTHERS = ("first", "second", "normal", "contact", "target_contact", "target_velocity", "loaded")
#: What a sweep may vary of a body: its speed along its velocity.
SPEED = "speed"


def read_gathering(document: Mapping[str, object], varied: Mapping[str, Numbers]) -> Gathering:
    """Return the gathering of a file's tables, a batch where entries are ``varied``."""
    for key in ("sphere", "body", "target", "impact", "nondimensional"):
        if key in document:
            rule = "cannot stand beside [bodies.NAME] and [[touches]]; leave out one or the other"
            raise ValueError(f"{key}: {rule}")
    tables = of_kind("bodies", document.get("bodies"), Mapping, rule="must be tables",
                     remedy="write [bodies.ball], and its touches as [[touches]]")  # fmt: skip
    given = of_kind("touches", document.get("touches"), list, rule="must be a list of tables",
                    remedy="write [[touches]]")  # fmt: skip
    bodies: dict[str, Body] = {}
    walls: dict[str, HalfSpace] = {}
    for name, content in tables.items():
        made = _body(content, f"bodies.{name}")
        if isinstance(made, HalfSpace):
            walls[name] = made
        else:
            bodies[name] = made
    touches = [_touch(each, f"touches.{k}", walls) for k, each in enumerate(given)]
    for name, values in varied.items():
        _vary(name, values, bodies, touches)
    return Gathering(bodies, touches)


def swept_path(name: str, *, where: str = "") -> str:
    """Return the name of an entry that a sweep of a gathering may vary, or refuse it."""
    parts = name.split(".")
    if len(parts) == 3 and parts[0] == "bodies" and parts[2] == SPEED:
        return name
    if len(parts) == 3 and parts[0] == "touches" and parts[2] in NUMBERS and parts[1].isdigit():
        return name
    rule = "is no number of a gathering that varies"
    known = ", ".join(f"touches.0.{each}" for each in NUMBERS)
    raise ValueError(f"{where}{name}: {rule}; known: bodies.NAME.{SPEED}, {known}")


def _body(content: object, path: str) -> Body | HalfSpace:
    """Return a body that moves, or a half-space."""
    kind = content.get("kind", "sphere") if isinstance(content, Mapping) else "sphere"
    if not (isinstance(kind, str) and kind in KINDS):
        raise refuse(f"{path}.kind", kind, f"must be one of {', '.join(map(repr, KINDS))}")
    moving = () if kind == "half-space" else MOTION
    table = Table(_with_material(content, path), path, known=(*KINDS[kind], *moving))
    if kind == "half-space":
        return HalfSpace(read_material(table))
    shape: Sphere | RigidBody
    if kind == "sphere":
        present = [key for key in ("radius", "mass", "gyration_ratio") if table.has(key)]
        numbers = {key: table.number(key, remedy=unit_remedy(UNITS[key])) for key in present}
        table.require("radius", "in m")
        shape = table.make(Sphere, material=read_material(table), **numbers)
    else:
        numbers = {key: table.content[key] for key in RIGID_KEYS[:-1] if table.has(key)}
        shape = table.make(RigidBody, material=read_material(table), **numbers)
    vectors = {key: table.content[key] for key in MOTION if table.has(key)}
    return table.make(Body, shape=shape, **vectors)


def _with_material(content: object, path: str) -> object:
    """Return a table with the numbers of its material in place of its name."""
    name = content.get("material") if isinstance(content, Mapping) else None
    if not (isinstance(content, Mapping) and isinstance(name, str)):
        return content
    try:
        return {**content, "material": materials.entry(name).numbers()}
    except ValueError as error:
        raise ValueError(f"{path}.{error}") from error


def _touch(content: object, path: str, walls: Mapping[str, HalfSpace]) -> Touch:
    """Return a contact; the name of a half-space stands for it."""
    table = Table(content, path, known=(*OTHERS, *NUMBERS))
    for key in ("first", "second", "friction_coefficient", "normal"):
        table.require(key, "a contact needs first, second, friction_coefficient and normal")
    entries: dict[str, Any] = {key: table.content[key] for key in OTHERS if table.has(key)}
    present = [key for key in NUMBERS if table.has(key)]
    entries |= {key: table.number(key, remedy="one number") for key in present}
    if isinstance(entries["second"], str) and entries["second"] in walls:
        entries["second"] = walls[entries["second"]]
    return table.make(Touch, **entries)


def _vary(name: str, values: Numbers, bodies: dict[str, Body], touches: list[Touch]) -> None:
    """Give a body, or a contact, an array in place of a number."""
    section, key, entry = name.split(".")
    if section == "touches":
        place = int(key)
        if place >= len(touches):
            raise ValueError(f"sweep.{name}: there are {len(touches)} touches, counted from 0")
        entries: dict[str, Any] = {entry: values}
        touches[place] = attrs.evolve(touches[place], **entries)
        return
    if key not in bodies:
        raise ValueError(f"sweep.{name}: is no body; {nearest_of(key, bodies)}")
    body = bodies[key]
    size = float(np.linalg.norm(body.velocity))
    if not size > 0.0:
        raise ValueError(f"sweep.{name}: the body needs a velocity, whose direction is kept")
    speed = np.asarray(real(f"sweep.{name}", values, rule=POSITIVE, remedy="in m/s"))
    bodies[key] = attrs.evolve(body, velocity=speed[..., None] * body.velocity / size)
