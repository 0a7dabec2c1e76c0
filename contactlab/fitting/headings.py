"""Headings of a table of measured impacts: a name and its unit, as exports write them."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

from contactlab.impact.scene import entry_unit
from contactlab.numeric.checks import nearest
from contactlab.outcome.columns import QUANTITIES
from contactlab.scene_file.entries import ENTRIES

#: What can be measured of a rebound; everything else of a result follows from these and a law.
MEASURABLE = (
    "normal_restitution", "tangential_restitution", "slip_restitution", "rebound_angle_deg",
    "local_rebound_angle_deg", "rebound_angle", "local_rebound_angle", "rebound_speed",
    "rebound_normal_velocity", "rebound_tangential_velocity", "rebound_slip_velocity",
    "rebound_spin", "contact_time", "psi2",
)  # fmt: skip
#: Units that are converted: to which, and by what factor.
CONVERSIONS = {
    ("rad", "deg"): math.degrees(1.0), ("deg", "rad"): math.radians(1.0),
    ("mm/s", "m/s"): 1e-3, ("cm/s", "m/s"): 1e-2, ("mm", "m"): 1e-3, ("g", "kg"): 1e-3,
    ("rpm", "rad/s"): 2.0 * math.pi / 60.0, ("rev/s", "rad/s"): 2.0 * math.pi,
    ("1/min", "rad/s"): 2.0 * math.pi / 60.0, ("deg/s", "rad/s"): math.radians(1.0),
    ("ms", "s"): 1e-3, ("µs", "s"): 1e-6, ("us", "s"): 1e-6,
}  # fmt: skip
ERROR = "_error"
HEADING = re.compile(r"^\s*([^()\[\]]+?)\s*(?:[(\[]([^()\[\]]*)[)\]])?\s*$")


class Heading(NamedTuple):
    """What a column holds.

    ``role`` is "given" (an entry of the scene), "measured", "error" (standard error of a
    measured quantity) or "unused".
    """

    role: str
    name: str
    factor: float = 1.0


def read_heading(text: str) -> Heading:
    """Return what a heading such as ``rebound_spin (rad/s)`` names.

    Raises
    ------
    ValueError
        If the name is unknown, with the nearest, or the unit is missing or not its own.
    """
    found = HEADING.match(text)
    if text.lstrip().startswith("#") or not text.strip():
        return Heading("unused", text)
    if not found:
        raise ValueError(f"heading {text!r}: write a name and its unit, as in 'speed (m/s)'")
    name, unit = re.sub(r"[\s-]+", "_", found[1].lower()), (found[2] or "").strip()
    unit = {"°": "deg", "degrees": "deg", "-": "1"}.get(unit, unit)
    role = "measured"
    if name.endswith(ERROR):
        role, name = "error", name.removesuffix(ERROR)
    if name not in ENTRIES and unit == "deg" and not name.endswith("_deg"):
        name = f"{name}_deg"
    if name in ("incidence_angle", "incidence_angle_deg", "angle", "angle_rad"):
        unit, name = unit or ("deg" if name.endswith("_deg") else "rad"), "angle_deg"
    if name in ENTRIES and role == "measured":
        return Heading("given", name, _factor(text, name, unit, entry_unit(name)))
    if name in MEASURABLE:
        return Heading(role, name, _factor(text, name, unit, QUANTITIES[name].unit))
    if name in QUANTITIES or name == "status":
        return Heading("unused", text)
    known = [*ENTRIES, *MEASURABLE]
    short = [known for known in ENTRIES if "." not in known]
    raise ValueError(
        f"heading {text!r}: is neither an entry of a scene nor a quantity of a rebound; "
        f"{nearest(name, known)}before the impact: {', '.join(short)}; after it: "
        f"{', '.join(MEASURABLE)}; a column that begins with # is not read"
    )


def _factor(text: str, name: str, unit: str, own: str) -> float:
    """Return by what to multiply numbers in ``unit`` to have them in the name's own.

    Parameters
    ----------
    text : str
        The whole heading, for the refusal.
    name : str
        Of the quantity.
    unit : str
        As the heading gives it; empty if it gives none.
    own : str
        The unit in which the quantity is kept.
    """
    if unit == own or (not unit and (own == "1" or name.endswith("_deg"))):
        return 1.0
    if (unit, own) in CONVERSIONS:
        return CONVERSIONS[unit, own]
    others = ", ".join(["", *(given for given, to in CONVERSIONS if to == own)])
    told = "has no unit" if not unit else f"is in {unit}, which is not known here"
    raise ValueError(
        f"heading {text!r}: {told}; write '{name} ({own})'{others and ', or'}{others[1:]}"
    )
