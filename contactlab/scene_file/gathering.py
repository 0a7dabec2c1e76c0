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
from contactlab.impact.shapes import FLAT
from contactlab.numeric.checks import POSITIVE, of_kind, real, refuse
from contactlab.numeric.types import Numbers
from contactlab.scene_file.bodies import rigid_body
from contactlab.scene_file.build import read_material, read_sphere
from contactlab.scene_file.entries import OWN_MATERIAL, SPHERE_KEYS
from contactlab.scene_file.table import Table, nearest_of

#: Kinds of body.
KINDS = ("sphere", "body", "half-space")
#: Vectors of a body that moves, and the keys of a contact, numbers and others.
MOTION = ("velocity", "spin", "force", "position")
NUMBERS = ("friction_coefficient", "gap", "restitution")
OTHERS = ("first", "second", "normal", "contact", "target_contact", "target_velocity", "loaded")
#: The number of a body that a sweep may vary: its speed along its velocity.
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
    shaped: dict[str, list[dict[str, object]]] = {}
    for name, content in tables.items():
        made, contacts = _body(content, f"bodies.{name}")
        if isinstance(made, HalfSpace):
            walls[name] = made
        else:
            bodies[name], shaped[name] = made, contacts
    touches: list[Touch] = []
    for k, each in enumerate(given):
        touches += _touches(each, f"touches.{k}", walls, shaped)
    for name, values in varied.items():
        _vary(name, values, bodies, touches)
    return Gathering(bodies, touches)


def read_path(name: str, *, where: str = "") -> str:
    """Return the name of an entry that a sweep of a gathering may vary, or refuse it."""
    parts = name.split(".")
    if len(parts) == 3 and parts[0] == "bodies" and parts[2] == SPEED:
        return name
    if len(parts) == 3 and parts[0] == "touches" and parts[2] in NUMBERS and parts[1].isdigit():
        return name
    rule = "is no number of a gathering that varies"
    known = ", ".join(f"touches.0.{each}" for each in NUMBERS)
    raise ValueError(f"{where}{name}: {rule}; known: bodies.NAME.{SPEED}, {known}")


def _body(content: object, path: str) -> tuple[Body | HalfSpace, list[dict[str, object]]]:
    """Return a body that moves, or a half-space, and the contacts that its shape has."""
    content = _with_material(content, path)
    given: Mapping[str, Any] = content if isinstance(content, Mapping) else {}
    kind = given.get("kind", "body" if "shape" in given else "sphere")
    if not (isinstance(kind, str) and kind in KINDS):
        raise refuse(f"{path}.kind", kind, f"must be one of {', '.join(map(repr, KINDS))}")
    if kind == "half-space":
        return HalfSpace(read_material(Table(content, path, known=("kind", "material")))), []
    shape: Sphere | RigidBody
    contacts: list[dict[str, object]] = []
    if kind == "sphere":
        shape = read_sphere(Table(content, path, known=("kind", *SPHERE_KEYS, *MOTION)))
    elif "shape" in given:
        shape, contacts = _shape(content, given, path)
    else:
        shape, _ = rigid_body(content, path, np.zeros(3), read_material, beside=MOTION)
    table = Table(content, path, known=given)
    vectors = {key: given[key] for key in MOTION if key in given}
    return table.make(Body, shape=shape, **vectors), contacts


def _shape(
    content: object, given: Mapping[str, object], path: str
) -> tuple[RigidBody, list[dict[str, object]]]:
    """Return the body of a shape, and normal, contact and gap of each of its contacts."""
    for key, what in (("normal", "into what it lands on"), ("axis", "the direction of the rod")):
        if key not in given and (key == "normal" or given["shape"] == "flat_rod"):
            raise ValueError(f"{path}.{key}: is missing; {what}, such as {key} = [x, y, z]")
    normal = np.asarray(real(f"{path}.normal", given["normal"]))
    beside = ("normal", *MOTION)
    body, contact, *gap = rigid_body(
        content, path, normal, read_material, further=FLAT, beside=beside
    )
    gaps = np.ravel(gap[0]) if gap else np.zeros(1)
    pairs = zip(np.reshape(contact, (-1, 3)), gaps.tolist(), strict=True)
    return body, [{"normal": normal, "contact": each, "gap": off} for each, off in pairs]


def _with_material(content: object, path: str) -> object:
    """Return a table with the numbers of its material in place of its name."""
    name = content.get("material") if isinstance(content, Mapping) else None
    if not (isinstance(content, Mapping) and isinstance(name, str)):
        return content
    try:
        own = OWN_MATERIAL.format(f"{path}.material")
        return {**content, "material": materials.entry(name, remedy=own).numbers()}
    except ValueError as error:
        raise ValueError(f"{path}.{error}") from error


def _touches(
    content: object,
    path: str,
    walls: Mapping[str, HalfSpace],
    shaped: Mapping[str, list[dict[str, object]]],
) -> list[Touch]:
    """Return a contact; without a normal, the contacts that the shape of its first body has.

    A contact names its half-space.
    """
    table = Table(content, path, known=(*OTHERS, *NUMBERS))
    needed = ["first", "second", "friction_coefficient"]
    first = table.content.get("first")
    own = shaped.get(first, []) if isinstance(first, str) and not table.has("normal") else []
    for key in needed if own else [*needed, "normal"]:
        table.require(key, "a contact needs first, second, friction_coefficient and normal")
    entries: dict[str, Any] = {key: table.content[key] for key in OTHERS if table.has(key)}
    present = [key for key in NUMBERS if table.has(key)]
    entries |= {key: table.number(key, remedy="one number") for key in present}
    if isinstance(entries["second"], str) and entries["second"] in walls:
        entries["second"] = walls[entries["second"]]
    for key in ("contact", "gap"):
        if own and key in entries:
            raise ValueError(f"{table.at(key)}: follows from the shape; leave it out")
    return [table.make(Touch, **entries, **each) for each in own or [{}]]


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
