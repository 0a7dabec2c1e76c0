"""Closed forms of the paper, for floats or arrays: Hertz's impact, gross slip, rigid rebound."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from contactlab.impact.bodies import Pair
from contactlab.impact.bodies import size_ratio as size_ratio  # a closed form too
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import greater, magnitude
from contactlab.numeric.types import Array, Mask, Real

#: 2.9432751843: duration of an elastic Hertz impact times v1/(C²R), eq. (7) unrounded.
DURATION_CONSTANT = 4.0 * math.gamma(0.4) * math.sqrt(math.pi) / (5.0 * math.gamma(0.9))


class HertzScales(NamedTuple):
    """Largest contact radius (m), approach (m) and force (N), and the duration (s), eqs (7)-(9)."""

    radius: Real
    approach: Real
    force: Real
    duration: Real


def hertz_scales(scene: Scene) -> HertzScales:
    """Return the scales of an elastic Hertz impact, eqs (7)-(9)."""
    pair, speed = scene.pair, scene.normal_speed
    ratio = size_ratio(pair.normal_mass, pair.effective_modulus, pair.radius, speed)
    approach = ratio * ratio * pair.radius  # a product: a float squared raises OverflowError
    # P_max follows from energy: ½ M v1² = (2/5) P_max C² R; the square of v1 may underflow.
    force = 1.25 * pair.normal_mass * speed * (speed / approach)
    return HertzScales(
        radius=ratio * pair.radius,
        approach=approach,
        force=force,
        duration=DURATION_CONSTANT * (approach / speed),
    )


def peak_pressure(scene: Scene) -> Real:
    """Return the greatest pressure in Pa of an elastic Hertz impact, p_0 = 3 P_max/(2 pi a b)."""
    scales, (one, other) = hertz_scales(scene), semi_axes(scene.pair)
    return 1.5 * (scales.force / scales.radius) / (math.pi * scales.radius) / (one * other)


def semi_axes(pair: Pair) -> tuple[Real, Real]:
    """Return the semi-axes along t1 and t2 over the radius of the circle as stiff (theory §16)."""
    ratio = pair.axis_ratio
    if ratio == 1.0 if isinstance(ratio, float) else np.all(np.equal(ratio, 1.0)):
        return 1.0, 1.0
    from contactlab.impact.elliptic import of_axes  # scipy, which few scenes need

    shape, along = of_axes(np.minimum(ratio, 1.0 / np.asarray(ratio))), np.less_equal(ratio, 1.0)
    axes = np.where(along, shape.major, shape.minor), np.where(along, shape.minor, shape.major)
    return axes if np.ndim(ratio) else (float(axes[0]), float(axes[1]))


def elongation_of(pair: Pair) -> Array:
    """Return the major over the minor semi-axis of the contact, at least 1, as an array."""
    ratio: Array = np.asarray(pair.axis_ratio)
    return np.maximum(ratio, 1.0 / ratio)


def linear_stiffness(scene: Scene) -> Real:
    """Return the k of a linear spring with Hertz's largest approach, M (v1/z_max)², in N/m."""
    frequency = scene.normal_speed / hertz_scales(scene).approach
    return scene.pair.normal_mass * frequency * frequency


def hertz_stiffness(scene: Scene) -> Real:
    """Return k = (4/3) E* sqrt(R) of P = k z^1.5, eq. (4), in N/m^1.5."""
    return (4.0 / 3.0) * scene.pair.effective_modulus * scene.pair.radius**0.5


def slips_throughout(psi1: Real, chi: Real, restitution: Real = 1.0) -> Mask:
    """Return True where an impact is in gross slip throughout, eqs (44) and (46) if elastic.

    The condition is ``|psi1| >= max(1, 2 chi (1 + e) - e)``, with one loss for pressure and shear
    too (theory §15). For chi < 1/2 eq. (46) alone does not suffice: below ``|psi1| = 1`` the
    contact sticks from the start (44).
    """
    end = 2.0 * chi * (1.0 + restitution) - restitution
    return magnitude(psi1) >= greater(end, 1.0)


def rigid_body_rebound(psi1: Real, chi: Real, restitution: Real = 1.0) -> Real:
    """Return psi2 of the rigid-body theory (paper §4.3): slip, then rolling if slip ends."""
    reduced = np.maximum(np.abs(psi1) - 2.0 * chi * (1.0 + restitution), 0.0)
    return np.copysign(reduced, psi1)
