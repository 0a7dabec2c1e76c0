"""The entries of a scene file: keys, units, replacement of values."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from contactlab.impact import material as materials
from contactlab.impact.scene import UNITS as SCENE_UNITS
from contactlab.numeric.checks import of_kind
from contactlab.numeric.names import nearest
from contactlab.registration.names import KINDS
from contactlab.scene_file.table import MATERIAL_KEYS

SPHERE_KEYS = ("radius", "mass", "gyration_ratio", "material")
IMPACT_KEYS = (
    "friction_coefficient", "speed", "angle_deg", "normal_speed", "tangential_velocity", "spin",
    "normal_spin",
)  # fmt: skip
#: Velocity of the struck body along the normal and along the surface, and its spin, where those of
#: the first body are numbers too.
STRUCK_KEYS = ("target_normal_velocity", "target_tangential_velocity", "target_spin")
#: Keys of an encounter in space; ``spin`` is a vector if ``velocity`` is given.
SPHERE_VECTORS = ("velocity", "normal", "spin", "target_velocity", "target_spin")
VECTOR_KEYS = (*SPHERE_VECTORS, "contact", "target_contact")
#: Velocities of spheres before the impact: by size and angle, or by components.
POLAR, CARTESIAN = ("speed", "angle_deg"), ("normal_speed", "tangential_velocity")
NONDIMENSIONAL_KEYS = ("psi1", "chi")
#: Parameters where friction changes the approach: eta or rho beside lam.
COUPLING_KEYS = ("lam", "eta", "rho")
#: Parameters of spin about the normal, in a scene without bodies.
SPIN_KEYS = ("spin", "spin_inertia")
#: Keys of a body that is no sphere: those of ``RigidBody``; shapes tell their own.
RIGID_KEYS = (
    "mass", "inertia", "principal", "axes", "curvature_radius", "cross_radius", "curvature_axis",
    "bending_period", "material",
)  # fmt: skip
#: Angle by which a shape is turned about y, by the right-hand rule.
TILT = "tilt_deg"
#: Further groups of a scene without bodies, which may be left out.
GROUP_KEYS = ("poisson_ratio", "coupling_number", "friction_coefficient")
BODY_SECTIONS = ("sphere", "body", "target", "impact")
#: How a file states the numbers of a material that the collection lacks.
OWN_MATERIAL = "or give your own: a table [{}] with young_modulus, poisson_ratio and density"

#: Units for the remedies in messages; the classes of bodies and scenes check the values.
UNITS = SCENE_UNITS | {
    "velocity": "m/s", "normal": "1", "target_velocity": "m/s", "target_spin": "rad/s",
    "target_normal_velocity": "m/s", "target_tangential_velocity": "m/s",
}  # fmt: skip


def _entries() -> dict[str, str]:
    """Return the dotted path of every entry that may vary, by short and by dotted name."""
    names = {key: f"impact.{key}" for key in (*IMPACT_KEYS, *STRUCK_KEYS)}
    scaled = (*NONDIMENSIONAL_KEYS, "coupling_number", *COUPLING_KEYS, "spin_inertia")
    names |= {key: f"nondimensional.{key}" for key in scaled} | {TILT: f"body.{TILT}"}
    dotted = [*names.values(), *(f"nondimensional.{key}" for key in ("spin", *GROUP_KEYS))]
    for body in ("sphere", "target"):
        dotted += [f"{body}.{key}" for key in SPHERE_KEYS if key != "material"]
        dotted += [f"{body}.material.{key}" for key in MATERIAL_KEYS]
    dotted += [f"body.{key}" for key in ("mass", "curvature_radius", "cross_radius")]
    return names | {path: path for path in dotted}


ENTRIES = _entries()
#: A property of a material, and an option of which each impact has its own number.
PROPERTY = re.compile(r"(?:sphere|body|target)\.material\.properties\.([A-Za-z_]\w*)")


def is_option(name: str) -> bool:
    """Return whether a name is the option of a law: ``"normal.relaxation_time"``."""
    kind, _, option = name.partition(".")
    return kind in KINDS and option.isidentifier()


def entry_path(name: str, *, where: str = "") -> str:
    """Return the dotted path of an entry that may vary, from its short or dotted name.

    Raises
    ------
    ValueError
        If the entry is unknown; ``where`` is the dotted path of the table with its name.
    """
    if PROPERTY.fullmatch(name) or is_option(name):
        return name
    if name not in ENTRIES:
        hint = nearest(name, ENTRIES)
        short = ", ".join((*IMPACT_KEYS, *NONDIMENSIONAL_KEYS))
        raise ValueError(
            f"{where}{name}: is not an entry of a scene; {hint}"
            f"known: {short}, or dotted ones such as sphere.radius"
        )
    return ENTRIES[name]


def replace_entry(
    document: Mapping[str, object], path: str, value: object, *, within: str = ""
) -> dict[str, object]:
    """Return a copy of ``document``, the table at ``within``, with ``value`` at a dotted path."""
    key, _, rest = path.partition(".")
    if not rest:
        return {**document, key: value}
    place = within + key
    rule, remedy = "must be a table", f"write it under [{place}]"
    inner = of_kind(place, document.get(key, {}), Mapping, rule=rule, remedy=remedy)
    return {**document, key: replace_entry(inner, rest, value, within=f"{place}.")}


def with_materials(tables: Mapping[str, object]) -> dict[str, object]:
    """Return the tables with the numbers of materials in place of their names."""
    completed = dict(tables)
    for body in ("sphere", "body", "target"):
        table = completed.get(body)
        name = table.get("material") if isinstance(table, Mapping) else None
        if isinstance(name, str):
            path = f"{body}.material"
            try:
                numbers = materials.entry(name, remedy=OWN_MATERIAL.format(path)).numbers()
                completed = replace_entry(completed, path, numbers)
            except ValueError as error:
                raise ValueError(f"{path}: {error}") from None
    return completed


def list_materials(
    tables: Mapping[str, object], of: Iterable[str] = BODY_SECTIONS
) -> tuple[str, ...]:
    """Return the names of materials in the tables ``of`` bodies, each once."""
    sections = (tables.get(name) for name in of)
    bodies = [section for section in sections if isinstance(section, Mapping)]
    names = [body["material"] for body in bodies if isinstance(body.get("material"), str)]
    return tuple(dict.fromkeys(names))


def without_rivals(tables: Mapping[str, object], names: Iterable[str]) -> dict[str, object]:
    """Return the tables without the velocities, polar or by components, that ``names`` replace."""
    forms = POLAR, CARTESIAN
    kept = dict(tables)
    impact = kept.get("impact")
    if isinstance(impact, Mapping):
        for form, rival in (forms, forms[::-1]):
            if set(form) & set(names):
                impact = {k: v for k, v in impact.items() if k not in rival}
                kept["impact"] = impact
    return kept
