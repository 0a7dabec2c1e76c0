"""A page to play with: a ball is thrown at a block, with slow motion through the contact."""

from __future__ import annotations

import json
import re
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

import contactlab
from contactlab.collisions.collide import collide
from contactlab.impact import shapes
from contactlab.impact.bodies import HalfSpace
from contactlab.impact.encounter import Encounter
from contactlab.impact.material import Material, entry, names
from contactlab.numeric.checks import refuse, yes_or_no
from contactlab.runs.simulation import Simulation

#: Springs and steps of the contact that the page draws; velocities after it come from the table.
SPRINGS, STEPS = 100, 500
#: Ranges of the sliders: least, most.
RANGES = {"angle": (0.0, 85.0), "speed": (0.1, 10.0), "spin": (-600.0, 600.0),
          "friction": (0.02, 1.0), "radius": (0.001, 0.1), "inertia": (0.25, 0.67),
          "restitution": (0.0, 1.0)}  # fmt: skip
#: Arguments of ``explore_page`` by their sliders, where the names differ.
ARGUMENTS = {"friction": "friction_coefficient", "inertia": "inertia_ratio"}
#: Parts of the page and their files; the kernel is that for games, no module here.
PARTS = {
    "STYLE": "contactlab_pages/explore.css", "KERNEL": "contactlab/kernels/contactlab_bounce.mjs",
    "OTHERS": "contactlab_pages/springs.js", "THROW": "contactlab_pages/throw.js",
    "CLASS": "contactlab_pages/class.js", "PAGE": "contactlab_pages/explore.js",
    "ROD": "contactlab_pages/rod.js",
}  # fmt: skip
#: Tilts of the rod from the vertical in degrees, its friction coefficient and restitutions.
TILTS, ROD_FRICTION, RESTITUTIONS = range(76), 0.3, (1.0, 0.8, 0.6, 0.4)


@cache
def rod_table() -> list[list[list[list[float]]]]:
    """Return a rod after a fall at 1 m/s: [e][law][tilt][velocity x, z, spin], in SI."""
    steel, down = Material.named("steel"), np.array([0.0, 0.0, -1.0])
    tilt = np.radians(TILTS)
    axis = np.column_stack((np.sin(tilt), np.zeros(len(tilt)), np.cos(tilt)))
    rods, contact = shapes.rod(length=1.0, radius=0.02, material=steel, normal=down, axis=axis)
    met = Encounter(
        rods, HalfSpace(steel), ROD_FRICTION, normal=down, velocity=down, contact=contact
    )
    table = []
    for e in RESTITUTIONS:
        laws = Simulation(restitution=e), Simulation(tangential="coulomb", restitution=e)
        after = [collide(met, each).check() for each in laws]
        left = [np.column_stack((each.velocity[:, ::2], each.spin[:, 1])) for each in after]
        table.append([(each.round(3) + 0.0).tolist() for each in left])
    return table


def explore_page(
    *,
    angle: float = 35.0,
    speed: float = 2.0,
    spin: float = 200.0,
    friction_coefficient: float = 0.8,
    radius: float = 0.01,
    inertia_ratio: float = 0.4,
    restitution: float = 1.0,
    material: str = "pmma",
    block: str | None = None,
    predict: bool = False,
) -> str:
    """Return the page as HTML.

    Parameters
    ----------
    angle : float
        First angle of incidence from the normal, in degrees.
    speed : float
        First speed, in m/s.
    spin : float
        First spin, in rad/s, positive where it adds to the slip.
    friction_coefficient : float
        First friction coefficient.
    radius : float
        First radius of the ball, in m.
    inertia_ratio : float
        First moment of inertia over m R², the square of the gyration ratio: 0.4 of a solid ball,
        2/3 of a thin shell. The mass is that of a solid ball.
    restitution : float
        First coefficient of normal restitution, rebound over approach velocity.
    material : str
        First material of the ball, a name of the collection.
    block : str, optional
        First material of the block, by default that of the ball.
    predict : bool
        Ask for a prediction first.

    Raises
    ------
    ValueError
        If a number is beyond its slider, or the material unknown.
    """
    first: dict[str, Any] = {
        "angle": angle, "speed": speed, "spin": spin, "friction": friction_coefficient,
        "radius": radius, "inertia": inertia_ratio, "restitution": restitution,
    }  # fmt: skip
    for name, value in first.items():
        least, most = RANGES[name]
        if not least <= value <= most:
            raise refuse(
                ARGUMENTS.get(name, name),
                value,
                f"must lie in [{least:g}, {most:g}], the range of the slider",
            )
    first |= {"material": entry(material).name, "block": entry(block).name if block else ""}
    first |= {"predict": yes_or_no("predict", predict), "guess": 0}
    page = resources.files("contactlab_pages").joinpath("explore.html").read_text("utf-8")
    for part, file in PARTS.items():
        package, _, name = file.partition("/")
        text = resources.files(package).joinpath(name).read_text("utf-8").strip()
        page = page.replace(f"/*{part}*/", re.sub("^export ", "", text, flags=re.MULTILINE))
    entries = {
        "/*MATERIALS*/null": json.dumps({name: entry(name).numbers() for name in names()}),
        "/*FIRST*/null": json.dumps(first),
        "/*TABLE*/null": json.dumps(rod_table(), separators=(",", ":")),
        "/*BOUNCES*/null": json.dumps(RESTITUTIONS),
        "/*SPRINGS*/0": str(SPRINGS),
        "/*STEPS*/0": str(STEPS),
        "/*RANGES*/null": json.dumps(RANGES),
        "VERSION": contactlab.__version__,
        "SPRINGS springs": f"{SPRINGS} springs",
        "STEPS steps": f"{STEPS} steps",
    }
    for place, text in entries.items():
        page = page.replace(place, text)
    return page
