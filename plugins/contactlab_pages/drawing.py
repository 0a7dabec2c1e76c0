"""A drawing of a scene as SVG: the sphere with its velocities before and after the impact."""

from __future__ import annotations

import math

import numpy as np

from contactlab.impact.bodies import Sphere
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.tables import number

#: Half width, height above and depth below the surface, in radii of the sphere.
WIDTH, HEIGHT, DEPTH = 4.2, 4.4, 0.9
#: Units of the drawing for one radius; length of the longer arrow in radii.
SCALE, ARROW = 60.0, 1.9
INCOMING, OUTGOING = "#0072B2", "#D55E00"


def scene_drawing(result: ImpactResult) -> str:
    """Return the drawing of one impact as SVG; empty for batches and scenes without bodies.

    The sphere comes from above. Tangential velocity is positive to the right, spin anticlockwise:
    both add to the slip velocity.
    """
    scene = result.scene
    if scene.sphere is None or scene.shape:
        return ""
    before = (float(scene.tangential_velocity), float(scene.normal_speed))
    after = (
        float(np.asarray(result.rebound_tangential_velocity)),
        float(result.rebound_normal_velocity),
    )
    unit = ARROW / max(math.hypot(*before), math.hypot(*after))
    parts = [
        _surface(isinstance(scene.target, Sphere)),
        f"<circle cx='0' cy='{-SCALE:g}' r='{SCALE:g}' fill='#cfe3f1' stroke='black'/>",
        _arrow(before, unit, INCOMING, incoming=True),
        _arrow(after, unit, OUTGOING, incoming=False),
        *_spins(float(scene.spin), float(np.asarray(result.rebound_spin))),
    ]
    box = (
        f"{-WIDTH * SCALE:g} {-HEIGHT * SCALE:g} {2 * WIDTH * SCALE:g} {(HEIGHT + DEPTH) * SCALE:g}"
    )
    style = "font-family='Georgia, serif' font-size='15'"
    return f"<svg viewBox='{box}' role='img' aria-label='the impact' {style}>{''.join(parts)}</svg>"


def _surface(curved: bool) -> str:
    """Return the surface of a half-space or a sphere."""
    w, d = WIDTH * SCALE, DEPTH * SCALE
    if curved:
        r = 2.5 * SCALE
        return f"<circle cx='0' cy='{r:g}' r='{r:g}' fill='#e4e4e4' stroke='black'/>"
    return f"<rect x='{-w:g}' y='0' width='{2 * w:g}' height='{d:g}' fill='#e4e4e4'/>" + (
        f"<line x1='{-w:g}' y1='0' x2='{w:g}' y2='0' stroke='black'/>"
    )


def _arrow(velocity: tuple[float, float], unit: float, colour: str, *, incoming: bool) -> str:
    """Return the arrow of a velocity (to the right, down) in m/s, ``unit`` radii for 1 m/s."""
    x, y = velocity[0] * unit, velocity[1] * unit
    length = math.hypot(x, y)
    if length == 0.0:
        return ""
    # arrows stand outside the sphere, along the path of its centre
    gap = 1.15 / length
    start = (-x - gap * x, -y - gap * y) if incoming else (gap * x, gap * y)
    stop = (start[0] + x, start[1] + y)
    ends = [SCALE * start[0], SCALE * (start[1] - 1.0), SCALE * stop[0], SCALE * (stop[1] - 1.0)]
    across = (-y / length, x / length)
    back = (ends[2] - 12.0 * x / length, ends[3] - 12.0 * y / length)
    tip = " ".join(
        f"{px:.1f},{py:.1f}"
        for px, py in (
            (ends[2], ends[3]),
            (back[0] + 5.0 * across[0], back[1] + 5.0 * across[1]),
            (back[0] - 5.0 * across[0], back[1] - 5.0 * across[1]),
        )
    )
    far = ends[:2] if incoming else ends[2:]
    side = -1.0 if incoming else 1.0
    anchor = "end" if incoming else "start"
    return (
        f"<line x1='{ends[0]:.1f}' y1='{ends[1]:.1f}' x2='{back[0]:.1f}' y2='{back[1]:.1f}' "
        f"stroke='{colour}' stroke-width='2.5'/><polygon points='{tip}' fill='{colour}'/>"
        f"<text x='{far[0] + 10.0 * side:.1f}' y='{far[1]:.1f}' fill='{colour}' "
        f"text-anchor='{anchor}'>{number(math.hypot(*velocity), digits=3)} m/s</text>"
    )


def _spins(before: float, after: float) -> list[str]:
    """Return the spins as text at the sides of the sphere."""
    texts = []
    for side, spin, colour in ((-1.0, before, INCOMING), (1.0, after, OUTGOING)):
        turn = "" if spin == 0.0 else " ↺" if spin > 0.0 else " ↻"
        anchor = "end" if side < 0.0 else "start"
        texts.append(
            f"<text x='{1.2 * SCALE * side:g}' y='{-0.35 * SCALE:g}' fill='{colour}' "
            f"text-anchor='{anchor}'>{number(spin, digits=3)} rad/s{turn}</text>"
        )
    return texts
